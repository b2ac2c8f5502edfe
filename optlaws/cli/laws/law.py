"""The command `optlaws law`: one law of the catalogue or of Savin's families, with its constants."""

from __future__ import annotations

from typing import Any

import optlaws
from optlaws.cli.laws.catalogue import continuous
from optlaws.cli.options import AsJson
from optlaws.cli.show import constants_table, print_json, show, table
from optlaws.errors import InputError

_LETTERS = ("a", "b", "c", "j", "d")


def law(
    name: str,
    /,
    *,
    alpha: float | None = None,
    peak_velocity: float | None = None,
    at: list[float] | None = None,
    as_json: AsJson = False,
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
    about, found = _asked(name, alpha, peak_velocity)
    values = [{"k": k, **{one: getattr(found, one)(k) for one in _LETTERS}} for k in at or ()]
    if as_json:
        print_json({**about, "at": values})
        return
    head = table()
    for key, value in _lines(about):
        head.add_row(key, value)
    show(head, constants_table(found.constants))
    if values:
        rows = table(*values[0])
        for row in values:
            rows.add_row(*(f"{value:.10g}" for value in row.values()))
        show(rows)


def _asked(name: str, alpha: float | None, B: float | None) -> tuple[dict[str, Any], optlaws.MotionLaw]:
    from optlaws.laws.savin.family import FAMILIES

    if name in FAMILIES:
        return _member(name, alpha, B)
    if alpha is not None or B is not None:
        raise InputError(f"--alpha and --peak-velocity choose a member of a family {', '.join(FAMILIES)}, not {name!r}")
    entry = optlaws.catalogue[name]
    return entry.to_dict(), entry.law


def _member(name: str, alpha: float | None, B: float | None) -> tuple[dict[str, Any], optlaws.MotionLaw]:
    if alpha is None and B is None:
        low, high = map(float, optlaws.SavinFamily.of(name).range)
        raise InputError(f"family {name} needs --alpha from {low:.9g} to {high:.9g}, or --peak-velocity")
    found = optlaws.savin(name, alpha, B=B)
    family = optlaws.SavinFamily.of(name)
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
    return [*lines, ("continuous", continuous(about["continuity"]))]
