"""The tables of entries in docs/reference/problem-files.md, made from what the values of problem files declare.

A new table is a line of `TABLES`, and its mark in the page: `<!-- entries of NAME -->`.
"""

from collections.abc import Callable
from functools import partial

import optlaws.cams.at_shaft  # noqa: F401 - by which the kind "cam" is known
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
