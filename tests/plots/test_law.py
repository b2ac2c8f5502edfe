"""What is drawn of laws, solutions and fronts."""

import subprocess
import sys

import numpy as np
import pytest
from matplotlib.figure import Figure

from optlaws import (
    Chebyshev,
    InputError,
    Problem,
    catalogue,
    pareto_front,
    proven_front,
    smoothstep,
)
from tests.internals.laws import law_panels
from tests.internals.plots import DISTINCT, draw_front, shades


def axes(count: int) -> np.ndarray:
    return np.ravel(Figure().subplots(1, count))


def test_without_matplotlib_drawing_says_what_is_missing_and_all_else_works() -> None:
    script = (
        "import sys\nsys.modules['matplotlib'] = None\nimport optlaws\n"
        "cycle = optlaws.Cycle([optlaws.Rise('35 mm', law='cycloidal'), optlaws.Return()], period='1 s')\n"
        "cycle.export('csv', points=9)\n"
        "try:\n    optlaws.smoothstep(3).plot()\n"
        "except optlaws.InputError as error:\n    print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert done.stdout == "drawing needs matplotlib: pip install matplotlib (or uv pip install ...)\n"


def test_a_law_is_drawn_as_it_is_with_its_peaks_marked() -> None:
    law = catalogue["modified sine"].law
    panels = axes(4)
    artists = law.plot(panels, color="red")
    assert {artist.axes for artist in artists} == set(panels)
    for nu, panel in enumerate(panels):
        k, values = panel.lines[0].get_data()
        assert panel.lines[0].get_color() == "red"
        assert np.allclose(values, law(k, nu), rtol=0.0, atol=1e-9)
    places, heights = panels[2].lines[-1].get_data()
    assert places == pytest.approx([0.875, 0.125])
    assert heights == pytest.approx([-law.constants.C.value, law.constants.C.value])


def test_a_jump_is_a_gap_with_both_its_sides() -> None:
    law = catalogue["constant acceleration"].law
    k, c, *_ = law_panels(law, "c")[0].series[0]
    (gap,) = np.flatnonzero(np.isnan(c))
    assert k[gap - 1 : gap + 2].tolist() == [0.5, 0.5, 0.5]
    assert c[[gap - 1, gap + 1]] == pytest.approx([4.0, -4.0])
    panels = axes(4)
    law.plot(panels)
    sides = [line for line in panels[2].lines if line.get_markerfacecolor() == "white"]
    assert [line.get_ydata().tolist() for line in sides] == [[4.0, -4.0]]
    assert "inf" in panels[3].get_title(loc="left")


@pytest.mark.parametrize("name", list(catalogue))
def test_every_law_of_the_catalogue_can_be_drawn(name: str) -> None:
    law = catalogue[name].law
    for nu, panel in enumerate(law_panels(law, "abcj")):
        k, values, *_ = panel.series[0]
        assert np.all(np.diff(k) >= 0.0)
        # a gap lies between two samples, and every jump has one
        gaps = np.flatnonzero(np.isnan(values[1:-1])) + 1
        assert not np.isnan(values[np.concatenate([gaps - 1, gaps + 1])]).any() or not np.isfinite(law.peak(nu).value)
        assert {place for place, _ in law.jumps(nu)} <= set(k[gaps].tolist())


def test_all_in_one_pair_of_axes_is_divided_by_the_peaks() -> None:
    (panel,) = axes(1)
    artists = smoothstep(3).plot(panel)
    assert [line.get_label() for line in artists] == ["a", "b / 1.875", "c / 5.7735", "j / 60"]
    assert all(np.abs(line.get_ydata()).max() == pytest.approx(1.0, abs=1e-4) for line in artists)


def test_a_front_is_drawn_into_the_axes_given() -> None:
    front = pareto_front(Problem(order=3, basis=Chebyshev(5)), points=3)
    (panel,) = axes(1)
    points, below, between = front.plot(panel, color="green")
    assert {each.axes for each in (points, below, between)} == {panel}
    assert np.allclose(np.transpose(points.get_data()), front.values)
    assert points.get_linewidth() == 0.0
    assert np.allclose(below.get_ydata(), [point.lower_bound for point in front])
    ends = np.array(between.get_segments())
    assert np.allclose(ends[:, :, 1], [[point.lower_bound, point.objective] for point in front])


def test_fronts_in_one_panel_are_named_apart() -> None:
    (panel,) = axes(1)
    for order in (3, 4):
        pareto_front(Problem(order=order, basis=Chebyshev(5)), points=3).plot(panel)
    proven = proven_front(Problem(order=5, basis=Chebyshev(5)), between=(1.8, 1.9), gap=1e-3)
    curve, _ = proven.plot(panel)
    assert curve.get_linewidth() > 0.0
    names = [text.get_text() for text in panel.get_legend().get_texts()]
    assert names == ["order 3, Chebyshev(degree=5)", "lower bound"] + [
        f"order {order}, Chebyshev(degree=5)" for order in (4, 5)
    ]


def test_other_axes_are_refused() -> None:
    with pytest.raises(InputError, match="one pair of axes or into four, got 3"):
        smoothstep(3).plot(axes(3))


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
