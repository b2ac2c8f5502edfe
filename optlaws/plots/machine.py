"""Pictures of machines: what an output does, how a mechanism moves, and what a motor can."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np

from optlaws.errors import InputError
from optlaws.mechanisms.drives.effort import over_speed
from optlaws.mechanisms.linkages.mechanism import MechanismReport
from optlaws.motion.quantities import RPM
from optlaws.plots.report import draw_panel
from optlaws.plots.style import (
    BLUES,
    DISTINCT,
    GREEN,
    GREY,
    WARM,
    empty_figure,
    name_point,
    new_axes,
    new_figure,
    plot_style,
)
from optlaws.tolerances import VALUE_ROUNDING

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from optlaws.cycles.answers import Solved
    from optlaws.mechanisms.drives.effort import BestRatio, PieceEffort
    from optlaws.mechanisms.linkages.mechanism import Mechanism
    from optlaws.mechanisms.machine.machine import MachineSpectrum
    from optlaws.mechanisms.machine.over_time import OutputCurve
    from optlaws.mechanisms.machine.spectrum import ResponseSpectrum
    from optlaws.shown.report import Panel, Series


def draw_spectrum(
    spectrum: ResponseSpectrum,
    axes: Axes | None = None,
    *,
    what: Literal["residual", "peak"] = "residual",
    over: float = 1.0,
    **style: Any,
) -> list[Artist]:
    """Draw residual or peak acceleration over the frequency into axes, new ones by default; return the artists.

    `over` divides the acceleration, for example by C of the law meant for the mass.
    """
    axes = axes or new_axes()
    (panel,) = (each for each in spectrum.report().panels if each.name.startswith(what))
    axes.set(xlabel=panel.across, ylabel=panel.name)
    return list(axes.plot(panel.series[0].at, panel.series[0].values / over, **style))


def draw_output(
    curve: OutputCurve,
    axes: Axes | None = None,
    *,
    count: int = 801,
    **style: Any,
) -> list[Artist]:
    """Draw an output of a machine over time into axes, new ones by default."""
    axes = axes or new_axes()
    axes.set(xlabel="time, durations of the rise", ylabel=curve.name)
    return list(axes.plot(*curve.samples(count), **{"color": DISTINCT[0], **style}))


def draw_machine_spectrum(
    spectrum: MachineSpectrum,
    axes: Axes | None = None,
    **style: Any,
) -> list[Artist]:
    """Draw an output's peak and each mode's residual in it into axes, new ones by default."""
    axes = axes or new_axes()
    axes.set(xlabel=spectrum.parameter, ylabel=spectrum.output)
    lines = axes.plot(spectrum.values, spectrum.peaks[spectrum.output], **{"color": GREY, "label": "peak", **style})
    for i, left in enumerate(spectrum.residuals.T):
        named = {"color": DISTINCT[i % len(DISTINCT)], "label": f"mode {i + 1} left", **style}
        lines += axes.plot(spectrum.values, left, **named)
    axes.set_ylim(bottom=0.0)
    axes.legend(frameon=False)
    return list(lines)


_SHOWN = 7  # positions of the linkage


def draw_mechanism(mechanism: Mechanism, axes: Any = None, **style: Any) -> list[Artist]:
    """Draw a mechanism into four pairs of axes, one for the linkage alone, or a new figure; return the artists.

    One that has no linkage to draw has three panels.
    """
    with plot_style():
        linked = bool(mechanism.linkage.chains)
        panels = _new_panels(linked) if axes is None else list(np.ravel(np.array(axes, dtype=object)))
        if linked and len(panels) == 1:
            return _linkage(mechanism, panels[0])
        if len(panels) != 3 + linked:
            raise InputError(
                f"ax must be {3 + linked} pairs of axes for this mechanism{', or one for its linkage' * linked}, got "
                f"{len(panels)}"
            )
        artists = _linkage(mechanism, panels.pop(0)) if linked else []
        return artists + _curves(mechanism, panels, style)


def _new_panels(linked: bool) -> list[Axes]:  # noqa: FBT001 - called by position
    if not linked:
        return list(np.ravel(new_figure(7.2, 6.0).subplots(3, 1, sharex=True)))
    figure = new_figure(10.4, 5.4)
    grid = figure.add_gridspec(3, 2, width_ratios=(1.15, 1.0))
    first = figure.add_subplot(grid[0, 1])
    others = [figure.add_subplot(grid[i, 1], sharex=first) for i in (1, 2)]
    panels = [first, *others]
    for panel in panels[:2]:
        panel.tick_params(labelbottom=False)
    figure.align_ylabels(panels)
    return [figure.add_subplot(grid[:, 0]), *panels]


def _curves(mechanism: Mechanism, panels: list[Axes], style: dict[str, Any]) -> list[Artist]:
    artists: list[Artist] = []
    report = MechanismReport(mechanism)
    for panel, axes, colour in zip(report.panels, panels, (BLUES[3], GREEN, WARM), strict=True):
        artists += draw_panel(panel, axes, **{"color": colour, **style})
        axes.axhline(0.0, color=GREY, linewidth=0.8)
    panels[-1].set(xlabel=report.panels[-1].across)
    return artists


def _linkage(mechanism: Mechanism, axes: Axes) -> list[Artist]:
    """The links in several positions, the first one dark, with the paths of their joints."""
    report = MechanismReport(mechanism)
    x = report.positions
    closed = bool(np.isclose(x[-1] - x[0], 2.0 * np.pi))
    shown = np.linspace(x[0], x[-1], _SHOWN + closed)[: _SHOWN if closed else None]
    artists: list[Artist] = []
    axes.set_aspect("equal")
    for paths, places, moving in zip(report.chains(x), report.chains(shown), report.moving, strict=True):
        for path in paths:
            if np.ptp(path, axis=1).max() > 0.0:
                artists += axes.plot(*path, color=GREY, linewidth=0.8, linestyle=":", zorder=1)
        if len(places) == 1:
            marker: dict[str, Any] = {"marker": "s", "color": WARM, "markersize": 7.0}
            marker |= {} if moving[0] else {"marker": "^", "color": GREY, "markersize": 9.0}
            artists += axes.plot(*places[0, :, :1], linestyle="", zorder=5, **marker)
            continue
        for i in range(len(shown))[::-1]:
            line: dict[str, Any] = (
                {"color": BLUES[4], "linewidth": 2.2} if i == 0 else {"color": BLUES[1], "linewidth": 1.0}
            )
            artists += axes.plot(*places[:, :, i].T, marker="o", markersize=4.0 if i == 0 else 2.5, zorder=3, **line)
    axes.set(xlabel="x, mm", ylabel="y, mm", title=f"{mechanism.name}, {len(shown)} positions")
    return artists


_SAMPLES = 801
_FAR_SPEED = 2.5  # times the greatest speed of a cycle: what is farther is not drawn


def draw_motor_of_cycle(plan: Solved, axes: Axes | None = None, **style: Any) -> list[Artist]:
    """Draw torque over speed at the motor during a cycle, within the motor's curves, with the RMS at the mean speed.

    The legend says what the cycle uses of each limit; where the greatest speed is far, that alone stands there.
    """
    sheet, motor = plan.sheet, plan.geared_motor.motor
    artists = draw_torque_over_speed(plan.along, axes, **{"label": "cycle", **style})
    axes = cast("Axes", artists[0].axes)
    used = {margin.name: f"{100.0 * margin.use:.3g} % used" for margin in sheet.margins}
    of_peak = used.get("torque-speed curve", used.get("peak torque", ""))
    known = {"peak torque": of_peak, "continuous torque": used.get("RMS torque", "")}
    for artist in artists:
        if share := known.get(str(artist.get_label()), ""):
            artist.set_label(f"{artist.get_label()}, {share}")
    rms: Any = {"color": WARM, "marker": "o", "markersize": 6.0, "linewidth": 0.0, "zorder": 5}
    artists += axes.plot(RPM * sheet.mean_speed, sheet.rms_torque, label="RMS torque at the mean speed", **rms)
    if np.isfinite(motor.greatest_speed):
        most, near = RPM * motor.greatest_speed, motor.greatest_speed <= _FAR_SPEED * sheet.peak_speed
        label = f"greatest speed {most:.5g} rpm, {used['speed']}"
        place: Any = {"linestyle": ":", "color": GREY, "linewidth": 1.4, "label": label}
        artists += [axes.axvline(most, **place)] if near else axes.plot([], [], **place)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=2, fontsize=8.0)
    return artists


def draw_torque_over_speed(
    along: Sequence[PieceEffort], axes: Axes | None = None, *, way: float = 1.0, **style: Any
) -> list[Artist]:
    """Draw torques over speeds of a motion, or of one that goes back (way -1), within the curves of the motor."""
    axes = axes or new_axes()
    artists: list[Artist] = []
    course = [way * values for values in over_speed(along, _SAMPLES)]
    goes_back = course[0].min() < -VALUE_ROUNDING * np.abs(course[0]).max()
    motor, fastest = along[0].drive.motor, float(np.abs(course[0]).max())
    near = motor.greatest_speed <= _FAR_SPEED * fastest
    speeds, limits = motor.limits_up_to(motor.greatest_speed if near else 1.5 * fastest, _SAMPLES)
    for name, values in limits.items():
        look: dict[str, Any] = {"color": GREY, "linestyle": "-" if name == "peak torque" else "--", "linewidth": 1.1}
        for side, label in ((1.0, name), (-1.0, None)):
            for end in (1.0, -1.0) if goes_back else (1.0,):
                shown = label if end > 0.0 else None
                artists += axes.plot(end * RPM * speeds, side * values, **look, label=shown)
    artists += axes.plot(RPM * course[0], course[1], **{"color": BLUES[3], **style})
    axes.axhline(0.0, color=GREY, linewidth=0.8)
    axes.set(xlabel="speed of the motor, rpm", ylabel="torque at the motor, N m")
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, frameon=False)
    return artists


def draw_best_ratio(best: BestRatio, axes: Axes | None = None, **style: Any) -> list[Artist]:
    """Draw root mean square and peak torque over the ratio into axes, new ones by default; return the artists."""
    axes = axes or new_axes()
    artists: list[Artist] = []
    for values, name, colour in ((best.rms_torques, "RMS torque", BLUES[3]), (best.peak_torques, "peak torque", GREY)):
        artists += axes.plot(best.ratios, values, **{"color": colour, "label": name, **style})
    artists += axes.plot([best.ratio], [best.rms_torque], "o", color=WARM)
    artists.append(name_point(axes, f"{best.ratio:.4g}", (best.ratio, best.rms_torque)))
    axes.set(xscale="log", xlabel="ratio", ylabel="torque at the motor, N m")
    axes.set_ylim(bottom=0.0)
    axes.legend(frameon=False)
    return artists


_SHOWN_RESIDUAL = 1e-4  # of the greatest residual: what a logarithmic picture still shows


def laws_figure(title: str, left: Sequence[Panel], moved: Panel, spread: float) -> Figure:
    """What laws leave of modes over their frequencies, within a spread in percent, and an output over k."""
    with plot_style():
        figure = empty_figure(9.6 + 3.6 * (len(left) - 1), 4.6)
        *before, last = figure.subplots(1, len(left) + 1)
        for panel, axes in zip(left, before, strict=True):
            least = _SHOWN_RESIDUAL * max(float(curve.values.max()) for curve in panel.series)
            for curve, style in zip(panel.series, _styles(panel.series), strict=True):
                axes.semilogy(curve.at, np.maximum(curve.values, least), **style)
            axes.axvspan(-spread, spread, color="#f2f2f2", zorder=0)
            ends = float(panel.series[0].at[0]), float(panel.series[0].at[-1])
            axes.set(xlim=ends, ylim=(least, None), xlabel="frequency off by, %", title=panel.name)
        for curve, style in zip(moved.series, _styles(moved.series), strict=True):
            last.plot(curve.at, curve.values, label=curve.name, **style)
        last.axvline(1.0, color="black", linewidth=0.7, linestyle=":")
        last.set(xlim=(0.0, float(moved.series[0].at[-1])), xlabel="k", title=moved.name)
        figure.suptitle(title, x=0.01, ha="left", fontsize=11.0)
        figure.legend(*last.get_legend_handles_labels(), loc="outside lower center", ncols=3)
        return figure


def _styles(curves: Sequence[Series]) -> list[dict[str, Any]]:
    """Full lines of optimal laws, broken ones of others."""
    ours, known = iter((BLUES[-1], GREEN, "#66c2a5", BLUES[1])), iter((GREY, WARM, "#fdae61", "#8c8c8c", "#a6761d"))
    return [
        {"color": next(ours, BLUES[-1]), "linewidth": 1.6}
        if curve.law == "optimal"
        else {"color": next(known, GREY), "linestyle": "--", "linewidth": 1.2}
        for curve in curves
    ]
