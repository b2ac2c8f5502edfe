"""Laws side by side, in Python and by `optlaws compare`, and the usual law beside a result."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from optlaws import (
    BarrelCam,
    Chebyshev,
    ConstantVelocity,
    Cycle,
    DiscCam,
    Drive,
    Dwell,
    Free,
    InputError,
    Mechanism,
    Motor,
    Move,
    Problem,
    Return,
    Rise,
    TranslatingRoller,
    at_most,
    catalogue,
    compare_laws,
    fastest,
    residual_vibration,
    smoothstep,
    synthesize,
)
from tests.internals.cams import barrel_differences
from tests.internals.cli import exit_code
from tests.internals.cycles import USUAL, usual_cycle
from tests.internals.shown import Difference, Differences

SINE = catalogue["modified sine"].law


def test_numbers_are_those_of_the_laws() -> None:
    comparison = compare_laws(
        "modified sine", smoothstep(3), stroke="35 mm", duration="100 ms", frequency=(12, 32), damping=0.05
    )
    sine, poly = comparison.rows
    assert (sine["law"], poly["law"]) == ("modified sine", "law 2")
    assert [sine[name] for name in "BCDJ"] == [getattr(SINE.constants, name).value for name in "BCDJ"]
    assert poly["velocity, m/s"] == pytest.approx(1.875 * 0.035 / 0.1)
    assert poly["jerk, m/s³"] == pytest.approx(60 * 0.035 / 0.1**3)
    assert sine["residual"] == residual_vibration(frequency=(12, 32), damping=0.05).value(SINE)
    turned = compare_laws(catalogue["modified sine"], stroke="180 deg", duration="1 s").rows[0]
    assert turned["acceleration, rad/s²"] == pytest.approx(np.pi * SINE.constants.C.value)


def test_a_mass_has_its_force_and_power_and_the_picture_the_units_of_the_machine() -> None:
    moved: dict[str, Any] = {"stroke": "35 mm", "duration": "0.1 s"}
    comparison = compare_laws(catalogue["modified sine"], **moved, mass="2 kg")
    (row,) = comparison.rows
    segments = [Rise("35 mm", "0.1 s", law="modified sine"), Dwell("0.1 s"), Return(duration="0.1 s")]
    rise = Cycle(segments, period="0.3 s").solve()
    assert row["force, N"] == pytest.approx(2.0 * 19.3478, rel=1e-4)
    torque = 2.0 * np.max(np.abs(np.multiply(*(rise(np.linspace(0.0, 0.1, 20001), nu) for nu in (1, 2)))))
    assert row["power, W"] == pytest.approx(torque, rel=1e-6)
    velocity = comparison.plot()[0].axes.figure.axes[1]
    assert (velocity.get_ylabel(), velocity.figure.axes[3].get_xlabel()) == ("velocity, m/s", "time, ms")
    assert np.nanmax(velocity.lines[0].get_ydata()) == pytest.approx(row["velocity, m/s"], rel=1e-6)
    assert np.nanmax(velocity.lines[0].get_xdata()) == pytest.approx(100.0)
    turned = compare_laws("modified sine", stroke="90 deg", duration="0.1 s", mass="0.3 kg m^2").rows[0]
    assert turned["torque, N m"] == pytest.approx(0.3 * np.pi / 2 * SINE.constants.C.value / 0.01)
    for wrong in ({"mass": "2 kg"}, {**moved, "mass": "2 kg m^2"}, {**moved, "mass": "0 kg"}):
        with pytest.raises(InputError, match=r"^mass "):
            compare_laws("modified sine", **wrong)


def test_the_optimum_beside_modified_sine() -> None:
    B, J = SINE.constants.B.value, SINE.constants.J.value
    nine, many = (synthesize(Problem(order=3, B=B, J=at_most(J), basis=Chebyshev(degree))) for degree in (9, 41))
    assert nine.status.value == many.status.value == "optimal"
    frame = compare_laws("modified sine", nine, many).to_pandas()
    assert frame["C"].round(3).tolist() == [5.528, 5.189, 4.903]
    assert frame["J"].to_numpy() == pytest.approx([J] * 3, rel=1e-9)
    assert frame["D"].round(2).tolist() == [5.46, 6.41, 7.22]
    assert nine.best_possible is not None
    assert round(nine.best_possible, 3) == 4.866


def test_what_a_small_C_costs_is_said() -> None:
    (remark,) = compare_laws("modified sine", "constant acceleration").remarks
    assert remark.startswith("constant acceleration: J = inf, without bound")
    assert compare_laws("constant acceleration", "modified sine").remarks == ()
    assert (
        compare_laws("cycloidal", "constant acceleration", frequency=6 * np.pi)
        .remarks[-1]
        .endswith("16; cycloidal has none")
    )


def test_all_laws_are_drawn_into_the_axes_given() -> None:
    from matplotlib.figure import Figure

    panels = Figure().subplots(4, 1)
    artists = compare_laws("modified sine", "cycloidal").plot(panels)
    assert {artist.axes for artist in artists} == set(panels)
    assert panels[2].lines[0].get_linestyle() != panels[2].lines[2].get_linestyle()


@pytest.mark.parametrize(
    ("laws", "given", "says"),
    [
        ((), {}, "no laws to compare"),
        (("cubic", "cubic"), {}, "given twice"),
        (("cubic",), {"stroke": "35 mm"}, "go together"),
        (("cubic",), {"stroke": "35 kg", "duration": "1 s"}, "mass"),
        (("cubic",), {"stroke": "0 mm", "duration": "1 s"}, "got .0 mm.: give how far the machine moves"),
        (("cubic",), {"stroke": "35 mm", "duration": "0 s"}, "duration"),
        (("cubic", 3), {}, "motion law"),
        (("cubic",), {"frequency": -1}, "frequency"),
    ],
)
def test_wrong_input_is_refused(laws: tuple[object, ...], given: dict[str, object], says: str) -> None:
    with pytest.raises(InputError, match=says):
        compare_laws(*laws, **given)  # type: ignore[arg-type] # wrong on purpose


def test_the_command_says_the_same(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    arguments = [
        "compare",
        "MODSINE",
        "III(7.2)",
        "--stroke",
        "35mm",
        "--time",
        "0.1s",
        "--frequency",
        "12",
        "--frequency",
        "32",
    ]
    assert exit_code([*arguments, "--json"]) == 0
    output = json.loads(capsys.readouterr().out)
    assert output == compare_laws("MODSINE", "III(7.2)", stroke="35 mm", duration="0.1 s", frequency=(12, 32)).to_dict()
    assert exit_code([*arguments, "--plot", str(tmp_path / "a.svg"), "--csv", str(tmp_path / "a.csv")]) == 0
    assert (tmp_path / "a.svg").is_file()
    assert (tmp_path / "a.csv").read_text("utf-8").count("\n") == 4
    assert f"{SINE.constants.C.value:.7g}" in capsys.readouterr().out


def test_a_cycle_stands_beside_modified_sine_in_the_same_moves() -> None:
    drive = Drive(Mechanism("2 kg m^2", coulomb="6 N m"), Motor("3e-4 kg m^2"), ratio=10)
    best, sine = (
        Cycle([Rise("90 deg", "0.4 s", law=law), Dwell()], period="1 s", advance="90 deg", drive=drive)
        for law in ("optimal", "modified sine")
    )
    report = best.report()
    table = report.tables[1]
    assert table.headings == ["what", "modified sine", "this law", "difference", "unit"]
    names = ["acceleration", "velocity", "jerk", "rms acceleration", "torque", "rms torque", "power", "energy"]
    # as files have them; pages write RMS
    assert [row[0] for row in table.rows] == [name.replace("rms", "RMS") for name in names]
    for name, (_, usual, chosen, text, unit) in zip(names, table.rows, strict=True):
        degrees = 180.0 / np.pi if unit == "deg/s" else 1.0
        values = [degrees * cycle.value(name) for cycle in (sine, best)]
        assert [usual, chosen] == pytest.approx(values, rel=1e-12)
        assert text == f"{100.0 * (chosen / usual - 1.0):+.1f} %"
    known = report.data["usual_law"]
    assert (known["name"], [each["name"] for each in known["values"]]) == ("modified sine", names)
    # given laws were not chosen by optlaws
    assert len(sine.report().tables) == 1
    assert "usual_law" not in sine.report().data


def test_the_usual_law_is_better_by_the_limits_that_it_breaks_or_for_its_degree() -> None:
    def remarks(**given: Any) -> list[str]:
        cycle = Cycle([RISE, Dwell("90 deg"), RETURN, Dwell()], speed="200 rpm", **given)
        return [row.value for row in cycle.summary() if "than these laws" in str(row.value)]

    fast = Cycle([RISE, Dwell("90 deg"), RETURN, Dwell()], speed="200 rpm", limits={"velocity": "0.55 m/s"})
    usual = usual_cycle(fast)
    assert usual is not None
    less = 100.0 * (1.0 - usual.peak(2) / fast.peak(2))
    taken = f"velocity, {1e3 * usual.peak(1):.5g} mm/s of 550 mm/s"
    better = f"modified sine has {less:.1f} % less acceleration than these laws"
    assert remarks(limits={"velocity": "0.55 m/s"}) == [f"{better}, but breaks a limit: segment 3 (Return): {taken}"]
    (poor,) = remarks(order=5, degree=3)
    assert poor.endswith("% less acceleration than these laws: give them a higher degree")


# --- the usual law ---


RISE, RETURN = Rise("35 mm", "120 deg"), Return("35 mm", "100 deg")


@pytest.mark.parametrize(
    "segments",
    [
        [Rise("35 mm", "120 deg", law=USUAL), Return(law=USUAL)],
        [Free("30 mm", "120 deg", via=[("60 deg", "10 mm")]), Return("30 mm", "120 deg"), Dwell()],
        [Move("20 mm", "100 deg", end_velocity="0.2 m/s"), ConstantVelocity("0.2 m/s", "40 deg"), Return()],
    ],
)
def test_there_is_none_where_all_moves_have_it_or_one_ends_otherwise_than_it_begins(segments: Any) -> None:
    assert usual_cycle(Cycle(segments, speed="200 rpm")) is None


def test_between_equal_velocities_it_is_added_to_the_uniform_motion() -> None:
    knife = [ConstantVelocity("1.5 m/s", "80 ms"), Return()]
    usual = usual_cycle(Cycle(knife, period="400 ms"))
    assert usual is not None
    beyond = 1.5 * 0.4  # what the return takes back beside the uniform motion
    assert usual.peak(2) == pytest.approx(SINE.constants.C.value * beyond / 0.32**2, rel=1e-9)
    times = np.linspace(0.08, 0.4, 9)
    law = SINE.a((times - 0.08) / 0.32)
    assert usual(times) == pytest.approx(0.12 + 1.5 * (times - 0.08) - beyond * law, abs=1e-12)
    started = Move("0.3 m", "0.2 s", start_velocity="1 m/s", end_velocity="1 m/s")
    moved = usual_cycle(Cycle([started, ConstantVelocity("1 m/s", "0.1 s")], period="0.3 s", advance="400 mm"))
    assert moved is not None
    assert moved.peak(2) == pytest.approx(SINE.constants.C.value * 0.1 / 0.2**2, rel=1e-9)
    # what ends where it begins has no law of stroke 1
    assert (
        usual_cycle(Cycle([ConstantVelocity("1 m/s", "0.1 s"), Move("0 m", "0.2 s")], period="0.3 s", advance="100 mm"))
        is None
    )


def test_a_difference_is_a_share_of_the_usual_value_and_nothing_of_0() -> None:
    values = [
        Difference("acceleration", "m/s²", 20.0, 19.0),
        Difference("residual", "m/s²", 0.0, 1.0),
        Difference("jerk", "m/s³", float("inf"), 3.0),
        Difference("prime circle", "mm", None, 50.0),
        Difference("stroke", "mm", 40.0, 40.0),
    ]
    assert [each.change for each in values[:4]] == [pytest.approx(-0.05), None, None, None]
    assert [each.text for each in values] == ["-5.0 %", "", "", "", "same"]
    beside = Differences(USUAL, values)
    assert [row.name for row in beside.rows] == ["acceleration", "residual", "jerk", "stroke"]
    assert beside.section().data["usual_law"]["values"][2]["usual"] is None
    assert not Differences(USUAL, []).section().heading


LIMITS = {"velocity": "1 m/s", "acceleration": ("-8 m/s^2", "12 m/s^2"), "jerk": "300 m/s^3"}


def beside_of(move: Any) -> dict[str, Any]:
    """The values beside modified sine, by their names."""
    return {each.name: each for each in move.beside.values}


@pytest.mark.parametrize("stroke", [0.02, 0.1, 0.6])
def test_a_least_time_stands_beside_the_closed_form_of_modified_sine(stroke: float) -> None:
    values = beside_of(fastest(Problem(order=3), stroke=f"{stroke} m", limits=LIMITS))
    known = SINE.constants
    terms = (known.B.value * stroke, (known.C.value * stroke / 8.0) ** 0.5, (known.J.value * stroke / 300.0) ** (1 / 3))
    assert values["least time"].usual == pytest.approx(max(terms), rel=1e-12)
    assert values["least time"].chosen < values["least time"].usual
    assert values["jerk"].usual == pytest.approx(known.J.value * stroke / max(terms) ** 3, rel=1e-12)


@pytest.mark.parametrize("most", [2.0, 0.05])  # the time that the second one takes is 3.4 times the least
def test_modified_sine_waits_until_a_vibration_is_within_its_limit(most: float) -> None:
    follower = {"frequency": ("13 Hz", "15 Hz"), "damping": 0.02}
    limits = {**LIMITS, "residual acceleration": f"{most} m/s^2"}
    values = beside_of(fastest(Problem(order=3), stroke="100 mm", follower=follower, limits=limits))
    assert values["residual acceleration"].usual == pytest.approx(most, rel=1e-9)
    without = beside_of(fastest(Problem(order=3), stroke="100 mm", limits=LIMITS))
    assert values["least time"].usual > without["least time"].usual


@pytest.mark.parametrize("more", [{"limits": {"snap": "30000 m/s^4"}}, {"end_velocity": "0.1 m/s"}])
def test_no_time_of_modified_sine_is_known_where_its_snap_jumps_or_an_end_moves(more: dict[str, Any]) -> None:
    assert fastest(Problem(order=4), **{"stroke": "100 mm", "limits": LIMITS, **more}).beside is None


def test_a_greatest_speed_stands_beside_that_of_modified_sine() -> None:
    limits = {"velocity": "1 m/s", "acceleration": "20 m/s^2", "jerk": "2000 m/s^3"}
    cycle = Cycle([RISE, Dwell("60 deg"), RETURN, Dwell()], speed="60 rpm", limits=limits)
    report: Any = cycle.fastest().report()
    values = beside_of(report)
    sine = Cycle([Rise("35 mm", "120 deg", law=USUAL), Dwell("60 deg"), Return("35 mm", "100 deg", law=USUAL), Dwell()],
                 speed="60 rpm", limits=limits)  # fmt: skip
    assert values["greatest speed"].usual == pytest.approx(sine.fastest().rpm, rel=1e-12)
    assert values["greatest speed"].chosen > values["greatest speed"].usual
    assert report.beside is not None
    assert report.beside.table in report.tables
    without: Any = sine.fastest().report()
    assert without.beside is None


def test_cams_stand_beside_those_of_modified_sine() -> None:
    cycle = Cycle([RISE, Dwell("90 deg"), RETURN, Dwell()], speed="200 rpm", drive={"mass": "2 kg"})
    usual = usual_cycle(cycle)
    assert usual is not None
    best, sine = (DiscCam(motion, "80 mm", TranslatingRoller("12 mm")) for motion in (cycle, usual))
    rows = {row.name: row for row in best.summary()}
    share = 100.0 * (cycle.peak(2) / usual.peak(2) - 1.0)
    assert rows["peak acceleration"].note == f"{share:+.1f} %: modified sine has {usual.peak(2):.5g} m/s²"
    assert "modified sine has" in rows["greatest pressure angle"].note
    assert "modified sine has" in rows["greatest contact force"].note
    assert not [row for row in sine.summary() if "modified sine has" in row.note]
    barrels = [BarrelCam(motion, "60 mm", "12 mm", "8 mm") for motion in (cycle, usual)]
    section = barrel_differences(barrels[0])
    steep = {row.name: row for row in section.facts}["greatest pressure angle at the bottom"]
    angle = 57.29577951308232 * max(abs(each.value) for each in barrels[1].pressure_angles)
    assert f"modified sine has {angle:.5g} deg" in steep.note
    assert not barrel_differences(barrels[1]).heading
