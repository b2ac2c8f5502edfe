"""Curves that a machine makes of a file: through rounded points, chains of rounded arcs, a profile with waves."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import tau

import numpy as np

from optlaws.cams.curves.plane_curve import CurveAlongNormals, PiecewiseCurve, derivatives
from optlaws.cams.cutting.arcs_and_chords import Arcs
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.enclosures.interval import Interval
from optlaws.numerics.enclosures.taylor import Pair, turned, variable


class CurveByJets(ABC):
    """A closed curve that is known by its jets, over a parameter of its own."""

    @abstractmethod
    def jets(self, places: Array | Interval, order: int) -> Pair:
        """Both coordinates with their Taylor terms by the parameter."""

    def __call__(self, places: Array, nu: int = 0) -> Array:
        """Points, or derivatives by the parameter."""
        return derivatives(self, places, nu)


@dataclass(frozen=True, eq=False)
class PointSpline(CurveByJets):
    """The closed cubic spline through points, m, shape (n, 2), over chords between them: what drawing programs draw.

    Its curvature is continuous everywhere; the last point is the first again.
    """

    points: Array

    @kept_property
    def breaks(self) -> tuple[float, ...]:
        """The points, by the way along the chords."""
        lengths = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        return (0.0, *np.cumsum(lengths).tolist())

    @kept_property
    def _pieces(self) -> PiecewiseCurve:
        return periodic(self.breaks, self.points)

    def jets(self, places: Array | Interval, order: int) -> Pair:
        """Both coordinates with their Taylor terms by the way along the chords."""
        x, y = self._pieces.jets(places, order)
        return x, y


@dataclass(frozen=True, eq=False)
class PolarSpline(CurveByJets):
    """The curve whose radius is the closed cubic spline through radii at even angles around the centre."""

    radii: Array

    @kept_property
    def breaks(self) -> tuple[float, ...]:
        """The angles of the radii."""
        return tuple(np.linspace(0.0, tau, len(self.radii)).tolist())

    @kept_property
    def _pieces(self) -> PiecewiseCurve:
        return periodic(self.breaks, self.radii[:, None])

    def jets(self, places: Array | Interval, order: int) -> Pair:
        """Both coordinates with their Taylor terms by the angle around the centre."""
        (radius,) = self._pieces.jets(places, order)
        sine, cosine = variable(places, order).waves()
        return radius * cosine, radius * sine


@dataclass(frozen=True, eq=False)
class ArcChain(CurveByJets):
    """Arcs as a curve: its parameter grows by one along each."""

    arcs: Arcs

    @property
    def breaks(self) -> tuple[float, ...]:
        """The parameters where one arc ends and the next begins."""
        return tuple(float(i) for i in range(len(self.arcs.points) + 1))

    def jets(self, places: Array | Interval, order: int) -> Pair:
        """Both coordinates with their Taylor terms by the parameter."""
        middle = places.middle if isinstance(places, Interval) else np.asarray(places, dtype=np.float64)
        which = np.clip(np.floor(middle).astype(int), 0, len(self.arcs.points) - 1)
        share = variable(places - which.astype(np.float64), order)
        straight = (self.arcs.bulges == 0.0)[:, None]
        # a line is the way along its chord, an arc a radius that turns about its centre
        centres = np.where(straight, self.arcs.points, self.arcs.centres)
        ways, radii = np.where(straight, self.arcs.ends - self.arcs.points, 0.0), self.arcs.points - centres
        x, y = turned(
            (share * 0.0 + radii[which, 0], share * 0.0 + radii[which, 1]),
            share * (4.0 * np.arctan(self.arcs.bulges))[which],
        )
        return x + share * ways[which, 0] + centres[which, 0], y + share * ways[which, 1] + centres[which, 1]


@dataclass(frozen=True)
class WavyCurve(CurveAlongNormals):
    """A curve with an error along its normals: a wave of so many periods a turn, amplitude in m, shift in rad."""

    amplitude: float
    waves: int
    shift: float

    @property
    def breaks(self) -> tuple[float, ...]:
        """Breaks of the curve, and every half wave, so that each part is simple."""
        waves = np.linspace(*self.base.interval, 2 * self.waves + 1)
        return tuple(np.unique(np.concatenate([self.base.breaks, waves])).tolist())

    def jets(self, angle: Array | Interval, order: int, *, before: bool = False) -> Pair:  # noqa: D102
        x, y = self.base.jets(angle, order, before=before)
        along_x, along_y = self.base.normal_jets(angle, order, before=before)
        _, wave = (variable(angle, order) * float(self.waves) + self.shift).waves()
        return x + along_x * wave * self.amplitude, y + along_y * wave * self.amplitude


def periodic(places: tuple[float, ...], values: Array) -> PiecewiseCurve:
    """The closed cubic spline through rows of values."""
    from scipy.interpolate import make_interp_spline

    spline = make_interp_spline(np.array(places), values, k=3, bc_type="periodic")
    return PiecewiseCurve.of_spline(spline.t, spline.c, 3)
