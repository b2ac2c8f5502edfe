"""Laws of least torque and energy of drives beside what no law can beat, held against optima of another optimiser."""

from copy import deepcopy
from typing import Any

import pytest

from optlaws import (
    C,
    InputError,
    Powers,
    Problem,
    Solution,
    at_most,
    drive_limit,
    drive_torque,
    integral,
    peak,
    rms,
    synthesize,
)
from optlaws.mechanisms import slider_crank
from optlaws.verification import verify
from tests.internals.synthesis import limit_beside

PRESS = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
MOVE = PRESS.dimensionless("0 deg", "180 deg", "0.3 s")
BASE: dict[str, Any] = {"order": 3, "basis": Powers(9), "symmetric": False, "monotone": True}


def solved(**entries: object) -> Solution:
    given: dict[str, Any] = {**BASE, "minimise": rms(MOVE.torque), **entries}
    return synthesize(Problem(**given))


def test_the_gap_to_the_limit_is_what_the_degree_costs() -> None:
    """Of a slider-crank, 180 deg in 0.3 s: torques in N m, least at degrees 9 and 13 by BFGS."""
    for degree, least in ((9, 3.989601), (13, 3.960253)):
        solution = solved(basis=Powers(degree))
        assert solution.objective * MOVE.unit == pytest.approx(least, abs=2e-6)
        assert solution.lower_bound * MOVE.unit == pytest.approx(3.924086, abs=2e-6)
        assert solution.drive_limit is not None
        assert solution.lower_bound == solution.drive_limit.value


@pytest.mark.parametrize(
    ("minimise", "known", "limit"),
    [
        (peak(MOVE.torque), 5.1057, 4.7308),
        pytest.param(integral(f"max(({MOVE.torque})*b, 0)"), 1.1960, 1.0140, marks=pytest.mark.long),
    ],
    ids=["peak", "energy"],
)
def test_peaks_and_energies_have_limits_too(minimise: object, known: float, limit: float) -> None:
    solution = solved(minimise=minimise, C=(0, 12))
    assert solution.objective * MOVE.unit <= known * 1.0002
    assert solution.lower_bound * MOVE.unit == pytest.approx(limit, abs=2e-4)
    assert solution.gap > 0.0


def test_the_file_holds_the_certificate_and_verify_checks_it() -> None:
    solution = solved()
    assert Solution.from_json(solution.to_json()) == solution
    checked = verify(solution.to_dict())
    claims = {claim.name: claim for claim in checked.claims}
    assert claims["the lower bound"].proven
    assert "phase plane" in claims["the lower bound"].detail
    assert claims["the drive's limit"].proven
    assert [claim.name for claim in checked.claims if not claim.proven] == []


def test_the_limit_of_another_problem_is_refused() -> None:
    solution = solved()
    other = solved(minimise=rms("(2 + a)*c + 0.5*b^2"))
    data = deepcopy(solution.to_dict())
    data["drive_limit"] = other.to_dict()["drive_limit"]
    with pytest.raises(InputError, match="of another problem"):
        Solution.from_dict(data)
    assert not all(claim.proven for claim in verify(data).claims)
    raised = deepcopy(solution.to_dict())
    raised["drive_limit"]["value"] *= 1.001
    with pytest.raises(InputError, match="above what its certificate proves"):
        Solution.from_dict(raised)


@pytest.mark.parametrize("changes", [{"monotone": False}, {"minimise": rms(MOVE.torque) + C}], ids=str)
def test_without_a_limit_nothing_is_claimed(changes: dict[str, object]) -> None:
    assert solved(basis=Powers(5), **changes).drive_limit is None


LOADED = drive_torque(inertia="1 + 0.6*a^2", load="3*a")
WITHIN: dict[str, Any] = {"B": (0, 2.2), "C": (0, 9)}


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("formula", "options"),
    [
        (f"({LOADED})^2", {"minimise": "rms torque"}),
        (f"max(({LOADED})*b, 0)", {"minimise": "energy"}),
        (f"max(({LOADED})*b, 0.6*({LOADED})*b)", {"minimise": "energy", "recovered": 0.6}),
    ],
)
def test_integrals_are_read_as_heat_and_energy(formula: str, options: dict[str, Any]) -> None:
    known = drive_limit(LOADED, B=2.2, C=9.0, **options).value
    known = known**2 if options["minimise"] == "rms torque" else known
    for factor in (1.0, 0.05):
        problem = Problem(**BASE, **WITHIN, minimise=integral(f"{factor}*{formula}"))
        limit = limit_beside(problem)
        assert limit is not None
        assert limit.value == pytest.approx(factor * known, rel=1e-6)


def test_energy_and_heat_together_are_above_their_limits_alone() -> None:
    power, heat = f"max(({LOADED})*b, 0)", f"0.05*({LOADED})^2"
    values = []
    for formula in (power, heat, f"{power} + {heat}"):
        limit = limit_beside(Problem(**BASE, **WITHIN, minimise=integral(formula)))
        assert limit is not None
        assert limit.gap < 1e-6
        values.append(limit.value)
    assert values[0] + values[1] < values[2] < 1.1 * (values[0] + values[1])


def test_a_bound_of_the_torque_counts() -> None:
    bounded = Problem(**BASE, minimise=rms(LOADED), bounds={peak(LOADED): (0, 4.5)}, B=at_most(2.2))
    limit = limit_beside(bounded)
    assert limit is not None
    assert limit.value == pytest.approx(drive_limit(LOADED, "rms torque", B=2.2, P=4.5).value, rel=1e-6)
