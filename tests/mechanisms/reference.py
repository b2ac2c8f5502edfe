"""Rows of the reference tables."""

import csv

from tests.documents import ROOT


def rows(name: str) -> list[dict[str, str]]:
    """Rows of tests/reference/NAME.csv; lines that begin with # are comments."""
    lines = (ROOT / "tests" / "reference" / f"{name}.csv").read_text("utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))
