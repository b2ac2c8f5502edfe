"""Rows of a box for the peaks of a body that shares a law's energy: B, C and D of its loader, linearised.

With I, the integral of sqrt(B² - b²) over the first half, as a variable beside the velocities, C at most M says
4 |p| <= 2 M I h(q), h = sqrt(q r)/b a function of q alone, and D at most M says |c| <= 4 M I²/b. In a box h, 1/b and I²
lie below straight lines, and products of two ranges below McCormick's planes. I itself is at most its tangent.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, isfinite, sqrt

import numpy as np
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.synthesis.families.energy import Energy, EnergyFamily
from optlaws.synthesis.families.family import ConstraintFamily
from optlaws.synthesis.problem.expression import leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import model_of
from optlaws.synthesis.proof.duality import Sublevel
from optlaws.synthesis.proof.nodes import Contact
from optlaws.synthesis.proof.power.box import Box, BoxRows, Places
from optlaws.tolerances import AWAY_FROM_REST

_FLAT_SECANT = 1e-12  # of a range: one that is narrower has the secant of a point
_SECANT_SERIES = 1e-3  # of a parameter: below it a series is nearer than the quotient
_ENERGY_OUTWARD = 1e-12  # of an energy's bounds: more than they are rounded by
_MIDDLE = 1e-6  # of t squared: nearer to the middle B - b has no digits left

#: X² (1 - X) is nowhere above
_MOST = 4.0 / 27.0
_STEPS = 4


@dataclass(frozen=True, eq=False)
class SecantOverestimator:
    """A straight line above a function in a range, and the function's least and greatest values."""

    slope: Array
    height: Array
    least: Array
    greatest: Array

    def where(self, good: NDArray[np.bool_]) -> SecantOverestimator:
        """The lines where they are good, zero elsewhere."""
        return SecantOverestimator(
            *(np.where(good, part, 0.0) for part in (self.slope, self.height, self.least, self.greatest))
        )


def secant_over_inverse(low: Array, high: Array) -> SecantOverestimator:
    """The chord of 1/b between positive numbers.

    >>> line = secant_over_inverse(np.ones(1), np.full(1, 2.0))
    >>> line.slope.tolist(), line.height.tolist()
    ([-0.5], [1.5])
    """
    return SecantOverestimator(-1.0 / (low * high), 1.0 / low + 1.0 / high, 1.0 / high, 1.0 / low)


def secant_over_root(B: float, square: Array, low: Array, high: Array) -> SecantOverestimator:
    """A line above h(q) = sqrt(q (2 B - t² q)) / (B - t² q), which is first concave in q, then convex.

    With b = B - t² q that is sqrt(B² - b²) / (t b). Where b is not positive throughout the line means nothing, and its
    `greatest` is inf.

    Parameters
    ----------
    B
        The peak velocity.
    square
        t², for each place.
    low, high
        The ranges of q, at least 0.

    Examples
    --------
    >>> line = secant_over_root(2.0, np.zeros(1), np.zeros(1), np.ones(1))  # h is the root of q
    >>> line.slope.tolist(), line.height.tolist()
    ([1.0], [0.25])
    """
    ends = [_root(B, square, q) for q in (low, high)]
    width = high - low
    flat = width <= _FLAT_SECANT * np.maximum(high, _FLAT_SECANT)
    rise = np.where(np.isfinite(ends[1]), ends[1], 0.0) - np.where(np.isfinite(ends[0]), ends[0], 0.0)
    slope = np.where(flat, 0.0, rise / np.where(flat, 1.0, width))
    turn = _turn(B, square, slope)
    between = np.where((turn > low) & (turn < high), turn, low)
    height = np.maximum(ends[0] - slope * low, ends[1] - slope * high)
    height = np.maximum(height, _root(B, square, between) - slope * between)
    return SecantOverestimator(slope, height, ends[0], ends[1])


def _root(B: float, square: Array, q: Array) -> Array:
    fall = square * q
    with np.errstate(divide="ignore", invalid="ignore"):
        values: Array = np.sqrt(q * np.maximum(2.0 * B - fall, 0.0)) / (B - fall)
    return np.where(fall < B, values, np.inf)


def _turn(B: float, square: Array, slope: Array) -> Array:
    """The end of the range of small q on which h is concave; inf if the range is unbounded."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        eta = 1.0 / (B * slope) ** 2
        kappa = square * eta
        # with X = 1 - t² x it is X² (1 - X) = kappa, of which the greatest root has a closed form
        X = 1.0 / 3.0 + 2.0 / 3.0 * np.cos(np.arccos(np.clip(1.0 - 2.0 * kappa / _MOST, -1.0, 1.0)) / 3.0)
        x = np.where(kappa < _SECANT_SERIES, eta * (1.0 + 2.0 * kappa), (1.0 - X) / square)
        for _ in range(_STEPS):
            rest = 1.0 - square * x
            x = x - (x * rest**2 - eta) / (rest * (1.0 - 3.0 * square * x))
        turn = B * x / (1.0 + np.sqrt(np.maximum(1.0 - square * x, 0.0)))
    return np.where(np.isfinite(turn) & (slope > 0.0) & (kappa < _MOST), turn, np.inf)


TANGENT = "tangent of the energy"
#: which planes bound the two products: from the greatest or the least of each first factor
_PLANES = ("++", "+-", "-+", "--")


def applies(problem: Problem) -> bool:
    """Whether a peak of a body that shares the energy is in the problem and boxes can bound it: b >= 0, one B."""
    model = model_of(problem)
    shared = [family for family in model.program.families if isinstance(family, EnergyFamily)]
    known = [family for family in shared if len(family.factors) > 1]
    if not known or not problem.monotone or not isinstance(problem.B, float):
        return False
    bounds = Sublevel.of(model).greatest_values(1.0)
    names = {family.name for family in shared}
    return all(constant.convex or constant.name in names for constant in problem.constants) and all(
        isfinite(bounds.get(name, inf)) for name in model.places
    )


class EnergyRows(BoxRows):
    """The rows of a problem with peaks of a loader, where `applies` is true; parameters as for `BoxRows`."""

    extra = 1

    def __init__(self, problem: Problem, claim: float, points: Sequence[float]) -> None:
        super().__init__(problem, claim, points)
        self.B = float(problem.B)  # type: ignore[arg-type] # `applies` says so
        self.place = self.size - 1
        self.shared = [family for family in self.model.program.families if isinstance(family, EnergyFamily)]
        self.peaks = {family.name: family for family in self.shared if len(family.factors) > 1}
        self.energy: Energy = self.shared[0].energy
        self.greatest: dict[str, float] = Sublevel.of(self.model).greatest_values(claim)
        self.least = {constant.name: float(constant.limit(problem) or 0.0) for constant in problem.constants}

    @property
    def names(self) -> tuple[str, ...]:
        """A name for each peak and each pair of planes."""
        return tuple(_named(name, planes) for name in self.peaks for planes in _PLANES)

    @property
    def alone(self) -> tuple[str, ...]:
        """The tangent of I, and of each peak velocity of the body."""
        return (TANGENT, *(family.name for family in self.shared if family.name not in self.peaks))

    @property
    def branched(self) -> list[int]:
        """I, and what is minimised together with others."""
        others = [self.model.places[name] for name in self.peaks if name in self.model.places]
        return [self.place] if self._single else [*others, self.place]

    @property
    def _single(self) -> bool:
        return len(list(leaves(self.problem.objective))) == 1

    def is_curved(self, family: ConstraintFamily) -> bool:
        """Whether the family is a peak of the body."""
        return isinstance(family, EnergyFamily) and family.name in self.peaks

    def kinds(self, box: Box) -> list[tuple[str, float]]:
        """Both signs of all planes, without redundant ones where a peak has a single bound."""
        del box
        rows = []
        for name in self.peaks:
            # alone, a peak is as great as the claim allows where that is any help
            planes = _PLANES[::2] if self._single or name not in self.model.places else _PLANES
            rows += [(_named(name, pair), sign) for pair in planes for sign in (1.0, -1.0)]
        return rows

    def places(self, k: Array) -> Places:
        """Rows of b, of q, of p and of c."""
        below = self._columns(self.energy.below, k)
        divided = [family for family in self.peaks.values() if family.divided]
        fall = self._columns(divided[0].factors[1], k) if divided else np.zeros_like(below)
        return Places(k, (self.derivative(1, k), self.mapped(below), self.mapped(fall), self.derivative(2, k)))

    def root(self) -> Box:
        low, high = self.brackets_at(self.points)
        others = sorted(self.model.places, key=self.model.places.__getitem__)
        bottom = [self.least.get(name, 0.0) for name in others]
        top = [self.greatest[name] for name in others]
        first, last = self._integral
        return Box(np.concatenate([low, bottom, [first]]), np.concatenate([high, top, [last]]))

    @kept_property
    def _integral(self) -> tuple[float, float]:
        """Least and greatest I: from 1/B² + 1/(Y B)² < 1, and from how fast sqrt(B² - b²) can fall."""
        most = 0.5 * self.B * sqrt(1.0 - 1.0 / self.B**2) * (1.0 + _ENERGY_OUTWARD)
        least = 0.0
        for name, family in self.peaks.items():
            peak = self._greatest(name)
            if family.divided:
                least = max(least, self.B**2 / (4.0 * peak * most))
            else:
                least = max(least, self.B**3 / (12.0 * peak * most**2))
        return min(least, most) * (1.0 - _ENERGY_OUTWARD), most

    def brackets_at(self, k: Array) -> tuple[Array, Array]:
        known = (np.array([0.0, 0.5]), np.array([0.0, self.B]), np.array([0.0, self.B]))
        return self._everywhere(known, k, self._rates({}, self._integral[1]))

    def brackets(self, box: Box, k: Array, velocity: Array) -> tuple[Array, Array]:
        """Least and greatest velocity at the places k of the laws in the box."""
        ends = np.array([0.0, self.B])
        sides = (np.maximum(side[: self.terms], 0.0) for side in (box.low, box.high))
        low, high = (np.append(ends, np.minimum(side, self.B)) for side in sides)
        known = (np.concatenate([[0.0, 0.5], self.points]), low, high)
        peaks = {name: self._bounds(box, name)[1] for name in self.peaks}
        first, last = self._everywhere(known, k, self._rates(peaks, float(box.high[self.place])))
        least, most = box.extent(velocity)
        return np.maximum(first, least), np.minimum(last, most)

    def _rates(self, peaks: dict[str, float], integral: float) -> tuple[float, float]:
        """Upper bounds of the rates of sqrt(B² - b²) and b²."""
        speed, power = inf, inf
        for name, family in self.peaks.items():
            peak = peaks.get(name, self._greatest(name))
            if family.divided:
                speed = min(speed, 2.0 * peak * integral)
            else:
                power = min(power, 8.0 * peak * integral**2)
        return speed, power

    def _everywhere(
        self, known: tuple[Array, Array, Array], k: Array, rates: tuple[float, float]
    ) -> tuple[Array, Array]:
        at, low, high = known
        away = np.abs(k[:, None] - at)
        least, most = np.zeros(len(k)), np.full(len(k), self.B)
        speed, power = rates
        if isfinite(speed):
            # sqrt(B² - b²) is the greater the less b is
            upper = (np.sqrt(self.B**2 - low**2) + speed * away).min(axis=1)
            lower = np.maximum((np.sqrt(self.B**2 - high**2) - speed * away).max(axis=1), 0.0)
            least = np.maximum(least, np.sqrt(np.maximum(self.B**2 - upper**2, 0.0)))
            most = np.minimum(most, np.sqrt(np.maximum(self.B**2 - lower**2, 0.0)))
        if isfinite(power):
            least = np.maximum(least, np.sqrt(np.maximum((low**2 - power * away).max(axis=1), 0.0)))
            most = np.minimum(most, np.sqrt((high**2 + power * away).min(axis=1)))
        return least * (1.0 - _ENERGY_OUTWARD), np.minimum(most * (1.0 + _ENERGY_OUTWARD), self.B)

    def curved(self, box: Box, places: Places, name: str, signs: Array) -> Array:
        """Rows s p <= M I h/2 or s c <= 4 M I²/b by the planes with the given name."""
        peak, _, planes = name.rpartition(", ")
        family = self.peaks[peak]
        velocity, below, fall, acceleration = places.rows
        low, high = self.brackets(box, places.k, velocity)
        good = (low > AWAY_FROM_REST * self.B) & (high >= low)
        low, high = np.where(good, low, 0.5 * self.B), np.where(good, high, 0.5 * self.B)
        if family.divided:
            square = (1.0 - 2.0 * places.k) ** 2
            line = secant_over_root(self.B, square, *self._below_range(box, square, below, (low, high)))
            bounded, shape, share = fall, below, 0.5
        else:
            line, bounded, shape, share = secant_over_inverse(low, high), acceleration, velocity, 4.0
        good &= np.isfinite(line.greatest)
        line = line.where(good)
        product, bounds = self._product(box, family, planes[1])
        bounding = signs[:, None] * bounded
        # (M I) h <= top h + bottom (M I) - top bottom, and the other way round
        flank, corner = (bounds[1], line.least) if planes[0] == "+" else (bounds[0], line.greatest)
        over = flank * line.slope[:, None] * shape + corner[:, None] * product
        over[:, -1] += flank * line.height - flank * corner
        return np.where(good[:, None], bounding - share * over, 0.0)

    def _product(self, box: Box, family: EnergyFamily, plane: str) -> tuple[Array, tuple[float, float]]:
        """A row above M I, or above M I², in the box, with the least and greatest value of that product."""
        least, most = float(box.low[self.place]), float(box.high[self.place])
        row = np.zeros(self.size + 1)
        row[self.place] = 1.0
        if not family.divided:
            # the chord of the square
            row *= least + most
            row[-1] = -least * most
            least, most = least * least, most * most
        low, high = self._bounds(box, family.name)
        bounds = (low * least, high * most)
        if family.name not in self.model.places:
            return high * row, bounds
        flank, corner = (high, least) if plane == "+" else (low, most)
        row = flank * row
        row[self.model.places[family.name]] += corner
        row[-1] -= flank * corner
        return row, bounds

    def _below_range(self, box: Box, square: Array, below: Array, velocity: tuple[Array, Array]) -> tuple[Array, Array]:
        """Least and greatest q in the box: an affine function of the law, and B - b = t² q; rounded outward."""
        least, most = box.extent(below)
        greatest = np.append(np.maximum(np.abs(box.low), np.abs(box.high)), 1.0)
        blur = _ENERGY_OUTWARD * (np.abs(below) @ greatest)
        wide = np.where(square > _MIDDLE, square, np.inf)
        first = (self.B * (1.0 - _ENERGY_OUTWARD) - velocity[1]) / wide
        last = np.where(square > _MIDDLE, (self.B * (1.0 + _ENERGY_OUTWARD) - velocity[0]) / wide, np.inf)
        low = np.maximum(np.maximum(least - blur, first), 0.0)
        return low, np.maximum(np.minimum(most + blur, last), low)

    def beside(self, box: Box) -> list[tuple[Contact, Array]]:
        """I at most its tangent at a law in the box, and M I >= B/2 by its own."""
        middle = np.zeros(self.variables)
        middle[: self.terms] = self.coordinates(0.5 * (box.low + box.high))
        above = -self.mapped(self.energy.majorant(middle)[None])[0]
        above[self.place] += 1.0
        speeds = [family.name for family in self.shared if family.name not in self.peaks]
        steps = [(TANGENT, above), *((name, self._velocity(box, name)) for name in speeds)]
        return [(Contact(name, 1.0, 0.0, 0.0), row) for name, row in steps]

    def _velocity(self, box: Box, name: str) -> Array:
        """B/(2 I) <= M: 1/I is at least its tangent in the middle of the box."""
        middle = 0.5 * float(box.low[self.place] + box.high[self.place])
        row = np.zeros(self.size + 1)
        row[self.place] = -0.5 * self.B / middle**2
        row[-1] = self.B / middle
        if name in self.model.places:
            row[self.model.places[name]] = -1.0
        else:
            row[-1] -= self._greatest(name)
        return row

    def _columns(self, family: ConstraintFamily, k: Array) -> Array:
        columns: Array = family.columns(2.0 * (1.0 - 2.0 * k) ** 2 - 1.0)[0]  # type: ignore[attr-defined]
        return columns

    def _bounds(self, box: Box, name: str) -> tuple[float, float]:
        """Least and greatest value of a peak in the box; the same number where it is only bounded."""
        if name in self.model.places:
            place = self.model.places[name]
            return float(box.low[place]), float(box.high[place])
        return self._greatest(name), self._greatest(name)

    def _greatest(self, name: str) -> float:
        return self.greatest[name]


def _named(peak: str, planes: str) -> str:
    return f"{peak}, {planes}"
