"""Motions as controllers run them: polynomials of time or of the master between breaks, their extremes and jumps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import comb
from operator import ge
from typing import Any, NamedTuple

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.numbers import MAGNITUDE_LIMIT, Array, derivative, listed, number_or_array, numbers, real_times
from optlaws.numerics import bernstein
from optlaws.numerics.bernstein import greatest_difference
from optlaws.tolerances import POLISHING_REACH, SAME_TIME

#: a motion by its derivatives: of places and of the order nu of the derivative
Derivatives = Callable[[Array, int], Array]

_STEPS = 3


class Extreme(NamedTuple):
    """An extreme value and its place, the first one if several are equal; in machine units."""

    value: float
    x: float


@dataclass(frozen=True, init=False)
class PiecewiseMotion:
    """Polynomials between breaks, in ascending powers of x - x_i, in machine units; call it with an order nu.

    x is what the controller counts: time or the position of the master. What is not continuous at a break stays so:
    a value there is the one after it, extremes look at both sides, and `jumps` gives the size. Derivatives are those
    of the pieces; where one jumps, those above it are no impulses here.

    Parameters
    ----------
    breaks
        x_0 < x_1 < ... < x_n, shape (n + 1,).
    coefficients
        n rows; piece i is y = sum coefficients[i][m] (x - x_i)^m.

    Raises
    ------
    InputError
        If the breaks do not increase, or there is not a row of finite numbers for every piece; in its methods, if a
        place is beyond the breaks.

    Examples
    --------
    >>> motion = PiecewiseMotion([0, 1, 2], [[0, 0, 1], [1, 2, -1]])
    >>> motion(1.5), motion.extremes(1), motion.jumps(2).tolist()
    (1.75, (Extreme(value=0.0, x=0.0), Extreme(value=2.0, x=1.0)), [-4.0])
    """

    breaks: tuple[float, ...]
    coefficients: tuple[tuple[float, ...], ...]

    def __init__(self, breaks: Any, coefficients: Any) -> None:
        places = numbers(_plain(breaks), "breaks")
        if len(places) < 2 or any(map(ge, places, places[1:])):
            raise InputError(f"breaks must be at least two increasing numbers, got {shortened(places)}")
        object.__setattr__(self, "breaks", places)
        object.__setattr__(self, "coefficients", _rows(coefficients, len(places) - 1))

    def __repr__(self) -> str:
        shape = f"{len(self.coefficients)} pieces of degree {self.degree}"
        return f"PiecewiseMotion({shape} from {self.start:g} to {self.stop:g})"

    def __call__(self, x: Any, nu: int = 0) -> Any:
        places, nu = real_times(x), derivative(nu)
        outside = places[(places < self.start) | (places > self.stop)]
        if outside.size:
            raise InputError(f"x must be from {self.start!r} to {self.stop!r}, got {float(outside.flat[0])!r}")
        return number_or_array(self._values(places, nu))

    @property
    def start(self) -> float:
        """The first break of the motion."""
        return self.breaks[0]

    @property
    def stop(self) -> float:
        """The last break of the motion."""
        return self.breaks[-1]

    @kept_property
    def degree(self) -> int:
        """The highest power of any piece."""
        return max(map(len, self.coefficients)) - 1

    @kept_property
    def lengths(self) -> Array:
        """How long each piece is, shape (n,)."""
        return np.diff(self.breaks)

    def powers(self, nu: int = 0) -> Array:
        """Ascending powers of x - x_i of the derivative of order nu, a row for each piece.

        >>> PiecewiseMotion([0, 1, 2], [[0, 0, 1], [1]]).powers(1).tolist()
        [[0.0, 2.0], [0.0, 0.0]]
        """
        if nu not in self._powers:
            # of no power it is one column of zeros
            self._powers[nu] = np.asarray(np.polynomial.polynomial.polyder(self._powers[0], nu, axis=1))
        return self._powers[nu]

    def ends(self, nu: int) -> tuple[Array, Array]:
        """The derivative of order nu just after the start and just before the end of each piece."""
        table = self.powers(derivative(nu))
        return table[:, 0].copy(), _horner(table, self.lengths)

    def jumps(self, nu: int) -> Array:
        """The jump of the derivative of order nu at each inner break: the value after it less the value before.

        >>> PiecewiseMotion([0, 1, 3], [[0, 1], [1, -0.5]]).jumps(1).tolist()
        [-1.5]
        """
        first, last = self.ends(nu)
        return first[1:] - last[:-1]

    def seam(self, nu: int) -> float:
        """The jump of the derivative of order nu at the repetition of the motion; for nu 0, the net displacement.

        >>> PiecewiseMotion([0, 1], [[0, 0, 1]]).seam(1)
        -2.0
        """
        first, last = self.ends(nu)
        return float(first[0] - last[-1])

    def extremes(self, nu: int) -> tuple[Extreme, Extreme]:
        """The least and the greatest value of the derivative of order nu, both sides of every break counted.

        They are enclosed by Bernstein coefficients of the pieces, halved until nothing is left but rounding.

        >>> PiecewiseMotion([0, 1], [[0, 1, -1]]).extremes(0)
        (Extreme(value=0.0, x=0.0), Extreme(value=0.25, x=0.5))
        """
        low, high = (self._top(derivative(nu), sign) for sign in (-1.0, 1.0))
        return Extreme(-low.value if low.value else 0.0, low.x), high

    def peak(self, nu: int) -> Extreme:
        """The greatest magnitude of the derivative of order nu."""
        low, high = self.extremes(nu)
        return max(Extreme(0.0 - low.value, low.x), high, key=lambda extreme: (extreme.value, -extreme.x))

    def rms(self, nu: int) -> float:
        """Root mean square of the derivative of order nu, impulses left out.

        >>> round(PiecewiseMotion([0, 1], [[0, 1]]).rms(0) ** 2, 12)
        0.333333333333
        """
        table = self.powers(derivative(nu))
        u, weights = np.polynomial.legendre.leggauss(table.shape[1])
        squares = _horner(table[:, None], self.lengths[:, None] * (u + 1.0) / 2.0) ** 2 @ (weights / 2.0)
        return float(np.sqrt(squares @ self.lengths / (self.stop - self.start)))

    def in_single(self) -> PiecewiseMotion:
        """The motion with breaks and coefficients rounded to REAL32.

        Raises
        ------
        InputError
            If a number is beyond REAL32, or two breaks round to one.

        >>> PiecewiseMotion([0, 0.1], [[0.1]]).in_single().breaks
        (0.0, 0.10000000149011612)
        """
        with np.errstate(over="ignore"):
            breaks = np.array(self.breaks, dtype=np.float32)
            rows = [np.array(row, dtype=np.float32) for row in self.coefficients]
        if not all(np.isfinite(numbers).all() for numbers in (breaks, *rows)):
            raise InputError("a number of the motion is beyond REAL32 (3.4e38): choose units that make it smaller")
        if (np.diff(breaks) <= 0).any():
            raise InputError("two breaks are the same in REAL32: take fewer pieces or let x start at 0")
        return PiecewiseMotion(breaks, [row.tolist() for row in rows])

    def deviation(self, motion: Derivatives | PiecewiseMotion, nu: int = 0, breaks: Sequence[float] = ()) -> Extreme:
        """The greatest magnitude of the difference of a derivative to another motion, over the whole interval.

        Of two piecewise motions it is that of a polynomial, to rounding. Of a function of places and of an order it is
        an estimate: where series through its values at places resolve it, nothing is proven of what it does between
        them; where it is not smooth, `breaks` say.

        Raises
        ------
        InputError
            If the intervals differ, or a function is not smooth between the breaks.

        >>> line = PiecewiseMotion([0, np.pi / 2], [[0, 2 / np.pi]])
        >>> greatest = line.deviation(lambda x, nu: np.sin(x + nu * np.pi / 2))
        >>> round(greatest.value, 9), round(greatest.x, 6)
        (0.210513662, 0.880689)
        """
        nu = derivative(nu)
        if isinstance(motion, PiecewiseMotion):
            return self.minus(motion).peak(nu)
        greatest = greatest_difference(lambda x: self._values(x, nu), lambda x: motion(x, nu), self._with(breaks))
        return Extreme(*greatest)

    def minus(self, other: PiecewiseMotion) -> PiecewiseMotion:
        """The difference, between the breaks of both.

        >>> PiecewiseMotion([0, 2], [[0, 1]]).minus(PiecewiseMotion([0, 1, 2], [[0, 1], [1]])).coefficients
        ((0.0, 0.0), (0.0, 1.0))
        """
        if (self.start, self.stop) != (other.start, other.stop):
            raise InputError(
                f"motions are compared over the same interval, got {self.start!r} to {self.stop!r} "
                f"and {other.start!r} to {other.stop!r}"
            )
        breaks = np.unique(np.concatenate([self.breaks, other.breaks]))
        first, second = self._cut(breaks), other._cut(breaks)
        table = np.zeros((len(first), max(first.shape[1], second.shape[1])))
        table[:, : first.shape[1]] = first
        table[:, : second.shape[1]] -= second
        return PiecewiseMotion(breaks, table)

    def then(self, other: PiecewiseMotion) -> PiecewiseMotion:
        """First this motion and then another that begins where it ends."""
        if other.start != self.stop:
            raise InputError(f"the next motion must begin at {self.stop!r}, where this one ends, got {other.start!r}")
        return PiecewiseMotion((*self.breaks, *other.breaks[1:]), (*self.coefficients, *other.coefficients))

    def in_units(self, x: float = 1.0, y: float = 1.0) -> PiecewiseMotion:
        """The motion with places times x and values times y, coefficients rounded once.

        >>> PiecewiseMotion([0, 0.5], [[0, 0, 1]]).in_units(720.0, 1000.0).coefficients
        ((0.0, 0.0, 0.0019290123456790122),)
        """
        across, up = Fraction(x), Fraction(y)
        rows = [[float(Fraction(c) * up / across**n) for n, c in enumerate(row)] for row in self.coefficients]
        return PiecewiseMotion([float(Fraction(place) * across) for place in self.breaks], rows)

    @kept_property
    def _powers(self) -> dict[int, Array]:
        table = np.zeros((len(self.coefficients), self.degree + 1))
        for i, row in enumerate(self.coefficients):
            table[i, : len(row)] = row
        return {0: table}

    def _values(self, places: Array, nu: int) -> Array:
        which = np.searchsorted(self.breaks[1:-1], places, side="right")
        return np.asarray(_horner(self.powers(nu)[which], places - np.array(self.breaks)[which]))

    def _with(self, breaks: Sequence[float]) -> Array:
        """The breaks with others between them; what lies as near as rounding is the same break."""
        breaks_here, others = np.array(self.breaks), np.array([x for x in breaks if self.start < x < self.stop])
        after = np.searchsorted(breaks_here, others)
        apart = np.minimum(breaks_here[after] - others, others - breaks_here[after - 1])
        return np.unique(np.concatenate([breaks_here, others[apart > SAME_TIME * (self.stop - self.start)]]))

    def _cut(self, breaks: Array) -> Array:
        """Coefficients of the same polynomials on finer pieces."""
        table = self.powers()
        which = np.searchsorted(self.breaks[1:-1], breaks[:-1], side="right")
        moved, by = table[which], breaks[:-1] - np.array(self.breaks)[which]
        count = table.shape[1]
        columns = [
            sum((comb(m, n) * moved[:, m] * by ** (m - n) for m in range(n, count)), np.zeros(len(by)))
            for n in range(count)
        ]
        return np.stack(columns, axis=1)

    def _top(self, nu: int, sign: float) -> Extreme:
        table = self.powers(nu)
        control = bernstein.from_powers(table * self.lengths[:, None] ** np.arange(table.shape[1]))
        value, row, u = bernstein.top(sign * control)
        if u in {0.0, 1.0}:
            return Extreme(value, self.breaks[row + int(u)])
        # the place near that found by halving where the derivative is stationary
        length = float(self.lengths[row])
        s, slope, bend = u * length, self.powers(nu + 1)[row], self.powers(nu + 2)[row]
        for _ in range(_STEPS):
            steepness, curvature = float(_horner(slope, s)), float(_horner(bend, s))
            step = steepness / curvature if curvature else 0.0
            if abs(step) > POLISHING_REACH * length or not 0.0 <= s - step <= length:
                break
            s -= step
        return Extreme(value, self.breaks[row] + length * (s / length))


def _horner(table: Array, x: Any) -> Any:
    total = table[..., -1]
    for n in range(table.shape[-1] - 2, -1, -1):
        total = total * x + table[..., n]
    return total


def _rows(coefficients: Any, count: int) -> tuple[tuple[float, ...], ...]:
    """Rows of finite floats, one for each piece; an array is checked as a whole."""
    rows = listed(_plain(coefficients), "coefficients", count + 1)
    if len(rows) != count:
        raise InputError(f"coefficients must be {count} rows, one between breaks, got {len(rows)}")
    table = coefficients if isinstance(coefficients, np.ndarray) and coefficients.ndim == 2 else np.empty((0, 0))
    if table.dtype == np.float64 and table.size and (np.abs(table) <= MAGNITUDE_LIMIT).all():
        return tuple(map(tuple, rows))
    return tuple(numbers(_plain(row), f"coefficients[{i}]") or (0.0,) for i, row in enumerate(rows))


def _plain(values: Any) -> Any:
    return values.tolist() if isinstance(values, np.ndarray) else values
