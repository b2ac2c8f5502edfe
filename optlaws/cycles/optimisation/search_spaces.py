"""The spaces in which the laws of a cycle are optimised: splines over joined segments, and their names in words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from math import ceil, inf

from optlaws.cycles.specification.joints import LawSpan
from optlaws.cycles.specification.programme import is_optimal
from optlaws.errors import InputError
from optlaws.motion.piece import factor
from optlaws.motion.quantities import Kind
from optlaws.numbers import MOST_PIECES
from optlaws.synthesis.problem.constants import FUNCTIONALS, RootMeanSquare
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.windows import Window, via
from optlaws.synthesis.spaces.bases import Pieces, PolynomialBasis
from optlaws.synthesis.spaces.periodic_pieces import PeriodicPieces
from optlaws.tolerances import AGREEMENT

_MOST, _LEAST = 600, 3  # pieces of a law, and of a motion even so: fewer may not bend as its ends require
#: pieces of a stretch where what is minimised has its peaks inside of pieces: the velocity, what a load does, power
_FEW = {Kind.VELOCITY: 6, Kind.LOAD: 4, Kind.POWER: 4}
_ALL_MOTIONS = "all motions through the joints"


def joined_basis(span: LawSpan, order: int, degree: int, minimised: Kind) -> Pieces:
    """Splines with twice as many pieces in a stretch as a law with Z of a degree has coefficients and end conditions.

    Their acceleration is linear between breaks where the order is 3, so that its peaks, and those of the jerk, are at
    breaks: a linear program on known places.

    >>> from optlaws import Cycle, Dwell, Free
    >>> motions = [Dwell("0.1 s"), Free("30 mm", "0.2 s"), Free("-30 mm")]
    >>> (solution,) = Cycle(motions, period="0.5 s").solutions
    >>> len(solution.problem.basis.breaks), solution.problem.basis.degree
    (49, 3)
    """
    curved = sum(len(points) - 1 for bends, points in _points(span) if bends)
    most = min(2 * (degree + order), max(_LEAST, _MOST // curved))
    if _LEAST * curved > MOST_PIECES:
        raise InputError(
            f"{len(span.stretches)} motions through {len(span.via)} points are one law, of at most {MOST_PIECES} "
            "pieces: put a dwell or a move between them, where velocity and acceleration are known"
        )
    each = most if minimised not in _FEW else max(1, min(most, _FEW[minimised] * (degree + order) // 12))
    fastest = _least_velocity(span)
    breaks, straight = [0.0], list[int]()
    for bends, points in _points(span):
        if not bends:
            straight.append(len(breaks) - 1)
            breaks.append(span.place(points[-1][0]))
            continue
        for (low, y), (high, z) in pairwise(points):
            parts = ceil(each / (len(points) - 1))
            if minimised is Kind.VELOCITY:
                turning = _pieces_to_turn(abs(z - y) / (high - low), fastest, order)
                parts = max(parts, min(turning, ceil(most / (len(points) - 1))))
            begin, end = span.place(low), span.place(high)
            breaks += [begin + (end - begin) * i / parts for i in range(1, parts)] + [end]
    smoothness = max(order - 1, minimised.order - 1, 1)
    power = max(3, minimised.order, 2 * order - 1 if minimised is Kind.LOAD else order)
    return PeriodicPieces(breaks, power, smoothness, straight) if span.turns else Pieces(breaks, power, smoothness)


def _least_velocity(span: LawSpan) -> float:
    """A lower bound of the peak velocity of a span: the greatest mean between two points, or a known value."""
    steps = [(low, y, high, z) for _, points in _points(span) for (low, y), (high, z) in pairwise(points)]
    means = [abs(z - y) / (high - low) for low, y, high, z in steps if high > low]
    known = (abs(state.velocity) for state in (span.first, span.last, *span.states) if state is not None)
    return max(0.0, *means, *known)


def _points(span: LawSpan) -> Iterator[tuple[bool, list[tuple[float, float]]]]:
    """Of each stretch whether it bends, and the times and positions that it passes, its ends among them."""
    position = span.offset
    for stretch, start, stop in span.timed:
        passed = [(start, position), *(point for point in span.via if start < point[0] < stop)]
        position += stretch.displacement
        yield is_optimal(stretch.given), [*passed, (stop, position)]


def _pieces_to_turn(mean: float, fastest: float, order: int) -> int:
    """How many pieces let a velocity have a mean, whatever it is at both ends, and never be above the `fastest`.

    Splines with order - 2 continuous derivatives of b go from one constant velocity to another in order - 1 pieces of
    equal length, and have the mean of both there. With n pieces, between ends at the fastest, a mean of
    -(1 - 2 (order - 1) / n) times it is left. A mean that is the fastest itself needs none, for b is constant.
    """
    left = 1.0 - mean / fastest
    return 1 if left <= AGREEMENT else ceil(2 * (order - 1) / left)


def halved(basis: Pieces) -> Pieces | None:
    """Splines with every piece but straight ones cut in two; None if the pieces become too many.

    >>> halved(Pieces((0.0, 0.5, 1.0), 3, 1)).breaks
    (0.0, 0.25, 0.5, 0.75, 1.0)
    """
    if 2 * len(basis.breaks) > _MOST:
        return None
    stiff = set(basis.straight) if isinstance(basis, PeriodicPieces) else set[int]()
    breaks, straight = [0.0], list[int]()
    for i, (low, high) in enumerate(pairwise(basis.breaks)):
        if i in stiff:
            straight.append(len(breaks) - 1)
        else:
            breaks.append(0.5 * (low + high))
        breaks.append(high)
    if isinstance(basis, PeriodicPieces):
        return replace(basis, breaks=tuple(breaks), straight=tuple(straight))
    return replace(basis, breaks=tuple(breaks))


def joint_windows(span: LawSpan, order: int) -> Iterator[Window]:
    """Positions at joints and on the way, and what is known of velocities and accelerations at joints of a cycle."""
    for time, position in span.via:
        yield via("a", (position - span.origin) / span.stroke, at=span.place(time))
    bends = [is_optimal(stretch.given) for stretch in span.stretches]
    for i, state in enumerate(span.states):
        for nu, value in enumerate([*state, 0.0][: order - 1] if state is not None else (), start=1):
            # after a straight stretch the velocity is that of its start; beside one there is no acceleration
            if bends[i - 1] and (nu == 1 or bends[i]):
                yield via("abcj"[nu], value / factor(span.stroke, span.duration, nu), at=span.place(span.starts[i]))


def minimised_rms(problem: Problem) -> int | None:
    """The order of the derivative whose root mean square a problem minimises; None if it minimises something else."""
    constant = FUNCTIONALS.get(problem.minimise) if isinstance(problem.minimise, str) else None
    return constant.nu if isinstance(constant, RootMeanSquare) else None


def search_space(problem: Problem, span: LawSpan, order: int, fastest: float = inf) -> str:
    """The laws, in words, among which the solution of a span's problem is the best; `fastest` is its greatest velocity.

    No motion has a greatest velocity below its greatest mean. A polynomial of degree 2 nu - 1 between two joints has
    the least root mean square of the derivative of order nu, if its ends have no more than nu conditions each.
    """
    nu, basis = minimised_rms(problem), problem.basis
    if problem.minimise == "B" and fastest <= _least_velocity(span) * (1.0 + AGREEMENT):
        return _ALL_MOTIONS
    if isinstance(basis, Pieces):
        if nu is not None and basis == splines_of_least_rms(span, order, nu):
            return _ALL_MOTIONS
        return f"splines of degree {basis.degree} in {len(basis.breaks) - 1} pieces"
    degree = basis.degree if isinstance(basis, PolynomialBasis) else 0
    rich = nu is not None and problem.order <= nu and 2 * nu <= 2 * problem.order + degree + 1
    if rich and not (problem.bounded or problem.windows or problem.monotone):
        return _ALL_MOTIONS
    return f"laws of order {problem.order} with Z of degree {degree}"


def remark_on_degrees(problems: Sequence[tuple[LawSpan, Problem]], degree: int) -> tuple[str, ...]:
    """The remarks on spans whose Z has another degree than the requested degree."""
    return tuple(
        f"{span.where}: Z has the degree {basis.degree}, not {degree}, for the velocities at its ends"
        for span, basis in ((span, problem.basis) for span, problem in problems)
        if isinstance(basis, PolynomialBasis) and basis.degree != degree
    )


def splines_of_least_rms(span: LawSpan, order: int, nu: int) -> Pieces | None:
    """The splines that hold the motion of least root mean square of the derivative of order nu, of all motions.

    They are of degree 2 nu - 1 with breaks at the joints alone, and as smooth as can be but where more than the
    position is known. None where such a motion would violate the end conditions of the order: then none is the best.

    >>> from optlaws import Cycle, Dwell, Free
    >>> motions = [Dwell("0.1 s"), Free("30 mm", "0.2 s"), Free("-30 mm")]
    >>> (solution,) = Cycle(motions, period="0.5 s", minimise="rms jerk").solutions
    >>> solution.problem.basis
    Pieces(breaks=(0.0, 0.5, 1.0), degree=5, continuity=4)
    """
    known = not span.turns or any(state is not None for state in span.states)
    if order > (nu if known else 2 * nu - 1):
        return None
    times = sorted({*span.starts, *(time for time, _ in span.via), span.stop})
    breaks = [span.place(time) for time in times]
    if not span.turns:
        return Pieces(breaks, 2 * nu - 1, 2 * nu - 2)
    straight = [times.index(start) for stretch, start, _ in span.timed if not is_optimal(stretch.given)]
    return PeriodicPieces(breaks, 2 * nu - 1, nu - 1 if known else 2 * nu - 2, straight)
