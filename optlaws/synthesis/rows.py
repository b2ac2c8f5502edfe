"""Families of constraints that hold at every k: rows of a semi-infinite linear program, and where they bind."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from optlaws.laws.series import real_parts_of_roots
from optlaws.synthesis.space import even_gegenbauer_jet

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Family:
    """The constraint s (f(u) . x + offset(u)) <= slack . x for every u, s = 1 or, if `two_sided`, s = 1 and -1.

    f and offset are Chebyshev series in u on [-1, 1]: one column a variable. If `odd`, they are odd in u and only
    0 <= u <= 1 counts (u = 1 - 2k); otherwise u = 2 (1-2k)² - 1.
    """

    name: str
    series: Array
    offset: Array
    slack: Array
    two_sided: bool = False
    odd: bool = False

    @property
    def signs(self) -> tuple[float, ...]:
        """The values that s takes."""
        return (1.0, -1.0) if self.two_sided else (1.0,)

    @property
    def lowest(self) -> float:
        """The least u that counts."""
        return 0.0 if self.odd else -1.0

    @cached_property
    def _jet(self) -> Array:
        # value, first and second derivative side by side, the offset as a last column of each
        value = np.column_stack([self.series, self.offset])
        parts = [value]
        for _ in range(2):
            slope = np.zeros_like(value)
            lower = chebyshev.chebder(parts[-1])
            slope[: len(lower)] = lower
            parts.append(slope)
        return np.hstack(parts)

    def values(self, u: Array) -> Array:
        """f and offset with two derivatives by u, shape (3, points, variables + 1); the last column is the offset."""
        angles = np.arccos(np.minimum(np.maximum(u, -1.0), 1.0))
        flat = np.cos(np.outer(angles, np.arange(len(self.offset)))) @ self._jet
        shaped: Array = flat.reshape(len(u), 3, -1).transpose(1, 0, 2)
        return shaped

    def jet(self, u: Array, s: Array) -> Array:
        """The constraint's rows with sign and slack, and two derivatives, shaped like `values`."""
        rows: Array = self.values(u) * s[:, None]
        rows[0, :, :-1] -= self.slack
        return rows

    def rows(self, u: Array, s: Array) -> tuple[Array, Array]:
        """A and h of the rows A x <= h at the points u with signs s."""
        values = self.jet(u, s)[0]
        return values[:, :-1], -values[:, -1]

    def residual(self, x: Array, u: Array) -> Array:
        """f . x + offset at the points u, without sign and slack."""
        return np.asarray(chebyshev.chebval(u, self.series @ x + self.offset), dtype=float)

    def extremes(self, x: Array) -> tuple[Array, Array, Array]:
        """Points, signs and residuals (positive where violated) at every end and stationary point."""
        slope = np.asarray(chebyshev.chebder(self.series @ x + self.offset), dtype=np.float64)
        if self.odd:
            inner = real_parts_of_roots(slope[::2])
            inner = np.sqrt((inner + 1.0) / 2.0)
        else:
            inner = real_parts_of_roots(slope)
        u = np.concatenate([[self.lowest], np.sort(inner), [1.0]])
        value = self.residual(x, u)
        room = float(self.slack @ x)
        signs = np.repeat(self.signs, len(u))
        return np.tile(u, len(self.signs)), signs, signs * np.tile(value, len(self.signs)) - room

    def k(self, u: Array) -> Array:
        """The k in [0, 1/2] that belongs to u."""
        return (1.0 - (u if self.odd else np.sqrt(np.maximum(u + 1.0, 0.0) / 2.0))) / 2.0


@dataclass(frozen=True, eq=False)
class RatioFamily(Family):
    """A family whose columns are even Gegenbauer polynomials, `scale` times; the offset's (degree 0) is last.

    Their values grow so much toward k = 0 that a series would lose the digits of the others.
    """

    index: float = 0.5
    scale: Array = field(default_factory=lambda: np.ones(1))

    def values(self, u: Array) -> Array:
        """f and offset with two derivatives by u, by recurrence."""
        polynomials = even_gegenbauer_jet(self.index, len(self.scale) - 1, u)
        shaped = np.zeros((3, len(u), len(self.slack) + 1))
        shaped[:, :, : len(self.scale) - 1] = polynomials[:, :, 1:] * self.scale[:-1]
        shaped[:, :, -1] = polynomials[:, :, 0] * self.scale[-1]
        return shaped

    def residual(self, x: Array, u: Array) -> Array:
        """f . x + offset at the points u, by recurrence."""
        value: Array = self.values(u)[0] @ np.append(x, 1.0)
        return value


@dataclass(frozen=True, eq=False)
class Points:
    """Points of one family: positions u and signs s."""

    u: Array
    s: Array

    def joined(self, other: Points) -> Points:
        """Both sets."""
        return Points(np.concatenate([self.u, other.u]), np.concatenate([self.s, other.s]))


@dataclass(frozen=True, eq=False)
class Program:
    """Minimise objective . x subject to families and one equality, equality . x = right - equality_offset."""

    families: tuple[Family, ...]
    equality: Array
    equality_offset: float
    objective: Array

    @property
    def size(self) -> int:
        """Number of variables."""
        return len(self.objective)

    def violation(self, x: Array) -> float:
        """Largest residual over every family and every u."""
        return max(float(family.extremes(x)[2].max()) for family in self.families)
