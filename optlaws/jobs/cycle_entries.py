"""The problem file of the job "cycle": axes with their segments, every number with its unit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from optlaws.cycles.cycle import Cycle
from optlaws.cycles.interlocks.interlock import Interlock
from optlaws.cycles.interlocks.interlock_kinds import INTERLOCKS
from optlaws.cycles.specification.frozen import frozen, thawed
from optlaws.cycles.specification.load import ElasticFollower
from optlaws.cycles.specification.segments import CycleSegment
from optlaws.echo import shortened
from optlaws.entries.declared import Declared, ValueOf, declared, entries_of, entry, same
from optlaws.entries.value_types import Choice, Listed, ReadBy, Switch, Text, Whole
from optlaws.errors import InputError, located
from optlaws.exports.format import Request
from optlaws.jobs.axes.axis_transitions import TransitionEntries
from optlaws.jobs.axes.drive_entries import drive_of
from optlaws.jobs.axes.entry_sweep import SweepEntries, SweptCycle, swept
from optlaws.jobs.job_entries import ProblemFile
from optlaws.numbers import Quantity
from optlaws.suggest import unknown_key

if TYPE_CHECKING:
    from optlaws.cycles.machine_axes import Axes, Overlap


@declared
class OverlapEntries(Declared, title="an overlap"):
    """How moves are to overlap: the goal, and of an acceleration the axes whose moves may take longer."""

    goal: str = entry(Choice("period", "acceleration"), "What is to be least.", example="acceleration")
    of: tuple[str, ...] = entry(
        Listed(Text(), most=8), "Of an acceleration the axes whose moves may take longer; all unless given.", default=()
    )


@declared
class ExportEntries(Declared, title="an export"):
    """An export of an axis: its format, its file, and the format's options."""

    _: KW_ONLY
    to: str = entry(Text(), "A format of `optlaws export --list`.", example="rockwell-cam")
    file: str | None = entry(Text(), "The name of its file.", default=None)
    master: str = entry(Text(), "How far the master goes in a cycle.", default="360 deg")
    unit: str | None = entry(Text(), "Of positions.", default=None, example="mm")
    points: int | str | None = same(Request, "points")
    counts: int | None = same(Request, "counts")
    digits: int | None = same(Request, "digits")
    decimal: str | None = same(Request, "decimal", default=None)
    interpolation: str | None = same(Request, "interpolation")
    task: str | None = entry(Text(), "Time of the drive's task, whose samples are reported.", default=None)
    name: str | None = same(Request, "name", default=None)


def _constants(value: Any) -> Any:
    if not isinstance(value, Mapping):
        raise InputError(f"it must be a table, got {shortened(value)}")
    return frozen(value)


_TABLE = ReadBy(_constants, "a table", thawed, {"type": "object"})
_TRANSITIONS = Listed(ValueOf(TransitionEntries), most=8, each="cam")


@declared
class AxisEntries(Declared, title="an axis"):
    """A single axis of the machine."""

    writes_defaults = True

    _: KW_ONLY
    name: str = entry(Text(), "What tables, pictures and files call it.", example="slide")
    segment: tuple[CycleSegment, ...] = entry(
        Listed(ValueOf(CycleSegment), least=1, most=100, each="segment"),
        "What happens, in order.",
        example=[{"kind": "rise", "by": "35 mm", "duration": "120 deg"}, {"kind": "return"}],
    )
    minimise: str = same(Cycle, "minimise")
    limits: Mapping[str, Any] = same(Cycle, "limits")
    start: Quantity | None = same(Cycle, "start")
    advance: Quantity | None = same(Cycle, "advance")
    mechanism: Mapping[str, Any] | None = entry(
        _TABLE, "A mechanism whose input moves as the axis does: a kind and its entries.", default=None
    )
    drive: Mapping[str, Any] | None = entry(
        _TABLE,
        "Constants of what the motion drives, as of `Cycle`; beside a mechanism its `motor`, a table or the name of "
        "one in the catalogue `motors`, a TOML file found from the problem file, and `ratio`, `efficiency`, `inertia` "
        "and `regeneration` of the gear, as `Drive` takes them.",
        default=None,
        example={"mass": "2 kg"},
    )
    load: Any = same(Cycle, "load")
    follower: ElasticFollower | None = entry(
        ValueOf(ElasticFollower),
        "An elastic follower whose mass is to move as the segments say: the axis is then its cam.",
        default=None,
        example={"period": "20 ms", "damping": 0.05},
    )
    export: tuple[ExportEntries, ...] = entry(
        Listed(ValueOf(ExportEntries), most=20, each="export"), "Files for controllers.", default=()
    )
    run_in: tuple[TransitionEntries, ...] = entry(_TRANSITIONS, "Cams from rest into the cycle.", default=())
    run_out: tuple[TransitionEntries, ...] = entry(_TRANSITIONS, "Cams out of it.", default=())
    order: int = same(Cycle, "order")
    degree: int = same(Cycle, "degree")


@declared
class CycleProblemFile(ProblemFile, title="a problem file"):
    """The problem file of a cycle with its axes."""

    _: KW_ONLY
    axis: tuple[AxisEntries, ...] = entry(
        Listed(ValueOf(AxisEntries), least=1, most=8, each="axis", named=True), "The axes, each with a name."
    )
    interlocks: tuple[Interlock, ...] = entry(
        replace(INTERLOCKS, most=50), "Conditions between two axes each.", default=()
    )
    overlap: OverlapEntries | None = entry(
        ValueOf(OverlapEntries),
        "Moves are put together anew, within the interlocks.",
        default=None,
        example={"goal": "acceleration", "of": ["die"]},
    )
    speed: Quantity | None = same(Cycle, "speed")
    period: Quantity | None = same(Cycle, "period")
    rows: int = entry(Whole(2, 100_000), "Lines of the tables.", default=361)
    sweep: tuple[SweepEntries, ...] = entry(
        Listed(ValueOf(SweepEntries), most=4, each="sweep"),
        "The cycle for each value of an entry, with its objective and what drive and motor need.",
        default=(),
    )
    fastest: bool = entry(
        Switch(),
        "Whether all axes run at the greatest speed that their limits allow, with a file for `optlaws verify`.",
        default=False,
    )


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

    spec = CycleProblemFile.read(data, file)
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
    axes = {axis.name: axis.to_dict() for axis in spec.axis}

    def changed(data: dict[str, Any]) -> Cycle:
        return cycle_of(AxisEntries.from_dict(data), spec.speed, spec.period, file.parent)

    rows = []
    with located(str(file)):
        for sweep in spec.sweep:
            if sweep.axis not in axes:
                raise InputError(f"sweep of {sweep.entry}: {unknown_key(sweep.axis, axes, 'axis')}")
            rows.append(swept(sweep, axes[sweep.axis], changed))
    return rows


def cycle_of(axis: AxisEntries, speed: Quantity | None, period: Quantity | None, folder: Path = Path()) -> Cycle:
    """The cycle of an axis, or of its cam where there is a follower; `folder` contains catalogues of motors."""
    shared = (name for name in entries_of(Cycle) if name in entries_of(AxisEntries))
    entries = {name: getattr(axis, name) for name in shared} | {"drive": drive_of(axis.mechanism, axis.drive, folder)}
    cycle = Cycle(axis.segment, speed=speed, period=period, **entries)
    return cycle if axis.follower is None else cycle.cam(axis.follower.period, axis.follower.damping)


def follower_cycle(given: AxisEntries | Mapping[str, Any], speed: Quantity | None, period: Quantity | None) -> Cycle:
    """The motion of a cam's follower.

    Raises
    ------
    InputError
        If it has a mechanism: forces of a cam are of constants.
    """
    motion = ValueOf(AxisEntries).read(given, "motion")
    if motion.mechanism is not None:
        raise InputError(
            "motion: a cam's follower has no mechanism: an axis of a cycle has one, and the kind 'cam' of it is "
            "what this cam's shaft feels"
        )
    return cycle_of(motion, speed, period)
