"""Readers of the files that cut a cam, made for the tests alone: what a cutter makes of them, in millimetres."""

import re
from dataclasses import dataclass
from math import cos, radians, sin, tau
from pathlib import Path

import numpy as np
from ezdxf.entities.lwpolyline import LWPolyline
from ezdxf.entities.spline import Spline as SplineEntity
from ezdxf.filemanagement import readfile
from numpy.typing import NDArray
from scipy.interpolate import BSpline

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Line:
    start: Array
    stop: Array

    def distances(self, points: Array) -> Array:
        way = self.stop - self.start
        share = np.clip((points - self.start) @ way / (way @ way), 0.0, 1.0)
        return np.asarray(np.linalg.norm(points - self.start - share[:, None] * way, axis=1))


@dataclass(frozen=True)
class Arc:
    """From one place to another around a centre, counterclockwise or not."""

    start: Array
    stop: Array
    centre: Array
    left: bool

    @property
    def radius(self) -> float:
        return float(np.linalg.norm(self.start - self.centre))

    def distances(self, points: Array) -> Array:
        sign = 1.0 if self.left else -1.0
        first, last, at = (np.arctan2(one[..., 1], one[..., 0]) for one in self._seen(points))
        whole = np.mod(sign * (last - first), tau)
        within = np.mod(sign * (at - first), tau) <= whole
        radial = np.abs(np.linalg.norm(points - self.centre, axis=1) - self.radius)
        ends = np.minimum(*(np.linalg.norm(points - end, axis=1) for end in (self.start, self.stop)))
        return np.asarray(np.where(within, radial, ends))

    def leaves(self) -> Array:
        return self._tangent(self.start)

    def arrives(self) -> Array:
        return self._tangent(self.stop)

    def _tangent(self, at: Array) -> Array:
        x, y = (at - self.centre) / np.linalg.norm(at - self.centre)
        return np.array([-y, x]) if self.left else np.array([y, -x])

    def _seen(self, points: Array) -> tuple[Array, Array, Array]:
        return self.start - self.centre, self.stop - self.centre, points - self.centre


def dxf_spline(file: Path) -> BSpline:
    (one,) = readfile(file).modelspace().query("SPLINE")
    assert isinstance(one, SplineEntity)
    return BSpline(np.array(one.knots), np.array([tuple(point)[:2] for point in one.control_points]), one.dxf.degree)


def dxf_corners(file: Path) -> Array:
    (one,) = readfile(file).modelspace().query("LWPOLYLINE")
    assert isinstance(one, LWPolyline)
    assert one.closed
    return np.array([point[:2] for point in one.get_points()])


def dxf_arcs(file: Path) -> list[Arc | Line]:
    """Arcs in the order of the file, each from its first angle to its last, counterclockwise."""
    found: list[Arc | Line] = []
    for one in readfile(file).modelspace():
        if one.dxftype() == "LINE":
            found.append(Line(np.array(tuple(one.dxf.start)[:2]), np.array(tuple(one.dxf.end)[:2])))
        elif one.dxftype() == "ARC":
            centre = np.array(tuple(one.dxf.center)[:2])
            ends = [radians(angle) for angle in (one.dxf.start_angle, one.dxf.end_angle)]
            start, stop = (centre + one.dxf.radius * np.array([cos(angle), sin(angle)]) for angle in ends)
            found.append(Arc(start, stop, centre, left=True))
    return found


def svg_beziers(file: Path) -> Array:
    """Control points of the path's Bézier curves, shape (n, 4, 2), with y upward; the picture must be at scale."""
    text = file.read_text("utf-8")
    size = re.search(r'width="([\d.]+)mm" height="([\d.]+)mm" viewBox="\S+ \S+ ([\d.]+) ([\d.]+)"', text)
    assert size is not None
    assert size.groups()[:2] == size.groups()[2:]
    path = re.search(r'id="profile"[^>]*d="M ([^"]*)Z"', text)
    assert path is not None
    numbers = np.array([float(one) for one in re.findall(r"-?\d+\.?\d*", path[1])]).reshape(-1, 2) * [1.0, -1.0]
    ends = np.concatenate([numbers[:1], numbers[3::3]])
    return np.stack([ends[:-1], numbers[1::3], numbers[2::3], ends[1:]], axis=1)


def table(file: Path) -> Array:
    return np.loadtxt(file, delimiter=",", skiprows=2)


def moves(file: Path) -> list[Arc | Line]:
    at, found = np.zeros(2), list[Arc | Line]()
    for line in file.read_text("utf-8").splitlines():
        words = dict(re.findall(r"([GXYIJF])(-?[\d.]+)", line)) if line[:1] == "G" else {}
        if "X" not in words:
            continue
        to = np.array([float(words["X"]), float(words["Y"])])
        if words["G"] == "1":
            found.append(Line(at, to))
        elif words["G"] in "23":
            centre = at + np.array([float(words["I"]), float(words["J"])])
            found.append(Arc(at, to, centre, left=words["G"] == "3"))
        at = to
    return found
