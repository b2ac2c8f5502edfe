"""What jobs and commands write `optlaws verify` proves: random ones of every kind, with zeros and odd units."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pytest

from tests.check_proofs import run
from tests.internals.cli import exit_code
from tests.internals.jobs import JOBS

Numbers: TypeAlias = np.random.Generator
Entries: TypeAlias = "dict[str, Any]"

#: what the pages on verification say has no proof beside it
PARTLY = re.compile(
    r"not checked (at [^:]* s: )?"
    r"(the best possible( time)?: .* in doubles|the file: results without proofs|the law: "
    r"|lower_bound: .* do not prove alone)"
)
#: exit codes of a problem that is refused, has no law, or whose solver stopped
REFUSED = {2, 3, 4}
PROVEN, PARTLY_CHECKED = 0, 3


def of(numbers: Numbers, *values: Any) -> Any:
    """One of some values."""
    return values[int(numbers.integers(len(values)))]


def quantity(numbers: Numbers, low: float, high: float, unit: str) -> str:
    """A quantity whose size is anywhere between two."""
    return f"{float(np.exp(numbers.uniform(np.log(low), np.log(high)))):.6g} {unit}"


def scaled(value: str, by: float) -> str:
    number, unit = value.split(" ", 1)
    return f"{float(number) * by!r} {unit}"


# --- problems of laws ---


def basis(numbers: Numbers) -> Entries:
    entries: Entries = of(
        numbers,
        {"degree": int(numbers.integers(3, 10))},
        {"basis": "powers", "degree": int(numbers.integers(2, 7))},
        {"basis": "pieces", "breaks": int(2 * numbers.integers(1, 4)), "degree": 7, "continuity": 3},
        {"basis": "bsplines", "breaks": int(2 * numbers.integers(1, 4)), "degree": 5, "continuity": 3},
    )
    return entries


def objective(numbers: Numbers) -> str:
    nu, damping = float(numbers.uniform(8, 25)), of(numbers, 0.0, 0.0, 0.03)
    size = of(numbers, 1.0, 1e-9, 1e9)
    text: str = of(
        numbers,
        *("C", "J", "D", "rms_c", "rms_j", "snap", "C_plus", "C_minus", "B"),
        f"{size!r}*C",
        f"max({size!r}*C, {size / 9!r}*J)",
        f"{size!r}*C + {0.02 * size!r}*rms_j",
        f"residual(frequency={nu!r}, damping={damping!r})",
        f"residual(frequency=({nu!r}, {1.05 * nu!r}), damping={damping!r}) + 0.01*J",
        f"peak({size!r}*c + {of(numbers, 0.0, 0.3) * size!r}*b)",
        f"rms({size!r}*c + {of(numbers, 0.0, 2.0) * size!r}*a)",
        f"peak({size!r}*c + {3 * size!r})",
    )
    return text


def solutions(numbers: Numbers) -> Entries:
    bounds = of(
        numbers, {}, {"B": float(numbers.uniform(1.5, 2.1))}, {"B": [0.0, 1.8]}, {"C": [0.0, 8.0]}, {"J": [0.0, 70.0]},
        {"windows": [{"quantity": "c", "low": -20.0, "high": 0.0, "start": 0.5, "stop": 1.0}]},
        {"symmetric": False},
        {"monotone": True}, {"symmetric": False, "inflexion": 0.4},
    )  # fmt: skip
    return {
        "job": "solutions",
        "columns": ["C", "J", "lower bound", "gap", "status"],
        "problem": {"order": int(numbers.integers(2, 5)), **basis(numbers), **bounds},
        "sweep": [{"minimise": [objective(numbers), objective(numbers)]}],
    }


# --- moves ---


def fastest_moves(numbers: Numbers) -> Entries:
    return {"job": "fastest", "problem": {"order": 3, "degree": 5}, "move": [move(numbers)]}


def move(numbers: Numbers) -> Entries:
    unit = of(numbers, 1.0, 1.0, 1e-9, 1e-6, 1e6)
    stroke = scaled(quantity(numbers, 10, 1000, "mm"), unit)
    acceleration = scaled(quantity(numbers, 2, 20, "m/s^2"), unit)
    limits = {"acceleration": acceleration, "jerk": scaled(quantity(numbers, 100, 3000, "m/s^3"), unit)}
    if numbers.random() < 0.4:
        limits["velocity"] = scaled(quantity(numbers, 0.3, 2, "m/s"), unit)
    kind = of(numbers, "plain", "several", "ends", "follower", "quiet", "motor", "motor")
    entries: Entries = {"name": "one", "stroke": stroke, "limits": limits}
    if kind == "several":
        entries["stroke"] = [stroke, scaled(stroke, 1.7)]
    elif kind == "ends":
        entries["end_velocity"] = scaled(of(numbers, "0 m/s", "0.1 m/s", "-0.05 m/s"), unit)
    elif kind == "motor":
        return motor_move(numbers)
    else:
        damping = of(numbers, 0.0, 0.0, 0.02)
        frequency: Any = of(numbers, "16 Hz", ["15 Hz", "17 Hz"])
        entries["follower"] = {"frequency": frequency, "damping": damping}
        if kind == "quiet":
            entries["limits"] |= {"residual acceleration": scaled(acceleration, of(numbers, 1e-3, 0.1))}
        else:
            entries["front"] = {"minimise": ["residual acceleration", of(numbers, "jerk", "velocity")], "points": 3}
    return entries


def motor_move(numbers: Numbers) -> Entries:
    unit = of(numbers, 1.0, 1.0, 1e-6, 1e6)
    zero: dict[str, Any] = of(
        numbers, {}, {"load": "0 N m"}, {"coulomb": "0 N m", "viscous": "0 N m s/rad"}, {"load": load(numbers, unit)}
    )
    motor: Entries = {
        "inertia": scaled(of(numbers, "0 kg m^2", "3e-4 kg m^2"), unit),
        "peak_torque": scaled(quantity(numbers, 3, 9, "N m"), unit),
    }
    efficiency = of(numbers, {}, {}, {"efficiency": 0.8})
    least = of(numbers, "torque", "rms torque", "energy", "acceleration")
    return {
        "name": "one",
        "stroke": of(numbers, "45 deg", "360 deg"),
        "start": of(numbers, "0 deg", "30 deg"),
        "limits": of(numbers, {}, {"jerk": "3000 rad/s^3"}, {"velocity": "9 rad/s"}),
        "mechanism": {"kind": "table", "inertia": scaled("0.8 kg m^2", unit), **zero},
        "drive": {"motor": motor, "ratio": of(numbers, 1, 20), **efficiency},
        "front": {"minimise": [least], "points": 2},
    }


def load(numbers: Numbers, unit: float) -> str:
    return scaled(of(numbers, "2 N m", "-2 N m"), unit)


# --- machines, cycles and cams ---


def machine_laws(numbers: Numbers) -> Entries:
    unit, damping = of(numbers, 1.0, 1.0, 1e-9, 1e9), of(numbers, 0.0, 1.0)
    stiffness = float(numbers.uniform(100.0, 800.0))
    outputs = {"torque": "drive force", "sway": "deflection motor-load"}
    keep = of(
        numbers,
        [],
        [{"residual": 1, "output": "sway", "most": of(numbers, 0.0, 1e-9)}],
        [{"residual": 1, "output": "sway", "spread": 0.1, "most": 0.01}],
        [{"residual": 1, "output": "torque", "most": unit * 5.0}],
    )
    least = of(numbers, {"peak": "torque"}, {"rms": "torque"}, {"peak": "sway"}, {"rms": "sway"})
    return {
        "job": "machine laws",
        "report": ["torque"],
        "standard": ["cycloidal"],
        "machine": {
            "masses": {"motor": of(numbers, 1.0, 0.1) * unit, "load": 2.0 * unit},
            "links": [["motor", "load", stiffness * unit, damping * unit]],
            "drive": "motor",
            "outputs": outputs,
        },
        "units": {"torque": "N m"},
        "vibration": {"output": "sway"},
        "sought": [
            {
                "name": "ours",
                "minimise": least,
                "keep": [*keep, {"constant": "J", "most": 400.0}],
                "problem": {"order": 3, "degree": int(numbers.integers(6, 10))},
            }
        ],
        "figure": {"output": "torque", "laws": ["ours"]},
    }


def axis(numbers: Numbers, name: str) -> Entries:
    unit = of(numbers, 1.0, 1.0, 1e-9, 1e6)
    stroke = scaled(quantity(numbers, 10, 100, "mm"), unit * of(numbers, 1.0, -1.0))
    drive = {"mass": scaled(of(numbers, "0 kg", "2 kg"), unit), "dry": scaled(of(numbers, "0 N", "5 N"), unit)}
    law = of(numbers, {}, {}, {"law": of(numbers, "cycloidal", "modified sine", "3-4-5")})
    there = {"kind": "move", "by": stroke, "duration": of(numbers, "120 deg", "60 deg"), **law}
    return {
        "name": name,
        "minimise": of(numbers, "acceleration", "jerk", "velocity", "rms acceleration"),
        "drive": drive,
        "order": int(numbers.integers(2, 5)),
        "degree": 7,
        "segment": [
            there,
            {"kind": "dwell", "duration": "90 deg"},
            {"kind": "move", "to": "0 mm", "duration": "100 deg"},
            {"kind": "dwell"},
        ],
    }


def cycle(numbers: Numbers) -> Entries:
    return {"job": "cycle", "speed": quantity(numbers, 1, 600, "rpm"), "rows": 13, "axis": [axis(numbers, "slide")]}


def fastest_cycle(numbers: Numbers) -> Entries:
    unit = of(numbers, 1.0, 1.0, 1e-9, 1e6)
    stroke = scaled(quantity(numbers, 10, 100, "mm"), unit * of(numbers, 1.0, -1.0))
    limits = {"acceleration": scaled(quantity(numbers, 5, 50, "m/s^2"), unit)}
    limits |= of(numbers, {}, {"velocity": scaled("0.8 m/s", unit)})
    limits |= of(numbers, {}, {"jerk": scaled("2500 m/s^3", unit)}, {"deceleration": scaled("15 m/s^2", unit)})
    segments = [
        {"kind": "move", "by": stroke},
        {"kind": "dwell", "duration": of(numbers, "40 ms", "90 deg")},
        {"kind": "move", "to": "0 mm"},
    ]
    return {
        "job": "cycle",
        "speed": "60 rpm",
        "rows": 13,
        "fastest": True,
        "axis": [{"name": "feed", "limits": limits, "segment": segments, "degree": 5}],
    }


def cam(numbers: Numbers) -> Entries:
    law = of(numbers, {}, {"law": "cycloidal"})
    curvature = of(numbers, {}, {"radius_of_curvature": "15 mm"})
    sought = of(numbers, {}, {"pressure_angle": "25 deg"}, {"best": "laws", "pressure_angle": "25 deg", **curvature})
    forces = of(numbers, {}, {"forces": {"irregularity": 0.05}})
    return {
        **sought,
        **forces,
        "job": "cam",
        "speed": "200 rpm",
        "rows": 13,
        "prime_radius": "50 mm",
        "follower": {"kind": "translating roller", "radius": "12 mm", "offset": of(numbers, "0 mm", "6 mm")},
        "motion": {
            "name": "slide",
            "drive": {
                "mass": "2 kg",
                "stiffness": of(numbers, "0 N/mm", "2 N/mm"),
                "preload": of(numbers, "0 N", "60 N"),
            },
            "segment": [
                {"kind": "rise", "by": quantity(numbers, 5, 25, "mm"), "duration": "120 deg", **law},
                {"kind": "return", **law},
            ],
        },
    }


DRAWN: dict[str, Callable[[Numbers], Entries]] = {
    "cam": cam,
    "cycle": cycle,
    "cycle, at greatest speed": fastest_cycle,
    "fastest": fastest_moves,
    "machine laws": machine_laws,
    "solutions": solutions,
}


# --- commands ---


def solve(numbers: Numbers) -> list[str]:
    entries = basis(numbers)
    words = ["solve", "--order", str(numbers.integers(2, 5)), "--minimise", objective(numbers)]
    for name in ("basis", "degree", "breaks", "continuity"):
        words += [f"--{name}", str(entries[name])] if name in entries else []
    words += of(
        numbers, [], ["--peak-velocity", "1.8"], ["--most", "C=8"], ["--unsymmetric"], ["--monotone"],
        ["--least", "C_minus=0"], ["--window", "c <= 0 @ 0.5..1"], ["--most-power", "9"],
    )  # fmt: skip
    return words


def solve_fastest(numbers: Numbers) -> list[str]:
    drawn = move(numbers) | {"name": "one"}
    while "drive" in drawn or not isinstance(drawn["stroke"], str) or "residual acceleration" in drawn["limits"]:
        drawn = move(numbers)
    words = ["solve", "--order", "3", "--degree", "5", "--fastest", "--stroke", drawn["stroke"]]
    return words + [word for name, value in drawn["limits"].items() for word in ("--limit", f"{name}={value}")]


def advise(numbers: Numbers) -> list[str]:
    unit = of(numbers, 1.0, 1e-9, 1e6)
    stroke = scaled(quantity(numbers, 1, 100, "mm"), unit).replace(" ", "")
    words = ["advise", "--stroke", stroke, "--duration", "0.1s", "--degree", "5", "--points", str(of(numbers, 0, 3))]
    words += ["--minimise", of(numbers, "acceleration", "jerk", "rms acceleration")]
    return [*words, *of(numbers, [], ["--mass", "2kg"], ["--frequency", "30Hz", "--damping", "0"])]


COMMANDS = {"solve": solve, "solve --fastest": solve_fastest, "advise": advise}


def toml(value: Any) -> str:
    """A value as TOML has it in one line."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(name)} = {toml(each)}" for name, each in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value)


def wrong(files: list[Path], capsys: pytest.CaptureFixture[str]) -> list[str]:
    """What `optlaws verify` says of files that it does not prove, nor partly as its pages tell."""
    said = []
    for file in files:
        capsys.readouterr()
        code = exit_code(["verify", str(file)])
        text = capsys.readouterr().out
        claims = [" ".join(line.split()) for line in text.splitlines() if line.startswith("not ")]
        lines = [line for line in claims if not PARTLY.search(line)]
        if code not in {PROVEN, PARTLY_CHECKED} or lines:
            said.append(f"{file.name}: {code}: {text}")
        second = run(file)
        if second.returncode not in {PROVEN, PARTLY_CHECKED}:
            said.append(f"{file.name} by the second program: {second.stdout[-5000:]}{second.stderr}")
    return said


def outcome(job: str, seed: int, folder: Path, capsys: pytest.CaptureFixture[str]) -> str:
    """What becomes of a drawn problem file: "written", and then verified, or why it was refused."""
    entries = {"title": job} | DRAWN[job](np.random.default_rng([seed, *job.encode()]))
    file, out = folder / f"{seed}.toml", folder / f"{seed}"
    file.write_text("\n".join(f"{name} = {toml(value)}" for name, value in entries.items()), "utf-8")
    code = exit_code(["run", str(file), "--out", str(out)])
    if code in REFUSED:
        return f"refused: {capsys.readouterr().err}"
    files = sorted(out.glob("*.json"))
    assert code == 0
    assert files
    said = wrong(files, capsys)
    assert not said, "\n".join([*said, file.read_text("utf-8")])
    return "written"


def outcome_of_command(name: str, seed: int, folder: Path, capsys: pytest.CaptureFixture[str]) -> str:
    """What becomes of drawn arguments of a command: "written", and then verified, or why they were refused."""
    words, file = COMMANDS[name](np.random.default_rng([seed, *name.encode()])), folder / f"{seed}.json"
    code = exit_code([*words, "--json", "--output", str(file)])
    if code in REFUSED:
        return f"refused: {capsys.readouterr().err}"
    assert code == 0
    said = wrong([file], capsys)
    assert not said, "\n".join([*said, " ".join(words)])
    return "written"


def test_every_job_with_data_is_drawn() -> None:
    assert {DRAWN[name](np.random.default_rng(0))["job"] for name in DRAWN} == set(JOBS)


@pytest.mark.sample(3)
@pytest.mark.parametrize("job", DRAWN)
def test_what_a_job_writes_is_proven(job: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert outcome(job, 0, tmp_path, capsys) == "written"


@pytest.mark.long
@pytest.mark.parametrize("job", DRAWN)
def test_what_random_jobs_write_is_proven(job: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    outcomes = Counter(outcome(job, seed, tmp_path, capsys).partition(":")[0] for seed in range(1, 31))
    assert outcomes["written"] > 18


@pytest.mark.sample(3)
@pytest.mark.parametrize("command", COMMANDS)
def test_what_a_command_writes_is_proven(command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert outcome_of_command(command, 0, tmp_path, capsys) == "written"


@pytest.mark.long
@pytest.mark.parametrize("command", COMMANDS)
def test_what_random_commands_write_is_proven(command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    outcomes = Counter(outcome_of_command(command, seed, tmp_path, capsys).partition(":")[0] for seed in range(1, 21))
    assert outcomes["written"] > 12
