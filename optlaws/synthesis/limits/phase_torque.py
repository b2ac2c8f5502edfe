"""Torques over position and velocity: affine in the acceleration, or behind a gear with losses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.convexity import quadratic
from optlaws.formulas.jets import formula_jet
from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.reading import read
from optlaws.formulas.slopes import added, constant, opposite, scaled
from optlaws.formulas.tree import Call, Formula, Name, Number, Product, Sum, product, substituted
from optlaws.kept import kept_property
from optlaws.numbers import Array, not_negative, power_of_two
from optlaws.numerics.interval import exact
from optlaws.numerics.taylor import Jet, variable

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
