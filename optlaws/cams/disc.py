"""A disc cam: a motion, a prime circle and a follower, with all its curves as functions of the cam's angle."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal, Unpack

import numpy as np

from optlaws.cams.curves.cam_files import CURVES, CutCurve, CutFormat, Cutting, CuttingOptions, write_outline
from optlaws.cams.curves.extremes import CamExtremes
from optlaws.cams.curves.motion_by_angle import CamMotion, as_motion
from optlaws.cams.curves.plane_curve import PlaneCurve
from optlaws.cams.followers.contact import FollowerContact
from optlaws.cams.followers.follower import CamFollower, Place, follower_names, positive
from optlaws.cycles.cycle import Cycle, Plan
from optlaws.echo import keywords_of, shortened
from optlaws.entries.declared import documented_by
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.motion.quantities import in_degrees, quantity
from optlaws.numbers import Array, NumberOrQuantity, derivative, number_or_array, real_times
from optlaws.numerics.interval import Interval
from optlaws.numerics.taylor import Pair, turned, variable
from optlaws.sentences import sentence
from optlaws.shown.report import Report
from optlaws.shown.summary import Summary

Turning = Literal["counterclockwise", "clockwise"]
TURNINGS: dict[Turning, float] = {"counterclockwise": 1.0, "clockwise": -1.0}


def sense(turning: Any) -> float:
    """The sense in which a cam turns, 1 for counterclockwise and -1 for clockwise."""
    check_names([turning], TURNINGS, "turning")
    return TURNINGS[turning]


@dataclass(frozen=True)
class DiscCam:
    """A disc cam and its follower; lengths in metres, angles in radians, derivatives by the cam's angle.

    Parameters
    ----------
    motion
        A `Cycle`, which is a turn of the cam, or the law of a part of the turn, `CamMotion.of_law(...)`.
    prime_radius
        Radius of the prime circle, such as "80 mm": the distance of the roller's centre, or of the flat face, from the
        cam's centre where the follower is lowest. The base circle of the profile is smaller by the roller's radius.
    follower
        Such as `TranslatingRoller("12 mm")`: a roller or a flat face on a slide or an arm.
    turning
        "counterclockwise" or "clockwise", seen with a slide's way pointing up or a pivot to the right of the cam.
    phase
        By how much the coordinates of the cam are turned, counterclockwise; for cams on one shaft.
    mirrored
        Whether the coordinates of the cam are mirrored at the line through its centre and a pivot to the right, for the
        second follower of a pair, on the other side; `turning` is as it is seen in the mirror.

    Raises
    ------
    InputError
        If there is no such mechanism, or an argument of a method is none; the error states the remedy.

    Examples
    --------
    >>> from optlaws import TranslatingRoller
    >>> from optlaws import Dwell, Return, Rise
    >>> segments = [Rise("40 mm", "120 deg", law="cycloidal"), Dwell("60 deg"), Return(law="cycloidal")]
    >>> cam = DiscCam(Cycle(segments, speed="200 rpm"), prime_radius="80 mm", follower=TranslatingRoller("12 mm"))
    >>> round(float(np.degrees(cam.pressure_angle(1.0))), 6), cam.profile(1.0).shape
    (21.157747, (2,))
    """

    motion: Cycle | Plan | CamMotion
    prime_radius: NumberOrQuantity
    follower: CamFollower
    turning: Turning = field(default="counterclockwise", kw_only=True)
    phase: NumberOrQuantity = field(default="0 deg", kw_only=True)
    mirrored: bool = field(default=False, kw_only=True)

    def __post_init__(self) -> None:
        if not isinstance(self.follower, CamFollower):
            raise InputError(f"follower must be a {follower_names()}, got {shortened(self.follower)}")
        sense(self.turning)
        quantity(self.phase, "angle", "phase")
        self.contact  # noqa: B018 - what cannot be built is refused at once

    @kept_property
    def displacement(self) -> CamMotion:
        """The displacement of the follower by the cam's angle."""
        motion = as_motion(self.motion, self.follower.axis)
        _check_smooth(motion)
        return motion

    @kept_property
    def contact(self) -> FollowerContact:
        """How the follower touches the cam, in numbers."""
        radius, motion = positive(self.prime_radius, "prime_radius"), self.displacement
        return self.follower.contact(Place(radius, *motion.range, motion.slopes, sense(self.turning)))

    @property
    def base_radius(self) -> float:
        """Radius of the base circle, the smallest circle that touches the profile, m.

        Examples
        --------
        >>> from optlaws import Cycle, DiscCam, Return, Rise, TranslatingRoller
        >>> lift = Cycle([Rise("25 mm", "150 deg", law="3-4-5"), Return(law="3-4-5")], speed="300 rpm")
        >>> DiscCam(lift, prime_radius="50 mm", follower=TranslatingRoller("10 mm")).base_radius
        0.04
        """
        return positive(self.prime_radius, "prime_radius") - self.contact.roller

    @kept_property
    def extremes(self) -> CamExtremes:
        """Enclosed extremes over the whole turn: pressure angles, radii of curvature, undercut."""
        return self.contact.extremes(self.displacement)

    @kept_property
    def pitch_curve(self) -> PlaneCurve:
        """The way of the roller's centre around the cam; under a flat face the profile itself."""
        phase = quantity(self.phase, "angle", "phase")
        return FollowerCurve(self.displacement, self.contact, phase, mirrored=bool(self.mirrored))

    @kept_property
    def profile(self) -> PlaneCurve:
        """The profile of the cam, its edge."""
        return self.pitch_curve.offset(-self.contact.roller) if self.contact.roller else self.pitch_curve

    def cutter_path(self, cutter_radius: NumberOrQuantity) -> PlaneCurve:
        """The path of the centre of a cutter or grinding wheel that cuts the profile."""
        return self.pitch_curve.offset(positive(cutter_radius, "cutter_radius") - self.contact.roller)

    def outline(self, curve: CutCurve | None = None, cutter_radius: NumberOrQuantity | None = None) -> PlaneCurve:
        """The curve that is cut: the "profile", the "pitch" curve, or the path of a "cutter" with a radius."""
        chosen = curve or ("profile" if cutter_radius is None else "cutter")
        check_names([chosen], CURVES, "curve")
        if (chosen == "cutter") != (cutter_radius is not None):
            raise InputError(
                "cutter_radius and curve='cutter' go together: give the radius, such as cutter_radius='10 mm'"
            )
        if cutter_radius is not None:
            return self.cutter_path(cutter_radius)
        return self.profile if chosen == "profile" else self.pitch_curve

    @documented_by(Cutting)
    @keywords_of(CuttingOptions)
    def export(
        self,
        file: str | Path,
        as_: CutFormat | None = None,
        *,
        curve: CutCurve | None = None,
        cutter_radius: NumberOrQuantity | None = None,
        force: bool = False,
        **options: Unpack[CuttingOptions],
    ) -> Path:
        """Write the profile, the pitch curve or the path of a cutter to a file, whole or not at all; return its path.

        Parameters
        ----------
        file
            Where; its ending (.dxf, .svg, .csv, .nc) says the format unless `as_` does.
        as_
            "dxf spline", "dxf polyline", "dxf arcs", "svg", "csv", "csv polar", "g-code" or "g-code arcs".
        curve, cutter_radius
            "profile", "pitch", or "cutter" with the cutter's radius, such as "10 mm"; the profile unless given.
        about
            The comment in the file.
        force
            Whether a file with other contents is replaced.

        Raises
        ------
        InputError
            If an entry is unknown or out of its range, the motion is no whole turn, or the file cannot be written.
        """
        return write_outline(self.outline(curve, cutter_radius), file, as_, force=force, **options)

    def summary(self) -> Summary:
        """The proven undercut, pressure angles and radii of the cam, and its forces if it has a drive, as rows.

        Examples
        --------
        >>> from optlaws import Cycle, DiscCam, Return, Rise, TranslatingRoller
        >>> lift = Cycle([Rise("25 mm", "150 deg", law="3-4-5"), Return(law="3-4-5")], speed="300 rpm")
        >>> cam = DiscCam(lift, "50 mm", TranslatingRoller("10 mm"))
        >>> [(row.name, row.text(6), row.unit, row.place is None) for row in cam.summary()][:2]
        [('undercut', 'free', '', True), ('radius of the prime circle', '50', 'mm', True)]
        """
        return self.report().facts

    def report(self) -> Report:
        """The facts of the cam, its enclosed extremes, and its motion, pressure angle and curvature as curves.

        Examples
        --------
        >>> from optlaws import Cycle, DiscCam, Return, Rise, TranslatingRoller
        >>> lift = Cycle([Rise("25 mm", "150 deg", law="3-4-5"), Return(law="3-4-5")], speed="300 rpm")
        >>> [panel.title for panel in DiscCam(lift, "50 mm", TranslatingRoller("10 mm")).report().panels][:2]
        ['displacement, mm', 'pressure angle, deg']
        """
        from optlaws.cams.report import CamReport

        return CamReport(self)

    def _repr_html_(self) -> str:
        return self.summary()._repr_html_()

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:
        """Draw the cam with its follower, pressure angle, curvature and displacement; return the artists of matplotlib.

        `ax` is one pair of axes, for the cam alone, or four; a new figure unless given. `style` is what `Axes.plot`
        takes, for the curves.
        """
        from optlaws.plots.cam import draw_cam

        return draw_cam(self, ax, **style)

    def pressure_angle(self, angle: Any, nu: int = 0) -> Any:
        """The angle between the force on the follower and its way, rad, or a derivative of it by the cam's angle."""
        nu = derivative(nu)
        s = self.displacement.jet(real_times(angle), nu + 2)
        return number_or_array(self.contact.pressure(s).cut(nu).arctangent().derivative(nu))

    def radius_of_curvature(self, angle: Any) -> Any:
        """The radius of curvature of the profile, m: above 0 where it is convex, below where it is concave."""
        s = self.displacement.jet(real_times(angle), 2)
        return number_or_array(self.contact.radius_of_curvature(s))


@dataclass(frozen=True)
class FollowerCurve(PlaneCurve):
    """The path of a roller's centre around the cam, or the envelope of a flat face."""

    motion: CamMotion
    contact: FollowerContact
    phase: float
    mirrored: bool = False

    @property
    def breaks(self) -> tuple[float, ...]:
        return self.motion.breaks

    @property
    def closed(self) -> bool:
        return self.motion.closed

    @property
    def turning(self) -> float:
        return -self.contact.turning if self.mirrored else self.contact.turning

    def jets(self, angle: Array | Interval, order: int, *, before: bool = False) -> Pair:
        s = self.motion.jet(angle, order + self.contact.lost, before=before)
        return self._in_cam(self.contact.point(s), angle, order)

    def normal_jets(self, angle: Array | Interval, order: int, *, before: bool = False) -> Pair:
        normal = self.contact.normal(self.motion.jet(angle, order, before=before))
        return (
            super().normal_jets(angle, order, before=before) if normal is None else self._in_cam(normal, angle, order)
        )

    def _in_cam(self, pair: Pair, angle: Array | Interval, order: int) -> Pair:
        at = angle if isinstance(angle, Interval) else self.motion.within(angle)
        x, y = turned(pair, variable(at, order) * -self.contact.turning + self.phase)
        return (x, -y) if self.mirrored else (x, y)


def _check_smooth(motion: CamMotion) -> None:
    """Refuse a motion whose velocity jumps or whose acceleration has no bound: a cam would have a corner."""
    for stretch in motion.stretches:
        if not np.isfinite(stretch.extremes(2)).all():
            raise InputError(
                sentence(
                    "motion: the acceleration of its law between {} and {} of the cam has no bound, and the cam would "
                    "have a corner: take a law whose C is finite",
                    in_degrees(stretch.start), in_degrees(stretch.stop),
                )
            )  # fmt: skip
    inner = np.array(motion.breaks[1:-1] if not motion.closed else motion.breaks)
    if not len(inner):
        return
    after = np.asarray(motion.jet(inner, 1).terms[1])
    before = np.asarray(motion.jet(inner, 1, before=True).terms[1])
    if motion.closed:  # what is before the start is at the end, and what is after the end at the start
        before[0], after[-1] = before[-1], after[0]
    jumps = np.abs(after - before)
    if jumps.max() > 1e-9 * max(abs(slope) for slope in motion.slopes):
        place = in_degrees(inner[int(np.argmax(jumps))])
        raise InputError(
            sentence(
                "motion: its velocity jumps at {} of the cam, where the cam would have a corner: take laws whose "
                "velocities meet",
                place,
            )
        )
