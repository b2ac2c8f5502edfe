"""The problem file of the job "cam": the follower's cycle, the follower, the prime circle and limits, with units."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias

import msgspec

from optlaws.cams.curves.cam_files import format_of
from optlaws.cams.curves.file_options import Cutting
from optlaws.cams.disc import DiscCam
from optlaws.errors import InputError
from optlaws.files import writing
from optlaws.files.problem_file import Text
from optlaws.jobs.cycle_entries import AxisEntries
from optlaws.jobs.job import JobFile

#: its kind, and the entries that this kind takes
FollowerEntries: TypeAlias = dict[str, str]
Several = Annotated[tuple[int, ...], msgspec.Meta(max_length=10)]


class ForcesEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Forces of the cam under the drive of its motion."""

    friction: dict[str, float | str] = {}
    width: str | None = None
    materials: tuple[str, str] = ("steel", "steel")
    irregularity: float | None = None

    def options(self) -> dict[str, Any]:
        """Entries of the forces themselves."""
        return {"friction": self.friction, "width": self.width, "materials": self.materials}


class SpringEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A spring that keeps the follower on the cam over a range of speeds."""

    speeds: tuple[str, str]
    force: str | None = None
    stiffness: str | None = None
    preload: str | None = None
    greatest: Literal["force", "contact"] = "force"


class AsManufacturedEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The files whose executed motion is reported: tables of a number of points and decimals, and profile errors."""

    points: Several = (361, 721)
    decimals: Several = (3, 4, 6)
    curve: str = "profile"
    error: str | None = None
    waves: Several = (3, 12)


class FileEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A file that cuts the cam; what is not given is as in `DiscCam.export`."""

    name: Text
    format: str | None = None
    curve: str | None = None
    cutter_radius: str | None = None
    tolerance: str | None = None
    decimals: int | None = None
    points: int | None = None
    degree: int | None = None
    feed: str | None = None

    def options(self) -> dict[str, Any]:
        """Entries of the export that are given."""
        given = msgspec.structs.asdict(self)
        return {key: value for key, value in given.items() if key not in {"name", "format"} and value is not None}

    def check(self, cam: DiscCam) -> None:
        """Refuse before the work is done what would be refused when the file is written."""
        if Path(self.name).name != self.name:
            raise InputError(f"file: name must be that of a file in the folder of results, got {self.name!r}")
        writing.check_name(Path(self.name))
        format_of(Path(self.name), self.format)
        entries = self.options()
        cam.outline(entries.pop("curve", None), entries.pop("cutter_radius", None))
        Cutting(**entries)


class PairEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The return cam: how its follower is fixed to the first one, and the follower where it is another."""

    distance: str | None = None
    angle: str | None = None
    follower: FollowerEntries | None = None


class CamProblemFile(JobFile, kw_only=True, forbid_unknown_fields=True):
    """The problem file of a disc cam."""

    motion: Annotated[dict[str, Any], AxisEntries]
    follower: FollowerEntries
    prime_radius: str | None = None
    #: the name that earlier files have for `prime_radius`
    base_radius: str | None = None
    #: "base circle" is what earlier files call "prime circle"
    best: Literal["laws", "prime circle", "base circle", "offset"] | None = None
    pair: PairEntries | None = None
    speed: str | None = None
    period: str | None = None
    turning: str = "counterclockwise"
    cutter_radius: str | None = None
    pressure_angle: str | None = None
    radius_of_curvature: str | None = None
    rows: Annotated[int, msgspec.Meta(ge=2, le=100_000)] = 361
    process: dict[str, Any] | None = None
    forces: ForcesEntries | None = None
    spring: SpringEntries | None = None
    as_made: AsManufacturedEntries | None = None
    file: Annotated[list[FileEntries], msgspec.Meta(max_length=50)] = msgspec.field(default_factory=list)
    animation: bool = False

    def __post_init__(self) -> None:
        if self.best == "base circle":
            self.best = "prime circle"

    @property
    def limits(self) -> dict[str, Any]:
        """The limits of the cam, and how it turns, as functions of sizes and of best laws take them."""
        limits = {"pressure_angle": self.pressure_angle, "radius_of_curvature": self.radius_of_curvature}
        return {**limits, "turning": self.turning}
