"""An opened file of results: views take its plans and its cam in place of a search, where they show its entries."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

from optlaws.cycles.cycle import Cycle, Plan
from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.jobs import cam as cam_job
from optlaws.jobs.cam_entries import CamProblemFile
from optlaws.jobs.cam_result import CamResult

#: entries that change nothing of a cam's laws
_BESIDE = ("title", "text", "cutter_radius")
_PLAN = ("cycle", "solutions", "chosen", "bound")


class OpenedResults:
    """The text of the file that was opened last; it is read, and its numbers are checked, when a view looks for one."""

    def __init__(self) -> None:
        self.text = ""

    def plan_of(self, cycle: Cycle) -> Plan | None:
        """The plan of a cycle; None where the file has none, or states what does not follow from its laws."""
        plans = _plans(self.text) if self.text else ()
        return next((plan for plan in plans if plan.specification == cycle), None)

    def cam_of(self, spec: CamProblemFile) -> CamResult | None:
        """The cam of a problem file; None where the results are of no such cam."""
        known = _cam(self.text) if self.text else None
        if known is None or replace(known.spec, **{name: getattr(spec, name) for name in _BESIDE}) != spec:
            return None
        return replace(known, spec=spec)


OPENED = OpenedResults()


@lru_cache(maxsize=4)
def _plans(text: str) -> Sequence[Plan]:
    try:
        data = reading.json_text(text, "the file")
        axes = data.get("axes", {"axis": data})
        entries = [{name: axis[name] for name in _PLAN if name in axis} for axis in axes.values()]
        plans = [Plan.from_dict(each) for each in entries if each.get("solutions")]
    except (AttributeError, TypeError, InputError):  # other contents: views compute what they show
        return ()
    return [plan for plan in plans if not plan.contradiction()]


@lru_cache(maxsize=4)
def _cam(text: str) -> CamResult | None:
    try:
        result = cam_job.stored(reading.json_text(text, "the file"))
    except (AttributeError, KeyError, TypeError, InputError):
        return None
    return result if isinstance(result, CamResult) and not result.plan.contradiction() else None
