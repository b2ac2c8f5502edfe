"""Problems as problem files ask for them: entries of a table, some replaced by others."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil, isfinite, log10
from typing import Annotated, Any, Literal

import msgspec

from optlaws.errors import InputError
from optlaws.synthesis import Problem, Range, Solution, Status

Count = Annotated[int, msgspec.Meta(ge=1, le=100)]
Positive = Annotated[float, msgspec.Meta(gt=0.0, le=1e100)]
Bound = Annotated[float, msgspec.Meta(ge=0.0)]
Asking = Positive | Annotated[list[Bound], msgspec.Meta(min_length=2, max_length=2)] | Literal["free"]
Text = Annotated[str, msgspec.Meta(min_length=1)]

HEADINGS = {name: f"{name} asked" for name in ("B", "C", "D", "J")} | {
    "minimise": "minimised",
    "order": "order l",
    "degree": "degree of Z",
}


class Asked(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Entries of a problem; those left out are the base problem's, or as in `Problem`. "free" takes a constant away."""

    minimise: Text | None = None
    B: Asking | None = None
    C: Asking | None = None
    D: Asking | None = None
    J: Asking | None = None
    order: Count | None = None
    bounds: dict[str, Asking] | None = None
    inflexion: Annotated[float, msgspec.Meta(gt=0.0, lt=1.0)] | None = None
    basis: Literal["powers", "chebyshev", "bernstein", "bsplines", "pieces"] | None = None
    degree: Count | None = None
    breaks: Count | Annotated[list[Bound], msgspec.Meta(min_length=2)] | None = None
    continuity: Count | None = None
    monotone: bool | None = None
    symmetric: bool | None = None

    def given(self) -> dict[str, Any]:
        """The entries that are there."""
        return {name: getattr(self, name) for name in Asked.__struct_fields__ if getattr(self, name) is not None}


def problem(where: str, *parts: Mapping[str, Any]) -> Problem:
    """The problem of entries of which later ones replace earlier ones; `where` is what an error calls it.

    Raises
    ------
    InputError
        If the order is missing or a value is out of range.

    Examples
    --------
    >>> problem("row 1", {"order": 4, "B": 1.641}, {"B": "free", "minimise": "D"})
    Problem(B=None, order=4, basis=Chebyshev(degree=9), minimise='D')
    """
    entries: dict[str, Any] = {}
    for part in parts:
        entries |= part
    try:
        kept = {name: value for name, value in entries.items() if value != "free"}
        if "bounds" in kept:
            kept["bounds"] = {name: value for name, value in kept["bounds"].items() if value != "free"}
        return Problem.from_dict(kept)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def shown(value: Any) -> str | float | int:  # noqa: ANN401 - an entry
    """An entry as a table's cell.

    Examples
    --------
    >>> shown([0, 60]), shown([1.5, 1.8]), shown(1.641)
    ('at most 60', '1.5 to 1.8', 1.641)
    """
    if isinstance(value, Range):
        value = [value.low, value.high]
    if isinstance(value, list):
        low, high = value
        if not isfinite(high):
            return f"at least {low:g}"
        return f"{low:g} to {high:g}" if low > 0.0 else f"at most {high:g}"
    return value if isinstance(value, int | float) and not isinstance(value, bool) else str(value)


def gap(solution: Solution) -> str:
    """The gap; where it is closed the power of ten above it, for what lies below differs between machines."""
    if solution.status is Status.OPTIMAL:
        return f"1e{ceil(log10(max(solution.gap, 1e-10)))}"
    return f"{solution.gap:.3g}"


def record(solution: Solution) -> dict[str, Any]:
    """What results keep of a solution: nothing that differs from run to run."""
    kept = ["status", "objective", "lower_bound", "limit", "constants", "z", "law", "problem", "certificate"]
    if solution.power_certificate is not None:
        kept.append("power_certificate")
    whole = solution.to_dict()
    return {name: whole[name] for name in kept}
