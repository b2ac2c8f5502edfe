"""The map of balancing mechanisms: which type has the smallest cam at a dwell and a clutch angle."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees, pi
from typing import TYPE_CHECKING

import numpy as np

from optlaws import drawing
from optlaws.errors import InfeasibleProblem
from optlaws.laws import MotionLaw
from optlaws.mechanisms.angles import deg
from optlaws.mechanisms.dwell.choice import least_dwell
from optlaws.mechanisms.dwell.mechanism import dwell_mechanism

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHADES = {"I": "#eeeeee", "III": "#cfe5dc", "II": "#cfe0f0"}
RULE = (45.0, 100.0)
_POINTS = 21
_WHOLE = 180.0


def draw(law: MotionLaw, limits: Sequence[float], clutch_angles: Sequence[float]) -> Figure:
    """A panel for each limit of b over the inertia ratio, with the paper's rule drawn on it.

    Neither swing nor least radius matters: the order of the sizes is always II, III, I.
    """
    clutches = np.linspace(clutch_angles[0], clutch_angles[1], _POINTS)
    with drawing.style():
        figure = drawing.figure(3.3 * len(limits) + 0.6, 4.3)
        panels = figure.subplots(1, len(limits), squeeze=False, sharey=True)[0]
        for axes, limit in zip(panels, limits, strict=True):
            third = np.array([_from("III", law, limit, clutch) for clutch in clutches.tolist()])
            second = np.array([_from("II", law, limit, clutch) for clutch in clutches.tolist()])
            axes.fill_betweenx(clutches, 0.0, third, color=SHADES["I"], linewidth=0.0)
            axes.fill_betweenx(clutches, third, second, color=SHADES["III"], linewidth=0.0)
            axes.fill_betweenx(clutches, second, _WHOLE, color=SHADES["II"], linewidth=0.0)
            for edge in (third, second):
                axes.plot(edge, clutches, color=drawing.GREY, linewidth=1.0)
            middle = _POINTS // 2
            edges = (0.0, third[middle], second[middle], _WHOLE)
            for kind, low, high in zip(("I", "III", "II"), edges, edges[1:], strict=False):
                axes.text(0.5 * (low + high), clutches[middle], kind, ha="center", va="center", fontsize=13.0)
            for place in RULE:
                line = axes.axvline(place, color=drawing.WARM, linestyle="--", linewidth=1.3)
            axes.set(xlim=(0.0, _WHOLE), ylim=tuple(clutch_angles), xlabel="dwell (degrees)")
            axes.set_title(f"b ≤ {limit:g} I1/I")
            axes.grid(visible=False)
            axes.set_xticks([0, *RULE, _WHOLE])
        panels[0].set_ylabel("clutch angle (degrees)")
        figure.legend([line], ["the paper's rule: I up to 45°, II above 100°"], loc="outside lower center")
        return figure


def _from(kind: str, law: MotionLaw, limit: float, clutch: float) -> float:
    """The dwell in degrees from which on a type keeps to the limit; half a turn where it never does."""
    dwell = deg(2.0 * clutch + 1.0)
    one = dwell_mechanism(
        kind,
        law=law,
        dwell=dwell,
        rise=pi - dwell,
        clutch_angle=deg(clutch),
        swing=1.0,
        radius_ratio=1.0,
        inertia_ratio=1.0,
    )
    try:
        return degrees(least_dwell(one, limit))
    except InfeasibleProblem:
        return _WHOLE
