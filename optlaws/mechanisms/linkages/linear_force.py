"""Drives of constant inertia and of a load in proportion to the position: forces that are affine in the motion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from optlaws.formulas.affine import affine
from optlaws.formulas.slopes import added, constant, multiplied
from optlaws.formulas.tree import Formula, Table, number, rebuilt
from optlaws.motion.piece import factor
from optlaws.tolerances import OPERATIONS_ROUNDING


class LinearForce(NamedTuple):
    """The force of a motion x: inertia x'' + viscous x' + stiffness x + constant + dry sign(x'), in SI units."""

    inertia: float
    viscous: float
    stiffness: float
    constant: float
    dry: float

    def formula(self, stroke: float, duration: float, offset: float, direction: float, unit: float) -> str:
        """The force in a unit, as a formula of a law that moves forwards (direction 1), backwards (-1) or rests (0).

        >>> LinearForce(2.0, 0.0, 10.0, 3.0, 0.5).formula(0.1, 1.0, 0.2, -1.0, 1.0)
        '(1.0)*a + (0.2)*c + (4.5)'
        """
        still = self.constant + self.stiffness * offset + self.dry * direction
        factors = [size / unit for size in self._factors(stroke, duration)]
        terms = [f"({value!r})*{name}" for value, name in zip(factors, "abc", strict=True) if value]
        return " + ".join([*terms, f"({still / unit!r})"])

    def size(self, stroke: float, duration: float, offset: float) -> float:
        """The order of magnitude of the force along a motion, as its unit."""
        spring, damper, inertia = (abs(size) for size in self._factors(stroke, duration))
        return 4.0 * inertia + 2.0 * damper + spring + abs(self.constant + self.stiffness * offset) + self.dry

    def _factors(self, stroke: float, duration: float) -> tuple[float, float, float]:
        """The factors of a, b and c of a law in the force."""
        return (
            self.stiffness * stroke,
            self.viscous * factor(stroke, duration, 1),
            self.inertia * factor(stroke, duration, 2),
        )


def line_of(formula: Formula) -> tuple[float, float] | None:
    """The slope of a formula of x and its value at x = 0, where it is a straight line; None where it is none.

    >>> from optlaws.formulas.reading import read
    >>> line_of(read("2*(x + 1) - pi", ("x",))), line_of(read("table(x, 0:1, 1:3, 2:5)", ("x",)))
    ((2.0, -1.1415926535897931), (2.0, 1.0))
    >>> line_of(read("sin(x)", ("x",))) is None
    True
    """
    form = affine(_with_lines(formula), ("x",))
    if form is None:
        return None
    slope, rest = (constant(part) for part in (dict(form.factors).get("x", number(0.0)), form.rest))
    return None if slope is None or rest is None else (slope, rest)


def _with_lines(formula: Formula) -> Formula:
    """The formula with lines in place of tables whose values are on one."""
    parts = [_with_lines(part) for part in formula.parts]
    whole = rebuilt(formula, parts) if parts else formula
    if not isinstance(whole, Table) or whole.order:
        return whole
    places, values = np.array(whole.places), np.array(whole.values)
    slope = float((values[-1] - values[0]) / (places[-1] - places[0]))
    first = float(values[0] - slope * places[0])
    size = np.abs(values).max() + abs(slope) * np.abs(places).max()
    if np.abs(first + slope * places - values).max() > OPERATIONS_ROUNDING * size:
        return whole
    return added([multiplied([number(slope), whole.of]), number(first)])
