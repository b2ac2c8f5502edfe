"""A process force on a cam's follower, over the cam's angle, the time or the follower's way: smooth between its edges.

Its tables may jump where a place is given twice, as where a tool strikes. Between two edges each table is a polynomial,
so that forces are enclosed there as those of inertia and spring are.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import degrees
from typing import Any, NamedTuple

import numpy as np

from optlaws.cams.curves.motion_by_angle import CamMotion
from optlaws.cycles.specification.process import FORCES, ProcessEntries, rescaled
from optlaws.echo import shortened
from optlaws.errors import InputError, located
from optlaws.formulas.arithmetic import pieces
from optlaws.formulas.slopes import added, multiplied
from optlaws.formulas.tree import Formula, Name, Table, number, rebuilt, table_places
from optlaws.kept import kept_property
from optlaws.mechanisms.linkages.entries import TableKind, formula_of, table_numbers
from optlaws.motion.quantities import TURN
from optlaws.motion.smooth_stretches import jet_of_parts
from optlaws.numbers import Array
from optlaws.numerics.interval import Interval, exact
from optlaws.numerics.roots import bisect
from optlaws.numerics.taylor import Jet, variable
from optlaws.synthesis.limits.formula_jets import formula_jet
from optlaws.tolerances import CLOSURE

#: what a force may be over, with the name in formulas
VARIABLES = {"time": "t", "master": "m", "driven": "s"}


class ForceStretch(NamedTuple):
    """A range of the cam's angle, rad, in which the force is a smooth formula."""

    start: float
    stop: float
    formula: Formula


@dataclass(frozen=True)
class ProcessByAngle:
    """The force of a process on a follower over the cam's angle, N; a torque in N m on a follower that swings.

    It is above 0 where it pushes the follower along its way, off the cam.

    Parameters
    ----------
    motion
        Of the follower.
    stretches
        One after the other, over the whole motion; none where there is no process.
    name
        Of the variable in their formulas: "m", the cam's angle, or "s", the displacement.
    """

    motion: CamMotion
    stretches: tuple[ForceStretch, ...] = ()
    name: str = "m"

    @kept_property
    def edges(self) -> Array:
        """Angles between which it is smooth, rad."""
        return np.unique([place for stretch in self.stretches for place in stretch[:2]])

    def jet(self, angle: Array | Interval, order: int) -> Jet:
        """The force with its Taylor terms, taken from the stretch that contains an angle or an interval's midpoint."""
        if not isinstance(angle, Interval):
            return Jet(tuple(term.middle for term in self.jet(exact(self.motion.within(angle)), order).terms))
        if not self.stretches:
            return variable(angle, order) * 0.0

        def along(stretch: ForceStretch, at: Interval) -> Jet:
            place = variable(at, order) if self.name == "m" else self.motion.jet(at, order)
            return formula_jet(stretch.formula, self.name, place)

        return jet_of_parts(self.stretches, along, angle)


def read_process_by_angle(given: Mapping[str, Any] | None, motion: CamMotion, rate: float | None) -> ProcessByAngle:
    """A process force from its entries, as cycles have it on mechanisms; none without entries.

    `force`, or `torque` on a follower that swings, is a table, a formula or a quantity, above 0 where it pushes to
    greater displacements; `over` the "time" t from the beginning of the motion, the "master", which is the cam's angle
    m, or the displacement s of the "driven" follower. Over time and angle a table jumps where a place is given twice.

    Parameters
    ----------
    given
        The entries.
    motion
        Of the follower.
    rate
        The angular velocity of the cam, rad/s; None where there is a range of them, and then no force is over time.

    Raises
    ------
    InputError
        If an entry is unknown or wrong, or a table ends within the motion.
    """
    if given is None:
        return ProcessByAngle(motion)
    if not isinstance(given, Mapping):
        raise InputError(
            f"process must be entries such as {{'force': '-300 N', 'over': 'master'}}, got {shortened(given)}"
        )
    with located("process"):
        process = ProcessEntries.from_dict(given)
    kind, over, interpolation = process.kind, process.over, process.interpolation
    if FORCES[kind] != motion.axis:
        right = next(name for name, axis in FORCES.items() if axis == motion.axis)
        raise InputError(f"process: on this follower acts a {right}: give {right} in place of {kind}")
    if over == "time" and rate is None:
        raise InputError(
            "process: a force over time is another at each speed: give it over the 'master', the cam's angle"
        )
    name, dimension = VARIABLES[over], {"time": "time", "master": "angle"}.get(over, motion.axis)
    runs = _runs(process.given, (dimension, kind), f"process: {kind}", name, interpolation)
    if over == "driven":
        if len(runs) > 1:
            raise InputError(f"process: {kind}: over the follower's way its table gives a place twice: give it once")
        return ProcessByAngle(motion, tuple(_over_way(runs[0], motion)), "s")
    if over == "time":
        runs = [rescaled(run, "t", "m", (0.0, 1.0 / (rate or 1.0))) for run in runs]
    return ProcessByAngle(motion, tuple(_over_angle(runs, motion, kind)))


def _runs(
    given: Any,
    dimensions: tuple[str, str],
    name: str,
    variable_name: str,
    interpolation: TableKind,
) -> list[Formula]:
    """The formula, or the tables between jumps, where a place is given twice."""
    pairs = list(given.items()) if isinstance(given, Mapping) else given
    if not isinstance(pairs, list | tuple):
        return [formula_of(given, dimensions, name, variable=variable_name, interpolation=interpolation)]
    runs: list[list[tuple[float, float]]] = [[]]
    for place, value in table_numbers(list(pairs), dimensions, name):
        if runs[-1] and place == runs[-1][-1][0]:
            runs.append([])
        runs[-1].append((place, value))
    return [formula_of(run, dimensions, name, variable=variable_name, interpolation=interpolation) for run in runs]


def _over_angle(runs: list[Formula], motion: CamMotion, kind: str) -> list[ForceStretch]:
    """Smooth stretches of formulas of the cam's angle."""
    (first, last), breaks = motion.interval, np.array(motion.breaks)
    stretches: list[ForceStretch] = []
    for run in runs:
        places = [_snapped(place, breaks) for place in table_places(run, "m")]
        ends = (places[0], places[-1]) if isinstance(run, Table) else (first, last)
        within = [ends[0], *(place for place in places if ends[0] < place < ends[1]), ends[1]]
        stretches += [ForceStretch(*cell, _smooth_at(run, "m", 0.5 * sum(cell))) for cell in pairwise(within)]
    inside = [stretch for stretch in stretches if stretch.stop > first and stretch.start < last]
    whole = bool(inside) and inside[0].start <= first and inside[-1].stop >= last
    if not whole or any(each.stop != following.start for each, following in pairwise(inside)):
        shown = (f"{degrees(place):.6g}" for place in (stretches[0].start, stretches[-1].stop, first, last))
        raise InputError(
            "process: {}: its table goes from {} to {} deg of the cam, and the motion from {} to {} deg: give a table "
            "that ascends over the whole motion".format(kind, *shown)
        )
    return [each._replace(start=max(each.start, first), stop=min(each.stop, last)) for each in inside]


def _over_way(force: Formula, motion: CamMotion) -> list[ForceStretch]:
    """Smooth stretches of a formula of the displacement: between the angles at which it is at a place of a table."""
    edges: list[float] = []
    places = table_places(force, "s")
    for low, high in pairwise(motion.monotone_edges.tolist()):
        first, last = float(motion(low)), float(motion.jet(np.array(high), 0, before=True).terms[0])
        within = [place for place in places if min(first, last) < place < max(first, last)]
        edges += [
            low,
            *(
                _reached(motion, place, (low, high), rises=last > first)
                for place in within[:: 1 if last > first else -1]
            ),
        ]
    edges.append(motion.interval[1])
    middles = [0.5 * (low + high) for low, high in pairwise(edges)]
    formulas = (_smooth_at(force, "s", float(motion(middle))) for middle in middles)
    return [ForceStretch(*cell, formula) for cell, formula in zip(pairwise(edges), formulas, strict=True)]


def _reached(motion: CamMotion, place: float, ends: tuple[float, float], *, rises: bool) -> float:
    """The angle in a range of monotone motion at which the follower is at a position."""
    return bisect(lambda at: bool((motion(at) < place) == rises), *ends)[0]


def _snapped(place: float, breaks: Array) -> float:
    """A place, moved to a break of the motion if it differs from it by rounding only."""
    nearest = float(breaks[np.argmin(np.abs(breaks - place))])
    return nearest if abs(nearest - place) <= CLOSURE * TURN else place


def _smooth_at(formula: Formula, name: str, at: float) -> Formula:
    """A formula in which the polynomial that it is at a place stands for each table of a name."""
    if isinstance(formula, Table) and formula.of == Name(name):
        piece = int(np.clip(np.searchsorted(formula.places, at, side="right") - 1, 0, len(formula.places) - 2))
        step = added([Name(name), number(-formula.places[piece])])
        polynomial: Formula = number(0.0)
        for coefficient in pieces(formula)[piece, ::-1].tolist():
            polynomial = added([number(coefficient), multiplied([polynomial, step])])
        return polynomial
    if name not in formula.names():
        return formula
    return rebuilt(formula, [_smooth_at(part, name, at) for part in formula.parts])
