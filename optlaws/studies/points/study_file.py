"""Study files: a problem, and which of its entries vary and how."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.files.problem_file import Text, convert
from optlaws.numbers import finite
from optlaws.studies.points.problem_entries import Asked
from optlaws.suggest import unknown_key
from optlaws.synthesis.problem.fields import ENTRIES

Positive = Annotated[float, msgspec.Meta(gt=0.0, le=1e7)]
_PLACE = re.compile(r"\{(?:1-)?(\w+)\}")


class Steps(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A range: `steps` values from end to end, at equal differences or, on a log scale, at equal ratios."""

    low: float = msgspec.field(name="from")
    high: float = msgspec.field(name="to")
    steps: Annotated[int, msgspec.Meta(ge=1, le=10_000_000)]
    scale: Literal["linear", "log"] = "linear"


class Span(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A range that a sample fills."""

    low: float = msgspec.field(name="from")
    high: float = msgspec.field(name="to")
    scale: Literal["linear", "log"] = "linear"


class Sample(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Points spread over the product of spans: Sobol's sequence (scrambled) or a Latin hypercube."""

    kind: Literal["sobol", "latin hypercube"]
    points: Annotated[int, msgspec.Meta(ge=1, le=10_000_000)]
    seed: Annotated[int, msgspec.Meta(ge=0)]
    over: Annotated[dict[str, Span], msgspec.Meta(min_length=1)]


Values = Annotated[list[Any], msgspec.Meta(min_length=1)]


class StudyFile(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A study: what is solved at every point of the product of all that varies.

    Attributes
    ----------
    job
        What `optlaws run` makes of it.
    title
        What the study is about.
    problem
        Entries shared by all points; text may hold places such as {w} or {1-w}, which `vary` fills.
    vary
        By entry: a list of values or a range; the study takes their product.
    together
        Tables of lists of one length that are run through together.
    sample
        Samples, each one further factor of the product.
    bound
        How problems with D are bounded, as in `synthesize`.
    time_limit
        Seconds that a point may take.
    chunk
        Points solved in turn by one worker, each started by the one before it; chosen by their number unless given.
    imports
        Modules that register constants or bases, imported before anything is solved.
    """

    job: Literal["atlas"] | None = None
    title: Text = "study"
    problem: Asked
    vary: dict[str, Values | Steps] = {}
    together: list[dict[str, Values]] = []
    sample: list[Sample] = []
    bound: Literal["quick", "tight"] = "quick"
    time_limit: Positive = 60.0
    chunk: Annotated[int, msgspec.Meta(ge=1, le=10_000)] | None = None
    imports: list[Text] = []

    def names(self) -> list[str]:
        """The entries that vary, in the order of the file."""
        tables: Iterable[Iterable[str]] = (self.vary, *self.together, *(sampling.over for sampling in self.sample))
        return [name for table in tables for name in table]


def read_study(source: Path | str | Mapping[str, Any]) -> StudyFile:
    """A study from its file, or from the same as a dict.

    Raises
    ------
    InputError
        If the file cannot be read, an entry is unknown (the nearest right one is named) or of the wrong type, or an
        entry varies twice.

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
            convert(values, Steps, Path(f"{file}, vary, {name}"))
    study = convert(data, StudyFile, file)
    _check_names(study, str(file))
    names = study.names()
    for name in places(study):
        if name not in names:
            raise InputError(f"{file}: nothing fills the place {{{name}}}: vary {name}")
        _check_fillings(study, name, str(file))
    return study


def _check_names(study: StudyFile, file: str) -> None:
    """Refuse a study in which nothing varies, or something that is no entry, or something twice."""
    names = study.names()
    if not names:
        raise InputError(
            f"{file}: nothing varies: add a table [vary], such as B = {{ from = 1.5, to = 2.5, steps = 11 }}"
        )
    known = {*ENTRIES} - {"bounds"} | places(study)
    for name in names:
        if name == "bounds":
            raise InputError(f'{file}: bounds vary one by one: name the constant, as in "bounds.rms_c"')
        if name not in known and not name.startswith("bounds."):
            raise InputError(f"{file}: {unknown_key(name, {*known, 'bounds.NAME'}, 'entry')}")
        if names.count(name) > 1:
            raise InputError(f"{file}: {name} varies twice")


def _check_fillings(study: StudyFile, name: str, file: str) -> None:
    tables: Iterable[Mapping[str, Any]] = (study.vary, *study.together)
    for values in (table[name] for table in tables if name in table):
        for value in values if isinstance(values, list) else ():
            finite(value, f"{file}: {name}, which fills a place in text,")


def places(study: StudyFile) -> set[str]:
    """Names in braces within text of the problem and of what varies."""
    values = [value for column in study.vary.values() if isinstance(column, list) for value in column]
    values += [value for table in study.together for column in table.values() for value in column]
    base = study.problem.given()
    values += [base.get("minimise"), *base.get("bounds", {}), *study.names()]
    return {name for text in values if isinstance(text, str) for name in _PLACE.findall(text)}


def filled(text: str, values: Mapping[str, Any]) -> str:
    """Text with its places filled.

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
    """The entries of a point's problem, as `Problem.from_dict` reads them: those of the base, and those that vary.

    Examples
    --------
    >>> entries({"order": 4, "minimise": "C", "B": 1.8}, {"B": "free", "bounds.rms_c": 4.0})
    {'order': 4, 'minimise': 'C', 'bounds': {'rms_c': 4.0}}
    """
    merged: dict[str, Any] = {name: value for name, value in base.items() if name != "bounds"}
    bounds = dict(base.get("bounds", {}))
    for name, value in inputs.items():
        if name.startswith("bounds."):
            bounds[name.removeprefix("bounds.")] = value
        elif name in ENTRIES:
            merged[name] = value
    merged = {name: filled(v, inputs) if isinstance(v, str) else v for name, v in merged.items() if v != "free"}
    bounds = {filled(name, inputs): value for name, value in bounds.items() if value != "free"}
    return merged | ({"bounds": bounds} if bounds else {})
