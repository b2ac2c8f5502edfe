"""Problems as problem files describe them: entries of a table, some replaced by others."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil, isfinite, log10
from typing import Any

from optlaws.errors import located
from optlaws.files.reading import is_number
from optlaws.synthesis import Problem, Range, Solution, Status
from optlaws.synthesis.problem.fields import FREE, ConstantBounds
from optlaws.synthesis.problem.problem import ENTRIES
from optlaws.synthesis.problem.windows import Window


def problem(where: str, *parts: Mapping[str, Any]) -> Problem:
    """The problem of entries in which later ones replace earlier ones; errors call it `where`.

    Examples
    --------
    >>> problem("row 1", {"order": 4, "B": 1.641}, {"B": "free", "minimise": "D"})
    Problem(B=None, order=4, basis=Chebyshev(degree=9), minimise='D')
    """
    entries = {name: value for part in parts for name, value in part.items()}
    entries = {name: value for name, value in entries.items() if value != FREE}
    if "bounds" in entries:
        entries["bounds"] = {name: value for name, value in entries["bounds"].items() if value != FREE}
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
    if isinstance(value, list) and not isinstance(ENTRIES[name].type, ConstantBounds):
        return ("; " if name == "windows" else ", ").join(_brief(item) for item in value)
    if isinstance(value, Range):
        value = [value.low, value.high]
    if isinstance(value, list):
        low, high = value
        if not isfinite(high):
            return f"at least {low:g}"
        return f"{low:g} to {high:g}" if low > 0.0 else f"at most {high:g}"
    return value if is_number(value) else str(value)


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
    names = ["status", "objective", "lower_bound", "best_possible", "constants", "z", "law", "problem", "certificate"]
    proofs = {
        "power_certificate": solution.power_certificate,
        "peak_certificate": solution.peak_certificate,
        "drive_limit": solution.drive_limit,
    }
    names += [name for name, proof in proofs.items() if proof is not None]
    entries = solution.to_dict()
    return {name: entries[name] for name in names}


def steady(data: Any) -> Any:
    """Stored laws and proofs without what differs from run to run: versions, and how long was searched.

    Examples
    --------
    >>> steady({"solutions": [{"objective": 4.5, "seconds": 0.2, "versions": {"numpy": "2.1"}}]})
    {'solutions': [{'objective': 4.5, 'seconds': 0.0}]}
    """
    if isinstance(data, list):
        return [steady(part) for part in data]
    if not isinstance(data, dict):
        return data
    stable = {name: steady(part) for name, part in data.items() if name != "versions"}
    return stable | {name: type(stable[name])() for name in ("seconds", "iterations") if name in stable}
