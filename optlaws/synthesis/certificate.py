"""Lower bounds that stand by themselves: contacts and multipliers, checked by weak duality with numpy alone.

Every law of the problem obeys the constraints below. Their sum with multipliers m >= 0 (any sign for the equation),
divided by the sum of the multipliers of |c| <= C, bounds C from below by L(law) = sum of m times left side. The
multipliers are such that L hardly depends on the free coefficients z; what rounding leaves of that dependence is
charged against the bound, with z bounded through the stroke: b <= B gives a mean of |b| of at most 2B - 1.
The functions here share nothing with the solver. They know the velocities of eq. 8 with odd Z as (k(1-k))^(l-1) times
even Gegenbauer polynomials of index l - 1/2 in 2k - 1, of which the first alone carries the stroke.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev, legendre
from numpy.typing import NDArray

from optlaws.errors import InputError

Array = NDArray[np.float64]

UPPER = "c <= C"
LOWER = "c >= -C"
CHORD = "(b(1/2) - b) / (1-2k)^2 >= 0"
RATIO = "b / (k(1-k))^(l-1) >= 0"
MIDDLE = "b(1/2) = B"
CONSTRAINTS = (UPPER, LOWER, CHORD, RATIO, MIDDLE)
_STRAIGHT = 1e-9  # below it sin(mp) / sin(p) is m to rounding


@dataclass(frozen=True)
class Contact:
    """A constraint at one k with its multiplier (dimensionless).

    Examples
    --------
    >>> Contact("c <= C", 0.25, 0.5).multiplier
    0.5
    """

    constraint: str
    k: float
    multiplier: float

    def __post_init__(self) -> None:
        if self.constraint not in CONSTRAINTS:
            msg = f"constraint {self.constraint!r} is unknown; known are {', '.join(CONSTRAINTS)}"
            raise InputError(msg)
        if not 0.0 <= self.k <= 1.0 or not np.isfinite(self.multiplier):
            msg = f"a contact needs k in [0, 1] and a finite multiplier, got {self!r}"
            raise InputError(msg)


@dataclass(frozen=True)
class Certificate:
    """Contacts and multipliers that prove a lower bound of C, or that no law exists.

    It speaks of all laws (8) of order l with Z of the given degree, zero end values, b(1/2) = B >= b and, where
    `monotone`, b >= 0: symmetric or not (the contacts stand for themselves and their mirror images).

    Examples
    --------
    >>> import optlaws
    >>> solution = optlaws.synthesize(optlaws.Problem(B=1.859, order=4, basis=optlaws.Chebyshev(9)))
    >>> bool(solution.certificate.bound <= solution.constants.C.value)
    True
    """

    order: int
    degree: int
    B: float
    monotone: bool
    contacts: tuple[Contact, ...]

    @cached_property
    def bound(self) -> float:
        """The proven lower bound of C, recomputed from the contacts with numpy alone; -inf where there is none."""
        share = sum(c.multiplier for c in self.contacts if c.constraint in {UPPER, LOWER} and c.multiplier > 0.0)
        return excess(self) / share if share > 0.0 else -np.inf

    @cached_property
    def proves_infeasible(self) -> bool:
        """Whether the contacts of the velocity constraints alone contradict each other (Farkas)."""
        return not any(c.constraint in {UPPER, LOWER} for c in self.contacts) and excess(self) > 0.0

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict with the recomputed bound (None where there is none)."""
        bound = self.bound if np.isfinite(self.bound) else None
        return {**asdict(self), "contacts": [asdict(c) for c in self.contacts], "bound": bound}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Certificate:
        """Read what `to_dict` wrote; the bound is recomputed, not read."""
        contacts = tuple(Contact(**c) for c in data["contacts"])
        return cls(int(data["order"]), int(data["degree"]), float(data["B"]), bool(data["monotone"]), contacts)


def excess(certificate: Certificate) -> float:
    """Least value over all laws of the problem of the constraints' sum, right sides taken over; a rigorous lower bound.

    Negative multipliers of inequalities and forward contacts where b >= 0 is not asked count as zero.
    """
    names = np.array([c.constraint for c in certificate.contacts])
    k = np.array([c.k for c in certificate.contacts])
    multipliers = np.array([c.multiplier for c in certificate.contacts])
    usable = (names == MIDDLE) | (multipliers > 0.0)
    if not certificate.monotone:
        usable &= names != RATIO
    multipliers = np.where(usable, multipliers, 0.0)

    functionals = np.zeros((len(k), 1 + (certificate.degree + 1) // 2))
    signs = {UPPER: 1.0, LOWER: -1.0, CHORD: -1.0, RATIO: -1.0, MIDDLE: 1.0}
    values = {UPPER: _acceleration, LOWER: _acceleration, CHORD: _chord, RATIO: _ratio, MIDDLE: _middle}
    for name, sign in signs.items():
        mine = names == name
        if mine.any():
            functionals[mine] = sign * values[name](certificate.order, certificate.degree, k[mine])
    base, *residual = multipliers @ functionals
    base -= certificate.B * float(multipliers[names == MIDDLE].sum())
    share = float(multipliers[(names == UPPER) | (names == LOWER)].sum())
    return float(base - _rounding(certificate, np.asarray(residual), base / share if share > 0.0 else None))


def _rounding(certificate: Certificate, residual: Array, claim: float | None) -> float:
    """Most that what depends on z can be worth, over all laws that could contradict the claim.

    A law that contradicts the claim C >= claim has |c| < claim; a law that contradicts infeasibility has b <= B and
    stroke 1, so a mean of |b| of at most 2B - 1. Either bounds all Legendre moments of the law; the base law's own are
    at most 1 for b and its rise and fall of velocity for c.
    """
    if claim is None:
        weights = _least_extension(_velocity, certificate.order, certificate.degree) @ residual
        return float(2.0 * certificate.B * np.abs(weights).sum())
    weights = _least_extension(_acceleration, certificate.order, certificate.degree) @ residual
    base = 2.0 * float(_velocity(certificate.order, certificate.degree, np.array([0.5]))[0, 0])
    return float((max(claim, 0.0) + base) * np.abs(weights).sum())


def _ratio(order: int, degree: int, k: Array) -> Array:
    polynomials = _gegenbauer(order - 0.5, degree + 1, 2.0 * k - 1.0)[: degree + 2 : 2]
    return polynomials.T * _scale(order, degree)


def _velocity(order: int, degree: int, k: Array) -> Array:
    weight: Array = (k * (1.0 - k))[:, None] ** (order - 1)
    return weight * _ratio(order, degree, k)


def _acceleration(order: int, degree: int, k: Array) -> Array:
    y, m = 2.0 * k - 1.0, np.arange(0, degree + 2, 2)
    if order == 1:
        polynomials = _gegenbauer(1.5, degree + 1, y)
        return np.where(m > 0, 2.0 * polynomials[m - 1].T, 0.0) * _scale(order, degree)
    factor = -2.0 * (m + 1) * (m + 2 * order - 2) / (4.0 * (2 * order - 3))
    weight = (k * (1.0 - k))[:, None] ** (order - 2)
    return weight * _gegenbauer(order - 1.5, degree + 2, y)[m + 1].T * (factor * _scale(order, degree))


def _middle(order: int, degree: int, k: Array) -> Array:
    return np.tile(_velocity(order, degree, np.array([0.5])), (len(k), 1))


def _chord(order: int, degree: int, k: Array) -> Array:
    even = _even_series(order, degree)
    p = np.arcsin(np.clip(2.0 * k - 1.0, -1.0, 1.0))
    m = np.arange(len(even))
    near = np.abs(p) < _STRAIGHT
    safe = np.where(near, 1.0, p)
    ratio = np.where(near[:, None], m, np.sin(np.outer(safe, m)) / np.sin(safe)[:, None])
    values: Array = (2.0 * (-1.0) ** m * ratio**2) @ even
    return values


def _gegenbauer(index: float, degree: int, y: Array) -> Array:
    rows = np.empty((degree + 1, len(y)))
    rows[0] = 1.0
    rows[1:2] = 2.0 * index * y
    for n in range(2, degree + 1):
        rows[n] = (2.0 * (n + index - 1.0) * y * rows[n - 1] - (n + 2.0 * index - 2.0) * rows[n - 2]) / n
    return rows


@lru_cache(maxsize=256)
def _scale(order: int, degree: int) -> Array:
    # the base law's stroke is 1; the free velocities have root mean square 1
    y, weights = legendre.leggauss(2 * order + degree)
    velocities = ((1.0 - y * y) / 4.0) ** (order - 1) * _gegenbauer(order - 0.5, degree + 1, y)[: degree + 2 : 2]
    scale = 1.0 / np.sqrt(velocities**2 @ weights / 2.0)
    scale[0] = 2.0 / (velocities[0] @ weights)
    return np.asarray(scale)


@lru_cache(maxsize=256)
def _even_series(order: int, degree: int) -> Array:
    # velocities as series in T_2m(2k-1)
    count = 2 * order + degree
    y = chebyshev.chebpts1(count)
    series = 2.0 / count * chebyshev.chebvander(y, count - 1).T @ _velocity(order, degree, (1.0 + y) / 2.0)
    series[0] /= 2.0
    return np.asarray(series[::2])


@lru_cache(maxsize=256)
def _least_extension(values: Callable[[int, int, Array], Array], order: int, degree: int) -> Array:
    """Matrix from a functional's values on the free functions to weights of their Legendre moments.

    A moment is the integral of P_m(2k-1) times the function: at most the mean magnitude of the function.
    """
    count = 2 * order + degree
    y, weights = legendre.leggauss(count)
    free = values(order, degree, (1.0 + y) / 2.0)[:, 1:]
    moments = legendre.legvander(y, count - 1).T @ (0.5 * weights[:, None] * free)
    return np.asarray(np.linalg.pinv(moments.T), dtype=np.float64)
