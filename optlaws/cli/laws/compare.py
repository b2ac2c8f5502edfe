"""The command `optlaws compare`: laws side by side, in a table and in one figure."""

from __future__ import annotations

from pathlib import Path

import optlaws
from optlaws.cli.options import AsJson, Duration, Frequencies, Plot, Signed, check_files, save_picture
from optlaws.cli.show import number, print_json, show, table
from optlaws.errors import InputError
from optlaws.tolerances import VALUE_ROUNDING

_ONE, _INTERVAL = 1, 2


def compare(
    *laws: str,
    stroke: Signed = None,
    duration: Duration = None,
    frequency: Frequencies | None = None,
    damping: float = 0.0,
    plot: Plot = None,
    csv: Path | None = None,
    as_json: AsJson = False,
) -> None:
    """Compare laws: their constants, their peaks in a machine, the vibration they leave behind.

    Parameters
    ----------
    laws
        Names or codes of the catalogue, members such as "III(7.2)", JSON files of laws or of `optlaws solve --output`,
        tables of points such as old.csv or "old.csv(tolerance=0.02; columns=1,3)".
    stroke
        Stroke of the machine with its unit, such as 35mm or 45deg; with --duration gives peaks in machine units.
    duration
        Duration of the motion with its unit, such as 0.1s.
    frequency
        Frequency nu of an elastic follower, radians of its free vibration in the motion, or twice for an interval: the
        greatest residual acceleration is listed.
    damping
        Damping ratio of the follower.
    plot
        Draw a, b, c and j of all laws into this file, PNG or SVG.
    csv
        Write the table to this file.
    as_json
        Print one JSON object on stdout and nothing else.
    """
    check_files(csv, plot=plot)
    if frequency is not None and len(frequency) > _INTERVAL:
        raise InputError(
            f"--frequency is given once for a single one or twice for an interval, got {len(frequency)} times"
        )
    swept = None if frequency is None else frequency[0] if len(frequency) == _ONE else (frequency[0], frequency[1])
    comparison = optlaws.compare_laws(*laws, stroke=stroke, duration=duration, frequency=swept, damping=damping)
    if csv is not None:
        _save(comparison, csv)
    if plot is not None:
        save_picture(plot, comparison)
    if as_json:
        print_json(comparison.to_dict())
        return
    rows = (
        [cell if isinstance(cell, str) else number(cell, VALUE_ROUNDING, ".7g") for cell in row.values()]
        for row in comparison.rows
    )
    show(table(*comparison.rows[0], rows=rows), *comparison.remarks)


def _save(comparison: optlaws.Comparison, file: Path) -> None:
    from optlaws.files import tables, writing

    rows = [list(row.values()) for row in comparison.rows]
    writing.write(file, tables.to_csv(list(comparison.rows[0]), rows, about="laws compared"))
