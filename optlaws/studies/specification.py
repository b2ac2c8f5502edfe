"""Study files: a problem, and which of its entries vary and how."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import chain
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.files.problem_file import Text, convert
from optlaws.numbers import finite
from optlaws.studies.problem_entries import ProblemEntries
from optlaws.suggest import unknown_key
from optlaws.synthesis.problem.fields import CONSTANTS, ENTRIES

#: what varies of the bounds of a constant: what `Problem` takes, the greatest value or the least
BOUNDS, AT_MOST, _ = PREFIXES = ("bounds.", "at_most.", "at_least.")
FREE = "free"
_PLACE = re.compile(r"\{(?:1-)?(\w+)\}")

Count = Annotated[int, msgspec.Meta(ge=1, le=10_000_000)]
Values = Annotated[list[Any], msgspec.Meta(min_length=1)]


# the order of the fields of these classes is part of the hash of a study


class SteppedRange(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A range: `steps` values from end to end, at equal differences or, on a log scale, at equal ratios."""

    low: float = msgspec.field(name="from")
    high: float = msgspec.field(name="to")
    steps: Count
    scale: Literal["linear", "log"] = "linear"


class SampleSpan(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A range that a sample fills."""

    low: float = msgspec.field(name="from")
    high: float = msgspec.field(name="to")
    scale: Literal["linear", "log"] = "linear"


class Sample(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Points spread over the product of spans: Sobol's sequence (scrambled) or a Latin hypercube."""

    kind: Literal["sobol", "latin hypercube"]
    points: Count
    seed: Annotated[int, msgspec.Meta(ge=0)]
    over: Annotated[dict[str, SampleSpan], msgspec.Meta(min_length=1)]


class StudyFile(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A study: the problem at every point of the product of all that varies.

    `problem` has the entries shared by all points; its text may hold places such as {w} or {1-w}. `vary` has a list or
    a range for each entry, `together` tables of lists that are run through together, `sample` samples, each one factor
    of the product. `bound` is that of `synthesize`, `time_limit` in seconds a point, `chunk` the points that one worker
    solves in turn (chosen by their number unless given), `imports` the modules that register constants or bases.
    """

    job: Literal["script", "atlas"] | None = None
    title: Text = "study"
    problem: ProblemEntries
    vary: dict[str, Values | SteppedRange] = {}
    together: list[dict[str, Values]] = []
    sample: list[Sample] = []
    bound: Literal["quick", "tight"] = "quick"
    time_limit: Annotated[float, msgspec.Meta(gt=0.0, le=1e7)] = 60.0
    chunk: Annotated[int, msgspec.Meta(ge=1, le=10_000)] | None = None
    imports: list[Text] = []

    def names(self) -> list[str]:
        """The entries that vary, in the order of the file."""
        return list(chain(self.vary, *self.together, *(sample.over for sample in self.sample)))

    def lists(self) -> list[tuple[str, list[Any]]]:
        """The lists of values, each with its entry."""
        columns = chain(self.vary.items(), *(table.items() for table in self.together))
        return [(name, values) for name, values in columns if isinstance(values, list)]

    def places(self) -> set[str]:
        """The names in braces within text of the problem and of what varies."""
        base = self.problem.given()
        texts = chain(
            [base.get("minimise")], base.get("bounds", {}), self.names(), *(list_ for _, list_ in self.lists())
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
        file, data = Path("the study"), dict(reading.checked(source, "the study"))
    else:
        file = Path(source)
        data = reading.toml(file)
    varied = data.get("vary")
    for name, values in varied.items() if isinstance(varied, Mapping) else ():
        if isinstance(values, Mapping):
            # by itself, for an error that names the entry
            convert(values, SteppedRange, Path(f"{file}, vary, {name}"))
    study = convert(data, StudyFile, file)
    _check_names(study, file)
    _check_places(study, file)
    return study


def _check_names(study: StudyFile, file: Path) -> None:
    """Refuse a study in which nothing varies, or something that is no entry, or something twice."""
    names = study.names()
    if not names:
        raise InputError(
            f"{file}: nothing varies: add a table [vary], such as B = {{ from = 1.5, to = 2.5, steps = 11 }}"
        )
    known = {*ENTRIES} - {"bounds"} | study.places()
    for name in names:
        if name == "bounds":
            raise InputError(
                f'{file}: bounds vary one by one: name the constant, as in "bounds.rms_c" or "at_most.rms_c"'
            )
        constant = constant_of(name)
        if name not in known and constant is None:
            raise InputError(f"{file}: {unknown_key(name, known | {f'{prefix}NAME' for prefix in PREFIXES}, 'entry')}")
        if names.count(name) > 1 or (constant is not None and {constant, f"{BOUNDS}{constant}"} & {*names} - {name}):
            raise InputError(f"{file}: {constant or name} varies twice")


def _check_places(study: StudyFile, file: Path) -> None:
    """Refuse places in text that nothing fills, or that no numbers fill."""
    lists = dict(study.lists())
    for name in study.places():
        if name not in study.names():
            raise InputError(f"{file}: nothing fills the place {{{name}}}: vary {name}")
        for value in lists.get(name, ()):
            finite(value, f"{file}: {name}, which fills a place in text,")


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
