"""The problem file of the job "cycle": axes with their segments, every number with its unit."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec

from optlaws.cycles.cycle import Cycle
from optlaws.cycles.interchange import CLOCK, ENTRIES
from optlaws.cycles.interlocks.interlock import Interlock
from optlaws.cycles.specification.segments import SEGMENTS, CycleSegment
from optlaws.errors import InputError, located
from optlaws.files.problem_file import Text, convert
from optlaws.jobs.axes.axis_transitions import TransitionEntries
from optlaws.jobs.axes.drive_entries import drive_of
from optlaws.jobs.axes.entry_sweep import SweepEntries, SweptCycle, swept
from optlaws.jobs.job import JobFile
from optlaws.suggest import unknown_key

if TYPE_CHECKING:
    from optlaws.cycles.machine_axes import Axes, Overlap


class OverlapEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """How moves are to overlap: the goal, and of an acceleration the axes whose moves may take longer."""

    goal: Literal["period", "acceleration"]
    of: Annotated[list[Text], msgspec.Meta(max_length=8)] = []


class ElasticFollowerEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """An elastic follower whose mass is to execute the cycle."""

    period: str
    damping: float = 0.0


class ExportEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """An export of an axis: its format, its file, and the format's options."""

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
    """A single axis of the machine."""

    name: Text
    segment: Annotated[list[Annotated[dict[str, Any], CycleSegment]], msgspec.Meta(min_length=1, max_length=100)]
    minimise: str = "acceleration"
    limits: dict[str, str | list[str] | bool] = {}
    start: str | None = None
    advance: str | None = None
    mechanism: dict[str, Any] | None = None
    drive: dict[str, Any] | None = None
    load: LoadEntries | None = None
    follower: ElasticFollowerEntries | None = None
    export: Annotated[list[ExportEntries], msgspec.Meta(max_length=20)] = []
    run_in: Annotated[list[TransitionEntries], msgspec.Meta(max_length=8)] = []
    run_out: Annotated[list[TransitionEntries], msgspec.Meta(max_length=8)] = []
    order: int = 3
    degree: int = 9


class CycleProblemFile(JobFile, kw_only=True, forbid_unknown_fields=True):
    """The problem file of a cycle with its axes."""

    axis: Annotated[list[AxisEntries], msgspec.Meta(min_length=1, max_length=8)]
    interlocks: Annotated[list[Annotated[dict[str, Any], Interlock]], msgspec.Meta(max_length=50)] = msgspec.field(
        default_factory=list
    )
    overlap: OverlapEntries | None = None
    speed: str | None = None
    period: str | None = None
    rows: Annotated[int, msgspec.Meta(ge=2, le=100_000)] = 361
    sweep: Annotated[list[SweepEntries], msgspec.Meta(max_length=4)] = msgspec.field(default_factory=list)
    fastest: bool = False


def given(entries: msgspec.Struct) -> dict[str, Any]:
    """Entries that the file gives."""
    return {name: value for name, value in msgspec.structs.asdict(entries).items() if value is not None}


def read(data: Mapping[str, Any], file: Path) -> tuple[CycleProblemFile, Axes]:
    """The entries of a file, and its axes, as cycles by their names; overlapped where the file requests it.

    Raises
    ------
    InputError, InfeasibleProblem
        As `read_given`, or if the axes cannot overlap; the error names the file.
    """
    spec, axes = read_given(data, file)
    overlap = overlap_of(spec, axes, file)
    return spec, axes if overlap is None else overlap.axes


def overlap_of(spec: CycleProblemFile, axes: Axes, file: Path) -> Overlap | None:
    """The overlap of the axes of a file; None where the file has no such entry."""
    if spec.overlap is None:
        return None
    with located(str(file)):
        return axes.fastest() if spec.overlap.goal == "period" else axes.gentlest(*spec.overlap.of)


def read_given(data: Mapping[str, Any], file: Path) -> tuple[CycleProblemFile, Axes]:
    """The entries of a file, and its axes before any overlap.

    Raises
    ------
    InputError
        If an entry is unknown or wrong; the error names the file, the axis and the segment, or the interlock.
    """
    from optlaws.cycles.machine_axes import Axes

    spec = convert(data, CycleProblemFile, file)
    cycles: dict[str, Cycle] = {}
    for axis in spec.axis:
        if axis.name in cycles:
            raise InputError(f"{file}: two axes are called {axis.name}: give each a name of its own")
        with located(f"{file}: axis {axis.name}"):
            cycles[axis.name] = cycle_of(axis, spec.speed, spec.period, file.parent)
    if spec.fastest and spec.overlap is not None:
        raise InputError(f"{file}: fastest and overlap are two ways to a period: give one of them")
    if len(cycles) > 1 and spec.interlocks and "interlocks" in cycles:
        raise InputError(f"{file}: an axis is called interlocks, as what is known of them is: give it another name")
    with located(str(file)):
        return spec, Axes(cycles, interlocks=spec.interlocks)


def sweeps_of(spec: CycleProblemFile, file: Path) -> list[list[SweptCycle]]:
    """The cycles of every sweep of a file.

    Raises
    ------
    InputError
        If a sweep names an axis or an entry that is not there, or a value is wrong; the error names the file.
    """
    axes = {axis.name: msgspec.to_builtins(axis) for axis in spec.axis}

    def changed(data: dict[str, Any]) -> Cycle:
        return cycle_of(convert(data, AxisEntries, Path(data["name"])), spec.speed, spec.period, file.parent)

    rows = []
    with located(str(file)):
        for sweep in spec.sweep:
            if sweep.axis not in axes:
                raise InputError(f"sweep of {sweep.entry}: {unknown_key(sweep.axis, axes, 'axis')}")
            rows.append(swept(sweep, axes[sweep.axis], changed))
    return rows


def cycle_of(axis: AxisEntries, speed: str | None, period: str | None, folder: Path = Path()) -> Cycle:
    """The cycle of an axis, or of its cam where there is a follower; `folder` contains catalogues of motors."""
    entries: dict[str, Any] = {name: getattr(axis, name) for name in ENTRIES if name not in CLOCK}
    entries["load"] = None if axis.load is None else given(axis.load)
    entries["drive"] = drive_of(axis.mechanism, axis.drive, folder)
    cycle = Cycle(SEGMENTS.read(axis.segment, "segments"), speed=speed, period=period, **entries)
    return cycle if axis.follower is None else cycle.cam(axis.follower.period, axis.follower.damping)


def follower_cycle(motion: AxisEntries, speed: str | None, period: str | None) -> Cycle:
    """The motion of a cam's follower.

    Raises
    ------
    InputError
        If it has a mechanism: forces of a cam are of constants.
    """
    if motion.mechanism is not None:
        raise InputError(
            "motion: a cam's follower has no mechanism: an axis of a cycle has one, and the kind 'cam' of it is "
            "what this cam's shaft feels"
        )
    return cycle_of(motion, speed, period)
