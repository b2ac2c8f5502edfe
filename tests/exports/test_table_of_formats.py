"""The table of formats on the page about exports says what is computed."""

from tests.documents import ROOT
from tests.exports.table_of_formats import rows

PAGE = (ROOT / "docs/how-to/export.md").read_text("utf-8")


def test_the_page_says_what_is_computed() -> None:
    lines = PAGE.splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith("| format | points"))
    stated = {
        cells[0]: cells[1:]
        for line in lines[start + 2 :]
        if line.startswith("|") and (cells := [cell.strip() for cell in line.strip("|").split("|")])
    }
    for name, points, ratio, jump, deviation, by, apart in rows():
        row = stated[name]
        assert row[:3] == [points, ratio, jump], name
        assert float(row[3]) == float(deviation)
        assert row[4] == by
        assert float(apart) <= 1e-12
        assert float(row[5]) <= 1e-12
