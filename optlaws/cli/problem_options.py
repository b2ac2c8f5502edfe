"""Options of commands that read a problem: those of its declared entries, and the problem that they state."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Any, Literal

from optlaws.cli.options import Option, given, options
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.synthesis import Basis, BoundaryConditions, Problem
from optlaws.synthesis.problem.fields import ENTRIES
from optlaws.synthesis.problem.ranges import as_range, read_bounds
from optlaws.synthesis.spaces.bases import read_breaks


def _numbers(text: str) -> list[float]:
    try:
        return [float(number) for number in text.replace(",", " ").split()]
    except ValueError:
        raise InputError(f'start and end are numbers such as "0, 0.5", got {shortened(text)}') from None


def _numbered(name: str, read: Callable[[str], Any] = _numbers) -> dict[str, Any]:
    """An option of several numbers in one text."""
    each = ENTRIES[name]
    shown = ", ".join(map(str, each.example))
    return {"type": str, "read": read, "signed": True, "about": f'{each.about} Numbers such as "{shown}".'}


def _at_most(name: str, constant: str) -> dict[str, Any]:
    about = f"{constant} at most this."
    return {"name": name, "type": float, "about": about, "read": lambda high: as_range((None, high), constant)}


#: what is another in options than in files: a name of its own, another type, or less than files can say
_OWN: dict[str, dict[str, Any]] = {
    "B": {
        "name": "--peak-velocity",
        "type": float,
        "about": "B, above 1 (dimensionless; the mean velocity is 1); free unless given.",
    },
    "C": _at_most("--most-acceleration", "C"),
    "D": _at_most("--most-power", "D"),
    "J": _at_most("--most-jerk", "J"),
    "basis": {"type": Literal[tuple(Basis.kinds)]},
    "breaks": _numbered("breaks", read_breaks),
    **{name: _numbered(name) for name in ("straight", "start", "end")},
    "symmetric": {
        "name": "--unsymmetric",
        "about": "Seek among unsymmetric laws too.",
        "default": False,
        "read": lambda typed: False if typed else None,
    },
    "windows": {"name": "--window", "type": list[str], "signed": True},
}

#: the options of a problem by its entries; "most" and "least" are its bounds
PROBLEM: dict[str, Option] = {
    **options(ENTRIES, group=None, **{name: _OWN.get(name, {}) for name in ENTRIES if name != "bounds"}),
    "most": Option("--most", list[str], "Any constant at most a value, such as rms_c=4; may be repeated."),
    "least": Option("--least", list[str], "Any constant at least a value; may be repeated."),
}


def problem_of(values: Mapping[str, Any]) -> Problem:
    """The problem that the values of its options state."""
    entries = given(values)
    bounds = [entries.pop(side, []) for side in ("most", "least")]
    if any(bounds):
        entries["bounds"] = read_bounds(*bounds)
    _check_ends(entries)
    _check_breaks(entries)
    return Problem.from_dict(entries)


def _check_ends(entries: dict[str, Any]) -> None:
    """Require the order if nothing fixes it; periodic laws, moving ends and inflexions make laws unsymmetric."""
    ends = [entries[name] for name in ("start", "end") if name in entries]
    if len(ends) == 1:
        raise InputError("--start and --end go together")
    if ends:
        boundary = BoundaryConditions(*map(tuple, ends))
    elif "order" not in entries:
        raise InputError("give --order, the number of conditions at each end, or the conditions by --start and --end")
    repeats = entries.get("basis") == "periodic"
    if repeats or "inflexion" in entries or (ends and boundary != BoundaryConditions.rest(boundary.order)):
        entries["symmetric"] = False


def _check_breaks(entries: Mapping[str, Any]) -> None:
    if "basis" not in entries:
        return
    piecewise = "breaks" in inspect.signature(Basis.kinds[entries["basis"]]).parameters
    if piecewise != ("breaks" in entries) or ("continuity" in entries and not piecewise):
        raise InputError(
            "--basis bsplines, pieces and periodic need --breaks, the others take neither --breaks nor --continuity"
        )
    if "straight" in entries and entries["basis"] != "periodic":
        raise InputError("--straight is for --basis periodic alone")
