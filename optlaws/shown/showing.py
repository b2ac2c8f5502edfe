"""How values show themselves in notebooks: tables and small drawings as HTML, escaped, legible on light and on dark."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from itertools import groupby
from math import isfinite

WIDTH = 150
HEIGHT = 60
_MARGIN = 4
#: on white and on black as well
_LINE = "#4292c6"

Numbers = Sequence[float]


class Html(str):
    """Text that is HTML already, and is not escaped again.

    Examples
    --------
    >>> cell(Html("<b>C</b>")), cell("<b>C</b>")
    ('<b>C</b>', '&lt;b&gt;C&lt;/b&gt;')
    """

    __slots__ = ()


def cell(value: object) -> str:
    """A number to seven digits, nothing for None, everything else as its text, escaped."""
    if value is None:
        return ""
    if isinstance(value, Html):
        return value
    return escape(f"{value:.7g}" if isinstance(value, float) else str(value))


def page(title: object, *parts: str) -> str:
    """A title above parts that are HTML; without scripts, styles or addresses.

    Examples
    --------
    >>> page("laws of <l>", facts({"C": 4.0}))
    '<div><b>laws of &lt;l&gt;</b><table><tr><th>C</th><td>4</td></tr></table></div>'
    """
    return f"<div><b>{cell(title)}</b>{''.join(parts)}</div>"


def facts(named: Mapping[str, object]) -> str:
    """A table of names and values; values of None are omitted.

    Examples
    --------
    >>> facts({"status": "optimal", "limit": None})
    '<table><tr><th>status</th><td>optimal</td></tr></table>'
    """
    rows = (
        f"<tr><th>{cell(name)}</th><td>{cell(value)}</td></tr>" for name, value in named.items() if value is not None
    )
    return f"<table>{''.join(rows)}</table>"


def table(headings: Iterable[object], rows: Iterable[Iterable[object]]) -> str:
    """An HTML table with headings."""
    head = "".join(f"<th>{cell(heading)}</th>" for heading in headings)
    body = "".join(f"<tr>{''.join(f'<td>{cell(entry)}</td>' for entry in row)}</tr>" for row in rows)
    return f"<table><tr>{head}</tr>{body}</table>"


def drawing(name: str, x: Numbers, y: Numbers) -> str:
    """A small curve as SVG with a line at 0; it is broken where y is not finite.

    Parameters
    ----------
    name
        What stands in its corner, and what is read aloud.
    x, y
        Places, ascending, and values.

    Examples
    --------
    >>> drawing("c", [0.0, 0.5, 0.5, 1.0], [4.0, 4.0, float("nan"), -4.0]).count("M")
    2
    """
    known = [value for value in y if isfinite(value)]
    low, high = min([0.0, *known]), max([0.0, *known])
    up = (HEIGHT - 2 * _MARGIN) / ((high - low) or 1.0)
    along = (WIDTH - 2 * _MARGIN) / ((x[-1] - x[0]) or 1.0)

    def height(value: float) -> str:
        return f"{HEIGHT - _MARGIN - (value - low) * up:.1f}"

    points = [
        (f"{_MARGIN + (place - x[0]) * along:.1f},{height(v)}" if isfinite(v) else "")
        for place, v in zip(x, y, strict=True)
    ]
    runs = [" L".join(run) for drawn, run in groupby(points, key=bool) if drawn]
    curve = " ".join(f"M{run}" for run in runs)
    label = escape(name, quote=True)
    return (
        f'<svg width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="{label}">'
        f'<line x1="{_MARGIN}" x2="{WIDTH - _MARGIN}" y1="{height(0.0)}" y2="{height(0.0)}" '
        'stroke="currentColor" stroke-opacity="0.35"/>'
        f'<path d="{curve}" fill="none" stroke="{_LINE}" stroke-width="1.6"/>'
        f'<text x="{WIDTH - _MARGIN}" y="12" font-size="11" text-anchor="end" fill="currentColor">{label}</text></svg>'
    )
