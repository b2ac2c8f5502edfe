"""The tables of entries in docs/reference/problem-files.md, made from what the values of problem files declare.

`python docs/_ext/entry_tables.py` writes them again; tests/test_documents.py holds the page to them. A new table is a
line of `TABLES`, and its two marks in the page: `<!-- entries of NAME -->` and `<!-- end of the entries of NAME -->`.
"""

from pathlib import Path

from optlaws.entries.declared import Declared
from optlaws.entries.reference import markdown_table
from optlaws.jobs.cycle_entries import AxisEntries, CycleProblemFile
from optlaws.jobs.moves.move_entries import FastestProblemFile

PAGE = Path(__file__).resolve().parents[2] / "docs" / "reference" / "problem-files.md"
#: declared values by the names of their tables, and entries whose own entries stand elsewhere
TABLES: dict[str, tuple[type[Declared], tuple[str, ...]]] = {
    "a cycle": (CycleProblemFile, ("axis",)),
    "an axis": (AxisEntries, ("run_out", "segment.limits")),
    "a least time": (FastestProblemFile, ()),
}


def page_with_tables(page: str) -> str:
    """The page with the entries of today."""
    for name, (value, apart) in TABLES.items():
        begin, end = f"<!-- entries of {name} -->\n", f"<!-- end of the entries of {name} -->\n"
        table = f"{begin}\n{markdown_table(value, apart=apart)}\n\n{end}"
        before, _, rest = page.partition(begin)
        page = before + table + rest.partition(end)[2]
    return page


if __name__ == "__main__":
    PAGE.write_text(page_with_tables(PAGE.read_text("utf-8")), "utf-8")
