"""Problem files of the job "cam" beside the single disc cam: best laws, least prime circles, pairs, barrels."""

import csv
import json
import re
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest

from optlaws import (
    BarrelCam,
    CamForces,
    Cycle,
    DiscCam,
    Dwell,
    InfeasibleProblem,
    InputError,
    OscillatingRoller,
    Return,
    Rise,
    TranslatingFlat,
    TranslatingRoller,
    best_cam,
    best_offset,
    best_prime_circle,
    conjugate_cam,
    energy_fluctuation,
    least_prime_circle,
    least_spring,
    synthesize,
)
from optlaws.verification import verify_all
from tests.internals.explorer import CycleRequest, cam_view
from tests.internals.files import reading
from tests.internals.jobs import STARTERS, job, read_of_cam, stored_cam

MOTION = """
[motion]
name = "slide"
degree = 5
[[motion.segment]]
kind = "rise"
by = "35 mm"
duration = "120 deg"
[[motion.segment]]
kind = "dwell"
duration = "90 deg"
[[motion.segment]]
kind = "return"
duration = "100 deg"
[[motion.segment]]
kind = "dwell"
"""
HEAD = 'job = "cam"\ntitle = "Small"\nspeed = "200 rpm"\nrows = 13\n'
ROLLER = '[follower]\nkind = "translating roller"\nradius = "12 mm"\n'
LAWS = HEAD + 'prime_radius = "50 mm"\npressure_angle = "25 deg"\nbest = "laws"\n' + ROLLER + MOTION
GIVEN = LAWS.replace('by = "35 mm"', 'by = "35 mm"\nlaw = "345"').replace('"return"', '"return"\nlaw = "345"')
BASE = HEAD + 'radius_of_curvature = "3 mm"\nbest = "prime circle"\n[follower]\nkind = "translating flat"\n' + MOTION
OFFSET = (
    HEAD + 'prime_radius = "60 mm"\nbest = "offset"\n[process]\nover = "master"\n'
    'force = [["0 deg", "0 N"], ["90 deg", "0 N"], ["90 deg", "-300 N"], ["120 deg", "0 N"], ["360 deg", "0 N"]]\n'
    '[forces]\nirregularity = 0.04\n[spring]\nspeeds = ["0 rpm", "220 rpm"]\ngreatest = "contact"\n'
    + ROLLER + MOTION.replace("degree = 5", 'drive = { mass = "2 kg", preload = "100 N" }').replace(
        '"120 deg"', '"120 deg"\nlaw = "3-4-5"').replace('"100 deg"', '"100 deg"\nlaw = "3-4-5"')
)  # fmt: skip
PAIR = HEAD + 'prime_radius = "60 mm"\n[pair]\ndistance = "190 mm"\n' + ROLLER + MOTION
BARREL = HEAD + '[barrel]\nouter_radius = "60 mm"\ndepth = "12 mm"\nroller_radius = "8 mm"\n' + MOTION


def cycle() -> Cycle:
    moves = [Rise("35 mm", "120 deg"), Dwell("90 deg"), Return(duration="100 deg"), Dwell()]
    return Cycle(moves, speed="200 rpm", degree=5)


@pytest.fixture(autouse=True)
def drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pictures are made, but the contract of jobs writes them."""
    monkeypatch.setattr("optlaws.plots.style.rendered", lambda *_: b"")


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """The bound of a power is the quick one, where no test looks at it."""
    monkeypatch.setattr("optlaws.jobs.sought_cam.with_tight_bounds", lambda plan: plan)


def done(folder: Path, text: str) -> tuple[str, dict[str, Any], set[str]]:
    """The page, what a program is told, and the names of the files."""
    file = folder / "small.toml"
    file.write_text(text, "utf-8")
    written = job.done(file).write(folder / "out")
    reply = json.loads((folder / "out" / "cam.json").read_text("utf-8"))
    return (folder / "out" / "cam.md").read_text("utf-8"), reply, {one.name for one in written}


def told_of(folder: Path, text: str) -> dict[str, Any]:
    """What a program is told, without files."""
    file = folder / "small.toml"
    file.write_text(text, "utf-8")
    return read_of_cam(reading.toml(file), file).data


def test_best_laws_are_those_of_the_library_and_bear_forces(tmp_path: Path) -> None:
    drive = 'drive = { mass = "2 kg", preload = "100 N" }\n'
    text = LAWS.replace("degree = 5\n", "degree = 5\n" + drive) + '[forces]\nwidth = "20 mm"\n'
    reply = told_of(tmp_path, text)
    best = best_cam(cycle(), "50 mm", TranslatingRoller("12 mm"), pressure_angle="25 deg")
    assert reply["best"]["objective"] == pytest.approx(best.objective, rel=1e-9)
    assert reply["best"]["status"] == best.status.value == "optimal"
    assert reply["greatest_pressure_angle"]["high"] == pytest.approx(np.radians(25.0), rel=1e-7)
    assert reply["greatest_pressure_angle"]["angle"] is None
    assert reply["forces"]["speed"] == pytest.approx(2.0 * np.pi * 200 / 60)


def test_the_best_laws_without_a_prime_circle_are_on_the_least_one_of_modified_sine(tmp_path: Path) -> None:
    reply = told_of(tmp_path, LAWS.replace('prime_radius = "50 mm"\n', ""))
    moves = [Rise("35 mm", "120 deg", law="modified sine"), Dwell("90 deg")]
    usual = Cycle([*moves, Return(duration="100 deg", law="modified sine"), Dwell()], speed="200 rpm")
    least = least_prime_circle(usual, TranslatingRoller("12 mm"), pressure_angle="25 deg")
    assert reply["prime_radius"] == pytest.approx(least.radius, rel=2e-7)
    assert reply["greatest_pressure_angle"]["high"] <= np.radians(25.0) * (1.0 + 1e-6)
    values = {each["name"]: each["change"] for each in reply["usual_law"]["values"]}
    assert values["peak acceleration"] < -0.1
    assert values["prime circle"] == pytest.approx(0.0, abs=1e-6)


PUMP = (
    HEAD + 'best = "laws"\nradius_of_curvature = "8 mm"\nprime_radius = "40 mm"\n[forces]\n'
    '[follower]\nkind = "translating flat"\n'
    '[process]\nover = "master"\nforce = [["0 deg", "0 N"], ["30 deg", "-250 N"], ["120 deg", "-250 N"], '
    '["150 deg", "0 N"], ["360 deg", "0 N"]]\n'
    + MOTION.replace(
        "degree = 5", 'degree = 5\nminimise = "power"\ndrive = { mass = "0.45 kg", preload = "80 N" }\n'
        'limits = { acceleration = "40 m/s^2" }')
)  # fmt: skip


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize("of_motion", [False, True])
def test_the_least_power_is_that_at_the_shaft_under_a_process(tmp_path: Path, *, of_motion: bool) -> None:
    process = PUMP[PUMP.index("[process]") : PUMP.index("\n[motion]")]
    text = PUMP
    if of_motion:
        text = PUMP.replace(process, "") + process.replace("[process]", "[motion.load]")
    reply = told_of(tmp_path, text)
    speed = 200 * 2 * np.pi / 60
    shaft = max(abs(reply["forces"]["torque"][side]) for side in ("low", "high"))
    assert reply["best"]["objective"] == pytest.approx(shaft * speed, rel=1e-6)
    assert shaft * speed > 115.5  # W: 330 N at the mean velocity of 0.35 m/s


@pytest.mark.usefixtures("quick")
def test_the_page_says_what_power_is_least_and_what_the_shaft_takes_where_there_is_friction(tmp_path: Path) -> None:
    text = PUMP.replace("[forces]", "[forces]\nfriction = { contact = 0.06 }")
    page, reply, _ = done(tmp_path, text)
    torque = max(abs(reply["forces"]["torque"][side]) for side in ("low", "high"))
    power = torque * 200.0 * np.pi / 30.0
    assert reply["best"]["objective"] < 0.9 * power
    (row,) = re.findall(r"\| least power without friction at the cam, under its limits .*", page)
    assert f"{reply['best']['objective']:.5g}" in row
    assert f"With this friction the shaft takes up to {power:.5g} W: compare" in page
    compared = {each["name"]: each["change"] for each in reply["usual_law"]["values"]}
    assert next(iter(compared)) == "peak power without friction at the cam"


def test_a_bound_of_nothing_is_none(tmp_path: Path) -> None:
    page, reply, _ = done(tmp_path, PUMP.replace('limits = { acceleration = "40 m/s^2" }', ""))
    assert reply["best"]["lower_bound"] == 0.0
    assert re.search(
        r"\| least power under the limits of the cam \| [\d.]+ +\| +\| W +\| local, no bound is known", page
    )


_ARM = '"oscillating roller"\nradius = "12 mm"\narm = "114 mm"\npivot_distance = "146 mm"'
SWUNG = (
    LAWS.replace('"translating roller"\nradius = "12 mm"', _ARM).replace('"35 mm"', '"24 deg"')
    .replace('"50 mm"\npressure_angle = "25 deg"', '"66 mm"\npressure_angle = "35 deg"')
    .replace('"120 deg"', '"75 deg"').replace('"90 deg"', '"190 deg"').replace('"100 deg"', '"80 deg"')
)  # fmt: skip


def test_where_the_usual_law_has_no_least_prime_circle_the_page_says_why(tmp_path: Path) -> None:
    page, _, _ = done(tmp_path, SWUNG)
    (row,) = re.findall(r"\| least prime circle +\|([^|]*)\|([^|]*)\|", page)
    assert row[0].strip() == "none"
    assert float(row[1]) == pytest.approx(66.0, rel=0.05)
    assert "Modified sine has no least prime circle: no prime circle keeps a pressure angle of 35 deg" in page


def test_the_least_prime_circle_is_that_of_the_library(tmp_path: Path) -> None:
    page, reply, _ = done(tmp_path, BASE)
    assert "of the laws of least acceleration" in page
    best = best_prime_circle(cycle(), TranslatingFlat(), radius_of_curvature="3 mm")
    assert reply["best"]["objective"] == pytest.approx(best.least.radius, rel=1e-9)
    assert reply["best"]["lower_bound"] == pytest.approx(best.lower_bound, rel=1e-9)
    assert reply["best"]["status"] == "optimal"


def test_without_a_prime_circle_the_least_that_keeps_the_limits_is_taken(tmp_path: Path) -> None:
    reply = told_of(tmp_path, HEAD + 'pressure_angle = "25 deg"\nradius_of_curvature = "5 mm"\n' + ROLLER + MOTION)
    follower = TranslatingRoller("12 mm")
    least = least_prime_circle(cycle(), follower, pressure_angle="25 deg", radius_of_curvature="5 mm")
    assert reply["least_prime_circle"]["radius"] == pytest.approx(least.radius, rel=1e-9)
    assert reply["greatest_pressure_angle"]["high"] == pytest.approx(np.radians(25.0), rel=1e-7)
    assert reply["undercut"]["status"] == "free"


def test_a_cam_stands_beside_the_one_with_the_usual_law_of_the_same_file(tmp_path: Path) -> None:
    drive = 'drive = { mass = "2 kg" }\n'
    text = HEAD + 'pressure_angle = "25 deg"\n[forces]\nwidth = "20 mm"\n[spring]\nspeeds = ["0 rpm", "220 rpm"]\n'
    text += ROLLER + MOTION.replace("degree = 5\n", "degree = 5\n" + drive)
    usual = text.replace('"120 deg"', '"120 deg"\nlaw = "modified sine"').replace(
        '"100 deg"', '"100 deg"\nlaw = "modified sine"'
    )
    chosen, alone = told_of(tmp_path, text), told_of(tmp_path, usual)
    beside = chosen["usual_law"]
    assert "usual_law" not in alone
    assert beside["name"] == "modified sine"
    values = {each["name"]: each for each in beside["values"]}
    for reply, which in ((chosen, "chosen"), (alone, "usual")):
        seen = {name: each[which] for name, each in values.items()}
        assert seen["prime circle"] == pytest.approx(1e3 * reply["prime_radius"], rel=1e-9)
        assert seen["greatest contact force"] == pytest.approx(reply["forces"]["contact"]["most"], rel=1e-9)
        assert seen["greatest Hertz's pressure"] == pytest.approx(1e-6 * reply["forces"]["pressure"]["most"], rel=1e-9)
        assert seen["stiffness of the least spring"] == pytest.approx(reply["spring"]["stiffness"], rel=1e-9)
        # the forces are those with the spring beside them
        assert not reply["forces"]["lifts_off"]
    for change in (each for each in values.values() if each["usual"]):
        assert change["change"] == pytest.approx(change["chosen"] / change["usual"] - 1.0)
    assert values["peak acceleration"]["change"] < -0.1
    assert chosen["laws"]["status"] == "optimal"
    assert chosen["laws"]["lower_bound"] == pytest.approx(values["peak acceleration"]["chosen"], rel=1e-6)


def test_files_that_call_the_prime_circle_base_circle_are_read_where_both_are_one(tmp_path: Path) -> None:
    flat = LAWS.replace(ROLLER, '[follower]\nkind = "translating flat"\n').replace('pressure_angle = "25 deg"', "")
    flat = flat.replace('best = "laws"\n', "")
    now, before = (told_of(tmp_path, text) for text in (flat, flat.replace("prime_radius", "base_radius")))
    assert before["cam"]["base_radius"] == now["cam"]["prime_radius"]
    assert {**before, "cam": {}} == {**now, "cam": {}}
    assert now["prime_radius"] == now["base_radius"] == 0.05
    sought = BASE.replace('"prime circle"', '"base circle"')
    assert told_of(tmp_path, sought)["best"] == told_of(tmp_path, BASE)["best"]


@pytest.mark.long
def test_the_best_offset_bears_a_process_a_flywheel_and_a_spring(tmp_path: Path) -> None:
    page, reply, written = done(tmp_path, OFFSET)
    moves = [Rise("35 mm", "120 deg", law="3-4-5"), Dwell("90 deg"), Return(duration="100 deg", law="3-4-5"), Dwell()]
    cycle = Cycle(moves, speed="200 rpm", drive={"mass": "2 kg", "preload": "100 N"})
    best = best_offset(cycle, "60 mm", TranslatingRoller("12 mm"))
    process = reading.toml(tmp_path / "small.toml")["process"]
    forces = CamForces(best.cam, process=process)
    energy = energy_fluctuation(forces)
    assert reply["best_offset"]["offset"] == pytest.approx(best.offset, rel=1e-9)
    assert reply["best_offset"]["proven"] is True
    assert reply["forces"] == forces.results()
    assert reply["energy"] == {**energy.to_dict(), "flywheel": energy.flywheel(0.04)}
    spring = least_spring(
        best.cam, drive={"mass": "2 kg"}, speeds=("0 rpm", "220 rpm"), process=process, greatest="contact"
    )
    assert reply["spring"] == json.loads(spring.to_json())
    for text in ("best offset", "mean power", "flywheel for an irregularity of 0.04", "greatest contact force, any"):
        assert text in page
    assert "forces.svg" in written


def test_a_pair_has_its_second_cam_in_table_picture_and_files(tmp_path: Path) -> None:
    asked = '[[file]]\nname = "cam.nc"\ntolerance = "0.1 mm"\ndecimals = 2\n'
    page, reply, written = done(tmp_path, PAIR.replace("[pair]", asked + "[pair]"))
    first = DiscCam(cycle(), "60 mm", TranslatingRoller("12 mm"))
    second = conjugate_cam(first, distance="190 mm")
    table = np.genfromtxt(tmp_path / "out" / "cam.csv", delimiter=",", skip_header=2)
    assert np.allclose(table[:, 9:11], 1e3 * second.pitch_curve(np.radians(table[:, 0])), atol=1e-5)
    motion = cycle()
    for nu, size in enumerate((1e3, 1e3, 1.0, 1.0)):
        within = table[:-1, 0] * (motion.duration / 360.0)
        assert np.allclose(table[:-1, 1 + nu], size * np.asarray(motion(within, nu)), rtol=1e-6, atol=1e-4)
    assert reply["return_cam"]["undercut"]["status"] == second.extremes.undercut.status
    assert {"pair.svg", "cam.nc", "return-cam.nc"} <= written
    assert "[return-cam.nc]" in page


def test_the_return_cam_of_a_pair_presses_where_the_first_does_not(tmp_path: Path) -> None:
    text = PAIR.replace("[pair]", '[forces]\nwidth = "20 mm"\n[pair]').replace("rows = 13", "rows = 721")
    page, reply, _ = done(tmp_path, text.replace("degree = 5", 'drive = { mass = "2 kg" }'))
    assert "lifts off" not in page
    assert "The return cam presses its follower from" in page
    assert "| Hertz's pressure of the return cam" in page
    assert reply["forces"]["return_contact"]["most"] > 0.0
    assert not reply["forces"]["lifts_off"]
    with (tmp_path / "out" / "cam.csv").open(encoding="utf-8") as file:
        headings, *rows = list(csv.reader(file))[1:]
    table = dict(zip(headings, np.array(rows, float).T, strict=True))
    of_return, pressure = "contact force of the return cam, N", "Hertz's pressure, MPa"
    columns = {"contact": "contact force, N", "torque": "torque at the shaft, N m", "return_contact": of_return}
    for name, column in (columns | {"pressure": pressure}).items():
        low, high = (reply["forces"][name][end] * (1e-6 if column == pressure else 1.0) for end in ("least", "most"))
        assert (table[column].min(), table[column].max()) == pytest.approx((low, high), abs=1e-3 * high)
        assert max(low - table[column].min(), table[column].max() - high) <= 1e-7 * high
    assert np.all((table[of_return] == 0.0) | (table[of_return] == table["contact force, N"]))
    assert np.all((table[of_return] == 0.0) | (table[pressure] == 0.0))
    assert not [claim for each in verify_all(tmp_path / "out" / "cam.json").values() for claim in each.unchecked]


def test_a_barrel_has_its_flanks_tabled(tmp_path: Path) -> None:
    page, reply, written = done(tmp_path, 'cutter_radius = "5 mm"\n' + BARREL)
    assert re.search(r"\| least acceleration +\| [\d.]+ +\| [\d.]+ +\| m/s² +\| optimal", page)
    assert "Search space: laws of order 3 with Z of degree 5." in page
    cam = BarrelCam(cycle(), "60 mm", "12 mm", "8 mm")
    table = np.genfromtxt(tmp_path / "out" / "cam.csv", delimiter=",", skip_header=2)
    angles = np.radians(table[:, 0])
    assert np.allclose(table[:, 2], 1e3 * np.asarray(cycle()(angles / angles[-1] * cycle().duration, 1)), atol=1e-4)
    assert np.allclose(table[:, 8:11], 1e3 * cam.flank("upper")(angles), atol=1e-5)
    assert np.allclose(table[:, 20:23], 1e3 * cam.cutter_path("5 mm")(angles), atol=1e-5)
    assert reply["undercut"] == {"status": cam.undercut}
    assert reply["pressure_angles"]["greatest"]["high"] == pytest.approx(cam.pressure_angles[1].high, rel=1e-9)
    assert written == {"cam.md", "cam.csv", "cam.json", "cam.svg"}


def test_a_barrel_keeps_its_pressure_angle_or_says_where_it_is_steep(tmp_path: Path) -> None:
    def cam(allowed: str, text: str = BARREL) -> tuple[str, Any, Path]:
        folder = tmp_path / (allowed or "free")
        folder.mkdir()
        page, reply, _ = done(folder, f'pressure_angle = "{allowed}"\n' + text if allowed else text)
        return page, reply["pressure_angles"], folder / "out" / "cam.json"

    page, angles, _ = cam("")
    steepest = np.degrees([-angles["least"]["low"], angles["greatest"]["high"]])
    (remark,) = re.findall(r"The pressure angle at the bottom of the groove is .*", page)
    assert re.findall(r"([\d.]+) deg at", remark) == [f"{angle:.5g}" for angle in steepest]
    assert "where the roller moves back and" in remark
    assert remark.endswith("or give pressure_angle, within which the laws are sought then.")
    # the laws take the limit to the full, and nothing is left to be said
    allowed = round(float(min(steepest)) - 1.0, 3)
    page, angles, file = cam(f"{allowed} deg")
    assert np.degrees(max(-angles["least"]["low"], angles["greatest"]["high"])) == pytest.approx(allowed, rel=1e-7)
    assert "The pressure angle at the bottom" not in page
    # in both motions, as the velocity that it allows
    (most,) = re.findall(rf"The pressure_angle of {allowed} deg at the bottom of the groove allows (.*)\.\n", page)
    limits = "; ".join(f"segment {name}: velocity, {most} of {most}" for name in ("1 (Rise)", "3 (Return)"))
    assert f"\nLimits: {limits}.\n" in page
    assert not [claim for each in verify_all(file).values() for claim in each.unchecked]
    # a law that is given may be steeper
    given = BARREL.replace('by = "35 mm"', 'by = "35 mm"\nlaw = "345"').replace('"return"', '"return"\nlaw = "345"')
    assert "more than the allowed 20 deg: make the cylinder larger." in cam("20 deg", given)[0]
    with pytest.raises(InfeasibleProblem, match=r"pressure_angle of 9 deg .* allows [\d.]+ mm/s: make the cylinder"):
        cam("9 deg")


@pytest.mark.parametrize(
    ("text", "old", "new", "message"),
    [
        (LAWS, 'pressure_angle = "25 deg"\n', "", "pressure_angle"),
        (
            LAWS,
            'prime_radius = "50 mm"\npressure_angle = "25 deg"\n',
            "",
            "prime_radius is missing.*best = 'prime circle'",
        ),
        (PAIR, 'prime_radius = "60 mm"\n', "", "prime_radius is missing.*the least one that keeps them is taken"),
        (LAWS, '"laws"', '"law"', "best"),
        (GIVEN, "", "", "best = 'laws' looks for laws, and each motion has a given one"),
        (BASE, "speed", 'prime_radius = "9 mm"\nspeed', "best = 'prime circle' computes prime_radius"),
        (OFFSET, 'prime_radius = "60 mm"\n', "", "prime_radius is missing"),
        (OFFSET, '"12 mm"', '"12 mm"\noffset = "1 mm"', "best = 'offset' computes the offset"),
        (OFFSET, '"translating roller"\nradius = "12 mm"', '"translating flat"', "is of a translating roller, got a"),
        (OFFSET, "irregularity = 0.04", "irregularity = 4.0", "irregularity must be above 0 and below 2"),
        (OFFSET, '"master"', '"mastr"', "did you mean 'master'"),
        (OFFSET, '"-300 N"', '"-300 mm"', "process: force: value 3"),
        (OFFSET, "process", "proces", "proces"),
        (OFFSET, '"contact"', '"contacts"', "greatest"),
        (PUMP, 'minimise = "power"', 'minimise = "power"\nload = { force = "-9 N" }', "load: beside .process."),
        (PUMP, '["120 deg", "-250 N"]', '["30 deg", "-250 N"]', "process: .*'30 deg'.*'30 deg'"),
        (PAIR, 'distance = "190 mm"', 'angle = "110 deg"', "pair: a pair of TranslatingRoller is given by its"),
        (PAIR, '"190 mm"', '"90 mm"', "pair: .*distance"),
        (BARREL, "depth", "deep", "deep.*depth"),
        (BARREL, '"8 mm"', '"50 mm"', "roller_radius 50 mm is not less than the radius at the bottom"),
        (BARREL, "[barrel]", ROLLER + "[barrel]", "follower"),
    ],
)
def test_what_is_wrong_names_file_and_entry(tmp_path: Path, text: str, old: str, new: str, message: str) -> None:
    assert old in text
    file = tmp_path / "small.toml"
    file.write_text(text.replace(old, new, 1), "utf-8")
    with pytest.raises(InputError, match=rf"(?s)small\.toml.*{message}"):
        job.done(file).write(tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_second_follower_may_be_another(tmp_path: Path) -> None:
    text = (
        PAIR.replace("translating", "oscillating")
        .replace('"35 mm"', '"25 deg"')
        .replace('radius = "12 mm"', 'radius = "12 mm"\narm = "110 mm"\npivot_distance = "140 mm"')
    )
    other = 'kind = "oscillating roller", radius = "9 mm", arm = "90 mm", pivot_distance = "140 mm"'
    reply = told_of(tmp_path, text.replace('distance = "190 mm"', f'angle = "85 deg"\nfollower = {{ {other} }}'))
    swing = [Rise("25 deg", "120 deg"), Dwell("90 deg"), Return(duration="100 deg"), Dwell()]
    first = DiscCam(Cycle(swing, speed="200 rpm", degree=5), "60 mm", OscillatingRoller("12 mm", "110 mm", "140 mm"))
    second = conjugate_cam(first, OscillatingRoller("9 mm", "90 mm", "140 mm"), angle="85 deg")
    least = second.extremes.least_convex_radius.low
    assert reply["return_cam"]["convex_radius"]["low"] == pytest.approx(least, rel=1e-9)


def test_a_cam_that_is_undercut_says_so_where_forces_are_asked_for(tmp_path: Path) -> None:
    steep = MOTION.replace("120 deg", "40 deg").replace("100 deg", "40 deg").replace("90 deg", "140 deg")
    steep = steep.replace("[[motion", 'drive = { mass = "2 kg", preload = "60 N" }\n[[motion', 1)
    small = HEAD + 'prime_radius = "20 mm"\n' + ROLLER + "[forces]\n"
    page, _, _ = done(tmp_path, small + steep)
    assert "Undercut: undercut at " in page
    assert "which an undercut cam cannot give" in page
    with pytest.raises(InputError, match=r"no pressure: undercut at \d.* make the prime circle larger"):
        done(tmp_path, small + 'width = "20 mm"\n' + steep)


def test_page_and_explorer_show_the_facts_of_one_report(tmp_path: Path) -> None:
    """What is beyond a limit, extremes and sizes: each row of the page is a sentence of the view."""
    text = HEAD + 'prime_radius = "45 mm"\npressure_angle = "25 deg"\nradius_of_curvature = "40 mm"\n' + ROLLER + MOTION
    page, _, _ = done(tmp_path, text)
    study = CycleRequest(study=reading.toml(tmp_path / "small.toml"))
    trust, answer = cam_view.answer(study)["trust"], cam_view.sizes(study)
    sizes, beside = answer["facts"], answer["beside"]["rows"]
    (first, second) = (line for line in page.splitlines() if line.startswith("Limits exceeded: "))
    assert trust["advice"] == f"{first.removesuffix('.')}; {second.removeprefix('Limits exceeded: ')}"
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in page.splitlines() if line.startswith("| ")]
    shown = [row for row in rows if row[0] != "what"]
    compared, (law, *extremes) = shown[:6], shown[6:]
    peaks = ["peak acceleration", "peak velocity", "peak jerk"]  # what is least stands first
    assert [row[0] for row in compared] == [*peaks, "greatest pressure angle", "prime circle", "least prime circle"]
    for (name, usual, chosen, change, unit), (shown_name, *both, shown_change) in zip(compared, beside, strict=True):
        assert (shown_name, shown_change) == (name, change)
        assert [f"{each.value:.5g} {each.unit}" for each in both] == [f"{usual} {unit}", f"{chosen} {unit}"]
    assert sizes[0] == f"{law[0]} {law[1]} {law[3]}: {law[4]}"
    jerk, proof = sizes[-2:]
    assert jerk in page
    assert jerk.endswith("times that of modified sine: limit the jerk to less.")
    assert proof in page
    for row, fact in zip(extremes, [*trust["facts"], *sizes[1:-2]], strict=True):
        name, *values, unit, place = row
        ends = " to ".join(dict.fromkeys(f"{value} {unit}" for value in values))
        assert fact.startswith(f"{name} {ends} at ")
        assert float(fact.split(" at ")[1].split()[0]) == pytest.approx(float(place), abs=0.01)


@pytest.mark.parametrize(("by", "unit"), [("35 mm", "mm"), ("20 deg", "deg")])
def test_displacements_of_a_table_are_in_the_units_of_pictures(tmp_path: Path, by: str, unit: str) -> None:
    text = HEAD + 'prime_radius = "60 mm"\n' + ROLLER + MOTION.replace("35 mm", by)
    if unit == "deg":
        arm = '[follower]\nkind = "oscillating roller"\nradius = "12 mm"\narm = "90 mm"\npivot_distance = "120 mm"\n'
        text = text.replace(ROLLER, arm)
    done(tmp_path, text)
    lines = (tmp_path / "out" / "cam.csv").read_text("utf-8").splitlines()
    assert lines[1].split('","')[1] == f"displacement, {unit}"
    assert max(float(line.split(",")[1]) for line in lines[2:]) == pytest.approx(float(by.split(maxsplit=1)[0]))


@pytest.mark.long
@pytest.mark.parametrize(
    ("mass", "better"),
    [({}, ["peak acceleration"]), ({"mass": "3 kg"}, ["peak power", "peak torque at the shaft"])],
    ids=["light", "heavy"],
)
def test_the_cam_of_the_starter_is_nowhere_worse_than_the_one_with_the_usual_law(
    tmp_path: Path, mass: dict[str, str], better: list[str]
) -> None:
    numbers = {"stroke": "40mm", "rise": "110deg", "return": "110deg", "speed": "180rpm", **mass}
    text = STARTERS["cam"].text(numbers, tmp_path / "cam.toml").replace("animation = true", "")
    values = {each["name"]: each["change"] for each in told_of(tmp_path, text)["usual_law"]["values"]}
    assert next(iter(values)) == better[0]
    assert max(values[name] for name in better) < -0.05
    # the limits of the file are rounded up
    assert max(change for change in values.values() if change is not None) < 1e-4


def test_laws_of_least_power_count_the_spring_that_they_need(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A mass alone has other laws of least power than with the spring: modified sine took less with both before.

    The bound is of the laws with their spring alone: of those on the way none is computed.
    """
    relaxed = Mock(wraps=synthesize)
    monkeypatch.setattr("optlaws.cycles.optimisation.span_values.synthesize", relaxed)
    numbers = {"stroke": "40mm", "rise": "110deg", "return": "110deg", "speed": "180rpm", "mass": "3 kg"}
    text = STARTERS["cam"].text(numbers, tmp_path / "cam.toml").replace("animation = true", "")
    text = re.sub(r'(mass = "3 kg").* }', r"\1 }", text)
    text += '[spring]\nspeeds = ["0 rpm", "180 rpm"]\npreload = "20 N"\n'
    page, reply, _ = done(tmp_path, text.replace("degree = 15", "degree = 7"))
    assert relaxed.call_count == 1  # of two motions, one is proven by its own bound
    drive = reply["cam"]["motion"]["drive"]
    assert drive["preload"] == "20 N"
    # four digits, rounded up
    assert 1.0 <= float(drive["stiffness"].split()[0]) / reply["spring"]["stiffness"] < 1.001
    assert "The least spring, which stands below, presses the follower on the cam here." in page
    (usual, chosen) = (float(cell) for cell in page.split("| peak power")[1].split("|")[1:3])
    assert chosen < 0.98 * usual
    assert reply["forces"]["contact"]["least"] >= -1e-6
    assert not [claim for each in verify_all(tmp_path / "out" / "cam.json").values() for claim in each.unchecked]


@pytest.mark.usefixtures("quick")
def test_the_usual_law_beside_laws_with_their_least_spring_has_its_own(tmp_path: Path) -> None:
    speeds = '[spring]\nspeeds = ["0 rpm", "220 rpm"]\npreload = "60 N"\n'
    text = PUMP.replace('0.45 kg", preload = "80 N"', '8 kg"').replace("40 m/s^2", "60 m/s^2") + speeds
    (tmp_path / "chosen").mkdir()
    _, reply, _ = done(tmp_path / "chosen", text)
    values = {each["name"]: (each["usual"], each["chosen"]) for each in reply["usual_law"]["values"]}
    given = text.replace('best = "laws"\n', "")
    for kind in ("rise", "return"):
        given = given.replace(f'kind = "{kind}"', f'kind = "{kind}"\nlaw = "modified sine"')
    alone = told_of(tmp_path, given.replace(' limits = { acceleration = "60 m/s^2" }', ""))
    assert reply["spring"]["stiffness"] > 1.03 * alone["spring"]["stiffness"]  # or nothing is seen
    usual, _ = values["stiffness of the least spring"]
    assert usual == pytest.approx(alone["spring"]["stiffness"], rel=1e-9)
    # a spring that is counted has four digits
    assert values["greatest contact force"][0] == pytest.approx(alone["forces"]["contact"]["most"], rel=1e-3)
    torque = alone["forces"]["torque"]["most"]
    assert values["peak torque at the shaft"][0] == pytest.approx(torque, rel=1e-3)
    assert values["peak power"][0] == pytest.approx(torque * 200.0 * np.pi / 30.0, rel=1e-3)
    claims = [claim for each in verify_all(tmp_path / "chosen" / "out" / "cam.json").values() for claim in each.claims]
    assert not [claim for claim in claims if not claim.proven]


def test_the_least_power_of_the_starter_is_proven_and_the_explorer_leaves_its_bound_to_the_command(
    tmp_path: Path,
) -> None:
    numbers = {"stroke": "40mm", "rise": "110deg", "return": "100deg", "speed": "180rpm", "mass": "3 kg"}
    text = STARTERS["cam"].text(numbers, tmp_path / "cam.toml").replace("animation = true", "")
    page, reply, _ = done(tmp_path, text.replace("degree = 15", "degree = 7"))
    assert "The follower stays on the cam." in page
    assert re.search(r"least power under the limits of the cam \| ([\d.]+) *\| \1 *\| W +\| optimal \|\n", page)
    changes = {each["name"]: each["change"] for each in reply["usual_law"]["values"]}
    assert changes["peak torque at the shaft"] < -0.03
    (verification,) = verify_all(tmp_path / "out" / "cam.json").values()
    assert verification.proven
    assert "best.lower_bound" in {claim.name for claim in verification.claims}
    study = reading.toml(tmp_path / "small.toml")
    facts = cam_view.sizes(CycleRequest(study=study))["facts"]
    value = f"{reply['best']['objective']:.5g}"
    assert f"least power under the limits of the cam {value} W: its bound is computed by optlaws run" in facts
    assert not [fact for fact in facts if "gap" in fact]


def test_the_explorer_calls_an_objective_and_its_bound_no_range(tmp_path: Path) -> None:
    (tmp_path / "small.toml").write_text(SWUNG, "utf-8")
    facts = cam_view.sizes(CycleRequest(study=reading.toml(tmp_path / "small.toml")))["facts"]
    (least,) = (fact for fact in facts if fact.startswith("least acceleration under"))
    assert re.fullmatch(r"least acceleration under the limits of the cam [\d.]+ rad/s²: local, gap [\d.]+ %", least)


def test_a_search_for_the_proof_of_a_power_that_is_stopped_leaves_the_quick_bound(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("optlaws.jobs.sought_cam.with_tight_bounds", Mock(side_effect=KeyboardInterrupt))
    numbers = {"stroke": "40mm", "rise": "110deg", "return": "100deg", "speed": "180rpm", "mass": "3 kg"}
    text = STARTERS["cam"].text(numbers, tmp_path / "cam.toml").replace("animation = true", "")
    page, reply, _ = done(tmp_path, text.replace("degree = 15", "degree = 7"))
    assert reply["best"]["status"] == "local"
    assert 0.0 < reply["best"]["lower_bound"] < 0.99 * reply["best"]["objective"]
    assert "| local, gap " in page


def test_a_cam_without_a_usual_law_beside_it_has_its_peaks_in_a_table(tmp_path: Path) -> None:
    through = 'kind = "free"\nby = "35 mm"\nvia = [["40 deg", "12 mm"]]'
    text = HEAD + 'prime_radius = "60 mm"\n' + ROLLER + MOTION.replace('kind = "rise"\nby = "35 mm"', through)
    page, reply, _ = done(tmp_path, text)
    peaks = dict(re.findall(r"\| (peak \w+) +\| ([\d.e+]+)", page))
    motion = stored_cam(reply).plan
    sizes = [1e3 * motion.peak(1), motion.peak(2), motion.peak(3)]
    assert [float(peaks[f"peak {name}"]) for name in ("velocity", "acceleration", "jerk")] == pytest.approx(
        sizes, rel=1e-4
    )
    assert "Modified sine cannot stand beside these laws" in page


def test_lengths_that_are_likely_without_their_unit_are_the_first_sentence_of_a_page(tmp_path: Path) -> None:
    text = GIVEN.replace('best = "laws"\n', "")
    page, *_ = done(tmp_path, text.replace('radius = "12 mm"', "radius = 12").replace('"50 mm"', "12.05"))
    sentence = "The prime circle has a radius of 12.05 m: a length without a unit is in metres."
    assert sentence in page
    assert page.index(sentence) < page.index("![")


def test_a_follower_that_lifts_off_is_the_first_sentence_of_its_page(tmp_path: Path) -> None:
    motion = MOTION.replace("degree = 5", 'degree = 5\ndrive = { mass = "2 kg" }')
    text = HEAD + 'prime_radius = "60 mm"\n' + ROLLER + "[forces]\n" + motion
    page, reply, _ = done(tmp_path, text)
    title, _, first, *_ = page.split("\n\n")
    assert title == "# Small"
    assert re.fullmatch(
        r"The follower lifts off at [\d.]+ deg: give its spring more preload or stiffness, or reduce the speed\.", first
    )
    assert reply["forces"]["contact"]["least"] < 0.0
    assert page.count("lifts off") == 1
    (tmp_path / "held").mkdir()
    held = motion.replace('"2 kg"', '"2 kg", stiffness = "3 N/mm", preload = "100 N"')
    assert "lifts off" not in done(tmp_path / "held", text.replace(motion, held))[0]
    # the least spring leaves no force: what it takes to have some is an entry of it
    spring, advice = '[spring]\nspeeds = ["0 rpm", "200 rpm"]\n', 'give [spring] a least force, such as force = "20 N"'
    for name, least in (("least", ""), ("reserve", 'force = "20 N"\n')):
        (tmp_path / name).mkdir()
        page, reply, _ = done(
            tmp_path / name, text.replace("[forces]\n", f'[forces]\nwidth = "20 mm"\n{spring}{least}')
        )
        assert (advice in page) is ("touches without force" in page) is (name == "least")
        assert "give its spring" not in page
        assert (reply["forces"]["pressure"]["least"] == 0.0) is (name == "least")


def test_what_the_reserve_of_a_spring_costs_beside_the_usual_law_is_said(tmp_path: Path) -> None:
    motion = MOTION.replace("degree = 5", 'degree = 5\ndrive = { mass = "2 kg" }')
    motion = motion.replace('by = "35 mm"', 'by = "35 mm"\nlaw = "345"').replace('"return"', '"return"\nlaw = "345"')
    spring = '[spring]\nspeeds = ["0 rpm", "200 rpm"]\nforce = "20 N"\n'
    page, reply, _ = done(tmp_path, HEAD + 'prime_radius = "60 mm"\n' + ROLLER + spring + motion)
    values = {each["name"]: each["change"] for each in reply["usual_law"]["values"]}
    stiffer = values["stiffness of the least spring"]
    assert stiffer > 0.005
    said = f"The reserve takes a spring that is {100.0 * stiffer:.1f} % stiffer than with modified sine: limit the "
    assert said in page
