"""Readers of exports that share no code with what writes them: each gives the curve that the controller runs."""

import csv
import io
import re
import struct
from collections.abc import Callable
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import Akima1DInterpolator, BPoly, CubicHermiteSpline, CubicSpline, PPoly

Array = NDArray[np.float64]
Curve = Callable[[Array, int], Array]

NUMBER = r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?"


def spline(x: Array, y: Array, conditions: Any) -> Curve:
    curve = CubicSpline(x, y, bc_type=conditions)
    return lambda places, nu: np.asarray(curve(places, nu))


def broken(x: Array, y: Array) -> Curve:
    curve = PPoly(np.array([np.diff(y) / np.diff(x), y[:-1]]), x)
    return lambda places, nu: np.asarray(curve(places, nu))


def akima(x: Array, y: Array) -> Curve:
    curve = Akima1DInterpolator(x, y)
    return lambda places, nu: np.asarray(curve(places, nu))


def osculating(x: Array, values: Array) -> Curve:
    """Each interval by itself, in its own [0, 1], so that high degrees keep their digits."""
    if len(values) == 2:
        cubic = CubicHermiteSpline(x, *values)
        return lambda places, nu: np.asarray(cubic(places, nu))
    steps = np.diff(x)

    def evaluate(places: Array, nu: int) -> Array:
        which = np.clip(np.searchsorted(x, places, side="right") - 1, 0, len(steps) - 1)
        found = np.empty(len(places))
        for i in np.unique(which):
            ends = [[values[m][j] * steps[i] ** m for m in range(len(values))] for j in (i, i + 1)]
            height = ends[0][0]
            ends[0][0], ends[1][0] = 0.0, ends[1][0] - height
            here = which == i
            local = BPoly.from_derivatives([0.0, 1.0], ends)
            found[here] = local((places[here] - x[i]) / steps[i], nu) / steps[i] ** nu + (height if nu == 0 else 0.0)
        return found

    return evaluate


def codesys_xyva(text: str) -> tuple[Array, Curve]:
    rows = np.array(
        [
            [float(one) for one in match]
            for match in re.findall(rf"dX := ({NUMBER}), dY := ({NUMBER}), dV := ({NUMBER}), dA := ({NUMBER})", text)
        ]
    ).T
    count = int(re.search(r"nElements := (\d+)", text)[1])  # type: ignore[index]
    assert rows.shape[1] == count
    assert f"ARRAY[0..{count - 1}] OF SMC_CAMXYVA" in text
    ends = [float(re.search(rf"{name} := ({NUMBER})", text)[1]) for name in ("xStart", "xEnd")]  # type: ignore[index]
    assert ends == [rows[0, 0], rows[0, -1]]
    return rows[0], osculating(rows[0], rows[1:])


def codesys_xy(text: str) -> tuple[Array, Curve]:
    count = int(re.search(r"nElements := (\d+)", text)[1])  # type: ignore[index]
    pairs = np.array([[float(x), float(y)] for x, y in re.findall(rf"\[({NUMBER}), ({NUMBER})\]", text)])
    size = int(re.search(r"SMC_CAMTable_LREAL_(\d+)_2 :=", text)[1])  # type: ignore[index]
    assert len(pairs) == size >= count
    x, y = pairs[:count].T
    cubic = "byInterpolationQuality := 3" in text
    return x, spline(x, y, ((1, 0.0), (1, 0.0))) if cubic else broken(x, y)


def rockwell_cam(text: str) -> tuple[Array, Curve]:
    rows = re.findall(
        rf"\w+\[(\d+)\]\.Master := ({NUMBER}); \w+\[\1\]\.Slave := ({NUMBER}); \w+\[\1\]\.SegmentType := (\d);", text
    )
    assert [int(row[0]) for row in rows] == list(range(len(rows)))
    single = ": CAM[" in text
    x, y = ([float(np.float32(row[i])) if single else float(row[i]) for row in rows] for i in (1, 2))
    slopes = [float(group) for group in re.search(rf"StartSlope = ({NUMBER}), EndSlope = ({NUMBER})", text).groups()]  # type: ignore[union-attr]
    if rows[0][3] == "0":
        return np.array(x), broken(np.array(x), np.array(y))
    return np.array(x), spline(np.array(x), np.array(y), ((1, slopes[0]), (1, slopes[1])))


def profile_numbers(rows: list[list[int]]) -> list[tuple[float, ...]]:
    """X, Y and C0 to C3 of elements of CAM_PROFILE."""
    assert {(len(row), row[0]) for row in rows} == {(14, 2)}
    return [struct.unpack(">6d", struct.pack(">12i", *row[1:5], *row[6:])) for row in rows]


def rockwell_profile(text: str) -> tuple[Array, Curve]:
    rows = [[int(one) for one in row.split(",")] for row in re.findall(r"\[(-?\d+(?:,-?\d+)+)\]", text)]
    x, y, c0, c1, c2, c3 = np.array(profile_numbers(rows)).T
    curve = PPoly(np.array([c3, c2, c1, y + c0])[:, :-1], x)
    return x, lambda places, nu: np.asarray(curve(places, nu))


def twincat_table(text: str) -> tuple[Array, Curve]:
    count = int(re.search(r"NoOfRows := (\d+), NoOfColumns := 2", text)[1])  # type: ignore[index]
    body = re.search(rf"ARRAY\[1\.\.{count}, 1\.\.2\] OF LREAL := \[(.*?)\];", text, re.DOTALL)[1]  # type: ignore[index]
    x, y = np.array([float(one) for one in body.split(",")]).reshape(count, 2).T
    if "MC_INTERPOLATIONTYPE_LINEAR" in text:
        return x, broken(x, y)
    return x, spline(x, y, "periodic" if y[0] == y[-1] else ((1, 0.0), (1, 0.0)))


def separated(text: str, separator: str = ",", decimal: str = ".") -> tuple[list[str], Array]:
    """The heading and the columns of CSV."""
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    heading, *rows = csv.reader(io.StringIO("\n".join(lines)), delimiter=separator)
    return heading, np.array([[float(cell.replace(decimal, ".")) for cell in row] for row in rows]).T


def sew(text: str, decimal: str = ".") -> Array:
    count, *rows = text.splitlines()
    assert int(count) == len(rows)
    return np.array([[float(cell.replace(decimal, ".")) for cell in row.split(";")] for row in rows]).T


def lenze(text: str, decimal: str = ".") -> Array:
    rows = [line.partition("//")[0].split() for line in text.splitlines()]
    return np.array([[float(cell.replace(decimal, ".")) for cell in row] for row in rows]).T


def kas(text: str, decimal: str = ".") -> Array:
    lines = text.splitlines()
    assert re.fullmatch("CYCLIC;(YES|NO);", lines[0])
    assert (lines[1], lines[-1]) == ("TABLE_BEGIN;;", "TABLE_END;;")
    rows = [line.split(";") for line in lines[2:-1]]
    assert {row[2] for row in rows} == {"SPLINE"}
    return np.array([[float(cell.replace(decimal, ".")) for cell in row[:2]] for row in rows]).T


def plcopen(text: str) -> Array:
    rows = [line.split(",") for line in text.splitlines() if not line.startswith("#")]
    return np.array(rows, dtype=np.float64).T


def isg(text: str) -> Array:
    lines = [line.partition("#")[0].strip() for line in text.splitlines()]
    start, stop = lines.index("Begintable"), lines.index("EndTable")
    head = dict(line.split(" = ") for line in lines[:start])
    rows = np.array([[int(cell) for cell in line.split()] for line in lines[start + 1 : stop]])
    assert int(head["Lines"]) == len(rows) <= 360
    assert head["Function type"] == "1"
    assert np.diff(rows[:, 0]).min() >= 1000
    return rows.T * 1e-4


def technosoft(text: str, stop: float, stroke: float, counts: int = 65536) -> Array:
    x, y = np.array([[int(cell) for cell in line.split()] for line in text.splitlines()], dtype=np.float64).T
    assert set(np.diff(x)) <= {2.0**n for n in range(8)}
    assert len(x) <= 8192
    return np.array([x * stop / x[-1], y * stroke / counts])


def ros2(text: str) -> tuple[str, Array, Array]:
    """The joint, the times and the rows of positions, velocities, accelerations."""
    message = import_module("yaml").safe_load(text)
    [joint] = message["joint_names"]
    seconds = [one["time_from_start"]["sec"] + 1e-9 * one["time_from_start"]["nanosec"] for one in message["points"]]
    fields = [name for name in ("positions", "velocities", "accelerations") if name in message["points"][0]]
    return joint, np.array(seconds), np.array([[one[name][0] for one in message["points"]] for name in fields])
