"""Motions handed to controllers: files in their formats, and what the controller will run, before anything is saved."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import msgspec

from optlaws.errors import InputError
from optlaws.explorer.answers import cycle_view
from optlaws.explorer.answers.asked import MOST_LAWS, AskedLaw, law_of
from optlaws.explorer.answers.law_view import digits

Text = Annotated[str, msgspec.Meta(max_length=60)]
_MOST_POINTS = 10_000


class AskedExport(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A law or a cycle in a format, with the machine it moves."""

    format: Text
    view: Literal["laws", "cycle"] = "laws"
    laws: Annotated[list[AskedLaw], msgspec.Meta(min_length=1, max_length=MOST_LAWS)]
    active: Annotated[int, msgspec.Meta(ge=0, lt=MOST_LAWS)] = 0
    cycle: cycle_view.AskedCycle | None = None
    stroke: Text = "35 mm"
    time: Text = "0.1 s"
    master: Text = "120 deg"
    points: Annotated[int, msgspec.Meta(ge=2, le=_MOST_POINTS)] | None = None
    counts: Annotated[int, msgspec.Meta(ge=2, le=2**53)] | None = None


def formats() -> list[dict[str, Any]]:
    """The formats, with who takes each and what may be asked of it.

    Examples
    --------
    >>> next(entry["target"] for entry in formats() if entry["name"] == "codesys-xyva")
    'CODESYS SoftMotion, SMC_CAMXYVA in MC_CAM_REF'
    """
    from optlaws.exports import format as known

    return [
        {"name": name, "target": known.FORMATS[name].target, "takes": list(known.FORMATS[name].takes)}
        for name in sorted(known.FORMATS)
    ]


def answer(asked: AskedExport) -> dict[str, Any]:
    """The file, and the peaks of the motion as the controller interpolates it beside those of the law.

    Examples
    --------
    >>> made = answer(AskedExport(format="codesys-xyva", laws=[AskedLaw(name="cycloidal")], points=9))
    >>> made["name"], made["rows"][1][0]
    ('Cam.st', 'peak of acceleration, mm/s²')
    """
    made = _export(asked)
    written = made.written
    return {
        "name": f"Cam{made.format.extension}",
        "type": "text/plain",
        "text": made.text,
        "words": f"{made.format.target}: {written.points} {written.counted}, {written.model}",
        "notes": list(written.notes),
        "rows": [[name, *map(_cell, numbers)] for name, *numbers in made.rows()],
    }


def _export(asked: AskedExport) -> Any:  # noqa: ANN401 - an Export
    given: dict[str, Any] = {"points": asked.points, "counts": asked.counts}
    if asked.view == "cycle":
        if asked.cycle is None:
            raise InputError("there is no cycle to export")
        return cycle_view.cycle(asked.cycle).export(asked.format, **given)
    law = law_of(asked.laws[min(asked.active, len(asked.laws) - 1)])
    return law.export(asked.format, stroke=asked.stroke, duration=asked.time, master=asked.master or None, **given)


def _cell(number: float | None) -> str:
    return "—" if number is None else digits(number, 6)
