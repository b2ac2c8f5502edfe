"""Mechanisms as the page draws them: the links to scale at the times of a cycle, inertia and load over the input."""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees
from typing import Any

import numpy as np

from optlaws import Cycle, Mechanism
from optlaws.cams.at_shaft import CamAtShaft
from optlaws.explorer.views.cam_view import drawing
from optlaws.explorer.views.panel_data import drawn
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.tree import Formula
from optlaws.motion.display_units import MILLI
from optlaws.motion.quantities import si_number
from optlaws.numbers import Array

FRAMES = 181
_SAMPLES = 241
_DECIMALS = 3
#: what a mechanism in proportion is drawn from: the entry of its size
_ROUND = {"rack": "radius", "belt": "radius", "screw": "lead"}
#: units of the input, of its inertia and of its load, and how many of the first make one of SI
INPUTS = {"angle": ("deg", degrees(1.0), "kg m²", "N m"), "length": ("mm", MILLI, "kg", "N")}


def picture(cycle: Cycle, mechanism: Mechanism, entries: Mapping[str, Any]) -> dict[str, Any]:
    """The mechanism at equal steps of time over a cycle, in mm and deg: links, a cam, or a drum with a slide."""
    times = np.linspace(0.0, cycle.duration, FRAMES)
    x = np.asarray(cycle(times))
    _, factor, _, _ = INPUTS[mechanism.axis]
    shown: dict[str, Any] = {
        "name": mechanism.name,
        "input": drawn(factor * x, 4),
        "ends": [factor * end for end in _used(cycle)],
        "axis": mechanism.axis,
    }
    if mechanism.linkage.chains:
        return shown | {"kind": "links"} | _links(mechanism, x)
    if mechanism.name == "cam":
        return shown | {"kind": "cam", "dimensions": []} | drawing(CamAtShaft.from_dict(entries).cam)
    if mechanism.name in _ROUND:
        size = float(si_number(entries[_ROUND[mechanism.name]], ("length",), "size"))
        slide = drawn(MILLI * np.asarray(mechanism.driven_position("slide", x)), 4)
        return shown | {"kind": mechanism.name, "size": MILLI * size, "slide": slide}
    return shown | {"kind": "table"}


def _links(mechanism: Mechanism, x: Array) -> dict[str, Any]:
    """The joints of each chain at positions of the input, and their paths over the range of the mechanism."""
    over = np.linspace(*mechanism.over, _SAMPLES) if mechanism.has_end else np.linspace(x.min(), x.max(), _SAMPLES)
    chains = [[_placed(point, x) for point in chain] for chain in mechanism.linkage.chains]
    moving = {point: _placed(point, over) for chain in mechanism.linkage.chains for point in chain if _moves(point)}
    fixed = [len(chain) == 1 and not _moves(chain[0]) for chain in mechanism.linkage.chains]
    return {"chains": chains, "fixed": fixed, "paths": list(moving.values())}


def _moves(point: tuple[Formula, Formula]) -> bool:
    return bool(point[0].names() | point[1].names())


def _placed(point: tuple[Formula, Formula], x: Array) -> list[list[float | None]]:
    """Coordinates of a joint in mm; a fixed joint has the same place at all times."""
    places = np.array([evaluate(part, {"x": x}, NUMPY) + 0.0 * x for part in point])
    return [drawn(row, _DECIMALS) for row in MILLI * places.T]


def _used(cycle: Cycle) -> tuple[float, float]:
    """The least and the greatest position of the input."""
    used = [value for peak in cycle.peaks for value, _ in peak.extremes[0]]
    return min(used), max(used)


def over_input(cycle: Cycle, mechanism: Mechanism) -> dict[str, Any]:
    """Panels of inertia and load over the input, with the part of it that the cycle uses."""
    unit, factor, inertia, load = INPUTS[mechanism.axis]
    low, high = _used(cycle)
    ends = mechanism.over if mechanism.has_end else (low, high)
    x = np.linspace(*ends, _SAMPLES)
    at = drawn(factor * x, 4)
    panels = [
        {"name": name, "unit": unit_of, "series": [{"at": at, "values": drawn(np.asarray(values), 9)}]}
        for name, unit_of, values in (
            ("inertia J", inertia, mechanism.inertia(x)),
            ("load T", load, mechanism.load(x)),
        )
    ]
    return {
        "across": f"input of the {mechanism.name}, {unit}; lines: what the cycle uses",
        "range": [factor * ends[0], factor * ends[1]],
        "panels": panels,
        "segments": [{"name": "", "at": [factor * low, factor * high]}, {"name": "", "at": [factor * high] * 2}],
    }
