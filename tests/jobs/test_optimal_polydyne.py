"""The job "optimal polydyne": what its table says of optimal, robust and known laws."""

import csv
from pathlib import Path

import pytest

from optlaws.jobs import job
from tests.documents import ROOT

TEXT = (ROOT / "problems" / "optimal_polydyne.toml").read_text("utf-8")


def table(folder: Path) -> list[dict[str, str]]:
    lines = (folder / "table.csv").read_text("utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def test_the_stored_table_has_optima_below_the_families_and_robust_laws_below_their_bound() -> None:
    rows = table(ROOT / "results" / "optimal_polydyne")
    for damping in ("0", "0.05"):
        C = {row["law"]: float(row["C of the cam"]) for row in rows if row["damping"] == damping}
        B = {row["law"]: row["B of the mass"] for row in rows if row["damping"] == damping}
        for order, member in ((4, "family III, alpha = 7.2"), (5, "family IV, alpha = 11")):
            assert C[f"optimal, order {order}, free B"] <= C[f"optimal, order {order}, same B"] < 0.8 * C[member]
            assert float(B[f"optimal, order {order}, same B"]) == pytest.approx(float(B[member]), rel=1e-7)
            assert C[f"robust on the cam, order {order - 2}"] <= C[f"robust polydyne, order {order}"] < C[member]
    assert all(row["status"] in {"", "optimal"} for row in rows)
    assert all(float(row["greatest residual"]) <= 0.1 * (1 + 1e-7) for row in rows if row["law"].startswith("robust"))


def test_a_small_job_writes_its_files(tmp_path: Path) -> None:
    small = TEXT.replace("degree = 15", "degree = 9").replace("dampings = [0.0, 0.05]", "dampings = [0.0]")
    file = tmp_path / "small.toml"
    file.write_text(small, "utf-8")
    written = job.run(file, tmp_path / "out")
    assert [one.name for one in written] == ["table.csv", "table.md", "figure.svg", "figure.png"]
    rows = table(tmp_path / "out")
    assert len(rows) == 13
    assert float(rows[0]["C of the cam"]) == pytest.approx(5.705264895, rel=1e-7)
