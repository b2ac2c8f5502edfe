"""Pictures of cams: the profile with its follower at several angles, to scale, and the follower's motion and load."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.cams.barrel import SIDES, BarrelCam, SpaceCurve
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.contact import FollowerContact
from optlaws.cams.forces import CamForces
from optlaws.cams.report import CamReport
from optlaws.errors import InputError
from optlaws.files.writing import MARK
from optlaws.motion.quantities import DEGREES, MILLI, TURN_DEG
from optlaws.numbers import Array
from optlaws.plots.report import draw_panel, draw_panels
from optlaws.plots.style import BLUES, GREEN, GREY, WARM, new_figure, plot_style, titled

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from optlaws.shown.report import Panel

_OUTLINE_DRAWN = 1e-5  # m: by so much the outline of an animated cam may be off

_SHOWN = 8  # followers around the cam
_SAMPLES = 721
_FILL = "#dfe9f3"
_FORCE_COLOURS = {"N": BLUES[3], "N m": WARM, "MPa": GREEN}
#: of curves of the usual law
_BESIDE: dict[str, Any] = {"color": GREY, "linewidth": 1.1, "linestyle": (0, (4, 2)), "zorder": 1.5}


def cam_figure(cam: DiscCam, title: str, usual: tuple[str, DiscCam] | None = None) -> Figure:
    """The cam and what its follower does, as a figure; beside it what a cam with the usual law of a name does."""
    with plot_style():
        figure, panels = _figure(len(CamReport(cam).panels) - 1)
        if usual is not None:
            name, other = usual
            _draw_profile(other, panels[0], _BESIDE | {"label": name})
            for panel, axes in zip(CamReport(other).panels, panels[1:], strict=False):
                draw_panel(panel, axes, **_BESIDE)
        draw_cam(cam, panels)
        figure.align_ylabels(panels[1:])
        return titled(figure, title)


def forces_figure(forces: CamForces, title: str, *, usual: tuple[str, CamForces] | None = None) -> Figure:
    """Contact force, torque and, where the contact has a width, Hertz's pressure over the turn; a process force above.

    Beside them are those of a cam with the usual law of a name.
    Between the torque and its mean lies the work that a flywheel stores, where a process takes some.
    """
    report = CamReport(forces.cam)
    process, loads = report.process(forces), report.loads(forces)
    name, beside = ("", ()) if usual is None else (usual[0], CamReport(usual[1].cam).loads(usual[1]))
    panels = [*zip(process, [GREEN], strict=False), *((panel, _FORCE_COLOURS[panel.unit]) for panel in loads)]
    with plot_style():
        figure = new_figure(8.6, 2.2 * len(panels))
        column = np.ravel(figure.subplots(len(panels), 1, sharex=True))
        for axes, (panel, colour) in zip(column, panels, strict=True):
            (curve,) = _draw(report, [panel], [axes], color=colour)
            axes.axhline(0.0, color=GREY, linewidth=0.8)
            for other in beside:
                if other.name == panel.name:
                    draw_panel(other, axes, **_BESIDE | {"label": name})
                    axes.legend(loc="upper right")
            if process and colour == WARM:
                _work_above_mean(axes, curve, 0.5 * sum(forces.mean_torque))
            axes.set(xlabel="", ylabel=panel.title.replace(" of the return", "\nof the return"))
        figure.axes[-1].set(xlabel="cam, deg")
        figure.align_ylabels()
        return titled(figure, title)


def _draw(report: CamReport, panels: Sequence[Panel], axes: Sequence[Axes], **style: Any) -> list[Artist]:
    """Panels over the angle of a cam."""
    artists = draw_panels(panels, report.segments, axes, **style)
    axes[-1].set_xticks(np.arange(0.0, DEGREES * report.cam.displacement.breaks[-1] + 1.0, 60.0))
    return artists


def _work_above_mean(axes: Axes, curve: Any, mean: float) -> None:
    """The mean of a torque, and what lies between them."""
    at, torque = (np.asarray(part) for part in curve.get_data())
    axes.axhline(mean, color=WARM, linewidth=0.8, linestyle=(0, (6, 4)), label="mean")
    axes.fill_between(at, torque, mean, where=list(torque > mean), color=WARM, alpha=0.15, label="above the mean")
    axes.legend(loc="upper right")


def pair_figure(first: DiscCam, second: DiscCam, title: str) -> Figure:
    """Two cams on one shaft, in their common coordinates, with both followers at the start."""
    colours = BLUES[3], WARM
    with plot_style():
        figure = new_figure(5.6, 6.0)
        axes = figure.subplots()
        axes.set_aspect("equal")
        for cam, colour, name in zip((first, second), colours, ("cam", "return cam"), strict=True):
            profile = MILLI * cam.profile(np.linspace(*cam.displacement.interval, _SAMPLES))
            axes.plot(*profile.T, color=colour, zorder=4, label=name)
            start = np.array(0.0)
            _draw_body(cam, axes, start, colour, 0.6 * float(np.hypot(*(MILLI * cam.profile(start)))))
        axes.plot(*_linked(first, second).T, color=GREY, linewidth=1.1, label="follower at the start")
        axes.plot([0.0], [0.0], "+", color=GREY, markersize=9.0, zorder=5)
        axes.set(xlabel="x of the cams, mm", ylabel="y of the cams, mm")
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=3)
        return titled(figure, title)


def _draw_body(cam: DiscCam, axes: Axes, at: Array, colour: str, reach: float) -> None:
    """The roller, or the face with so much on either side of where it touches, mm."""
    if cam.contact.roller:
        from matplotlib.patches import Circle

        centre = tuple(MILLI * cam.pitch_curve(at))
        axes.add_patch(Circle(centre, MILLI * cam.contact.roller, fill=False, edgecolor=colour, zorder=3))
        return
    touched, normal = MILLI * cam.profile(at), cam.profile.normal(at)
    along = reach * np.array([normal[1], -normal[0]])
    axes.plot(*np.array([touched - along, touched + along]).T, color=colour, linewidth=1.1, zorder=3)


def _linked(first: DiscCam, second: DiscCam) -> Array:
    """The line between the two followers, along their common slide or through their common pivot."""
    joints = [MILLI * cam.pitch_curve(np.array(0.0)) for cam in (first, second)]
    if first.contact.pivot is not None:
        turned = _phase(first, 0.0)
        joints.insert(1, MILLI * first.contact.pivot * np.array([np.cos(turned), np.sin(turned)]))
    return np.array(joints)


def barrel_figure(cam: BarrelCam, title: str) -> Figure:
    """The groove unrolled at the outer radius, and the pressure angle at the top and at the bottom of the groove."""
    angles = np.linspace(*cam.displacement.interval, _SAMPLES)
    with plot_style():
        figure = new_figure(8.6, 5.6)
        groove, pressure = figure.subplots(2, 1, sharex=True, height_ratios=(1.4, 1.0))
        for side, colour in zip(SIDES, (BLUES[3], WARM), strict=True):
            groove.plot(*_unrolled(cam.flank(side), angles, cam.pitch_curve), color=colour, label=f"{side} flank")
        centre = np.degrees(angles), MILLI * cam.pitch_curve(angles)[:, 2]
        groove.plot(*centre, color=GREY, linestyle=":", label="axis of the roller")
        for radius, colour in zip(cam.radii, (BLUES[3], WARM), strict=True):
            values = np.degrees(cam.pressure_angle(angles, radius=radius))
            pressure.plot(np.degrees(angles), values, color=colour, label=f"at the radius {MILLI * radius:g} mm")
        pressure.axhline(0.0, color=GREY, linewidth=0.8)
        groove.set(ylabel="along the shaft, mm")
        pressure.set(xlabel="around the cam, deg", ylabel="pressure angle, deg", xlim=(0.0, TURN_DEG))
        pressure.set_xticks(np.arange(0.0, TURN_DEG + 1.0, 60.0))
        for axes in (groove, pressure):
            axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
        figure.align_ylabels()
        return titled(figure, title)


def _unrolled(curve: SpaceCurve, angles: Array, pitch: SpaceCurve) -> tuple[Array, Array]:
    """A curve's angle around the cam in degrees, near the roller's angle, and its place along the shaft in mm."""
    x, y, along = curve(angles).T
    beside = np.angle((y + 1j * x) / (pitch(angles) @ np.array([1j, 1.0, 0.0])))
    return np.degrees(angles + curve.turning * beside), MILLI * along


def draw_cam(cam: DiscCam, axes: Any = None, **style: Any) -> list[Artist]:
    """Draw a cam with its follower around it, and displacement, pressure angle and curvature over the cam's angle.

    Into one pair of axes the cam alone is drawn; without a pressure angle three are enough for all.
    """
    report = CamReport(cam)
    # the radius of curvature says in mm what the curvature does
    drawn = report.panels[:-1]
    if axes is None:
        with plot_style():
            axes = _figure(len(drawn))[1]
    panels = list(np.ravel(np.asarray(axes, dtype=object)))
    if len(panels) not in {1, 1 + len(drawn)}:
        most = "four" if len(drawn) == 3 else "three"
        raise InputError(f"a cam is drawn into one pair of axes or into {most}, got {len(panels)}")
    artists = _draw_mechanism(cam, panels[0], {"color": BLUES[3]} | style)
    return artists if len(panels) == 1 else artists + _draw(report, drawn, panels[1:], **style)


def _figure(rows: int) -> tuple[Figure, list[Axes]]:
    figure = new_figure(10.4, 5.6)
    grid = figure.add_gridspec(rows, 2, width_ratios=(1.15, 1.0))
    right: list[Axes] = []
    for row in range(rows):
        right.append(figure.add_subplot(grid[row, 1], sharex=right[0] if right else None))
    for edge in right[:-1]:
        edge.tick_params(labelbottom=False)
    return figure, [figure.add_subplot(grid[:, 0]), *right]


def _draw_mechanism(cam: DiscCam, axes: Axes, style: dict[str, Any]) -> list[Artist]:
    """The profile with its base circle, the pitch curve with its prime circle, and the follower seen from the cam."""
    first, last = cam.displacement.interval
    angles = np.linspace(first, last, _SAMPLES)
    axes.set_aspect("equal")
    if cam.displacement.closed:
        axes.fill(*(MILLI * cam.profile(angles)).T, color=_FILL, zorder=1)
    artists = _draw_profile(cam, axes, {"zorder": 4, "label": "profile"} | style)
    _draw_circle(axes, cam.base_radius, "base circle", (0, (6, 4)))
    if cam.contact.roller:
        _draw_circle(axes, cam.base_radius + cam.contact.roller, "prime circle", (0, (6, 2, 1, 2)))
        dotted: Any = {"color": GREY, "linewidth": 0.8, "linestyle": ":", "zorder": 2}
        axes.plot(*(MILLI * cam.pitch_curve(angles)).T, label="pitch curve", **dotted)
    for i, at in enumerate(np.linspace(first, last, _SHOWN, endpoint=not cam.displacement.closed)):
        _draw_follower(cam, axes, float(at), GREY if i else WARM)
    axes.plot([], [], color=WARM, linewidth=1.1, label="follower at the start")
    axes.plot([0.0], [0.0], "+", color=GREY, markersize=9.0, zorder=5)
    axes.set(xlabel="x of the cam, mm", ylabel="y of the cam, mm")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=3, borderpad=1.0)
    return artists


def _draw_profile(cam: DiscCam, axes: Axes, style: dict[str, Any]) -> list[Artist]:
    return list(axes.plot(*(MILLI * cam.profile(np.linspace(*cam.displacement.interval, _SAMPLES))).T, **style))


def _draw_circle(axes: Axes, radius: float, label: str, dashes: Any) -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, _SAMPLES)
    points = MILLI * radius * np.array([np.cos(turn), np.sin(turn)])
    axes.plot(*points, color=GREY, linewidth=0.8, linestyle=dashes, zorder=2, label=label)


def _draw_follower(cam: DiscCam, axes: Axes, angle: float, colour: str) -> None:
    """A roller with its arm or rod, or a face, in the cam's coordinates."""
    at = np.array(angle)
    farthest = float(np.abs(MILLI * cam.profile(np.linspace(*cam.displacement.interval, 61))).max())
    _draw_body(cam, axes, at, colour, 0.45 * farthest)
    if cam.contact.roller:
        centre = MILLI * cam.pitch_curve(at)
        rod = np.array([centre, _holder(cam, cam.contact, angle, centre)])
        axes.plot(*rod.T, color=colour, linewidth=1.1, zorder=3)


def _holder(cam: DiscCam, contact: FollowerContact, angle: float, centre: Array) -> Array:
    """The displayed end of a rod, or the pivot of an arm, mm."""
    turned = -contact.turning * angle + _phase(cam, angle)
    if contact.pivot is not None:
        return MILLI * contact.pivot * np.array([np.cos(turned), np.sin(turned)])
    return centre + MILLI * 2.5 * contact.roller * np.array([-np.sin(turned), np.cos(turned)])


def _phase(cam: DiscCam, angle: float) -> float:
    """The angle by which the cam's coordinates are turned: where its curve is beside where its follower is."""
    x, y = (float(coordinate.terms[0]) for coordinate in cam.contact.point(cam.displacement.jet(np.array(angle), 2)))
    curve = cam.pitch_curve(np.array(angle))
    return float(np.arctan2(curve[1], curve[0]) - np.arctan2(y, x) + cam.contact.turning * angle)


_FRAMES = 241
_FACE = 0.6  # half the length of a face, in least radii
_MARGIN = 6.0


def animated(cam: DiscCam, seconds: float = 4.0) -> str:
    """The picture of a turn in a number of seconds, repeated, in millimetres; y points up."""
    from optlaws.cams.curves.approximations import spline
    from optlaws.cams.curves.cam_files import beziers

    outline = beziers(spline(cam.profile, _OUTLINE_DRAWN)) * [MILLI, -MILLI]
    curves = " ".join(f"C {_pair(a)} {_pair(b)} {_pair(c)}" for _, a, b, c in outline)
    path = f"M {_pair(outline[0, 0])} {curves} Z"
    every = f'dur="{seconds:g}s" repeatCount="indefinite"'
    turn = -360.0 * cam.contact.turning
    kind, values = _svg_motion(cam)
    half = MILLI * (_reach(cam) + 0.5 * cam.contact.roller) + _MARGIN
    box = f"{-half:.3f} {-half:.3f} {2 * half:.3f} {2 * half:.3f}"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="480" height="480" viewBox="{box}">\n'
        f"<desc>a cam that turns under its follower; {MARK}</desc>\n"
        f'<g fill="none" stroke-width="{half / 180:.3f}">\n'
        f'<path fill="#dfe9f3" stroke="{BLUES[3]}" d="{path} M 0 0 H {half / 8:.3f}">\n'
        f'<animateTransform attributeName="transform" type="rotate" from="0" to="{turn:g}" {every}/></path>\n'
        f'<g stroke="{WARM}">{_svg_follower(cam)}\n'
        f'<animateTransform attributeName="transform" type="{kind}" values="{values}" {every}/></g>\n'
        f'<circle r="{half / 60:.3f}" stroke="{GREY}"/>\n</g>\n</svg>\n'
    )


def _reach(cam: DiscCam) -> float:
    """The greatest distance of the picture's contents from the centre."""
    angles = np.linspace(*cam.displacement.interval, _FRAMES)
    far = float(np.linalg.norm(cam.pitch_curve(angles), axis=1).max()) + 2.0 * cam.contact.roller
    return max(far, cam.contact.pivot or 0.0)


def _svg_motion(cam: DiscCam) -> tuple[str, str]:
    """How the follower moves from where it is at first: along its way, or about its pivot, clockwise as it rises."""
    angles = np.linspace(*cam.displacement.interval, _FRAMES)
    off = np.asarray(cam.displacement(angles)) - float(cam.displacement(float(angles[0])))
    if cam.contact.pivot is not None:
        pivot = f"{MILLI * cam.contact.pivot:.3f} 0"
        return "rotate", ";".join(f"{np.degrees(angle):.4f} {pivot}" for angle in off)
    return "translate", ";".join(f"0 {-MILLI * length:.4f}" for length in off)


def _svg_follower(cam: DiscCam) -> str:
    """The follower in its initial position."""
    contact, first = cam.contact, np.array(cam.displacement.interval[0])
    s = cam.displacement.jet(first, 2)
    x, y = (MILLI * float(coordinate.terms[0]) for coordinate in contact.point(s))
    if not contact.roller:
        normal = contact.normal(s)
        along = (
            np.array([1.0, 0.0]) if normal is None else np.array([float(n.terms[0]) for n in (normal[1], normal[0])])
        )
        way = _FACE * MILLI * _reach(cam) * along * [1.0, -1.0]
        return f'<path d="M {x - way[0]:.3f} {-(y - way[1]):.3f} L {x + way[0]:.3f} {-(y + way[1]):.3f}"/>'
    end = f"{x:.3f} {-2.0 * y:.3f}" if contact.pivot is None else f"{MILLI * contact.pivot:.3f} 0"
    return (
        f'<circle cx="{x:.3f}" cy="{-y:.3f}" r="{MILLI * contact.roller:.3f}" fill="white"/>'
        f'<path d="M {x:.3f} {-y:.3f} L {end}"/>'
    )


def _pair(point: Array) -> str:
    return f"{point[0]:.3f},{point[1]:.3f}"
