"""Base class of the segments of piecewise laws, and polynomial segments, into which all others can be converted."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import lru_cache
from typing import Any, ClassVar, NamedTuple

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import JsonText
from optlaws.laws.polynomial import PolynomialLaw
from optlaws.laws.storage import contents, known_fields
from optlaws.lazy import Registry
from optlaws.numbers import Array, finite, numbers
from optlaws.numerics import chebyshev

_START, _END = np.zeros(1), np.ones(1)


class Wave(NamedTuple):
    """The sine amplitude sin(frequency s + phase) of s = k - start."""

    amplitude: float
    frequency: float
    phase: float


class Waves(NamedTuple):
    """An acceleration as the sum of a Chebyshev series in 2u - 1 and of sines, with the velocity at its start."""

    acceleration: tuple[float, ...]
    b0: float
    sines: tuple[Wave, ...] = ()


class Segment(JsonText, ABC):
    """A stretch of a motion law in u = (k - start) / length, u in [0, 1]; frozen, with a name and plain contents.

    A kind is a frozen dataclass of numbers and tuples of numbers, declared with its name, for example
    ``class SplineSegment(Segment, kind="spline")``. Where it lies is known to the law alone, so every method
    takes the length; derivatives are with respect to k. A kind supplies the abstract methods; storage follows, and by a
    polynomial interpolant all that is computed from segments, unless it has a closed form of its own for that. An
    acceleration that is not smooth has no such interpolant: InputError.

    Examples
    --------
    >>> Segment.from_dict({"kind": "power", "b0": 0.0, "b1": 1.5})
    PowerSegment(b0=0.0, b1=1.5)
    """

    _json_name = "a segment"
    _json_layout: ClassVar[Mapping[str, Any]] = {"allow_nan": False}

    kind: ClassVar[str]
    kinds: ClassVar[Registry[type[Segment]]] = Registry("segment")

    def __init_subclass__(cls, *, kind: str | None = None, **kwargs: object) -> None:
        super().__init_subclass__(**kwargs)
        if kind is not None:
            cls.kind = kind
            Segment.kinds[kind] = cls

    @abstractmethod
    def derivative(self, u: Array, length: float, nu: int) -> Array:
        """Derivative of order nu of a at u, shape of u; for nu = 0 the displacement since the segment's start."""

    def derivatives(self, u: Array, length: float, count: int) -> Array:
        """The derivatives of the orders below a count at u, a row each."""
        return np.array([self.derivative(u, length, nu) for nu in range(count)])

    @abstractmethod
    def candidates(self, length: float, nu: int) -> Array:
        """Every u inside the segment where the derivative of order nu may be extreme."""

    @abstractmethod
    def power_candidates(self, length: float) -> Array:
        """Every u inside the segment where d = b c may be extreme."""

    @abstractmethod
    def square(self, length: float, nu: int) -> float:
        """Integral over the segment of the square of the derivative of order nu, at least 1."""

    def power(self, u: Array, length: float) -> Array:
        """Kinetic power d = b c at u."""
        return self.derivative(u, length, 1) * self.derivative(u, length, 2)

    def scaled(self, length: float, scale: float, drift: float = 0.0) -> Segment:
        """The segment whose velocity is scale b + drift; an interpolating polynomial unless the kind knows better."""
        return self.interpolated(length).scaled(length, scale, drift)

    def backwards(self, length: float) -> Segment:
        """The segment whose velocity is b(length - s); an interpolating polynomial unless the kind knows better."""
        return self.interpolated(length).backwards(length)

    def times(self, length: float, y: Array) -> Segment:
        """The segment whose acceleration is c times the Chebyshev series y in 2u - 1, with the same velocity at first.

        An interpolating polynomial unless the kind knows better.
        """

        def c(x: Array) -> Array:
            return self.derivative(0.5 * (x + 1.0), length, 2) * chebyshev.value(y, x)

        series = chebyshev.interpolated(c, f"acceleration of the {self.kind} segment times y")
        return PolynomialSegment(tuple(series.tolist()), self.velocity(length))

    def plus_derivatives(self, length: float, once: float, twice: float) -> Segment:
        """The segment with displacement a + once b + twice c, for the cam of an elastic follower (1.27).

        An interpolating polynomial unless the kind knows better.
        """

        def c(x: Array) -> Array:
            u = 0.5 * (x + 1.0)
            orders = ((2, 1.0), (3, once), (4, twice))
            return np.asarray(sum(factor * self.derivative(u, length, order) for order, factor in orders))

        series = chebyshev.interpolated(c, f"acceleration of the cam under the {self.kind} segment")
        return PolynomialSegment(tuple(series.tolist()), self._velocity_plus(length, once, twice))

    def at_rest(self, length: float, share: float) -> Segment:  # noqa: ARG002 - for kinds whose c may be infinite
        """The segment with rest where rounding, below a share of its greatest velocity, has missed one.

        It matters where c is infinite: d = b c would be, too.
        """
        return self

    def waves(self, length: float) -> Waves | None:  # noqa: ARG002 - for kinds that are waves
        """The acceleration as a polynomial and sines, where it is: a follower responds to these in closed form."""
        return None

    def interpolated(self, length: float) -> PolynomialSegment:
        """The segment with its acceleration interpolated to machine accuracy.

        Raises
        ------
        InputError
            If the acceleration is not smooth on the segment.

        Examples
        --------
        >>> from optlaws.laws.segments import SineSegment
        >>> len(SineSegment(1.0, 3.0).interpolated(0.5).acceleration)
        13
        """

        def c(x: Array) -> Array:
            return self.derivative(0.5 * (x + 1.0), length, 2)

        series = chebyshev.interpolated(c, f"acceleration of the {self.kind} segment")
        return PolynomialSegment(tuple(series.tolist()), self.velocity(length))

    def velocity(self, length: float, *, last: bool = False) -> float:
        """Velocity at the segment's start, or at its end."""
        return float(self.derivative(_END if last else _START, length, 1)[0])

    def _velocity_plus(self, length: float, once: float, twice: float) -> float:
        b, c, j = (float(self.derivative(_START, length, nu)[0]) for nu in (1, 2, 3))
        return b + once * c + twice * j

    def to_dict(self) -> dict[str, Any]:
        """The segment as plain data, from which `from_dict` constructs an equal one."""
        return {"kind": self.kind, **contents(self)}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Segment:
        """The segment that `to_dict` described.

        Raises
        ------
        InputError
            If the kind or a key is unknown, a key is missing, or a number is not finite.
        """
        if not isinstance(data, Mapping):
            raise InputError(f"a segment must be a dict, got {shortened(data)}")
        given = dict(data)
        kind = given.pop("kind", None)
        if not isinstance(kind, str) or kind not in Segment.kinds:
            raise InputError(
                f"kind of segment {shortened(kind)} is unknown; known are {', '.join(sorted(Segment.kinds))}"
            )
        segment_class = Segment.kinds[kind]
        return segment_class(**known_fields(segment_class, given, f"a {kind} segment"))

    def _check(self) -> None:
        """Turn every field into floats."""
        for field in fields(self):  # type: ignore[arg-type]
            value = getattr(self, field.name)
            many = str(field.type).startswith("tuple")
            object.__setattr__(self, field.name, numbers(value, field.name) if many else finite(value, field.name))


@dataclass(frozen=True)
class PolynomialSegment(Segment, kind="polynomial"):
    """Acceleration c = sum acceleration[n] T_n(2u - 1); velocity b0 at the segment's start.

    Examples
    --------
    >>> PolynomialSegment([-2.0, 6.0], b0=1.0).derivative(np.array([0.0, 1.0]), 0.5, 2)
    array([-8.,  4.])
    """

    acceleration: tuple[float, ...]
    b0: float = 0.0

    def __post_init__(self) -> None:
        self._check()

    def derivative(self, u: Array, length: float, nu: int) -> Array:
        return np.asarray(length ** (2.0 - nu) * self._law(length)(u, nu), dtype=np.float64)

    def derivatives(self, u: Array, length: float, count: int) -> Array:
        series = self._law(length)._all_series(count)  # noqa: SLF001 - of the same kind
        scales = length ** (2.0 - np.arange(count))
        return scales.reshape(-1, *(1,) * u.ndim) * chebyshev.values(series, 2.0 * u - 1.0)

    def candidates(self, length: float, nu: int) -> Array:
        return self._law(length)._candidates(nu)  # noqa: SLF001 - of the same kind

    def power_candidates(self, length: float) -> Array:
        return self._law(length)._power_candidates()  # noqa: SLF001 - of the same kind

    def square(self, length: float, nu: int) -> float:
        return length ** (5 - 2 * nu) * self._law(length).rms(nu) ** 2

    def scaled(self, length: float, scale: float, drift: float = 0.0) -> Segment:  # noqa: ARG002 - others need it
        return PolynomialSegment(
            tuple(scale * coefficient for coefficient in self.acceleration), scale * self.b0 + drift
        )

    def backwards(self, length: float) -> Segment:
        turned = (coefficient if n % 2 else -coefficient for n, coefficient in enumerate(self.acceleration))
        return PolynomialSegment(tuple(turned), self.velocity(length, last=True))

    def times(self, length: float, y: Array) -> Segment:  # noqa: ARG002 - what others of its kind need
        product = chebyshev.product(np.array(self.acceleration or (0.0,)), y)
        return PolynomialSegment(tuple(product.tolist()), self.b0)

    def plus_derivatives(self, length: float, once: float, twice: float) -> Segment:
        c = np.array(self.acceleration or (0.0,))
        j = chebyshev.derivative(c) / length
        s = chebyshev.derivative(j) / length
        total = c.copy()
        total[: len(j)] += once * j
        total[: len(s)] += twice * s
        return PolynomialSegment(tuple(total.tolist()), self._velocity_plus(length, once, twice))

    def waves(self, length: float) -> Waves:  # noqa: ARG002 - what others of its kind need
        return Waves(self.acceleration or (0.0,), self.b0)

    def _law(self, length: float) -> PolynomialLaw:
        # a = length² times this law in u, so that its acceleration is the segment's
        return _polynomial(self.acceleration, self.b0 / length)


@lru_cache(maxsize=256)
def _polynomial(acceleration: tuple[float, ...], b0: float) -> PolynomialLaw:
    return PolynomialLaw(acceleration, b0=b0)
