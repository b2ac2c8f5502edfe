"""The serialisation of a cycle as it was given: plain data, JSON, and a problem file."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, fields
from typing import Any, Self

from optlaws.cycles.specification.segments import ConstantVelocity, CycleSegment, Dwell, Free, Move, Return, Rise
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.extras import needed
from optlaws.files.reading import JsonText
from optlaws.laws import MotionLaw
from optlaws.mechanisms.machine.machine import Machine
from optlaws.motion.quantities import written
from optlaws.suggest import unknown_key

KINDS: dict[str, type[Any]] = {
    "dwell": Dwell,
    "constant velocity": ConstantVelocity,
    "move": Move,
    "rise": Rise,
    "return": Return,
    "free": Free,
}
FORMAT = "optlaws cycle 1"
_ENTRIES = (
    "segments", "speed", "period", "minimise", "limits", "start", "advance", "drive", "load", "order", "degree",
)  # fmt: skip
_CLOCK = ("speed", "period")
_SHOWN = 6  # segments in a line
_NAMES = ("position", "velocity", "acceleration", "jerk")


class SerialisationMixin(JsonText):
    """The forms of a cycle as text: plain data, JSON, a problem file, a table of its segments, a line."""

    _json_name = "a stored cycle"

    segments: Sequence[CycleSegment]
    minimise: str

    @property
    def duration(self) -> float:
        """Duration of the cycle in seconds."""
        raise NotImplementedError

    def to_dict(self) -> dict[str, Any]:
        """The entries of the cycle, plain and JSON-able; its laws are looked for again when it is read.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm").to_dict()["segments"][0]
        {'kind': 'rise', 'by': '35 mm', 'duration': '120 deg'}
        """
        return _to_data(self)

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """Read what `to_dict` gave.

        Raises
        ------
        InputError
            If an entry is unknown or wrong.
        """
        return cls(**_from_data(data))

    def to_toml(self, title: str = "Cycle", *, axis: str = "axis") -> str:
        """A problem file for `optlaws cycle`, with this cycle as its only axis.

        Raises
        ------
        InputError
            If a law is a value: a problem file names laws, or JSON files that hold them.

        Examples
        --------
        >>> from optlaws import Cycle, Return, Rise
        >>> print(Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm").to_toml("Press", axis="slide"))
        job = "cycle"
        title = "Press"
        speed = "200 rpm"
        ...
        """
        data = _to_data(self)
        clock = {name: data[name] for name in _CLOCK if name in data}
        return problem_file(title, clock, {axis: self})

    def to_pandas(self) -> Any:  # noqa: ANN401 - pandas is imported where it is asked for
        """A data frame with a row for each segment: start, duration, end, peaks, leaps; SI units.

        Needs the extra `optlaws[studies]`.
        """
        return _frame(self)

    def __repr__(self) -> str:
        names = ", ".join(segment.label for segment in self.segments[:_SHOWN])
        more = f", and {len(self.segments) - _SHOWN} more" if len(self.segments) > _SHOWN else ""
        return f"Cycle([{names}{more}], period={self.duration:.6g} s, minimise={self.minimise!r})"


def _to_data(cycle: Any) -> dict[str, Any]:  # noqa: ANN401 - a Cycle
    """The entries of a cycle as plain data; its laws are looked for again when it is read."""
    given = {name: _plain(getattr(cycle, name)) for name in _ENTRIES if name != "segments"}
    entries = {name: value for name, value in given.items() if value not in (None, {}, ())}
    return {"format": FORMAT, **entries, "segments": [_segment(segment) for segment in cycle.segments]}


def _from_data(data: Any) -> dict[str, Any]:  # noqa: ANN401 - it is checked here
    """The arguments of a `Cycle` from plain data."""
    if not isinstance(data, Mapping) or not isinstance(data.get("segments"), list):
        raise InputError("a stored cycle is a table with a list of segments, as Cycle.to_dict gives it")
    if data.get("format", FORMAT) != FORMAT:
        raise InputError(f"a stored cycle has format {FORMAT!r}, got {shortened(data['format'])}")
    given = {name: value for name, value in data.items() if name not in {"format", "segments"}}
    for name in given:
        if name not in _ENTRIES:
            raise InputError(f"cycle: {unknown_key(name, _ENTRIES)}")
    load = given.get("load")
    if isinstance(load, Mapping) and "A" in load:
        given["load"] = Machine.from_dict(load)
    return given | {"segments": [_read_segment(entry, i) for i, entry in enumerate(data["segments"], start=1)]}


def problem_file(title: str, clock: Mapping[str, Any], cycles: Mapping[str, SerialisationMixin]) -> str:
    """A problem file of the job "cycle" with a clock, its speed or period, and an axis for each cycle.

    Raises
    ------
    InputError
        If a law or a load is a value that no problem file can hold.
    """
    lines = [
        'job = "cycle"',
        f"title = {_text(title)}",
        *(f"{name} = {_value(value)}" for name, value in clock.items()),
    ]
    for name, cycle in cycles.items():
        lines += ["", *_axis_lines(name, cycle)]
    return "\n".join(lines) + "\n"


def _axis_lines(axis: str, cycle: SerialisationMixin) -> list[str]:
    data = {name: value for name, value in _to_data(cycle).items() if name not in {"format", *_CLOCK}}
    segments = data.pop("segments")
    for i, segment in enumerate(segments, start=1):
        if not isinstance(segment.get("law", ""), str):
            raise InputError(f"segment {i}: a problem file names its law: save the law as a JSON file and name that")
    if "A" in data.get("load", {}):
        raise InputError("load: a problem file takes a mass on a spring: a machine is kept by Cycle.to_json")
    lines = ["[[axis]]", f"name = {_text(axis)}", *(f"{name} = {_value(value)}" for name, value in data.items())]
    for segment in segments:
        lines += ["", "[[axis.segment]]", *(f"{name} = {_value(value)}" for name, value in segment.items())]
    return lines


def _segment(segment: CycleSegment) -> dict[str, Any]:
    kind = next(name for name, known in KINDS.items() if known is type(segment))
    given = {each.name: _plain(getattr(segment, each.name)) for each in fields(segment)}  # type: ignore[arg-type] # dataclasses
    defaults = {each.name: each.default for each in fields(segment)}  # type: ignore[arg-type]
    entries = {name: value for name, value in given.items() if value not in (None, {}, (), [], defaults[name])}
    return {"kind": kind, **entries}


def _read_segment(data: Any, number: int) -> CycleSegment:  # noqa: ANN401 - it is checked here
    given = dict(data) if isinstance(data, Mapping) else {}
    kind = KINDS.get(str(given.pop("kind", "")))
    if kind is None:
        raise InputError(f"segment {number}: its kind must be one of {', '.join(KINDS)}, got {shortened(data)}")
    for name in given:
        if name not in kind.__dataclass_fields__:
            raise InputError(f"segment {number}: {unknown_key(name, tuple(kind.__dataclass_fields__))}")
    for each in fields(kind):
        if each.default is MISSING and each.default_factory is MISSING and each.name not in given:
            raise InputError(f"segment {number}: {each.name} is missing")
    if isinstance(given.get("law"), Mapping):
        given["law"] = MotionLaw.from_dict(given["law"])
    segment: CycleSegment = kind(**given)
    return segment


def _plain(value: Any) -> Any:  # noqa: ANN401 - whatever a person gave
    if isinstance(value, MotionLaw | Machine):
        return value.to_dict()
    if isinstance(value, Mapping):
        return {str(key): _plain(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(part) for part in value]
    return value if value is None or isinstance(value, bool | int | float) else str(written(value))


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def _value(value: Any) -> str:  # noqa: ANN401 - plain data
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_text(name)} = {_value(part)}" for name, part in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    return json.dumps(value, ensure_ascii=False)


def _frame(cycle: Any) -> Any:  # noqa: ANN401 - pandas is imported where it is asked for
    needed("pandas", "to_pandas")
    import pandas as pd

    unit = "m" if cycle.axis == "length" else "rad"
    units = dict(zip(_NAMES, (unit, f"{unit}/s", f"{unit}/s²", f"{unit}/s³"), strict=True))
    rows = []
    for peaks, joint in zip(cycle.peaks, cycle.joints, strict=True):
        row = {"segment": peaks.name, "start, s": peaks.start, "duration, s": peaks.duration}
        row |= {f"peak {name}, {units[name]}": peaks.peak(nu) for nu, name in enumerate(_NAMES)}
        rows.append(row | {f"leap of {name}, {units[name]}": joint[name] for name in _NAMES[1:3]})
    return pd.DataFrame(rows)
