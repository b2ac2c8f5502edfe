"""Plans in files: each solution is proven, and its place in the cycle computed again from the cycle."""

import json
from pathlib import Path
from typing import Any

import pytest

from optlaws import ConstantVelocity, Cycle, Dwell, Return, Rise
from optlaws.errors import InputError
from optlaws.verification import verify
from tests.internals.cli import PartlyChecked
from tests.internals.cli import verify as command
from tests.verification.tampering import changed


@pytest.fixture(scope="module")
def plan() -> dict[str, Any]:
    moves = [Rise("35 mm", "120 deg"), Dwell("60 deg"), Return("35 mm", "100 deg"), Dwell()]
    return json.loads(Cycle(moves, speed="100 rpm", limits={"velocity": "1 m/s"}).solve().to_json())  # type: ignore[no-any-return]


def test_the_laws_of_a_plan_are_proven_and_partly_checked_in_its_cycle(plan: dict[str, Any], tmp_path: Path) -> None:
    verification = verify(plan)
    assert verification.proven
    places = {claim.name.split(": ")[0] for claim in verification.claims}
    assert places == {"solutions[0]", "solutions[1]"}
    assert [claim.name for claim in verification.unchecked] == ["the laws of the cycle"]
    file = tmp_path / "plan.json"
    file.write_text(json.dumps(plan), "utf-8")
    with pytest.raises(PartlyChecked, match="they meet its joints and keep its limits, in doubles; status optimal"):
        command(file)


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
    assert [claim.name for claim in verification.unchecked] == ["the laws of the cycle", "the motions of the proofs"]
    (name, proof), *_ = data["proofs"].items()
    weak = changed(data, ("proofs", name, "contacts"), proof["contacts"][1:])
    for wrong in (changed(data, ("period",), 2.0 * data["period"]), weak):
        assert not verify(wrong).proven
