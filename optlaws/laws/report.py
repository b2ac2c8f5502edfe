"""The report of a law: its constants, its curves over k through their extremes, and its values at equal steps of k.

Curves are broken where they jump. The values are those of a, b, c, j and d.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from optlaws.files import tables
from optlaws.kept import kept_property
from optlaws.laws.curve import Curve
from optlaws.laws.law import MotionLaw
from optlaws.numbers import MOST_VALUES, Array, chop, whole
from optlaws.numerics.peaks import Peak
from optlaws.shown.curve_points import refined
from optlaws.shown.report import Panel, ReportSegment, ReportTable, Series
from optlaws.shown.summary import Summary
from optlaws.tolerances import NO_MARK, VALUE_ROUNDING

_NAMES = {"a": "displacement", "b": "velocity", "c": "acceleration", "d": "power", "j": "jerk"}
#: the orders of the derivatives; of the power, that of the last of which it is made
_ORDERS = {"a": 0, "b": 1, "c": 2, "d": 2, "j": 3}
_SAMPLES = 161


def law_panels(curve: Curve, letters: str = "abcdj") -> tuple[Panel, ...]:
    """Curves of a law, or of the motion of a mass, dimensionless at the same places k.

    Examples
    --------
    >>> from optlaws import catalogue
    >>> (panel,) = law_panels(catalogue["constant acceleration"].law, "c")
    >>> panel.title, panel.peaks
    ('acceleration c', ((0.5, -4.0), (0.0, 4.0)))
    """
    jumps = _jumps(curve, 3)
    k = _places(curve, jumps, _SAMPLES)
    values = [_power(curve, k, jumps) if of == "d" else _values(curve, _ORDERS[of], k, jumps) for of in letters]
    extremes = [curve.power_extrema() if of == "d" else curve.extrema(_ORDERS[of]) for of in letters]
    marks = np.array([extreme.k for pair in extremes for extreme in pair if isfinite(extreme.value)])
    k, values = refined(k, values, [getattr(curve, of) for of in letters], marks)
    return tuple(_panel(*parts, k) for parts in zip(letters, extremes, values, strict=True))


def _panel(letter: str, extremes: tuple[Peak, Peak], values: Array, k: Array) -> Panel:
    size = max(abs(extreme.value) for extreme in extremes)
    marked = (extreme for extreme in extremes if letter != "a" and chop(extreme.value, size, NO_MARK))
    peaks = tuple(dict.fromkeys((extreme.k, extreme.value) for extreme in marked))
    least, most = (extreme.value for extreme in extremes)
    return Panel(f"{_NAMES[letter]} {letter}", "", (Series(k, values),), (), peaks, (least, most), "k", 1.0)


def _places(curve: Curve, jumps: Array, count: int) -> Array:
    """Even places and breaks; those of jumps three times, for the values before, between and after."""
    even = np.union1d(np.linspace(*curve.interval, count), curve.breaks)
    return np.sort(np.concatenate([even, jumps, jumps]))


def _values(curve: Curve, nu: int, k: Array, jumps: Array) -> Array:
    values = np.array(curve(k, nu))
    first = np.searchsorted(k, jumps)
    places, sides = curve.samples(2, nu)
    values[first] = sides[np.searchsorted(places, jumps)]
    values[first[np.isin(jumps, _jumps(curve, nu))] + 1] = np.nan
    return np.where(np.isfinite(values), values, np.nan)


def _power(curve: Curve, k: Array, jumps: Array) -> Array:
    """The values of b c, between those of the sides of jumps; where c is infinite and b is 0, those of the power."""
    b, c = (_values(curve, nu, k, jumps) for nu in (1, 2))
    infinite = ~np.isfinite(np.asarray(curve(k, 2)))
    power = np.where(infinite, curve.d(k), b * c)
    return np.where(np.isfinite(power), power, np.nan)


def _jumps(curve: Curve, nu: int) -> Array:
    """The places where the curve's derivative jumps; jumps of lower order make it infinite there."""
    if not isinstance(curve, MotionLaw):
        return np.empty(0)
    return np.unique([place for lower in range(1, nu + 1) for place, _ in curve.jumps(lower)])


@dataclass(frozen=True)
class LawReport:
    """The report of a law; its panels are a, b, c, d and j over k, dimensionless."""

    law: MotionLaw

    tables: ClassVar[tuple[ReportTable, ...]] = ()
    segments: ClassVar[tuple[ReportSegment, ...]] = ()

    @property
    def facts(self) -> Summary:
        """The constants of the law."""
        return self.law.constants.summary()

    @kept_property
    def panels(self) -> tuple[Panel, ...]:
        """Displacement, velocity, acceleration, power and jerk."""
        return law_panels(self.law)

    @property
    def data(self) -> dict[str, Any]:
        """The law with its constants."""
        return {"constants": self.law.constants.to_dict(), "law": self.law.to_dict()}


LETTERS = ("a", "b", "c", "j", "d")
#: the default number of lines
SAMPLES = 201
_DIGITS = 15


def sizes(law: MotionLaw) -> tuple[float, ...]:
    """The greatest values of a, b, c, j and d."""
    constants = law.constants
    return law.peak(0).value, constants.B.value, constants.C.value, constants.J.value, constants.D.value


def values(law: MotionLaw, k: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """The values of a, b, c, j and d; what is rounding beside the greatest is 0.

    >>> from optlaws import smoothstep
    >>> [float(column[0]) for column in values(smoothstep(3), np.array([0.5]))]
    [0.5, 1.875, 0.0, -30.0, 0.0]
    """
    columns = [getattr(law, letter)(k) for letter in LETTERS]
    return [
        np.where(np.abs(column) <= VALUE_ROUNDING * size, 0.0, column)
        for column, size in zip(columns, sizes(law), strict=True)
    ]


def table_of_values(law: MotionLaw, name: str, count: int = SAMPLES) -> str:
    """The values as CSV, a line for each k.

    Raises
    ------
    InputError
        If `count` is not an integer of at least 2.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> print(table_of_values(smoothstep(3), "3-4-5", 3), end="")
    # law 3-4-5: dimensionless; after a jump its value there; made by optlaws
    k,a,b,c,j,d
    0,0,0,0,60,0
    0.5,0.5,1.875,0,-30,0
    1,1,0,0,60,0
    """
    k = np.linspace(0.0, 1.0, whole(count, "samples", least=2, most=MOST_VALUES))
    about = f"law {' '.join(name.split())}: dimensionless; after a jump its value there"
    rows = np.column_stack([k, *values(law, k)]).tolist()
    return tables.to_csv(("k", *LETTERS), rows, about=about, digits=_DIGITS)
