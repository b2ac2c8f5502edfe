"""The job "follower": tables, figures, its errors, and what results/ holds."""

from pathlib import Path

import pytest

from optlaws.jobs import job
from tests.documents import ROOT
from tests.jobs.examples import FOLLOWER
from tests.jobs.written import table
from tests.mechanisms.savin_cases import rows

RESULTS = ROOT / "results" / "savin_follower"
FILES = {"coefficients.csv", "cams.csv", "off_design.csv", "follower.md"} | {
    f"{name}.{kind}" for name in ("curves", "spectrum") for kind in ("svg", "png")
}


def run(folder: Path, text: str) -> Path:
    file = folder / "small.toml"
    file.write_text(text, "utf-8")
    job.run(file, folder / "out")
    return folder / "out"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return run(tmp_path_factory.mktemp("follower"), FOLLOWER)


def test_every_file_is_written(made: Path) -> None:
    assert {file.name for file in made.iterdir()} == FILES == {file.name for file in RESULTS.iterdir()}


def test_the_rows_are_the_runs(made: Path) -> None:
    lines = table(made / "off_design.csv")
    assert [(line["cam"], line["change"], float(line["deviation of nu, %"])) for line in lines] == [
        ("first", "speed", -5.0),
        ("first", "speed", 0.0),
        ("second", "stiffness", -5.0),
        ("second", "stiffness", 0.0),
    ]
    assert float(lines[1]["dynamic factor"]) == 1.0
    assert float(lines[1]["residual acceleration"]) == 0.0
    assert float(lines[2]["n"]) == pytest.approx(1.5)
    page = (made / "follower.md").read_text("utf-8")
    assert "## Dynamic factor off design" in page
    assert "curves.svg" in page


def test_results_in_the_repository_are_the_digests_numbers() -> None:
    names = {"III_rigid": "III direct", "IV_rigid": "IV direct", "K": "K direct"}
    found = {
        (one["cam"], one["change"] if float(one["damping"]) else "undamped", float(one["deviation of nu, %"])): one
        for one in table(RESULTS / "off_design.csv")
    }
    compared = 0
    for row in rows("off_design"):
        cam = names.get(row["law"], f"{row['law']}, n = {row['n_design']}")
        change = {"undamped": "undamped", "zeta_const": "speed", "n_const": "stiffness"}[row["variant"]]
        line = found.get((cam, change, float(row["pct"])))
        if line is not None:
            assert float(line["dynamic factor"]) == pytest.approx(float(row["kd_rise"]), rel=1e-7)
            assert float(line["residual acceleration"]) == pytest.approx(float(row["res_acc_amp"]), rel=1e-7, abs=1e-8)
            compared += 1
    assert compared == len(found) == 80


def test_the_coefficients_in_the_repository_are_whole_fractions() -> None:
    found = {(one["cam"], int(one["i"])): one for one in table(RESULTS / "coefficients.csv")}
    for row in rows("cam_coeffs"):
        line = found[f"{row['family']}, n = {row['n']}", int(row["i"])]
        assert float(line["Q_i of the mass"]) == pytest.approx(float(row["Q"]), rel=1e-7)
        assert float(line["q_i of the cam"]) == pytest.approx(float(row["q"]), rel=1e-7)
