"""What values show of themselves in a notebook: escaped, without scripts, and never an exception."""

import re
from html.parser import HTMLParser
from typing import Protocol

import numpy as np
import pytest

from optlaws import (
    Chebyshev,
    Cycle,
    Dwell,
    Follower,
    Problem,
    ProblemArray,
    Return,
    Rise,
    Solution,
    catalogue,
    compare_laws,
    pareto_front,
    smoothstep,
    synthesize,
    synthesize_array,
)
from tests.internals.shown import facts, page

VOID = {"path", "line"}


class Checked(HTMLParser):
    """Elements that are closed in order."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        assert tag != "script"
        assert not any(name.startswith("on") or name in {"href", "src"} for name, _ in attrs)
        self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:  # noqa: ARG002 - its face
        assert tag in VOID

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


class Shown(Protocol):
    def _repr_html_(self) -> str: ...


def checked(value: Shown) -> tuple[str, str]:
    """The HTML of a value, and its text."""
    html = value._repr_html_()
    parser = Checked()
    parser.feed(html)
    assert parser.open == []
    assert not re.search(r"\b(?:nan|inf)\b", "".join(re.findall(r'd="([^"]*)"', html)))
    return html, parser.text


@pytest.fixture(scope="module")
def solution() -> Solution:
    return synthesize(Problem(B=1.8, order=4, basis=Chebyshev(5)))


def test_a_solution_shows_what_is_proven_and_its_law(solution: Solution) -> None:
    html, text = checked(solution)
    assert html.count("<svg") == 5
    for part in ("optimal", f"{solution.objective:.7g}", "lower bound", "b", "j"):
        assert part in text
    assert (
        "5.2" in checked(solution.constants)[1] or f"{solution.constants.C.value:.7g}" in checked(solution.constants)[1]
    )


def test_a_problem_shows_what_is_asked() -> None:
    _, text = checked(Problem(B=1.8, order=4, minimise="0.5*C/4 + J/32"))
    assert "1.8" in text
    assert "minimise" in text


def test_the_catalogue_shows_every_law_with_its_acceleration() -> None:
    html, text = checked(catalogue)
    assert html.count("<svg") == len(catalogue)
    assert "modified sine" in text
    assert "modsine" in checked(catalogue["modified sine"])[1]


def test_followers_show_themselves_and_their_answers() -> None:
    assert "damping ratio" in checked(Follower(20, 0.05))[1]
    assert checked(Follower(20, 1.5))[0].count("<svg") == 1
    assert "residual acceleration" in checked(Follower(20, 0.05).response(smoothstep(4)))[1]
    assert "cycloidal" in checked(compare_laws("modified sine", "cycloidal"))[1]


def test_a_cycle_shows_its_segments_or_why_it_has_no_laws() -> None:
    segments = [Rise("35 mm", "120 deg"), Dwell("90 deg", name="wait <here>"), Return()]
    html, text = checked(Cycle(segments, speed="200 rpm"))
    assert "wait <here>" in text
    assert html.count("<svg") == 4
    _, text = checked(Cycle(segments, speed="200 rpm", limits={"velocity": "100 mm/s"}))
    assert "it more time or a wider limit" in text


def test_fronts_and_arrays() -> None:
    front = pareto_front(Problem(order=3), over=("B", "C"), points=3, between=(1.6, 1.8))
    assert checked(front)[0].count("<svg") == 1
    surface = pareto_front(Problem(order=3), over=("B", "C", "J"), points=4, between=(1.6, 1.8))
    assert checked(surface)[0].count("<svg") == 0
    laws = synthesize_array(ProblemArray(B=np.array([1.05, 1.7, 1.8]), order=4))
    assert "infeasible" in checked(laws)[1]


def test_titles_and_facts_are_escaped() -> None:
    assert "<i>" not in page("<i>", facts({"<i>": "<i>"}))
