"""The problem file of the job "cycle": axes with their segments, every number with its unit."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from optlaws.cycles.cycle import Cycle
from optlaws.cycles.interchange import CLOCK, ENTRIES, KINDS
from optlaws.cycles.machine_axes import Axes, Overlap
from optlaws.cycles.specification.segments import CycleSegment
from optlaws.errors import InfeasibleProblem, InputError, located
from optlaws.files.problem_file import Text, convert
from optlaws.jobs.job import JobFile

Kind = Literal["dwell", "constant velocity", "move", "rise", "return", "free"]


class SegmentEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A segment; which entries it may have beside its duration depends on its kind."""

    kind: Kind
    duration: str | list[str] | None = None
    least: str | None = None
    name: str | None = None
    by: str | None = None
    to: str | None = None
    law: Text | None = None
    limits: dict[str, str] | None = None
    velocity: str | None = None
    start_velocity: str | None = None
    end_velocity: str | None = None
    via: list[list[str]] | None = None


class ElasticFollowerEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """An elastic follower whose mass is to move as the cycle says."""

    period: str
    damping: float = 0.0


class ExportEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """An export of an axis: its format, its file, and what the format takes."""

    to: str
    file: Text | None = None
    master: str = "360 deg"
    unit: str | None = None
    points: int | str | None = None
    counts: int | None = None
    digits: int | None = None
    decimal: str | None = None
    interpolation: str | None = None
    task: str | None = None
    name: str | None = None


class LoadEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A mass on a spring that the motion drives."""

    period: str
    damping: float = 0.0
    mass: str | None = None
    inertia: str | None = None


class AxisEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """One axis of the machine."""

    name: Text
    segment: Annotated[list[SegmentEntries], msgspec.Meta(min_length=1, max_length=100)]
    minimise: str = "acceleration"
    limits: dict[str, str] = {}
    start: str | None = None
    advance: str | None = None
    drive: dict[str, str] | None = None
    load: LoadEntries | None = None
    follower: ElasticFollowerEntries | None = None
    export: Annotated[list[ExportEntries], msgspec.Meta(max_length=20)] = []
    order: int = 3
    degree: int = 9


class InterlockEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A condition on two axes; which entries it has beside the axis depends on its kind."""

    kind: Literal["after", "clearance", "forbidden", "synchronous"]
    axis: Text
    name: Text | None = None
    position: str | None = None
    of: str | None = None
    above: str | None = None
    below: str | None = None
    way: str | None = None
    over: str | None = None
    least: str | list[list[str]] | None = None
    most: str | list[list[str]] | None = None
    units: list[str] | None = None
    across: str | None = None
    corners: list[list[str]] | None = None
    to: str | None = None
    during: list[str] | None = None
    within: str | None = None
    ratio: float | None = None


class OverlapEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """How moves are to overlap: the goal, and of an acceleration the axes whose moves may take longer."""

    goal: Literal["period", "acceleration"]
    of: Annotated[list[Text], msgspec.Meta(max_length=8)] = []


class CycleProblemFile(JobFile, kw_only=True, forbid_unknown_fields=True):
    """The problem file of a cycle with its axes."""

    axis: Annotated[list[AxisEntries], msgspec.Meta(min_length=1, max_length=8)]
    interlocks: Annotated[list[InterlockEntries], msgspec.Meta(max_length=50)] = msgspec.field(default_factory=list)
    overlap: OverlapEntries | None = None
    speed: str | None = None
    period: str | None = None
    rows: Annotated[int, msgspec.Meta(ge=2, le=100_000)] = 361


def read(data: Mapping[str, Any], file: Path) -> tuple[CycleProblemFile, Axes]:
    """The entries of a file, and its axes, which are cycles by their names; overlapped where the file says so.

    Raises
    ------
    InputError, InfeasibleProblem
        As `read_given`, or if the axes cannot overlap; the error names the file.
    """
    spec, axes = read_given(data, file)
    overlap = overlap_of(spec, axes, file)
    return spec, axes if overlap is None else overlap.axes


def overlap_of(spec: CycleProblemFile, axes: Axes, file: Path) -> Overlap | None:
    """How the axes of a file overlap; None where it says nothing of that."""
    if spec.overlap is None:
        return None
    with located(str(file)):
        return axes.fastest() if spec.overlap.goal == "period" else axes.gentlest(*spec.overlap.of)


def read_given(data: Mapping[str, Any], file: Path) -> tuple[CycleProblemFile, Axes]:
    """The entries of a file, and its axes as they are given.

    Raises
    ------
    InputError
        If an entry is unknown or wrong; the error names the file, the axis and the segment, or the interlock.
    """
    spec = convert(data, CycleProblemFile, file)
    cycles: dict[str, Cycle] = {}
    for axis in spec.axis:
        if axis.name in cycles:
            raise InputError(f"{file}: two axes are called {axis.name}: give each a name of its own")
        try:
            cycles[axis.name] = cycle_of(axis, spec.speed, spec.period)
        except (InputError, InfeasibleProblem) as error:
            raise type(error)(f"{file}: axis {axis.name}: {error}") from None
    if len(cycles) > 1 and spec.interlocks and "interlocks" in cycles:
        raise InputError(f"{file}: an axis is called interlocks, as what is known of them is: give it another name")
    with located(str(file)):
        return spec, Axes(cycles, interlocks=[_given(entries) for entries in spec.interlocks])


def cycle_of(axis: AxisEntries, speed: str | None, period: str | None) -> Cycle:
    """The cycle of an axis: that of the cam, where there is a follower."""
    segments = [segment_of(entry, i + 1) for i, entry in enumerate(axis.segment)]
    given: dict[str, Any] = {name: getattr(axis, name) for name in ENTRIES if name not in CLOCK}
    given["load"] = None if axis.load is None else _given(axis.load)
    cycle = Cycle(segments, speed=speed, period=period, **given)
    return cycle if axis.follower is None else cycle.cam(axis.follower.period, axis.follower.damping)


def _given(entries: msgspec.Struct) -> dict[str, Any]:
    """Entries that were given."""
    return {name: value for name, value in msgspec.structs.asdict(entries).items() if value is not None}


def segment_of(entries: SegmentEntries, number: int) -> CycleSegment:
    """A segment of a file."""
    kind = KINDS[entries.kind]
    given = _given(entries)
    del given["kind"]
    taken = kind.__dataclass_fields__
    for name in given:
        if name not in taken:
            raise InputError(f"segment {number}: a {entries.kind} takes no {name}; it takes {', '.join(taken)}")
    if entries.kind == "constant velocity" and entries.velocity is None:
        raise InputError(f"segment {number}: a constant velocity needs its velocity, such as velocity = '300 mm/s'")
    segment: CycleSegment = kind(**given)
    return segment
