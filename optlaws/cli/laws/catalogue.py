"""The command `optlaws catalogue`: the standard laws, listed and searched."""

from __future__ import annotations

import optlaws
from optlaws.cli.options import takes
from optlaws.cli.show import Answer
from optlaws.errors import InputError


@takes("Draw the acceleration of each listed law, in a panel each, into this file, PNG or SVG.")
def catalogue(search: str | None = None, /) -> Answer:
    """List the standard laws, or the laws that match a text, the likeliest first.

    Parameters
    ----------
    search
        A name in any language or of a controller, or part of one.
    """
    from optlaws.laws.catalogue.entry import continuity_row
    from optlaws.plots.law import accelerations_figure
    from optlaws.shown.report import ReportTable

    known = optlaws.catalogue
    entries = tuple(known.values()) if search is None else known.search(search)
    if not entries:
        raise InputError(f"no law is like {search!r}; `optlaws catalogue` lists all {len(known)}")
    rows = (
        [entry.name, *(getattr(entry.constants, name).value for name in "BCDJ"), continuity_row(entry.continuity).value]
        for entry in entries
    )
    return Answer(
        lambda: [ReportTable(["law", *"BCDJ", "continuous"], list(rows))],
        lambda: [{key: value for key, value in entry.to_dict().items() if key != "law"} for entry in entries],
        lambda: accelerations_figure({entry.name: entry.law for entry in entries}),
    )
