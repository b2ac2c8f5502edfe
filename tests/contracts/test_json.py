"""What leaves the library as JSON is JSON: no Infinity and no NaN, whatever jumps a law has."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any, NoReturn

import pytest

import optlaws
from optlaws import Chebyshev, Pieces, Powers, Problem, Solution, Window, deg, pareto_front, synthesize, verification
from optlaws.cli.app import exit_code
from tests.contracts.frozen import commands
from tests.documents import ROOT
from tests.laws.examples import EXAMPLES

#: an acceleration that jumps: J has no bound
JUMPS = Problem(order=2, basis=Pieces(degree=3, breaks=4, continuity=1), B=1.8)
STUDY = "[problem]\norder = 2\nbasis = 'pieces'\nbreaks = 4\ncontinuity = 1\ndegree = 3\n[vary]\nB = [1.8]\n"


def refuse(constant: str) -> NoReturn:
    raise AssertionError(f"{constant} is not JSON")


def strict(text: str) -> object:
    return json.loads(text, parse_constant=refuse)


@pytest.fixture(scope="module")
def jumping() -> Solution:
    return synthesize(JUMPS)


def test_an_infinite_constant_is_null(jumping: Solution) -> None:
    assert jumping.constants.J.value == float("inf")
    assert jumping.to_dict()["constants"]["J"]["value"] is None
    assert jumping.constants.to_dict(rms=True)["J"] == jumping.constants.J.to_dict()


@pytest.mark.parametrize("name", EXAMPLES)
def test_laws_and_their_constants(name: str) -> None:
    law = EXAMPLES[name]
    assert strict(json.dumps([law.to_dict(), law.constants.to_dict(rms=True)]))


def values(jumping: Solution) -> dict[str, Any]:
    """A value of every kind that gives plain data, each with something infinite in it where it can have it."""
    mechanism = optlaws.dwell_mechanism(
        "I",
        law=optlaws.catalogue["K"].law,
        dwell=deg(120),
        rise=deg(90),
        swing=deg(20),
        clutch_angle=deg(15),
        radius_ratio=1.0,
        inertia_ratio=0.1,
    )
    return {
        "Solution": jumping,
        "Problem": jumping.problem,
        "Basis": jumping.problem.basis,
        "Certificate": jumping.certificate,
        "PowerCertificate": synthesize(
            Problem(order=2, basis=Powers(3), B=1.8, minimise="D"), bound="tight"
        ).power_certificate,
        "Front": pareto_front(replace(JUMPS, B=None), points=2, between=(1.7, 1.9)),
        "Window": Window("b", high=1.9),
        "Loader": optlaws.loader(optlaws.catalogue["0050"].law),
        "BalancedLaw": optlaws.balanced_law(order=4, B=1.8, basis=Chebyshev(3)),
        "DwellMechanism": mechanism,
        "Verification": verification.verify(jumping.to_dict()),
        "Entry": optlaws.catalogue["constant velocity"],
        "Segment": EXAMPLES["power of time"].segments[0],  # type: ignore[attr-defined] # a piecewise law
    }


def test_every_value(jumping: Solution) -> None:
    for name, value in values(jumping).items():
        assert strict(json.dumps(value.to_dict())), name


COMMANDS = [
    "solve --order 2 --degree 3 --basis pieces --breaks 4 --continuity 1 --peak-velocity 1.8",
    "constants --order 1 --z 0.5",
    "law 0050 --at 0.5",
    "law II --alpha 1",
    "catalogue",
    "front --order 2 --degree 3 --points 2",
    "follower 0050 --nu 20",
    "loader 0050",
    "dwell K --dwell 90 --rise 90 --swing 20 --clutch-angle 15 --radius-ratio 1 --inertia-ratio 0.1 --most-torque 0.5",
    "lever --beta 0.75 --lam 1 --swing 60",
    f"atlas --order 4 --peak-velocity 1.71 --file {ROOT}/results/atlas/atlas.csv",
]


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_code([*command.split(), "--json"]) == 0
    assert strict(capsys.readouterr().out)


def test_commands_that_read_files(jumping: Solution, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    solution, study = tmp_path / "solution.json", tmp_path / "study.toml"
    solution.write_text(json.dumps(jumping.to_dict()), "utf-8")
    study.write_text(STUDY, "utf-8")
    for arguments in (["verify", solution], ["study", study, "--out", tmp_path / "out", "--workers", "1"]):
        assert exit_code([*map(str, arguments), "--json"]) == 0
        assert strict(capsys.readouterr().out)


def test_every_command_with_json_is_here() -> None:
    asked = {command.split()[0] for command in COMMANDS} | {"verify", "study"}
    assert asked == {name for name, options in commands().items() if "--json" in " ".join(options).split()}
