"""Optima for machines: what is proven of each kind, and that nothing else is called proven."""

import json
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from optlaws import C, Chebyshev, Cycle, Link, Machine, Pieces, Problem, Return, Rise, Solution, at_most, synthesize
from optlaws.verification import exact_bound, verify, verify_all
from tests.documents import ROOT
from tests.sampling import sampled
from tests.verification.tampering import changed

AXIS = Machine.from_masses(
    {"motor": 0.8e-4, "carriage": 2.4e-4},
    [Link("motor", "carriage", 9.0, 0.0018)],
    drive="motor",
    outputs={"torque": "drive force", "sway": "deflection motor-carriage"},
    duration=0.1,
    stroke=4.0,
)
WHOLE: dict[str, Any] = {"order": 3, "symmetric": False, "basis": Chebyshev(7)}
SWAY = AXIS.residual(1, "sway", spread=0.1)
BOX = AXIS.residual(1, "sway", spread=0.1, damping=(0.0, 0.05))
ASKED: dict[str, dict[str, Any]] = {
    "peak": {"minimise": AXIS.peak("torque"), "J": at_most(100), "bounds": {SWAY: at_most(0.01)}},
    "peak in the dwell": {"minimise": C, "bounds": {AXIS.peak("sway", within=(1.0, 1.5)): at_most(0.02)}},
    "rms": {"minimise": AXIS.rms("torque", dwell=0.5), "J": at_most(100)},
    "rms kept": {"minimise": C, "bounds": {AXIS.rms("torque"): at_most(0.6)}},
    "residual": {"minimise": SWAY, "J": at_most(70), "basis": Chebyshev(3)},
    "residual over a box": {"minimise": C, "bounds": {BOX: at_most(0.01)}},
    "cycle": {"minimise": AXIS.peak("torque", cycle=(0.2, 0.3)), "B": at_most(2.0)},
    "rms of a cycle alone": {"minimise": AXIS.rms("torque", cycle=(0.2, 0.3), offset=0.3)},
    "side": {"minimise": AXIS.peak("torque", side="low", offset=0.4), "J": at_most(100)},
    "side at its floor": {"minimise": AXIS.peak("sway", side="high", offset=1.0), "J": at_most(100)},
    "side below 0": {"minimise": AXIS.peak("torque", side="high", offset=-5.0) + 0.1 * C},
    "sum": {"minimise": AXIS.peak("torque") + 0.1 * C + 10.0 * SWAY, "J": at_most(100)},
    "maximum": {"minimise": f"max({AXIS.peak('torque')!r}, {AXIS.rms('torque')!r}) + 0.05*C"},
    "pieces": {"minimise": AXIS.peak("torque"), "J": at_most(100), "basis": Pieces([0, 0.3, 0.7, 1], 5, 2)},
    "symmetric": {"minimise": AXIS.peak("torque"), "J": at_most(100), "symmetric": True},
    "symmetric pieces": {
        "minimise": AXIS.rms("torque"),
        "J": at_most(100),
        "symmetric": True,
        "basis": Pieces([0, 0.5, 1], 7, 3),
    },
}


@cache
def solved(kind: str) -> Solution:
    return synthesize(Problem(**{**WHOLE, **ASKED[kind]}))


def stored(kind: str) -> dict[str, Any]:
    data: dict[str, Any] = json.loads(json.dumps(solved(kind).to_dict()))
    return data


@pytest.mark.parametrize("kind", sampled(ASKED, each=5))
def test_each_kind_is_proven_and_nothing_more(kind: str) -> None:
    data = stored(kind)
    verification = verify(data)
    assert [str(claim) for claim in verification.claims if not claim.proven] == []
    assert verification.gap is not None
    assert abs(verification.gap) < 1e-8
    more = {**data}
    for key, sign in (("objective", -1.0), ("lower_bound", 1.0)):
        more[key] += sign * 1e-6 * abs(data[key])
    refused = {claim.name for claim in verify(more).claims if not claim.proven}
    assert refused >= {"the objective", "the lower bound"}


@pytest.mark.parametrize("kind", sampled(["peak", "rms", "residual over a box"]))
def test_another_machine_is_not_proven(kind: str) -> None:
    text = json.dumps(stored(kind))
    # a stiffness that is more by a millionth, in the problem and in the certificate
    matrix = repr(AXIS.A[1][0])
    assert matrix in text
    assert not verify(json.loads(text.replace(matrix, repr(AXIS.A[1][0] * (1.0 + 1e-6))))).proven


@pytest.mark.long
def test_a_whole_cycle_with_its_load_is_proven() -> None:
    load = {"period": "20 ms", "damping": 0.05}
    cycle = Cycle([Rise("35 mm", "0.1 s"), Return()], period="0.3 s", load=load, minimise="load acceleration")
    for solution in cycle.solutions:
        assert verify(json.loads(json.dumps(solution.to_dict()))).proven


@pytest.mark.long
def test_no_multiplier_and_no_place_proves_more_than_is_true() -> None:
    solution = solved("peak")
    data = solution.certificate.to_dict()
    for i, contact in enumerate(data["contacts"]):
        for key, value in (("k", min(1.0, contact["k"] + 0.01)), ("multiplier", contact["multiplier"] * 1.5)):
            other = changed(data, ("contacts", i, key), value)
            bound = exact_bound(type(solution.certificate).from_dict(other))
            assert bound is None or float(bound) <= solution.objective * (1.0 + 1e-9)


@pytest.mark.parametrize("file", sampled(sorted((ROOT / "results").glob("machine_*/laws.json")), each=4))
def test_the_laws_of_problem_files_are_proven(file: Path) -> None:
    verifications = verify_all(file)
    assert len(verifications) > 2
    assert [str(claim) for one in verifications.values() for claim in one.claims if not claim.proven] == []
