"""The tables of entries in docs/reference/problem-files.md, made from what the values of problem files declare.

`python docs/_ext/entry_tables.py` writes them again; tests/test_documents.py holds the page to them. A new table is a
line of `TABLES`, and its two marks in the page: `<!-- entries of NAME -->` and `<!-- end of the entries of NAME -->`.
"""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

from optlaws.cams.barrel import Groove
from optlaws.entries.reference import markdown_table
from optlaws.jobs.cam_entries import CamProblemFile
from optlaws.jobs.cycle_entries import AxisEntries, CycleProblemFile
from optlaws.jobs.fastest import FastestProblemFile
from optlaws.jobs.machine_laws import MachineLawsProblemFile
from optlaws.jobs.solutions import SolutionsProblemFile
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.drives.motor import Motor
from optlaws.mechanisms.linkages.mechanism_kinds import Body, Loads, MechanismKind
from optlaws.synthesis.problem.problem import PROBLEM

PAGE = Path(__file__).resolve().parents[2] / "docs" / "reference" / "problem-files.md"
#: tables of declared values by their names; of some entries the entries stand elsewhere
TABLES: dict[str, Callable[[], str]] = {
    "a table of solutions": partial(
        markdown_table, SolutionsProblemFile, apart=("problem", "sweep", "compare.problem")
    ),
    "a problem": partial(markdown_table, PROBLEM),
    "a cycle": partial(markdown_table, CycleProblemFile, apart=("axis",)),
    "an axis": partial(markdown_table, AxisEntries, apart=("run_out", "segment.limits")),
    "a least time": partial(markdown_table, FastestProblemFile),
    "laws for a machine": partial(markdown_table, MachineLawsProblemFile, apart=("sought.keep",)),
    "mechanisms of all kinds": partial(markdown_table, MechanismKind),
    **{
        f"the kind {name}": partial(
            markdown_table, kind, apart=("bodies", "loads", "follower", "segment"), without=MechanismKind
        )
        for name, kind in MechanismKind.kinds().items()
    },
    "bodies": partial(markdown_table, Body),
    "loads": partial(markdown_table, Loads),
    "a drive": partial(markdown_table, Drive, apart=("motor",)),
    "a motor": partial(markdown_table, Motor),
    "a cam": partial(markdown_table, CamProblemFile, apart=("motion", "pair.follower")),
    "a barrel": partial(markdown_table, Groove),
}


def between_marks(page: str, what: str, tables: Mapping[str, Callable[[], str]]) -> str:
    """The page with these tables, each between its marks, which say what it lists and by which name."""
    for name, table_of in tables.items():
        begin, end = f"<!-- {what} of {name} -->\n", f"<!-- end of the {what} of {name} -->\n"
        before, _, rest = page.partition(begin)
        page = f"{before}{begin}\n{table_of()}\n\n{end}{rest.partition(end)[2]}"
    return page


def page_with_tables(page: str) -> str:
    """The page with the entries of today."""
    return between_marks(page, "entries", TABLES)


if __name__ == "__main__":
    PAGE.write_text(page_with_tables(PAGE.read_text("utf-8")), "utf-8")
