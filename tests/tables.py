"""Rows of results and of the tables of reference; lines that begin with # say where they come from."""

import csv
from pathlib import Path

from tests.documents import ROOT


def table(file: Path) -> list[dict[str, str]]:
    """The rows of a CSV file by their headings."""
    lines = file.read_text("utf-8").splitlines()
    assert lines[0].startswith("#"), "the first line names the source"
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def rows(name: str) -> list[dict[str, str]]:
    """The rows of tests/reference/NAME.csv."""
    return table(ROOT / "tests" / "reference" / f"{name}.csv")
