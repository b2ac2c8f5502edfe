"""What results/ holds of Savin's families: their table against the reference, and their figure."""

import pytest

from optlaws import savin
from tests.documents import ROOT
from tests.internals.laws import alpha_range
from tests.laws.reference import rows
from tests.problems.written import table

RESULTS = ROOT / "results" / "savin_families"


def test_the_table_has_every_member_of_the_reference() -> None:
    found = table(RESULTS / "table.csv")
    for row in rows("savin_peaks.csv"):
        if (row["family"], row["alpha"]) == ("III", "7.2"):
            continue  # the paper's experiment, at no equal step of alpha
        near = [
            one
            for one in found
            if one["family"] == row["family"] and abs(float(one["alpha"]) - float(row["alpha"])) < 1e-6
        ]
        assert len(near) == 1
        for name, column in (("B", "B"), ("C", "C"), ("D", "D"), ("kC", "k of C"), ("kD", "k of D")):
            assert float(near[0][column]) == pytest.approx(float(row[name]), rel=1e-7)


def test_every_row_is_the_law_s() -> None:
    for row in table(RESULTS / "table.csv"):
        low, high = alpha_range(row["family"])
        constants = savin(row["family"], min(max(float(row["alpha"]), low), high)).constants
        assert constants.C.value == pytest.approx(float(row["C"]), rel=1e-7)
        assert constants.D.value == pytest.approx(float(row["D"]), rel=1e-7)


def test_the_best_members_are_named() -> None:
    text = (RESULTS / "table.md").read_text("utf-8")
    for row in rows("savin_least.csv"):
        assert row["minC"] in text
        assert row["minD"] in text


def test_the_figure_names_its_curves() -> None:
    text = (RESULTS / "figure.svg").read_text("utf-8")
    for label in ("family I", "family IV", "peak power D", "least of the family"):
        assert label in text
