"""The ledger: every printed item of the papers with its verdict, as tables and one page."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Annotated

import msgspec

from optlaws import InputError
from optlaws.results import Cell, Entries, Page, Results, read, unknown_key

from .papers import items
from .papers.items import Verdict
from .papers.verdicts import Judged, judge

KINDS = ("formula", "cell", "number", "figure", "claim", "procedure")
HEADINGS = ("paper", "id", "kind", "printed", "computed", "verdict", "reason", "confidence")
#: so many cells of which the same is said stand on one line
_MANY = 4
#: what needs no word on the page
_PLAIN = {Verdict.REPRODUCED, Verdict.ON_GRID, Verdict.AGREES, Verdict.CONFIRMED}


class Ledger(Entries):
    """The problem file: the papers' files."""

    papers: Annotated[list[items.Text], msgspec.Meta(min_length=1)]


@dataclass(frozen=True)
class Entry:
    """A paper of the ledger: its name, its title and its items as they are declared."""

    name: str
    title: str
    items: Sequence[items.Item]


def run(results: Results) -> None:
    """Compute every item again, and table its verdict.

    Raises
    ------
    InputError
        If an item's verdict does not hold; the message names all of them.
    """
    spec = results.read(Ledger)
    papers = list(_papers(spec, results.file))
    judged = [judge(item, paper.name, results.file.parent) for paper in papers for item in paper.items]
    wrong = [_broken(judgement) for judgement in judged if not judgement.holds]
    if wrong:
        raise InputError("verdicts do not hold:\n" + "\n".join(wrong))
    results.table("ledger", HEADINGS, [_cells(judgement) for judgement in judged])
    results.table("summary", *_summary(papers, judged))
    _fill(results.page("ledger").text(spec.text), papers, judged)
    for paper in papers:
        _misprints(results.page(f"misprints_{paper.name}", f"Misprints and misreadings: {paper.title}"), paper, judged)
    counts = Counter(judgement.verdict for judgement in judged)
    assert (len(judged), counts[Verdict.REPRODUCED], counts[Verdict.MISPRINT], counts[Verdict.AGREES]) == (
        695,
        204,
        23,
        177,
    )


def entries(file: Path) -> list[Entry]:
    """The papers of a ledger's problem file.

    Raises
    ------
    InputError
        If it is not one, or an item is wrong.
    """
    return list(_papers(read(file, Ledger), file))


def chosen(
    papers: Sequence[Entry], *, paper: str | None, kind: str | None, verdict: str | None, name: str | None
) -> list[tuple[str, items.Item]]:
    """Items of some papers, by the paper's name, kind, declared verdict and id; None is any.

    Raises
    ------
    InputError
        If a paper, kind, verdict or id is not known.
    """
    for what, choice, known in (
        ("paper", paper, [entry.name for entry in papers]),
        ("kind", kind, KINDS),
        ("verdict", verdict, [str(word) for word in Verdict]),
        ("id", name, [item.id for entry in papers for item in entry.items]),
    ):
        if choice is not None and choice not in known:
            raise InputError(unknown_key(choice, known, what))
    return [
        (entry.name, item)
        for entry in papers
        for item in entry.items
        if paper in {None, entry.name}
        and kind in {None, item.kind}
        and verdict in {None, str(item.verdict)}
        and name in {None, item.id}
    ]


def _papers(spec: Ledger, file: Path) -> Iterator[Entry]:
    for name in spec.papers:
        source = file.parent / name
        paper, listed = items.read(source)
        yield Entry(source.stem, paper.title, listed)


def _broken(judgement: Judged) -> str:
    item = judgement.item
    return f"{judgement.paper} {item.id}: declared {item.verdict!s}, found {judgement.verdict!s} ({judgement.words})"


def _cells(judgement: Judged) -> list[Cell]:
    item = judgement.item
    return [
        judgement.paper,
        item.id,
        item.kind,
        item.printed,
        judgement.computed,
        str(judgement.verdict),
        item.reason,
        item.confidence,
    ]


def _summary(papers: Sequence[Entry], judged: Sequence[Judged]) -> tuple[list[str], list[list[Cell]]]:
    counts = Counter((judgement.paper, judgement.item.kind, judgement.verdict) for judgement in judged)
    headings = ["paper", "kind", "items", *(str(verdict) for verdict in Verdict)]
    rows: list[list[Cell]] = []
    for paper in [*(entry.name for entry in papers), "all"]:
        for kind in [*KINDS, "all"]:
            by_verdict = [
                sum(
                    count
                    for (name, of_kind, reached), count in counts.items()
                    if reached is verdict and paper in {name, "all"} and kind in {of_kind, "all"}
                )
                for verdict in Verdict
            ]
            if sum(by_verdict):
                rows.append([paper, kind, sum(by_verdict), *by_verdict])
    return headings, rows


def _fill(page: Page, papers: Sequence[Entry], judged: Sequence[Judged]) -> None:
    page.table(*_summary(papers, judged))
    for paper in papers:
        other = [judgement for judgement in judged if judgement.paper == paper.name and judgement.verdict not in _PLAIN]
        if other:
            page.heading(paper.title)
            groups = [list(group) for _, group in groupby(other, key=_told_alike)]
            lines = [_line(group[0]) if len(group) < _MANY else _together(group) for group in _apart(groups)]
            page.table(["item", "printed", "computed", "verdict", "why"], lines)


def _misprints(page: Page, paper: Entry, judged: Sequence[Judged]) -> None:
    """The misprints and misreadings of a paper, for the page of its theory."""
    wrong = {Verdict.MISPRINT, Verdict.MISREAD}
    lines = [
        [
            judgement.item.id,
            str(judgement.verdict),
            judgement.item.as_read or judgement.item.printed,
            judgement.item.means or judgement.item.printed,
            judgement.item.reason,
        ]
        for judgement in judged
        if judgement.paper == paper.name and judgement.verdict in wrong
    ]
    page.table(["item", "verdict", "reads", "should read", "why"], lines)


def _told_alike(judgement: Judged) -> tuple[str, ...]:
    """Cells of which the same is said stand together."""
    return (
        (judgement.item.kind, str(judgement.verdict), judgement.item.reason)
        if judgement.verdict is Verdict.PERCENT
        else (judgement.item.id,)
    )


def _apart(groups: Sequence[list[Judged]]) -> Iterator[list[Judged]]:
    for group in groups:
        yield from [group] if len(group) >= _MANY else [[judgement] for judgement in group]


def _together(group: Sequence[Judged]) -> list[Cell]:
    ids = f"{group[0].item.id} to {group[-1].item.id}, {len(group)} cells"
    return [ids, "", None, f"to {max(judgement.item.within for judgement in group):g} %", group[0].item.reason]


def _line(judgement: Judged) -> list[Cell]:
    item = judgement.item
    verdict = f"to {item.within:g} %" if judgement.verdict is Verdict.PERCENT else str(judgement.verdict)
    means = f"means {item.means}" if item.means else ""
    why = "; ".join(part for part in (means, item.reason, item.lost, item.source) if part)
    computed = judgement.computed if item.kind in {"number", "cell", "claim", "procedure"} else None
    return [item.id, item.printed.replace("|", "\\|"), computed, verdict, why.replace("|", "\\|")]


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
