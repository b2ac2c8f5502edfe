"""Cycles as data, problem files, tables and lines; at another speed, at angles with units, in one pair of axes."""

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from optlaws import (
    Chebyshev,
    ConstantVelocity,
    Cycle,
    Dwell,
    Free,
    InputError,
    Machine,
    Move,
    Problem,
    Return,
    Rise,
    smoothstep,
    synthesize,
)
from tests.documents import ROOT
from tests.internals.cli import exit_code
from tests.internals.files import reading
from tests.internals.jobs import read_of_cycle_entries as read

PRESS = Cycle(
    [Rise("35 mm", "120 deg", name="up"), Dwell("90 deg"), Return("35 mm", "100 deg", law="modified sine"), Dwell()],
    speed="200 rpm",
    limits={"velocity": "740 mm/s"},
    drive={"mass": "2 kg"},
)
SHEAR = Cycle([ConstantVelocity("1.5 m/s", "80 ms"), Return()], period="400 ms", degree=15)
TURNING = Cycle([Free("30 mm", via=[("0.1 s", "10 mm")], duration="0.2 s"), Free("-30 mm")], period="0.5 s")
AWAY_AND_BACK = Cycle(
    [Free("30 mm", "0.1 s"), Dwell("50 ms"), Free("0 mm", "0.1 s", via=[("50 ms", "45 mm")]), Free("-30 mm")],
    period="0.5 s",
    degree=5,
)


@pytest.mark.sample(3)
@pytest.mark.parametrize("cycle", [PRESS, SHEAR, TURNING], ids=["press", "shear", "turning"])
def test_a_cycle_goes_through_json_and_a_problem_file(cycle: Cycle, tmp_path: Path) -> None:
    again = Cycle.from_json(cycle.to_json())
    assert again.to_dict() == cycle.to_dict()
    assert again.objective == pytest.approx(cycle.objective, rel=1e-12)
    file = tmp_path / "cycle.toml"
    file.write_text(cycle.to_toml("Of a cycle", axis="slide"), "utf-8")
    _, cycles = read(reading.toml(file), file)
    assert cycles["slide"].objective == pytest.approx(cycle.objective, rel=1e-12)
    assert cycles["slide"].to_dict() == cycle.to_dict()


def test_laws_and_machines_that_are_values_are_kept_as_data() -> None:
    machine = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"])
    cycle = Cycle([Rise("35 mm", "0.1 s", law=smoothstep(4)), Return()], period="0.3 s", load=machine)
    again = Cycle.from_json(cycle.to_json())
    assert again.pieces[0].law == smoothstep(4)
    assert again.load == machine
    with pytest.raises(InputError, match="load: a problem file takes a mass on a spring only"):
        cycle.to_toml()


def test_a_law_that_is_a_value_goes_through_a_problem_file(tmp_path: Path) -> None:
    harmonic = synthesize(Problem(order=3, basis=Chebyshev(9), B=1.75)).law
    laws = [smoothstep(4), harmonic, PRESS.pieces[0].law]
    moves = [Move("10 mm", "60 deg", law=law, name='a "quoted" name') for law in laws]
    cycle = Cycle([*moves, Return(law="cycloidal")], speed="200 rpm")
    file = tmp_path / "cycle.toml"
    file.write_text(cycle.to_toml(axis="slide"), "utf-8")
    again = read(reading.toml(file), file)[1]["slide"]
    assert [piece.law for piece in again.pieces] == [piece.law for piece in cycle.pieces]
    assert [again.peak(nu) for nu in range(4)] == [cycle.peak(nu) for nu in range(4)]
    # and as often as it is written
    assert again.to_toml(axis="slide") == cycle.to_toml(axis="slide")


@pytest.mark.parametrize(
    ("data", "says"),
    [
        ({}, "a stored cycle needs its segments"),
        ({"segments": [], "format": "other"}, "format 'optlaws cycle 1', got 'other'"),
        ({"segments": [{"kind": "dwel"}]}, "segment 1: unknown kind of a segment 'dwel'; did you mean 'dwell'"),
        ({"segments": [{"kind": "dwell", "by": "3 mm"}]}, "segment 1: unknown entry of a dwell 'by'; known are"),
        (
            {"segments": [{"kind": "dwell"}], "sped": "3 rpm"},
            "unknown entry of a stored cycle 'sped'; did you mean",
        ),
    ],
)
def test_what_is_no_stored_cycle_is_refused(data: dict[str, Any], says: str) -> None:
    with pytest.raises(InputError, match=says):
        Cycle.from_dict(data)


def test_the_same_motion_at_another_speed() -> None:
    for cycle in (PRESS, SHEAR, TURNING, AWAY_AND_BACK):
        fast = cycle.at("400 rpm")
        share = 0.15 / cycle.duration
        for nu in range(1, 4):
            assert fast.peak(nu) == pytest.approx(cycle.peak(nu) / share**nu, rel=1e-9)
        assert fast(0.2 * 0.15) == pytest.approx(cycle(0.2 * cycle.duration))
    assert [segment.label for segment in AWAY_AND_BACK.at("400 rpm").segments] == [
        "Free",
        "Dwell",
        "Free",
        "Free",
        "Free",
    ]
    with pytest.raises(InputError, match="speed must be an angular velocity"):
        PRESS.at("400 mm")


def test_a_line_angles_with_units_and_a_table_of_segments() -> None:
    assert repr(PRESS) == "Cycle([up, Dwell, Return, Dwell], period=0.3 s, minimise='acceleration')"
    many = Cycle([Move("1 mm", law="cycloidal"), *[Dwell("1 deg")] * 8], speed="60 rpm", advance="1 mm")
    assert "and 3 more" in repr(many)
    assert PRESS.at_angle("0.25 rad", 1) == pytest.approx(PRESS.at_angle(np.degrees(0.25), 1))
    with pytest.raises(InputError, match="angle must be an angle"):
        PRESS.at_angle("3 mm")
    frame = PRESS.to_pandas()
    assert frame["segment"].tolist() == ["up", "Dwell", "Return", "Dwell"]
    assert frame["peak velocity, m/s"].max() == pytest.approx(PRESS.peak(1))
    assert frame["duration, s"].sum() == pytest.approx(0.3)


def test_all_is_drawn_into_one_pair_of_axes_with_the_limits() -> None:
    axes = Figure().subplots()
    artists = PRESS.plot(axes)
    curves = [line for line in axes.lines if "/" in str(line.get_label())]
    assert len(curves) == 4
    assert {artist.axes for artist in artists} == {axes}
    assert all(np.abs(np.asarray(line.get_ydata())).max() == pytest.approx(1.0, rel=1e-6) for line in curves)
    assert any(line.get_linestyle() == "--" for line in axes.lines)
    with pytest.raises(InputError, match="one pair of axes or into four, got 2"):
        PRESS.plot(list(Figure().subplots(2, 1)))


@pytest.mark.skipif(os.geteuid() == 0 and not Path("/dev/null").exists(), reason="needs a place that takes no folder")
def test_results_that_could_not_be_written_are_refused_before_solving(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    file = ROOT / "problems" / "cycle_press.toml"
    study = tmp_path / "study.toml"
    study.write_text("[problem]\norder = 3\n", "utf-8")
    assert exit_code(["study", str(study), "--out", "/dev/null/there"]) == 2
    assert "cannot write /dev/null/there" in capsys.readouterr().err
    for command in ("run", "cycle"):
        assert exit_code([command, str(file), "--out", "/dev/null/there"]) == 2
        assert "cannot write /dev/null/there" in capsys.readouterr().err


def test_a_law_is_given_by_its_json_text_in_files_too(tmp_path: Path) -> None:
    law = smoothstep(4)
    cycle = Cycle([Rise("35 mm", "0.1 s", law=law.to_json()), Return(law="cycloidal")], period="0.3 s")
    assert cycle.pieces[0].law == law
    file = tmp_path / "stored.toml"
    file.write_text(cycle.to_toml(), "utf-8")
    assert read(reading.toml(file), file)[1]["axis"].pieces[0].law == law
    with pytest.raises(InputError, match=r"segment 1 \(Rise\): law: a law must be JSON text"):
        Cycle([Rise("35 mm", "0.1 s", law="{"), Return(law="cycloidal")], period="0.3 s")
