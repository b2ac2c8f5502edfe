"""The torsion lever to scale, its moment and its motion."""

from __future__ import annotations

from math import cos, degrees, pi, sin
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from optlaws import deg
from optlaws.balancing import TorsionLever
from optlaws.plots.style import BLUES, GREEN, GREY, WARM, empty_figure, plot_style
from optlaws.results import Entries, Results

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_ANGLES = ("chi01", "chi02")
_NAMES = (*_ANGLES, "period", "zeta", "B1", "B3", "C1", "C3")


class Drawing(Entries, rename={"lam": "lambda"}):
    """The problem file; the swing in degrees."""

    beta: float
    lam: float
    rho: float
    nu: float
    swing: float


def run(results: Results) -> None:
    """Draw the lever, and table its exact motion beside the asymptotic one."""
    spec = results.read(Drawing)
    lever = TorsionLever(beta=spec.beta, lam=spec.lam, rho=spec.rho, nu=spec.nu, swing=deg(spec.swing))
    results.picture("mechanism", draw_mechanism(lever))
    results.picture("motion", draw_motion(lever))
    parameters = f"beta = {spec.beta:g}, lambda = {spec.lam:g}, rho = {spec.rho:g}, nu = {spec.nu:g}"
    page = results.page("drawing").text(spec.text)
    page.text(f"{parameters}, swing {spec.swing:g} degrees; angles in degrees, the period in units of sqrt(I / c1).")
    page.figure("mechanism", "The mechanism").figure("motion", "Moment and motion")
    rows = []
    for name in _NAMES:
        scale = degrees(1.0) if name in _ANGLES else 1.0
        exact, asymptotic = (scale * getattr(motion, name) for motion in (lever.exact, lever.asymptotic))
        rows.append([name, exact, asymptotic, f"{100 * (asymptotic / exact - 1):.3f}"])
    page.table(["", "exact", "asymptotic", "off by, %"], rows)
    exact = lever.exact
    assert abs(exact.period - 10.118762) < 1e-5
    assert abs(exact.chi01 - exact.chi02 - lever.swing) < 1e-9


Point = NDArray[np.float64]

_BODY = BLUES[3]
_PALE = BLUES[0]
_O1 = np.zeros(2)


def draw_mechanism(lever: TorsionLever) -> Figure:
    """The drawing: at rest in full, at both extremes in pale lines."""
    from matplotlib.patches import Circle

    with plot_style():
        figure = empty_figure(8.4, 5.6)
        axes = figure.subplots()
        axes.set_axis_off()
        axes.set_aspect("equal")
        motion = lever.exact
        for chi in (motion.chi01, motion.chi02):
            _links(axes, lever, chi, {"color": _PALE, "linewidth": 3.0, "zorder": 2})
        _cam(axes)
        _links(axes, lever, 0.0, {"color": _BODY, "linewidth": 5.0, "zorder": 4})
        o2 = _o2(lever)
        axes.add_patch(Circle((o2[0], o2[1]), 0.27, facecolor="#dfe9f3", edgecolor=_BODY, linewidth=1.0, zorder=1))
        for centre, radius, sense in ((_O1, 0.17, 1.0), (o2, 0.17, -1.0)):
            _bar(axes, centre, radius, sense)
        _angles(axes, lever)
        _labels(axes, lever)
        axes.set(xlim=(-1.28, lever.lam + 0.55), ylim=(-1.2, 1.2))
        return figure


def _o2(lever: TorsionLever) -> Point:
    return np.array([lever.lam, 1.0 - lever.beta])


def _towards(angle: float) -> Point:
    """Unit vector at an angle from the upright, clockwise."""
    return np.array([sin(angle), cos(angle)])


def _beside(point: Point, right: float = 0.0, up: float = 0.0) -> tuple[float, float]:
    return float(point[0]) + right, float(point[1]) + up


def _joints(lever: TorsionLever, chi: float) -> tuple[Point, Point]:
    gamma = float(lever.linkage.rocker(chi))
    return _towards(gamma), _o2(lever) + lever.beta * _towards(chi)


def _links(axes: Axes, lever: TorsionLever, chi: float, style: dict[str, Any]) -> None:
    a, b = _joints(lever, chi)
    chain = np.array([_O1, a, b, _o2(lever)])
    axes.plot(*chain.T, solid_joinstyle="round", solid_capstyle="round", **style)
    axes.plot(*chain.T, "o", color="white", markeredgecolor=style["color"], markersize=7.0, zorder=style["zorder"] + 1)


def _bar(axes: Axes, centre: Point, radius: float, sense: float) -> None:
    """A torsion bar seen along its axis, and the frame that holds its far end."""
    turn = np.linspace(0.0, 6.0 * pi, 280)
    size = 0.05 + (radius - 0.05) * turn / turn[-1]
    spiral = centre[:, None] + size * np.array([sense * np.sin(turn), -np.cos(turn)])
    axes.plot(*spiral, color=WARM, linewidth=1.6, zorder=6)
    anchor = np.array([centre[0], centre[1] - radius])
    axes.plot([anchor[0], anchor[0]], [anchor[1], centre[1] - 0.33], color=WARM, zorder=6)
    _ground(axes, np.array([anchor[0], centre[1] - 0.33]))


def _ground(axes: Axes, at: Point) -> None:
    style: dict[str, Any] = {"color": GREY, "linewidth": 1.2, "zorder": 3}
    axes.plot([at[0] - 0.13, at[0] + 0.13], [at[1], at[1]], **style)
    for shift in np.linspace(-0.11, 0.11, 5):
        axes.plot([at[0] + shift, at[0] + shift - 0.05], [at[1], at[1] - 0.05], **style)


def _cam(axes: Axes) -> None:
    """The rocker's arm with its roller, on a cam."""
    from matplotlib.patches import Circle, Polygon

    roller, hub = np.array([-0.72, -0.05]), np.array([-0.84, -0.62])
    axes.plot(*np.array([_O1, roller]).T, color=_BODY, linewidth=5.0, zorder=4, solid_capstyle="round")
    gap = float(np.hypot(*(roller - hub))) - 0.09
    turn = np.linspace(0.0, 2.0 * pi, 181)
    toward = np.arctan2(*(roller - hub)[::-1])
    radius = gap * (0.84 + 0.16 * np.cos(turn - toward))
    outline = hub + (radius * np.array([np.cos(turn), np.sin(turn)])).T
    axes.add_patch(Polygon(outline, facecolor="#f0f0f0", edgecolor=GREY, linewidth=1.2, zorder=2))
    axes.add_patch(Circle(tuple(hub), 0.035, facecolor="white", edgecolor=GREY, linewidth=1.2, zorder=3))
    axes.add_patch(Circle(tuple(roller), 0.09, facecolor="white", edgecolor=_BODY, linewidth=1.6, zorder=5))
    axes.annotate("cam", _beside(hub, 0.0, -0.16), ha="center", color=GREY, fontsize=10.0)


def _angles(axes: Axes, lever: TorsionLever) -> None:
    motion, o2 = lever.exact, _o2(lever)
    gamma01 = float(lever.linkage.rocker(motion.chi01))
    text = r"$\chi_{01}$", r"$\chi_{02}$", r"$\gamma_{01}$"
    for centre, end, name, size in (
        (o2, motion.chi01, text[0], 0.78 * lever.beta),
        (o2, motion.chi02, text[1], 0.78 * lever.beta),
        (_O1, gamma01, text[2], 0.62),
    ):
        way = np.array([centre + size * _towards(angle) for angle in np.linspace(0.0, end, 40)])
        axes.plot(*way.T, color=GREEN, linewidth=1.2, zorder=5)
        style: dict[str, Any] = {"arrowstyle": "-|>", "color": GREEN, "linewidth": 1.2}
        axes.annotate("", way[-1], xytext=way[-4], arrowprops=style, zorder=5)
        middle = centre + (size + 0.09) * _towards(0.5 * end)
        axes.annotate(name, _beside(middle), ha="center", va="center", color=GREEN, fontsize=12.0, zorder=7)


def _labels(axes: Axes, lever: TorsionLever) -> None:
    o2, (a, b) = _o2(lever), _joints(lever, 0.0)
    axes.plot(*np.array([_O1, o2]).T, color=GREY, linewidth=1.0, linestyle=(0, (6, 3)), zorder=1)
    large: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 12.0, "zorder": 7}
    for name, at in (
        ("1", _beside(0.4 * a, -0.08, 0.0)),
        (r"$\lambda$", _beside(0.5 * (a + b), 0.0, 0.08)),
        (r"$\beta$", _beside(o2 + 0.66 * (b - o2), 0.06, 0.0)),
        (r"$\alpha$", _beside(0.5 * (_O1 + o2), 0.0, -0.09)),
        (r"$O_1$", _beside(_O1, -0.25, 0.12)),
        (r"$O_2$", _beside(o2, 0.38, 0.12)),
        ("I", _beside(o2, 0.22, -0.09)),
        ("A", _beside(a, -0.1, 0.07)),
        ("B", _beside(b, 0.1, 0.07)),
    ):
        axes.annotate(name, at, **large)
    small: dict[str, Any] = {"ha": "center", "va": "top", "fontsize": 10.0, "color": WARM}
    axes.annotate(
        "torsion bar 1, stiffness $c_1$,\non the rocker that the cam drives", _beside(_O1, 0.3, -0.46), **small
    )
    axes.annotate("torsion bar 2, stiffness $\\xi c_1$,\non the driven mass", _beside(o2, 0.0, -0.46), **small)


def draw_motion(lever: TorsionLever) -> Figure:
    """The moment of the bars over the angle, b and c over k, exact and asymptotic."""
    exact, asymptotic = lever.exact, lever.asymptotic
    chi = np.linspace(exact.chi02, exact.chi01, 201)
    k = np.linspace(0.0, 1.0, 401)
    with plot_style():
        figure = empty_figure(9.2, 4.4)
        left, right = figure.subplots(1, 2)
        angle = np.degrees(chi)
        left.plot(angle, lever.moment(chi), color=BLUES[3], label="exact, eq. (2)")
        left.plot(angle, lever.taylor_moment(chi), "--", color=WARM, label="third degree, eq. (4)")
        left.plot(angle, lever.n * chi, color=GREY, linewidth=1.0, label="linear, n chi")
        left.set(
            xlabel="deviation of the driven link, deg",
            ylabel="moment / c1, radians",
            title="Moment of the bars on the driven link",
        )
        left.legend(loc="upper left")
        for motion, stroke, name in ((exact, "-", "exact"), (asymptotic, "--", "asymptotic")):
            right.plot(k, motion.law.b(k), stroke, color=BLUES[3], label=f"b, {name}")
            right.plot(k, motion.law.c(k), stroke, color=GREEN, label=f"c, {name}")
        right.axvline(2.0 * exact.zeta, color=GREY, linewidth=1.0)
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
        return figure


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
