"""Problems as problem files describe them: entries of a table, some replaced by others."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil, isfinite, log10
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec

from optlaws.entries.value_types import ReadBy
from optlaws.errors import located
from optlaws.files.problem_file import Text, convert
from optlaws.synthesis import Problem, Range, Solution, Status
from optlaws.synthesis.problem.fields import ENTRIES, Kind
from optlaws.synthesis.problem.windows import Window

Count = Annotated[int, msgspec.Meta(ge=1, le=100)]
Positive = Annotated[float, msgspec.Meta(gt=0.0, le=1e100)]
Number = Annotated[float, msgspec.Meta(ge=-1e100, le=1e100)]
Bound = Annotated[float, msgspec.Meta(ge=0.0)]
Asking = Positive | Annotated[list[Bound], msgspec.Meta(min_length=2, max_length=2)] | Literal["free"]

Some = msgspec.Meta(min_length=1)

#: what files hold for each kind of entry
TYPES: dict[Kind, Any] = {
    Kind.CONSTANT: Asking,
    Kind.CONSTANTS: dict[str, Asking],
    Kind.WHOLE: Count,
    Kind.NUMBER: Number,
    Kind.NUMBERS: list[Number],
    Kind.TEXT: Text,
    Kind.SWITCH: bool,
    Kind.BASIS: Text,
    Kind.BREAKS: Count | Annotated[list[Bound], msgspec.Meta(min_length=2)],
    Kind.WINDOWS: list[dict[str, Any] | str],
}


class OptionalEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Entries of a problem that a file may hold; what is left out is None."""

    def given(self) -> dict[str, Any]:
        """The given entries of a problem, in the order of the table."""
        return {name: getattr(self, name) for name in ENTRIES if getattr(self, name) is not None}


def _struct(name: str, doc: str, types: Mapping[str, Any]) -> Any:
    members = [(entry, types[entry] | None, None) for entry in ENTRIES]
    return msgspec.defstruct(name, members, bases=(OptionalEntries,), namespace={"__doc__": doc}, module=__name__)


if TYPE_CHECKING:

    class ProblemEntries(OptionalEntries):
        """The entries of one problem."""

    class EntryLists(OptionalEntries):
        """Lists of values, one for each entry that varies."""

else:
    ProblemEntries = _struct(
        "ProblemEntries",
        'Entries of a problem; those left out are as in the base problem or `Problem`. "free" takes a constant away.',
        {name: TYPES[entry.kind] for name, entry in ENTRIES.items()},
    )
    EntryLists = _struct(
        "EntryLists",
        "Values that entries take in turn; lists in one table go together and are of one length.",
        {name: Annotated[list[TYPES[entry.kind]], Some] for name, entry in ENTRIES.items()},
    )


class ProblemTable(ReadBy):
    """The table of a problem, of which the given entries are kept."""

    entries = ProblemEntries


#: the space of laws in files that look for laws in it
PROBLEM = ProblemTable(
    lambda data: convert(data, ProblemEntries, Path("its entries")).given(), "a table of the entries of a `Problem`"
)


def problem(where: str, *parts: Mapping[str, Any]) -> Problem:
    """The problem of entries in which later ones replace earlier ones; errors call it `where`.

    Examples
    --------
    >>> problem("row 1", {"order": 4, "B": 1.641}, {"B": "free", "minimise": "D"})
    Problem(B=None, order=4, basis=Chebyshev(degree=9), minimise='D')
    """
    entries = {name: value for part in parts for name, value in part.items()}
    entries = {name: value for name, value in entries.items() if value != "free"}
    if "bounds" in entries:
        entries["bounds"] = {name: value for name, value in entries["bounds"].items() if value != "free"}
    with located(where):
        return Problem.from_dict(entries)


def shown(name: str, value: Any) -> str | float | int:
    """The value of an entry as a table's cell.

    Examples
    --------
    >>> shown("B", [0, 60]), shown("C", [1.5, 1.8]), shown("B", 1.641), shown("start", [0, 0.5])
    ('at most 60', '1.5 to 1.8', 1.641, '0, 0.5')
    """
    if isinstance(value, dict):
        return "; ".join(f"{key} {shown('B', item)}" for key, item in value.items())
    if isinstance(value, list) and ENTRIES[name].kind not in {Kind.CONSTANT, Kind.CONSTANTS}:
        return ("; " if ENTRIES[name].kind is Kind.WINDOWS else ", ").join(_brief(item) for item in value)
    if isinstance(value, Range):
        value = [value.low, value.high]
    if isinstance(value, list):
        low, high = value
        if not isfinite(high):
            return f"at least {low:g}"
        return f"{low:g} to {high:g}" if low > 0.0 else f"at most {high:g}"
    return value if isinstance(value, int | float) and not isinstance(value, bool) else str(value)


def _brief(part: Any) -> str:
    if isinstance(part, Mapping):
        return repr(Window.from_dict(part))
    return part if isinstance(part, str) else f"{part:g}"


def gap(solution: Solution) -> str:
    """The gap; where it is closed the power of ten above it, for what lies below differs between machines."""
    if solution.status is Status.OPTIMAL:
        return f"1e{ceil(log10(max(solution.gap, 1e-10)))}"
    return f"{solution.gap:.3g}"


def record(solution: Solution) -> dict[str, Any]:
    """Data of a solution for the results: nothing that differs between runs."""
    names = ["status", "objective", "lower_bound", "limit", "constants", "z", "law", "problem", "certificate"]
    proofs = {
        "power_certificate": solution.power_certificate,
        "peak_certificate": solution.peak_certificate,
        "drive_limit": solution.drive_limit,
    }
    names += [name for name, proof in proofs.items() if proof is not None]
    entries = solution.to_dict()
    return {name: entries[name] for name in names}
