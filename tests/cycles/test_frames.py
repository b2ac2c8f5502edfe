"""The frame of a table: where its rows begin in a turn, one lobe of several, and rows that are no turn."""

import json
from pathlib import Path

import numpy as np
import pytest

from optlaws import InputError, catalogue, read_cycle_table, split_table
from tests.internals.cli import exit_code

CYCLOIDAL = catalogue["cycloidal"].law
DEGREES = np.arange(0.0, 360.0, 2.0)


def lift(degrees: np.ndarray) -> np.ndarray:
    """A rise from 60 to 180 deg and a return from 200 to 320 deg."""
    return 20.0 * np.asarray(
        CYCLOIDAL(np.clip((degrees - 60) / 120, 0, 1)) - CYCLOIDAL(np.clip((degrees - 200) / 120, 0, 1))
    )


def test_rows_that_begin_anywhere_in_a_turn_go_on_over_its_end() -> None:
    """Rows from 340 deg on, through 0, to 338 deg: the printed angles fall once."""
    printed = np.roll(DEGREES, -170)
    table = split_table(printed, np.round(lift(printed), 4), digit=1e-4)
    assert (table.places[0], table.places[-1]) == (340.0, 700.0)
    assert [part.stop for part in table.stretches] == pytest.approx([420.0, 540.0, 560.0, 680.0, 700.0], abs=1e-6)
    assert "the cycle begins at 340 deg of its master" in str(table)
    cycle = table.cycle(speed="60 rpm")
    assert 1e3 * np.asarray(cycle.at_angle((DEGREES - 340.0) % 360.0)) == pytest.approx(lift(DEGREES), abs=1e-3)
    with pytest.raises(InputError, match=r"must increase, and 0 follows 358 \(rows 180 and 181 of its points\)"):
        split_table([*DEGREES, *DEGREES], [*lift(DEGREES), *lift(DEGREES)])


def test_a_table_that_moves_where_it_begins_is_read_from_a_rest_on() -> None:
    """The first row is in the midst of the return, which is whole in a cycle that begins in a rest."""
    x = np.append(DEGREES, 360.0)
    y = np.round(lift((x + 250.0) % 360.0), 4)
    table = split_table(x, y, digit=1e-4, begin=131.0)
    assert [part.law for part in table.stretches] == [None, "cycloidal", None, "cycloidal", None]
    assert [part.stop for part in table.stretches] == pytest.approx([170.0, 290.0, 310.0, 430.0, 492.0], abs=1e-6)
    cycle = table.cycle(speed="60 rpm")
    assert 1e3 * np.asarray(cycle.at_angle((x - 132.0) % 360.0)) == pytest.approx(y, abs=1e-3)
    with pytest.raises(InputError, match="begin must be from 0 to 360, in the turn, got 400"):
        split_table(x, y, begin=400.0)
    assert "it moves where it begins: its moves are whole where begin is 120 deg, in a rest" in str(
        split_table(x, y, digit=1e-4)
    )


def test_a_turn_of_another_length_is_to_be_said() -> None:
    table = split_table(2.0 * DEGREES, np.round(lift(DEGREES), 4), digit=1e-4)
    with pytest.raises(
        InputError, match=r"go over 716 deg, and a turn of the master is 360: say by turn how long it is"
    ):
        table.cycle(speed="60 rpm")


def test_a_table_may_begin_below_zero(tmp_path: Path) -> None:
    """Whole numbers from -10000 to 10000 as controllers of electronic cams take them, a sine of 500 over the turn."""
    x = np.linspace(-10000.0, 10000.0, 41)
    lines = (f"{place:.0f}\t{1000 + 500 * np.sin(2e-4 * np.pi * (place / 2 + 5000)):.0f}" for place in x)
    (tmp_path / "ecam.txt").write_text("\n".join(lines), encoding="utf-16")
    table = read_cycle_table(tmp_path / "ecam.txt", master="0.001 mm", unit="0.001 mm")
    assert [part.kind for part in table.stretches] == ["rise", "return", "rise"]
    assert [part.stop for part in table.stretches] == pytest.approx([-5.0, 5.0, 10.0], abs=0.01)
    assert table.peaks[1].holds(0.5 * (2 * np.pi / 20) ** 2)
    assert table.cycle(period="1 s").peak(2) == pytest.approx(0.5e-3 * (2 * np.pi) ** 2, rel=0.01)


def test_one_lobe_of_several_is_a_turn() -> None:
    """An eighth of a turn of a dial that advances by 45 deg in each, without the last row."""
    x = np.arange(0.0, 45.0, 0.5)
    table = split_table(
        x, np.round(45 * CYCLOIDAL(np.clip((x - 5) / 30, 0, 1)), 4), digit=1e-4, unit="deg", lobes=8, advance=360.0
    )
    moves = [part for part in table.stretches if part.law is not None]
    assert [part.law for part in moves] == ["cycloidal"] * 8
    assert [part.start for part in moves] == pytest.approx([5.0 + 45.0 * i for i in range(8)])
    assert [len(table.stretches), len(table.places), table.places[-1], table.heights[-1]] == [17, 721, 360.0, 360.0]
    cycle = table.cycle(speed="60 rpm")
    assert cycle.duration == pytest.approx(1.0)
    assert cycle.peak(2) == pytest.approx(2 * np.pi * np.radians(45.0) * 12.0**2)
    with pytest.raises(InputError, match=r"the rows go over 44.5 of the master, more than a turn of 36: give a longer"):
        split_table(x, x, lobes=10)
    with pytest.raises(InputError, match="lobes must be an integer"):
        split_table(x, x, lobes=0)


def test_lobes_of_stated_functions_and_of_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = [(0.0, 0.0), (60.0, 12.0), (90.0, 12.0), (120.0, 0.0)]
    point = "(MasterPos := {}, SlavePos := {}, SlaveVelo := 0.0, SlaveAcc := 0.0, SlaveJerk := 0.0, FunctionType := 15)"
    file = tmp_path / "cam.st"
    file.write_text("\n".join(point.format(*row) for row in rows))
    table = read_cycle_table(file, lobes=3)
    assert [(part.kind, part.stop) for part in table.stretches][3:6] == [
        ("rise", 180.0),
        ("dwell", 210.0),
        ("return", 240.0),
    ]
    assert table.cycle(speed="60 rpm").peak(2) == pytest.approx(12e-3 * 10 / np.sqrt(3) * 12.0**2)
    assert exit_code(["cycle", str(file), "--lobes", "3", "--speed", "60rpm"]) == 0
    assert "return 330 360 -12 3-4-5 polynomial" in " ".join(capsys.readouterr().out.split())
    with pytest.raises(InputError, match=r"cam\.st: the rows go over 120 of the master, more than a turn of 90"):
        read_cycle_table(file, lobes=4)


@pytest.mark.parametrize("damage", ["12;3,x", "12;", "12;1,234.5", "12;3;4", "6;3"])
def test_nothing_is_written_of_a_damaged_table(
    damage: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    lines = [f"{angle:.0f};{height:.3f}" for angle, height in zip(DEGREES, lift(DEGREES), strict=True)]
    Path("cam.csv").write_text("\n".join([*lines[:6], damage, *lines[7:]]))
    ways = (
        ["--save", "cam.toml"],
        ["--export", "csv"],
        ["--plot", "cam.svg"],
        ["--modernise", "0.1mm", "--save", "b.toml"],
    )
    for way in ways:
        assert exit_code(["cycle", "cam.csv", "--speed", "60rpm", *way]) == 2
        assert "line" in (error := capsys.readouterr().err)
        assert " 7" in error
    assert [file.name for file in tmp_path.iterdir()] == ["cam.csv"]


def test_better_laws_are_saved_with_their_proofs_and_saved_again_unless_they_change(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("cam.csv").write_text("\n".join(f"{x:g};{y:.3f}" for x, y in zip(DEGREES, lift(DEGREES), strict=True)))
    ways = ["cycle", "cam.csv", "--speed", "60rpm", "--save", "new.toml", "--modernise"]
    assert exit_code([*ways, "0.1mm"]) == 0
    assert "proofs: new.json" in capsys.readouterr().out
    assert exit_code([*ways, "0.1mm", "--json"]) == 0
    written = json.loads(capsys.readouterr().out)
    assert (written["saved"], written["proofs"]) == ("new.toml", "new.json")
    assert exit_code([*ways, "0.2mm"]) == 2
    assert "there is new.toml" in capsys.readouterr().err
    assert exit_code(["verify", "new.json"]) == 0
    assert capsys.readouterr().out.count(" claims are proven") == 2
    assert exit_code([*ways, "0.1"]) == 2
    assert "without a unit" in capsys.readouterr().err


def test_positions_go_on_where_their_encoder_begins_again() -> None:
    x, law = np.arange(0.0, 360.0, 1.5), catalogue["cycloidal"].law
    swing = 25.0 * (law(np.clip((x - 40.0) / 80.0, 0, 1)) - law(np.clip((x - 180.0) / 90.0, 0, 1)))
    rocking, plain = (split_table(x, np.round(y, 4), unit="deg") for y in ((350.0 + swing) % 360.0, 350.0 + swing))
    assert str(rocking) == str(plain)
    assert [part.law for part in rocking.moves] == ["cycloidal"] * 2
    table = split_table(x, np.round((100.0 + 3.0 * x + swing) % 360.0, 4), unit="deg")
    assert table.seam == pytest.approx(1080.0, abs=2.0)
    indexing = 3.0 * law(np.clip((x - 40.0) / 200.0, 0, 1))
    assert split_table(x[::20], indexing[::20], unit="turn").heights[-1] == 3.0


@pytest.mark.sample(4)
@pytest.mark.parametrize("seed", range(8))
def test_a_noisy_turn_whose_last_row_is_missing_is_whole(seed: int) -> None:
    x, law = np.arange(720.0) / 2.0, catalogue["modified sine"].law
    lift = 2.0 * (law(np.clip((x - 30.0) / 100.0, 0.0, 1.0)) - law(np.clip((x - 190.0) / 90.0, 0.0, 1.0)))
    table = split_table(x, np.round(lift + np.random.default_rng(seed).normal(0.0, 0.01, 720), 3), digit=1e-3)
    assert table.stretches[-1].stop == 360.0
    assert table.cycle(speed="60 rpm").duration == 1.0


def test_rows_that_are_missing_in_a_move_are_named_and_bound_no_peak() -> None:
    x, law = np.linspace(0.0, 360.0, 721), catalogue["modified sine"].law
    lift = 20.0 * (law(np.clip((x - 30.0) / 100.0, 0.0, 1.0)) ** 2 - law(np.clip((x - 190.0) / 90.0, 0.0, 1.0)))
    left = (x <= 70.0) | (x >= 100.0)
    y = np.round(lift + np.random.default_rng(2).normal(0.0, 1e-3, 721), 4)
    table = split_table(x[left], y[left], digit=1e-4)
    assert "no points are from 70 to 100 deg: between them is what goes on best" in str(table)
    rise, back = table.moves
    assert not rise.peaks[1].is_known
    assert back.peaks[1].is_known
    assert "no points" not in str(split_table(x, y, digit=1e-4))


def test_a_turn_in_rounded_radians_is_one_turn() -> None:
    """Rows to 6.2832 rad, which is more than 2π by rounding, were read and then refused as a cycle."""
    x = np.linspace(0.0, 2.0 * np.pi, 361)
    k = np.degrees(x)
    law = catalogue["modified sine"].law
    y = 20.0 * (law(np.clip((k - 30.0) / 100.0, 0.0, 1.0)) - law(np.clip((k - 200.0) / 90.0, 0.0, 1.0)))
    cycle = split_table(np.round(x, 4), np.round(y, 4), master="rad").cycle(speed="200 rpm")
    assert cycle.duration == pytest.approx(0.3, rel=1e-12)
    without_end = split_table(np.round(x[:-1], 4), np.round(y[:-1], 4), master="rad")
    assert without_end.cycle(speed="200 rpm").duration == pytest.approx(0.3, rel=1e-12)
    assert np.abs(1e3 * cycle.at_angle(np.arange(0.0, 360.0)) - y[:-1]).max() < 3e-3
