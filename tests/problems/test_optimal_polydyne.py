"""What results/ holds of optimal, robust and known laws for an elastic follower."""

import pytest

from tests.documents import ROOT
from tests.problems.written import table


def test_the_stored_table_has_optima_below_the_families_and_robust_laws_below_their_bound() -> None:
    rows = table(ROOT / "results" / "optimal_polydyne" / "table.csv")
    for damping in ("0", "0.05"):
        C = {row["law"]: float(row["C of the cam"]) for row in rows if row["damping"] == damping}
        B = {row["law"]: row["B of the mass"] for row in rows if row["damping"] == damping}
        for order, member in ((4, "family III, alpha = 7.2"), (5, "family IV, alpha = 11")):
            assert C[f"optimal, order {order}, free B"] <= C[f"optimal, order {order}, same B"] < 0.8 * C[member]
            assert float(B[f"optimal, order {order}, same B"]) == pytest.approx(float(B[member]), rel=1e-7)
            assert C[f"robust on the cam, order {order - 2}"] <= C[f"robust polydyne, order {order}"] < C[member]
    assert all(row["status"] in {"", "optimal"} for row in rows)
    assert all(float(row["greatest residual"]) <= 0.1 * (1 + 1e-7) for row in rows if row["law"].startswith("robust"))
