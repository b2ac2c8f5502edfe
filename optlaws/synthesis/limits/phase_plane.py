"""The phase plane of a move from rest to rest: torques over position and velocity, and what is minimised and bounded.

A law that never turns back is a velocity b over the position a. With w = b², the acceleration is c = w'/2, so that a
torque I(a) c + S(a) b² + R(a) b + T(a) is affine in w and w' but for R, and its peak, its mean square, energies and the
time are convex in w. What is minimised over the plane is what no law from rest to rest that never turns back can beat.

Behind a gear with losses a torque is the greater of two such forms.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass, replace
from math import inf, nextafter, sqrt
from typing import Any, Literal, TypeAlias

import numpy as np

from optlaws.echo import shortened
from optlaws.entries import value_types as types
from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Listed, ReadBy, Together
from optlaws.errors import InputError
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.convexity import quadratic
from optlaws.formulas.jets import formula_jet
from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.reading import read
from optlaws.formulas.slopes import added, constant, opposite, scaled
from optlaws.formulas.tree import Call, Formula, Name, Number, Product, Sum, product, substituted
from optlaws.kept import kept_property
from optlaws.numbers import Array, finite, not_negative, positive, power_of_two
from optlaws.numerics.interval import exact
from optlaws.numerics.taylor import Jet, variable
from optlaws.tolerances import VALUE_ROUNDING, WINDOW_EDGE

_ZERO, _ONE = Number(0.0), Number(1.0)
_KEYS = (("c",), ("b", "b"), ("b",), ())
_TWO = 2


@dataclass(frozen=True)
class PhaseTorque:
    """A torque I(a) c + S(a) b² + R(a) b + T(a), dimensionless; c alone is an acceleration.

    Attributes
    ----------
    inertia, square, drag, load
        The factors I, S, R and T, formulas of a.

    Examples
    --------
    >>> torque = PhaseTorque.of(read("(1 + 0.6*a^2)*c + 0.6*a*b^2 + 3*a"))
    >>> torque.inertia, torque.square, torque.drag, torque.load
    (1 + 0.6*a^2, 0.6*a, 0, 3*a)
    """

    inertia: Formula
    square: Formula = _ZERO
    drag: Formula = _ZERO
    load: Formula = _ZERO

    @classmethod
    def of(cls, formula: Formula) -> PhaseTorque | None:
        """The torque that a formula of a, b and c is; None where it is none, as where it depends on k."""
        terms = quadratic(formula, ("b", "c"))
        return None if terms is None or ("c",) not in terms else cls.of_terms(terms)

    @classmethod
    def of_power(cls, formula: Formula) -> PhaseTorque | None:
        """The torque whose product with b is a formula; for the number 0 a torque without factors."""
        if constant(formula) == 0.0:
            return cls(_ZERO)
        terms = quadratic(formula, ("b", "c"), 3)
        if terms is None or any("b" not in key for key in terms):
            return None
        by_velocity: dict[tuple[str, ...], Formula] = {}
        for key, factor in terms.items():
            rest = list(key)
            rest.remove("b")
            by_velocity[tuple(rest)] = factor
        return cls.of_terms(by_velocity)

    @classmethod
    def of_terms(cls, terms: Mapping[tuple[str, ...], Formula]) -> PhaseTorque | None:
        """The torque of factors by the names that they multiply; None where these are others or depend on k."""
        if not terms.keys() <= set(_KEYS) or any(factor.names() - {"a", "pi"} for factor in terms.values()):
            return None
        return cls(*(terms.get(key, _ZERO) for key in _KEYS))

    @property
    def factors(self) -> tuple[Formula, Formula, Formula, Formula]:
        """I, S, R and T."""
        return self.inertia, self.square, self.drag, self.load

    def values(self, a: Array) -> tuple[Array, Array, Array, Array]:
        """I, S, R and T at positions, each of the shape of a."""
        inertia, square, drag, load = (
            np.broadcast_to(np.asarray(evaluate(factor, {"a": a}, NUMPY), dtype=np.float64), a.shape)
            for factor in self.factors
        )
        return inertia, square, drag, load

    def jets(self, a: Jet) -> tuple[Jet, Jet, Jet, Jet]:
        """I, S, R and T where a is a jet of intervals."""
        inertia, square, drag, load = (formula_jet(factor, "a", a) for factor in self.factors)
        return inertia, square, drag, load

    def scaled(self, by: float) -> PhaseTorque:
        """The torque times a factor."""
        return PhaseTorque(*(scaled(factor, by) if by else _ZERO for factor in self.factors))

    def slowed(self, time: float) -> PhaseTorque:
        """The torque where the time is measured in another unit."""
        return replace(
            self,
            inertia=scaled(self.inertia, time**-2),
            square=scaled(self.square, time**-2),
            drag=scaled(self.drag, 1.0 / time),
        )

    def inertia_slope(self, a: Array) -> Array:
        """The derivative of I by a at positions."""
        places = exact(a)
        return np.asarray(formula_jet(self.inertia, "a", variable(places, 1)).terms[1].middle)

    @kept_property
    def kinks(self) -> tuple[float, ...]:
        """The positions strictly between 0 and 1 at which a factor is not smooth, ascending."""
        over_k = (MotionFormula(substituted(factor, {"a": Name("k")})) for factor in self.factors)
        return tuple(sorted({place for factor in over_k for place in factor.kinks}))

    @kept_property
    def size(self) -> float:
        """The approximate size of the torque in smooth laws, a power of 2."""
        inertia, square, drag, load = self.values(np.linspace(0.0, 1.0, 65))
        return power_of_two(
            float(np.max(4.0 * np.abs(inertia) + 4.0 * np.abs(square) + 2.0 * np.abs(drag) + np.abs(load)))
        )

    @property
    def branches(self) -> tuple[PhaseTorque, ...]:
        """The torque itself, which has one form for both directions of the power."""
        return (self,)

    def plus(self, other: PhaseTorque, share: float = 1.0) -> PhaseTorque:
        """The sum with a share of another torque; the share is left a factor, so that nothing is rounded."""
        pairs = zip(self.factors, other.factors, strict=True)
        return PhaseTorque(*(added([first, _shared(second, share)]) for first, second in pairs))

    def to_data(self) -> list[str]:
        """The factors of the torque as texts."""
        return [str(factor) for factor in self.factors]


#: the acceleration c as if it were a torque
ACCELERATION = PhaseTorque(_ONE)


@dataclass(frozen=True)
class GearTorque:
    """The torque of a motor behind a gear with losses: motor + max(to_load * load, back * load).

    Where the load is above 0, power flows to it: the first branch. Where it is below 0, power flows back.

    Attributes
    ----------
    motor
        What the motor's own inertia and friction take.
    load
        At the mechanism, as a gear without losses would hand it on.
    to_load, back
        Factors of the load, as 1/eta and eta; the first is at least the second.

    Examples
    --------
    >>> torque = GearTorque.of(read("0.2*c + max(1.25*(c + 3*a), 0.8*(c + 3*a))"))
    >>> torque.motor.inertia, torque.load.load, torque.to_load, torque.back
    (0.2, 3*a, 1.25, 0.8)
    >>> [branch.inertia for branch in torque.branches]
    [0.2 + 1.25*1, 0.2 + 0.8*1]
    >>> GearTorque.of(read("0.5*(0.2*c + max(1.25*(c + 3*a), 0.8*(c + 3*a)))")) == torque.times(0.5)
    True
    """

    motor: PhaseTorque
    load: PhaseTorque
    to_load: float
    back: float

    @classmethod
    def of(cls, formula: Formula) -> GearTorque | None:
        """The torque of a formula that is a sum with one maximum of two torques; None for other formulas."""
        share, rest = _share(formula)
        if share != 1.0:
            torque = cls.of(rest)
            return None if torque is None else torque.times(share)
        terms = formula.terms if isinstance(formula, Sum) else (formula,)
        greater = [term for term in terms if isinstance(term, Call) and term.function == "max"]
        if len(greater) != 1 or len(greater[0].arguments) != 2:
            return None
        motor = _of_all([term for term in terms if term is not greater[0]])
        return None if motor is None else cls._of_two(motor, *greater[0].arguments)

    @classmethod
    def _of_two(cls, motor: PhaseTorque, first: Formula, second: Formula) -> GearTorque | None:
        (share, load), (other, same) = _share(first), _share(second)
        if load != same:  # the greater of any two torques is the second and, where the first is above it, the rest
            base, more = PhaseTorque.of(second), _of_all([first, opposite(second)])
            return None if base is None or more is None else cls(motor.plus(base), more, 1.0, 0.0)
        torque = PhaseTorque.of(load)
        return None if torque is None else cls(motor, torque, max(share, other), min(share, other))

    @kept_property
    def branches(self) -> tuple[PhaseTorque, PhaseTorque]:
        """The torque where power flows to the load, and where it flows back; the greater is the torque."""
        return self.motor.plus(self.load, self.to_load), self.motor.plus(self.load, self.back)

    def scaled(self, by: float) -> GearTorque | PhaseTorque:
        """The torque times a factor; the load is unchanged, because only its sign matters."""
        if by == 0.0:
            return PhaseTorque(_ZERO)
        return self.times(by)

    def times(self, by: float) -> GearTorque:
        """The torque times a factor above 0."""
        return GearTorque(self.motor.scaled(by), self.load, by * self.to_load, by * self.back)

    def slowed(self, time: float) -> GearTorque:
        """The torque where the time is measured in another unit."""
        return replace(self, motor=self.motor.slowed(time), load=self.load.slowed(time))

    @property
    def size(self) -> float:
        """About how great the torque is along smooth laws: a power of 2."""
        return self.branches[0].size

    def to_data(self) -> dict[str, Any]:
        """Motor and load by their factors, and the shares of the load."""
        return {
            "motor": self.motor.to_data(),
            "load": self.load.to_data(),
            "to_load": self.to_load,
            "back": self.back,
        }


#: a torque with one form for both directions of the power, or behind a gear with losses
AnyTorque: TypeAlias = PhaseTorque | GearTorque


def torque_of(formula: Formula) -> AnyTorque | None:
    """The torque in the phase plane that a formula of a, b and c is; None where it is none.

    >>> torque_of(read("c + 3*a")), torque_of(read("c*k"))
    (PhaseTorque(inertia=1, square=0, drag=0, load=3*a), None)
    """
    return PhaseTorque.of(formula) or GearTorque.of(formula)


def greater_power(arguments: Sequence[Formula]) -> tuple[AnyTorque, AnyTorque] | None:
    """The two torques whose powers, times b, have a given maximum; None where there are not two torques.

    Behind a gear with losses these are three or four: a power has two forms, and so has the share that is recovered.

    >>> first, second = greater_power([read(text) for text in ("1.25*c*b", "0.8*c*b", "0")])
    >>> first.branches[0].inertia, second.inertia
    (0.8 + 1.25 + -1*0.8, 0)
    """
    torques = [PhaseTorque.of_power(argument) for argument in arguments]
    known = [torque for torque in torques if torque is not None]
    if len(known) < len(arguments) or not _TWO <= len(arguments) <= 2 * _TWO:
        return None
    if len(known) == _TWO:
        return known[0], known[1]
    geared = GearTorque(known[1], known[0].plus(known[1], -1.0), 1.0, 0.0)
    if len(known) == _TWO + 1:
        return (geared, known[2]) if constant(arguments[2]) == 0.0 else None
    shares = [_share(argument) for argument in arguments[_TWO:]]
    same = [of == argument for (_, of), argument in zip(shares, arguments, strict=False)]
    return (geared, geared.scaled(shares[0][0])) if all(same) and shares[0][0] == shares[1][0] else None


def torque_from(data: Any) -> AnyTorque:
    """The torque that `to_data` described.

    Raises
    ------
    InputError
        If it is no such torque.
    """
    if isinstance(data, Mapping):
        if set(data) != {"motor", "load", "to_load", "back"}:
            raise InputError(f"a torque behind a gear has motor, load, to_load and back, got {shortened(data)}")
        to_load, back = (not_negative(data[name], name) for name in ("to_load", "back"))
        if to_load < back:
            raise InputError(f"to_load must be at least back, got {to_load!r} and {back!r}")
        return GearTorque(_plain(data["motor"]), _plain(data["load"]), to_load, back)
    return _plain(data)


def _plain(texts: Any) -> PhaseTorque:
    if not isinstance(texts, list | tuple) or len(texts) != len(_KEYS):
        raise InputError(f"a torque is the texts of its factors of c, b², b and 1, got {shortened(texts)}")
    return PhaseTorque(*(read(text, ("a",)) for text in texts))


def _of_all(terms: Sequence[Formula]) -> PhaseTorque | None:
    """The torque of a sum, which may lack an acceleration."""
    form = quadratic(added(list(terms)), ("b", "c"))
    return None if form is None else PhaseTorque.of_terms(form)


def _share(formula: Formula) -> tuple[float, Formula]:
    """A number, and the factor that it multiplies."""
    first = formula.factors[0] if isinstance(formula, Product) else None
    if isinstance(formula, Product) and isinstance(first, Number) and first.value > 0.0:
        return first.value, product(list(formula.factors[1:]))
    return 1.0, formula


def _shared(formula: Formula, share: float) -> Formula:
    return formula if share == 1.0 else _ZERO if share == 0.0 or formula == _ZERO else Product((Number(share), formula))


#: what is least: the mean over time of a torque's square and of powers, the peak of a torque, or the time itself
PhasePlaneKind: TypeAlias = Literal["mean", "peak", "time"]


@dataclass(frozen=True)
class TorqueLimit:
    """The bound |torque| <= at_rest - fall * b: a peak torque, or a straight part of a motor's curve.

    Where `side` is 1 only torque <= at_rest - fall * b is meant, and where it is -1 only -torque. It holds at the
    positions from `start` to `stop`.

    Examples
    --------
    >>> TorqueLimit(ACCELERATION, 9.0).fall
    0.0
    """

    torque: AnyTorque
    at_rest: float
    fall: float = 0.0
    side: Literal[-1, 0, 1] = 0
    start: float = 0.0
    stop: float = 1.0

    def __post_init__(self) -> None:
        _check_window(self.start, self.stop)

    @property
    def everywhere(self) -> bool:
        """Whether the limit holds in the whole stroke."""
        return (self.start, self.stop) == (0.0, 1.0)

    def to_data(self) -> list[Any]:
        """Its torque and numbers as plain data."""
        numbers = [self.at_rest, self.fall] if self.everywhere else [self.at_rest, self.fall, self.start, self.stop]
        return [self.torque.to_data(), *numbers]

    @classmethod
    def from_data(cls, data: Any) -> TorqueLimit:
        """The limit that `to_data` described."""
        if not isinstance(data, list | tuple) or len(data) not in {3, 5}:
            raise InputError(f"a limit is a torque, a value at rest, a fall, and a window, got {shortened(data)}")
        at_rest, fall, *window = (finite(value, "a limit") for value in data[1:])
        return cls(torque_from(data[0]), at_rest, fall, 0, *window)


@dataclass(frozen=True)
class VelocityLimit:
    """The bound b <= B at the positions from `start` to `stop`.

    Examples
    --------
    >>> VelocityLimit(0.2, 0.4, 1.1).B
    1.1
    """

    start: float
    stop: float
    B: float

    def __post_init__(self) -> None:
        _check_window(self.start, self.stop)
        positive(self.B, "B")


def _check_window(start: float, stop: float) -> None:
    if not 0.0 <= start < stop <= 1.0:
        raise InputError(f"a window has two positions that ascend from 0 to 1, got {start!r} and {stop!r}")


def _torque(value: Any) -> AnyTorque:
    return value if isinstance(value, PhaseTorque | GearTorque) else torque_from(value)


def _torque_limit(value: Any) -> TorqueLimit:
    return value if isinstance(value, TorqueLimit) else TorqueLimit.from_data(value)


def _velocity_limit(value: Any) -> VelocityLimit:
    if isinstance(value, VelocityLimit):
        return value
    numbers = Together(types.Number(), types.Number(), types.Number(), names=("start", "stop", "B"))
    return VelocityLimit(*numbers.read(value, "a limit of the velocity"))


def _formula(value: Any) -> Formula:
    return value if isinstance(value, Formula) else read(value, ("a",))


_TORQUE = ReadBy(_torque, "a torque, as the texts of I, S, R and T", lambda torque: torque.to_data())


@declared
class PhasePlane(Declared, title="a phase plane"):
    """An objective with bounds over all motions from rest to rest that never turn back.

    With nothing to minimise it is the time that is least.

    Examples
    --------
    >>> plane = PhasePlane(peak=ACCELERATION, B=1.8)
    >>> plane.kind, PhasePlane.from_dict(plane.to_dict()) == plane
    ('peak', True)
    """

    writes_defaults = True

    squared: AnyTorque | None = entry(_TORQUE, "A torque whose mean square is minimised.", default=None)
    maxima: tuple[tuple[AnyTorque, AnyTorque], ...] = entry(
        Listed(Together(_TORQUE, _TORQUE)),
        "Powers that are minimised in the mean: each is b times the greater of two torques.",
        default=(),
    )
    peak: AnyTorque | None = entry(_TORQUE, "A torque whose greatest magnitude is minimised; alone.", default=None)
    limits: tuple[TorqueLimit, ...] = entry(
        Listed(ReadBy(_torque_limit, "a torque, a value at rest, a fall, and a window", TorqueLimit.to_data)),
        "Bounds of torques.",
        default=(),
    )
    B: float = entry(
        types.Number(above=0.0, absent=inf), "The greatest velocity; infinite where it is free.", default=inf
    )
    C: float = entry(types.Number(above=0.0, absent=inf), "The greatest acceleration, likewise.", default=inf)
    heat: float = entry(types.Number(above=0.0), "The factor of the mean square.", default=1.0)
    velocities: tuple[VelocityLimit, ...] = entry(
        Listed(ReadBy(_velocity_limit, "two positions and a velocity", lambda limit: list(astuple(limit)))),
        "Bounds of the velocity over parts of the stroke.",
        default=(),
    )
    holding: Formula | None = entry(
        ReadBy(_formula, "a formula of a", str),
        "The torque that holds the load at rest; that of a slow motion unless given.",
        default=None,
    )

    def _check(self) -> None:
        if self.peak is not None and (self.squared is not None or self.maxima):
            raise InputError("a peak is minimised alone: leave out what else is minimised")
        if self.kind != "time" and self.B <= 1.0:
            raise InputError(f"B must be above 1, the mean velocity, got {self.B!r}")
        if len({torque.load for torque in self.torques if isinstance(torque, GearTorque)}) > 1:
            raise InputError("torques behind a gear with losses must be those of one load")
        for formula in (branch.inertia for torque in self.torques for branch in torque.branches):
            least = float(np.min(evaluate(formula, {"a": np.linspace(0.0, 1.0, 1025)}, NUMPY)))
            if least < 0.0:
                raise InputError(f"an inertia must be at least 0 at every position, got {least:.6g} of {formula}")

    @property
    def kind(self) -> PhasePlaneKind:
        """Whether a mean, a peak or the time is minimised."""
        if self.peak is not None:
            return "peak"
        return "mean" if self.squared is not None or self.maxima else "time"

    @property
    def torques(self) -> tuple[AnyTorque, ...]:
        first = [torque for torque in (self.squared, self.peak) if torque is not None]
        several = [torque for torques in self.maxima for torque in torques]
        return (*first, *several, *(limit.torque for limit in self.limits))

    @property
    def bounds(self) -> tuple[TorqueLimit, ...]:
        """The limits: limits over parts of the stroke first, the limit of the acceleration last."""
        limits = sorted(self.limits, key=lambda limit: limit.everywhere)
        return (*limits, *([TorqueLimit(ACCELERATION, self.C)] if inf > self.C else []))

    @property
    def within_jerk(self) -> bool:
        """Whether bounds rise with the velocity, as those of the acceleration do that a bound of the jerk implies."""
        return any(limit.fall < 0.0 for limit in self.limits)

    @property
    def greatest_velocity(self) -> float:
        """A velocity that no motion within the bounds exceeds: to reach it and stop takes less than the stroke."""
        return min(self.B, nextafter(sqrt(self.C), inf)) if inf > self.C else self.B

    @property
    def gear_load(self) -> PhaseTorque | None:
        """The load whose sign gives the direction of power through a gear with losses; None without such a gear."""
        geared = [torque for torque in self.torques if isinstance(torque, GearTorque)]
        return geared[0].load if geared else None

    @kept_property
    def branches(self) -> tuple[PhasePlane, ...]:
        """Planes with torques of a single form; at every position, every motion is in one of them.

        Behind a gear with losses that is one with a load of at least 0, and one with a load of at most 0.
        """
        load = self.gear_load
        return (self,) if load is None else (self._branch(0, load), self._branch(1, load))

    def _branch(self, i: int, load: PhaseTorque) -> PhasePlane:
        def of(torque: AnyTorque) -> PhaseTorque:
            return torque.branches[min(i, len(torque.branches) - 1)]

        limits = [replace(limit, torque=of(limit.torque)) for limit in self.limits]
        return replace(
            self,
            squared=None if self.squared is None else of(self.squared),
            maxima=tuple((of(first), of(second)) for first, second in self.maxima),
            peak=None if self.peak is None else of(self.peak),
            limits=(TorqueLimit(load, 0.0, side=1 if i else -1), *limits),
        )

    @kept_property
    def reference(self) -> PhaseTorque:
        """The torque whose price follows from the potential and all other prices: of what is bounded or squared.

        Raises
        ------
        InputError
            If nothing keeps the acceleration finite.
        """
        bounds = [bound.torque for bound in self.bounds if bound.side == 0 and bound.everywhere]
        several = bounds[-1] if bounds else self.peak or self.squared
        if several is None:
            raise InputError("nothing keeps the acceleration finite: bound C or a torque")
        torque = several.branches[0]
        a = np.linspace(0.0, 1.0, 1025)
        inertia = torque.values(a)[0]
        if (least := int(np.argmin(inertia))) >= 0 and inertia[least] <= VALUE_ROUNDING * float(inertia.max()):
            raise InputError(
                f"the inertia {torque.inertia} vanishes at a = {a[least]:.4g}, where nothing keeps the acceleration "
                "finite: bound C"
            )
        return torque

    @kept_property
    def kinks(self) -> tuple[float, ...]:
        """The positions strictly between 0 and 1 at which a torque is not smooth, ascending."""
        branches = [branch for torque in self.torques for branch in torque.branches]
        ends = {place for branch in branches for place in branch.kinks}
        # a little within windows, so that what is nearest to an end surely is
        ends |= {limit.start + WINDOW_EDGE for limit in self.windows if limit.start > 0.0}
        ends |= {limit.stop - WINDOW_EDGE for limit in self.windows if limit.stop < 1.0}
        return tuple(sorted(ends))

    @property
    def jumps(self) -> tuple[float, ...]:
        """The positions at which the potential may jump: where a bounded velocity begins and ends, ascending."""
        ends = {limit.start + WINDOW_EDGE for limit in self.velocities if limit.start > 0.0}
        return tuple(sorted(ends | {limit.stop - WINDOW_EDGE for limit in self.velocities if limit.stop < 1.0}))

    @property
    def windows(self) -> tuple[TorqueLimit | VelocityLimit, ...]:
        """The bounds that hold over parts of the stroke."""
        return (*self.velocities, *(limit for limit in self.limits if not limit.everywhere))

    def velocity_bound(self, low: Array, high: Array) -> Array:
        """The greatest velocity in parts of the stroke, each from one position to another."""
        most = np.full(low.shape, self.greatest_velocity)
        for limit in self.velocities:
            most = np.where((low >= limit.start) & (high <= limit.stop), np.minimum(most, limit.B), most)
        return most

    def slowed(self, time: float) -> PhasePlane:
        """The plane of the least time, measured in another unit."""
        limits = tuple(
            replace(limit, torque=limit.torque.slowed(time), fall=limit.fall / time) for limit in self.limits
        )
        velocities = tuple(replace(limit, B=limit.B * time) for limit in self.velocities)
        return PhasePlane(limits=limits, B=self.B * time, C=self.C * time**2, velocities=velocities)
