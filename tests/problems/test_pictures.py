"""Pictures in results/ say what they show: curves named, tables of points told apart, axes with their units."""

import re
from collections.abc import Sequence

import numpy as np
import pytest

from optlaws import Problem, pareto_front
from problems.dwell_drawing import SHADES
from tests.documents import ROOT
from tests.internals.plots import DISTINCT, WARM, draw_front, shades


def texts(picture: str) -> list[str]:
    return re.findall(r"<!-- (.*) -->", (ROOT / "results" / f"{picture}.svg").read_text("utf-8"))


def markers(picture: str, face: str) -> int:
    """How many marks of points with a warm edge have this face."""
    content = (ROOT / "results" / f"{picture}.svg").read_text("utf-8")
    return len(re.findall(f'<use [^>]*style="fill: {face}; stroke: {WARM}"', content))


@pytest.mark.parametrize(
    ("picture", "labels"),
    [
        ("fronts/c-over-b-by-order", ("Savin", "smoothsteps", "modified sine", "best possible")),
        ("fronts/d-over-c", ("Savin", "smoothsteps", "modified sine", "best possible of each")),
        ("optimal_table/figure", ("peak velocity B", "Savin", "best possible")),
        ("savin_families/figure", ("family I", "family IV", "peak power D", "least of the family")),
        ("lever_nomogram/nomogram", [f"Rocker at its extreme, rho = {rho}" for rho in ("0.05", "0.15", "0.3")]),
    ],
)
def test_curves_are_named(picture: str, labels: Sequence[str]) -> None:
    found = "\n".join(texts(picture))
    assert all(label in found for label in labels)


def test_only_cubic_laws_of_the_printed_table_are_drawn_as_such() -> None:
    assert "laws of the paper with Z(k) of degree 3" in texts("optimal_table/figure")
    # of the thirteen laws those of B = 1.75, 2.078, 2.406, 2.461 and 2.5 are not; one more of each in the legend
    assert markers("optimal_table/figure", WARM) == 8 + 1
    assert markers("optimal_table/figure", "#ffffff") == 5 + 1


def test_curves_of_the_nomogram_are_named() -> None:
    assert texts("lever_nomogram/nomogram").count("beta") == 6


def test_limits_are_named_by_their_curves() -> None:
    labels = {f"best possible of each, {curve}" for curve in ("B = 1.641", "B free")}
    assert labels <= set(texts("fronts/d-over-c"))


@pytest.mark.parametrize("picture", ["optimal_polydyne/figure", "atlas/least-c", "atlas/least-d"])
def test_no_title_stands_twice(picture: str) -> None:
    titles = [text for text in texts(picture) if re.search("beside|of the cam,|degree of Z:|given B", text)]
    assert titles
    assert len(set(titles)) == len(titles)


def test_sections_of_a_dwell_have_a_colour_each_and_cams_a_scale() -> None:
    assert len(set(SHADES.values())) == len(SHADES)
    assert "stroke S" in texts("dwell_drawing/mechanism")


def test_axes_of_savins_families_are_dimensionless() -> None:
    labels = texts("savin_families/figure")
    assert sum("dimensionless" in text for text in labels) == 6


def test_colours_differ() -> None:
    assert len(set(DISTINCT)) == 6
    for count in range(1, 6):
        assert len(set(shades(count))) == count


def test_a_front_can_be_drawn_alone() -> None:
    front = pareto_front(Problem(order=3), ("B", "C"), points=3, between=(1.5, 1.8))
    line, *_ = draw_front(front)
    assert line.axes is not None
    assert line.axes.get_ylabel() == "peak acceleration C (dimensionless)"
    surface = pareto_front(Problem(order=3), ("B", "C", "J"), points=4, between=(1.5, 1.8))
    (points,) = draw_front(surface)
    assert len(np.asarray(points.get_array())) == len(surface)  # type: ignore[attr-defined]
