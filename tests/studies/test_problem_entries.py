"""A problem in a problem file: bases of pieces, bounds of any constant, an inflexion."""

import json
import sys
from pathlib import Path
from typing import Any

import pytest

from optlaws import BSplines, InputError, Pieces, Problem, at_most, between
from tests.internals.cli import exit_code
from tests.internals.studies import problem
from tests.internals.synthesis import PROBLEM


def asked(**entries: Any) -> Problem:
    return problem("row 1", PROBLEM.read(entries, "problem"))


def test_every_entry_is_read() -> None:
    found = asked(
        order=3,
        basis="bsplines",
        degree=3,
        breaks=[0, 0.3, 0.7, 1],
        continuity=2,
        bounds={"rms_c": [0, 4], "snap": 900.0},
    )
    assert found == Problem(
        order=3, basis=BSplines((0, 0.3, 0.7, 1), 3, 2), bounds={"rms_c": at_most(4), "snap": 900.0}
    )
    assert asked(order=3, basis="pieces", degree=4, breaks=8, bounds={"rms_c": [3.5, 4]}) == Problem(
        order=3, basis=Pieces(8, 4), bounds={"rms_c": between(3.5, 4)}
    )
    assert asked(order=3, symmetric=False, inflexion=0.4).inflexion == 0.4
    assert asked(order=3, bounds={"rms_c": "free"}) == Problem(order=3)


@pytest.mark.parametrize(
    ("entries", "text"),
    [
        ({"basis": "spline"}, "basis"),
        ({"inflexion": 1.0}, "inflexion"),
        ({"inflexion": 0.4}, "symmetric=False"),
        ({"bounds": {"rmsc": 4}}, "did you mean 'rms_c'"),
        ({"basis": "bsplines", "degree": 3}, "the basis 'bsplines' needs its breaks"),
        (
            {"basis": "powers", "degree": 3, "continuity": 2},
            "has no continuity: leave it out, or take bsplines or periodic or pieces",
        ),
    ],
)
def test_entries_that_make_no_sense_are_refused(entries: dict[str, Any], text: str) -> None:
    with pytest.raises(InputError, match=text):
        asked(order=3, **entries)


# --- the command ---


def test_the_command_study_says_what_it_did(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, out = tmp_path / "small.toml", str(tmp_path / "study")
    file.write_text("[problem]\norder = 4\n[vary]\nB = [1.5, 1.2]\ndegree = [3]\n")
    assert exit_code(["study", str(file), "--out", out, "--workers", "1", "--json"]) == 0
    results = capsys.readouterr()
    assert json.loads(results.out)["counts"] == {"optimal": 1, "infeasible": 1}
    assert "2 of 2" in results.err
    assert exit_code(["study", "--status", out]) == 0
    assert "2 of 2 points (finished)" in capsys.readouterr().out
    for wrong, text in (
        ([], "name a study file"),
        ([str(file), "--status", out], "--status takes a directory and neither"),
        ([str(tmp_path / "no.toml")], "cannot read"),
        (["--status", str(tmp_path)], "contains no study"),
    ):
        assert exit_code(["study", *wrong]) == 2
        assert text in capsys.readouterr().err


def test_a_cluster_without_its_package_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "small.toml"
    file.write_text("[problem]\norder = 4\n[vary]\nB = [1.5]\n")
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert exit_code(["study", str(file), "--dask", "tcp://x:1"]) == 2
    assert "pip install 'optlaws[cluster]'" in capsys.readouterr().err
