"""Readers of programs of controllers, and what the controllers make of them, by scipy and by linear equations."""

import re
from math import perm
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BPoly, PPoly

from tests.exports.structured_text import without_comments

Array = NDArray[np.float64]
Row = dict[str, Any]


def rows(text: str, first: str) -> list[Row]:
    """Structures `(first := ..., second := ...)` of a text as dicts; numbers as floats, names as texts."""
    matches = re.findall(rf"\(({first} := [^()]*)\)", without_comments(text))
    return [dict(map(_pair, one.split(", "))) for one in matches]


def _pair(text: str) -> tuple[str, Any]:
    name, value = text.split(" := ")
    try:
        return name, float(value)
    except ValueError:
        return name, value


def cam_builder(text: str) -> PPoly:
    table = rows(text, "x0")
    breaks = [*(row["x0"] for row in table), table[-1]["x1"]]
    assert [row["x1"] for row in table] == breaks[1:]
    return PPoly(np.array([[row[f"a{n}"] for row in table] for n in range(7, -1, -1)]), breaks)


def motion_function(text: str) -> PPoly:
    table = rows(text, "PointIndex")
    assert [row["PointIndex"] for row in table] == list(range(1, len(table) + 1))
    assert [row["RelIndexNextPoint"] for row in table] == [1.0] * (len(table) - 1) + [0.0]
    kinds = [row["FunctionType"] for row in table]
    values = [[row[name] for name in ("MasterPos", "SlavePos", "SlaveVelo", "SlaveAcc", "SlaveJerk")] for row in table]
    orders = {"MOTIONFUNCTYPE_POLYNOM5_MM": 3, "MOTIONFUNCTYPE_POLYNOM7_MM": 4}
    assert kinds[-1] == "MOTIONFUNCTYPE_NOTDEF"
    return hermite(values, [orders[kind] for kind in kinds[:-1]])


def third_motion_function(text: str) -> PPoly:
    table = rows(text, "FunctionType")
    names = ("MasterPosition", "SlavePosition", "SlaveVelocity", "SlaveAcceleration", "SlaveJerk")
    orders = {"EMotionFunctionType.Polynomial5": 3, "EMotionFunctionType.Polynomial7": 4}
    kinds = [row["FunctionType"] for row in table]
    assert kinds[-1] == "EMotionFunctionType.Undefined"
    return hermite([[row[name] for name in names] for row in table], [orders[kind] for kind in kinds[:-1]])


def basic_points(text: str) -> PPoly:
    table = rows(text, "leadingValue")
    assert 2 <= len(table) <= 51
    names = ("leadingValue", "followingValue", "velocityRatio", "accelerationRatio")
    return hermite([[row[name] for name in names] for row in table], [3] * (len(table) - 1))


def advanced_elements(text: str) -> PPoly:
    table = rows(text, "leadingValueStart")
    assert {row["camProfileType"] for row in table} <= {2.0, 3.0, 5.0}
    assert all(row["followingValueStart"] == row["followingValueEnd"] for row in table if row["camProfileType"] == 2.0)
    return joined([_of_element(row, []) for row in table], table)


def polynomial_elements(text: str) -> PPoly:
    table = rows(text, "leadingValueStart")
    assert {(row["camProfileType"], row["polynomialMode"]) for row in table} == {(44.0, 1.0)}
    return joined([_of_element(row, [(3, 0.0, row["geoJerkStart"])]) for row in table], table)


def _of_element(row: Row, more: list[tuple[int, float, float]]) -> Array:
    """Ascending powers of the polynomial of least degree with the values of an element, by linear equations in u."""
    length = row["leadingValueEnd"] - row["leadingValueStart"]
    names = ("followingValue", "geoVelo", "geoAccel")
    asked = [
        (nu, u, row[f"{name}{side}"]) for nu, name in enumerate(names) for u, side in ((0.0, "Start"), (1.0, "End"))
    ]
    asked += more
    count = len(asked)
    matrix = [[perm(n, nu) * u ** (n - nu) if n >= nu else 0.0 for n in range(count)] for nu, u, _ in asked]
    values = [value * length**nu for nu, _, value in asked]
    return np.asarray(np.linalg.solve(matrix, values) / length ** np.arange(count))


def joined(powers: list[Array], found: list[Row]) -> PPoly:
    assert len(found) <= 50
    assert all(one["leadingValueEnd"] == next_one["leadingValueStart"] for one, next_one in zip(found, found[1:]))  # noqa: B905, RUF007
    breaks = [*(row["leadingValueStart"] for row in found), found[-1]["leadingValueEnd"]]
    return PPoly(np.array(powers).T[::-1], breaks)


def hermite(points: list[list[float]], orders: list[int]) -> PPoly:
    """Polynomials with the values of both ends, so many of them."""
    pieces = []
    for first, last, count in zip(points, points[1:], orders, strict=False):
        ends = [first[0], last[0]]
        bernstein = BPoly.from_derivatives(ends, [first[1 : count + 1], last[1 : count + 1]])
        pieces.append(PPoly.from_bernstein_basis(bernstein).c[:, 0])
    table = np.zeros((max(map(len, pieces)), len(pieces)))
    for i, piece in enumerate(pieces):
        table[len(table) - len(piece) :, i] = piece
    return PPoly(table, [point[0] for point in points])


def acp10(text: str) -> tuple[PPoly, int, int]:
    """The polynomials, and the periods of master and slave; what the drive checks (error 5304) is checked."""
    plain = without_comments(text)
    master, slave, count = (int(re.search(rf"{name} := (-?\d+),", plain)[1]) for name in PERIODS)  # type: ignore[index]
    found = rows(text, "a")
    x = [0.0, *(row["x"] for row in found)]
    assert 1 <= len(found) == count <= 64
    assert found[0]["a"] == 0.0
    assert (np.diff(x) > 0).all()
    assert x[-1] == master
    table = np.array([[row[letter] for row in found] for letter in "gfedcba"])
    single = table.astype(np.float32).astype(np.float64)
    assert np.allclose(single, table, rtol=6e-8, atol=0)
    motion = PPoly(single, np.array(x).astype(np.float32).astype(np.float64))
    assert abs(motion(float(master)) - slave) <= 0.1
    return motion, master, slave


PERIODS = ("MasterPeriod", "SlavePeriod", "PolynomialNumber")
