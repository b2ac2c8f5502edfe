"""The problem file of the job "cycle": axes with their segments, every number with its unit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from optlaws.cycles.axes.interlock import INTERLOCKS, Interlock
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.specification.load import ElasticFollower
from optlaws.cycles.specification.programme import period_of
from optlaws.cycles.specification.segments import CycleSegment, Transition
from optlaws.echo import shortened
from optlaws.entries.declared import Declared, ValueOf, declared, entries_of, entry, frozen, same, thawed
from optlaws.entries.value_types import Choice, Either, Listed, Number, ReadBy, Switch, Text, Whole
from optlaws.errors import InputError, located
from optlaws.exports.format import Request
from optlaws.files.reading import check_names
from optlaws.jobs.job_entries import ProblemFile
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.drives.motor import read_motors
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.mechanisms.linkages.mechanism_kinds import MechanismKind
from optlaws.motion.quantities import Exact
from optlaws.numbers import NumberOrQuantity, Quantity

if TYPE_CHECKING:
    from optlaws.cycles.axes.machine_axes import Axes, Overlap


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


@declared
class SweepEntries(Declared, title="a sweep"):
    """An entry of an axis, such as "drive.ratio" or "mechanism.crank", and the values that it takes."""

    axis: str = entry(Text(), "The axis.", example="slide")
    values: tuple[str | float, ...] = entry(
        Listed(Either(Number(), Text(), which=lambda value: int(isinstance(value, str))), least=2, most=50),
        "What the entry is in turn.",
        example=[10, 20, 30],
    )
    entry: str = entry(
        Text(), 'Of the axis, such as "drive.ratio", "mechanism.crank" or "segment.1.duration".', example="drive.ratio"
    )


def _constants(value: Any) -> Any:
    if not isinstance(value, Mapping):
        raise InputError(f"it must be a table, got {shortened(value)}")
    return frozen(value)


_TABLE = ReadBy(_constants, "a table", thawed, {"type": "object"})
_TRANSITIONS = Listed(ValueOf(Transition), most=8, each="cam")


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
    run_in: tuple[Transition, ...] = entry(_TRANSITIONS, "Cams from rest into the cycle.", default=())
    run_out: tuple[Transition, ...] = entry(_TRANSITIONS, "Cams out of it.", default=())
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
    speed: NumberOrQuantity | None = same(Cycle, "speed")
    period: NumberOrQuantity | None = same(Cycle, "period")
    rows: int = entry(Whole(2, 100_000), "Lines of the tables.", default=361)
    sweep: tuple[SweepEntries, ...] = entry(
        Listed(ValueOf(SweepEntries), most=4, each="sweep"),
        "The cycle for each value of an entry, with its objective and what drive and motor need. Beside the best value "
        "others are added, unless it is an end.",
        default=(),
    )
    fastest: bool = entry(
        Switch(),
        "Whether all axes run at the greatest speed that their limits allow, with a file for `optlaws verify`.",
        default=False,
    )

    def _check(self) -> None:
        super()._check()
        _ = self.given_period
        names = [axis.name for axis in self.axis]
        for name in names:
            if names.count(name) > 1:
                raise InputError(f"two axes are called {name}: give each a name of its own")
        if self.fastest and self.overlap is not None:
            raise InputError("fastest and overlap are two ways to a period: give one of them")
        if len(names) > 1 and self.interlocks and "interlocks" in names:
            raise InputError(
                "an axis is called interlocks, which is the name of an entry of the results: give it another name"
            )

    @property
    def period_sought(self) -> bool:
        """Whether the least period is what its overlap is for, so that none needs to be given."""
        return self.overlap is not None and self.overlap.goal == "period"

    @property
    def given_period(self) -> float | None:
        """The given period in seconds; None where it is sought and neither period nor speed is given."""
        sought = self.period_sought and self.speed is None and self.period is None
        return None if sought else period_of(self.speed, self.period)

    def overlap_of(self, axes: Axes, file: Path) -> Overlap | None:
        """The overlap of its axes; None where it has no such entry. An error names the file."""
        if self.overlap is None:
            return None
        with located(str(file)):
            return axes.fastest() if self.period_sought else axes.least_acceleration(*self.overlap.of)


def read(data: Mapping[str, Any], file: Path) -> tuple[CycleProblemFile, Axes]:
    """The entries of a file, and its axes, as cycles by their names; overlapped where the file requests it."""
    spec, axes = read_given(data, file)
    overlap = spec.overlap_of(axes, file)
    return spec, axes if overlap is None else overlap.axes


def read_given(data: Mapping[str, Any], file: Path) -> tuple[CycleProblemFile, Axes]:
    """The entries of a file, and its axes before any overlap; an error names the file, the axis and the segment."""
    from optlaws.cycles.axes.machine_axes import Axes

    spec, cycles = CycleProblemFile.read(data, file), dict[str, Cycle]()
    with located(str(file)):
        if spec.given_period is None and not any(axis.follower for axis in spec.axis):
            tables = dict[str, Any]()
            for axis in spec.axis:
                with located(f"axis {axis.name}"):
                    tables[axis.name] = _table_of(axis)
            given = Axes(tables, interlocks=spec.interlocks)
            begun = tuple(replace(axis, segment=tuple(given[axis.name].segments)) for axis in spec.axis)
            return replace(spec, axis=begun, speed=None, period=Exact(given.duration, "s")), given
        if spec.period_sought:
            from optlaws.cycles.axes.first_diagram import first_diagram

            axes = {axis.name: axis for axis in spec.axis}

            def planned(name: str, segments: Sequence[CycleSegment], period: Quantity) -> Cycle:
                # times are those of the mass where there is a follower
                return cycle_of(replace(axes[name], segment=tuple(segments), follower=None), None, period)

            moves = {name: axis.segment for name, axis in axes.items()}
            timed, seconds = first_diagram(moves, planned, spec.given_period)
            begun = tuple(replace(axis, segment=tuple(timed[name])) for name, axis in axes.items())
            spec = replace(spec, axis=begun, speed=None, period=Exact(seconds, "s"))
        for axis in spec.axis:
            with located(f"axis {axis.name}"):
                cycles[axis.name] = cycle_of(axis, spec.speed, spec.period)
        return spec, Axes(cycles, interlocks=spec.interlocks)


def _table_of(axis: AxisEntries) -> dict[str, Any]:
    """What a cycle takes of an axis, without its clock."""
    shared = (name for name in entries_of(Cycle) if name in entries_of(AxisEntries))
    entries = {name: getattr(axis, name) for name in shared}
    return {**entries, "drive": drive_of(axis.mechanism, axis.drive), "segments": axis.segment}


def cycle_of(axis: AxisEntries, speed: NumberOrQuantity | None, period: NumberOrQuantity | None) -> Cycle:
    """The cycle of an axis, or of its cam where there is a follower."""
    cycle = Cycle(**_table_of(axis), speed=speed, period=period)
    return cycle if axis.follower is None else cycle.cam(axis.follower.period, axis.follower.damping)


def drive_of(
    mechanism: Mapping[str, Any] | None, drive: Mapping[str, Any] | None
) -> Mapping[str, Any] | Mechanism | Drive | None:
    """The drive of a cycle as an argument of `Cycle`: constants of a table, a mechanism, or a motor with one.

    >>> table = {"kind": "table", "inertia": "0.8 kg m^2"}
    >>> motor = {"inertia": "3e-4 kg m^2", "peak_torque": "6 N m"}
    >>> drive_of(table, {"motor": motor, "ratio": 20}).motor.peak_torque
    6.0
    """
    if mechanism is None:
        if drive is not None and {"motor", "motors", "ratio"} & drive.keys():
            raise InputError(
                "drive: a motor drives a mechanism: give the axis its table mechanism too, such as mechanism = "
                "{ kind = 'table', inertia = '0.8 kg m^2' }"
            )
        return drive
    with located("mechanism"):
        from optlaws.cams import at_shaft  # noqa: F401 - by which the kind "cam" is known

        driven = MechanismKind.from_dict(mechanism).mechanism
    if drive is None:
        return driven
    if "motor" not in drive:
        raise InputError(
            "drive: beside a mechanism it has a motor, such as motor = { inertia = '3e-4 kg m^2' }; masses, springs "
            "and friction of the load are the mechanism's"
        )
    given = dict(drive)
    with located("drive"):
        given["motor"] = motor_of(given["motor"], given.pop("motors", None))
        return Drive.from_dict({"mechanism": driven, **given})


def motor_of(motor: Any, catalogue: Any) -> Any:
    """The table of a motor, or the motor of a catalogue that its name says."""
    if not isinstance(motor, str):
        if catalogue is not None:
            raise InputError("motors: the motor is given as a table: leave the catalogue out, or name a motor of it")
        return motor
    if catalogue is None:
        raise InputError(
            f"motor: {motor!r} is one of a catalogue: give its file, such as motors = 'motors.toml', or give the motor "
            "as a table"
        )
    motors = read_motors(Path(Text().read(catalogue, "motors")))
    with located(f"motor: {catalogue}"):
        check_names([motor], motors, "motor")
    return motors[motor]
