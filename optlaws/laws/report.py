"""The report of a law: its constants, and its curves over k through their extremes, broken where they jump."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import Any

import numpy as np

from optlaws.kept import kept_property
from optlaws.laws.curve import Curve
from optlaws.laws.law import MotionLaw
from optlaws.numbers import Array, chop
from optlaws.shown.curve_points import refined
from optlaws.shown.report import Panel, ReportSegment, ReportTable, Series
from optlaws.shown.summary import Summary
from optlaws.tolerances import NO_MARK

#: the orders of what is shown of a law; the power d has none
ORDERS = {"a": 0, "b": 1, "c": 2, "d": None, "j": 3}
_NAMES = {"a": "displacement", "b": "velocity", "c": "acceleration", "d": "power", "j": "jerk"}
_SAMPLES = 161


def law_panel(curve: Curve, letter: str) -> Panel:
    """One of a, b, c, d and j of a law or of the motion of a mass, dimensionless over k.

    Examples
    --------
    >>> from optlaws import catalogue
    >>> panel = law_panel(catalogue["constant acceleration"].law, "c")
    >>> panel.title, panel.peaks
    ('acceleration c', ((0.5, -4.0), (0.0, 4.0)))
    """
    nu, function = ORDERS[letter], getattr(curve, letter)
    extremes = curve.power_extrema() if nu is None else curve.extrema(nu)
    marked = [extreme for extreme in extremes if isfinite(extreme.value)]
    k, values = _power(curve) if nu is None else broken(curve, nu)
    k, (values,) = refined(k, [values], [function], np.array([extreme.k for extreme in marked]))
    size = max((abs(extreme.value) for extreme in marked), default=0.0)
    peaks = dict.fromkeys(
        (extreme.k, extreme.value) for extreme in marked if nu != 0 and chop(extreme.value, size, NO_MARK)
    )
    least, most = (extreme.value for extreme in extremes)
    return Panel(f"{_NAMES[letter]} {letter}", "", (Series(k, values),), peaks=tuple(peaks), ends=(least, most))


def _power(curve: Curve) -> tuple[Array, Array]:
    """Samples of the power, broken where it jumps or is infinite."""
    (k, b), (_, c) = (curve.samples(_SAMPLES, nu) for nu in (1, 2))
    with np.errstate(invalid="ignore"):
        return _with_gaps(_jumps(curve, 2), k, np.where(np.isfinite(c), b * c, curve.d(k)))


def broken(curve: Curve, nu: int, count: int = _SAMPLES) -> tuple[Array, Array]:
    """Samples of a derivative to be drawn as a line: it is broken by nan where the derivative jumps or is infinite.

    Examples
    --------
    >>> from optlaws import catalogue
    >>> k, c = broken(catalogue["constant acceleration"].law, 2, 3)
    >>> k.tolist(), c.tolist()
    ([0.0, 0.5, 0.5, 0.5, 1.0], [4.0, 4.0, nan, -4.0, -4.0])
    """
    return _with_gaps(_jumps(curve, nu), *curve.samples(count, nu))


def _with_gaps(jumps: Array, k: Array, values: Array) -> tuple[Array, Array]:
    values = np.where(np.isfinite(values), values, np.nan)
    # at a break the value before it comes first, and the one after it at least twice
    last = np.searchsorted(k, jumps, side="right") - 1
    first = np.searchsorted(k, jumps, side="left")
    keep = np.ones(len(k), dtype=bool)
    for before, after in zip(first, last, strict=True):
        keep[before + 2 : after] = False
        values[before + 1] = np.nan
    return k[keep], values[keep]


def _jumps(curve: Curve, nu: int) -> Array:
    """The places where the curve's derivative jumps; jumps of lower order make it infinite there."""
    if not isinstance(curve, MotionLaw):
        return np.empty(0)
    return np.unique([place for lower in range(1, nu + 1) for place, _ in curve.jumps(lower)])


@dataclass(frozen=True)
class LawReport:
    """The report of a law; its panels are a, b, c, d and j over k, dimensionless."""

    law: MotionLaw
    tables: tuple[ReportTable, ...] = ()
    segments: tuple[ReportSegment, ...] = ()

    @property
    def facts(self) -> Summary:
        """The constants of the law."""
        return self.law.constants.summary()

    @kept_property
    def panels(self) -> tuple[Panel, ...]:
        """Displacement, velocity, acceleration, power and jerk."""
        return tuple(law_panel(self.law, letter) for letter in ORDERS)

    @property
    def data(self) -> dict[str, Any]:
        """The law with its constants."""
        return {"constants": self.law.constants.to_dict(), "law": self.law.to_dict()}
