"""Axes whose moves overlap, in files: each number is computed again, and what is computed in doubles is named so."""

import json
from pathlib import Path

import pytest

from optlaws.typing import Overlap
from optlaws.verification import verify
from tests.documents import ROOT
from tests.internals.cli import exit_code
from tests.verification.tampered_formats import drawn_axes
from tests.verification.tampering import changed


@pytest.mark.parametrize("goal", ["period", "acceleration"])
def test_an_overlap_is_read_again_and_recomputed(goal: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    best = drawn_axes(goal)
    again = Overlap.from_json(best.to_json())
    assert again.to_dict() == best.to_dict()
    assert (again.status, again.gap, again.gain) == (best.status, best.gap, best.gain)
    verification = verify(best.to_dict())
    assert [claim.name.split()[0] for claim in verification.claims] == ["interlock"]
    assert verification.proven
    assert [claim.name for claim in verification.recomputed] == [
        f"the {goal}",
        "lower bound over all instants",
        "what binds",
    ]
    file = tmp_path / "overlap.json"
    file.write_text(best.to_json(), "utf-8")
    assert exit_code(["verify", str(file)]) == 0
    assert capsys.readouterr().out.endswith("\n1 proven, 3 recomputed in doubles, 0 not checked\n")


def test_false_numbers_of_an_overlap_are_not_proven() -> None:
    data = json.loads(drawn_axes("period").to_json())
    for name, factor in (("objective", 0.999), ("objective", 1.001), ("lower_bound", 1.0 + 1e-8)):
        assert not verify(changed(data, (name,), data[name] * factor)).proven, (name, factor)
    for binding in (["nothing"], data["binding"][1:], [*data["binding"], data["binding"][0]]):
        assert not verify(changed(data, ("binding",), binding)).proven, binding
    # no order is stated by it
    assert verify(changed(data, ("binding",), data["binding"][::-1])).proven
    assert not verify(changed(data, ("given", "interlocks"), [])).proven
    assert not verify(changed(data, ("goal",), "acceleration")).proven


def test_the_proven_interlocks_of_a_machine_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_code(["verify", str(ROOT / "results" / "cycle_die_and_table" / "cycle.json")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(",")[0] for line in lines if " interlock " in line] == [
        "proven      interlock index: clear",
        "proven      interlock close: clear",
    ]
