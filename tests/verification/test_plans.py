"""Plans in files: each solution is proven, and its place in the cycle computed again from the cycle."""

import json
import re
from pathlib import Path as File
from typing import Any

import numpy as np
import pytest

from optlaws import ConstantVelocity, Cycle, Dwell, Plan, Return, Rise
from optlaws.errors import InputError
from optlaws.verification import verify, verify_all
from tests.documents import ROOT
from tests.internals.cli import exit_code
from tests.internals.cycles import CycleReport
from tests.internals.verification import differences
from tests.verification.tampering import Path, changed, places, value_at


@pytest.fixture(scope="module")
def plan() -> dict[str, Any]:
    moves = [Rise("35 mm", "120 deg"), Dwell("60 deg"), Return("35 mm", "100 deg"), Dwell()]
    return json.loads(Cycle(moves, speed="100 rpm", limits={"velocity": "1 m/s"}).solve().to_json())  # type: ignore[no-any-return]


def test_the_laws_of_a_plan_are_proven_and_compared_with_its_cycle(
    plan: dict[str, Any], tmp_path: File, capsys: pytest.CaptureFixture[str]
) -> None:
    verification = verify(plan)
    assert verification.proven
    places = {claim.name.split(": ")[0] for claim in verification.claims}
    assert places == {"solutions[0]", "solutions[1]"}
    assert [claim.name for claim in verification.recomputed] == ["the laws of the cycle"]
    file = tmp_path / "plan.json"
    file.write_text(json.dumps(plan), "utf-8")
    assert exit_code(["verify", str(file)]) == 0
    assert re.search(r"\n\d\d proven, 1 recomputed in doubles, 0 not checked\n$", capsys.readouterr().out)


def test_a_plan_that_states_what_is_false_is_not_proven(plan: dict[str, Any]) -> None:
    objective = plan["solutions"][1]["objective"]
    for place, value, why in (
        (("solutions", 1, "objective"), objective * 0.999, "solutions[1]: the objective"),
        (("solutions", 0, "lower_bound"), 1.01 * objective, "solutions[0]: the lower bound"),
        (("cycle", "limits"), {"velocity": "0.2 m/s"}, "the laws of the cycle"),
    ):
        verification = verify(changed(plan, place, value))
        assert not verification.proven
        assert why in {claim.name for claim in verification.claims if not claim.proven}


def test_laws_that_miss_the_velocities_of_the_joints_are_none_of_the_cycle(plan: dict[str, Any]) -> None:
    moving = Cycle([ConstantVelocity("1.5 m/s", "80 ms"), Return()], period="400 ms").solve().to_dict()
    assert verify(moving).proven
    other = verify(changed(moving, ("solutions", 0), plan["solutions"][0]))
    (claim,) = (claim for claim in other.claims if not claim.proven)
    assert "segment 2 (Return): its solution has other ends than its joints" in str(claim)


def test_what_is_no_solution_of_a_plan_is_named(plan: dict[str, Any]) -> None:
    with pytest.raises(InputError, match=r"solutions\[1\] is no solution"):
        verify(changed(plan, ("solutions", 1), plan["cycle"]))
    fewer = verify(changed(plan, ("solutions",), plan["solutions"][:1]))
    assert "2 optimised motions, got 1 solutions" in str([claim for claim in fewer.claims if not claim.proven])


def test_a_fastest_cycle_is_proven_by_its_certificates() -> None:
    limits = {"acceleration": "20 m/s^2", "jerk": "2000 m/s^3"}
    moves = [Rise("35 mm", "120 deg"), Dwell("60 deg"), Return()]
    data = json.loads(Cycle(moves, speed="60 rpm", limits=limits).fastest().to_json())
    verification = verify(data)
    assert verification.proven
    assert {claim.name.split(":")[0] for claim in verification.claims} == {f"{name}.proof" for name in data["proofs"]}
    again = ["the least period: the motions of the proofs", "the laws of the cycle"]
    assert [claim.name for claim in verification.recomputed] == again
    assert not verification.unchecked
    (name, proof), *_ = data["proofs"].items()
    weak = changed(data, ("proofs", name, "contacts"), proof["contacts"][1:])
    # a limit that is wider is no limit of the cycle, and its proof none that the cycle is no faster
    wider = changed(data, ("proofs", name, "problem", "C", 1), 1.01 * proof["problem"]["C"][1])
    longer = changed(data, ("segments", 0, "least"), 0.99 * data["segments"][0]["least"])
    for wrong in (changed(data, ("period",), 2.0 * data["period"]), weak, wider, longer):
        assert not verify(wrong).proven


@pytest.fixture(scope="module")
def axis() -> dict[str, Any]:
    """An axis of `cycle.json`: a plan with its numbers, among them an effort, joints and the usual law."""
    moves = [Rise("35 mm", "120 deg"), Dwell("60 deg"), Return("35 mm", "100 deg", law="cycloidal"), Dwell()]
    cycle = Cycle(moves, speed="100 rpm", limits={"velocity": "1 m/s"}, drive={"mass": "2 kg", "gravity": "20 N"})
    return json.loads(json.dumps(CycleReport(cycle).stored, allow_nan=False))  # type: ignore[no-any-return]


def test_the_numbers_of_an_axis_are_proven_by_its_laws_or_computed_again(axis: dict[str, Any]) -> None:
    verification = verify(axis)
    assert verification.proven
    assert {"objective", "lower_bound"} < {claim.name for claim in verification.claims}
    numbers = next(claim for claim in verification.recomputed if claim.name == "the numbers")
    named = {"period", "usual_law", "segments", "joints", "effort", "laws", "modified_sine_jerk"}
    assert named < set(numbers.detail.split(": ")[1].split(", "))


@pytest.mark.sample(10)
@pytest.mark.parametrize("minimise", ["power", "force", "rms force", "energy", "acceleration"])
@pytest.mark.parametrize("drive", [{"mass": "2 kg"}, {"mass": "2 kg", "stiffness": "900 N/m", "gravity": "20 N"}])
def test_objectives_of_a_drive_are_proven_by_the_constants_of_the_laws(minimise: str, drive: dict[str, str]) -> None:
    moves = [Rise("35 mm", "120 deg"), Dwell("60 deg"), Return("35 mm", "100 deg"), Dwell()]
    # an energy within a limit of the jerk takes twenty times as long
    limits = {"acceleration": "9 m/s^2"} | ({} if minimise == "energy" else {"jerk": "400 m/s^3"})
    plan = Cycle(moves, speed="100 rpm", minimise=minimise, drive=drive, limits=limits, degree=5).solve()
    data = json.loads(json.dumps(CycleReport(plan).stored, allow_nan=False))
    verification = verify(data)
    assert verification.proven
    stated = {"objective"} | ({"lower_bound"} if plan.lower_bound is not None else set())
    proven = {claim.name for claim in verification.claims} & stated
    # bounds by energies in phase planes have no certificate
    assert proven == stated if minimise != "power" or drive == {"mass": "2 kg"} else proven >= {"objective"}
    for name in proven:
        assert not verify(changed(data, (name,), data[name] * (1.0 + 1e-8))).proven


def part(data: dict[str, Any], path: Path) -> dict[str, Any]:
    """The entry of a place alone."""
    return {key: value for key, value in data.items() if key == path[0]}


def numbers(data: dict[str, Any]) -> list[tuple[Path, Any]]:
    """What is stated of the laws of an axis, by place, each with another value."""
    found = list[tuple[Path, Any]]()
    for path in places(data):
        value = value_at(data, path)
        if path[0] not in {"cycle", "solutions"} and path[-1] != "format" and isinstance(value, int | float | str):
            off = (
                f"{value} or so"
                if isinstance(value, str)
                else value + (1e-6 * abs(value) if abs(value) > 1e-9 else 1e-3)
            )
            found.append((path, off))
    return found


def test_numbers_of_an_axis_that_are_changed_are_found(axis: dict[str, Any]) -> None:
    found = numbers(axis)
    for i in np.random.default_rng(2026).permutation(len(found))[:8]:
        assert not verify(changed(axis, *found[i])).proven, found[i]


@pytest.mark.sample(3)
@pytest.mark.parametrize("name", sorted(file.parent.name for file in (ROOT / "results").glob("*/cycle.json")))
def test_every_number_of_a_stored_cycle_that_is_changed_is_found(name: str) -> None:
    data = json.loads((ROOT / "results" / name / "cycle.json").read_text("utf-8"))
    for stated in data["axes"].values():
        plan = {key: stated[key] for key in ("cycle", "solutions", "chosen", "bound") if key in stated}
        known = CycleReport(Plan.from_dict(plan)).stored
        assert list(differences(stated, {**known, **plan}, "")) == []
        believed = []
        for path, value in numbers(stated):
            wrong = changed(part(stated, path), path, value)
            believed += [] if path[0] in plan or list(differences(wrong, known, "")) else [path]
        assert believed == []


@pytest.mark.sample(4)
@pytest.mark.parametrize("name", sorted(file.parent.name for file in (ROOT / "results").glob("*/cycle.json")))
def test_a_page_calls_a_bound_proven_where_a_verification_proves_it(name: str) -> None:
    data = json.loads((ROOT / "results" / name / "cycle.json").read_text("utf-8"))
    page = (ROOT / "results" / name / "cycle.md").read_text("utf-8")
    for stated in data["axes"].values():
        if stated.get("lower_bound") is None:
            continue
        verification = verify(stated)
        proven = "lower_bound" in {claim.name for claim in verification.claims}
        rows = [row for row in verification.recomputed if row.name == "lower_bound"]
        assert proven != bool(rows)
        known = Plan.from_dict({key: stated[key] for key in ("cycle", "solutions", "chosen", "bound") if key in stated})
        assert known.lower_bound_name == ("proven lower bound" if proven else "lower bound in doubles")
        assert f"| {known.lower_bound_name} " in page


def test_a_bound_that_a_plan_states_beside_its_laws_is_sought_again_and_never_above_them() -> None:
    limits = {"rms force": "45 N"}
    cycle = Cycle([Rise("30 mm", "0.1 s"), Return()], period="0.4 s", drive={"mass": "2 kg"}, limits=limits)
    stored = json.loads(json.dumps(CycleReport(cycle).stored))
    assert Plan.from_dict(cycle.solve().to_dict()) == cycle.solve()
    assert "lower_bound" in {claim.name for claim in verify(stored).recomputed}
    higher = 1.00001 * stored["lower_bound"]
    wrong = verify(changed(changed(stored, ("bound",), higher), ("lower_bound",), higher))
    assert "lower_bound" in {claim.name for claim in wrong.claims if not claim.proven}
    above = 1.001 * stored["objective"]
    verification = verify(changed(changed(stored, ("bound",), above), ("lower_bound",), above))
    assert "is above its objective" in str([str(claim) for claim in verification.claims if not claim.proven])


def test_a_plan_selected_among_several_best_keeps_its_bound() -> None:
    plan = Cycle([ConstantVelocity("1.5 m/s", "80 ms"), Return()], period="400 ms", minimise="velocity").solve()
    assert plan.chosen
    assert plan.lower_bound == pytest.approx(1.5)
    assert Plan.from_json(plan.to_json()).lower_bound == plan.lower_bound


def test_a_peak_that_is_infinite_is_stored_as_null() -> None:
    moves = [Rise("30 mm", "0.1 s", law="parabolic"), Return()]
    stored = CycleReport(Cycle(moves, period="0.4 s", order=2)).stored
    assert [each["jerk"] is None for each in stored["segments"]] == [True, False]
    assert verify(json.loads(json.dumps(stored, allow_nan=False))).proven


def test_the_interlocks_and_the_overlap_of_axes_are_computed_again_from_their_plans() -> None:
    data = json.loads((ROOT / "results" / "cycle_die_and_table" / "cycle.json").read_text("utf-8"))
    verified = verify_all(data)
    assert all(each.proven for each in verified.values())
    assert {claim.name for claim in verified[""].claims} == {"interlock index", "interlock close"}
    for path, value in (
        (("interlocks", 0, "clearance"), 1e-6),
        (("interlocks", 1, "rule", "position"), "30 mm"),
        (("overlap", "gain"), data["overlap"]["gain"] * 1.001),
        (("overlap", "objective"), data["overlap"]["objective"] * 0.999),
        (("overlap", "status"), "local"),
    ):
        assert not verify_all(changed(data, path, value))[""].proven, path
