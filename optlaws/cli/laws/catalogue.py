"""The command `optlaws catalogue`: the standard laws, listed and searched."""

from __future__ import annotations

import optlaws
from optlaws.cli.options import AsJson, Plot, save_figure
from optlaws.cli.show import print_json, show, table
from optlaws.errors import InputError

_LETTERS = ("b", "c", "j", "j'", "j''")


def catalogue(search: str | None = None, /, *, plot: Plot = None, as_json: AsJson = False) -> None:
    """List the standard laws, or the laws that match a text, the likeliest first.

    Parameters
    ----------
    search
        A name in any language or of a controller, or part of one.
    plot
        Draw the acceleration of each listed law, in a panel each, into this file, PNG or SVG.
    """
    known = optlaws.catalogue
    entries = tuple(known.values()) if search is None else known.search(search)
    if not entries:
        raise InputError(f"no law is like {search!r}; `optlaws catalogue` lists all {len(known)}")
    if plot is not None:
        from optlaws.plots.law import accelerations_figure

        save_figure(plot, accelerations_figure({entry.name: entry.law for entry in entries}))
    if as_json:
        print_json([{key: value for key, value in entry.to_dict().items() if key != "law"} for entry in entries])
        return
    rows = (
        [entry.name, *(getattr(entry.constants, name).value for name in "BCDJ"), continuous(entry.continuity)]
        for entry in entries
    )
    show(table("law", *"BCDJ", "continuous", rows=rows, digits=6))


def continuous(order: int) -> str:
    """Which derivatives of a law are continuous, in letters."""
    return "a" + "".join(f", {letter}" for letter in _LETTERS[:order])
