"""The best laws of a cycle with given durations: one problem for each span, each with its status and its proof.

Where durations are fixed and spans are parted by joints that are known, the cycle decouples: the greatest of the least
peaks is the least of the greatest ones, and the least sum of squares is the sum of the least ones.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby
from math import inf
from operator import itemgetter
from typing import Any

from optlaws.cycles.asked.conversion import Piece, factor
from optlaws.cycles.asked.joints import Span, State
from optlaws.cycles.asked.programme import AXES, Stretch, in_small_units, is_optimal
from optlaws.cycles.asked.quantities import quantity
from optlaws.cycles.asked.segments import Free, Move
from optlaws.cycles.drive import Drive
from optlaws.cycles.joined import joined_basis, joint_windows, place
from optlaws.cycles.load import LOAD, Load, load_output
from optlaws.errors import InfeasibleProblem, InputError
from optlaws.suggest import unknown_key
from optlaws.synthesis.functionals.makers import peak, rms
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.spaces.bases import Chebyshev
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions

#: what may be least over a cycle: the order of the derivative, and whether it is its root mean square
OBJECTIVES = {
    "velocity": (1, False),
    "acceleration": (2, False),
    "jerk": (3, False),
    "rms acceleration": (2, True),
    "rms jerk": (3, True),
    "force": (-1, False),
    "rms force": (-1, True),
}
LIMITS = {"velocity": 1, "acceleration": 2, "jerk": 3, "force": -1, "torque": -1}
FORCE, LOADED = -1, -2
_PEAKS = {1: "B", 2: "C", 3: "J"}
_FORCES = {"length": "force", "angle": "torque"}
_ROUGH = 15  # degree of Z where points on the way or velocities bend the law


@dataclass(frozen=True)
class Wanted:
    """What is least over a cycle, the limits of the whole of it, and how rich laws are.

    Parameters
    ----------
    minimise
        One of `OBJECTIVES`.
    limits
        Greatest velocity, acceleration and jerk, in SI units, by order; of force or torque by -1.
    order, degree
        End conditions of laws, and the degree of Z.
    drive
        What the force is of, where it is minimised or bounded.
    load
        What is driven elastically.
    loaded
        Greatest values of the load's outputs, in SI units, by output and whether they are root mean squares.
    """

    minimise: str
    limits: Mapping[int, float]
    order: int
    degree: int
    drive: Drive | None
    load: Load | None = None
    loaded: Mapping[tuple[str, bool], float] = field(default_factory=dict)

    @property
    def of_load(self) -> bool:
        """Whether the load is spoken of, so that the cycle is one problem."""
        return bool(self.loaded) or kind_of(self.minimise)[0] == LOADED


def kind_of(minimise: str) -> tuple[int, bool]:
    """The order of the derivative that is minimised (-1 a force, -2 of the load), and whether its root mean square.

    Examples
    --------
    >>> kind_of("rms jerk"), kind_of("load acceleration")
    ((3, True), (-2, False))
    """
    return OBJECTIVES.get(minimise, (LOADED, minimise.startswith("rms ")))


def check_objective(minimise: Any, load: Load | None) -> None:  # noqa: ANN401 - it is checked here
    """Refuse what cannot be minimised.

    Raises
    ------
    InputError
        If it is no objective, or the load has no such output.
    """
    if not isinstance(minimise, str) or (minimise not in OBJECTIVES and load_output(minimise, load) is None):
        raise InputError(f"minimise: {unknown_key(minimise, (*OBJECTIVES, 'load acceleration'), 'objective')}")


def read_load_limits(entries: Mapping[str, Any], load: Load | None) -> dict[tuple[str, bool], float]:
    """Those of limits that are of the load, in SI units, by output and whether they are root mean squares.

    Raises
    ------
    InputError
        If the load has no such output, or a limit is not above 0 or of another dimension.

    Examples
    --------
    >>> from optlaws.cycles.load import read_load
    >>> read_load_limits({"load deflection": "2 mm"}, read_load({"period": "20 ms"}, "length"))
    {('deflection', False): 0.002}
    """
    found = {}
    for name, value in entries.items():
        asked = load_output(name, load)
        if asked is not None and load is not None:
            found[asked] = load.limit(value, asked[0], f"limits, {name}")
    return found


def read_limits(entries: Mapping[str, Any], axis: str, where: str) -> dict[int, float]:
    """Limits in SI units by the order of the derivative.

    Raises
    ------
    InputError
        If a name is unknown, or a limit is not above 0 or of another dimension.

    Examples
    --------
    >>> read_limits({"velocity": "616 mm/s"}, "length", "limits")
    {1: 0.616}
    """
    found = {}
    for name, value in entries.items():
        if name not in LIMITS:
            if where == "limits" and name.removeprefix("rms ").startswith(LOAD):
                continue
            raise InputError(f"{where}: {unknown_key(name, LIMITS, 'limit')}")
        dimension = _FORCES[axis] if LIMITS[name] == FORCE else AXES[axis][LIMITS[name]]
        found[LIMITS[name]] = quantity(value, dimension, f"{where}, {name}")
        if found[LIMITS[name]] <= 0.0:
            raise InputError(f"{where}, {name} must be above 0, got {value!r}")
    return found


def limits_of_stretch(one: Stretch, wanted: Wanted, axis: str) -> dict[int, float]:
    """Limits of a segment by order: its own and those of the whole cycle, whichever is less."""
    entries = one.given.limits if isinstance(one.given, Move | Free) else {}
    given = read_limits(entries, axis, f"{one.where}: limits")
    orders = {*wanted.limits, *given}
    infinite = float("inf")
    return {nu: min(wanted.limits.get(nu, infinite), given.get(nu, infinite)) for nu in sorted(orders)}


def solve(span: Span, wanted: Wanted, axis: str) -> tuple[Piece, Solution]:
    """The best law of a span, in its place, with its proof.

    Raises
    ------
    InfeasibleProblem
        If no law keeps the limits; the error names the segment.
    """
    stroke = scale(span)
    problem = span_problem(span, wanted, axis, stroke)
    try:
        solution = synthesize(problem)
    except InfeasibleProblem as error:
        raise InfeasibleProblem(
            f"{span.where}: no law keeps its limits in {span.duration:.9g} s: give it more time or wider limits. "
            f"{error.args[0]}",
            problem=problem,
            tried=error.tried,
            proof=error.proof,
        ) from None
    return Piece(span.start, span.duration, span.offset, stroke, solution.law), solution


def scale(span: Span) -> float:
    """What a span's law is measured by: its displacement, or where it has none how far it gets on the way."""
    if span.displacement:
        return span.displacement
    ways = [abs(position - span.offset) for _, position in span.via]
    known = (one for one in (span.first, span.last, *span.states) if one is not None)
    ways += [abs(state.velocity) * span.duration for state in known]
    return max(ways, default=0.0)


def span_problem(span: Span, wanted: Wanted, axis: str, stroke: float) -> Problem:
    """The dimensionless problem of a span.

    Raises
    ------
    InputError
        If nothing moves, or a limit is less than what the ends ask.
    """
    if stroke == 0.0:
        raise InputError(f"{span.where} has nothing to move: take a Dwell")
    if span.turns or len(span.stretches) > 1 or span.via:
        return _problem_of_several(span, wanted, axis, stroke)
    ends = _ends(span, stroke, wanted.order)
    plain = not any(any(one[1:]) for one in (ends.start, ends.end))
    bounds, parts = _limits(span, wanted, axis, stroke)
    forced = kind_of(wanted.minimise)[0] == FORCE or any(constant not in _PEAKS.values() for constant in bounds)
    return Problem(
        order=wanted.order,
        basis=Chebyshev(wanted.degree if plain else max(wanted.degree, _ROUGH)),
        minimise=_objective(span, wanted, stroke),
        monotone=forced and wanted.drive is not None and wanted.drive.dry > 0.0,
        symmetric=plain and not forced and not parts,
        boundary=ends,
        windows=parts,
        bounds=bounds,
    )


def _problem_of_several(span: Span, wanted: Wanted, axis: str, stroke: float) -> Problem:
    """One law for several stretches, or through points on the way."""
    bounds, parts = _limits(span, wanted, axis, stroke)
    minimised = max(kind_of(wanted.minimise)[0], 3 if 3 in wanted.limits else 0)
    minimised = LOADED if wanted.of_load else minimised
    bounds |= {_of_load(wanted, *asked, span): Range(0.0, most / abs(stroke)) for asked, most in wanted.loaded.items()}
    first = (span.offset - span.origin) / stroke
    plain = BoundaryConditions((first,), (first + span.displacement / stroke,))
    return Problem(
        order=1 if span.turns else wanted.order,
        basis=joined_basis(span, wanted.order, wanted.degree, minimised),
        minimise=_objective(span, wanted, stroke),
        symmetric=False,
        boundary=plain if span.turns else _ends(span, stroke, wanted.order),
        windows=(*joint_windows(span, wanted.order, stroke), *parts),
        bounds=bounds,
    )


def _ends(span: Span, stroke: float, order: int) -> BoundaryConditions:
    first, last = (_end(state, span.duration, stroke, order) for state in (span.first, span.last))
    return BoundaryConditions((0.0, *first), (span.displacement / stroke, *last))


def _end(state: State, duration: float, stroke: float, order: int) -> tuple[float, ...]:
    values = [value / factor(stroke, duration, nu) + 0.0 for nu, value in enumerate(state, start=1)]
    return tuple((values + [0.0] * order)[: order - 1])


def _limits(span: Span, wanted: Wanted, axis: str, stroke: float) -> tuple[dict[Any, Range], tuple[Window, ...]]:
    """Limits of the whole span as bounds of its constants, those of parts of it as windows."""
    _check_mean(span, wanted, axis)
    of_each = [limits_of_stretch(one, wanted, axis) if is_optimal(one.given) else None for one in span.stretches]
    sought = [one for one in of_each if one is not None]
    if all(one == sought[0] for one in sought) and _straight_within(span, sought[0].get(1, inf)):
        return dict(_bound(span, wanted, stroke, nu, most) for nu, most in sought[0].items()), ()
    windows = []
    for own, start, stop in _alike(of_each, (*span.starts, span.stop)):
        for nu, most in own.items():
            name, high = "abcj"[nu], _law_limit(span, stroke, nu, most)
            if nu == FORCE:
                name, unit = _force(span, wanted, stroke)
                high = most / unit
            windows.append(Window(name, -high, high, place(span, start), place(span, stop)))
    return {}, tuple(windows)


def _bound(span: Span, wanted: Wanted, stroke: float, nu: int, most: float) -> tuple[Any, Range]:
    """A limit of a whole span as a bound of one of its constants."""
    if nu == FORCE:
        formula, unit = _force(span, wanted, stroke)
        return peak(formula), Range(0.0, most / unit)
    return _PEAKS[nu], Range(0.0, _law_limit(span, stroke, nu, most))


def _of_load(wanted: Wanted, output: str, mean: bool, span: Span) -> Functional:  # noqa: FBT001 - the second of a pair
    if wanted.load is None:
        raise AssertionError  # what is asked of a load is read with it
    return wanted.load.constant(output, span.duration, mean=mean)


def _straight_within(span: Span, most: float) -> bool:
    """Whether uniform motions keep a limit of the velocity."""
    times = zip(span.stretches, span.starts, (*span.starts[1:], span.stop), strict=True)
    return all(is_optimal(one.given) or abs(one.displacement) <= most * (stop - start) for one, start, stop in times)


def _alike(
    of_each: Sequence[dict[int, float] | None], times: Sequence[float]
) -> Iterator[tuple[dict[int, float], float, float]]:
    """Limits of stretches from where to where they are the same."""
    for limits, several in groupby(zip(of_each, times, times[1:], strict=False), key=itemgetter(0)):
        parts = list(several)
        if limits is not None:
            yield limits, parts[0][1], parts[-1][2]


def _check_mean(span: Span, wanted: Wanted, axis: str) -> None:
    """Refuse a limit of the velocity that is no more than the mean velocity: such a law cannot even start from rest."""
    for one, start, stop in zip(span.stretches, span.starts, (*span.starts[1:], span.stop), strict=True):
        most = limits_of_stretch(one, wanted, axis).get(1) if is_optimal(one.given) else None
        mean = abs(one.displacement) / (stop - start)
        if most is not None and mean >= most:
            raise InfeasibleProblem(
                f"{one.where}: {in_small_units(abs(one.displacement), axis)} in {stop - start:.9g} s are "
                f"{in_small_units(mean, axis)}/s on average, but its velocity is to be at most "
                f"{in_small_units(most, axis)}/s: give it more time or a wider limit"
            )


def _law_limit(span: Span, stroke: float, nu: int, most: float) -> float:
    return most / abs(factor(stroke, span.duration, nu))


def _objective(span: Span, wanted: Wanted, stroke: float) -> Any:  # noqa: ANN401 - a name or a constant
    nu, mean = kind_of(wanted.minimise)
    if nu > 0:
        return {2: "rms_c", 3: "rms_j"}[nu] if mean else _PEAKS[nu]
    asked = load_output(wanted.minimise, wanted.load) if nu == LOADED else None
    if asked is not None:
        return _of_load(wanted, *asked, span)
    formula, _ = _force(span, wanted, stroke)
    return rms(formula) if mean else peak(formula)


def _force(span: Span, wanted: Wanted, stroke: float) -> tuple[str, float]:
    """The force along a span's law as a formula, and its unit."""
    if wanted.drive is None:
        raise InputError("force and torque are of a drive: give one, such as drive={'mass': '2 kg'}")
    if wanted.drive.dry > 0.0 and (span.turns or len(span.stretches) > 1 or span.via):
        raise InputError(
            f"drive: dry: {span.where} may turn back, where dry friction leaps and nothing is proven: leave it out of "
            "what is minimised or bounded, or take moves between rests"
        )
    direction = 1.0 if span.displacement > 0.0 else -1.0
    unit = force_unit(span, wanted.drive, stroke)
    if unit == 0.0:
        raise InputError("drive: nothing resists the motion: give it a mass, an inertia, a spring or friction")
    return wanted.drive.formula(stroke, span.duration, span.origin, direction, unit), unit


def force_unit(span: Span, drive: Drive, stroke: float) -> float:
    """About how great the force along a span is: a unit in which it is near 1."""
    return drive.size(stroke, span.duration, span.origin)
