"""Study files: a problem, and which of its entries vary and how."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import KW_ONLY
from itertools import chain
from pathlib import Path
from typing import Any

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, FrozenTable, ValueOf, declared, entry, same
from optlaws.entries.value_types import Choice, Either, Listed, Number, ReadBy, Table, Text, Whole, is_list
from optlaws.errors import InputError, located
from optlaws.files import reading
from optlaws.files.reading import check_names
from optlaws.laws.catalogue.reading import with_files
from optlaws.numbers import finite
from optlaws.synthesis.problem.fields import CONSTANTS, FREE
from optlaws.synthesis.problem.problem import ENTRIES, PROBLEM
from optlaws.synthesis.solve import Bound

#: what varies of the bounds of a constant: what `Problem` takes, the greatest value or the least
BOUNDS, AT_MOST, _ = PREFIXES = ("bounds.", "at_most.", "at_least.")
_PLACE = re.compile(r"\{(?:1-)?(\w+)\}")
_COUNT = Whole(1, 10_000_000)


def _values(given: Any) -> tuple[Any, ...]:
    if not isinstance(given, list | tuple) or not given:
        raise InputError(f"it must be a list of one value at least, got {shortened(given)}")
    return tuple(given)


_VALUES = ReadBy(_values, "a list of values", list, {"type": "array", "minItems": 1})


# the order of the entries of these classes is part of the hash of a study


@declared
class SampleSpan(Declared, title="a span"):
    """A range that a sample fills."""

    writes_defaults = True

    _: KW_ONLY
    low: float = entry(Number(), "The least value, or the greatest.", name="from", example=1.5)
    high: float = entry(Number(), "The value at the other end.", name="to", example=2.5)
    scale: str = entry(Choice("linear", "log"), "Whether differences or ratios are equal.", default="linear")


@declared
class SteppedRange(Declared, title="a range"):
    """A range: `steps` values from end to end, at equal differences or, on a log scale, at equal ratios."""

    writes_defaults = True

    _: KW_ONLY
    low: float = same(SampleSpan, "from")
    high: float = same(SampleSpan, "to")
    steps: int = entry(_COUNT, "How many values there are.", example=11)
    scale: str = same(SampleSpan, "scale")


@declared
class Sample(Declared, title="a sample"):
    """Points spread over the product of spans: Sobol's sequence (scrambled) or a Latin hypercube."""

    writes_defaults = True

    _: KW_ONLY
    kind: str = entry(Choice("sobol", "latin hypercube"), "How they are spread.", example="sobol")
    points: int = entry(_COUNT, "How many there are; of Sobol's sequence a power of 2.", example=64)
    seed: int = entry(Whole(), "Of its random numbers.", example=1)
    over: Mapping[str, SampleSpan] = entry(Table(ValueOf(SampleSpan)), "The span of each entry that varies.")


@declared
class StudyFile(Declared, title="a study"):
    """A study: the problem at every point of the product of all that varies."""

    writes_defaults = True

    _: KW_ONLY
    job: str | None = entry(Choice("script", "atlas"), "Of a file that comes with optlaws.", default=None, shown=False)
    title: str = entry(Text(), "What results call it.", default="study")
    problem: Mapping[str, Any] = entry(PROBLEM, "What all points share; its text may hold places such as {w} or {1-w}.")
    vary: Mapping[str, tuple[Any, ...] | SteppedRange] = entry(
        Table(Either(ValueOf(SteppedRange), _VALUES, which=is_list)),
        "A list or a range of values for each entry.",
        default=FrozenTable(),
        example={"B": {"from": 1.5, "to": 2.5, "steps": 11}},
    )
    together: tuple[Mapping[str, tuple[Any, ...]], ...] = entry(
        Listed(Table(_VALUES)), "Tables of lists that are run through together.", default=()
    )
    sample: tuple[Sample, ...] = entry(Listed(ValueOf(Sample)), "Samples of the product.", default=())
    bound: Bound = entry(Choice("quick", "tight"), "That of `synthesize`.", default="quick")
    time_limit: float = entry(Number(above=0.0, most=1e7), "Of a point, in seconds.", default=60.0)
    chunk: int | None = entry(
        Whole(1, 10_000), "The points that a worker solves in turn; by their number unless given.", default=None
    )
    imports: tuple[str, ...] = entry(
        Listed(Text(), each="module"), "Modules that register constants or bases.", default=()
    )

    def to_dict(self) -> dict[str, Any]:
        """All entries, and all of the problem: None where one is not given."""
        return super().to_dict() | {"problem": {name: self.problem.get(name) for name in ENTRIES}}

    def names(self) -> list[str]:
        """The entries that vary, in the order of the file."""
        return list(chain(self.vary, *self.together, *(sample.over for sample in self.sample)))

    def lists(self) -> list[tuple[str, tuple[Any, ...]]]:
        """The lists of values, each with its entry."""
        columns = chain(self.vary.items(), *(table.items() for table in self.together))
        return [(name, values) for name, values in columns if isinstance(values, tuple)]

    def places(self) -> set[str]:
        """The names in braces within text of the problem and of what varies."""
        texts = chain(
            [self.problem.get("minimise")],
            self.problem.get("bounds", {}),
            self.names(),
            *(values for _, values in self.lists()),
        )
        return {name for text in texts if isinstance(text, str) for name in _PLACE.findall(text)}


def read_study(source: Path | str | Mapping[str, Any]) -> StudyFile:
    """A study from its file, or from the same as a dict.

    Examples
    --------
    >>> read_study({"problem": {"order": 4}, "vary": {"B": {"from": 1.5, "to": 2.5, "steps": 11}}}).names()
    ['B']
    """
    if isinstance(source, Mapping):
        name, data = "the study", reading.checked(source, "the study")
    else:
        name, data = str(source), with_files(reading.toml(Path(source)), Path(source).parent)
    with located(name):
        study = StudyFile.from_dict(data)
        _check_names(study)
        _check_places(study)
    return study


def _check_names(study: StudyFile) -> None:
    """Refuse a study in which nothing varies, or something that is no entry, or something twice."""
    names = study.names()
    if not names:
        raise InputError("nothing varies: add a table [vary], such as B = { from = 1.5, to = 2.5, steps = 11 }")
    known = {*ENTRIES} - {"bounds"} | study.places()
    for name in names:
        if name == "bounds":
            raise InputError('bounds vary one by one: name the constant, as in "bounds.rms_c" or "at_most.rms_c"')
        constant = constant_of(name)
        if constant is None:
            check_names([name], known | {f"{prefix}NAME" for prefix in PREFIXES}, "entry")
        if names.count(name) > 1 or (constant is not None and {constant, f"{BOUNDS}{constant}"} & {*names} - {name}):
            raise InputError(f"{constant or name} varies twice")


def _check_places(study: StudyFile) -> None:
    """Refuse places in text that nothing fills, or that no numbers fill."""
    lists = dict(study.lists())
    for name in study.places():
        if name not in study.names():
            raise InputError(f"nothing fills the place {{{name}}}: vary {name}")
        for value in lists.get(name, ()):
            finite(value, f"{name}, which fills a place in text,")


def constant_of(name: str) -> str | None:
    """The constant of which a bound varies; None where something else does."""
    return next((name.removeprefix(prefix) for prefix in PREFIXES if name.startswith(prefix)), None)


def filled(text: str, values: Mapping[str, Any]) -> str:
    """A text with values in place of the names in braces.

    Examples
    --------
    >>> filled("{w}*C/4 + {1-w}*D/2.25", {"w": 0.25})
    '0.25*C/4 + 0.75*D/2.25'
    """

    def number(match: re.Match[str]) -> str:
        value = finite(values[match[1]], match[1])
        return repr(1.0 - value if match[0].startswith("{1-") else value)

    return _PLACE.sub(number, text)


def entries(base: Mapping[str, Any], inputs: Mapping[str, Any]) -> dict[str, Any]:
    """The entries of a point's problem for `Problem.from_dict`: the base entries and the varied ones.

    Examples
    --------
    >>> entries({"order": 4, "minimise": "C", "B": 1.8}, {"B": "free", "bounds.rms_c": 4.0})
    {'order': 4, 'minimise': 'C', 'bounds': {'rms_c': 4.0}}
    >>> entries({"order": 4, "B": 1.8}, {"at_most.J": 60.0})
    {'order': 4, 'B': 1.8, 'J': [0.0, 60.0]}
    """
    merged: dict[str, Any] = {name: value for name, value in base.items() if name != "bounds"}
    bounds = dict(base.get("bounds", {}))
    for name, value in inputs.items():
        constant = constant_of(name)
        if constant is not None:
            whole = name.startswith(BOUNDS)
            place = merged if constant in CONSTANTS and constant not in bounds and not whole else bounds
            place[constant] = value if whole or value == FREE else _bounded(place.get(constant), name, value)
        elif name in ENTRIES:
            merged[name] = value
    merged = {name: filled(v, inputs) if isinstance(v, str) else v for name, v in merged.items() if v != FREE}
    bounds = {filled(name, inputs): value for name, value in bounds.items() if value != FREE}
    return merged | ({"bounds": bounds} if bounds else {})


def _bounded(bounds: Any, name: str, value: float) -> list[float | None]:
    """Both bounds of a constant, one of them new; a bound replaces a fixed value."""
    low, high = bounds if isinstance(bounds, list) else (0.0, None)
    return [low, value] if name.startswith(AT_MOST) else [value, high]
