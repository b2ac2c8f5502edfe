"""The ledger: every declared verdict is what is computed, nothing is missing, and a changed digit is noticed."""

import re
import shutil
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import msgspec
import numpy as np
import pytest

from optlaws import InputError
from optlaws.results import Results
from problems.ledger import entries, run
from problems.papers import items
from problems.papers.items import VERDICTS, Item, Verdict
from problems.papers.published import limited, triple_harmonic
from problems.papers.verdicts import Judged, judge
from tests.documents import ROOT

PROBLEMS = ROOT / "problems"
LEDGER = PROBLEMS / "ledger.toml"
PAPERS = {paper.name: paper for paper in entries(LEDGER)}
#: rows and columns of the printed tables
CELLS = {"savin": 0, "loader": 12 * 3, "lever": 14 * 10, "dwell": 0, "optimal": 13 * 3 + 67, "published": 16}
#: the numbers of the equations, and the last of them; none is left out
EQUATIONS = {
    "savin": (r"\(1\.(\d+)\)", 27),
    "loader": (r"\((\d+)", 25),
    "lever": (r"\((\d+)\)", 21),
    "dwell": (r"\((\d+)\)", 35),
    "optimal": (r"\((\d+)\)", 10),
    "published": (r"\((\d+)\)", 0),
}


@cache
def judged(paper: str) -> Mapping[str, Judged]:
    """All items of a paper, computed once for all tests."""
    return {item.id: judge(item, paper, PROBLEMS) for item in PAPERS[paper].items}


@pytest.mark.sample(3)
@pytest.mark.parametrize("paper", PAPERS)
def test_every_declared_verdict_is_the_computed_one(paper: str) -> None:
    broken = {name: one.words for name, one in judged(paper).items() if not one.holds}
    assert broken == {}


@pytest.mark.parametrize("paper", PAPERS)
def test_no_cell_and_no_equation_is_missing(paper: str) -> None:
    names = [item.id for item in PAPERS[paper].items]
    assert sum(item.kind == "cell" for item in PAPERS[paper].items) == CELLS[paper]
    pattern, last = EQUATIONS[paper]
    assert {int(found[1]) for name in names if (found := re.match(pattern, name))} == set(range(1, last + 1))


@pytest.mark.parametrize("paper", PAPERS)
def test_a_changed_digit_changes_the_verdict(paper: str) -> None:
    draw = np.random.default_rng(7)
    numbers = [item for item in PAPERS[paper].items if re.fullmatch(r"-?\d+\.\d+", item.printed) and item.compute]
    for item in draw.choice(np.array(numbers, dtype=object), size=min(40, len(numbers)), replace=False):
        place = draw.choice([i for i, letter in enumerate(item.printed) if letter.isdigit()][:4])
        digit = str((int(item.printed[place]) + 3) % 10)
        wrong = msgspec.structs.replace(item, printed=item.printed[:place] + digit + item.printed[place + 1 :])
        if item.verdict in {Verdict.MISPRINT, Verdict.CONTRADICTED}:
            continue
        assert not judge(wrong, paper, PROBLEMS).holds, wrong


@pytest.mark.parametrize("paper", PAPERS)
def test_a_changed_formula_changes_the_verdict(paper: str) -> None:
    formulas = [item for item in PAPERS[paper].items if item.kind == "formula" and item.verdict is Verdict.AGREES]
    for item in formulas:
        left, _, right = item.printed.rpartition("=")
        wrong = msgspec.structs.replace(item, printed=f"{left}= 1.001*({right}) + 0.001")
        assert judge(wrong, paper, PROBLEMS).verdict is Verdict.CONTRADICTED, item.id


@pytest.mark.parametrize(
    ("harmonics", "constants"),
    [
        ((6.04, 0.0), (2.0, 5.318, 7.928, 51.71)),
        ((5.1968, 1.769), (1.7185, 6.076, 5.266, 66.30)),
        ((9 * np.pi / 4, 0.0), (2.0, 9.4248, 11.754, 68.379)),
    ],
)
def test_laws_of_three_harmonics_have_their_constants(
    harmonics: tuple[float, float], constants: tuple[float, ...]
) -> None:
    law = triple_harmonic(*harmonics)
    assert law.a(1.0) == pytest.approx(1.0, abs=1e-14)
    assert [getattr(law.constants, name).value for name in "BCDJ"] == pytest.approx(constants, rel=2e-4)


def test_a_motion_at_its_limits_is_at_one_of_them_everywhere() -> None:
    law = limited([0.3, 0.4, 0.2, 0.5])
    middles = 0.5 * (np.array(law.breaks[1:]) + np.array(law.breaks[:-1]))
    peaks = [float(np.abs(law(middles, nu)).max()) for nu in (4, 3, 2, 1)]
    reached = [np.abs(law(middles, nu)) >= (1.0 - 1e-9) * peak for nu, peak in zip((4, 3, 2, 1), peaks, strict=True)]
    assert len(law.segments) == 15
    assert np.any(reached, axis=0).all()


NUMBER = Item(
    id="C of S3", kind="number", printed="5.774", compute="optimal.smooth_constant",
    arguments={"order": 3, "name": "C", "steps": 20}, verdict=Verdict.REPRODUCED,
)  # fmt: skip


@pytest.mark.parametrize(
    ("changed", "verdict"),
    [
        ({}, Verdict.REPRODUCED),
        ({"printed": "5.76"}, Verdict.ON_GRID),
        ({"printed": "5.79", "verdict": Verdict.PERCENT, "within": 0.29}, Verdict.PERCENT),
        ({"printed": "5.79", "verdict": Verdict.PERCENT, "within": 0.5}, Verdict.CONTRADICTED),
        ({"printed": "5.74", "verdict": Verdict.MISPRINT, "means": "5.774", "reason": "a digit"}, Verdict.MISPRINT),
        ({"printed": "5.74", "verdict": Verdict.MISPRINT, "means": "5.775", "reason": "a digit"}, Verdict.PERCENT),
        ({"verdict": Verdict.MISPRINT, "means": "5.774", "reason": "a digit"}, Verdict.REPRODUCED),
        ({"verdict": Verdict.MISREAD, "as_read": "5774", "reason": "a point"}, Verdict.MISREAD),
        ({"verdict": Verdict.MISREAD, "as_read": "5.774", "reason": "a point"}, Verdict.REPRODUCED),
        ({"printed": "57.74"}, Verdict.CONTRADICTED),
        ({"printed": "inf"}, Verdict.CONTRADICTED),
        ({"printed": "0.000"}, Verdict.CONTRADICTED),
    ],
)
def test_a_verdict_is_found_whatever_is_declared(changed: dict[str, object], verdict: Verdict) -> None:
    assert judge(msgspec.structs.replace(NUMBER, **changed), "optimal", PROBLEMS).verdict is verdict


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"compute": "optimal.smoth_constant"}, "did you mean 'optimal.smooth_constant'"),
        ({"compute": "nobody.constant"}, "unknown computation"),
        ({"arguments": {"order": 3, "nam": "C", "steps": 20}}, "has no argument nam"),
        ({"arguments": {"order": 3}}, "needs the argument name"),
        ({"kind": "claim"}, "computes no claim"),
        ({"kind": "formula", "printed": "C = 1"}, "has no argument draw"),
        ({"printed": "five"}, "'five' is not a number"),
    ],
)
def test_what_cannot_be_computed_is_refused(changed: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match=message):
        judge(msgspec.structs.replace(NUMBER, **changed), "optimal", PROBLEMS)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ('verdict = "misprint"', "needs the entry means"),
        ('verdict = "to p percent"', "needs the entry within"),
        ('verdict = "undecidable"', "needs the entry lost"),
        ('verdict = "agrees"', "a number cannot be agrees"),
        ('verdict = "correct"', "correct"),
        ('verdict = "reproduced to its digits"\nprintd = "2"', "did you mean 'printed'"),
    ],
)
def test_an_item_that_lacks_what_its_verdict_needs_is_refused(lines: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "paper.toml"
    item = 'id = "one"\nkind = "number"\nprinted = "1"\ncompute = "optimal.range"'
    file.write_text(f'title = "T"\nsource = "S"\n[[item]]\n{item}\n{lines}\n', "utf-8")
    with pytest.raises(InputError, match=message):
        items.read(file)


def test_each_kind_can_be_undecidable() -> None:
    assert all(Verdict.UNDECIDABLE in verdicts for verdicts in VERDICTS.values())


LEDGER_FILE = 'title = "Two items"\npapers = ["paper.toml"]\n'
PAPER = """
title = "A paper"
source = "none"
[[item]]
id = "C of S3"
kind = "number"
printed = "5.774"
compute = "optimal.smooth_constant"
arguments = { order = 3, name = "C", steps = 20 }
verdict = "reproduced to its digits"
[[item]]
id = "Z of S3"
kind = "formula"
printed = "Z = -3 + 6*k"
compute = "optimal.known_law"
arguments = { order = 3 }
verdict = "agrees"
"""


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("5.774", "5.775", "verdicts do not hold.*C of S3: declared reproduced to its digits, found to p percent"),
        ("6*k", "7*k", "Z of S3: declared agrees, found contradicted"),
        ("known_law", "know_law", "did you mean 'optimal.known_law'"),
        ('verdict = "agrees"', 'verdict = "confirmed"', "a formula cannot be confirmed"),
        ("title", "titel", "did you mean 'title'"),
    ],
)
def test_what_is_wrong_in_a_paper_s_file_is_named(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert old in PAPER
    (tmp_path / "ledger.toml").write_text(LEDGER_FILE, "utf-8")
    (tmp_path / "paper.toml").write_text(PAPER.replace(old, new, 1), "utf-8")
    with pytest.raises(InputError, match=f"(?s){message}"):
        run(Results(tmp_path / "ledger.toml"))


def test_a_figure_is_drawn_where_results_do_not_lie_beside_the_problems(tmp_path: Path) -> None:
    shutil.copy(PROBLEMS / "lever_drawing.toml", tmp_path)
    figure = Item(
        id="Fig. 1", kind="figure", printed="the mechanism", job="lever_drawing.toml", file="mechanism.svg",
        curves=["cam"], verdict=Verdict.AGREES,
    )  # fmt: skip
    assert judge(figure, "lever", tmp_path).holds
    assert not judge(msgspec.structs.replace(figure, curves=["a cam of cheese"]), "lever", tmp_path).holds
    with pytest.raises(InputError, match=r"draws no other\.svg"):
        judge(msgspec.structs.replace(figure, file="other.svg"), "lever", tmp_path)
    with pytest.raises(InputError, match=r"none\.toml is no problem"):
        judge(msgspec.structs.replace(figure, job="none.toml"), "lever", tmp_path)


def test_a_ledger_needs_papers(tmp_path: Path) -> None:
    file = tmp_path / "ledger.toml"
    for changed, message in (('paper = ["paper.toml"]', "did you mean 'papers'"), ("papers = []", "papers")):
        file.write_text(f'title = "None"\n{changed}\n', "utf-8")
        with pytest.raises(InputError, match=message):
            entries(file)
