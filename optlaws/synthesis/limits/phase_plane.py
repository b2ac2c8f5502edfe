"""The phase plane of a move from rest to rest: torques over position and velocity, and what is minimised and bounded.

A law that never turns back is a velocity b over the position a. With w = b², the acceleration is c = w'/2, so that a
torque I(a) c + S(a) b² + R(a) b + T(a) is affine in w and w' but for R, and its peak, its mean square, energies and the
time are convex in w. What is minimised over the plane is what no law from rest to rest that never turns back can beat.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import inf, nextafter, sqrt
from typing import Any, Literal, TypeAlias

import numpy as np

from optlaws.errors import InputError
from optlaws.files.reading import JsonText
from optlaws.formulas.affine import quadratic
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.reading import read
from optlaws.formulas.slopes import constant, scaled
from optlaws.formulas.tree import Formula, Name, Number, substituted
from optlaws.kept import kept_property
from optlaws.numbers import Array, bounded, positive, power_of_two
from optlaws.numerics.interval import exact
from optlaws.numerics.taylor import Jet, variable
from optlaws.synthesis.limits.formula_jets import formula_jet
from optlaws.tolerances import VALUE_ROUNDING

#: what is least: the mean over time of a torque's square and of powers, the peak of a torque, or the time itself
PhasePlaneKind: TypeAlias = Literal["mean", "peak", "time"]

_ZERO, _ONE = Number(0.0), Number(1.0)
_KEYS = (("c",), ("b", "b"), ("b",), ())


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
        return None if terms is None or ("c",) not in terms else cls._of_terms(terms)

    @classmethod
    def of_power(cls, formula: Formula) -> PhaseTorque | None:
        """The torque that, times b, is a formula; of the number 0 that without any factor."""
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
        return cls._of_terms(by_velocity)

    @classmethod
    def _of_terms(cls, terms: Mapping[tuple[str, ...], Formula]) -> PhaseTorque | None:
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
        """About how great the torque is along smooth laws: a power of 2."""
        inertia, square, drag, load = self.values(np.linspace(0.0, 1.0, 65))
        return power_of_two(
            float(np.max(4.0 * np.abs(inertia) + 4.0 * np.abs(square) + 2.0 * np.abs(drag) + np.abs(load)))
        )

    def to_list(self) -> list[str]:
        """The factors as texts."""
        return [str(factor) for factor in self.factors]


#: the acceleration c as if it were a torque
ACCELERATION = PhaseTorque(_ONE)


@dataclass(frozen=True)
class TorqueLimit:
    """The bound |torque| <= at_rest - fall * b: a peak torque, or a straight part of a motor's curve.

    Examples
    --------
    >>> TorqueLimit(ACCELERATION, 9.0).fall
    0.0
    """

    torque: PhaseTorque
    at_rest: float
    fall: float = 0.0


@dataclass(frozen=True)
class PhasePlane(JsonText):
    """What is minimised over all motions from rest to rest that never turn back, and within which bounds.

    Attributes
    ----------
    squared, heat
        A torque whose mean square is minimised, and the factor of that.
    maxima
        Powers that are minimised in the mean: each is b times the greater of two torques.
    peak
        A torque whose greatest magnitude is minimised; alone. With nothing to minimise it is the time that is least.
    limits
        Bounds of torques.
    B, C
        The greatest velocity and the greatest acceleration; infinite where they are free.

    Examples
    --------
    >>> plane = PhasePlane(peak=ACCELERATION, B=1.8)
    >>> plane.kind, PhasePlane.from_dict(plane.to_dict()) == plane
    ('peak', True)
    """

    squared: PhaseTorque | None = None
    maxima: tuple[tuple[PhaseTorque, PhaseTorque], ...] = ()
    peak: PhaseTorque | None = None
    limits: tuple[TorqueLimit, ...] = ()
    B: float = inf
    C: float = inf
    heat: float = 1.0

    _json_name = "a phase plane"

    def __post_init__(self) -> None:
        if self.peak is not None and (self.squared is not None or self.maxima):
            raise InputError("a peak is minimised alone: leave out what else is minimised")
        if self.kind != "time" and self.B <= 1.0:
            raise InputError(f"B must be above 1, the mean velocity, got {self.B!r}")
        for formula in (torque.inertia for torque in self.torques):
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
    def torques(self) -> tuple[PhaseTorque, ...]:
        """Every torque that occurs in it."""
        first = [torque for torque in (self.squared, self.peak) if torque is not None]
        several = [torque for torques in self.maxima for torque in torques]
        return (*first, *several, *(limit.torque for limit in self.limits))

    @property
    def bounds(self) -> tuple[TorqueLimit, ...]:
        """The limits and, as the last of them, that of the acceleration."""
        return (*self.limits, *([TorqueLimit(ACCELERATION, self.C)] if inf > self.C else []))

    @property
    def greatest_velocity(self) -> float:
        """A velocity that no motion within the bounds exceeds: to reach it and stop takes less than the stroke."""
        return min(self.B, nextafter(sqrt(self.C), inf)) if inf > self.C else self.B

    @kept_property
    def reference(self) -> PhaseTorque:
        """The torque whose price follows from the potential and all other prices: of what is bounded or squared.

        Raises
        ------
        InputError
            If nothing keeps the acceleration finite.
        """
        bounds = self.bounds
        torque = bounds[-1].torque if bounds else self.peak or self.squared
        if torque is None:
            raise InputError("nothing keeps the acceleration finite: bound C or a torque")
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
        return tuple(sorted({place for torque in self.torques for place in torque.kinks}))

    def slowed(self, time: float) -> PhasePlane:
        """The plane of the least time, measured in another unit."""
        limits = tuple(
            TorqueLimit(limit.torque.slowed(time), limit.at_rest, limit.fall / time) for limit in self.limits
        )
        return PhasePlane(limits=limits, B=self.B * time, C=self.C * time**2)

    def to_dict(self) -> dict[str, Any]:
        """The plane as plain data: torques as the texts of I, S, R and T."""
        return {
            "squared": None if self.squared is None else self.squared.to_list(),
            "maxima": [[torque.to_list() for torque in torques] for torques in self.maxima],
            "peak": None if self.peak is None else self.peak.to_list(),
            "limits": [[limit.torque.to_list(), limit.at_rest, limit.fall] for limit in self.limits],
            "B": bounded(self.B),
            "C": bounded(self.C),
            "heat": self.heat,
        }

    @classmethod
    def from_dict(cls, data: Any) -> PhasePlane:  # noqa: ANN401 - it is checked here
        """The plane that `to_dict` described."""
        if not isinstance(data, Mapping) or set(data) != {"squared", "maxima", "peak", "limits", "B", "C", "heat"}:
            raise InputError("a phase plane has the keys squared, maxima, peak, limits, B, C and heat")
        squared, peak = (None if data[key] is None else _torque(data[key]) for key in ("squared", "peak"))
        maxima = tuple((_torque(first), _torque(second)) for first, second in data["maxima"])
        limits = tuple(TorqueLimit(_torque(torque), float(P), float(fall)) for torque, P, fall in data["limits"])
        B, C = (inf if data[key] is None else float(data[key]) for key in ("B", "C"))
        return cls(squared, maxima, peak, limits, B, C, positive(data["heat"], "heat"))


def _torque(texts: Any) -> PhaseTorque:  # noqa: ANN401 - it is checked here
    if not isinstance(texts, list | tuple) or len(texts) != len(_KEYS):
        raise InputError(f"a torque is the texts of its factors of c, b², b and 1, got {texts!r}")
    return PhaseTorque(*(read(text, ("a",)) for text in texts))
