"""The table of a front for a controller: certified laws as Chebyshev series, their peaks, and what is proven."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import comb, prod

import numpy as np

from optlaws.errors import InputError
from optlaws.exports.polynomial_pieces import Stretch, stretches
from optlaws.laws import MotionLaw
from optlaws.numbers import Array
from optlaws.numerics import exact
from optlaws.tolerances import JUMP, LIMIT_ROUNDING, ROUNDOFF, TINY

_BOUND_ROUNDING = 2.0**-30  # of a bound of roundings: more than its own sum of positive numbers is rounded by

ORDERS = 4
#: roundings of a step, of a mixed coefficient with its own, and of a place in [-1, 1] less what its scale adds
_STEP, _MIXED, _PLACE = 4, 8, 6
_BYTES = 8
#: the highest degree of a law, whose series are summed term by term
MOST_DEGREE = 80


@dataclass(frozen=True)
class FrontTable:
    """Laws from rest to rest at ascending peak velocities, whose weighted means a controller runs.

    Attributes
    ----------
    velocities, accelerations, jerks
        B of the laws, ascending; C and J, none below that of a later law: bounds of the peaks, and between two laws the
        weighted mean bounds those of the weighted mean. Dimensionless.
    series
        For each law and piece the Chebyshev coefficients of its displacement in x from -1 to 1, shape (laws, pieces,
        terms).
    breaks
        Of the pieces, shape (pieces + 1,), in k.
    odd
        Whether the laws are of one piece and antisymmetric about its middle: only odd coefficients are stored then, and
        the constant is 1/2.
    gap
        What is proven of C: no law of the problem with at most this B has one that is less by more than this share.
    ends
        Whether this holds for the first and the last law against laws of all B: no law is as much slower or better.
    errors
        By how much a, b, c, d of a weighted mean may be missed in double precision, dimensionless.
    slack
        By which share times are lengthened, so that limits are satisfied in spite of rounding.
    """

    velocities: tuple[float, ...]
    accelerations: tuple[float, ...]
    jerks: tuple[float, ...]
    series: Array
    breaks: tuple[float, ...]
    odd: bool
    gap: float
    ends: tuple[bool, bool]
    errors: tuple[float, ...]
    slack: float

    def __len__(self) -> int:
        return len(self.velocities)

    @property
    def terms(self) -> int:
        """How many coefficients a piece has."""
        return int(self.series.shape[2])

    @property
    def degree(self) -> int:
        """The degree of the laws."""
        return 2 * self.terms - 1 if self.odd else self.terms - 1

    @property
    def size(self) -> int:
        """Bytes of the table in double precision."""
        breaks = 0 if len(self.breaks) == 2 else 2 * len(self.breaks) - 1
        return _BYTES * (self.series.size + 3 * len(self) + breaks)


def front_table(
    velocities: Sequence[float], laws: Sequence[MotionLaw], gap: float, ends: tuple[bool, bool]
) -> FrontTable:
    """The table of certified laws at ascending B.

    Parameters
    ----------
    velocities
        B of each law as its problem has it.
    laws
        Polynomials, or polynomials between the same breaks, from rest to rest.
    gap, ends
        What is proven of them, as `FrontTable` has it.

    Raises
    ------
    InputError
        If the laws are no such polynomials or do not begin and end at rest.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> table = front_table((1.5, 1.875), (smoothstep(2), smoothstep(3)), 1.0, (False, False))
    >>> table.odd, table.degree, table.size, table.velocities, table.jerks
    (True, 5, 96, (1.5, 1.875), (60.0, 60.0))
    """
    for law in laws:
        _check_rest(law)
    breaks, series, exact_series = _series(laws)
    odd = len(breaks) == 2 and not any(value for law in exact_series for value in law[0][2::2])
    peaks = np.array([[law.constants.B.value, law.constants.C.value, law.constants.J.value] for law in laws])
    peaks[:, 0] = np.maximum(peaks[:, 0], velocities)
    peaks[:, 1:] = np.maximum.accumulate(peaks[::-1, 1:])[::-1]
    if not (np.diff(peaks[:, 0]) > 0.0).all() or not np.isfinite(peaks).all():
        raise InputError("a table needs laws of ascending B and finite C and J: take a front of order 3 or more")
    stored = np.ascontiguousarray(series[:, :, 1::2]) if odd else series
    errors = _errors(series, exact_series, breaks, odd=odd)
    b, c, j = (tuple(column) for column in peaks.T.tolist())
    return FrontTable(b, c, j, stored, breaks, odd, gap, ends, errors, _slack(peaks, errors))


def _check_rest(law: MotionLaw) -> None:
    ends = [float(law.a(0.0)), float(law.a(1.0)) - 1.0, float(law.b(0.0)), float(law.b(1.0))]
    if max(map(abs, ends)) > JUMP:
        raise InputError("functions at run time move from rest to rest: take a front of laws whose ends rest")


def _series(laws: Sequence[MotionLaw]) -> tuple[tuple[float, ...], Array, list[list[list[Fraction]]]]:
    """Breaks, and for each law and piece the series of its displacement: rounded, an array, and exact."""
    parts = [list(stretches(law)) for law in laws]
    if not all(parts):
        raise InputError("functions at run time take laws of polynomials: take a front of such laws")
    breaks = _breaks(parts[0])
    if any(_breaks(other) != breaks for other in parts):
        raise InputError("a table of laws needs laws with the same breaks")
    rows = [[_chebyshev(stretch) for stretch in part] for part in parts]
    terms = max(len(row) for law in rows for row in law)
    if terms > MOST_DEGREE + 1:
        raise InputError(f"laws at run time have degrees to {MOST_DEGREE}, got {terms - 1}: take a lower degree")
    every = [[row + [Fraction(0)] * (terms - len(row)) for row in law] for law in rows]
    return breaks, np.array([[exact.rounded(row) for row in law] for law in every]), every


def _breaks(parts: Sequence[Stretch]) -> tuple[float, ...]:
    return (float(parts[0][0]), *(float(last) for _, last, _ in parts))


def _chebyshev(stretch: Stretch) -> list[Fraction]:
    """The series in x, -1 where the stretch begins and 1 where it ends."""
    low, high, powers = stretch
    return exact.exact_chebyshev([value * (high - low) ** n for n, value in enumerate(powers)])


def _errors(
    series: Array, exact_series: list[list[list[Fraction]]], breaks: tuple[float, ...], *, odd: bool
) -> tuple[float, ...]:
    """The greatest of all pieces: of the summation, and of the coefficients' own rounding."""
    errors = np.zeros(ORDERS)
    for piece, (low, high) in enumerate(pairwise(breaks)):
        stored = series[:, piece].copy()
        stored[:, 0] = 0.5 if odd else stored[:, 0]
        missed = np.array(
            [
                [abs(float(value - Fraction(number))) for value, number in zip(law[piece], row, strict=True)]
                for law, row in zip(exact_series, stored.tolist(), strict=True)
            ]
        )
        scale = 2.0 / (high - low)
        of_sum, _ = summation_bounds(np.abs(stored).max(axis=0), scale)
        _, of_table = summation_bounds(missed.max(axis=0), scale)
        errors = np.maximum(errors, np.add(of_sum, of_table))
    return tuple(errors.tolist())


def _slack(peaks: Array, errors: tuple[float, ...]) -> float:
    """Twice the greatest rounding of velocity, acceleration and jerk, and the effect of a rounded weight.

    A weight that is off by the rounding of B moves C and J by as much, times their logarithmic slopes along the front.
    """
    added = max(errors[1] / peaks[0, 0], errors[2] / peaks[-1, 1], errors[3] / peaks[-1, 2])
    width = np.diff(peaks[:, 0]) / peaks[1:, 0]
    steepest = (-np.diff(peaks[:, 1:], axis=0) / peaks[1:, 1:] / width[:, None]).max()
    return float(2.0 * (added + LIMIT_ROUNDING * (2.0 + steepest)))


def summation_bounds(magnitudes: Array, scale: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Bounds of the error and of the value of a series and its three derivatives by k, for every x in [-1, 1].

    Clenshaw's recurrence b_n = c_n + 2 x b_(n+1) - b_(n+2) is run with its derivatives, of which the order m has
    2 m b_(n+1) of the order m - 1 in place of c_n. What a step is rounded by counts as a change of c_n: at n and of the
    order s it changes the derivative m by comb(m, s) times the derivative m - s of T_n, which is greatest at x = 1. A
    step is rounded at most four times, each by a unit roundoff of its terms; they are bounded by the derivatives at 1
    of the Chebyshev polynomials of the second kind. Fused operations round less.

    Parameters
    ----------
    magnitudes
        Of the coefficients, shape (n,); of several series that are mixed by weights from 0 to 1, the greatest each.
    scale
        dx/dk, by which each derivative is multiplied.

    Examples
    --------
    >>> errors, values = summation_bounds(np.array([0.5, 0.5]), 2.0)
    >>> [f"{error:.1e}" for error in errors], [round(value, 12) for value in values]
    (['2.8e-15', '3.1e-15', '1.0e-300', '1.0e-300'], [1.0, 1.0, 0.0, 0.0])
    """
    last = len(magnitudes) - 1
    first_kind = np.array([[_at_end(n, m) for n in range(last + 2)] for m in range(ORDERS + 2)])
    rounded = magnitudes * (1.0 + _gamma(_MIXED))
    changes = _changes(rounded, first_kind)
    errors, values = [], []
    for m in range(ORDERS):
        value = float(first_kind[m, : last + 1] @ rounded)
        moved = ((2.0 * scale + _PLACE) * ROUNDOFF) * float(first_kind[m + 1, : last + 1] @ rounded)
        total = _gamma(_MIXED) * value + moved
        total += sum(comb(m, s) * float(changes[s] @ first_kind[m - s, : last + 1]) for s in range(m + 1))
        factor = scale**m * (1.0 + _BOUND_ROUNDING)
        errors.append(factor * (total + _gamma(4 * m + 4) * (value + total)) + TINY)
        values.append(scale**m * value)
    return tuple(errors), tuple(values)


def _changes(rounded: Array, first_kind: Array) -> Array:
    """Rounding bounds of each step of each order, shape (orders, n); the last sum is the step of n = 0."""
    count = len(rounded)
    changes, terms = np.zeros((ORDERS, count)), np.zeros((ORDERS, count + 2))
    # U_n is the derivative of T_(n+1), divided by n + 1
    second_kind = first_kind[1:, 1:] / np.arange(1, first_kind.shape[1])
    for n in range(count - 1, -1, -1):
        for m in range(ORDERS):
            given = rounded[n] if m == 0 else 2.0 * m * terms[m - 1, n + 1]
            changes[m, n] = _gamma(_STEP) * (given + 2.0 * terms[m, n + 1] + terms[m, n + 2])
            by_order = [changes[s, n:] + (rounded[n:] if s == 0 else 0.0) for s in range(m + 1)]
            terms[m, n] = sum(
                comb(m, s) * float(given_there @ second_kind[m - s, : count - n])
                for s, given_there in enumerate(by_order)
            )
    return changes


def _at_end(n: int, m: int) -> float:
    """The derivative of order m of T_n at 1."""
    return float(prod((n * n - i * i) / (2 * i + 1) for i in range(m)))


def _gamma(count: int) -> float:
    return count * ROUNDOFF / (1.0 - count * ROUNDOFF)
