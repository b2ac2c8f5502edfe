"""Tables of whole cycles: their parts, the laws that they are, and better ones within a tolerance."""

from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import BPoly

from optlaws import Cycle, Dwell, InputError, Return, Rise, catalogue, read_cycle_table, smoothstep, split_table
from tests.internals.cycles import OldTableReport, law_of_move, nothing_to_better, points_in

PROGRAMME = [Rise("35 mm", "120 deg"), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()]


def table(rise: str, back: str, digits: int, step: float = 1.0, lead: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    x = np.arange(0.0, 360.0 + 0.5 * step, step)
    up = catalogue[rise].law(np.clip((x - lead) / 120.0, 0.0, 1.0))
    down = catalogue[back].law(np.clip((x - lead - 210.0) / 100.0, 0.0, 1.0))
    return x, np.round(35.0 * (up - down), digits)


@pytest.mark.sample(3)
@pytest.mark.parametrize("lead", [0.0, 20.0])
@pytest.mark.parametrize("digits", [2, 4])
@pytest.mark.parametrize("laws", [("modified sine", "cycloidal"), ("3-4-5 polynomial", "modified trapezoid")])
def test_standard_laws_and_their_ends_are_recognised(laws: tuple[str, str], digits: int, lead: float) -> None:
    split = split_table(*table(*laws, digits, lead=lead), digit=10.0**-digits)
    moves = [part for part in split.stretches if part.law is not None]
    assert [part.kind for part in moves] == ["rise", "return"]
    assert [part.law for part in moves] == list(laws)
    ends = [end for part in moves for end in (part.start, part.stop)]
    assert ends == pytest.approx([lead, lead + 120.0, lead + 210.0, lead + 310.0], abs=0.3 if digits == 2 else 1e-9)
    assert [round(part.stroke, digits) for part in moves] == [35.0, -35.0]
    cycle = split.cycle(speed="200 rpm")
    x, y = table(*laws, digits, lead=lead)
    assert 1000.0 * np.asarray(cycle.at_angle(x[:-1])) == pytest.approx(y[:-1], abs=2.0 * split.room)


def test_a_law_of_nobody_is_fitted_and_bettered() -> None:
    law = smoothstep(6)
    x = np.arange(361.0)
    y = np.round(35.0 * (law(np.clip(x / 120.0, 0.0, 1.0)) - law(np.clip((x - 200.0) / 120.0, 0.0, 1.0))), 4)
    split = split_table(x, y, digit=1e-4)
    moves = [part for part in split.stretches if part.law is not None]
    assert [part.kind for part in moves] == ["rise", "return"]
    assert not any(isinstance(part.law, str) for part in moves)
    assert all(part.distance > split.room for part in moves)
    old, new = split.cycle(speed="100 rpm"), split.modernised(0.3, speed="100 rpm")
    assert 1000.0 * np.abs(np.asarray(new.at_angle(x)) - np.asarray(old.at_angle(x))).max() < 0.31
    greatest = [max(abs(np.asarray(cycle.at_angle(np.linspace(0.0, 360.0, 3601), 2)))) for cycle in (old, new)]
    assert greatest[1] < 0.9 * greatest[0]


def test_noise_and_a_seam_are_reported() -> None:
    x, y = table("cycloidal", "cycloidal", 6)
    noisy = y + np.random.default_rng(1).normal(0.0, 0.01, len(y))
    noisy[-20:] += 0.2
    split = split_table(x, noisy)
    assert split.scatter == pytest.approx(0.01, rel=0.3)
    assert split.seam == pytest.approx(0.2, abs=0.08)
    assert "scatter by" in str(split)
    assert "from the first one" in str(split)


def test_a_file_of_a_cycle_is_read(tmp_path: Path) -> None:
    x, y = table("modified sine", "cycloidal", 3)
    file = tmp_path / "old.csv"
    file.write_text("degree;mm\n" + "\n".join(f"{a:g};{b:.3f}".replace(".", ",") for a, b in zip(x, y, strict=True)))
    split = read_cycle_table(file)
    assert [part.law for part in split.stretches] == ["modified sine", None, "cycloidal", None]
    assert split.cycle(speed="200 rpm").duration == pytest.approx(0.3)
    whole = Cycle(PROGRAMME, speed="200 rpm")
    assert split.cycle(speed="200 rpm").duration == whole.duration


@pytest.mark.parametrize(
    ("above", "separator", "units"),
    [
        ("# deg,in", ",", ("deg", "in")),
        ("# angle [deg], lift [in]", ",", ("deg", "in")),
        ("an old cam\n// deg m\n", " ", ("deg", "m")),
        ("# an old one in m", " ", ("deg", "mm")),
        ("# by hand,in m", ",", ("deg", "m")),
        ("", ",", ("deg", "mm")),
    ],
)
def test_a_heading_may_be_a_comment(tmp_path: Path, above: str, separator: str, units: tuple[str, str]) -> None:
    x, y = table("modified sine", "cycloidal", 3)
    file = tmp_path / "old.csv"
    rows = [f"{a:g}{separator}{b:.3f}" for a, b in zip(x, y, strict=True)]
    file.write_text("\n".join([above, *rows]))
    read = read_cycle_table(file)
    assert (read.master, read.unit) == units
    assert ("without a unit, taken as mm" in read.layout) == (units[1] == "mm")


@pytest.mark.parametrize(
    ("heading", "size", "unit"),
    [
        ("deg,stroke [mm/10]", 0.1, "mm"),
        ("deg,lift 1/100 mm", 0.01, "mm"),
        ("deg,lift x0.01mm", 0.01, "mm"),
        ("deg;lift [0,01 mm]", 0.01, "mm"),
        ("deg,lift [10⁻² mm]", 0.01, "mm"),
        ("φ / °,s / mm", 1.0, "mm"),
        ("Winkel [Grad],Hub [µm]", 1.0, "µm"),
        ("deg,dm", 1.0, "dm"),
        ("deg,Hub 40 mm", 1.0, "mm"),
        ("angle,lift (old)", 1.0, "mm without a known unit in 'lift (old)'"),
        ("deg,furlong", 1.0, "mm without a known unit in 'furlong'"),
        ("winkel,hub", 1.0, "mm without a known unit in 'hub'"),
        ("x,s", 1.0, "mm without a known unit in 's'"),
    ],
)
def test_a_heading_says_what_its_numbers_count(tmp_path: Path, heading: str, size: float, unit: str) -> None:
    file, (x, y) = tmp_path / "old.csv", table("modified sine", "cycloidal", 3)
    separator = ";" if ";" in heading else ","
    file.write_text("\n".join([heading, *(f"{a:g}{separator}{b:.3f}" for a, b in zip(x, y, strict=True))]), "utf-8")
    points = points_in(file.read_text("utf-8"), file)
    known, _, without = unit.partition(" ")
    assert points.units == ("deg", known)
    assert points.heights == pytest.approx(size * np.round(y, 3), rel=1e-12)
    assert points.layout == (f"columns of numbers {without}, taken as mm" if without else "columns of numbers")


@pytest.mark.parametrize(
    ("heading", "says"),
    [
        ("deg,lift [furlong]", "'furlong' is no unit that is known here: .* such as unit = '0.01 mm'"),
        ("deg,lift [-]", "'-' is no unit"),
        ("deg,lift (x 0.01)", "'x 0.01' is no unit"),
        ("deg,lift [mm/s]", "not clear what is counted"),
        ("deg,lift mm/deg", "not clear what is counted"),
        ("deg,lift mm*100", "not clear what is counted"),
        ("deg,lift 10 µm", "not clear what is counted"),
        ("deg,Grad", "Grad is a degree or 1/400 of a turn: say which, by unit = 'deg' or unit = 'gon'"),
        ("steps,mm", "heading 'steps': numbers are counts: .* such as master = '0.9 deg'"),
    ],
)
def test_a_heading_that_does_not_say_what_its_numbers_count_is_refused(tmp_path: Path, heading: str, says: str) -> None:
    file = tmp_path / "old.csv"
    x, y = table("cycloidal", "cycloidal", 3)
    file.write_text("\n".join([heading, *(f"{a},{b:.3f}" for a, b in zip(x, y, strict=True))]), "utf-8")
    with pytest.raises(InputError, match=says):
        points_in(file.read_text("utf-8"), file)
    assert points_in(file.read_text("utf-8"), file, unit="0.01 mm", master="deg").units == ("deg", "mm")


@pytest.mark.parametrize("heading", ["gon", "angle [gon]", "grad", "Winkel [Grad]"])
def test_a_turn_may_have_400_gon(tmp_path: Path, heading: str) -> None:
    """A table without the row of its end; a master whose unit is not known is deg, which the layout says."""
    file, (x, y) = tmp_path / "old.csv", table("modified sine", "cycloidal", 3)
    rows = [f"{a / 0.9:.4f},{b:.3f}" for a, b in zip(x[:-1], y[:-1], strict=True)]
    file.write_text("\n".join([f"{heading},mm", *rows]))
    old = read_cycle_table(file)
    assert old.master == "gon"
    assert old.places[-1] == pytest.approx(400.0)
    assert old.layout == f"columns of numbers, {len(rows)} rows with the end of their turn added"
    assert old.cycle(speed="200 rpm").duration == pytest.approx(0.3)
    file.write_text("\n".join(["Winkel,mm", *rows]))
    assert "master without a known unit in 'Winkel', taken as deg" in points_in(file.read_text(), file).layout


@pytest.mark.parametrize(
    ("says", "x", "y"),
    [
        ("at least 12 points", [0.0, 1.0], [0.0, 1.0]),
        ("must increase", [*range(12), 3], [0.0] * 13),
        ("never moves", range(13), [1.0] * 13),
    ],
)
def test_what_is_no_cycle_is_refused(says: str, x: list[float], y: list[float]) -> None:
    with pytest.raises(InputError, match=says):
        split_table(x, y)


@pytest.mark.parametrize(
    ("law", "what"),
    [
        ("constant velocity", "at constant velocity, without acceleration or jerk"),
        pytest.param("modified sine", "", marks=pytest.mark.long),
    ],
)
def test_a_move_without_acceleration_keeps_its_law(law: str, what: str) -> None:
    """A quarter sine up, and a way back whose law may have no acceleration."""
    x = np.arange(361.0)
    up = np.where(x <= 120.0, np.sin(0.5 * np.pi * np.minimum(x, 120.0) / 120.0), 1.0)
    down = catalogue[law].law(np.clip((x - 180.0) / 90.0, 0.0, 1.0))
    split = split_table(x, np.round(3.0 * (up - down), 3), digit=1e-3)
    better = split.bettered(0.05)
    back, after = (
        next(part for part in each.moves if part.kind == "return" and part.corner is None) for each in (split, better)
    )
    assert back.law == law
    assert nothing_to_better(law_of_move(back)) == what
    assert (after.law == law) is bool(what)
    for gain in better.gains(split):
        assert not gain.share(2) > 0.0
        assert gain.deviation <= 0.05 * (1.0 + 1e-9)


def test_the_whole_cycle_is_compared_where_corners_were_taken_away() -> None:
    """A tappet whose corners become smooth: an acceleration and a jerk in place of infinite ones."""
    x = np.arange(0.0, 361.0)
    old = split_table(x, np.interp(x, [60.0, 100.0, 200.0, 290.0], [0.0, 4.0, 4.0, 0.0]), digit=1e-3)
    new = old.bettered(0.05)
    whole = new.gain_of_cycle(old)
    assert whole.kind == "whole cycle"
    assert whole.old[1:] == (np.inf, np.inf)
    blends = [part for part in new.moves if part.corner is not None]
    steepest = max(
        abs(part.stroke) / (part.stop - part.start) ** 2 * law_of_move(part).peak(2).value for part in blends
    )
    assert whole.new[1] == pytest.approx(steepest, rel=1e-12)
    data = OldTableReport(old, new).data
    assert data["gain_of_cycle"]["new"] == pytest.approx(list(whole.new))
    assert data["old_stretches"] == OldTableReport(old).data["stretches"]
    assert len(data["stretches"]) > len(data["old_stretches"])
    assert [row[0] for row in OldTableReport(old, new).tables[1].rows[-3:]] == ["whole cycle", "", ""]


def test_a_cycle_that_is_harder_than_the_old_one_says_so() -> None:
    """A line that takes 10 deg to end in a rest: noise hides the most of its jerk, and shows some of others."""
    x = np.linspace(0.0, 360.0, 721)
    rise = BPoly.from_derivatives(
        [40.0, 100.0, 180.0, 190.0], [[0.0] * 3, [30.0, 0.05, 0.0], [34.0, 0.05, 0.0], [34.25, 0.0, 0.0]]
    )
    fall = smoothstep(2)(np.clip((x - 210.0) / 100.0, 0.0, 1.0))
    exact = rise(np.clip(x, 40.0, 190.0)) - 34.25 * np.asarray(fall)
    table = split_table(x, np.round(exact + np.random.default_rng(17).normal(0.0, 3e-3, 721), 3), digit=1e-3)
    assert not table.corners
    facts = "\n".join(map(str, OldTableReport(table, table.bettered(0.05)).facts))
    assert "the greatest jerk of the new cycle is" in facts
    assert "that of the old one above" in facts


@pytest.mark.parametrize("top", [180.0, 120.0])
def test_corners_of_a_triangle_are_taken_away_within_the_tolerance(top: float) -> None:
    """At equal slopes the velocity is 0 where the turn begins, so that a blend had a part without length."""
    x = np.arange(361.0)
    old = split_table(x, np.interp(x, [0.0, top, 360.0], [0.0, 10.0, 0.0]).round(3), digit=1e-3)
    new = old.bettered(0.05)
    assert new.corners == ()
    assert new.gain_of_cycle(old).deviation == pytest.approx(0.05, rel=1e-9)
    assert all(new.blend_in_words(part) for part in new.moves if part.corner is not None)
