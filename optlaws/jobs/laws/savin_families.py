"""The job "savin families": the constants of Savin's families over alpha, tabled and drawn (his Fig. 2)."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from optlaws.files import tables, writing
from optlaws.files.problem_file import convert
from optlaws.jobs.laws.figure_savin import draw
from optlaws.laws.savin.family import SavinFamily
from optlaws.studies.points.problem_entries import Text

HEADINGS = ("family", "alpha", "delta", "order of a⁽ⁿ⁾(0)", "a⁽ⁿ⁾(0)", "B", "C", "k of C", "D", "k of D")
BEST = (
    "family", "u", "H", "M", "alpha from", "alpha to", "alpha of least C", "least C", "alpha of least D", "least D",
)  # fmt: skip

Named = Literal["I", "II", "III", "IV"] | Annotated[int, msgspec.Meta(ge=0, le=20)]


class Study(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: Text
    families: Annotated[list[Named], msgspec.Meta(min_length=1, max_length=6)]
    rows: Annotated[int, msgspec.Meta(ge=2, le=1000)]
    points: Annotated[int, msgspec.Meta(ge=2, le=10000)] = 201
    text: str = ""


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Study, file)
    families = [SavinFamily.of(one) for one in spec.families]
    about = f"{spec.title}; from {file.name}"
    lines = [line for one in families for line in _lines(one, spec.rows)]
    written = [
        writing.write(out / "table.csv", tables.to_csv(HEADINGS, lines, about=about)),
        writing.write(out / "table.md", _markdown(spec, families, lines)),
    ]
    drawing = draw(spec.title, families, spec.points)
    return written + [writing.write(out / f"figure.{kind}", content) for kind, content in drawing.items()]


def _lines(family: SavinFamily, rows: int) -> list[list[tables.Cell]]:
    """Members at equal steps of alpha on either side of the base law, those of least C and of least D."""
    low, high = family.range
    steps = rows // 2
    alphas = {low * i / steps for i in range(steps + 1)} | {high * i / steps for i in range(steps + 1)}
    named = {Fraction(family.least_C[0]), Fraction(family.least_D[0])}
    alphas |= {one for one in named if all(abs(one - other) > 1e-9 for other in alphas)}
    return [_line(family, alpha) for alpha in sorted(alphas)]


def _line(family: SavinFamily, exact: Fraction) -> list[tables.Cell]:
    alpha = float(exact)
    order, start = family.start(alpha)
    C, D = family.C(alpha), family.D(alpha)
    delta = None if alpha == 0.0 else float(family.M + 1 / exact)
    return [
        str(family).removeprefix("family "),
        alpha,
        delta,
        order,
        start,
        family.B(alpha).value,
        *_pair(C),
        *_pair(D),
    ]


def _pair(peak: Any) -> tuple[float, float]:  # noqa: ANN401
    return peak.value, peak.k


def _best(family: SavinFamily) -> list[tables.Cell]:
    low, high = map(float, family.range)
    (at_C, C), (at_D, D) = family.least_C, family.least_D
    name = str(family).removeprefix("family ")
    return [name, family.u, family.H, f"{family.M}", low, high, at_C, C.value, at_D, D.value]


def _markdown(spec: Study, families: list[SavinFamily], lines: list[list[tables.Cell]]) -> str:
    text = [spec.text.strip(), ""] if spec.text.strip() else []
    best = tables.to_markdown(BEST, [_best(one) for one in families], digits=10)
    return "\n".join(
        [
            f"# {spec.title}",
            "",
            f"<!-- {writing.MARK} -->",
            "",
            *text,
            f"![{spec.title}](figure.svg)",
            "",
            best,
            tables.to_markdown(HEADINGS, lines, digits=8),
        ]
    )
