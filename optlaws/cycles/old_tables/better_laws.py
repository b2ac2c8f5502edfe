"""Better laws in the moves of a table: of least acceleration, within a tolerance of the old laws, from end to end."""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from math import inf, isfinite, nan
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial

from optlaws.cycles.old_tables.peak_intervals import PeakInterval
from optlaws.cycles.old_tables.standard import JUMP
from optlaws.cycles.old_tables.stretches import Stretch, law_of_move
from optlaws.errors import InfeasibleProblem, SolverFailure
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.tables.curve_pieces import law_of_curve
from optlaws.numbers import Array
from optlaws.numerics.bernstein import greatest_difference
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import at_most
from optlaws.synthesis.problem.windows import Window, via
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.spaces.bases import Chebyshev
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions

Ends = tuple[tuple[float, ...], tuple[float, ...]]

_JERK = 1.2  # of an old law's greatest jerk: what a law of less acceleration in its place may have
_RAMP = 0.1  # of a move: over so much of it a jump of the acceleration at its end is taken
_SAME = 1e-6  # of a greatest velocity or acceleration: what differs by less is the same
_LEAST_GAIN = 1e-3  # of an acceleration: for less no law is replaced, as the rounding of a table may show so much
_SETTLED = 1e-9  # of a tolerance: a law that is no farther beyond it is so by rounding alone
_PATIENT = 5  # rounds after which it may be ten times as far in each
_SYMMETRIC = 1e-6  # of a tolerance: by how much a law may differ from its mirror image
_FIRST = 8  # parts between the places with which the search begins
_APART = 2e-3  # of a move: places that are nearer to a new one give way to it
_ROUNDS = 15
_LOOKS = 800  # places at which the difference of two laws is looked at for its extremes
_FREE = 4  # the order up to which derivatives are left free at one end and given at the other
#: by which share of a jump of velocity it has changed at a share of the width about a corner
_BLENDS = Polynomial([0.0, 1.0]), Polynomial([0.0, 0.0, 3.0, -2.0])
_MOST = 0.25  # of a stroke: tolerances beyond it are none
HARDLY_KNOWN = 4.0  # times the least that an old peak may be: where it may be more the table does not tell it
_NONE = 1e-6  # of a new peak: what an old one is at least tells nothing


class MoveGain(NamedTuple):
    """The gain of a move over an old one, in units of the table.

    Attributes
    ----------
    kind
        "rise" or "return".
    start, stop
        Where it is, in units of the master.
    old, new
        The peaks of velocity, acceleration and jerk by the master; inf where one has no greatest value.
    deviation
        The greatest difference of positions, over the whole move.
    intervals
        Between which values the old peaks are by the table; empty where the old move is of no table.
    lower_bound, status
        What no acceleration within the tolerance is below, of laws of the order and degree, and the status of the new
        law: nan and "" where none was sought or found.

    Examples
    --------
    >>> round(MoveGain("rise", 0.0, 120.0, (1.0, 2.0, 3.0), (1.0, 1.5, 3.3), 0.05).share(2), 3)
    -0.25
    """

    kind: str
    start: float
    stop: float
    old: tuple[float, float, float]
    new: tuple[float, float, float]
    deviation: float
    intervals: tuple[PeakInterval, ...] = ()
    lower_bound: float = nan
    status: str = ""

    def shares(self, nu: int) -> tuple[float, float]:
        """The least and the greatest relative change of the peak of order nu, 1 to 3, that the table leaves open.

        Where the old peak cannot be known from the table the least one is nan, as the old one may be of any size; the
        greatest one is inf where the old peak may be 0.

        Examples
        --------
        >>> known = PeakInterval(0.9, 1.1), PeakInterval(1.6, 2.5), PeakInterval(2.5, float("inf"))
        >>> gain = MoveGain("rise", 0.0, 120.0, (1.0, 2.0, 3.0), (1.0, 1.5, 3.3), 0.05, known)
        >>> [round(share, 3) for share in gain.shares(2)], round(gain.shares(3)[1], 3)
        ([-0.4, -0.062], 0.32)
        """
        low, high = self.intervals[nu - 1] if self.intervals else (0.0, 0.0)
        if not high > 0.0:
            return self.share(nu), self.share(nu)
        new = self.new[nu - 1]
        return new / high - 1.0 if isfinite(high) else nan, new / low - 1.0 if low > _NONE * new else inf

    def share(self, nu: int) -> float:
        """The relative change of the peak of order nu, 1 to 3; nan if the old one is infinite, 0 or hardly known.

        Examples
        --------
        >>> spike = PeakInterval(0.01, 3.7)
        >>> MoveGain("rise", 0.0, 120.0, (0.2, 3.69, 79.0), (0.2, 0.19, 0.55), 0.05, (spike,) * 3).share(2)
        nan
        """
        old, new = self.old[nu - 1], self.new[nu - 1]
        low, high = self.intervals[nu - 1] if self.intervals else (old, old)
        if high > HARDLY_KNOWN * low:
            return nan
        return new / old - 1.0 if isfinite(old) and old > 0.0 else nan


def bettered(stretches: Sequence[Stretch], room: float, order: int, degree: int) -> list[Stretch]:
    """Stretches with the laws of least acceleration within a tolerance of theirs; moves without such say why.

    A new law begins and ends with the position and the velocity of the old one. Beside a dwell or constant velocity its
    further derivatives, as many as its order says, are 0; where two moves go on into each other they are those of both
    new laws, by the move of the greater acceleration. At a corner beside a dwell or constant velocity it has the
    velocity of this, where the tolerance allows it, and none is left; else its further derivatives are free there.
    """
    count = len(stretches)
    moves = [i for i, part in enumerate(stretches) if part.law is not None and part.corner is None]
    moves.sort(key=lambda i: -_acceleration(stretches[i]))
    # what these have where they go on into other moves is that of their old laws
    as_before = {i for i in moves if all(stretches[j % count].line is not None for j in (i - 1, i + 1))}
    reasons = dict[int, Stretch]()
    while True:
        better, known = list(stretches), set(as_before)
        for i in moves:
            part = _better(better, known, i, room, order, degree, as_before=i in as_before)
            # the first reason is that of its own tolerance, not of what its neighbours have
            unchanged = part.solution is None
            better[i] = reasons.setdefault(i, part) if unchanged else part
            known.add(i)
            if unchanged and i not in as_before:
                as_before.add(i)
                break
        else:
            return better


def _acceleration(part: Stretch) -> float:
    return law_of_move(part).constants.C.value * abs(part.stroke) / (part.stop - part.start) ** 2


def _better(
    stretches: Sequence[Stretch],
    known: Container[int],
    number: int,
    room: float,
    order: int,
    degree: int,
    *,
    as_before: bool,
) -> Stretch:
    """A move with a better law, between the known ones of others; or why it keeps its law."""
    part = stretches[number]
    old, share = law_of_move(part), room / abs(part.stroke)
    what = nothing_to_better(old)
    if what:
        return replace(part, reason=f"it is {what}")
    ends = _ends(stretches, known, number, order, as_before=as_before, corners=True)
    smooth = _ends(stretches, known, number, order, as_before=as_before, corners=False)
    if smooth != ends:
        without = _with_least(part, old, share, order, degree, smooth)
        if without.solution is not None:
            return without
        with_corner = _with_least(part, old, share, order, degree, ends)
        with_corner = replace(with_corner, reason=f"a corner stays, as {without.reason}")
        return _with_sufficient_tolerance(with_corner, old, share, order, degree, smooth)
    if any(abs(value) >= old.constants.C.value * (1.0 - _LEAST_GAIN) for state in ends for value in state[2:3]):
        return replace(part, reason="its acceleration is greatest where it goes on into the next move")
    better = _with_least(part, old, share, order, degree, ends)
    if better.solution is not None:
        return better
    return _with_sufficient_tolerance(better, old, share, order, degree, ends)


def _with_least(part: Stretch, old: MotionLaw, share: float, order: int, degree: int, ends: Ends) -> Stretch:
    """A move with the law of least acceleration between its ends, or why it keeps its law."""
    solution = _least_or_reason(old, share, order, degree, ends)
    if isinstance(solution, str):
        return replace(part, reason=solution)
    return replace(part, law=solution.law, solution=solution, peaks=())


def without_corners(stretches: Sequence[Stretch], room: float, order: int) -> list[Stretch]:
    """Stretches with the corners between lines taken away, each within a tolerance of it.

    Over a width w about a corner the velocity changes by v evenly, at most v w/8 off, or from order 3 on with
    continuous acceleration: by v (3u² - 2u³), at most 3 v w/32 off.
    """
    lines, blends = list(stretches), list[Stretch]()
    shape = _BLENDS[order > 2]
    for i, after in enumerate(stretches):
        before = stretches[i - 1]
        if before.line is None or after.line is None:
            continue
        jump = after.line - before.line
        if abs(jump) <= JUMP * max(abs(before.line), abs(after.line)):
            continue
        wide = min(_blend_width(shape, jump, room), before.stop - before.start, after.stop - after.start)
        lines[i - 1] = _shortened(lines[i - 1], 0.0, 0.5 * wide)
        lines[i] = _shortened(lines[i], 0.5 * wide, 0.0)
        blends += _blend(after.start, after.low, wide, before.line + jump * shape, stretches)
    long = [part for part in lines if part.stop - part.start > _SAME * (stretches[-1].stop - stretches[0].start)]
    return sorted([*long, *blends], key=lambda part: part.start)


def _blend_width(shape: Polynomial, jump: float, room: float) -> float:
    """Over which width a velocity changes by a jump, at most a tolerance off the corner, which it is in the middle."""
    return room / (float(shape.integ()(0.5)) * abs(jump))


def _blend_jerk(jump: float, room: float) -> float:
    """The greatest jerk where a velocity changes by a jump with continuous acceleration."""
    return abs(jump) * float(_BLENDS[1].deriv(2)(0.0)) / _blend_width(_BLENDS[1], jump, room) ** 2 if jump else 0.0


def _shortened(part: Stretch, first: float, last: float) -> Stretch:
    """A line without so much of its start and its end."""
    slope = part.line or 0.0
    return replace(
        part,
        start=part.start + first,
        stop=part.stop - last,
        low=part.low + first * slope,
        high=part.high - last * slope,
    )


def _blend(
    corner: float, height: float, wide: float, velocity: Polynomial, stretches: Sequence[Stretch]
) -> list[Stretch]:
    """The rises and returns of a velocity, by shares of a width about a corner; those before the turn at its end."""
    position = height - 0.5 * wide * velocity(0.0) + wide * velocity.integ()
    derivatives = position, velocity, velocity.deriv() / wide
    turn, advance = stretches[-1].stop - stretches[0].start, stretches[-1].high - stretches[0].low
    roots = np.atleast_1d(velocity.roots())
    turns = roots.real[(np.abs(roots.imag) < _SAME) & (roots.real > _SAME) & (roots.real < 1.0 - _SAME)].tolist()
    inner = [0.5] if corner in (stretches[0].start, stretches[-1].stop) else []
    nodes = [0.0, *inner, *(at for at in turns if all(abs(at - other) > _SAME for other in inner)), 1.0]
    parts = []
    for first, last in pairwise(sorted(nodes)):
        before = corner + wide * (last - 0.5) <= stretches[0].start
        start, stop = (corner + wide * (u - 0.5) + before * turn for u in (first, last))
        low, high = (float(position(u)) + before * advance for u in (first, last))
        law = law_of_curve(
            [first * wide, last * wide], high - low, [velocity.degree() + 1],
            lambda x, _, nu: np.asarray(derivatives[nu](x / wide)),
        )  # fmt: skip
        parts.append(Stretch("rise" if high > low else "return", start, stop, low, high, law, corner=corner))
    return parts


def nothing_to_better(old: MotionLaw) -> str:
    """What a law is whose acceleration or jerk is 0, so that none in its place has less; empty for any other law.

    >>> from optlaws import catalogue
    >>> nothing_to_better(catalogue["constant velocity"].law), nothing_to_better(catalogue["cycloidal"].law)
    ('at constant velocity, without acceleration or jerk', '')
    """
    if old.constants.C.value == 0.0:
        return "at constant velocity, without acceleration or jerk"
    return "at constant acceleration, without jerk" if old.constants.J.value == 0.0 else ""


def _ends(
    stretches: Sequence[Stretch], known: Container[int], number: int, order: int, *, as_before: bool, corners: bool
) -> Ends:
    """The states at the ends of a move: position and velocity, and as many further derivatives as are known.

    Without corners its velocity is that of the line beside it.
    """
    part = stretches[number]
    old, length = law_of_move(part), part.stop - part.start
    same = _SAME * old.constants.B.value
    states = []
    for place, state in enumerate(old.boundary_values(max(order, 2))):
        other = (number - 1 + 2 * place) % len(stretches)
        beside = stretches[other]
        if beside.line is not None:
            goes_on = [0.0, beside.line * length / part.stroke, *[0.0] * order]
        else:
            ratio, size = length / (beside.stop - beside.start), beside.stroke / part.stroke
            values = law_of_move(beside).boundary_values(max(order, 2))[1 - place]
            goes_on = [size * ratio**nu * value for nu, value in enumerate(values)]
        velocity = 0.0 if abs(state[1]) <= same else state[1]
        corner = abs(velocity - goes_on[1]) > same
        if corner and not corners and beside.line is not None:
            velocity, corner = goes_on[1], False
        further = state[2:] if corner or (as_before and beside.line is None) else goes_on[2:]
        open_end = corner or not (beside.line is not None or as_before or other == number or other in known)
        states.append((float(place), velocity, *([] if open_end and order <= _FREE else further))[:order])
    return states[0], states[1]


def _with_sufficient_tolerance(
    part: Stretch, old: MotionLaw, share: float, order: int, degree: int, ends: Ends
) -> Stretch:
    """A move with a tolerance within which a law is better, and by how much; as it is where none was found."""
    before = _acceleration_before(old, ends)
    while (share := 2.0 * share) <= _MOST:
        solution = _least_or_reason(old, share, order, degree, ends)
        if not isinstance(solution, str):
            less = 1.0 - solution.law.constants.C.value / before
            return replace(part, sufficient_tolerance=share * abs(part.stroke), sufficient_gain=less)
    return part


def _acceleration_before(old: MotionLaw, ends: Ends) -> float:
    """The peak of the acceleration of an old law; infinite where it has a corner at an end and a new one has none."""
    return inf if max(_velocity_changes(old, ends)) > _SAME * old.constants.B.value else old.constants.C.value


def _velocity_changes(old: MotionLaw, ends: Ends) -> list[float]:
    """By how much the velocities at given ends are others than those of an old law."""
    return [abs(was[1] - state[1]) for was, state in zip(old.boundary_values(2), ends, strict=True)]


@lru_cache(maxsize=256)
def _least_or_reason(old: MotionLaw, share: float, order: int, degree: int, ends: Ends) -> Solution | str:
    """The law of least acceleration within a share of the stroke of an old one, or why there is none."""
    try:
        return _least(old, share, order, degree, ends) or f"none of order {order} and degree {degree} so near has less"
    except InfeasibleProblem:
        return f"no law of order {order} and degree {degree} is so near"
    except SolverFailure:
        return f"the search for a law of order {order} and degree {degree} so near failed"


def _least(old: MotionLaw, share: float, order: int, degree: int, ends: Ends) -> Solution | None:
    """The law of least acceleration within a share of the stroke of an old one; None where none has less.

    It is found by cutting planes: windows at few places, which others join where a law is too far. They have
    the tolerance itself, so that the bound of the solution is that of all laws within it; less by twice what rounding
    leaves a law beyond it at last. Its jerk is bounded by that of the old law, or by what takes its jumps at the ends
    over a part of the move, and corners over the width that the tolerance allows. The acceleration of an old law with a
    corner that the new one has not is infinite.
    """
    C, J, corners = _acceleration_before(old, ends), old.constants.J.value, _velocity_changes(old, ends)
    jumps = [abs(was[2] - now) for was, state in zip(old.boundary_values(3), ends, strict=True) for now in state[2:3]]
    jerk = _JERK * max([J, *(jump / _RAMP for jump in jumps), *(_blend_jerk(jump, share) for jump in corners)])
    same = min(len(state) for state in ends)
    known = [
        via(quantity, value, at=state[0]) for state in ends for quantity, value in zip("cj", state[same:], strict=False)
    ]
    conditions = BoundaryConditions(*(state[:same] for state in ends))
    k = np.linspace(0.0, 0.5, _LOOKS)
    turned = np.abs(np.asarray(old(k)) + np.asarray(old(1.0 - k)) - 1.0)
    # the mean of a law and its mirror image is no worse
    symmetric = conditions == BoundaryConditions.rest(order) and float(turned.max()) <= _SYMMETRIC * share
    basis = Chebyshev(degree + 2 * (order - same))
    places = 0.5 - 0.5 * np.cos(np.pi * np.arange(1, _FIRST) / _FIRST)
    solution, room = None, share
    for count in range(_ROUNDS):
        places = places[places < 0.5] if symmetric else places
        heights = np.asarray(old(places))
        windows = [
            Window("a", height - room, height + room, k, k)
            for k, height in zip(places.tolist(), heights.tolist(), strict=True)
        ]
        problem = Problem(
            basis=basis, symmetric=symmetric, boundary=conditions, J=at_most(jerk) if isfinite(jerk) else None,
            windows=(*known, *windows),
        )  # fmt: skip
        solution = synthesize(problem, start=solution)
        law = solution.law
        if law.constants.C.value >= C * (1.0 - _LEAST_GAIN):
            return None
        apart, farthest = _farthest(law, old)
        if apart <= share:
            return solution
        if apart <= share * (1.0 + _SETTLED * 10.0 ** max(count - _PATIENT, 0)):
            room -= 2.0 * (apart - share)
            continue
        beyond = _beyond(law, old, share, farthest)
        binding = np.abs(np.asarray(law(places)) - heights) > 0.95 * room
        near = np.abs(places[:, None] - beyond).min(axis=1) <= _APART
        places = np.sort(np.concatenate([places[binding & ~near], beyond]))
    raise SolverFailure("the places where a law is at its tolerance do not settle", problem=problem)


def _beyond(law: MotionLaw, old: MotionLaw, share: float, farthest: float) -> Array:
    """Where the difference of two laws has a maximum of more than a share; one place is where it is greatest."""
    k = np.linspace(0.0, 1.0, _LOOKS)
    apart = np.abs(np.asarray(law(k)) - np.asarray(old(k)))
    before, here, after = apart[:-2], apart[1:-1], apart[2:]
    tops = (here > share) & (here >= before) & (here > after)
    bend = (before - 2.0 * here + after)[tops]
    parabolas = k[1:-1][tops] + 0.5 * k[1] * (before - after)[tops] / bend
    return np.append(parabolas[np.abs(parabolas - farthest) > k[1]], farthest)


def gain(new: Stretch, old: Stretch) -> MoveGain:
    """The gain of a move over the old move in its place."""
    size, length, known = abs(old.stroke), old.stop - old.start, new.solution
    proof = (known.lower_bound * size / length**2, known.status.value) if known else (nan, "")
    off = size * deviation(law_of_move(new), law_of_move(old))
    return MoveGain(old.kind, old.start, old.stop, peaks_of(old), peaks_of(new), off, old.peaks, *proof)


def peaks_of(part: Stretch) -> tuple[float, float, float]:
    """The peaks of velocity, acceleration and jerk in a move, by the master; inf where one has no greatest value."""
    known, size, length = law_of_move(part).constants, abs(part.stroke), part.stop - part.start
    return known.B.value * size / length, known.C.value * size / length**2, known.J.value * size / length**3


def deviation(law: MotionLaw, other: MotionLaw) -> float:
    """The greatest difference of two laws over the whole of k."""
    return _farthest(law, other)[0]


def _farthest(law: MotionLaw, other: MotionLaw) -> tuple[float, float]:
    """The greatest difference of two laws, and where it is."""
    size, place = greatest_difference(law, other, np.unique([0.0, 1.0, *law.breaks, *other.breaks]))
    return abs(size), place
