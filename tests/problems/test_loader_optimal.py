"""What results/ holds of laws that are made for their inertial loaders."""

import json

import pytest

from optlaws import MotionLaw, catalogue, inertial_loader
from tests.documents import ROOT
from tests.problems.written import table

RESULTS = ROOT / "results" / "loader_optimal"


def test_laws_are_what_their_loaders_say() -> None:
    laws = json.loads((RESULTS / "laws.json").read_text("utf-8"))["laws"]
    printed = {row["law"]: float(row["B"]) for row in table(RESULTS / "table.csv")}
    assert printed.keys() == laws.keys()
    for found in laws["Shun"].values():
        law = MotionLaw.from_dict(found["law"])
        assert law.constants.B.value == pytest.approx(printed["Shun"], rel=1e-7)
        assert found["loader"]["constants"]["C"]["value"] == pytest.approx(inertial_loader(law).C, rel=1e-9)
    own = catalogue["3-4-5 polynomial"].law.constants.C.value
    assert laws["Shun"]["C no greater"]["executive"]["C"] <= own * (1.0 + 1e-8)


def test_results_hold_laws_between_the_limit_and_the_printed_ones() -> None:
    rows = table(RESULTS / "table.csv")
    assert len(rows) == 12
    for row in rows:
        least = [float(value) for name, value in row.items() if name.startswith("l = ")]
        assert float(row["best possible"]) < min(least)
        if row["C_l"]:
            assert max(least) < float(row["C_l"])
    for row in table(RESULTS / "rivals.csv"):
        if row["rival"] == "C no greater":
            assert float(row["C"]) <= float(row["printed C"]) * (1.0 + 1e-6)
