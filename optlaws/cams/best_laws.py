"""Laws that are best for their cam: least acceleration under limits of the cam, and the least prime circle of all laws.

Under a slide with a roller a limit of the pressure angle, |s' - e| <= tan(alpha) (height + s), is linear in the law,
and so is rho = r0 + s + s'' under a flat face: such laws are proven optimal as all others are. For an arm with a roller
the limit is s' <= G(s) with a sine G: laws below lines under it are solutions, laws below lines over it give the bound.

The radius of curvature under a roller is not convex in the law: see `roller_curvature`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from math import ceil, sqrt
from typing import Any, NamedTuple, TypeAlias

from optlaws.cams.curves.motion_by_angle import as_motion
from optlaws.cams.disc import DiscCam, Turning, sense
from optlaws.cams.followers.contact import CURVATURE, PRESSURE, FollowerContact, LinearLimit
from optlaws.cams.followers.follower import CamFollower, Place, shown
from optlaws.cams.least_sizes import CamLimits, LeastPrimeCircle, least_prime_circle
from optlaws.cams.roller_curvature import RollerCurvature, curvature_of
from optlaws.cycles.cycle import Cycle, Plan
from optlaws.cycles.optimisation.objectives import SUMS, kind_of
from optlaws.cycles.optimisation.optimal import span_problem, unlimited, with_places
from optlaws.cycles.optimisation.span_values import known_drive, size_of
from optlaws.cycles.specification.limits import Side, amount
from optlaws.entries.declared import documented_by
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.kept import kept_property
from optlaws.motion.piece import Piece, factor
from optlaws.motion.quantities import MILLI, QUANTITIES, TURN, TURN_DEG, Kind
from optlaws.numbers import NumberOrQuantity
from optlaws.sentences import Amount, joined, sentence
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.expression import maximum
from optlaws.synthesis.problem.fields import CONSTANTS
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import synthesize
from optlaws.synthesis.status import Status

_CAM_GAIN = 1e-4  # of an objective: a round that gains less is the last


class SolvedPiece(NamedTuple):
    """A piece of a cycle with its law, and its solution if the law is optimised."""

    piece: Piece
    solution: Solution | None


Solved: TypeAlias = list[SolvedPiece]


class CamBound(NamedTuple):
    """A lower bound of laws for a cam, the status of these laws, and the solutions whose bounds it is of."""

    lower_bound: float
    status: Status
    solutions: tuple[Solution, ...]


_WIDER = "make the prime circle larger, the limits wider, or the motion longer"

_ROUNDS = 8
_TENTHS = 10.0  # of a mm: what a prime circle that is advised is rounded up to
#: the constants of velocity, acceleration and jerk
_DERIVATIVES = "BCJ"


@dataclass(frozen=True)
class BestCam:
    """The cam whose law is best under limits of the cam.

    Attributes
    ----------
    cam
        With its laws.
    objective
        The value of the cycle's objective over the whole cycle; SI units.
    solutions
        The solutions of the single motions, with their proofs.
    proof
        What gives the lower bound and the status, which are computed where they are needed.
    """

    cam: DiscCam
    objective: float
    solutions: tuple[Solution, ...]
    proof: Callable[[], CamBound] = field(repr=False, compare=False)

    @property
    def lower_bound(self) -> float:
        """What no other laws of this order and degree in the same times that keep the limits can beat."""
        return self._proven.lower_bound

    @property
    def status(self) -> Status:
        """Optimal where the lower bound meets the objective."""
        return self._proven.status

    @property
    def bounding(self) -> tuple[Solution, ...]:
        """The solutions whose bounds are the lower bound: of the same motions under lines above the limits."""
        return self._proven.solutions

    @kept_property
    def _proven(self) -> CamBound:
        return self.proof()


@dataclass(frozen=True)
class BestPrimeCircle:
    """The least prime circle of all laws.

    Attributes
    ----------
    least
        The least prime circle of these laws, proven for them.
    lower_bound
        What no laws of this order and degree in the same times can beat, m.
    solutions
        The solutions of the single motions, with their proofs.
    """

    least: LeastPrimeCircle
    lower_bound: float
    solutions: tuple[Solution, ...]


@documented_by(CamLimits)
def best_cam(
    cycle: Cycle,
    prime_radius: NumberOrQuantity,
    follower: CamFollower,
    *,
    pressure_angle: NumberOrQuantity | None = None,
    radius_of_curvature: NumberOrQuantity | None = None,
    turning: Turning = "counterclockwise",
) -> BestCam:
    """The optimal laws of a cycle under limits of its cam, at a given prime circle.

    Displacements stay between those of the cycle's joints. The curvature under a roller is no convex limit of the law:
    where the best laws without it break it, laws within it are computed and, up to degrees of 15 or so, proven by a
    search over boxes, which takes some seconds.

    Parameters
    ----------
    cycle
        Its optimal motions are optimised again; its objective and its limits stay.
    prime_radius, follower, turning
        As of a `DiscCam`.

    Raises
    ------
    InputError
        If there is no such mechanism, no limit, or nothing is optimal in the cycle.
    InfeasibleProblem
        If no law keeps them; with proof, where they are linear in the law.
    SolverFailure
        If the search yields no law within a limit that is not convex, though none was shown not to exist.

    Examples
    --------
    >>> from optlaws import TranslatingRoller
    >>> from optlaws import Dwell, Return, Rise
    >>> cycle = Cycle([Rise("35 mm", "120 deg"), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()], speed="200 rpm")
    >>> free = best_cam(cycle, "50 mm", TranslatingRoller("12 mm"), pressure_angle="60 deg")
    >>> bound = best_cam(cycle, "50 mm", TranslatingRoller("12 mm"), pressure_angle="26 deg")
    >>> round(free.objective, 4), bound.status.value, round(bound.objective, 4)
    (21.8838, 'optimal', 23.5665)
    """
    limits = CamLimits(pressure_angle, radius_of_curvature).of_one()
    given = DiscCam(cycle, prime_radius, follower, turning=turning)
    known = _with_solutions(cycle)
    if limits.proven(given.extremes):  # the best laws without the limits keep them
        return BestCam(
            given,
            cycle.objective,
            cycle.solutions,
            lambda: CamBound(_total(cycle, known), cycle.status, tuple(cycle.solutions)),
        )
    _refuse_radius_of_no_law(cycle, given, limits.radius)
    within = _solved(cycle, given, limits.in_si, below=True)
    inner = _with_curvature(cycle, given, limits.radius, within)
    plan = _plan(cycle, inner)
    cam = replace(given, motion=plan)
    if broken := limits.broken(cam.extremes):
        raise SolverFailure(
            sentence(
                "the best laws go beyond limits that are not convex in them: {}; {}",
                joined("; ", broken.values()),
                _circle_within(plan, given, limits),
            )
        )
    exact = bounds_are_of_all(cam.contact, limits)
    return _bounded_by(plan, cam, lambda: inner if exact else _beyond(cycle, given, limits))


def _circle_within(plan: Plan, cam: DiscCam, limits: CamLimits) -> str:
    """The prime circle on which laws satisfy limits that they exceed on a smaller one, as a remedy."""
    try:
        least = least_prime_circle(plan, cam.follower, **limits.to_dict(), turning=cam.turning).radius
    except (InfeasibleProblem, InputError):
        return "make the prime circle larger, or drop a limit"
    enough = Amount(ceil(MILLI * least * _TENTHS) / _TENTHS, "mm")
    return sentence("these laws satisfy them on a prime circle of {}: make it as large, or drop a limit", enough)


def cam_of_laws(
    plan: Plan, cam: DiscCam, bounding: Sequence[Solution] = (), lower_bound: float | None = None
) -> BestCam:
    """The cam of laws that are known, with the bound that solutions of its motions give, their own unless others are.

    Earlier files state a `lower_bound` without them.
    """
    known = _with_solutions(plan.with_solutions(bounding) if bounding else plan)
    return _bounded_by(plan, cam, lambda: known, lower_bound)


def _bounded_by(plan: Plan, cam: DiscCam, bounded: Callable[[], Solved], known: float | None = None) -> BestCam:
    def proof() -> CamBound:
        solved = bounded()
        least = _total(plan, solved) if known is None else known
        status = Status.OPTIMAL if plan.objective - least <= 1e-6 * plan.objective else Status.LOCAL
        return CamBound(least, status, tuple(each.solution for each in solved if each.solution is not None))

    return BestCam(cam, plan.objective, tuple(plan.solutions), proof)


def with_tight_bounds(plan: Plan) -> Plan:
    """The plan with the tight bound of the motion of the greatest power, and of the next if that has less then.

    The other motions take less power whatever their bounds.
    """
    objective, tried = plan.specification.in_si, set[int]()
    kind, drive = objective.kind, known_drive(objective.drive)
    while True:
        sizes = [size_of(piece, kind, drive, mean=objective.mean) for _, piece, _ in plan.laws]
        first, solutions = max(range(len(sizes)), key=sizes.__getitem__), list(plan.solutions)
        if first in tried or solutions[first].status != Status.LOCAL:
            return plan
        tried.add(first)
        solutions[first] = synthesize(solutions[first].problem, bound="tight")
        plan = plan.with_solutions(solutions)


def bounds_are_of_all(contact: FollowerContact, limits: CamLimits) -> bool:
    """Whether the problems of laws under limits of a cam have these limits themselves, and not lines within them."""
    return contact.linear or limits.pressure_angle is None


def bounds_hold(plan: Plan, bounding: Sequence[Solution], cam: DiscCam, limits: CamLimits) -> bool:
    """Whether the bounds of solutions of a plan's motions are those of all its laws that keep the limits of its cam.

    They are where each solution is of the problem of its motion, or of this problem with limits of the cam, or with
    lines above these.
    """
    objective, contact = plan.specification.in_si, cam.contact
    for (span, piece, _), solution in zip(plan.laws, bounding, strict=True):
        known = [span_problem(span, objective)]
        lines = linear_limits(piece, contact, limits.in_si, plan.duration, below=False)
        known.append(_problem(known[0], [limit.window() for limit in lines], ()))
        bend = None if limits.radius is None else curvature_of(piece, contact, limits.radius, plan.duration)
        known += [] if bend is None else [replace(known[1], windows=(*known[1].windows, bend.window()))]
        if solution.problem not in known:
            return False
    return True


@documented_by(CamLimits)
def best_prime_circle(
    cycle: Cycle,
    follower: CamFollower,
    *,
    pressure_angle: NumberOrQuantity | None = None,
    radius_of_curvature: NumberOrQuantity | None = None,
    turning: Turning = "counterclockwise",
) -> BestPrimeCircle:
    """The least prime circle that any laws of a cycle's optimal motions allow.

    What a prime circle needs at an angle is linear in the law, so that its greatest value is a convex objective. The
    radius of curvature under a roller is no part of it: the prime circle of these laws keeps it, and is above the lower
    bound where it needs more for it.

    Parameters
    ----------
    cycle
        Its limits and its given laws stay; its optimal motions are optimised again.
    follower
        A roller on a slide, with a limit of the pressure angle, or a flat face on a slide, with one of the radius.
    turning
        As of a `DiscCam`.

    Raises
    ------
    InputError
        If the follower is another, or the limit of its kind is missing.
    InfeasibleProblem
        If no law keeps the limits of the cycle.

    Examples
    --------
    >>> from optlaws import TranslatingFlat
    >>> from optlaws import Dwell, Return, Rise
    >>> cycle = Cycle([Rise("10 mm", "70 deg"), Return("10 mm", "70 deg"), Dwell()], speed="3000 rpm")
    >>> best = best_prime_circle(cycle, TranslatingFlat(), radius_of_curvature="3 mm")
    >>> round(1e3 * best.least.radius, 4), round(1e3 * best.lower_bound, 4)
    (10.1341, 10.1341)
    """
    limits = CamLimits(pressure_angle, radius_of_curvature).of_one().in_si
    limit = follower.sizing_limit
    if limit is None:
        raise InputError(
            "follower: the least prime circle of all laws is computed for rollers and flat faces on slides alone"
        )
    contact = _unit_contact(cycle, follower, sense(turning))
    if limit not in limits:
        raise InputError(f"the least prime circle of all laws under this follower takes the limit {_NAMED[limit]}")
    sizing = {limit: limits[limit]}
    solutions = []
    for piece, solution in _with_solutions(cycle):
        if solution is not None:
            excesses = _excesses(piece, contact, sizing, cycle.duration)
            solutions.append(synthesize(_problem(solution.problem, (), excesses)))
    plan = cycle.with_solutions(solutions)
    return prime_circle_of_laws(
        plan, follower, pressure_angle=pressure_angle, radius_of_curvature=radius_of_curvature, turning=turning
    )


@documented_by(CamLimits)
def prime_circle_of_laws(
    plan: Plan,
    follower: CamFollower,
    *,
    pressure_angle: NumberOrQuantity | None = None,
    radius_of_curvature: NumberOrQuantity | None = None,
    turning: Turning = "counterclockwise",
) -> BestPrimeCircle:
    """The least prime circle of laws that need the least, with the bound that their own bounds give.

    Parameters
    ----------
    plan
        The laws, as `best_prime_circle` finds them.
    follower, turning
        Those of `best_prime_circle`.
    """
    given = CamLimits(pressure_angle, radius_of_curvature)
    limit, contact = follower.sizing_limit, _unit_contact(plan, follower, sense(turning))
    sizing = {name: size for name, size in given.in_si.items() if name == limit}
    needs = []
    for piece, solution in _with_solutions(plan):
        if solution is None:
            excesses = _excesses(piece, contact, sizing, plan.duration)
            needs += [abs(piece.stroke) * excess.value(piece.law) for excess in excesses]
        else:
            needs.append(abs(piece.stroke) * solution.lower_bound)
    least = least_prime_circle(plan, follower, **given.to_dict(), turning=turning)
    # the unit contact is 1 m high, and what is needed goes beyond that
    return BestPrimeCircle(least, follower.prime_radius(1.0 + max(needs)), tuple(plan.solutions))


def _excesses(piece: Piece, contact: FollowerContact, limits: dict[str, float], period: float) -> list[Functional]:
    """By how much a piece goes beyond the limits of a follower at a height."""
    return [limit.excess() for limit in linear_limits(piece, contact, limits, period, below=True)]


_NAMED = {PRESSURE: "pressure_angle='30 deg'", CURVATURE: "radius_of_curvature='5 mm'"}


def _unit_contact(cycle: Cycle | Plan, follower: CamFollower, turning: float) -> FollowerContact:
    """The contact of a follower 1 m above the cam's centre."""
    motion = as_motion(cycle, follower.axis)
    return follower.contact(Place(follower.prime_radius(1.0), *motion.range, motion.slopes, turning))


def linear_limits(
    piece: Piece, contact: FollowerContact, limits: dict[str, float], period: float, *, below: bool
) -> list[LinearLimit]:
    """The limits of a cam as linear limits of a piece's law, in a turn of a period; none of a dwell."""
    if piece.stroke == 0.0:
        return []
    return contact.linear_limits(piece, limits, TURN * piece.duration / period, below=below)


def _with_solutions(cycle: Cycle | Plan) -> Solved:
    """The pieces of a cycle, each with the solution of its problem if its law is optimal."""
    if not cycle.solutions:
        raise InputError("cycle: none of its laws is optimised: leave the law of a move out, or give law='optimal'")
    if kind_of(cycle.minimise)[0] in (*SUMS, Kind.LOAD):
        kinds = "a peak or a root mean square of the motion, the force or the power"
        raise InputError(f"cycle: minimise {kinds}, not the {cycle.minimise}")
    known = {id(solution.law): solution for solution in cycle.solutions}
    return [SolvedPiece(piece, known.get(id(piece.law))) for piece in cycle.pieces]


def _solved(cycle: Cycle, cam: DiscCam, limits: dict[str, float], *, below: bool) -> Solved:
    """The pieces with laws that keep lines below the limits, or above them."""
    solved: Solved = []
    for piece, solution in _with_solutions(cycle):
        if solution is None:
            solved.append(SolvedPiece(piece, None))
            continue
        best = _best(piece, solution.problem, cam.contact, limits, cycle.duration, below=below)
        for _ in range(_ROUNDS if below and not cam.contact.linear else 0):
            guide, last = replace(piece, law=best.law), best.objective
            best = _best(guide, solution.problem, cam.contact, limits, cycle.duration, below=True)
            if best.objective > last * (1.0 - _CAM_GAIN):
                break
        solved.append(SolvedPiece(replace(piece, law=best.law), best))
    return solved


def _refuse_radius_of_no_law(cycle: Cycle, cam: DiscCam, radius: float | None) -> None:
    """Refuse a least radius in m that no law gives the profile, as far as ends of the motions say so."""
    for piece, solution in _with_solutions(cycle):
        curvature = None if radius is None else curvature_of(piece, cam.contact, radius, cycle.duration)
        if solution is None or curvature is None:
            continue
        why, rest = "", curvature.at_rest()
        if rest is not None:
            why = f"where the follower rests the profile has {shown(rest - cam.contact.roller)}, whatever the law"
        elif curvature.is_out_of_reach():
            why = "no path that bends so little goes so far out in so short a turn"
        if why:
            raise InfeasibleProblem(
                f"no law {_from(piece, cycle.duration)} keeps the least radius of curvature: {why}: make the prime "
                "circle larger, the least radius smaller, or the motion longer",
                problem=solution.problem,
            )


def _with_curvature(cycle: Cycle, cam: DiscCam, radius: float | None, within: Solved) -> Solved:
    """The pieces with laws whose profile keeps a least radius in m under a roller."""
    met: Solved = []
    for known in within:
        curvature = None if radius is None else curvature_of(known.piece, cam.contact, radius, cycle.duration)
        if known.solution is None or curvature is None or not curvature.broken():
            met.append(known)
            continue
        best = _solved_with_curvature(known.solution.problem, curvature)
        met.append(SolvedPiece(replace(known.piece, law=best.law), best))
    return met


def _beyond(cycle: Cycle, cam: DiscCam, limits: CamLimits) -> Solved:
    """The pieces with solutions whose bounds are those of all laws, by lines above the limits of the pressure angle."""
    beyond = _solved(cycle, cam, limits.in_si, below=False)
    try:
        return _with_curvature(cycle, cam, limits.radius, beyond)
    except SolverFailure:
        return beyond


def _solved_with_curvature(problem: Problem, curvature: RollerCurvature) -> Solution:
    try:
        return synthesize(replace(problem, windows=(*problem.windows, curvature.window())), bound="tight")
    except (InfeasibleProblem, SolverFailure):
        raise SolverFailure(
            f"no law was found {_from(curvature.piece, curvature.period)} that keeps the least radius of curvature, "
            f"and under this follower its limit is not convex in the law: {_WIDER}"
        ) from None


def _from(piece: Piece, period: float) -> str:
    return f"from {piece.start:.6g} s ({TURN_DEG * piece.start / period:.6g} deg) on"


def _best(
    guide: Piece, problem: Problem, contact: FollowerContact, limits: dict[str, float], period: float, *, below: bool
) -> Solution:
    """The best law between lines, which touch the limits where a guiding law is."""
    windows = [limit.window() for limit in linear_limits(guide, contact, limits, period, below=below)]
    try:
        return synthesize(_problem(problem, windows, ()))
    except InfeasibleProblem as error:
        where, remedy = _from(guide, period), _limit_in_the_way(guide, problem, windows, contact) or _WIDER
        if below and not contact.linear:
            raise SolverFailure(
                sentence("no law was found {} that keeps the limits of the cam: {}", where, remedy)
            ) from None
        raise InfeasibleProblem(
            sentence("no law {} keeps the limits of the cam with those of the motion: {}", where, remedy),
            problem=error.problem,
            tried=with_places(error.tried, guide.start, guide.start + guide.duration, period),
            proof=error.proof,
        ) from None


def _limit_in_the_way(guide: Piece, problem: Problem, windows: Sequence[Window], contact: FollowerContact) -> str:
    """The limit of the motion without which laws keep those of the cam, with what it would have to be, or nothing."""
    axis = "length" if contact.pivot is None else "angle"
    for nu, name in enumerate(_DERIVATIVES, 1):
        limit = problem.range(name)
        if limit is None:
            continue
        others: dict[str, Any] = {each: problem.range(each) for each in CONSTANTS if each != name}
        bounds = {constant: allowed for constant, allowed in problem.bounds.items() if constant.name != name}
        free = replace(unlimited(problem), **others, bounds=bounds, minimise=name)
        try:
            gentlest = synthesize(_problem(free, windows, ()))
        except (InfeasibleProblem, SolverFailure):
            continue
        size = factor(abs(guide.stroke), guide.duration, nu)
        allowed, needed = (amount(Side(Kind(nu)), size * each, axis) for each in (limit.high, gentlest.objective))
        text = "the limit of its {} is {}, and laws are found from {} on: allow more, or {}"
        return sentence(text, QUANTITIES[nu], allowed, needed, _WIDER)
    return ""


def _problem(problem: Problem, windows: Sequence[Window], objectives: Sequence[Functional]) -> Problem:
    """A problem with the limits of a cam, whose law stays between its ends, or with an objective of its cam."""
    minimise: Any = problem.minimise
    if objectives:
        minimise = maximum(*objectives) if len(objectives) > 1 else objectives[0]
    inside = Window("a", 0.0, 1.0)
    return replace(problem, symmetric=False, minimise=minimise, windows=(*problem.windows, *windows, inside))


def _total(cycle: Cycle | Plan, solved: Solved) -> float:
    """The objective of a cycle whose pieces have their lower bounds, or else the constants of their laws."""
    (kind, mean), sizes = kind_of(cycle.minimise), []
    if not kind.order:
        return _plan(cycle, solved).lower_bound or 0.0
    nu = kind.order
    for piece, solution in solved:
        if solution is not None:
            constant = solution.lower_bound
        else:
            constant = 0.0 if piece.stroke == 0.0 else piece.law.rms(nu) if mean else piece.law.peak(nu).value
        sizes.append((piece.duration, abs(piece.stroke) / piece.duration**nu * constant))
    if mean:
        return sqrt(sum(time * size**2 for time, size in sizes) / cycle.duration)
    return max(size for _, size in sizes)


def _plan(cycle: Cycle | Plan, solved: Solved) -> Plan:
    """The cycle with the solutions of its pieces, whose force or power is that of its drive."""
    return cycle.with_solutions([best.solution for best in solved if best.solution is not None])
