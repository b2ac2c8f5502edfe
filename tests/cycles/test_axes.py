"""Several axes on one clock: built from segments, tables or cycles, kept, tabled, drawn and exported together."""

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from optlaws import Axes, Cycle, Drive, Dwell, InputError, Mechanism, Motor, Move, Return, Rise, slider_crank
from tests.internals.exports import FORMATS
from tests.internals.files import reading
from tests.internals.jobs import read_of_cycle_entries as read

TABLE: dict[str, Any] = {"segments": [Rise("45 deg", "400 ms", law="345"), Dwell()], "advance": "45 deg"}
HEAD = [Dwell("400 ms", name="up"), Rise("250 mm", "200 ms", law="345"), Dwell("1200 ms"), Return(law="345")]
NO_SEGMENTS: Any = 3
NAMELESS = {"csv", "kas", "lenze", "plcopen", "sew", "technosoft"}  # rows of numbers
MACHINE = Axes({"table": TABLE, "weld head": HEAD}, period="2 s")


def test_axes_are_cycles_of_one_clock_by_name() -> None:
    alone = Cycle(HEAD, period="2 s")
    assert list(MACHINE) == ["table", "weld head"]
    assert len(MACHINE) == 2
    assert "weld head" in MACHINE
    assert MACHINE["weld head"].to_dict() == alone.to_dict()
    assert MACHINE.duration == alone.duration
    assert MACHINE.status == "optimal"
    assert MACHINE(0.5, 1)["weld head"] == alone(0.5, 1)
    assert MACHINE.at_angle("0.25 turn")["weld head"] == alone(0.5)
    assert MACHINE.at("60 rpm")["weld head"](0.25) == pytest.approx(alone(0.5))


def test_axes_are_kept_as_data_and_as_a_problem_file(tmp_path: Path) -> None:
    assert Axes.from_json(MACHINE.to_json()).to_dict() == MACHINE.to_dict()
    file = tmp_path / "machine.toml"
    file.write_text(MACHINE.to_toml("A machine"), "utf-8")
    _, cycles = read(reading.toml(file), file)
    assert {name: cycle(0.45) for name, cycle in cycles.items()} == MACHINE(0.45)


def test_axes_are_tabled_drawn_and_exported_together() -> None:
    frame = MACHINE.to_pandas()
    assert frame.loc["weld head", "segment"].tolist() == ["up", "Rise", "Dwell", "Return"]
    artists = MACHINE.plot(nu=2)
    figure = artists[0].figure
    assert [axis.get_ylabel() for axis in figure.axes] == [
        "table\nacceleration, rad/s²",
        "weld head\nacceleration, m/s²",
    ]
    axes = Figure().subplots()
    curves = MACHINE.plot(axes)
    assert [float(np.abs(curve.get_ydata()).max()) for curve in curves] == pytest.approx([1.0, 1.0])
    legend = axes.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["table / 45 deg", "weld head / 250 mm"]
    made = MACHINE.export({"table": "codesys-xyva", "weld head": "rockwell-cam"}, points=41)
    assert {name: one.points for name, one in made.items()} == {"table": 41, "weld head": 41}
    assert "weld head" in MACHINE._repr_html_()


@pytest.mark.sample(6)
@pytest.mark.parametrize("form", sorted(set(FORMATS) - NAMELESS))
def test_axes_are_exported_under_their_own_names(form: str) -> None:
    """In one project of a controller no two variables, tables or functions are called alike."""
    made = Axes(dict.fromkeys(["Weld head", "weld_head", "switch"], HEAD), period="2 s").export(form, points=21)
    texts = [export.text for export in made.values()]
    assert all(name in text for name, text in zip(["Weld_head", "weld_head_2", "Cam_switch"], texts, strict=True))
    assert "weld_head" not in texts[2].lower()
    assert len(set(texts)) == 3


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Axes({}), "axes: they are a table of segments by name"),
        (lambda: Axes({"x": HEAD}), "either a speed such as"),
        (lambda: Axes({"x": HEAD}, period="1 s"), r"axis x: the durations sum to"),
        (lambda: Axes({"x": NO_SEGMENTS}, period="1 s"), "axis x: its segments are a list such as"),
        (lambda: Axes({"x": {"segment": HEAD}}, period="1 s"), "axis x: unknown key 'segment'; did you mean"),
        (lambda: Axes({"x": TABLE | {"period": "2 s"}}, period="2 s"), "axis x: all axes have one period"),
        (lambda: Axes({"x": Cycle(HEAD, period="2 s"), "y": Cycle([Move("0.1 m", "2 s"), Return()], period="3 s")}),
         "axis y: its cycle takes 3 s, the machine's 2 s"),
        (lambda: MACHINE["tabel"], "unknown axis 'tabel'; did you mean 'table'"),
        (lambda: MACHINE.plot([1]), "2 axes are drawn into one pair of axes or into as many, got 1"),
        (lambda: MACHINE.plot(nu=4), "nu must be at most 3"),
        (lambda: MACHINE.export("codesis"), "axis table: to: unknown format"),
        (lambda: Axes.from_dict({"format": "other"}), "stored axes have format 'optlaws axes 1'"),
    ],
)  # fmt: skip
def test_what_is_wrong_names_the_axis(make: Any, says: str) -> None:
    with pytest.raises(InputError, match=says):
        make()


def test_axes_with_mechanisms_and_motors_are_kept_exported_and_made_faster(tmp_path: Path) -> None:
    press = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.05 kg m^2", "slider": "5 kg"})
    motor = Motor("3e-4 kg m^2", peak_torque="6 N m", curve=[("0 rpm", "6 N m"), ("3000 rpm", "4 N m")])
    geared = Drive(Mechanism("0.8 kg m^2"), motor, ratio=20, efficiency=0.85)
    turn = {"segments": [Rise("360 deg", "0.4 s", law="345"), Dwell()], "advance": "360 deg", "drive": press}
    machine = Axes(
        {"crank": turn, "table": TABLE | {"drive": geared}, "pusher": [Rise("30 mm", law="345"), Return(law="345")]},
        period="2 s",
    )
    assert Axes.from_json(machine.to_json()) == machine
    assert (machine["crank"].drive, machine["table"].drive) == (press, geared)
    file = tmp_path / "machine.toml"
    file.write_text(machine.to_toml("A machine"), "utf-8")
    _, cycles = read(reading.toml(file), file)
    assert [cycle.drive for cycle in cycles.values()] == [press, geared, None]
    assert cycles["table"].effort == machine["table"].effort
    exports = machine.export("codesys-xyva", points=41)
    assert [export.points for export in exports.values()] == [41, 41, 41]
    fast = machine.at("60 rpm")  # twice as fast: four times the torque, where there is nothing but inertia
    for name in ("crank", "table"):
        assert fast[name].effort.peak_force == pytest.approx(4.0 * machine[name].effort.peak_force, rel=1e-9)
        assert fast[name].effort.rms_force == pytest.approx(4.0 * machine[name].effort.rms_force, rel=1e-9)


def test_axes_are_one_trajectory_of_several_joints() -> None:
    """What a controller makes of the shared points is as near to each axis as its file alone, or nearer."""
    made = MACHINE.export("ros2", together=True)
    message = import_module("yaml").safe_load(made["table"].text)
    assert message["joint_names"] == ["table", "weld_head"]
    assert made["table"].text == made["weld head"].text
    seconds = np.array(
        [point["time_from_start"]["sec"] + 1e-9 * point["time_from_start"]["nanosec"] for point in message["points"]]
    )
    assert (np.diff(seconds) > 0.0).all()
    for place, (name, cycle) in enumerate(MACHINE.items()):
        for nu, field in enumerate(("positions", "velocities", "accelerations")):
            values = np.array([point[field][place] for point in message["points"]])
            inside = (seconds > 0.0) & (seconds < 2.0)
            assert np.allclose(values[inside], cycle(seconds[inside], nu), atol=1e-6 * cycle.peak(nu))
        alone = cycle.export("ros2")
        assert made[name].points >= alone.points
        assert made[name].report.deviation[0].value <= alone.report.deviation[0].value * 1.01 + 1e-12
    with pytest.raises(InputError, match="holds one axis"):
        MACHINE.export("codesys-xyva", together=True)


@pytest.mark.parametrize("interpolation", ["cubic", "quintic", "linear"])
def test_axes_are_columns_of_one_table(interpolation: Any) -> None:
    made = MACHINE.export("csv", together=True, points=37, interpolation=interpolation)
    assert made["table"].text == made["weld head"].text
    _, headings, *lines = made["table"].text.splitlines()
    rows = np.array([[float(cell) for cell in line.split(",")] for line in lines])
    assert (np.diff(rows[:, 0]) > 1e-7).all()
    orders = {"cubic": 1, "quintic": 3, "linear": 1}[interpolation]
    assert [heading.split()[0] for heading in headings.split(",")[1:]] == ["table"] * orders + ["weld_head"] * orders
    for place, (name, cycle) in enumerate(MACHINE.items()):
        motion = cycle.motion()
        values = np.asarray(motion(rows[:, 0]))
        assert rows[:, 1 + place * orders] == pytest.approx(values, abs=1e-9 * motion.stroke)
        alone = cycle.export("csv", points=37, interpolation=interpolation)
        assert made[name].points >= alone.points
        assert made[name].report.deviation[0].value <= alone.report.deviation[0].value * 1.01 + 1e-12
