"""Symmetric executive laws of one B, with the velocity and acceleration of their loaders and what these change by.

With t = 1 - 2k the velocity is b = B - u q, u = t², and q is linear in the coordinates. With p = q + u dq/du
the executive has c = 4 t p, and the loader b_l = Y t sqrt(r) and |c_l| = 4 Y b |p| / sqrt(r) with r = q (B + b):
nothing of it is 0/0 at the top, t = 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from optlaws.laws import MotionLaw, PolynomialLaw
from optlaws.synthesis.families.family import Family
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.synthesis.spaces.polynomials.space import polynomial_space

Array = NDArray[np.float64]

_NODES, _SAMPLES = 48, 201
_ROOT = 1e-12  # in units of B²: keeps roots real on the way to a law with b <= B


@dataclass(frozen=True, eq=False)
class Curve:
    """Values at places t of [0, 1], and their gradients by the coordinates: a row for each place."""

    value: Array
    gradient: Array


@dataclass(frozen=True, eq=False)
class Rows:
    """q, p and b / (base law's b) at places t, linear in the coordinates with the constant last."""

    t: Array
    q: Array
    p: Array
    ratio: Array


class LoaderSpace:
    """Symmetric laws from rest to rest with b(1/2) = B and polynomial Z, by free coordinates y (dimensionless).

    Parameters
    ----------
    B, order, degree
        Peak velocity, number of end conditions, degree of Z.

    Examples
    --------
    >>> space = LoaderSpace(1.875, 3, 5)
    >>> space.size, space.law(np.zeros(space.size)).b(0.5)
    (2, 1.875)
    """

    def __init__(self, B: float, order: int, degree: int) -> None:
        self.B = B
        self.laws = polynomial_space(BoundaryConditions.rest(order), degree, symmetric=True)
        row, base = self.laws.middle[:-1], float(self.laws.middle[-1])
        self.origin: Array = row * (B - base) / float(row @ row)
        self.free: Array = np.asarray(np.linalg.svd(row[None])[2][1:].T, dtype=np.float64)
        self.size = len(row) - 1
        slack = np.zeros(self.laws.terms)
        self._below, self._forward = self.laws.below(slack), self.laws.forward(slack)
        nodes, weights = legendre.leggauss(_NODES + 4 * degree)
        self._nodes, self._weights = self.rows(0.5 * (nodes + 1.0)), 0.25 * weights

    def coordinates(self, y: Array) -> Array:
        """Coordinates in the space of all symmetric laws."""
        found: Array = self.origin + self.free @ y
        return found

    def projected(self, law: MotionLaw) -> Array:
        """The y whose velocity is nearest to that of a law, in the mean square at some places."""
        at = self.rows(np.linspace(0.0, 1.0, _SAMPLES))
        fall = at.t[:, None] ** 2 * at.q
        wanted = self.B - np.asarray(law.b(0.5 * (1.0 - at.t))) - fall[:, -1]
        return np.asarray(np.linalg.lstsq(fall[:, :-1], wanted, rcond=None)[0], dtype=np.float64)

    def law(self, y: Array) -> PolynomialLaw:
        """The executive law."""
        return self.laws.law(self.coordinates(y))

    def rows(self, t: Array) -> Rows:
        """What is linear in the law, at places t."""
        q, slope = -self._columns(self._below, t)
        ratio = -self._columns(self._forward, t)[0]
        return Rows(t, *(self._reduced(one) for one in (q, q + (2.0 * t * t)[:, None] * slope, ratio)))

    def Y(self, y: Array) -> Curve:
        """The energy parameter, 1/2 over the integral of sqrt(B² - b²) from 0 to 1/2, by Gauss's rule."""
        at = self._nodes
        _, b, root = self._roots(at, y)
        integral = float(self._weights @ (at.t * root))
        gradient = (self._weights * at.t * b / root) @ at.q[:, :-1]
        Y = 0.5 / integral
        return Curve(np.array([Y]), -2.0 * Y * Y * gradient[None])

    def acceleration(self, at: Rows, y: Array) -> Curve:
        """c of the executive law, in its first half."""
        slope = 4.0 * at.t[:, None] * at.p
        return Curve(_at(slope, y), slope[:, :-1])

    def loader_acceleration(self, at: Rows, y: Array) -> Curve:
        """-c of the loader, in the first half."""
        Y = self.Y(y)
        _, b, root = self._roots(at, y)
        p, size = _at(at.p, y), float(Y.value[0])
        value = 4.0 * size * b * p / root
        by_p = 4.0 * size * b / root
        by_q = -4.0 * size * p * (at.t**2 / root + b * b / root**3)
        gradient = by_p[:, None] * at.p[:, :-1] + by_q[:, None] * at.q[:, :-1]
        return Curve(value, gradient + np.outer(value / size, Y.gradient[0]))

    def velocity(self, at: Rows, y: Array) -> Array:
        """b of the executive law."""
        found: Array = self.B - at.t**2 * _at(at.q, y)
        return found

    def _roots(self, at: Rows, y: Array) -> tuple[Array, Array, Array]:
        q = _at(at.q, y)
        b = self.B - at.t**2 * q
        return q, b, np.sqrt(np.maximum(q * (self.B + b), _ROOT * self.B**2))

    def _reduced(self, columns: Array) -> Array:
        found: Array = np.column_stack([columns[:, :-1] @ self.free, columns[:, :-1] @ self.origin + columns[:, -1]])
        return found

    @staticmethod
    def _columns(family: Family, t: Array) -> Array:
        columns: Array = family.columns(2.0 * t * t - 1.0)[:2]  # type: ignore[attr-defined]
        return columns


def _at(rows: Array, y: Array) -> Array:
    found: Array = rows @ np.append(y, 1.0)
    return found
