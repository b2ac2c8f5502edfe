"""What a machine makes of a file: curves through rounded points, chains of rounded arcs, a profile with waves."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, tau
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.cams.curves.jets import Jet, Pair, variable
from optlaws.cams.curves.plane_curve import PlaneCurve
from optlaws.cams.cutting.biarcs import Arcs

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Splined:
    """The closed cubic spline through points, over the chords between them: what drawing programs draw.

    Its curvature is continuous everywhere.

    Parameters
    ----------
    points
        Metres, shape (n, 2); the last is the first again.

    Examples
    --------
    >>> corners = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], [1.0, 0.0]])
    >>> round(float(np.linalg.norm(Splined(corners)(np.array(0.7)))), 3)
    0.972
    """

    points: Array

    @property
    def breaks(self) -> tuple[float, ...]:
        """The points, by the way along the chords."""
        lengths = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        return (0.0, *np.cumsum(lengths).tolist())

    def __call__(self, places: Array, nu: int = 0) -> Array:
        """Points, or derivatives by the way along the chords."""
        return np.asarray(periodic(self.breaks, self.points)(places, nu))


@dataclass(frozen=True, eq=False)
class PolarSplined:
    """The curve whose radius is the closed cubic spline through radii at even angles around the centre."""

    radii: Array

    @property
    def breaks(self) -> tuple[float, ...]:
        """The angles of the radii."""
        return tuple(np.linspace(0.0, tau, len(self.radii)).tolist())

    def __call__(self, places: Array, nu: int = 0) -> Array:
        """Points, or derivatives by the angle around the centre."""
        radius = periodic(self.breaks, self.radii)
        angle = np.asarray(places, dtype=np.float64)
        factorials = np.cumprod([1.0, *range(1, nu + 1)])
        terms = Jet(tuple(radius(angle, i) / factorials[i] for i in range(nu + 1)))
        sine, cosine = variable(angle, nu).waves()
        return np.stack([(terms * cosine).derivative(nu), (terms * sine).derivative(nu)], axis=-1)


@dataclass(frozen=True, eq=False)
class Chain:
    """Arcs as a curve: its parameter grows by one along each."""

    arcs: Arcs

    @property
    def breaks(self) -> tuple[float, ...]:
        """Where one arc ends and the next begins."""
        return tuple(float(i) for i in range(len(self.arcs.points) + 1))

    def __call__(self, places: Array, nu: int = 0) -> Array:
        """Points, or derivatives by the parameter."""
        at = np.asarray(places, dtype=np.float64)
        which = np.clip(np.floor(at).astype(int), 0, len(self.arcs.points) - 1)
        share = at - which
        curved = _on_circles(self.arcs, which, share, nu)
        chords = (self.arcs.ends - self.arcs.points)[which]
        straight = [self.arcs.points[which] + share[..., None] * chords, chords, 0.0 * chords][min(nu, 2)]
        return np.where((self.arcs.bulges[which] == 0.0)[..., None], straight, curved)


def _on_circles(arcs: Arcs, which: Array, share: Array, nu: int) -> Array:
    turn = 4.0 * np.arctan(arcs.bulges)[which]
    straight = arcs.bulges == 0.0
    centres = np.where(straight[:, None], 0.0, arcs.centres)[which]
    out = arcs.points[which] - centres
    angle = turn * share + 0.5 * pi * nu
    x, y = out[..., 0], out[..., 1]
    turned = np.stack([x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)], axis=-1)
    return np.asarray(turned * (turn**nu)[..., None] + (centres if nu == 0 else 0.0))


@dataclass(frozen=True)
class Wavy(PlaneCurve):
    """A curve with an error along its normals: a wave of so many periods a turn.

    Parameters
    ----------
    base
        The curve.
    amplitude
        Metres.
    waves
        Periods over the turn.
    shift
        Phase of the wave, rad.
    """

    base: PlaneCurve
    amplitude: float
    waves: int
    shift: float

    @property
    def breaks(self) -> tuple[float, ...]:
        """Those of the curve, and every half wave, so that each part is simple."""
        waves = np.linspace(*self.base.interval, 2 * self.waves + 1)
        return tuple(np.unique(np.concatenate([self.base.breaks, waves])).tolist())

    @property
    def closed(self) -> bool:
        """As the curve."""
        return self.base.closed

    @property
    def turning(self) -> float:
        """As the curve."""
        return self.base.turning

    def jets(self, angle: Array, order: int, *, before: bool = False) -> Pair:  # noqa: D102
        x, y = self.base.jets(angle, order, before=before)
        along_x, along_y = self.base.normal_jets(angle, order, before=before)
        _, wave = (variable(angle, order) * float(self.waves) + self.shift).waves()
        return x + along_x * wave * self.amplitude, y + along_y * wave * self.amplitude


def periodic(places: tuple[float, ...], values: Array) -> Any:  # noqa: ANN401 - scipy's
    """The closed cubic spline through values."""
    from scipy.interpolate import make_interp_spline

    return make_interp_spline(np.array(places), values, k=3, bc_type="periodic")
