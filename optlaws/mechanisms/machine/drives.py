"""What drives a machine: laws as exact pieces in time, and as Chebyshev series of a, b and c at every time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from optlaws.kept import kept_property
from optlaws.laws import MotionLaw, PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import Segment, Wave, Waves
from optlaws.laws.segments.sine import SineSegment
from optlaws.mechanisms.machine.state_space import DriveStretch
from optlaws.numbers import Array
from optlaws.numerics import chebyshev
from optlaws.numerics.panels import Panels, resolved

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace

_COUNT = 41  # coefficients of what is interpolated
_RADIANS = 10.0  # of the fastest sine in a stretch
_VELOCITY_RESOLVED = 1e-14  # of the velocity: what a series may miss anywhere
_VELOCITY_ABSORBED = 1e-15  # the same times half the length on which it is missed


@dataclass(frozen=True, eq=False)
class Forcing:
    """Displacement of the base over one stretch of time, s = time - start in [0, length]: a polynomial and sines.

    Times are in durations of the rise. `acceleration` is the Chebyshev series, in 2 s/length - 1, of what is no sine in
    c.

    >>> rise = Forcing(0.0, 1.0, 0.0, 0.0, np.zeros(1), (Wave(2 * np.pi, 2 * np.pi, 0.0),))
    >>> rise.derivative(np.array([1.0]), 0).round(12).tolist()
    [1.0]
    """

    start: float
    length: float
    a0: float
    b0: float
    acceleration: Array
    sines: tuple[Wave, ...] = ()

    def derivative(self, s: Array, nu: int) -> Array:
        """Derivative of order `nu` of a at s."""
        if not self.sines:
            return self._steady(s, nu)
        first, *others = (SineSegment(*sine).derivative(s, 1.0, nu) for sine in self.sines)
        swing: Array = sum(others, first)
        return swing if nu > 1 and not self.acceleration.any() else swing + self._steady(s, nu)

    @kept_property
    def series(self) -> tuple[Array, Array, Array]:
        """Chebyshev series of a, b and c, without sines."""
        velocity = chebyshev.integral(self.length * self.acceleration, self.b0)
        return chebyshev.integral(self.length * velocity, self.a0), velocity, self.acceleration

    @kept_property
    def _known(self) -> dict[int, Array]:
        return dict(enumerate(self.series))

    def _of_order(self, nu: int) -> Array:
        if nu not in self._known:
            self._known[nu] = chebyshev.derivative(self._of_order(nu - 1)) / self.length
        return self._known[nu]

    def _steady(self, s: Array, nu: int) -> Array:
        return chebyshev.value(self._of_order(nu), 2.0 * s / self.length - 1.0)


def forcings(
    law: MotionLaw, start: float = 0.0, length: float = 1.0, a0: float | None = None, stroke: float = 1.0
) -> tuple[Forcing, ...]:
    """Pieces of a0 + stroke (law(k) - law(0)), k = (time - start) / length; a0 is the law's own unless given."""
    return _Frame(law, start, length, float(law.a(0.0)) if a0 is None else a0, stroke).pieces()


@dataclass(frozen=True)
class _Frame:
    """A law in units of time."""

    law: MotionLaw
    start: float
    length: float
    a0: float
    stroke: float

    def pieces(self) -> tuple[Forcing, ...]:
        law = self.law
        if isinstance(law, PolynomialLaw):
            return (self._forcing(Waves(law.acceleration or (0.0,), law.b0), 0.0, 1.0),)
        if isinstance(law, PiecewiseLaw):
            stretches = zip(law.segments, pairwise(law.breaks), strict=True)
            return tuple(piece for segment, (low, high) in stretches for piece in self._segment(segment, low, high))
        return tuple(self._interpolated(lambda k: np.asarray(law.b(k)), 0.0, 1.0))

    def _segment(self, segment: Segment, low: float, high: float) -> list[Forcing]:
        if (waves := segment.waves(high - low)) is not None:
            return [self._forcing(waves, low, high)]
        return self._interpolated(lambda k: segment.derivative((k - low) / (high - low), high - low, 1), low, high)

    def _place(self, low: float, high: float) -> tuple[float, float, float]:
        a0 = self.a0 + self.stroke * (float(self.law.a(low)) - float(self.law.a(0.0)))
        return self.start + self.length * low, self.length * (high - low), a0

    def _forcing(self, waves: Waves, low: float, high: float) -> Forcing:
        scale = self.stroke / self.length**2
        sines = (Wave(scale * sine.amplitude, sine.frequency / self.length, sine.phase) for sine in waves.sines)
        c = scale * np.array(waves.acceleration)
        return Forcing(*self._place(low, high), self.stroke / self.length * waves.b0, c, tuple(sines))

    def _interpolated(self, velocity: Callable[[Array], Array], low: float, high: float) -> list[Forcing]:
        ends = 0.5 * (low + high) + 0.5 * (high - low) * chebyshev.nodes(_COUNT)
        size = float(np.abs(velocity(ends)).max()) or 1.0

        def short(b: Array, length: float) -> bool:
            missed = float(np.abs(b[-4:]).max()) / size
            return missed <= _VELOCITY_RESOLVED or 0.5 * missed * length <= _VELOCITY_ABSORBED

        panels, series = resolved(velocity, Panels((low, high), _COUNT), short)
        pieces = []
        for (first, last), b in zip(pairwise(panels.edges), series.T, strict=True):
            c = tuple((chebyshev.derivative(b) / (last - first)).tolist())
            pieces.append(self._forcing(Waves(c, float(chebyshev.value(b, -1.0))), first, last))
        return pieces


def of_law(
    law: MotionLaw, start: float = 0.0, length: float = 1.0, a0: float | None = None, stroke: float = 1.0
) -> list[DriveStretch]:
    """A law as it drives a machine, a0 + stroke (law(k) - law(0)) with k = (time - start) / length."""
    return [drive for forcing in forcings(law, start, length, a0, stroke) for drive in _drives(forcing)]


def rest(start: float, length: float, level: Array | float) -> DriveStretch:
    """A dwell at displacements, one for each column."""
    series = np.zeros((1, 3, np.size(level)))
    series[0, 0] = level
    return DriveStretch(start, length, series)


def of_space(space: LawSpace) -> list[DriveStretch]:
    """The drives of all laws of a space at once: a column for each free function, the base law's last."""
    x = chebyshev.nodes(_terms(space))
    drives = []
    for low, high in pairwise(space.breaks):
        k = low + 0.5 * (high - low) * (x + 1.0)
        values = np.stack([_values(space, nu, k) for nu in range(3)], axis=1)
        series = chebyshev.from_values(values.reshape(len(k), -1)).reshape(values.shape)
        drives.append(DriveStretch(float(low), float(high - low), np.ascontiguousarray(series)))
    return drives


def backward(drives: Sequence[DriveStretch], start: float, length: float, level: Array) -> list[DriveStretch]:
    """The return of such drives, level - (a - a(0)), stretched to a length."""
    panels = []
    low = drives[0].ends[0][0]
    for drive in drives:
        series = -drive.series / length ** np.arange(3.0)[:, None]
        series[0, 0] += level + low
        panels.append(DriveStretch(start + length * drive.start, length * drive.length, series))
    return panels


def _terms(space: LawSpace) -> int:
    """Coefficients that every law of a space has at most, on each piece."""
    return 3 + space.degree_of(1)


def _values(space: LawSpace, nu: int, k: Array) -> Array:
    """Columns of a derivative at k; of symmetric laws the second half mirrors the first."""
    family = space.derivative(nu, "", np.zeros(space.terms))
    mirrored = space.symmetric & (k > 0.5)
    columns = family.columns(1.0 - 2.0 * np.where(mirrored, 1.0 - k, k))[0]
    if nu != 1:
        columns[mirrored] *= -1.0
    if nu == 0 and mirrored.any():
        # also a single function that is not at half the stroke there goes on
        columns[mirrored] += 2.0 * family.columns(np.zeros(1))[0]
    return np.asarray(columns)


def _drives(forcing: Forcing) -> list[DriveStretch]:
    if not forcing.sines:
        # as it is: values at nodes would round all coefficients as much as the greatest, which shakes the machine
        exact = np.zeros((len(forcing.acceleration) + 2, 3, 1))
        for order, coefficients in enumerate(forcing.series):
            exact[: len(coefficients), order, 0] = coefficients
        return [DriveStretch(forcing.start, forcing.length, exact)]
    fastest = max(sine.frequency for sine in forcing.sines)
    count = max(1, ceil(fastest * forcing.length / _RADIANS))
    length = forcing.length / count
    terms = max(len(forcing.acceleration) + 2, _COUNT)
    places = 0.5 * length * (chebyshev.nodes(terms) + 1.0)
    drives = []
    for i in range(count):
        s = np.minimum(i * length + places, forcing.length)
        values = np.column_stack([forcing.derivative(s, nu) for nu in range(3)])
        series = np.asarray(chebyshev.from_values(values))[:, :, None]
        drives.append(DriveStretch(forcing.start + i * length, length, series))
    return drives
