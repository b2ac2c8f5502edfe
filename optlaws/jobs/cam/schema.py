"""The problem file of the job "cam": the follower's cycle, the follower, the base circle and limits, with units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias

import msgspec

from optlaws.cams.best_laws import BestBaseCircle, BestCam, best_base_circle, best_cam
from optlaws.cams.conjugate import conjugate_cam
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.follower import read_follower
from optlaws.cycles.cycle import Cycle
from optlaws.errors import InputError
from optlaws.files.problem_file import Text, convert
from optlaws.jobs.cam.forces_and_files import ForcesAndFiles, check
from optlaws.jobs.cycle_entries import AxisEntries, cycle_of

#: its kind, and the entries that this kind takes
FollowerEntries: TypeAlias = dict[str, str]


class PairEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The return cam: how its follower is fixed to the first one, and the follower where it is another."""

    distance: str | None = None
    angle: str | None = None
    follower: FollowerEntries | None = None


class CamProblemFile(ForcesAndFiles, kw_only=True, forbid_unknown_fields=True):
    """The problem file of a disc cam."""

    job: str
    title: Text
    motion: AxisEntries
    follower: FollowerEntries
    base_radius: str | None = None
    best: Literal["laws", "base circle"] | None = None
    pair: PairEntries | None = None
    speed: str | None = None
    period: str | None = None
    turning: str = "counterclockwise"
    cutter_radius: str | None = None
    pressure_angle: str | None = None
    radius_of_curvature: str | None = None
    rows: Annotated[int, msgspec.Meta(ge=2, le=100_000)] = 361
    text: str = ""

    @property
    def limits(self) -> dict[str, Any]:
        """The limits of the cam, and how it turns, as functions of sizes and of best laws take them."""
        limits = {"pressure_angle": self.pressure_angle, "radius_of_curvature": self.radius_of_curvature}
        return {**limits, "turning": self.turning}


@dataclass(frozen=True)
class Cams:
    """The cams that a problem file asks for.

    Attributes
    ----------
    cycle
        As the file gives it.
    first
        The cam; with the laws found where the best ones are sought.
    best
        How good these are, and the proof.
    second
        The return cam of a pair.
    """

    cycle: Cycle
    first: DiscCam
    best: BestCam | BestBaseCircle | None = None
    second: DiscCam | None = None


def read(data: Mapping[str, Any], file: Path) -> tuple[CamProblemFile, Cams]:
    """The entries of a file, and the cams.

    Raises
    ------
    InputError
        If an entry is unknown or wrong; the error names the file.
    """
    spec = convert(data, CamProblemFile, file)
    try:
        cams = _cams(spec)
        if spec.cutter_radius is not None:
            cams.first.cutter_path(spec.cutter_radius)
        check(spec, cams.first, cams.cycle)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None
    return spec, cams


def _cams(spec: CamProblemFile) -> Cams:
    follower = read_follower(spec.follower)
    if spec.best != "base circle" and spec.base_radius is None:
        raise InputError("base_radius is missing: give it, such as '60 mm', or ask for best = 'base circle'")
    if spec.best == "base circle" and spec.base_radius is not None:
        raise InputError("base_radius is what best = 'base circle' looks for: leave it out, or ask for best = 'laws'")
    cycle = cycle_of(spec.motion, spec.speed, spec.period)
    radius: Any = spec.base_radius
    if spec.best is None:
        cam = DiscCam(cycle, radius, follower, turning=spec.limits["turning"])
        return Cams(cycle, cam, None, _second(spec.pair, cam))
    if spec.best == "laws":
        best = best_cam(cycle, radius, follower, **spec.limits)
        return Cams(cycle, best.cam, best, _second(spec.pair, best.cam))
    least = best_base_circle(cycle, follower, **spec.limits)
    return Cams(cycle, least.least.cam, least, _second(spec.pair, least.least.cam))


def _second(entries: PairEntries | None, cam: DiscCam) -> DiscCam | None:
    if entries is None:
        return None
    follower = None if entries.follower is None else read_follower(entries.follower)
    try:
        return conjugate_cam(cam, follower, distance=entries.distance, angle=entries.angle)
    except InputError as error:
        raise InputError(f"pair: {error}") from None
