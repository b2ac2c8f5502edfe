"""Laws given as a formula of k: exact derivatives, one polynomial to machine accuracy between kinks."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.of_motion import MotionFormula, checked
from optlaws.formulas.reading import read
from optlaws.formulas.slopes import derivative, opposite
from optlaws.formulas.tree import Call, Formula, rebuilt
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment
from optlaws.numbers import Array
from optlaws.numerics import chebyshev
from optlaws.tolerances import AGREEMENT


def formula_law(text: str) -> PiecewiseLaw:
    """The law whose displacement a(k) is a formula of k, such as "k - sin(2*pi*k)/(2*pi)"; dimensionless.

    Velocity and acceleration are those of the differentiated formula. Between kinks, which `abs`, `max`, `min` and
    tables have, the acceleration is one polynomial to machine accuracy.

    Parameters
    ----------
    text
        The formula: numbers, k, pi, + - * / ^, sin cos tan atan tanh exp log sqrt abs, max min norm of several parts,
        `table(k, 0:0, 0.5:0.4, 1:1)` of straight lines, `spline(...)` of cubic ones.

    Raises
    ------
    InputError
        If the text is no formula of k, or the acceleration grows without limit, as that of `k^1.5` at k = 0.

    Examples
    --------
    >>> law = formula_law("k - sin(2*pi*k)/(2*pi)")
    >>> law
    PiecewiseLaw(segments=1, B=2, C=6.28319, D=8.1621, J=39.4784)
    >>> formula_law("k^2*(3 - 2*v)")
    Traceback (most recent call last):
    optlaws.formulas.reading.FormulaError: unknown name 'v'; known are k
      k^2*(3 - 2*v)
                 ^
    """
    if not isinstance(text, str):
        raise InputError(f"a law's formula must be a text such as 'k - sin(2*pi*k)/(2*pi)', got {shortened(text)}")
    motion = checked(MotionFormula(read(text, ("k",))), text)
    places = np.unique([0.0, *motion.kinks, 1.0])
    segments = [_segment(motion.formula, start, stop) for start, stop in pairwise(places.tolist())]
    law = PiecewiseLaw(places, segments, float(_values(motion.formula, np.zeros(1))[0]))
    _check(law, motion.formula, places)
    return law


def _segment(formula: Formula, start: float, stop: float) -> PolynomialSegment:
    velocity = derivative(_smooth(formula, 0.5 * (start + stop)), "k")
    acceleration = derivative(velocity, "k")

    def c(x: Array) -> Array:
        return _values(acceleration, start + 0.5 * (stop - start) * (x + 1.0))

    series = chebyshev.interpolated(c, f"the acceleration of the law {shortened(str(formula))}")
    return PolynomialSegment(tuple(series.tolist()), float(_values(velocity, np.array([start]))[0]))


def _smooth(formula: Formula, k: float) -> Formula:
    """The formula with each abs, max and min replaced by its smooth branch at k."""
    if isinstance(formula, Call) and formula.function in {"abs", "max", "min"}:
        values = [float(_values(part, np.array([k]))[0]) for part in formula.arguments]
        if formula.function == "abs":
            inner = _smooth(formula.arguments[0], k)
            return inner if values[0] >= 0.0 else opposite(inner)
        best = (max if formula.function == "max" else min)(values)
        return _smooth(formula.arguments[values.index(best)], k)
    return rebuilt(formula, [_smooth(part, k) for part in formula.parts])


def _values(formula: Formula, k: Array) -> Array:
    with np.errstate(all="ignore"):
        return np.array(np.broadcast_to(evaluate(formula, {"k": k}, NUMPY), k.shape), dtype=np.float64)


def _check(law: PiecewiseLaw, formula: Formula, places: Array) -> None:
    """Refuse a formula that the polynomials miss, as they would a kink that nothing announces."""
    inner = np.linspace(0.0, 1.0, 33)
    k = np.unique(np.concatenate([start + (stop - start) * inner for start, stop in pairwise(places.tolist())]))
    exact = _values(formula, k)
    error = float(np.abs(law.a(k) - exact).max())
    if not error <= AGREEMENT * max(float(np.ptp(exact)), float(np.abs(exact).max())):
        raise InputError(f"the law {shortened(str(formula))} must be smooth but for its abs, max, min and tables")
