"""Segments of piecewise laws: polynomials, constant power. A new kind is one class."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import lru_cache
from math import inf, log, prod
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws.polynomial import PolynomialLaw
from optlaws.laws.storage import contents, known_fields
from optlaws.lazy import Registry
from optlaws.numbers import finite, numbers

Array = NDArray[np.float64]


class Segment(ABC):
    """A stretch of a motion law in u = (k - start) / length, u in [0, 1]; frozen, with a name and plain contents.

    A kind is a frozen dataclass of numbers and tuples of numbers, declared with its name, for example
    ``class SplineSegment(Segment, kind="spline")``. Where it lies is known to the law alone, so every method is
    told the length; derivatives are with respect to k.

    Examples
    --------
    >>> Segment.from_dict({"kind": "power", "b0": 0.0, "b1": 1.5})
    PowerSegment(b0=0.0, b1=1.5)
    """

    kind: ClassVar[str]
    kinds: ClassVar[Registry[type[Segment]]] = Registry("segment")

    def __init_subclass__(cls, *, kind: str, **kwargs: object) -> None:
        super().__init_subclass__(**kwargs)
        cls.kind = kind
        Segment.kinds[kind] = cls

    @abstractmethod
    def derivative(self, u: Array, length: float, nu: int) -> Array:
        """Derivative of order nu of a at u, shape of u; for nu = 0 the displacement since the segment's start."""

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

    def to_dict(self) -> dict[str, Any]:
        """The segment as plain data, from which `from_dict` makes an equal one."""
        return {"kind": self.kind, **contents(self)}

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> Segment:
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
        made = Segment.kinds[kind]
        return made(**known_fields(made, given, f"a {kind} segment"))

    def _check(self) -> None:
        """Turn every field into floats."""
        for one in fields(self):  # type: ignore[arg-type]
            value = getattr(self, one.name)
            many = str(one.type).startswith("tuple")
            object.__setattr__(self, one.name, numbers(value, one.name) if many else finite(value, one.name))


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

    def derivative(self, u: Array, length: float, nu: int) -> Array:  # noqa: D102
        return np.asarray(length ** (2.0 - nu) * self._law(length)(u, nu), dtype=np.float64)

    def candidates(self, length: float, nu: int) -> Array:  # noqa: D102
        return self._law(length)._candidates(nu)  # noqa: SLF001

    def power_candidates(self, length: float) -> Array:  # noqa: D102
        return self._law(length)._power_candidates()  # noqa: SLF001

    def square(self, length: float, nu: int) -> float:  # noqa: D102
        return length ** (5 - 2 * nu) * self._law(length).rms(nu) ** 2

    def _law(self, length: float) -> PolynomialLaw:
        # a = length² times this law in u, so that its acceleration is the segment's
        return _polynomial(self.acceleration, self.b0 / length)


@dataclass(frozen=True)
class PowerSegment(Segment, kind="power"):
    """Constant kinetic power: b² runs straight from b0² to b1², so that d = (b1² - b0²) / (2 length) throughout.

    This is b = sqrt(p + q s) with p = b0² and q = 2d, written so that a velocity of zero at either end is exact.
    There c and all derivatives above are infinite, and given as such; the integral of c² is infinite too.

    Parameters
    ----------
    b0, b1
        Velocities at the two ends, not both zero and not of opposite signs.

    Examples
    --------
    >>> segment = PowerSegment(0.0, 1.5)
    >>> segment.derivative(np.array([0.0, 1.0]), 0.5, 2), segment.power(np.array([0.0, 1.0]), 0.5)
    (array([inf, 1.5]), array([2.25, 2.25]))
    """

    b0: float
    b1: float

    def __post_init__(self) -> None:
        self._check()
        if self.b0 * self.b1 < 0.0 or self.b0 == self.b1 == 0.0:
            raise InputError(f"velocities of a power segment must not differ in sign or both be zero, got {self}")

    def derivative(self, u: Array, length: float, nu: int) -> Array:  # noqa: D102
        sign = 1.0 if self.b0 + self.b1 > 0.0 else -1.0
        square = self.b0**2 * (1.0 - u) + self.b1**2 * u
        b = np.sqrt(square)
        if nu == 0:
            first = abs(self.b0)
            total = np.where(b + first == 0.0, 1.0, b + first)
            return sign * u * length * (2.0 / 3.0) * (first * first + first * b + square) / total
        order = nu - 1
        rate = 2.0 * self._power(length)
        if order == 0 or rate == 0.0:
            return sign * b if order == 0 else np.zeros_like(u)
        factor = sign * prod((0.5 - i) * rate for i in range(order))
        with np.errstate(divide="ignore", over="ignore"):
            return np.asarray(factor * square ** (0.5 - order))

    def power(self, u: Array, length: float) -> Array:
        """Kinetic power d = b c at u, the same everywhere and finite where c is not."""
        return np.full(np.shape(u), self._power(length))

    def candidates(self, length: float, nu: int) -> Array:  # noqa: ARG002, D102
        return np.empty(0)

    def power_candidates(self, length: float) -> Array:  # noqa: ARG002, D102
        return np.empty(0)

    def square(self, length: float, nu: int) -> float:  # noqa: D102
        # with v = b², v' = q constant: the derivative of order nu is q^m v^(1/2-m) times a number, m = nu - 1
        m, q = nu - 1, 2.0 * self._power(length)
        start, end = self.b0 * self.b0, self.b1 * self.b1
        if m > 0 and (q == 0.0 or start * end == 0.0):
            return 0.0 if q == 0.0 else inf
        if m == 0:
            return 0.5 * length * (start + end)
        factor = prod(0.5 - i for i in range(m)) ** 2 * q ** (2 * m - 1)
        if m == 1:
            return factor * log(end / start)
        return factor * (end ** (2 - 2 * m) - start ** (2 - 2 * m)) / (2 - 2 * m)

    def _power(self, length: float) -> float:
        return 0.5 * (self.b1 - self.b0) * (self.b1 + self.b0) / length


@lru_cache(maxsize=256)
def _polynomial(acceleration: tuple[float, ...], b0: float) -> PolynomialLaw:
    return PolynomialLaw(acceleration, b0=b0)
