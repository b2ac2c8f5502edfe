"""How a law shows itself in a notebook: a table of its constants and a drawing of a, b and c."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from optlaws.laws.constants import Constants

WIDTH = 150
HEIGHT = 60
MARGIN = 4


def page(title: str, constants: Constants, curves: Mapping[str, Sequence[float]]) -> str:
    """HTML text without scripts or styles of its own; curves are values at equal steps of k.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> "<svg" in page("a law", smoothstep(2).constants, {"a": [0.0, 1.0]})
    True
    """
    peaks = {"B": constants.B, "C": constants.C, "D": constants.D, "J": constants.J}
    rows = "".join(
        f"<tr><th>{name}</th><td>{peak.value:.7g}</td><td>{peak.k:.6g}</td></tr>" for name, peak in peaks.items()
    )
    drawings = "".join(_drawing(name, values) for name, values in curves.items())
    return (
        f"<div><b>{title}</b><table><tr><th></th><th>peak</th><th>k</th></tr>{rows}"
        f"<tr><th>RMS c</th><td>{constants.rms_c:.7g}</td><td></td></tr></table>{drawings}</div>"
    )


def _drawing(name: str, values: Sequence[float]) -> str:
    low, high = min(0.0, *values), max(0.0, *values)
    scale = (HEIGHT - 2 * MARGIN) / ((high - low) or 1.0)
    step = (WIDTH - 2 * MARGIN) / (len(values) - 1)
    points = " ".join(
        f"{MARGIN + i * step:.1f},{HEIGHT - MARGIN - (value - low) * scale:.1f}" for i, value in enumerate(values)
    )
    zero = HEIGHT - MARGIN + low * scale
    return (
        f'<svg width="{WIDTH}" height="{HEIGHT}" role="img" aria-label="{name}(k)">'
        f'<line x1="{MARGIN}" x2="{WIDTH - MARGIN}" y1="{zero:.1f}" y2="{zero:.1f}" stroke="#bbb"/>'
        f'<polyline points="{points}" fill="none" stroke="#1f6fb2" stroke-width="1.5"/>'
        f'<text x="{MARGIN}" y="12" font-size="11">{name}</text></svg>'
    )
