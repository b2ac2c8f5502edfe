"""Reference data as rows of text."""

import csv

from tests.documents import ROOT


def rows(name: str) -> list[dict[str, str]]:
    """The rows of a file of tests/reference whose first line says where it comes from."""
    text = (ROOT / "tests" / "reference" / name).read_text("utf-8")
    first, rest = text.split("\n", 1)
    assert first.startswith("# ")
    return list(csv.DictReader(rest.splitlines()))
