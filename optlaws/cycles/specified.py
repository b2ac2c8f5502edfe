"""What a cycle asks: its entries in machine units, and what follows from them without a search."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, replace
from typing import TYPE_CHECKING, Any, ClassVar, Self

from optlaws.cycles.optimisation.durations import durations
from optlaws.cycles.optimisation.objectives import OBJECTIVES, CycleObjective, check_objective, limits_of_cycle
from optlaws.cycles.optimisation.shared_limits import check_limits_at_joints
from optlaws.cycles.specification.limits import LIMITS_OF_CYCLE, both_sides
from optlaws.cycles.specification.load import ElasticLoad, Load, is_process, read_load
from optlaws.cycles.specification.programme import REST, Layout, Programme, is_optimal, layout, period_of, programme
from optlaws.cycles.specification.segments import SEGMENTS, CycleSegment, Dwell
from optlaws.echo import shortened
from optlaws.entries.declared import Declared, FrozenTable, ValueOf, declared, entries_of, entry, frozen, thawed
from optlaws.entries.value_types import KnownQuantity, Measured, ReadBy, Text, Whole
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.motion.quantities import Derived
from optlaws.numbers import MOST_DEGREE, Quantity

if TYPE_CHECKING:
    from optlaws.mechanisms.drives.drive_train import Drive
    from optlaws.mechanisms.linkages.mechanism import Mechanism

FORMAT = "optlaws cycle 1"
CLOCK = ("speed", "period")
USUAL_DEGREE = 9
_JERK = 3
_SHOWN = 6  # segments in a line


class Objective(Text):
    """What is least of a cycle: one of `OBJECTIVES`, or an output of its load."""

    def form(self) -> dict[str, Any]:
        return {"choices": list(OBJECTIVES)}


def _read_drive(value: Any) -> Any:
    if not isinstance(value, Mapping) or not {"mechanism", "axis"} & value.keys():
        return frozen(value)
    from optlaws.mechanisms.drives.drive_train import Drive
    from optlaws.mechanisms.linkages.mechanism import Mechanism

    return (Drive if "mechanism" in value else Mechanism).from_dict(value)


class DriveTable(ReadBy):
    """Constants of a drive, which stay a table, or a `Mechanism` or `Drive`."""

    def schema(self) -> dict[str, Any]:
        from optlaws.cycles.specification.drive import CONSTANTS
        from optlaws.mechanisms.drives.drive_train import Drive

        mechanism = {"type": "object", "required": ["axis", "inertia"]}
        return {"anyOf": [*(table.schema() for table in CONSTANTS.values()), mechanism, Drive.json_schema()]}


class LoadTable(ValueOf):
    """An elastic load or a process force, which stays a table, or a `Machine`."""

    def read(self, value: Any, name: str) -> Any:
        if not isinstance(value, Mapping) or "A" in value:
            from optlaws.mechanisms.machine.machine import Machine

            if isinstance(value, Machine | Mapping):
                return value if isinstance(value, Machine) else Machine.from_dict(value)
        if not is_process(value):
            super().read(value, name)
        return frozen(value)

    def plain(self, value: Any) -> Any:
        return _plain(value)


def _plain(value: Any) -> Any:
    """A drive or a load as plain data."""
    return thawed(value) if isinstance(value, Mapping) else value.to_dict()


@declared
class Specification(Declared, title="a stored cycle"):
    """The entries of a cycle, and what follows from them without a search of laws."""

    instead: ClassVar[Mapping[str, str]] = {"rpm": 'speed="{} rpm"'}

    segments: Sequence[CycleSegment] = entry(
        SEGMENTS, "What happens, in order: `Rise`, `Return`, `Move`, `Dwell`, `ConstantVelocity`, `Free`."
    )
    _: KW_ONLY
    speed: KnownQuantity = entry(
        Measured("angular velocity", above=0.0),
        "Speed of the master; give it or the period.",
        default=None,
        example="200 rpm",
    )
    period: KnownQuantity = entry(
        Measured("time", above=0.0), "The duration of the cycle; it or the speed.", default=None, example="0.3 s"
    )
    minimise: str = entry(
        Objective(),
        '"acceleration", "velocity", "jerk", "rms acceleration", "rms jerk", "rms snap" of optimal segments, or of the '
        'drive "force", "rms force" (of a table "torque", "rms torque"), "power", "energy" and, of a `Drive` whose '
        'motor has a motor constant, "heat": what its winding and its brake resistor burn.',
        default="acceleration",
        label="least",
    )
    limits: Mapping[str, Any] = entry(
        LIMITS_OF_CYCLE,
        'Of all segments, with optimal and with given laws: `{"velocity": "616 mm/s", "power": "400 W"}`, of '
        'derivatives up to the "snap". Of two quantities, as ("-8 m/s^2", "12 m/s^2"), the first is the least value; a '
        '"deceleration" is of moves that slow down. "rms force", "rms torque" and "energy" are of the whole cycle, as '
        'motors are rated; `{"motor": True}` are all those of the motor of a `Drive`.',
        default=FrozenTable(),
        example={"velocity": "616 mm/s"},
    )
    start: Quantity | None = entry(
        Measured("length", "angle", bare=True), "Position at the start, 0 unless given.", default=None, example="0 mm"
    )
    advance: Quantity | None = entry(
        Measured("length", "angle", bare=True),
        "The advance of each cycle over the previous one, 0 unless given.",
        default=None,
        example="45 deg",
    )
    drive: Mapping[str, Any] | Mechanism | Drive | None = entry(
        DriveTable(_read_drive, "a table of constants, a `Mechanism` or a `Drive`", _plain),
        'What the motion drives: `{"mass": "2 kg", "stiffness": "3 N/mm", "viscous": ..., "dry": ..., "gravity": '
        "...}`, with inertia in place of mass for tables; a `Mechanism` whose input moves as the cycle does, or the "
        "`Drive` of its motor. Objectives and limits are then of the torque at the input, or at the motor.",
        default=None,
        example={"mass": "2 kg"},
    )
    load: Any = entry(
        LoadTable(ElasticLoad),
        'What the motion drives elastically, over the whole cycle: `{"period": "20 ms", "damping": 0.05, "mass": "2 '
        "kg\"}` for a follower's mass on its spring, or its frequency in place of the period, the damping as its ratio "
        "to the critical one, between mass and "
        'ground; or a `Machine` in seconds and SI units. Its outputs may be minimised and bounded: "load '
        'acceleration", "rms load deflection", "load force"; the cycle is then one problem. Or a process force on the '
        'mechanism of the drive, `{"force": {"0 deg": "0 N", "360 deg": "-400 N"}, "over": "master", "on": '
        '"slider"}`: a table or formula over the "time", the "master" or the position of the "driven" link or of the '
        '"input", above 0 where it pushes to greater positions.',
        default=None,
        example={"period": "20 ms", "damping": 0.05},
    )
    order: int = entry(Whole(2, 10), "Number of end conditions of optimal laws.", default=3)
    degree: int = entry(
        Whole(0, MOST_DEGREE),
        "Degree of the polynomial Z of optimal laws, at least 15 where a velocity is given at an end; `search_space` "
        "names the set of laws of this order and degree.",
        default=USUAL_DEGREE,
    )

    def _check(self) -> None:
        self._complete_clock()
        check_objective(self.minimise, self._load)
        for stretch, limits in zip(self.programme.stretches, self.limits_of_segments, strict=True):
            if self.order < _JERK and _JERK in limits and is_optimal(stretch.given):
                raise InputError(
                    f"{stretch.where}: its jerk is limited, but laws of order {self.order} may jump in acceleration "
                    "where they begin or end: take order 3, or leave the limit of the jerk out"
                )
        if all(stretch.fixed for stretch in self.programme.stretches):
            # velocities that do not meet, and forces at joints beyond their limits, are refused at once
            check_limits_at_joints(self.layout, self.in_si, self.duration)

    def _complete_clock(self) -> None:
        """Of the speed and the period the one that is not given, from the other."""
        speed, period = (None if isinstance(each, Derived) else each for each in (self.speed, self.period))
        seconds = period_of(speed, period)
        if speed is None:
            object.__setattr__(self, "speed", Derived(60.0 / seconds, "rpm"))
        else:
            object.__setattr__(self, "period", Derived(seconds, "s"))

    @kept_property
    def programme(self) -> Programme:
        """The cycle as numbers in SI units."""
        return programme(self.segments, period_of(None, self.period), self.start, self.advance)

    @property
    def axis(self) -> str:
        """Whether positions are a "length" or an "angle"."""
        return self.programme.axis

    @property
    def duration(self) -> float:
        """Duration of the cycle in seconds."""
        return self.programme.period

    @kept_property
    def durations(self) -> tuple[float, ...]:
        """Durations of the segments in seconds; optimal ones where they are free."""
        return durations(self.programme, self.in_si)

    @kept_property
    def layout(self) -> Layout:
        """The given laws in their places, and the spans between known joints whose laws are looked for."""
        absolute = self._load is not None and self._load.absolute
        return layout(self.programme, self.durations, whole=self.in_si.of_load, absolute=absolute)

    @kept_property
    def in_si(self) -> CycleObjective:
        """The objective with the limits of the whole, the drive and the load in SI units, and the space of the laws."""
        drive, load = self._drive, self._load
        limits = limits_of_cycle(self.limits, self.programme, drive, load)
        return CycleObjective(self.minimise, limits, self.order, self.degree, drive, self.axis, load)

    @property
    def _drive(self) -> Drive | None:
        if self.drive is None:
            if is_process(self.load):
                raise InputError("load: a process force is of a drive: give one, such as drive={'mass': '2 kg'}")
            return None
        from optlaws.cycles.specification.drive import read_drive, read_process

        drive = read_drive(self.drive, self.axis)
        if not is_process(self.load):
            return drive
        return replace(drive, mechanism=read_process(self.load, drive.mechanism, self.duration))

    @kept_property
    def _load(self) -> Load | None:
        return read_load(self.load, self.axis)

    @property
    def limits_of_segments(self) -> tuple[dict[int, tuple[float, float]], ...]:
        """The least and greatest allowed values of derivatives in each segment, by the derivative's order; SI units.

        Of the force or torque by -1 and of the power by -3; nothing of a dwell.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> rise = Rise("35 mm", "120 deg", limits={"acceleration": ("-9 m/s^2", "12 m/s^2")})
        >>> Cycle([rise, Return()], speed="100 rpm", limits={"velocity": "1 m/s"}).limits_of_segments
        ({1: (-1.0, 1.0), 2: (-9.0, 12.0)}, {1: (-1.0, 1.0)})
        """
        limits = (stretch.sides(self.in_si.limits) for stretch in self.programme.stretches)
        return tuple(
            {} if isinstance(stretch.given, Dwell) else {kind.value: ends for kind, ends in both_sides(limited).items()}
            for limited, stretch in zip(limits, self.programme.stretches, strict=True)
        )

    @property
    def specification(self) -> Self:
        """The cycle itself, as of a plan the cycle that it solves."""
        return self

    @kept_property
    def modified_sine_jerk(self) -> float | None:
        """The greatest peak jerk that modified sine has in the same optimal motions, in SI units.

        A law of least acceleration has some four to five times as much. None unless the acceleration is minimised, no
        limit bounds the jerk or the snap, and every optimal motion goes from rest to rest.

        Examples
        --------
        >>> from optlaws import Cycle, Dwell, Return, Rise
        >>> cycle = Cycle([Rise("35 mm", "120 deg"), Dwell("90 deg"), Return(), Dwell("50 deg")], speed="200 rpm")
        >>> round(cycle.modified_sine_jerk, 3), round(cycle.peak(3) / cycle.modified_sine_jerk, 6)
        (4201.325, 4.145892)
        """
        from optlaws.laws.catalogue.catalogue import catalogue

        if self.minimise != "acceleration":
            return None
        greatest = 0.0
        for span in self.layout.spans:
            bounded = any(side.kind.order >= _JERK for side in span.stretches[0].sides(self.in_si.limits))
            if bounded or span.via or len(span.stretches) > 1 or (span.first, span.last) != (REST, REST):
                return None
            jerk = catalogue["modified sine"].law.constants.J.value * abs(span.displacement) / span.duration**_JERK
            greatest = max(greatest, jerk)
        return greatest or None

    def to_dict(self) -> dict[str, Any]:
        """The entries of the cycle, plain and JSON-able; its laws are optimised again after reading.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm").to_dict()["segments"][0]
        {'kind': 'rise', 'by': '35 mm', 'duration': '120 deg'}
        """
        entries = {each.name: (each, getattr(self, each.name)) for each in entries_of(type(self)).values()}
        plain = {
            name: each.type.plain(value)
            for name, (each, value) in entries.items()
            if value not in (None, {}) and not isinstance(value, Derived)
        }
        segments = plain.pop("segments")
        return {"format": FORMAT, **plain, "segments": segments}

    @classmethod
    def _from_earlier(cls, data: dict[str, Any]) -> dict[str, Any]:
        if data.get("format", FORMAT) != FORMAT:
            raise InputError(f"a stored cycle has format {FORMAT!r}, got {shortened(data['format'])}")
        return {name: value for name, value in data.items() if name != "format"}

    def to_toml(self, title: str = "Cycle", *, axis: str = "axis") -> str:
        """A problem file for `optlaws cycle`, with this cycle as its only axis; a law that is a value as its JSON text.

        Raises
        ------
        InputError
            If the load is a `Machine`: a problem file takes a mass on a spring only.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> print(Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm").to_toml("Press", axis="slide"))
        job = "cycle"
        title = "Press"
        speed = "200 rpm"
        ...
        """
        data = self.to_dict()
        return problem_file(title, {name: data[name] for name in CLOCK if name in data}, {axis: self})

    def __repr__(self) -> str:
        count = len(self.segments)
        names = ", ".join(segment.label for segment in self.segments[:_SHOWN])
        more = f", and {count - _SHOWN} more" if count > _SHOWN else ""
        return f"Cycle([{names}{more}], period={self.duration:.6g} s, minimise={self.minimise!r})"


def problem_file(
    title: str, clock: Mapping[str, Any], cycles: Mapping[str, Specification], more: Mapping[str, Any] | None = None
) -> str:
    """A problem file of the job "cycle" with a clock, its speed or period, an axis for each cycle, and more entries."""
    from optlaws.files.tables import to_toml

    axes = [_axis_entries(name, cycle) for name, cycle in cycles.items()]
    others = {name: value for name, value in (more or {}).items() if value}
    return to_toml({"job": "cycle", "title": title, **clock, "axis": axes, **others})


def _axis_entries(axis: str, cycle: Specification) -> dict[str, Any]:
    data = {name: value for name, value in cycle.specification.to_dict().items() if name not in {"format", *CLOCK}}
    segments = data.pop("segments")
    for segment in segments:
        if isinstance(segment.get("law"), dict):
            segment["law"] = MotionLaw.from_dict(segment["law"]).to_json()
    if "A" in data.get("load", {}):
        raise InputError("load: a problem file takes a mass on a spring only: Cycle.to_json stores a machine")
    return {"name": axis, **data, **_drive_tables(cycle.drive), "segment": segments}


def _drive_tables(drive: Any) -> dict[str, Any]:
    """A mechanism, and the motor before it, as the tables of an axis; nothing of a drive of constants."""
    if drive is None or isinstance(drive, Mapping):
        return {}
    entries = {name: value for name, value in drive.to_dict().items() if name not in {"format", "mechanism"}}
    if hasattr(drive, "mechanism"):
        return {**_drive_tables(drive.mechanism), "drive": entries}
    return {"drive": None, "mechanism": {"kind": "table", **entries}}
