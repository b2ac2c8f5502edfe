"""The job "lever tables": the printed coefficients Q, P, S and R of the torsion lever beside their closed forms."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import msgspec

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files import tables, writing
from optlaws.files.problem_file import Text, convert
from optlaws.jobs.pages import printed
from optlaws.jobs.pages.page import Page
from optlaws.mechanisms.lever.linkage import FourBar

COLUMNS = ("coefficient", "beta", "lambda", "printed")
REPRODUCED = printed.REPRODUCED
HEADINGS = ("coefficient", "beta", "lambda", "printed", "exact", "verdict", "reason")

Coefficient = Literal["Q", "P", "S", "R"]


class Misprint(msgspec.Struct, kw_only=True, forbid_unknown_fields=True, rename={"lam": "lambda"}):
    """A printed coefficient that is wrong, with the reason; beta and lambda as in the printed data."""

    coefficient: Coefficient
    beta: Text
    lam: str = ""
    reason: Text


class Tables(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: Text
    printed: Text
    text: str = ""
    misprint: list[Misprint] = []


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Tables, file)
    source = file.parent / spec.printed
    lines = printed.rows(source, COLUMNS)
    verdicts = _verdicts(spec, lines, str(source))
    cells = [
        (v.quantity, line["beta"], line["lambda"], v.printed, v.exact, v.verdict, v.reason)
        for line, v in zip(lines, verdicts, strict=True)
    ]
    about = f"{spec.title}; from {file.name}"
    return [
        writing.write(out / "verdicts.csv", tables.to_csv(HEADINGS, cells, about=about)),
        writing.write(out / "tables.md", str(_page(spec, lines, verdicts))),
    ]


def _verdicts(spec: Tables, lines: Sequence[Mapping[str, str]], where: str) -> list[printed.Verdict]:
    wrong: dict[tuple[str, str, str], str] = {
        (misprint.coefficient, misprint.beta, misprint.lam): misprint.reason for misprint in spec.misprint
    }
    verdicts = []
    for line in lines:
        name, beta, lam = (line[column] for column in COLUMNS[:3])
        if name not in ("Q", "P", "S", "R"):
            raise InputError(f"{where}: coefficient must be Q, P, S or R, got {shortened(name)}")
        if (name == "R") != bool(lam):
            raise InputError(f"{where}: R needs a lambda and the others have none, got {name} with lambda {lam!r}")
        linkage = FourBar(_above_zero(beta, where), _above_zero(lam or "1", where))
        # a coefficient that vanishes may come out as -0
        exact = float(getattr(linkage, name)) + 0.0
        try:
            verdicts.append(_judged(line, exact, wrong.pop((name, beta, lam), None)))
        except InputError as error:
            raise InputError(f"{where}: {error}") from None
    if wrong:
        rest = ", ".join(" ".join(part for part in key if part) for key in wrong)
        raise InputError(f"misprint: not among the printed numbers of {where}: {rest}")
    return verdicts


def _judged(line: Mapping[str, str], exact: float, misprint: str | None) -> printed.Verdict:
    name, beta, lam, text = (line[column] for column in COLUMNS)
    row = f"beta = {beta}" + (f", lambda = {lam}" if lam else "")
    if printed.number(text, f"{name} of {row}") != 0.0:
        return printed.judge(row, name, text, exact, on_grid=None, misprint=misprint)
    if exact != 0.0:
        raise InputError(f"{name} of {row} is printed as 0, it is {exact:.6g}: no share of it can be told")
    return printed.Verdict(row, name, text, exact, None, REPRODUCED, "")


def _above_zero(text: str, where: str) -> float:
    value = printed.number(text, where)
    if value <= 0.0:
        raise InputError(f"{where}: beta and lambda must be above 0, got {text}")
    return value


def _page(spec: Tables, lines: Sequence[Mapping[str, str]], verdicts: Sequence[printed.Verdict]) -> Page:
    page = Page(spec.title).text(spec.text)
    betas = list(dict.fromkeys(line["beta"] for line in lines))
    exact = {(v.quantity, line["beta"], line["lambda"]): v.exact for line, v in zip(lines, verdicts, strict=True)}
    for title, names, lam in (("Q, P and S, exact", "QPS", [""]), ("R, exact", "R", _lambdas(lines))):
        headings = ["beta", *(name if not ratio else f"{name}, lambda {ratio}" for name in names for ratio in lam)]
        rows = [[beta, *(exact.get((name, beta, ratio)) for name in names for ratio in lam)] for beta in betas]
        page.heading(title).table(headings, rows)
    count = Counter(v.verdict if not v.verdict.endswith("%") else "off by more than rounding" for v in verdicts)
    page.heading("Verdicts").table(["verdict", "numbers"], [[*item] for item in count.items()])
    off = [(v.quantity, v.row, v.printed, v.exact, v.verdict, v.reason) for v in verdicts if v.verdict != REPRODUCED]
    headings = ["coefficient", "of", "printed", "exact", "verdict", "reason"]
    return page.heading("Numbers that are not reproduced to their digits").table(headings, off)


def _lambdas(lines: Sequence[Mapping[str, str]]) -> list[str]:
    return list(dict.fromkeys(line["lambda"] for line in lines if line["lambda"]))
