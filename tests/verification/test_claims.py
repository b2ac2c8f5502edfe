"""Whatever a file says of its solutions is checked or refused: status, limit, problem, rows around them, other keys."""

import copy
import json
from functools import cache
from pathlib import Path as File
from typing import Any

import pytest

from optlaws import Certificate, Chebyshev, InfeasibleProblem, InputError, Pieces, Problem, pareto_front, synthesize
from optlaws.verification import verify, verify_all
from tests.internals.cli import exit_code
from tests.verification.tampering import Data, changed, data_of

CONVEX = Problem(B=1.859, order=4, basis=Chebyshev(5))
LOCAL = Problem(B=1.4, order=4, basis=Chebyshev(5), minimise="D")
OF_PIECES = Problem(B=1.75, order=2, basis=Pieces(4, 4, 2), minimise="max(C/4, J/40)")
NO_LAW = Problem(B=1.7, order=4, basis=Chebyshev(5), C=4.5)


def code_of(data: Data, folder: File) -> int:
    file = folder / "claims.json"
    file.write_text(json.dumps(data), "utf-8")
    return exit_code(["verify", str(file)])


def without_ground() -> dict[str, tuple[Data, str]]:
    """Files with something that nothing proves, and how it is called."""
    whole, local = data_of(CONVEX), data_of(LOCAL)
    law = {name: whole[name] for name in ("law", "constants")}
    return {
        "beside a law": (
            law
            | {"problem": whole["problem"] | {"B": 1.7}, "status": "optimal", "best_possible": 99.0, "z": [1, 2, 3]},
            "the law: unknown entry 'problem'",
        ),
        "another status": (local | {"status": "PROVEN OPTIMAL"}, "'PROVEN OPTIMAL'"),
        "several statuses": (local | {"status": ["optimal"]}, "the solution: unknown status ['optimal']"),
        "a certificate beside a law": (law | {"certificate": whole["certificate"]}, "the solution needs problem"),
        "a solution in a law": (law | {"inner": whole | {"objective": 1.0}}, "the law: unknown entry 'inner'"),
        "a solution in a solution": (whole | {"better": whole | {"objective": 1.0}}, "unknown entry 'better'"),
        "a claim in a certificate": (whole["certificate"] | {"gap": 0.0}, "unknown field `gap`"),
        "a claim in a contact": (
            changed(whole, ("certificate", "contacts", 0), whole["certificate"]["contacts"][0] | {"proven": True}),
            "unknown field `proven`",
        ),
        "a row beside": ({"rows": [whole, {"status": "optimal", "best_possible": 1e9, "C": 1.0}]}, "rows[1].status"),
        "a row of a solution": ({"rows": [{"solution": whole, "C": 1.0}]}, "rows[0]: unknown entry 'C'"),
        "text": ({"rows": [whole], "verdict": "all proven"}, "verdict states 'all proven' without a certificate"),
        "a printed B": ({"rows": [{"B": 1.2, "printed": law}]}, "rows[0].B states 1.2 without a certificate"),
        "a front's heading": ({"over": ["C"], "values": [[4.0, 2.0]], "points": [whole]}, "as many as points"),
        "a front's constant": ({"over": ["E"], "values": [[4.0]], "points": [whole]}, "'E'"),
        "an infinite front": ({"over": ["C"], "values": [[None]], "points": [whole]}, "values 1 1 must be a finite"),
        "beyond powers": (
            changed(changed(whole, ("problem", "B"), 1e300), ("certificate", "problem", "B"), 1e300),
            "problem.B: 1e+300 is beyond",
        ),
    }


@pytest.mark.parametrize("name", without_ground())
def test_what_nothing_proves_is_refused(name: str, tmp_path: File, capsys: pytest.CaptureFixture[str]) -> None:
    data, message = without_ground()[name]
    assert code_of(data, tmp_path) == 2
    assert message in capsys.readouterr().err


@cache
def row_text() -> str:
    whole = data_of(CONVEX)
    row = {"asked": whole["problem"], "status": whole["status"], "solution": whole}
    return json.dumps({"about": "a table", "rows": [row, {"asked": whole["problem"], "status": "not found"}]})


@cache
def front_text() -> str:
    front = pareto_front(Problem(B=1.641, order=3, basis=Chebyshev(5)), over=("C", "J"), points=2)
    return json.dumps(front.to_dict(), allow_nan=False)


@cache
def table_text() -> str:
    whole = data_of(CONVEX)
    law = {name: whole[name] for name in ("law", "constants")}
    return json.dumps({"rows": [{"B": "1.859", "printed": law, "same shape": whole}]})


CONTAINERS = [row_text, front_text, table_text]


@pytest.mark.parametrize("text", CONTAINERS, ids=lambda one: one.__name__)
def test_rows_fronts_and_tables_are_proven(text: Any) -> None:
    verifications = verify_all(json.loads(text()))
    assert [str(claim) for one in verifications.values() for claim in one.claims if not claim.proven] == []


def test_a_row_without_a_law_needs_a_proof(tmp_path: File, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(InfeasibleProblem) as caught:
        synthesize(NO_LAW)
    assert isinstance(caught.value.proof, Certificate)
    row = {"asked": NO_LAW.to_dict(), "status": "infeasible", "solution": None}
    assert code_of({"rows": [row]}, tmp_path) == 1
    assert "infeasible: no certificate stands beside it" in capsys.readouterr().out
    proof = caught.value.proof.to_dict()
    assert code_of({"rows": [row | {"proof": proof}]}, tmp_path) == 0
    assert code_of({"rows": [row | {"proof": proof, "asked": CONVEX.to_dict()}]}, tmp_path) == 1
    assert code_of({"rows": [row | {"proof": proof, "status": "optimal"}]}, tmp_path) == 1
    assert code_of({"rows": [{**row, "status": "optimal"}]}, tmp_path) == 1


@pytest.mark.parametrize("problem", [CONVEX, LOCAL, OF_PIECES], ids=repr)
def test_another_status_limit_or_z_is_not_believed(problem: Problem) -> None:
    data = data_of(problem)
    assert verify(data).proven
    tampered: list[Data] = [copy.deepcopy(data) for _ in range(3)]
    tampered[0]["status"] = "optimal"
    tampered[1]["best_possible"] = 1.001 * data["objective"]
    tampered[2]["z"] = [1.0] if data["z"] is None else [*data["z"][:-1], data["z"][-1] + 1e-6]
    assert verify(tampered[0]).proven == (data["status"] == "optimal")
    assert not verify(tampered[1]).proven
    if data["z"] is None:
        with pytest.raises(InputError, match="have no Z"):
            verify(tampered[2])
    else:
        assert not verify(tampered[2]).proven


@pytest.mark.parametrize(
    ("minimise", "order", "bounds"),
    [("C", 3, {}), ("C", 3, {"J": (0, 90)}), ("D", 3, {}), ("J", 3, {}), ("rms_c", 3, {}), ("J", 2, {})],
)
def test_limits_are_proven_by_their_closed_forms(minimise: str, order: int, bounds: dict[str, Any]) -> None:
    data = data_of(Problem(B=1.8, order=order, basis=Chebyshev(5), minimise=minimise, **bounds))
    lines = [line for line in str(verify(data)).splitlines() if " the best possible: " in line]
    assert [line.partition(" the best possible")[0].strip() for line in lines] == ["proven"]
    assert not verify(data).results()["unchecked"]
    above = verify({**data, "best_possible": 1.001 * data["best_possible"]})
    assert [claim.name for claim in above.claims if not claim.proven] == ["the best possible"]
