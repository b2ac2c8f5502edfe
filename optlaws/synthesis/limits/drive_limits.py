"""Limits of drives of a mechanism: the least peak or RMS torque, energy or time, with a certificate."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from math import inf, isinf, nextafter, sqrt
from typing import Any, get_args

import numpy as np

from optlaws.echo import shortened
from optlaws.entries import value_types
from optlaws.entries import value_types as types
from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Choice, Listed
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.files.reading import check_names, of_known_format
from optlaws.formulas.reading import read
from optlaws.kept import kept_property
from optlaws.numbers import Array, not_negative, positive, power_of_two
from optlaws.synthesis.limits.integrated import value_of
from optlaws.synthesis.limits.phase_plane import AnyTorque, PhasePlane, TorqueLimit, torque_of
from optlaws.synthesis.limits.phase_plane_bound import Guess, Potential, even_price, proven_bound
from optlaws.synthesis.limits.phase_plane_program import PhaseOptimum, optimum
from optlaws.synthesis.limits.plane_of_problem import DriveObjective, plane_of, within_jerk
from optlaws.synthesis.limits.standing import Standing, least_energy, standing_level, standing_sign
from optlaws.synthesis.problem.problem import Problem
from optlaws.tolerances import INTEGRATION, STATED_BOUND

_PHASE_WEIGHT = 1e-9  # of what is minimised: the price of the time where the torque at rest alone bounds it
_MEAN_WEIGHT = 1e-5  # likewise, where the mean of the load on a part of the way is what bounds it
_MOST_PHASE_GAP = 1e-2  # of a limit in the phase plane: what leaves less is not mended by more fall
_SMALL_PHASE_GAP = 1e-6  # of a limit: more is looked for on finer elements

_NUMBERS = Listed(value_types.Number())

#: by which shares of its size a potential falls more where it proves little
_STEEPER = (0.0, 1e-8, 1e-6, 1e-4)
#: of the level about which a torque is squared, where that of the load proves little
_SHARES = (0.5, 0.0)
#: where a gap is not small: how often a program is solved, from how many times as many elements, up to which gap
_FINER = ((3, 4, inf), (3, 8, 1e-3), (4, 4, 1e-4))
#: positions at which a mean of the load is looked for that is above a bound
_LOOKS = 512
#: times the time that is given within which a load beyond a torque is proven not to be moved
LONG = 2.0**20


@declared
class DriveLimit(Declared, title="a drive's limit"):
    """A limit for laws from rest to rest that never turn back, of any degree and kind.

    Examples
    --------
    >>> limit = drive_limit("c", "peak torque", B=1.8)
    >>> round(limit.value, 5), limit.gap < 1e-6, DriveLimit.from_json(limit.to_json()) == limit
    (4.05, True, True)
    """

    writes_defaults = True

    minimise: DriveObjective = entry(Choice(*get_args(DriveObjective)), "Of what.")
    value: float = entry(
        types.Number(absent=-inf),
        "The proven lower bound, dimensionless, rounded down; minus infinity of an energy that nothing bounds.",
    )
    attained: float = entry(
        types.Number(absent=inf),
        "The value of the motion of the limit, by integration; the infimum is between both. Infinite where no motion "
        "within the bounds is known.",
    )
    plane: PhasePlane = entry(ValueOf(PhasePlane), "The torques and the bounds, divided by `unit`.")
    unit: float = entry(
        types.Number(above=0.0),
        "A power of 2, by which torques are divided; of the least time, one by which times are.",
    )
    weight: float = entry(types.Number(least=0.0), "Of the certificate: the multiplier of the time.")
    edges: tuple[float, ...] = entry(_NUMBERS, "The ends of the pieces of the potential of the equation of motion.")
    potential: tuple[tuple[float, ...], ...] = entry(Listed(_NUMBERS), "The Bernstein coefficients of these pieces.")
    s: tuple[float, ...] = entry(_NUMBERS, "Places of the best motion, where a = sin²(pi s/2).")
    b: tuple[float, ...] = entry(_NUMBERS, "Its velocities there.")
    level: float = entry(
        types.Number(), "What the mean torque adds: the level about which a torque is squared.", default=0.0
    )
    price: float = entry(types.Number(), "The price of the mean where a peak is minimised.", default=0.0)
    near: float = entry(
        types.Number(least=0.0),
        "The peak, dimensionless, at which the inner minimum is taken; 0 where none is minimised.",
        default=0.0,
    )

    @property
    def gap(self) -> float:
        """The difference between the motion of the limit and the bound, as a share of the bound."""
        if self.attained == self.value:
            return 0.0
        return (self.attained - self.value) / abs(self.value) if self.value and abs(self.value) < inf else inf

    @kept_property
    def bound(self) -> float:
        """The lower bound, computed from the certificate alone with every rounding counted."""
        return _bound(self)

    def is_of(self, problem: Problem) -> bool:
        """Whether the limit belongs to a problem's objective within its bounds, with those that its jerk implies."""
        known = plane_of(problem)
        if known is None or known[1:] != (self.minimise, self.unit):
            return False
        return self.plane in [known[0], *within_jerk(known[0], problem)]

    def velocity(self, a: Any) -> Array:
        """The velocity of the best motion at positions, dimensionless.

        Examples
        --------
        >>> drive_limit("c", "peak torque", B=1.8).velocity([0.0, 0.5, 1.0]).round(3)
        array([0. , 1.8, 0. ])
        """
        from scipy.interpolate import PchipInterpolator

        given = np.asarray(a, dtype=np.float64)
        s = 2.0 / np.pi * np.arcsin(np.sqrt(np.clip(given, 0.0, 1.0)))
        places = np.array(self.s)
        shape = PchipInterpolator(places, np.array(self.b) / np.sin(np.pi * places), extrapolate=True)
        return np.asarray(shape(s) * np.sin(np.pi * s))

    def motion(self) -> tuple[Array, Array, Array]:
        """Times k from 0 to 1 of the best motion, with its positions and velocities there.

        Examples
        --------
        >>> k, a, b = drive_limit("c", "peak torque", B=1.8).motion()
        >>> bool(abs(a[k < 0.25] - 2.025 * k[k < 0.25] ** 2).max() < 1e-3)
        True
        """
        from scipy.interpolate import PchipInterpolator

        places, b = np.array(self.s), np.array(self.b)
        # the time passes with s at a finite rate, even at the ends
        rate = PchipInterpolator(places, np.sin(np.pi * places) / b, extrapolate=True).antiderivative()
        s = np.concatenate([[0.0], places, [1.0]])
        share = (rate(s) - rate(0.0)) / (rate(1.0) - rate(0.0))
        return np.asarray(share), np.sin(0.5 * np.pi * s) ** 2, np.concatenate([[0.0], b, [0.0]])

    @classmethod
    def from_dict(cls, data: Any) -> DriveLimit:
        """The limit that `to_dict` described, its bound computed again.

        Raises
        ------
        InputError
            If the data is no such limit, or claims more than its certificate proves.
        """
        limit = cls.stated(data)
        if wrong := limit.contradiction():
            raise InputError(wrong)
        return limit

    @classmethod
    def stated(cls, data: Any) -> DriveLimit:
        """The limit as its data states it, whether or not its certificate and its motion have its numbers.

        Raises
        ------
        InputError
            If the data is no such limit.
        """
        limit = super().from_dict(data)
        _check(limit)
        return limit

    @classmethod
    def _from_earlier(cls, data: dict[str, Any]) -> dict[str, Any]:
        return of_known_format(data, cls.named)

    def contradiction(self) -> str:
        """What is stated that the certificate or the motion does not have; empty where all of it agrees."""
        if self.value > self.bound and not _near(self.value, self.bound):
            return f"the value {self.value!r} is above what its certificate proves, {self.bound!r}"
        known = _attained(self)
        if not _near(self.attained, known):
            return f"attained is {self.attained!r}, and its motion has {known!r}"
        return ""


def drive_limit(
    torque: str,
    minimise: DriveObjective = "peak torque",
    *,
    B: float = inf,
    C: float = inf,
    P: float = inf,
    recovered: float = 0.0,
) -> DriveLimit:
    """The least peak or RMS torque, energy or time of all motions of a drive from rest to rest that never turn back.

    Parameters
    ----------
    torque
        The torque over a, b and c, such as `drive_torque` writes down: inertia times c, and parts with 1, b and b²,
        whose factors depend on the position a alone.
    minimise
        "peak torque", "rms torque", "energy" (the integral of the positive power, without what is recovered) in the
        time 1, or "time" for the stroke 1.
    B, C, P
        Bounds of the velocity, the acceleration and the torque.
    recovered
        Which share of the braking power is used again, 0 to 1; of the energy alone.

    Raises
    ------
    InputError
        If the torque is of another form, an inertia is below 0, or nothing keeps the acceleration finite.
    InfeasibleProblem
        If no motion keeps the bounds in the time 1; the error states the least time.
    SolverFailure
        If the conic program was not solved.

    Examples
    --------
    >>> limit = drive_limit("(1 + 0.6*a^2)*c + 0.6*a*b^2 + 3*a", "rms torque", B=2.2)
    >>> round(limit.value, 5), limit.gap < 1e-6
    (3.40484, True)
    """
    check_names([minimise], get_args(DriveObjective), "minimise")
    form = phase_torque(torque)
    share = not_negative(recovered, "recovered")
    if share > 1.0:
        raise InputError(f"recovered must be a share from 0 to 1, got {recovered!r}")
    B, C, P = (bound if bound == inf else positive(bound, name) for bound, name in ((B, "B"), (C, "C"), (P, "P")))
    unit = form.size
    form = form.scaled(1.0 / unit)
    plane = PhasePlane(limits=(TorqueLimit(form, P / unit),) if inf > P else (), B=B, C=C)
    if minimise == "peak torque":
        plane = replace(plane, peak=form)
    elif minimise == "rms torque":
        plane = replace(plane, squared=form)
    elif minimise == "energy":
        plane = replace(plane, maxima=((form, form.scaled(share)),))
    return limit_of_plane(plane, minimise, unit)


def phase_torque(torque: str) -> AnyTorque:
    """The torque of a text, in the form of the phase plane."""
    form = torque_of(read(torque, ("a", "b", "c", "k")))
    if form is None:
        raise InputError(
            "a torque in the phase plane is I*c + S*b^2 + R*b + T with factors of a alone, or such torques and the "
            f"greater of two, got {shortened(torque)}: give loads over the position a, not over k"
        )
    return form


def planes_of_proof(plane: PhasePlane, limit: DriveLimit) -> list[PhasePlane]:
    """The planes of which a limit may be that of a move in a plane, or the proof that it is impossible there."""
    if limit.minimise == "time":
        return [plane.slowed(limit.unit)]
    return [plane, *(free for _, free in _without_limits(plane) if limit.minimise == "peak torque")]


def _without_limits(plane: PhasePlane) -> Iterator[tuple[TorqueLimit, PhasePlane]]:
    """Greatest torques in the whole stroke, and planes of LONG times the time in which these have a least peak."""
    slow = replace(plane, limits=()).slowed(LONG)
    for limit in plane.limits:
        if limit.everywhere and not limit.side and limit.fall >= 0.0:
            yield limit, replace(slow, peak=limit.torque.slowed(LONG))


def limit_of_plane(plane: PhasePlane, minimise: DriveObjective, unit: float = 1.0) -> DriveLimit:
    """The limit of a phase plane of torques in a unit, with its certificate.

    Raises
    ------
    InfeasibleProblem
        If no motion keeps the bounds in the time 1; its proof is a limit of the time.
    SolverFailure
        If the conic program was not solved.
    """
    if plane.kind == "time":
        return _least_time(plane)
    level = standing_level(plane)
    try:
        best = _finer(Standing(plane, level), minimise, unit)
    except SolverFailure:
        _refuse(plane)
        raise
    for share in _SHARES if level and plane.squared is not None else ():
        if best.gap <= _MOST_PHASE_GAP:
            break
        with suppress(SolverFailure):
            best = max(best, _finer(Standing(plane, share * level), minimise, unit), key=_proves)
    return best


def unreachable(plane: PhasePlane, unit: float) -> DriveLimit | None:
    """A limit of a peak torque in up to LONG times the time that is above a bound of the plane; None where none is.

    The torque's mean from the first position on, or up to the last, is that of the load and of friction.
    """
    for bound, free in _without_limits(plane):
        assert free.peak is not None  # noqa: S101 - its least is looked for
        for sign, ends, means in _mean_loads(bound.torque):
            beyond = np.flatnonzero(means >= 0.5 * (bound.at_rest + np.max(means)))
            if np.max(means) <= bound.at_rest:
                continue
            most = int(beyond[-1])
            potential = even_price(free, free.peak, sign, *ends[most].tolist())
            weight, near = _PHASE_WEIGHT * bound.at_rest, float(means[most])
            parts = (*potential.to_data(), (0.25, 0.75), (1.0, 1.0))
            limit = DriveLimit("peak torque", 0.0, inf, free, unit, weight, *parts, near=near)
            limit = replace(limit, value=_bound(limit))
            if limit.value > bound.at_rest * unit:
                return replace(limit, attained=_attained(limit))
    return None


def _mean_loads(torque: AnyTorque) -> Iterator[tuple[float, Array, Array]]:
    """Signs, ends of ever longer ways from the first position on, or up to the last, and mean loads times the sign.

    A motion from rest, or to rest, takes no less than this of a torque in the mean of the way, without its friction.
    """
    a = np.sin(0.5 * np.pi * np.linspace(0.0, 1.0, _LOOKS + 1)) ** 2
    for sign, form in ((1.0, torque.branches[0]), (-1.0, torque.branches[-1])):
        load = form.values(a)[3]
        works = np.append(0.0, np.cumsum(0.5 * (load[1:] + load[:-1]) * np.diff(a)))
        first, last = (np.zeros(_LOOKS), a[1:]) if sign > 0.0 else (a[-2::-1], np.ones(_LOOKS))
        work = works[1:] if sign > 0.0 else works[-1] - works[-2::-1]
        yield sign, np.stack([first, last], axis=1), sign * work / (last - first)


def _proves(limit: DriveLimit) -> tuple[float, float]:
    return limit.value, -limit.attained


def _refuse(plane: PhasePlane) -> None:
    """Raise an error with its proof if the least time within the bounds is more than there is."""
    if not plane.bounds:
        return
    shortest = _least_time(plane)
    if shortest.value > 1.0:
        raise InfeasibleProblem(
            f"no motion keeps the bounds in the time 1: the least time within them is {shortest.value:.6g}",
            problem=plane,
            proof=shortest,
        )


def _finer(standing: Standing, minimise: DriveObjective, unit: float) -> DriveLimit:
    """The limit or, where its gap is not small, a limit on finer elements if it proves more."""
    best = _limit(standing, minimise, unit, optimum(standing))
    if best.attained == inf and minimise != "time":
        _refuse(standing.plane)
    for rounds, more, most in _FINER:
        if _SMALL_PHASE_GAP < best.gap <= most:
            with suppress(SolverFailure):
                other = _limit(standing, minimise, unit, optimum(standing, rounds, more))
                best = max(best, other, key=_proves) if isinf(min(best.gap, other.gap)) else _nearer(best, other)
    return best


def _nearer(limit: DriveLimit, other: DriveLimit) -> DriveLimit:
    """Of two limits the one that proves more or, where both prove as much, the one whose motion is nearer."""
    if abs(limit.value - other.value) <= 10.0 * _SMALL_PHASE_GAP * abs(limit.value):
        return min(limit, other, key=lambda each: each.gap)
    return max(limit, other, key=_proves)


def _least_time(plane: PhasePlane) -> DriveLimit:
    """The least time, in a unit in which it is about 1."""
    bounds = [sqrt(1.0 / bound.at_rest * bound.torque.size) for bound in plane.bounds]
    unit = power_of_two(max([*bounds, *(1.0 / limit.B for limit in plane.velocities), 1.0 / plane.B]))
    motion = optimum(Standing(plane.slowed(unit)), 1)
    if not 0.5 <= motion.objective <= 2.0:
        unit *= power_of_two(motion.objective)
    return _finer(Standing(plane.slowed(unit)), "time", unit)


def _limit(standing: Standing, minimise: DriveObjective, unit: float, motion: PhaseOptimum) -> DriveLimit:
    """The limit by the computed potential or, where that proves little, by others."""
    plane = standing.plane
    a = np.sin(0.5 * np.pi * motion.s) ** 2
    s, b = tuple(motion.s.tolist()), tuple(np.minimum(motion.velocities, plane.velocity_bound(a, a)).tolist())
    cells = tuple(motion.edges.tolist())
    attained = _in_units(value_of(plane, cells, s, b), minimise, unit, inf)
    near = max(motion.objective, 0.0) if plane.kind == "peak" else 0.0
    best = None
    for potential, weight, price, is_last in _certificates(standing, motion):
        level = standing.level if plane.kind == "mean" or price else 0.0
        parts = (*potential.to_data(), s, b, level, price, near)
        limit = DriveLimit(minimise, 0.0, attained, plane, unit, weight, *parts)
        limit = replace(limit, value=_bound(limit))
        if best is None or limit.value > best.value:
            best = limit
        if best.gap < (_MOST_PHASE_GAP if is_last else _SMALL_PHASE_GAP):
            break
    assert best is not None  # noqa: S101 - there are several certificates
    # what is stored is integrated over its own cells, as whoever verifies it does
    return replace(best, attained=_put_right(best, attained) if best.edges == cells else _attained(best))


def _certificates(standing: Standing, motion: PhaseOptimum) -> Iterator[tuple[Potential, float, float, bool]]:
    """Potentials, weights of the time and prices of the mean torque, and whether the next is for a large gap alone."""
    plane, potential = standing.plane, Potential(motion.edges, motion.potential)
    size = float(np.abs(motion.potential).max())
    for share in _STEEPER:
        trial = potential.steeper(share * size) if share else potential
        yield trial, motion.weight, 0.0, share in {0.0, _STEEPER[-1]}
    little, none = _PHASE_WEIGHT * abs(motion.objective), Potential(motion.edges, np.zeros_like(motion.potential))
    if plane.peak is not None and (sign := standing_sign(plane)):
        yield none, little, float(sign), True
        yield even_price(plane, plane.peak, float(sign)), little, 0.0, True
    if plane.peak is not None:
        for way, ends, means in _mean_loads(plane.peak):
            if np.max(means) > 0.0:
                even = even_price(plane, plane.peak, way, *ends[int(np.argmax(means))].tolist())
                yield even, little, 0.0, True
                # a greater weight keeps slow motions from costing what the fall of the price takes
                yield even, _MEAN_WEIGHT * abs(motion.objective), 0.0, True
    elif standing.level:
        yield none, little, 0.0, True


def _bound(limit: DriveLimit) -> float:
    potential = Potential(np.array(limit.edges), np.array(limit.potential))
    peak = limit.near if limit.minimise == "peak torque" else inf
    guess = Guess(np.array(limit.s), np.array(limit.b), peak)
    bound = proven_bound(Standing(limit.plane, limit.level, limit.price), potential, limit.weight, guess)
    return _in_units(max(bound, least_energy(limit.plane)), limit.minimise, limit.unit, 0.0)


def _attained(limit: DriveLimit) -> float:
    return _put_right(
        limit, _in_units(value_of(limit.plane, limit.edges, limit.s, limit.b), limit.minimise, limit.unit, inf)
    )


def _near(stated: float, known: float) -> bool:
    """Whether a stated number is a known one but for rounding; only itself is near an infinite one."""
    return stated == known or (abs(known) < inf and abs(stated - known) <= STATED_BOUND * abs(known))


def _put_right(limit: DriveLimit, value: float) -> float:
    """The value of a motion, without what integration is off below the bound; energies are differences of works."""
    size = max(abs(value), limit.unit) if limit.minimise == "energy" else abs(value)
    return limit.value if 0.0 < limit.value - value <= INTEGRATION * size else value


def _in_units(value: float, minimise: DriveObjective, unit: float, towards: float) -> float:
    """The value of the objective in its own unit, with roots rounded to a side; units are powers of 2."""
    if minimise == "rms torque":
        return unit * nextafter(sqrt(value), towards) if 0.0 < value < inf else value
    return unit * value


def _check(limit: DriveLimit) -> None:
    """Refuse a certificate whose parts do not fit each other."""
    edges, rows = limit.edges, limit.potential
    ascending = len(edges) > 1 and all(low < high for low, high in pairwise(edges))
    if not ascending or edges[0] != 0.0 or edges[-1] != 1.0:
        raise InputError(f"edges must ascend from 0 to 1, got {shortened(edges)}")
    if len(rows) != len(edges) - 1 or len({len(row) for row in rows}) != 1 or len(rows[0]) < 2:
        raise InputError(f"potential must have one row of as many coefficients for each of {len(edges) - 1} pieces")
    inside = all(0.0 < place < 1.0 for place in limit.s)
    if not limit.s or len(limit.s) != len(limit.b) or not inside or min(limit.b) <= 0.0:
        raise InputError("s and b must be as many places within (0, 1) with velocities above 0")
    if any(low >= high for low, high in pairwise(limit.s)):
        raise InputError(f"s must ascend, got {shortened(limit.s)}")
    plane = limit.plane
    if plane.kind != {"peak torque": "peak", "time": "time"}.get(limit.minimise, "mean"):
        raise InputError(f"the plane is none in which the {limit.minimise} is minimised")
    if plane.kind == "time" and limit.weight != 1.0:
        raise InputError(f"the weight of the time that is minimised is 1, got {limit.weight!r}")
    counts = {"level": plane.squared is not None or limit.price, "price": plane.peak, "near": plane.peak}
    for name, used in counts.items():
        if not used and getattr(limit, name) != 0.0:
            raise InputError(f"{name} is no part of this certificate: it must be 0, got {getattr(limit, name)!r}")


def limit_beside(problem: Problem) -> DriveLimit | None:
    """The limit of a problem's objective in the phase plane; None where it is of no drive, or laws may turn back.

    Examples
    --------
    >>> from optlaws import Problem, rms
    >>> problem = Problem(order=3, B=(1, 2.2), minimise=rms("(1 + 0.6*a^2)*c + 0.6*a*b^2 + 3*a"), monotone=True)
    >>> round(limit_beside(problem).value, 5)
    3.40484
    """
    known, best = plane_of(problem), None
    if known is None:
        return None
    with suppress(InputError, InfeasibleProblem, SolverFailure):
        best = _cached(*known)
    for plane in within_jerk(known[0], problem):
        with suppress(InputError, InfeasibleProblem, SolverFailure):
            within = _cached_once(plane, *known[1:])
            if within.value > (0.0 if best is None else best.value):
                return within
    return best


@lru_cache(maxsize=64)
def _cached(plane: PhasePlane, minimise: DriveObjective, unit: float) -> DriveLimit:
    return limit_of_plane(plane, minimise, unit)


@lru_cache(maxsize=64)
def _cached_once(plane: PhasePlane, minimise: DriveObjective, unit: float) -> DriveLimit:
    """The limit on the first elements: finer ones add little where so many bounds count."""
    standing = Standing(plane, standing_level(plane))
    return _limit(standing, minimise, unit, optimum(standing))
