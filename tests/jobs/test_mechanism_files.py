"""Mechanisms and motors in problem files: each kind as its function makes it, files written again, what is refused."""

import copy
import csv
import json
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import optlaws
from optlaws import (
    Body,
    Cycle,
    DiscCam,
    Drive,
    Dwell,
    InputError,
    Loads,
    Mechanism,
    Motor,
    OptlawsError,
    Return,
    Rise,
    Status,
    TranslatingRoller,
    belt,
    cam_mechanism,
    four_bar,
    slider_crank,
)
from tests.internals.cli import exit_code
from tests.internals.files import reading
from tests.internals.jobs import cycle_sweeps, read_given, sweeps_of
from tests.internals.jobs import read_of_cycle_entries as read
from tests.internals.mechanisms import MechanismKind

FORCE = [["0.3 m", "0 N"], ["0.31 m", "-400 N"], ["0.5 m", "-400 N"]]
CAM = {
    "prime_radius": "60 mm",
    "follower": {"kind": "translating roller", "radius": "12 mm"},
    "moved": "2 kg",
    "segment": [
        {"kind": "rise", "by": "30 mm", "duration": "120 deg", "law": "3-4-5"},
        {"kind": "return", "law": "cycloidal"},
    ],
    "loads": {"force": "-60 N", "stiffness": "3 N/mm"},
}
TABLE = {
    "inertia": [
        ["0 deg", "0.02 kg m^2"],
        ["30 deg", "0.05 kg m^2"],
        ["60 deg", "0.07 kg m^2"],
        ["90 deg", "0.06 kg m^2"],
    ]
}
MOTOR = {"inertia": "3e-4 kg m^2", "rated_torque": "2 N m", "curve": [["0 rpm", "9 N m"], ["3000 rpm", "6 N m"]]}
DRIVE = {"motor": MOTOR, "ratio": 20, "efficiency": [0.9, 0.8], "inertia": "1e-4 kg m^2", "regeneration": 0.5}
CRANK = {
    "kind": "slider crank",
    "crank": "0.1 m",
    "rod": "0.4 m",
    "bodies": {"crank": "0.02 kg m^2", "slider": "5 kg", "rod": {"mass": "2 kg", "centre": ["0.2 m", "0 m"]}},
    "loads": {"force": FORCE, "gravity": "180 deg"},
    "over": ["0 deg", "180 deg"],
    "coulomb": "0.5 N m",
}


def roller_cam() -> DiscCam:
    motion = Cycle([Rise("30 mm", "120 deg", law="3-4-5"), Return(law="cycloidal")], period="1 s")
    return DiscCam(motion, "60 mm", TranslatingRoller("12 mm"))


RAM = cam_mechanism(roller_cam(), "2 kg", loads=Loads("-60 N", stiffness="3 N/mm"))
ROCKER = four_bar(
    "0.1 m",
    "0.3 m",
    "0.25 m",
    "0.35 m",
    bodies={"rocker": "0.05 kg m^2", "coupler": Body("1 kg", centre=("0.1 m", "50 mm"))},
    branch="crossed",
)
#: tables of files that hold tables, with what the functions make of the same
KINDS: dict[str, tuple[Mapping[str, Any], Mechanism]] = {
    "slider crank": (
        CRANK,
        slider_crank(
            "0.1 m",
            "0.4 m",
            bodies={"crank": "0.02 kg m^2", "slider": "5 kg", "rod": Body("2 kg", centre=("0.2 m", "0 m"))},
            loads=Loads([tuple(pair) for pair in FORCE], gravity="180 deg"),
            over=("0 deg", "180 deg"),
        ).with_friction(coulomb="0.5 N m"),
    ),
    "cam": (CAM, RAM),
    "table": ({**TABLE, "viscous": "0.1 N m s/rad"}, Mechanism(TABLE["inertia"], viscous="0.1 N m s/rad")),
}


def entries(mechanism: Mapping[str, Any] | None, drive: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """The entries of a problem file with an axis that turns by 45 deg and returns."""
    segments = [{"kind": "rise", "by": "45 deg", "duration": "0.2 s"}, {"kind": "return"}]
    tables = {name: table for name, table in {"mechanism": mechanism, "drive": drive}.items() if table is not None}
    axis = {"name": "input", "minimise": "rms torque", "segment": segments, **tables}
    return {"job": "cycle", "title": "Driven", "period": "0.5 s", "axis": [axis]}


def driven(mechanism: Mapping[str, Any] | None, drive: Mapping[str, Any] | None = None) -> Any:
    """What drives the axis of such a file."""
    return read(entries(mechanism, drive), Path("driven.toml"))[1]["input"].drive


@pytest.mark.parametrize("kind", KINDS)
def test_a_kind_is_what_its_function_makes(kind: str) -> None:
    table, mechanism = KINDS[kind]
    assert driven({"kind": kind, **table}) == mechanism


def test_a_cam_of_an_earlier_file_has_its_prime_circle_by_another_name() -> None:
    flat = {"kind": "cam", **CAM, "follower": {"kind": "translating flat"}}
    former = {name: value for name, value in flat.items() if name != "prime_radius"} | {"base_radius": "60 mm"}
    assert driven(former) == driven(flat)
    with pytest.raises(InputError, match="write prime_radius = '60 mm' for the same cam, or prime_radius = '72 mm'"):
        driven(former | {"follower": CAM["follower"]})


def test_a_motor_is_given_in_the_file_or_by_a_catalogue(tmp_path: Path) -> None:
    drive = driven(CRANK, DRIVE)
    assert drive == Drive(
        KINDS["slider crank"][1],
        Motor("3e-4 kg m^2", rated_torque="2 N m", curve=MOTOR["curve"]),
        ratio=20.0,
        efficiency=(0.9, 0.8),
        inertia="1e-4 kg m^2",
        regeneration=0.5,
    )
    (tmp_path / "motors.toml").write_text('[small]\ninertia = "3e-4 kg m^2"\nrated_torque = "2 N m"\n', "utf-8")
    named = entries(CRANK, {"motor": "small", "motors": "motors.toml", "ratio": 3.0})
    taken: Any = read(named, tmp_path / "driven.toml")[1]["input"].drive
    assert taken.motor == Motor("3e-4 kg m^2", rated_torque="2 N m", name="small")
    with pytest.raises(InputError, match=r"axis input: drive: motor: .*/motors.toml: unknown motor 'smal'; .*'small'"):
        read(entries(CRANK, {"motor": "smal", "motors": "motors.toml"}), tmp_path / "driven.toml")


@pytest.mark.parametrize("entry", Drive.form()["entries"], ids=lambda entry: entry["name"])
def test_every_entry_of_a_drive_that_forms_offer_is_one_of_files(entry: dict[str, Any]) -> None:
    """What a form asks can be given in a file, and changes the drive that is made of it."""
    plain = driven(CRANK, {"motor": MOTOR})
    changed = driven(CRANK, {"motor": MOTOR, entry["name"]: entry["example"]})
    assert changed != plain
    assert changed.to_dict().keys() - plain.to_dict().keys() <= {entry["name"]}
    drive = {"motor": MOTOR, entry["name"]: changed.to_dict()[entry["name"]]}
    (again,) = read(entries(CRANK, drive), Path("again"))[1:]
    assert again["input"].drive == changed


@pytest.mark.parametrize("drive", [RAM, ROCKER, driven(CRANK, DRIVE)], ids=["cam", "linkage", "motor"])
def test_a_file_that_is_written_is_read_again(drive: Mechanism | Drive, tmp_path: Path) -> None:
    cycle = Cycle(
        [Rise("45 deg", "0.2 s"), Dwell("0.1 s"), Return()], period="0.5 s", drive=drive, minimise="rms torque"
    )
    file = tmp_path / "written.toml"
    file.write_text(cycle.to_toml("Written", axis="input"), "utf-8")
    again = read(reading.toml(file), file)[1]["input"]
    assert again.to_dict() == cycle.to_dict()
    assert again.drive == drive


def places(data: object, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Where the leaves and branches of plain data are."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ():
        yield (*path, key)
        yield from places(value, (*path, key))


def damaged(data: dict[str, Any], path: tuple[Any, ...], value: object) -> dict[str, Any]:
    """A copy of plain data with another value in a place."""
    changed = copy.deepcopy(data)
    place: Any = changed
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return changed


@pytest.mark.parametrize("value", [{"x": 1}, [[1]], "3 mm s", -1], ids=str)
def test_damage_is_refused_by_name_or_leaves_something_whole(value: object) -> None:
    """No place of a file or of stored data gives an error of Python; most give one of ours."""
    file = entries(CRANK, DRIVE)["axis"][0]
    stored = json.loads(
        Cycle([Rise("45 deg", "0.2 s"), Return()], period="0.5 s", drive=driven(CRANK, DRIVE)).to_json()
    )
    refused = 0
    tried = [damaged(file, path, value) for path in places(file) if path[0] in {"mechanism", "drive"}]
    for axis in tried:
        try:
            read({**entries(CRANK), "axis": [axis]}, Path("driven.toml"))
        except OptlawsError as error:
            refused += "axis input: " in str(error) or "driven.toml" in str(error)
    damaged_json = [damaged(stored, path, value) for path in places(stored) if path[0] == "drive"]
    for data in damaged_json:
        try:
            Cycle.from_dict(data)
        except OptlawsError:
            refused += 1
    assert refused > 0.85 * (len(tried) + len(damaged_json))


SHORT_TABLE = {"kind": "table", "inertia": "0.1 kg m^2", "load": [["0 deg", "1 N m"], ["30 deg", "4 N m"]]}
WRONG: dict[str, tuple[dict[str, Any], dict[str, Any] | None, str]] = {
    "no kind": ({"crank": "0.1 m"}, None, "mechanism: a mechanism needs its kind: give one of belt, cam, four bar"),
    "length": ({"kind": "toggle", "rod": "0.3 m"}, None, "give it in the table lengths = { rod = ... }"),
    "body": (
        {**CRANK, "bodies": {"slidr": "5 kg"}},
        None,
        "mechanism: bodies: unknown body 'slidr'; did you mean 'slider'",
    ),
    "entry of a body": (
        {**CRANK, "bodies": {"rod": {"mas": "5 kg"}}},
        None,
        "mechanism: bodies: rod: unknown entry of a body 'mas'; did you mean 'mass'",
    ),
    "negative inertia": (
        {**CRANK, "bodies": {"crank": "-0.02 kg m^2"}},
        None,
        "mechanism: bodies: crank must be at least 0, got '-0.02 kg m^2'",
    ),
    "not assembled": (
        {"kind": "four bar", "crank": "0.2 m", "coupler": "0.15 m", "rocker": "0.2 m", "frame": "0.3 m", "bodies": {}},
        None,
        "mechanism: the crank reaches no angle from 86.4167 to 273.583 deg",
    ),
    "short table": (SHORT_TABLE, None, "the mechanism is defined from 0 deg to 30 deg, got 45 deg"),
    "table and range": (
        {**SHORT_TABLE, "over": ["0 deg", "45 deg"]},
        None,
        "the table of the load goes from 0 deg to 30 deg, and the mechanism from 0 deg to 45 deg",
    ),
    "slides": (
        {"kind": "table", "inertia": "3 kg", "axis": "length"},
        None,
        "the input of the mechanism slides and the motion of the cycle turns",
    ),
    "time in a cam": (
        {"kind": "cam", **CAM, "segment": [{"kind": "rise", "by": "3 mm", "duration": "0.1 s"}]},
        None,
        "segment 1: duration over a turn of the cam must be an angle",
    ),
    "constants beside": (CRANK, {"mass": "3 kg"}, "drive: beside a mechanism it has a motor"),
    "no catalogue": (CRANK, {"motor": "small"}, "drive: motor: 'small' is one of a catalogue: give its file"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_named(name: str) -> None:
    mechanism, drive, text = WRONG[name]
    with pytest.raises(InputError) as caught:
        read(entries(mechanism, drive), Path("driven.toml"))[1]["input"].objective  # noqa: B018 - laws are looked for now
    assert text in str(caught.value)


def test_a_motor_without_a_mechanism_is_refused() -> None:
    with pytest.raises(InputError, match="axis input: drive: a motor drives a mechanism: give the axis its table"):
        driven(None, DRIVE)


TURNTABLE = """
job = "cycle"
title = "Table"
period = "0.6 s"
rows = 13
[[axis]]
name = "table"
advance = "45 deg"
mechanism = { kind = "table", inertia = "0.8 kg m^2" }
[axis.drive]
motor = { inertia = "3e-4 kg m^2", rated_torque = "2 N m", peak_torque = "3 N m", greatest_speed = "3000 rpm" }
ratio = 20
efficiency = 0.85
[[axis.segment]]
kind = "rise"
by = "45 deg"
duration = "0.25 s"
law = "modified sine"
[[axis.segment]]
kind = "dwell"
"""


@pytest.mark.long
def test_pages_and_tables_say_what_the_motor_needs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A rotary table of known sizing: 3.686 N m, 1.490 N m RMS, 1056 rpm, 229 W; a motor of 3 N m is too weak."""
    file = tmp_path / "table.toml"
    file.write_text(TURNTABLE, "utf-8")
    assert exit_code(["cycle", str(file), "--json"]) == 0
    motor = json.loads(capsys.readouterr().out)["table"]["motor"]
    known = {"peak_torque": 3.686, "rms_torque": 1.490, "peak_speed": 110.559, "motoring_power": 228.645}
    assert {name: round(motor[name], 3) for name in known} == pytest.approx(known, abs=5e-4)
    assert exit_code(["cycle", str(file), "--out", str(tmp_path / "out")]) == 0
    files = {path.name for path in (tmp_path / "out").iterdir()}
    assert files == {"table.svg", "table_motor.svg", "cycle.md", "cycle.json", "table.csv"}
    rows = [line.split(",") for line in (tmp_path / "out" / "table.csv").read_text("utf-8").splitlines()[1:]]
    heading = ",".join(rows[0])
    assert heading.endswith('"torque, N m","power, W","motor speed, rpm"')
    values = [[float(cell) for cell in row[-3:]] for row in rows[1:]]
    # torque times speed is power
    assert all(t * n * 3.141592653589793 / 30.0 == pytest.approx(p, rel=1e-6, abs=1e-6) for t, p, n in values)
    page = (tmp_path / "out" / "cycle.md").read_text("utf-8")
    assert "| peak torque, used | 122.86 | % | too weak |" in " ".join(page.split())
    picture = (tmp_path / "out" / "table_motor.svg").read_text("utf-8")
    assert "<!-- continuous torque, 74.5 % used -->" in picture
    assert "<!-- speed of the motor, rpm -->" in picture


def test_the_energies_of_a_cycle_differ_by_what_friction_takes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A lift with 0.1 N m of friction over 20 rad, which holds 8 kg at 30 mm by the ratio."""
    lift = belt("30 mm", "8 kg", inertia="2e-4 kg m^2", loads=Loads(gravity="180 deg")).with_friction(coulomb="0.1 N m")
    drive = Drive(lift, Motor("3e-4 kg m^2"), ratio=2.5, regeneration=0.75)
    ways = [Rise("10 rad", "0.3 s", law="345"), Dwell("0.2 s"), Return(duration="0.25 s", law="cycloidal"), Dwell()]
    file = tmp_path / "lift.toml"
    file.write_text(Cycle(ways, period="1 s", drive=drive).to_toml("Lift", axis="lift"), "utf-8")
    assert exit_code(["cycle", str(file), "--json"]) == 0
    motor = json.loads(capsys.readouterr().out)["lift"]["motor"]
    assert motor["motoring_energy"] - motor["braking_energy"] == pytest.approx(2.0, rel=1e-9)
    assert motor["energy"] == pytest.approx(2.0 + 0.25 * motor["braking_energy"], rel=1e-9)
    assert motor["braking_heat"] == pytest.approx(0.25 * motor["braking_energy"], rel=1e-9)
    assert motor["holding_torque"] == pytest.approx(8.0 * 9.80665 * 0.03 / 2.5, rel=1e-12)
    sheets = [drive.sheet(law, "0 rad", "10 rad", time) for law, time in (("345", "0.3 s"), ("cycloidal", "0.25 s"))]
    assert motor["peak_speed"] == pytest.approx(max(sheet.peak_speed for sheet in sheets), rel=1e-9)


def with_sweep(sweep: str, text: str = TURNTABLE) -> str:
    """A problem file with a sweep."""
    return text.replace("[[axis]]", f"[[sweep]]\n{sweep}\n[[axis]]", 1)


def test_a_sweep_of_the_ratio_says_what_each_costs(tmp_path: Path) -> None:
    file = tmp_path / "swept.toml"
    file.write_text(with_sweep('axis = "table"\nentry = "drive.ratio"\nvalues = [20, 60, 100]'), "utf-8")
    spec, _ = read(reading.toml(file), file)
    headings, rows = sweeps_of(spec, file)[0].table
    assert headings[0] == "drive.ratio"
    for row, ratio in zip(rows, (20, 60, 100), strict=True):
        sheet = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2"), ratio=ratio, efficiency=0.85).sheet(
            "modified sine", "0 deg", "45 deg", "0.25 s", period="0.6 s"
        )
        cells = dict(zip(headings, row, strict=True))
        assert cells["drive.ratio"] == ratio
        assert cells["peak torque, N m"] == pytest.approx(sheet.peak_torque, rel=1e-9)
        assert cells["RMS torque, N m"] == pytest.approx(sheet.rms_torque, rel=1e-9)
    assert rows[0][-1] == pytest.approx(122.8601, rel=1e-5)  # of the peak torque of 3 N m
    assert rows[2][-1] == pytest.approx(100.0 * 1055.762 * 5.0 / 3000.0, rel=1e-5)  # of the speed


def swept(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, values: str, objective: Callable[[float], float]) -> Any:
    """A sweep of the ratio, of cycles that are not computed: their objective is that of a function of it."""

    def cycle_of(axis: Any, *_: Any) -> Any:
        ratio = axis.drive["ratio"]
        known = {"objective": objective(ratio), "lower_bound": 0.0, "minimise": "torque", "status": Status.OPTIMAL}
        known["lower_bound_name"] = "proven lower bound"
        return SimpleNamespace(**known, peaks=(), solutions=(1,), axis="angle", drive=None)

    monkeypatch.setattr(cycle_sweeps, "cycle_of", cycle_of)
    monkeypatch.setattr(cycle_sweeps, "objective_unit", lambda *_: "N m")
    file = tmp_path / "swept.toml"
    file.write_text(with_sweep(f'axis = "table"\nentry = "drive.ratio"\nvalues = {values}'), "utf-8")
    spec, _ = read_given(reading.toml(file), file)
    return cycle_sweeps.sweeps_of(spec, file)[0]


@pytest.mark.parametrize("best", [23.0, 37.7, 55.0])
def test_a_sweep_goes_on_beside_the_best_value(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, best: float) -> None:
    sweep = swept(monkeypatch, tmp_path, "[10, 20, 40, 60, 80]", lambda ratio: ratio / best + best / ratio)
    least = min(row.objective for row in sweep.rows)
    assert 2.0 <= least <= 2.0 * (1.0 + 3e-4)
    assert [row.value for row in sweep.rows] == sorted(row.value for row in sweep.rows)
    assert 5 < len(sweep.rows) <= 9
    assert "Added between the values that are given: " in sweep.remark
    assert sweep.table.rows == [[row.value, "optimal", row.objective, None] for row in sweep.rows]


@pytest.mark.parametrize(("values", "last"), [("[10, 20, 40]", "40"), ("[40, 20]", "40")])
def test_a_sweep_says_that_the_best_value_is_the_last(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, values: str, last: str
) -> None:
    sweep = swept(monkeypatch, tmp_path, values, lambda ratio: 1.0 / ratio)
    assert len(sweep.rows) == len(sweep.entries.values)
    assert f"is at drive.ratio = {last}. It is the greatest of the values, at the edge of the sweep" in sweep.remark
    assert "Widen the sweep: add 80 to its values." in sweep.remark


def test_a_sweep_that_is_stopped_has_the_rows_so_far(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def objective(ratio: float) -> float:
        if ratio > 20.0:
            raise KeyboardInterrupt
        return ratio

    sweep = swept(monkeypatch, tmp_path, "[10, 20, 40, 60]", objective)
    assert [row.value for row in sweep.rows] == [10.0, 20.0]
    assert sweep.stopped
    assert sweep.remark.startswith("The sweep of drive.ratio was stopped after 2 of 4 values. The least torque")
    with pytest.raises(KeyboardInterrupt):
        swept(monkeypatch, tmp_path, "[40, 60]", objective)


def test_what_a_stopped_sweep_has_is_written_and_the_command_says_so(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def stopped(*given: Any) -> Any:
        if given[3] > 20.0:
            raise KeyboardInterrupt
        return computed(*given)

    computed = cycle_sweeps._swept
    monkeypatch.setattr(cycle_sweeps, "_swept", stopped)
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "swept.toml"
    file.write_text(with_sweep('axis = "table"\nentry = "drive.ratio"\nvalues = [20, 60, 100]'), "utf-8")
    assert exit_code(["cycle", str(file)]) == 130
    said = capsys.readouterr().err
    assert "drive.ratio = 20: optimal" in said
    assert "The sweep of drive.ratio was stopped after 1 of 3 values." in said
    rows = (tmp_path / "results" / "swept" / "sweep_1.csv").read_text("utf-8").splitlines()
    assert [row.partition(",")[0] for row in rows[2:]] == ["20"]


@pytest.mark.long
def test_a_sweep_of_a_limit_has_rows_without_a_law(tmp_path: Path) -> None:
    text = TURNTABLE.replace('law = "modified sine"\n', 'limits = { velocity = "4.8 rad/s" }\n')
    sweep = 'axis = "table"\nentry = "segment.1.limits.velocity"\nvalues = ["3 rad/s", "4.8 rad/s"]'
    file = tmp_path / "swept.toml"
    file.write_text(with_sweep(sweep, text), "utf-8")
    assert exit_code(["run", str(file), "--out", str(tmp_path / "out")]) == 0
    with (tmp_path / "out" / "sweep_1.csv").open(encoding="utf-8") as lines:
        rows = list(csv.reader(lines))[1:]
    assert [row[:2] for row in rows[1:]] == [["3 rad/s", "infeasible"], ["4.8 rad/s", "optimal"]]
    assert rows[0][2] == "least acceleration, rad/s²"
    assert rows[1][2] == ""
    assert rows[0][-1] == "reason"
    assert rows[1][-1].startswith("segment 1 (Rise): 45 deg in 0.25 s are 180 deg/s on average")
    assert "its velocity is to be at most 171.887339 deg/s: give it more time" in rows[1][-1]
    assert rows[2][-1] == ""
    assert float(rows[2][2]) > 4.0 * (3.141592653589793 / 4.0) / 0.25**2  # C is at least 4
    assert "<!-- least acceleration -->" in (tmp_path / "out" / "sweep_1.svg").read_text("utf-8")


@pytest.mark.parametrize(
    ("sweep", "text"),
    [
        (
            'axis = "tabel"\nentry = "drive.ratio"\nvalues = [1, 2]',
            "sweep of drive.ratio: unknown axis 'tabel'; did you",
        ),
        ('axis = "table"\nentry = "drvie.ratio"\nvalues = [1, 2]', "unknown entry 'drvie'; did you mean 'drive'"),
        (
            'axis = "table"\nentry = "drive.ratoi"\nvalues = [1, 2]',
            "sweep of drive.ratoi, 1.*unknown entry of a drive 'ratoi'; did you",
        ),
        ('axis = "table"\nentry = "drive.ratio"\nvalues = [1, -2]', "sweep of drive.ratio, -2.*ratio must be above 0"),
        ('axis = "table"\nentry = "segment.3.by"\nvalues = ["1 deg", "2 deg"]', "unknown entry '3'; known are 1, 2"),
        ('axis = "table"\nentry = "drive"\nvalues = [1, 2]', "sweep of drive, 1"),
        ('axis = "table"\nentry = "order.of.it"\nvalues = [1, 2]', "'order.of.it' must end in the name of an entry"),
        (
            'axis = "table"\nentry = "segment.9.by"\nvalues = [1, 2]',
            "entry 'segment.9.by': unknown entry '9'; known are",
        ),
        ('axis = "table"\nentry = "drive.ratio"\nvalues = [1]', "values"),
    ],
)
def test_a_wrong_sweep_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str], sweep: str, text: str) -> None:
    file = tmp_path / "swept.toml"
    file.write_text(with_sweep(sweep), "utf-8")
    assert exit_code(["run", str(file), "--out", str(tmp_path / "out")]) == 2
    assert re.search(f"swept.toml.*{text}", capsys.readouterr().err)


@pytest.mark.parametrize("kind", MechanismKind.kinds().values(), ids=lambda kind: kind.kind)
def test_a_kind_with_the_examples_of_its_entries_is_written_and_read_again(kind: type[MechanismKind]) -> None:
    """The examples that errors, forms and references show are values; the friction of all kinds is in the mechanism."""
    shown = kind.form()["entries"]
    needed = {each["name"]: each["example"] for each in shown if each["needed"]}
    value = kind.from_dict({"kind": kind.kind, **needed, "coulomb": "0.2 N m"})
    if kind.kind not in {"cam", "table"}:  # which are made of values
        made = getattr(optlaws, kind.kind.replace(" ", "_"))(**needed)
        assert made.with_friction(coulomb="0.2 N m") == value.mechanism
    assert kind.from_dict(json.loads(json.dumps(value.to_dict()))).mechanism == value.mechanism
    assert value.mechanism.coulomb == 0.2
    for each in shown:
        if "example" in each and not each["needed"]:
            assert kind.from_dict({"kind": kind.kind, **needed, each["name"]: each["example"]}) != value
    with pytest.raises(InputError, match=f"unknown entry of a(n?) {kind.kind} 'coulmob'; did you mean 'coulomb'"):
        kind.from_dict({"kind": kind.kind, **needed, "coulmob": "0.2 N m"})


def made_of(value: Any) -> Any:
    """The mechanism of its entries; others are made already."""
    return value.mechanism if isinstance(value, MechanismKind) else value


WRONG_VALUES = [True, "3 furlongs", -float("inf"), {"x": 1}, [[[1]]]]


@pytest.mark.parametrize("value", WRONG_VALUES, ids=str)
@pytest.mark.parametrize("kind", [*MechanismKind.kinds().values(), Drive, Motor], ids=lambda kind: kind.__name__)
def test_no_entry_takes_a_value_of_another_type(kind: type[MechanismKind] | type[Drive | Motor], value: object) -> None:
    """Errors name the entry, or the entry of its table, and none of Python's comes through."""
    shown = kind.form()["entries"]
    needed = {each["name"]: each["example"] for each in shown if each["needed"]}
    beside = {"kind": kind.kind} if issubclass(kind, MechanismKind) else {"mechanism": RAM}
    for each in shown:
        data = {**({} if kind is Motor else beside), **needed, each["name"]: value}
        with pytest.raises(InputError, match=each["name"]):
            made_of(kind.from_dict(data))
