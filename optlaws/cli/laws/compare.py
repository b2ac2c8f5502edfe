"""The command `optlaws compare`: laws side by side, in a table and in one figure."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import optlaws
from optlaws.cli.law_options import one_or_two
from optlaws.cli.options import Written, options, takes
from optlaws.cli.show import Answer

_COMPARED = "optlaws.cycles.law_comparison:compare_laws"


@takes(
    "Draw position, velocity, acceleration and jerk of all laws into this file, PNG or SVG.",
    machine=options(_COMPARED, "stroke", "duration", "mass"),
    follower=options(_COMPARED, "damping"),
)
def compare(
    *laws: str,
    machine: Mapping[str, Any],
    frequency: list[float | str] | None = None,
    follower: Mapping[str, Any],
    csv: Written = None,
) -> Answer:
    """Compare laws: their constants, their peaks in a machine, the vibration they leave behind.

    Parameters
    ----------
    laws
        Names or codes of the catalogue, members such as "III(7.2)", JSON files of laws or of `optlaws solve --output`,
        tables of points such as old.csv or "old.csv(tolerance=0.02; columns=1,3)".
    frequency
        Frequency of an elastic follower, such as 12Hz beside --duration, or as a number nu: the radians of its free
        vibration in the motion; twice for an interval. The greatest residual acceleration is listed.
    csv
        Write the table to this file.
    """
    from optlaws.shown.report import ReportTable

    swept = None if frequency is None else one_or_two(frequency)
    comparison = optlaws.compare_laws(*laws, **machine, frequency=swept, **follower)
    table = ReportTable(list(comparison.rows[0]), [list(row.values()) for row in comparison.rows])
    if csv is not None:
        from optlaws.files import tables, writing

        writing.write(csv, tables.to_csv(*table, about="laws compared"))
    return Answer(lambda: [table, *comparison.remarks], comparison.to_dict, comparison.plot)
