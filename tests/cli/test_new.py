"""A problem file to begin with: it has the person's numbers, runs as written, and nothing is written over."""

import re
import shlex
import tomllib
from pathlib import Path

import pytest

from optlaws import Drive, InputError, Motor, TranslatingRoller
from tests.cli.test_show import Terminal
from tests.internals.cli import exit_code
from tests.internals.entries import entries_of
from tests.internals.jobs import (
    STARTERS,
    TYPES,
    CamProblemFile,
    MachineLawsProblemFile,
    numbers_of,
    read_given,
    read_of_cycle_entries,
)
from tests.internals.mechanisms import SliderCrank

PARTLY_CHECKED = 3
Capture = pytest.CaptureFixture[str]

#: numbers of a person, by kind
OWN = {
    "cycle": "--stroke '90 deg' --rise '0.1 s' --speed 100rpm --mass '0.02 kg m^2' --velocity '300 rpm'",
    "cam": "--stroke 20mm --prime-radius '70 mm' --offset '5 mm' --mass '2 kg' --jerk '9000 m/s^3'",
    "machine": "--stroke '4 rad' --duration '0.1 s' --frequency '56 Hz' --sway '5e-3 rad' --damping 0",
    "drive": "--stroke '30 deg' --friction '4 N m' --ratio 25 --period '0.8 s'",
    "mechanism": "--crank '80 mm' --rod '0.3 m' --load '1.2 kN'",
    "fastest": "--stroke '90 deg' --velocity '200 rpm' --frequency '20 Hz'",
    "barrel": "--stroke '40 mm' --rise '70 deg' --roller '9 mm' --outer-radius '70 mm' --depth '10 mm' --cutter '6 mm'",
    "interlock": "--stroke '80 mm' --index '60 mm' --clear '40 mm' --within '0.5 mm' --rise '70 deg'",
    "law": "--velocity '0.62 m/s' --jerk '2431 m/s^3' --order 4",
    "study": "--minimise rms_c --steps 2 --from 1.6",
}


@pytest.fixture(autouse=True)
def _here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def command_of(out: str) -> list[str]:
    """The command that runs the file, as it was printed."""
    name, *arguments = shlex.split(out.splitlines()[-1])
    assert name == "optlaws"
    return arguments


SLOW = {"cycle", "machine", "mechanism", "study"}
AS_WRITTEN = [(kind, options) for kind in STARTERS for options in ("", OWN[kind])]


@pytest.mark.parametrize(
    ("kind", "options"),
    [
        pytest.param(kind, options, marks=[pytest.mark.long] if kind in SLOW or options else [])
        for kind, options in AS_WRITTEN
    ],
)
def test_the_file_runs_as_written_and_what_it_writes_is_proven(kind: str, options: str, capsys: Capture) -> None:
    assert exit_code(["new", kind, "my file.toml", *shlex.split(options)]) == 0
    command = command_of(capsys.readouterr().out)
    assert exit_code(command) == 0
    assert "error" not in capsys.readouterr().out
    text = Path("my file.toml").read_text("utf-8")
    for given in shlex.split(options)[1::2]:
        if kind not in {"law", "machine", "study"}:
            assert f'{given}"' in text or f"= {given}\n" in text
    written = list(Path().glob("results/my file/*"))
    for file in (file for file in written if file.suffix == ".json"):
        assert exit_code(["verify", str(file)]) in {0, PARTLY_CHECKED}, file
    assert bool(written) == (kind != "study")


def test_numbers_of_a_machine_become_bounds_of_a_law(capsys: Capture) -> None:
    assert exit_code(["new", "law", *shlex.split(OWN["law"]), "--duration", "50 ms", "--acceleration", "98 m/s^2"]) == 2
    assert "--velocity must be above the mean velocity, 0.7 m/s" in capsys.readouterr().err
    assert exit_code(["new", "law", "--velocity", "1.4 m/s", "--duration", "50 ms", "--acceleration", "98 m/s^2"]) == 0
    text = Path("law.toml").read_text("utf-8")
    assert "\nB = [1, 2]\n" in text
    assert "\nC = [0, 7]\n" in text
    assert "c times 14 m/s²" in text


def test_entries_left_out_are_comments_with_examples_of_the_right_kind(capsys: Capture) -> None:
    assert exit_code(["new", "cycle", "a.toml"]) == 0
    assert exit_code(["new", "cycle", "b.toml", "--stroke", "90 deg"]) == 0
    straight, turning = (Path(name).read_text("utf-8") for name in ("a.toml", "b.toml"))
    assert '\n# drive = { mass = "2.5 kg" }\n# ' not in straight
    assert '\n# drive = { mass = "2.5 kg" }\n' in straight
    assert '\n# drive = { inertia = "0.02 kg m^2" }\n' in turning
    assert '\n# velocity = "200 rpm"\n' in turning
    # every entry behind a # may be switched on; modified sine is faster than the limit of the velocity
    for names, code in (("drive|velocity", 0), ("drive|law", 0), ("velocity|law", 3)):
        switched = re.sub(rf"(?m)^# ({names}) = .*", lambda line: line[0][2:], straight)
        Path("c.toml").write_text(switched, "utf-8")
        capsys.readouterr()
        assert exit_code(["cycle", "c.toml", "--json"]) == code


def test_nothing_is_written_over(capsys: Capture) -> None:
    Path("cycle.toml").write_text("mine", "utf-8")
    assert exit_code(["new", "cycle"]) == 2
    assert "cycle.toml exists already and is not overwritten" in capsys.readouterr().err
    assert Path("cycle.toml").read_text("utf-8") == "mine"


@pytest.mark.parametrize(
    "words",
    ["cycle --rise 300deg --dwell 100deg", "barrel --depth 90mm", "cam --rise 300deg --dwell 100deg"],
)
def test_an_error_names_the_file_once(words: str, capsys: Capture) -> None:
    kind, *options = words.split()
    assert exit_code(["new", kind, "a.toml", *options]) == 2
    assert capsys.readouterr().err.count("a.toml") == 1
    assert not Path("a.toml").exists()


def test_nothing_is_read_from_a_terminal(monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.setattr("sys.stdin", Terminal("100 deg\n"))
    assert exit_code(["new", "cycle", "--stroke", "20 mm"]) == 0
    assert capsys.readouterr().err == ""
    text = Path("cycle.toml").read_text("utf-8")
    assert re.findall(r'^(?:by|duration|speed) = "(.*)"', text, re.MULTILINE)[:3] == ["200 rpm", "20 mm", "120 deg"]


@pytest.mark.parametrize("kind", STARTERS)
def test_the_help_of_a_kind_lists_its_numbers_alone(kind: str, capsys: Capture) -> None:
    assert exit_code(["new", kind, "--help"]) == 0
    out = capsys.readouterr().out
    assert re.findall(r"--([a-z-]+) STR", out) == [*numbers_of(kind)]
    usual = [value for value in numbers_of(kind).values() if value is not None]
    assert all(f"{value} unless given" in " ".join(out.replace("│", " ").split()) for value in usual)


def test_the_help_groups_all_numbers_by_their_kinds(capsys: Capture) -> None:
    assert exit_code(["new", "--help"]) == 0
    out = capsys.readouterr().out
    assert sorted(re.findall(r"--([a-z-]+) STR", out)) == sorted(TYPES)
    assert {*STARTERS} == {
        kind for line in re.findall(r"Numbers for ([a-z, ]+[a-z]) ─", out) for kind in line.split(", ")
    }


def test_numbers_are_what_the_entries_that_they_are_for_may_be() -> None:
    cam, roller = entries_of(CamProblemFile), entries_of(TranslatingRoller)
    vibration = entries_of(MachineLawsProblemFile)["vibration"].type.tables()[""]
    declared = {"speed": cam["speed"], "pressure-angle": cam["pressure_angle"], "curvature": cam["radius_of_curvature"]}
    declared |= {"prime-radius": cam["prime_radius"], "roller": roller["radius"], "offset": roller["offset"]}
    motor, crank = entries_of(Motor), entries_of(SliderCrank)
    declared |= {"ratio": entries_of(Drive)["ratio"], "crank": crank["crank"], "rod": crank["rod"]}
    declared |= {"rotor": motor["inertia"]}
    declared |= {name: motor[name.replace("-", "_")] for name in ("rated-torque", "peak-torque", "greatest-speed")}
    for name, each in {**declared, "spread": vibration["spread"]}.items():
        assert TYPES[name] == each.type, name


def test_what_binds_the_overlap_of_two_axes_is_their_interlocks(capsys: Capture) -> None:
    """Both are touched at once, neither early nor late; and angles of the master alone leave every period possible."""
    assert exit_code(["new", "interlock", "a.toml"]) == 0
    assert exit_code(["run", "a.toml"]) == 0
    page = capsys.readouterr().out
    for name in ("leaves", "comes back"):
        assert re.search(rf"\| bound by +\| {name} +\| +\| interlock ", page)
        assert re.search(rf"\| {name} +\| clear +\| 0 .*\| 0 +\|", page)
    text = Path("a.toml").read_text("utf-8")
    Path("b.toml").write_text(re.sub(r"(?m)^overlap = .*", 'overlap = { goal = "period" }', text), "utf-8")
    assert exit_code(["run", "b.toml"]) == 2
    assert "nothing bounds the period" in capsys.readouterr().err
    limited = Path("b.toml").read_text("utf-8")
    for name, limit in (("slide", "20 m/s^2"), ("table", "50 rad/s^2")):
        limited = limited.replace(f'name = "{name}"', f'name = "{name}"\nlimits = {{ acceleration = "{limit}" }}')
    # neither a dwell that only waits needs a duration, nor a move, nor is a period needed, which is sought
    waiting = re.sub('(?m)^duration = .*\nleast = "0 s"\n', "", limited)
    untimed = re.sub("(?m)^duration = .*\n(?=# Without|law|least)|^speed = .*\n", "", limited)
    short = untimed.replace("overlap =", 'period = "0.1 s"\noverlap =')
    texts = (limited, waiting, untimed, short)
    first, *others = (read_of_cycle_entries(tomllib.loads(text), Path("c.toml"))[1].duration for text in texts)
    assert others == pytest.approx([first] * len(others), rel=1e-8)
    # a period that nobody gave is none to compare with
    compared = [
        (
            "speed, as a multiple of that before the overlap" in [row.name for row in overlap.summary()],
            overlap.gain is None,
        )
        for spec, given in (read_given(tomllib.loads(text), Path("c.toml")) for text in (limited, untimed))
        if (overlap := spec.overlap_of(given, Path("c.toml")))
    ]
    assert compared == [(True, False), (False, True)]
    unlimited = re.sub("(?m)^limits = .*\n", "", untimed)
    with pytest.raises(
        InputError, match=r"axis slide: segment 2 \(Rise\): nothing bounds its time: give it a duration"
    ):
        read_of_cycle_entries(tomllib.loads(unlimited), Path("c.toml"))


def test_a_drive_begins_with_nothing_worse_than_by_modified_sine(capsys: Capture) -> None:
    assert exit_code(["new", "drive", "a.toml", "--friction", "4 N m"]) == 0
    assert exit_code(["run", "a.toml"]) == 0
    rows = re.findall(r"(?m)^\| ([\w ]+?) +\| [\d.]+ +\| [\d.]+ +\| (same|[-+][\d.]+) ", capsys.readouterr().out)
    gains = {name: 0.0 if gain == "same" else float(gain) for name, gain in rows}
    assert {"torque", "RMS torque", "power", "energy", "velocity"} <= gains.keys()
    assert max(gains.values()) <= 0.0
    assert min(gains["RMS torque"], gains["power"], gains["energy"]) < -1.0


@pytest.mark.long
@pytest.mark.parametrize(
    "numbers",
    [
        "--stroke 40mm --rise 110deg --return 110deg",
        # the radius of curvature binds: `tests/cams/test_best_laws.py` has such cams of a lower degree each time
        "--stroke 10mm --rise 90deg --return 90deg",
    ],
)
def test_a_cam_begins_with_less_torque_at_its_shaft_than_by_modified_sine(numbers: str, capsys: Capture) -> None:
    given = [*shlex.split(numbers), "--speed", "180rpm", "--mass", "3kg"]
    assert exit_code(["new", "cam", "a.toml", *given]) == 0
    assert exit_code(["run", "a.toml"]) == 0
    page = capsys.readouterr().out
    assert "The follower stays on the cam." in page
    rows = re.findall(r"(?m)^\| ([\w ']+?) +\| [\d.]+ +\| [\d.]+ +\| (same|[-+][\d.]+) ", page)
    gains = {name: 0.0 if gain == "same" else float(gain) for name, gain in rows}
    assert {"greatest contact force", "RMS torque", "prime circle"} <= gains.keys()
    assert max(gains.values()) <= 0.0
    assert gains["peak torque at the shaft"] < -12.0
    assert gains["least prime circle"] <= 0.0


def test_a_drive_begins_with_the_efficiency_of_its_gear() -> None:
    assert exit_code(["new", "drive", "a.toml", "--efficiency", "0.9"]) == 0
    assert exit_code(["new", "drive", "b.toml"]) == 0
    assert "\nefficiency = 0.9\n" in Path("a.toml").read_text("utf-8")
    assert "\n# efficiency = 0.95\n" in Path("b.toml").read_text("utf-8")
