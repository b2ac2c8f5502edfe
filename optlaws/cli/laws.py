"""The subcommands `optlaws law` and `optlaws catalogue`: standard laws and Savin's families."""

from __future__ import annotations

import json
from math import isfinite
from typing import Annotated, Any

from cyclopts import Parameter
from rich.console import Console
from rich.table import Column, Table

from optlaws.errors import InputError
from optlaws.laws import Constants, MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue as known
from optlaws.laws.savin.family import FAMILIES, SavinFamily
from optlaws.laws.savin.savin import savin

_LETTERS = ("a", "b", "c", "j")


def law(
    name: str,
    /,
    *,
    alpha: float | None = None,
    peak_velocity: float | None = None,
    at: list[float] | None = None,
    as_json: Annotated[bool, Parameter(name="--json")] = False,
) -> None:
    """Show a law of the catalogue, a coded law or a member of Savin's families, with its constants.

    Parameters
    ----------
    name
        A name in any language or of a controller, a code such as "0317(1,5)", or one of I, II, III, IV.
    alpha
        Member of the family I, II, III or IV.
    peak_velocity
        B of the member, in place of alpha.
    at
        k in [0, 1] to give a, b, c, j and d at; may be repeated.
    as_json
        Print one JSON object on stdout and nothing else.
    """
    about, found = _member(name, alpha, peak_velocity) if name in FAMILIES else _listed(name, alpha, peak_velocity)
    values = [{"k": k, **{one: getattr(found, one)(k) for one in (*_LETTERS, "d")}} for k in at or ()]
    if as_json:
        print(json.dumps(_bounded({**about, "at": values})))  # noqa: T201
        return
    console = Console()
    head = Table(show_header=False, box=None, pad_edge=False)
    for key, value in _lines(about):
        head.add_row(key, value)
    console.print(head)
    console.print(constants_table(found.constants))
    if values:
        table = Table(*values[0], box=None, pad_edge=False)
        for row in values:
            table.add_row(*(f"{value:.10g}" for value in row.values()))
        console.print(table)


def catalogue(search: str | None = None, /, *, as_json: Annotated[bool, Parameter(name="--json")] = False) -> None:
    """List the standard laws, or those that a text may mean, the likeliest first.

    Parameters
    ----------
    search
        A name in any language or of a controller, or part of one.
    as_json
        Print one JSON array on stdout and nothing else.
    """
    entries = tuple(known.values()) if search is None else known.search(search)
    if not entries:
        raise InputError(f"no law is like {search!r}; `optlaws catalogue` lists all {len(known)}")
    if as_json:
        print(json.dumps([_bounded({k: v for k, v in one.to_dict().items() if k != "law"}) for one in entries]))  # noqa: T201
        return
    table = Table(Column("law", no_wrap=True), "B", "C", "D", "J", "continuous", box=None, pad_edge=False)
    for one in entries:
        peaks = one.constants
        numbers = [f"{peak.value:.6g}" for peak in (peaks.B, peaks.C, peaks.D, peaks.J)]
        table.add_row(one.name, *numbers, _continuous(one.continuity))
    Console().print(table)


def constants_table(found: Constants) -> Table:
    """Constants with their places, as a table for a terminal."""
    table = Table("constant", "value", "at k", box=None, pad_edge=False)
    for name in ("B", "C", "D", "J"):
        peak = getattr(found, name)
        table.add_row(name, f"{peak.value:.10g}", f"{peak.k:.6g}")
    table.add_row("RMS of c", f"{found.rms_c:.10g}", "")
    return table


def _listed(name: str, alpha: float | None, B: float | None) -> tuple[dict[str, Any], MotionLaw]:
    if alpha is not None or B is not None:
        raise InputError(f"--alpha and --peak-velocity choose a member of a family {', '.join(FAMILIES)}, not {name!r}")
    entry = known[name]
    return entry.to_dict(), entry.law


def _member(name: str, alpha: float | None, B: float | None) -> tuple[dict[str, Any], MotionLaw]:
    if alpha is None and B is None:
        low, high = map(float, SavinFamily.of(name).range)
        raise InputError(f"family {name} needs --alpha from {low:.9g} to {high:.9g}, or --peak-velocity")
    found = savin(name, alpha, B=B)
    family = SavinFamily.of(name)
    about = {
        "name": f"Savin's family {name}",
        "alpha": alpha if alpha is not None else family.alphas(B=B)[0],
        "order": family.order,
        "constants": found.constants.to_dict(rms=True),
        "law": found.to_dict(),
    }
    return about, found


def _lines(about: dict[str, Any]) -> list[tuple[str, str]]:
    if "alpha" in about:
        return [
            ("law", about["name"]),
            ("alpha", f"{about['alpha']:.10g}"),
            ("order l", str(about["order"])),
        ]
    names = "; ".join(f"{language}: {', '.join(some)}" for language, some in about["aliases"].items())
    lines = [("law", about["name"]), ("also", names), ("built", about["formula"]), ("source", about["source"])]
    if about["from_memory"]:
        lines.append(("", "the definition is from memory: compare it with the source"))
    return [*lines, ("continuous", _continuous(about["continuity"]))]


def _bounded(data: Any) -> Any:  # noqa: ANN401 - plain data, whatever it holds
    """JSON has no infinity: a peak without bound is null."""
    if isinstance(data, dict):
        return {key: _bounded(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [_bounded(value) for value in data]
    return None if isinstance(data, float) and not isfinite(data) else data


def _continuous(order: int) -> str:
    return "a" + "".join(f", {one}" for one in ("b", "c", "j", "j'", "j''")[: min(order, 5)])
