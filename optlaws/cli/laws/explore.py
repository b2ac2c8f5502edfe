"""The command `optlaws explore`: laws, fronts and cycles in the browser."""

from __future__ import annotations

from optlaws.cli.options import Whole, takes


@takes(json=False, watched=False)
def explore(file: str | None = None, /, *, port: Whole | None = None, no_browser: bool = False) -> None:
    """Explore laws, fronts and cycles in the browser, from this machine alone: drag a point and the law follows.

    Parameters
    ----------
    file
        What to show first: a law's name, or the file of a law, a solution, a cycle, a problem or results.
    port
        Port on this machine, 0 for any free one; 8337 unless given, or a free one where that is taken.
    no_browser
        Print the address and open no browser.
    """
    from optlaws.explorer.server import explore as serve
    from optlaws.explorer.start import results_of, start

    results = results_of(file)
    serve(start(file, results), results, port, browser=not no_browser)
