"""The inertial loader's law on a stretch of the executive law: sqrt(B² - b²), as a segment of a piecewise law."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import comb, inf
from typing import Any

import numpy as np

from optlaws.balancing.loaders.tops import VelocityDeficit, velocity_deficit
from optlaws.errors import SolverFailure
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.segments.segment import Segment
from optlaws.numbers import Array
from optlaws.numerics.panels import TERMS, Function, Panels, resolved

_PANEL_ROUNDING = 2e-15  # of the scale of a root: what its series leaves on a panel
_LEAST_ROOT = 1e-9  # of its scale: a root that is smaller is known no worse
_SHORTEST_PANEL = 1e-6  # panels of a root are cut no further


@dataclass(frozen=True)
class LoaderStretch:
    """g(t) = sqrt(B² - b²) for 0 <= t <= length, at k = origin + t or, where the end is before it, at k = origin - t.

    B is the executive law's peak velocity, unsigned; `top` says whether |b| = B at the origin.
    """

    executive: MotionLaw
    B: float
    origin: float
    end: float
    top: bool

    @property
    def length(self) -> float:
        """The length of the stretch, the greatest t."""
        return abs(self.end - self.origin)

    def value(self, t: Array, nu: int) -> Array:
        """Derivative of some order of g with respect to t."""
        values = np.empty(t.shape)
        near, between = t <= self._root_reach, (t > self._root_reach) & (t <= self._reach)
        far = ~(near | between)
        if self._deficit is not None:
            if near.any():
                values[near] = self._deficit.root.derivative(t[near], nu)
            if between.any():
                values[between] = _root(self._deficit.energy(t[between], self.B, nu))
        if far.any():
            values[far] = _root(self._energy(t[far], nu))
        return values

    def integral(self, t: Array) -> Array:
        """Integral of g from 0 to t."""
        if self._deficit is None:
            return self._far_integral(t)
        close = self._deficit.root.integral(np.minimum(t, self._root_reach))
        return close + self._far_integral(np.maximum(t, self._root_reach)) if self._panels.edges else close

    def roots(self, nu: int) -> Array:
        """Every t among which is each root of the derivative of order nu."""
        far = self._panels.roots(lambda t: self.value(t, nu), lambda t: self.value(t, nu + 1))
        return far if self._deficit is None else np.concatenate([self._deficit.root.roots(nu), far])

    def power_roots(self) -> Array:
        """Every t among which is each extreme of b c of the executive law."""

        def slope(t: Array) -> Array:
            b, c, j = (self._executive(t, nu) for nu in range(3))
            return c * c + b * j

        def curvature(t: Array) -> Array:
            b, c, j, s = (self._executive(t, nu) for nu in range(4))
            return 3.0 * c * j + b * s

        least = 0.0 if self._deficit is None or self._deficit.deficit.step == 1.0 else 1e-6 * self.length
        edges = (least, *(t for t in self._panels.edges if t > least)) if self._panels.edges else (least, self.length)
        return Panels(edges).roots(slope, curvature)

    def square(self, nu: int) -> float:
        """Integral over the stretch of the square of the derivative of order nu."""
        near = 0.0 if self._deficit is None else self._deficit.root.square(nu)
        return near if near == inf else near + self._panels.square(lambda t: self.value(t, nu))

    @kept_property
    def _deficit(self) -> VelocityDeficit | None:
        if not self.top:
            return None
        return velocity_deficit(self._executive_at, self.B, self.length, f"{self.origin:.6g}")

    @kept_property
    def _root_reach(self) -> float:
        return -1.0 if self._deficit is None else self._deficit.root.reach

    @kept_property
    def _reach(self) -> float:
        return -1.0 if self._deficit is None else self._deficit.deficit.reach

    @kept_property
    def _panels(self) -> Panels:
        return _panels_of_root(lambda t: self.value(t, 0), max(self._root_reach, 0.0), self.length, self.B)

    @kept_property
    def _far_integral(self) -> Function:
        return self._panels.integral(lambda t: self.value(t, 0))

    def _executive_at(self, t: float, nu: int) -> float:
        return float(self._executive(np.array([t]), nu)[0])

    def _executive(self, t: Array, nu: int) -> Array:
        """Derivative of some order of |b| with respect to t, one-sided at both ends."""
        forward = self.end > self.origin
        low, high = min(self.origin, self.end), max(self.origin, self.end)
        k = self.origin + t if forward else self.origin - t
        # at a break a law has its right-hand value
        last = high if high == 1.0 else np.nextafter(high, low)
        values = self.executive(np.clip(k, low, last), nu + 1)
        return values * (1.0 if forward else -1.0) ** nu * self._sign

    @kept_property
    def _sign(self) -> float:
        middle = 0.5 * (self.origin + self.end)
        return 1.0 if self.executive.b(self.origin if self.top else middle) >= 0.0 else -1.0

    def _energy(self, t: Array, nu: int) -> list[Array]:
        """Derivatives 0 to `nu` of B² - b² with respect to t."""
        b = [self._executive(t, i) for i in range(nu + 1)]
        energies = [(self.B - np.abs(b[0])) * (self.B + np.abs(b[0]))]
        energies[0] = np.maximum(energies[0], 0.0)
        for n in range(1, nu + 1):
            square = sum((comb(n, i) * b[i] * b[n - i] for i in range(n + 1)), np.zeros_like(t))
            energies.append(-square)
        return energies


@lru_cache(maxsize=256)
def stretch(executive: MotionLaw, B: float, origin: float, end: float, *, top: bool) -> LoaderStretch:
    """The stretch with these data, cached with everything computed from it."""
    return LoaderStretch(executive, B, origin, end, top)


def _root(energy: list[Array]) -> Array:
    """The highest derivative of g = sqrt(energy) from the derivatives of g², by Leibniz's rule."""
    g = [np.sqrt(energy[0])]
    with np.errstate(divide="ignore", invalid="ignore"):
        for n in range(1, len(energy)):
            cross = sum((comb(n, i) * g[i] * g[n - i] for i in range(1, n)), np.zeros_like(g[0]))
            g.append((energy[n] - cross) / (2.0 * g[0]))
    return g[-1]


def _panels_of_root(f: Function, low: float, high: float, scale: float) -> Panels:
    """Panels from low to high on which f = sqrt(scale² - b²) is resolved to rounding; none where low = high.

    Where f is small next to its scale, rounding of b is all the larger in it, and nothing finer is needed.
    """
    if not low < high:
        return Panels(())
    if not np.isfinite(f(np.linspace(low, high, TERMS))).all():
        raise SolverFailure(f"the velocity of the loader is not finite between t = {low:g} and {high:g}")

    def short(series: Array, length: float) -> bool:
        values = np.abs(series)
        rounding = _PANEL_ROUNDING * scale * max(1.0, scale / max(float(values[0]), _LEAST_ROOT * scale))
        return bool(values[-3:].max() <= rounding) or length < _SHORTEST_PANEL

    return resolved(f, Panels((low, high)), short)[0]


@dataclass(frozen=True)
class LoaderSegment(Segment, kind="loader"):
    """b = scale sqrt(B² - b_ex²) between two places of an executive law, smooth inside.

    The scale is Y, negative where the loader moves back; `top` is "start" or "end" where the executive velocity has its
    peak there, else "".

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> segment = LoaderSegment(smoothstep(2), 0.0, 0.5, scale=1.0, top="end")
    >>> segment.derivative(np.array([0.0, 1.0]), 0.5, 1)
    array([1.5, 0. ])
    """

    executive: MotionLaw
    start: float
    end: float
    scale: float
    top: str = ""

    def __post_init__(self) -> None:
        given: Any = self.executive
        if not isinstance(given, MotionLaw):
            object.__setattr__(self, "executive", MotionLaw.from_dict(given))

    def derivative(self, u: Array, length: float, nu: int) -> Array:  # noqa: ARG002 - what others of its kind need
        flat = np.atleast_1d(u)
        if nu == 0:
            from_origin = self._stretch.integral(self._times(flat))
            values = self._stretch.integral(self._times(np.zeros(1))) - from_origin if self._back else from_origin
        else:
            values = self._stretch.value(self._times(flat), nu - 1)
            if self._back and nu % 2 == 0:
                values = -values
        return np.asarray(self.scale * values.reshape(np.shape(u)))

    def candidates(self, length: float, nu: int) -> Array:  # noqa: ARG002 - what others of its kind need
        return self._places(self._stretch.roots(nu)) if nu else np.empty(0)

    def power_candidates(self, length: float) -> Array:  # noqa: ARG002 - what others of its kind need
        return self._places(self._stretch.power_roots())

    def square(self, length: float, nu: int) -> float:  # noqa: ARG002 - what others of its kind need
        return self.scale**2 * self._stretch.square(nu - 1)

    @property
    def _back(self) -> bool:
        return self.top == "end"

    @kept_property
    def _stretch(self) -> LoaderStretch:
        ends = (self.end, self.start) if self._back else (self.start, self.end)
        B = self.executive.peak(1).value
        return stretch(self.executive, B, *ends, top=bool(self.top))

    def _times(self, u: Array) -> Array:
        span = self.end - self.start
        return span * (1.0 - u) if self._back else span * u

    def _places(self, t: Array) -> Array:
        u = np.clip(t / (self.end - self.start), 0.0, 1.0)
        return 1.0 - u if self._back else u
