"""The problem file of the job "cam": the follower's cycle, the follower, the base circle and limits, with units."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.follower import Follower
from optlaws.cams.followers.oscillating_flat import OscillatingFlat
from optlaws.cams.followers.oscillating_roller import OscillatingRoller
from optlaws.cams.followers.translating_flat import TranslatingFlat
from optlaws.cams.followers.translating_roller import TranslatingRoller
from optlaws.errors import InputError
from optlaws.files.problem_file import Text, convert
from optlaws.jobs.cam.more import More, check
from optlaws.jobs.cycle.entries import Axis, cycle_of

Kind = Literal["translating roller", "translating flat", "oscillating roller", "oscillating flat"]
KINDS: dict[str, type[Any]] = {
    "translating roller": TranslatingRoller,
    "translating flat": TranslatingFlat,
    "oscillating roller": OscillatingRoller,
    "oscillating flat": OscillatingFlat,
}


class AskedFollower(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A follower; which entries it has depends on its kind."""

    kind: Kind
    radius: str | None = None
    offset: str | None = None
    arm: str | None = None
    pivot_distance: str | None = None
    face_offset: str | None = None


class Study(More, kw_only=True, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: Text
    motion: Axis
    follower: AskedFollower
    base_radius: str
    speed: str | None = None
    period: str | None = None
    turning: str = "counterclockwise"
    cutter_radius: str | None = None
    pressure_angle: str | None = None
    radius_of_curvature: str | None = None
    rows: Annotated[int, msgspec.Meta(ge=2, le=100_000)] = 361
    text: str = ""


def read(data: Mapping[str, Any], file: Path) -> tuple[Study, DiscCam]:
    """The entries of a file, and the cam.

    Raises
    ------
    InputError
        If an entry is unknown or wrong; the error names the file.
    """
    spec = convert(data, Study, file)
    try:
        cycle = cycle_of(spec.motion, spec.speed, spec.period)
        cam = DiscCam(cycle, spec.base_radius, follower_of(spec.follower), turning=spec.turning)
        if spec.cutter_radius is not None:
            cam.cutter_path(spec.cutter_radius)
        check(spec, cam)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None
    return spec, cam


def follower_of(asked: AskedFollower) -> Follower:
    """A follower of a file.

    Raises
    ------
    InputError
        If it has an entry that its kind does not take, or lacks one.

    Examples
    --------
    >>> follower_of(AskedFollower(kind="translating roller", radius="12 mm"))
    TranslatingRoller(radius='12 mm', offset='0 mm')
    """
    kind = KINDS[asked.kind]
    given = {name: value for name, value in msgspec.structs.asdict(asked).items() if value is not None}
    del given["kind"]
    taken = kind.__dataclass_fields__
    for name in given:
        if name not in taken:
            raise InputError(f"follower: a {asked.kind} takes no {name}; it takes {', '.join(taken) or 'no entries'}")
    for name in taken:
        if name not in given and name not in {"offset", "face_offset"}:
            raise InputError(f"follower: a {asked.kind} needs its {name}, such as {name} = '12 mm'")
    found: Follower = kind(**given)
    return found
