"""The printed coefficients Q, P, S and R of the torsion lever beside their closed forms."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

import msgspec

from optlaws.balancing import FourBar
from optlaws.results import REPRODUCED, Entries, Page, PrintedNumber, Results, compared, rows

COLUMNS = ("coefficient", "beta", "lambda", "printed")
HEADINGS = (*COLUMNS, "exact", "verdict", "reason")


class Misprint(msgspec.Struct, rename={"lam": "lambda"}):
    """A printed coefficient that is wrong, with the reason; beta and lambda as in the printed data."""

    coefficient: str
    beta: str
    reason: str
    lam: str = ""


class Tables(Entries):
    """The problem file."""

    printed: str
    misprint: list[Misprint]


def run(results: Results) -> None:
    """Compare every printed number with its closed form."""
    spec = results.read(Tables)
    lines = rows(results.file.parent / spec.printed, COLUMNS)
    wrong = {(misprint.coefficient, misprint.beta, misprint.lam): misprint.reason for misprint in spec.misprint}
    verdicts = [_verdict(line, wrong) for line in lines]
    cells = [
        (v.quantity, line["beta"], line["lambda"], v.printed, v.exact, v.verdict, v.reason)
        for line, v in zip(lines, verdicts, strict=True)
    ]
    results.table("verdicts", HEADINGS, cells)
    _fill(results.page("tables").text(spec.text), lines, verdicts)
    count = Counter(verdict.verdict for verdict in verdicts)
    assert (len(verdicts), count[REPRODUCED], count["misprint"]) == (140, 91, 2)
    assert FourBar(0.5, 1.0).Q == 0.375


def _verdict(line: Mapping[str, str], wrong: Mapping[tuple[str, str, str], str]) -> PrintedNumber:
    name, beta, lam, text = (line[column] for column in COLUMNS)
    row = f"beta = {beta}" + (f", lambda = {lam}" if lam else "")
    # a coefficient that vanishes may come out as -0
    exact = float(getattr(FourBar(float(beta), float(lam or "1")), name)) + 0.0
    if float(text) == exact == 0.0:
        return PrintedNumber(row, name, text, exact, None, REPRODUCED, "")
    return compared(row, name, text, exact, on_grid=None, misprint=wrong.get((name, beta, lam)))


def _fill(page: Page, lines: Sequence[Mapping[str, str]], verdicts: Sequence[PrintedNumber]) -> None:
    betas = list(dict.fromkeys(line["beta"] for line in lines))
    lambdas = list(dict.fromkeys(line["lambda"] for line in lines if line["lambda"]))
    exact = {(v.quantity, line["beta"], line["lambda"]): v.exact for line, v in zip(lines, verdicts, strict=True)}
    for title, names, lam in (("Q, P and S, exact", "QPS", [""]), ("R, exact", "R", lambdas)):
        headings = ["beta", *(name if not ratio else f"{name}, lambda {ratio}" for name in names for ratio in lam)]
        values = [[beta, *(exact.get((name, beta, ratio)) for name in names for ratio in lam)] for beta in betas]
        page.heading(title).table(headings, values)
    count = Counter(v.verdict if not v.verdict.endswith("%") else "off by more than rounding" for v in verdicts)
    page.heading("Verdicts").table(["verdict", "numbers"], [[*item] for item in count.items()])
    off = [(v.quantity, v.row, v.printed, v.exact, v.verdict, v.reason) for v in verdicts if v.verdict != REPRODUCED]
    headings = ["coefficient", "of", "printed", "exact", "verdict", "reason"]
    page.heading("Numbers that are not reproduced to their digits").table(headings, off)


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
