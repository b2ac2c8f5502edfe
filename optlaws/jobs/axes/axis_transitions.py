"""Run-ins and run-outs of axes, as the job "cycle" reads, tables, draws, exports and stores them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Measured, Whole
from optlaws.errors import InfeasibleProblem, InputError
from optlaws.files.tables import Cell, to_csv
from optlaws.motion.display_units import UNITS
from optlaws.motion.quantities import QUANTITIES
from optlaws.numbers import Quantity
from optlaws.results import Page, Results

if TYPE_CHECKING:
    from optlaws.cycles.cycle import Cycle
    from optlaws.cycles.moves.transition_cam import TransitionCam, TransitionKind

TRANSITIONS = "transitions.json"
_ABOUT = "Table and picture begin where the cam does: at {:.9g} deg of the cycle's master, until {:.9g} deg."


@declared
class TransitionEntries(Declared, title="a run-in or run-out"):
    """A cam from rest into the cycle of an axis, or out of it."""

    at: Quantity = entry(
        Measured("angle", "time"), "The angle of the master, or time, at which it meets the cycle.", example="60 deg"
    )
    rest: Quantity | None = entry(
        Measured("length", "angle"), "The position of rest; where the cycle starts unless given.", default=None
    )
    over: Quantity | None = entry(
        Measured("angle", "time"),
        "The angle of the master, or time, that it takes; the least within the limits unless given.",
        default=None,
    )
    order: int | None = entry(
        Whole(), "How much is continuous where they meet; that of the axis unless given.", default=None
    )


class AxisTransition(NamedTuple):
    """A run-in or run-out of an axis, under the name that its files have."""

    name: str
    axis: str
    cycle: Cycle
    cam: TransitionCam

    @property
    def title(self) -> str:
        first, last = self.cam.master
        return f"{self.axis}, {self.cam.kind} from {first:.6g} to {last:.6g} deg"


#: run-ins and run-outs by the names of their files: the axis, the kind and the entries
Named: TypeAlias = "dict[str, tuple[str, TransitionKind, TransitionEntries]]"


def transition_names(
    given: Mapping[str, Mapping[TransitionKind, Sequence[TransitionEntries]]], plain: Mapping[str, str]
) -> Named:
    """The names of the files of run-ins and run-outs, numbered where an axis has several of a kind."""
    names: Named = {}
    for axis, kinds in given.items():
        for kind, entries in kinds.items():
            for i, cam in enumerate(entries, start=1):
                number = f"_{i}" if len(entries) > 1 else ""
                names[f"{plain[axis]}_{kind.replace('-', '_')}{number}"] = (axis, kind, cam)
    return names


def transitions_of(names: Named, cycles: Mapping[str, Cycle], file: Path) -> list[AxisTransition]:
    """The run-ins and run-outs of axes; errors name the file, the axis and the cam."""
    cams = []
    for name, (axis, kind, given) in names.items():
        cycle = cycles[axis]
        try:
            cam = (cycle.run_in if kind == "run-in" else cycle.run_out)(**given.to_dict())
        except (InputError, InfeasibleProblem) as error:
            raise type(error)(f"{file}: axis {axis}: {kind}: {error}") from None
        cams.append(AxisTransition(name, axis, cycle, cam))
    return cams


def add_transitions(result: Page, title: str, transitions: Sequence[AxisTransition]) -> None:
    """Put run-ins and run-outs on a page."""
    for transition in transitions:
        result.heading(transition.title).figure(transition.name, f"{title}: {transition.title}")
        result.text(_ABOUT.format(*transition.cam.master))
        result.facts(transition.cam.summary(), places="s")


def write_transitions(results: Results, title: str, transitions: Sequence[AxisTransition], rows: int) -> None:
    """Put the tables, the pictures and the proofs of run-ins and run-outs into results."""
    if not transitions:
        return
    from optlaws.plots.moves import transition_figure

    for name, _, cycle, cam in transitions:
        results.text(f"{name}.csv", _table(cam, rows, results.about))
        results.picture(name, transition_figure(cam, cycle, f"{title}: {cam.kind}"))
    results.data(TRANSITIONS, {transition.name: transition.cam.claims() for transition in transitions})


def transition_facts(transitions: Sequence[AxisTransition]) -> dict[str, Any]:
    """Data of run-ins and run-outs for programs, in SI units; empty if there are none."""
    known = {name: _facts(cam) for name, _, _, cam in transitions}
    return {"transitions": known} if known else {}


def _facts(cam: TransitionCam) -> dict[str, Any]:
    return {
        "kind": cam.kind,
        "master": list(cam.master),
        "duration": cam.duration,
        "rest": cam.rest,
        "status": cam.status.value,
        "none_below": None if cam.least is None else cam.least.none_below,
        **{name: cam.peak(nu) for nu, name in enumerate(QUANTITIES) if nu},
        "jumps": cam.jumps,
    }


def _table(cam: TransitionCam, rows: int, about: str) -> str:
    """Angle, time, position, velocity, acceleration and jerk at equal steps over the cam, as CSV."""
    units = UNITS[cam.axis]
    times = np.linspace(0.0, cam.duration, rows)
    columns = [np.linspace(*cam.master, rows), times]
    columns += [factor * cam.piece.values(times, nu) for nu, (_, factor) in enumerate(units)]
    headings = (f"{name}, {unit}" for name, (unit, _) in zip(QUANTITIES, units, strict=True))
    cells: list[list[Cell]] = [list(row) for row in zip(*(column.tolist() for column in columns), strict=True)]
    return to_csv(["master, deg", "time, s", *headings], cells, about=about)
