"""The command `optlaws compare`: laws side by side, in a table and in one figure."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import optlaws
from optlaws.cli.law_options import Frequencies
from optlaws.cli.options import AsJson, Plot, Written, options, save_picture, takes
from optlaws.cli.show import print_json, show, table
from optlaws.errors import InputError

_ONE, _INTERVAL = 1, 2


@takes(machine=options(optlaws.compare_laws, "stroke", "duration"), follower=options(optlaws.compare_laws, "damping"))
def compare(
    *laws: str,
    machine: Mapping[str, Any],
    frequency: Frequencies | None = None,
    follower: Mapping[str, Any],
    plot: Plot = None,
    csv: Written = None,
    as_json: AsJson = False,
) -> None:
    """Compare laws: their constants, their peaks in a machine, the vibration they leave behind.

    Parameters
    ----------
    laws
        Names or codes of the catalogue, members such as "III(7.2)", JSON files of laws or of `optlaws solve --output`,
        tables of points such as old.csv or "old.csv(tolerance=0.02; columns=1,3)".
    frequency
        Frequency nu of an elastic follower, radians of its free vibration in the motion, or twice for an interval: the
        greatest residual acceleration is listed.
    plot
        Draw a, b, c and j of all laws into this file, PNG or SVG.
    csv
        Write the table to this file.
    """
    if frequency is not None and len(frequency) > _INTERVAL:
        raise InputError(
            f"--frequency is given once for a single one or twice for an interval, got {len(frequency)} times"
        )
    swept = None if frequency is None else frequency[0] if len(frequency) == _ONE else (frequency[0], frequency[1])
    comparison = optlaws.compare_laws(*laws, **machine, frequency=swept, **follower)
    if csv is not None:
        _save(comparison, csv)
    save_picture(plot, comparison)
    if as_json:
        print_json(comparison.to_dict())
        return
    show(table(*comparison.rows[0], rows=(row.values() for row in comparison.rows)), *comparison.remarks)


def _save(comparison: optlaws.Comparison, file: Path) -> None:
    from optlaws.files import tables, writing

    rows = [list(row.values()) for row in comparison.rows]
    writing.write(file, tables.to_csv(list(comparison.rows[0]), rows, about="laws compared"))
