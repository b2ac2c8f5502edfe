"""The figure of the torsion lever's moment and motion, exact and asymptotic."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING

import numpy as np

from optlaws import drawing

if TYPE_CHECKING:
    from optlaws.mechanisms.lever.lever import TorsionLever


def draw(lever: TorsionLever) -> dict[str, bytes]:
    """The figure as svg and png."""
    exact, asymptotic = lever.exact, lever.asymptotic
    chi = np.linspace(exact.chi02, exact.chi01, 201)
    k = np.linspace(0.0, 1.0, 401)
    with drawing.style():
        figure = drawing.figure(9.2, 4.4)
        left, right = figure.subplots(1, 2)
        angle = np.degrees(chi)
        left.plot(angle, lever.moment(chi), color=drawing.BLUES[3], label="exact, eq. (2)")
        left.plot(angle, lever.taylor_moment(chi), "--", color=drawing.WARM, label="third degree, eq. (4)")
        left.plot(angle, lever.n * chi, color=drawing.GREY, linewidth=1.0, label="linear, n chi")
        left.set(
            xlabel="deviation of the driven link (degrees)",
            ylabel="moment / c1 (radians)",
            title="Moment of the bars on the driven link",
        )
        left.legend(loc="upper left")
        for motion, stroke, name in ((exact, "-", "exact"), (asymptotic, "--", "asymptotic")):
            right.plot(k, motion.law.b(k), stroke, color=drawing.BLUES[3], label=f"b, {name}")
            right.plot(k, motion.law.c(k), stroke, color=drawing.GREEN, label=f"c, {name}")
        right.axvline(2.0 * exact.zeta, color=drawing.GREY, linewidth=1.0)
        right.annotate(
            "rest, chi = 0",
            (2.0 * exact.zeta, -4.4),
            xytext=(-4, 0),
            textcoords="offset points",
            ha="right",
            fontsize=9.0,
        )
        right.set(
            xlabel="time k (dimensionless)",
            ylabel="b, c (dimensionless)",
            title=f"Stroke of {degrees(lever.swing):.4g} degrees as it runs",
        )
        right.legend(loc="upper right")
        return {kind: drawing.rendered(figure, kind) for kind in ("svg", "png")}
