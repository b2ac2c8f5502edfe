"""The command `optlaws ledger`: printed numbers, formulas, figures and claims, each with its verdict."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from optlaws.cli.app import NotProven
from optlaws.cli.options import AsJson
from optlaws.cli.show import busy, print_json, show, table


def ledger(
    paper: str | None = None,
    *,
    kind: str | None = None,
    verdict: str | None = None,
    id: str | None = None,  # noqa: A002 - the option's name
    file: Path = Path("problems/ledger.toml"),
    as_json: AsJson = False,
) -> None:
    """Show printed numbers, formulas, figures and claims, computed again, with their verdicts.

    No picture is drawn: the ledger is a list of verdicts, and its figures are redrawn by `optlaws run`.

    Ends with 0 if every verdict that is declared holds, 1 if one does not, 2 if an item cannot be computed.

    Parameters
    ----------
    paper
        savin, loader, lever, dwell or optimal; all unless given.
    kind
        formula, cell, number, figure, claim or procedure.
    verdict
        Items of which this is declared: "misprint", "contradicted", "undecidable", ...
    id
        One item.
    file
        The problem file of the ledger; by default, if it does not exist, the one that comes with optlaws.
    as_json
        Print a list of the items on stdout and nothing else.
    """
    from optlaws.files.packaged import or_packaged

    # a script that comes with optlaws, which type checkers find under problems/
    script = import_module("optlaws.problems.ledger")
    source = or_packaged(file)
    items = script.chosen(script.entries(source), paper=paper, kind=kind, verdict=verdict, name=id)
    with busy(f"{len(items)} items"):
        judged = [script.judge(item, name, source.parent) for name, item in items]
    if as_json:
        print_json([judgement.results() for judgement in judged])
    else:
        _show(judged)
    broken = [
        f"{judgement.paper} {judgement.item.id}: declared {judgement.item.verdict!s}, found {judgement.verdict!s}"
        for judgement in judged
        if not judgement.holds
    ]
    if broken:
        raise NotProven("\n".join(broken))


def _show(judged: Sequence[Any]) -> None:
    rows = []
    for judgement in judged:
        computed, item = "" if judgement.computed is None else f"{judgement.computed:.10g}", judgement.item
        rows.append([judgement.paper, item.id, item.kind, item.printed, computed, str(judgement.verdict)])
    reasons = [
        f"{judgement.item.id}: {why}" for judgement in judged if (why := judgement.item.reason or judgement.item.lost)
    ]
    headings = ("paper", "item", "kind", "printed", "computed", "verdict")
    show(table(*headings, rows=rows), *reasons, f"{len(judged)} items")
