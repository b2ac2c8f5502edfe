"""What people say of cycles and of several axes: errors that name the remedy, and motions that are what was said."""

import json
from importlib import import_module
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from optlaws import (
    Axes,
    ConstantVelocity,
    Cycle,
    Drive,
    Dwell,
    Follower,
    Free,
    InputError,
    Mechanism,
    Motor,
    Move,
    Return,
    Rise,
    catalogue,
    slider_crank,
    smoothstep,
)
from tests.documents import ROOT
from tests.internals.exports import FORMATS
from tests.internals.files import reading
from tests.internals.jobs import read_of_cycle_entries as read
from tests.internals.motion import TURN

SINE = "modified sine"


def cycle(*segments: Any, **others: Any) -> Cycle:
    return Cycle(list(segments), **({"speed": "200 rpm"} | others))


def plain(kind: str, **entries: Any) -> Any:
    """A segment as files have it, whose entries are read with the cycle's."""
    return {"kind": kind, **entries}


LEVEL = [Rise("35 mm", "180 deg"), Return("30 mm", "180 deg")]


@pytest.mark.parametrize(
    ("segments", "others", "message"),
    [
        ([], {}, "segments must be a list of 1 at least, each a segment"),
        ([Dwell()], {"speed": None}, 'either a speed such as "200 rpm" or a period'),
        ([Dwell()], {"period": "1 s"}, "either a speed"),
        ([Dwell()], {"speed": "0 rpm"}, "speed must be above 0"),
        ([Dwell()], {"speed": "200"}, "speed must be an angular velocity .* got '200' without a unit"),
        ([plain("free", by=0.03)], {}, "by must be a length .* or an angle .* got 0.03 without a unit"),
        ([plain("dwell", duration=0.1)], {}, "duration must be an angle .* or a time .* got 0.1 without a unit"),
        ([plain("dwell", duration="120 mm")], {}, r"segment 1: duration must be an angle .* or a time .* is a length"),
        ([plain("dwell", duration="-3 deg"), Dwell()], {}, "segment 1: duration must be above 0"),
        ([Dwell(), plain("dwell", duration=["3 deg"])], {}, "segment 2: duration must be a list of 2 at least"),
        ([plain("dwel")], {}, "segment 1: unknown kind of a segment 'dwel'; did you mean 'dwell'"),
        ([plain("rise", via=[])], {}, "segment 1: unknown entry of a rise 'via'; known are by, duration, end_vel"),
        ([plain("constant velocity")], {}, "segment 1: a constant velocity needs its velocity, such as"),
        (
            [Rise("35 mm", "120 deg"), Dwell("90 deg"), Return(duration="100 deg")],
            {},
            "sum to 310 deg .* lengthen .* 50",
        ),
        ([Rise("35 mm", "220 deg"), Return(duration="200 deg")], {}, "sum to 420 deg .* shorten segments by 60 deg"),
        (LEVEL, {}, "the positions do not close: .*5 mm from its start"),
        (LEVEL, {}, r"change a displacement by -5 mm, .*advance='5 mm'"),
        (
            [Rise("35 mm", "90 deg"), Dwell(), Return(duration="20 deg"), Dwell()],
            {},
            "with several free ones only moves",
        ),
        ([Rise("-35 mm", "90 deg"), Return()], {}, "`by` is given as a positive displacement"),
        ([Rise("0 mm", "90 deg"), Dwell()], {}, r"segment 1 \(Rise\): `by` must not be 0, got '0 mm': .* is a Dwell"),
        ([Move(duration="90 deg"), Return()], {}, "either a displacement `by` or a position `to`"),
        ([Rise("35 mm", "90 deg", law="modified sin x"), Return()], {}, r"segment 1 \(Rise\): law: .*modified sin x"),
        (
            [plain("rise", by="35 mm", duration="90 deg", law=5), Return()],
            {},
            "segment 1: law: it must be a name of the catalogue, a formula, a JSON or CSV file, 'optimal'.* got 5",
        ),
        ([plain("rise", limits={"sped": "1 m/s"})], {}, "segment 1: limits: unknown limit 'sped'; known are"),
        ([plain("rise", limits={"energy": "1 J"})], {}, "segment 1: limits: energy is of the whole cycle: give"),
        ([plain("rise", limits={"snap": "1 m/s"})], {}, "segment 1: limits: snap must be a snap such as '50000"),
        ([Rise("35 mm", "90 deg"), Return()], {"minimise": "accel"}, "minimise: unknown objective"),
        ([Rise("35 mm", "90 deg"), Return()], {"drive": {"mass": "-2 kg"}}, "drive: mass must be at least 0"),
        ([Rise("35 mm", "90 deg"), Return()], {"drive": {"mass": "2 N"}}, "drive: mass must be a mass .* is a force"),
        ([Rise("35 mm", "90 deg"), Return("30 deg")], {}, "by must be a length .* '30 deg' is an angle"),
        (
            [ConstantVelocity("1 m/s", "90 deg"), Return(law=SINE)],
            {},
            "ends with 0 mm/s and .*starts with 1000 mm/s, a jump of 1000 mm/s: .* law='optimal'",
        ),
        ([ConstantVelocity("1 m/s", "90 deg"), Dwell(), Return(duration="9 deg")], {}, "put a motion between them"),
        (
            [Free("1 mm", "90 deg"), Move("1 mm", "90 deg", law=SINE), Free("-2 mm")],
            {},
            r"segment 2 \(Move\): give it law='optimal': .* begin it where velocity and acceleration are known",
        ),
        (
            [Dwell("9 deg"), plain("free", by="1 mm", via=[("200 deg", "3 mm"), ("5 mm", "3 mm")])],
            {"advance": "1 mm"},
            "segment 2: via 2: 1 must be an angle .* or a time .*, but '5 mm' is a length",
        ),
        ([Dwell("9 deg"), Free("1 mm", via=[("359 deg", "3 mm")])], {"advance": "1 mm"}, "must be within the segment"),
    ],
)
def test_errors_say_what_is_wrong_and_the_remedy(segments: list[Any], others: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        cycle(*segments, **others)


def test_a_segment_without_a_duration_takes_what_is_left() -> None:
    course = cycle(Rise("35 mm", "120 deg", law=SINE), Dwell("0.1 s"), Return(duration="100 deg", law=SINE), Dwell())
    assert course.durations == pytest.approx([0.1, 0.1, 0.3 * 100 / 360, 0.1 - 0.3 * 100 / 360])


def test_motion_is_the_law_in_machine_units() -> None:
    course = cycle(Rise("35 mm", "120 deg", law=SINE), Dwell(), Return(duration="100 deg", law=SINE))
    law = catalogue[SINE].law
    k = np.linspace(0.0, 0.999, 50)
    for nu in range(4):
        assert course(0.1 * k, nu) == pytest.approx(0.035 / 0.1**nu * law(k, nu), rel=1e-9, abs=1e-12)
    C = law.constants.C.value
    assert course.peak(2) == pytest.approx(C * 0.035 / (0.3 * 100 / 360) ** 2)
    assert course.peaks[0].peak(1) == pytest.approx(law.constants.B.value * 0.35)
    assert course(0.05 + 3 * 0.3) == pytest.approx(course(0.05), rel=1e-9)
    assert course.at_angle(60.0) == pytest.approx(course(0.05))
    assert course.per_angle(60.0, 1) == pytest.approx(course(0.05, 1) * 0.3 / TURN)


def test_joints_tell_what_jumps() -> None:
    course = cycle(Rise("35 mm", "120 deg", law="constant acceleration"), Dwell(), Return(duration="100 deg", law=SINE))
    rise, dwell = course.joints[0], course.joints[1]
    assert rise["acceleration"] == pytest.approx(4 * 3.5)
    assert dwell["acceleration"] == pytest.approx(4 * 3.5)
    assert rise["velocity"] == dwell["velocity"] == 0.0


def test_a_table_that_indexes_goes_on() -> None:
    course = cycle(Rise("45 deg", "90 deg", law=SINE), Dwell(), advance="45 deg", period="2 s", speed=None)
    assert [course(2.0 * turn) for turn in range(4)] == pytest.approx([turn * pi / 4 for turn in range(4)])


def test_the_drive_gives_back_what_it_takes_but_for_friction() -> None:
    segments = [Rise("35 mm", "120 deg", law=SINE), Dwell(), Return(duration="100 deg", law=SINE)]
    kept = cycle(*segments, drive={"mass": "2 kg", "stiffness": "3 N/mm", "gravity": "19.6 N"}).effort
    rubbed = cycle(*segments, drive={"mass": "2 kg", "dry": "5 N"}).effort
    assert kept.mean_power == 0.0
    assert rubbed.mean_power == pytest.approx(5 * 2 * 0.035 / 0.3)
    mass = cycle(*segments, drive={"mass": "2 kg"})
    assert mass.effort.peak_force == pytest.approx(2 * mass.peak(2), rel=1e-12)
    assert mass.effort.rms_force == pytest.approx(
        2 * np.sqrt(sum(piece.duration * piece.mean_square(2) for piece in mass.pieces) / 0.3), rel=1e-9
    )
    d = catalogue[SINE].law.power_peak().value
    assert mass.effort.peak_power == pytest.approx(2 * d * 0.035**2 / (0.3 * 100 / 360) ** 3, rel=1e-9)


def test_the_mass_on_the_cam_moves_as_the_cycle_says() -> None:
    asked = cycle(Rise("30 mm", "120 deg", law=smoothstep(4)), Dwell("60 deg"),
                  Return(duration="120 deg", law=smoothstep(4)), Dwell())  # fmt: skip
    cam = asked.cam("20 ms", damping=0.05)
    nu = 2 * pi * asked.durations[0] / 0.020
    mass = Follower(nu, 0.05).cycle(cam.pieces[0].law, cam.pieces[2].law, dwell=0.5, fall_duration=1.0, rest=0.5)
    k = np.linspace(0.0, 2.99, 100)
    assert 0.03 * mass(k) == pytest.approx(asked(k * asked.durations[0]), abs=1e-10)


def test_a_mass_law_that_is_too_rough_is_named() -> None:
    with pytest.raises(InputError, match=r"segment 1 \(Rise\): the mass law has"):
        cycle(Rise("30 mm", "120 deg", law=SINE), Return(duration="120 deg"), Dwell()).cam("20 ms")


def test_a_cycle_is_written_with_the_law_of_a_file_not_with_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is read in any folder, where the name would mean another file or none."""
    (tmp_path / "law.json").write_text(catalogue["cycloidal"].law.to_json(), "utf-8")
    monkeypatch.chdir(tmp_path)
    moves = [Rise("35 mm", "0.1 s", law="law.json"), Return(law="cycloidal")]
    written = Cycle(moves, period="0.3 s").to_json()
    (tmp_path / "law.json").unlink()
    assert Cycle.from_json(written).peak(2) == pytest.approx(2.0 * pi * 3.5, rel=1e-12)


def test_half_segments_join_to_the_cam_of_others() -> None:
    """KU Leuven's cam of case KUL-18a: a rise and a return by halves, with the places that matcam wrote."""
    known = json.loads((ROOT / "tests" / "reference" / "published_cams.json").read_text("utf-8"))["KUL-18a"]
    halves = [
        Dwell("60 deg"),
        Rise("15 mm", "60 deg", law="C1"),
        Rise("15 mm", "60 deg", law="C2"),
        Dwell("20 deg"),
        Return("15 mm", "40 deg", law="C3"),
        Return("15 mm", "40 deg", law="C4"),
        Dwell(),
    ]
    cam = cycle(*halves, speed="30 rpm")
    places = np.array(known["thetadegree"])
    for nu, name in enumerate(("S", "V", "A")):
        assert 1e3 * cam.per_angle(places, nu) == pytest.approx(np.array(known[name]), abs=1e-10)
    assert [joint["velocity"] for joint in cam.joints] == [0.0] * 7
    assert [joint["acceleration"] for joint in cam.joints] == [0.0] * 7
    assert Cycle.from_json(cam.to_json()).peak(3) == cam.peak(3)
    assert Cycle.from_dict(cam.to_dict()).segments == cam.segments


def test_half_segments_that_do_not_meet_are_refused_with_the_jump_and_the_stroke() -> None:
    first, last = Rise("10 mm", "40 deg", law="C1"), Return(law="cycloidal")
    met = r"a jump of -90 mm/s: .* moving by 20 mm in the same time, segment 2 \(Rise\) would meet"
    with pytest.raises(InputError, match=met):
        cycle(first, Rise("10 mm", "80 deg", law="C2"), Dwell("60 deg"), last, speed="60 rpm")
    faster = ConstantVelocity("100 mm/s", "40 deg")
    with pytest.raises(InputError, match=r"moving by 5\.55555556 mm in the same time, segment 1"):
        cycle(first, faster, Rise("10 mm", "80 deg", law="C2"), last, speed="60 rpm")
    for second in (Rise("20 mm", law="C2"), Rise("10 mm")):
        shared = cycle(first, second, Dwell("20 deg"), Rise("5 mm"), Return("15 mm"), last, speed="60 rpm")
        with pytest.raises(InputError, match="does not rest where they meet"):
            _ = shared.durations
    with pytest.raises(InputError, match="a law and no velocities that move at its ends"):
        _ = cycle(Dwell("20 deg"), Rise("5 mm", law="H2"), Dwell("9 deg"), last, speed="60 rpm").durations
    with pytest.raises(InputError, match="its law must have the stroke 1, which `by` multiplies, but it has 30"):
        _ = cycle(Rise("5 mm", "90 deg", law="formula: 30*k^2*(3 - 2*k)"), last).pieces


# --- several axes on one clock ---


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
        (lambda: Axes({"x": HEAD}),
         r"axis x: segment 4 \(Return\): nothing bounds its time: give .*, or all axes either a speed such as"),
        (lambda: Axes({"x": HEAD}, speed="30 rpm", period="2 s"), "either a speed such as"),
        (lambda: Axes({"x": HEAD}, period="1 s"), r"axis x: the durations sum to"),
        (lambda: Cycle([Move("9 mm", "300 deg"), Dwell("120 deg"), Return("9 mm", "300 deg")], speed="3000 rpm"),
         "sum to 720 deg, and a cycle is one turn of its master: divide the angles and the speed by 2"),
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
