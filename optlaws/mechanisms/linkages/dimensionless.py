"""A mechanism over one stroke without dimensions: what formulas of a law need, and the units of their numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from optlaws.errors import InputError
from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.formulas.slopes import added, multiplied, opposite, scaled
from optlaws.formulas.tree import Formula, Name, Negative, Number, Product, Sum, Table, number, rebuilt
from optlaws.synthesis.functionals.makers import drive_torque
from optlaws.tolerances import TINY

_LOOKS = 721


@dataclass(frozen=True)
class DimensionlessMechanism:
    """A mechanism over the stroke x = start + stroke a(k), k = t/duration: texts in a, with the units of their numbers.

    The torque in the direction of the stroke is unit times `torque`, I(a) c + I'(a) b²/2 + f b + T(a): above 0 where
    the motor drives, whichever way x goes. Friction that does not depend on the speed is in T, for laws that never turn
    back.

    Attributes
    ----------
    inertia, load
        I(a) and T(a).
    friction
        f, of the viscous friction.
    unit
        Of the torque, N m or N.
    start, stroke, duration
        In rad or m, and s; the stroke is below 0 for motion to smaller x.
    holding
        The load without friction: what holds it at rest.
    """

    inertia: str
    friction: str
    load: str
    unit: float
    start: float
    stroke: float
    duration: float
    holding: str

    @property
    def torque(self) -> str:
        """The torque as a formula of a, b and c, for `peak`, `rms` and `integral`."""
        return drive_torque(inertia=self.inertia, friction=self.friction, load=self.load)

    @property
    def branches(self) -> tuple[str, ...]:
        """The torques whose maximum is `torque`: a single torque without gear losses."""
        return (self.torque,)

    @property
    def power(self) -> str:
        """The power, above 0 where the input is driven: torque times b."""
        return f"({self.torque})*b"

    @property
    def energy(self) -> str:
        """A formula of which the integral is the energy of the move, of which nothing is fed back."""
        return f"max({self.power}, 0)"

    @property
    def power_unit(self) -> float:
        """The unit of torque times b, W."""
        return self.unit * abs(self.stroke) / self.duration

    @property
    def energy_unit(self) -> float:
        """The unit of an integral of torque times b over k, J."""
        return self.unit * abs(self.stroke)


class InputFriction(NamedTuple):
    """Friction at the input of a mechanism, in SI units."""

    coulomb: float
    viscous: float


def dimensionless(
    inertia: Formula, load: Formula, friction: InputFriction, stroke: tuple[float, float, float]
) -> DimensionlessMechanism:
    """A mechanism over a stroke, known by its start, its length and its duration: see `Mechanism.dimensionless`."""
    start, way, time = stroke
    x = start + way * np.linspace(0.0, 1.0, _LOOKS)
    accelerating, direction = abs(way) / time**2, float(np.sign(way))
    moved = friction.viscous * abs(way) / time
    places = {"x": x, "k": np.linspace(0.0, 1.0, _LOOKS)}
    greatest = (float(np.max(np.abs(evaluate(formula, places, NUMPY)))) for formula in (inertia, load))
    unit = max(next(greatest) * accelerating, next(greatest), moved, friction.coulomb)
    if unit < TINY:
        raise InputError("the mechanism has neither inertia nor load nor friction on this stroke: nothing drives it")
    resisting = _times(_over_stroke(load, start, way), direction / unit)
    return DimensionlessMechanism(
        str(_times(_over_stroke(inertia, start, way), accelerating / unit)),
        str(number(moved / unit)),
        str(added([number(friction.coulomb / unit), resisting])),
        unit,
        start,
        way,
        time,
        str(resisting),
    )


def _over_stroke(formula: Formula, start: float, stroke: float) -> Formula:
    """The formula with start + stroke a for x; tables over x become tables over a."""
    if isinstance(formula, Name):
        way = multiplied([number(stroke), Name("a")])
        return added([number(start), way]) if formula.name == "x" else formula
    if isinstance(formula, Table) and formula.of == Name("x"):
        pairs = sorted(
            ((place - start) / stroke, value) for place, value in zip(formula.places, formula.values, strict=True)
        )
        places, values = zip(*pairs, strict=True)
        table = Table(Name("a"), places, values, formula.kind, formula.order)
        return _times(table, stroke**-formula.order)
    return rebuilt(formula, [_over_stroke(part, start, stroke) for part in formula.parts])


def _times(formula: Formula, factor: float) -> Formula:
    """A factor of either sign times a formula, taken into sums, products and tables."""
    if factor < 0.0:
        return _times(_opposite(formula), -factor)
    if isinstance(formula, Number | Negative | Product | Sum):
        return _scaled(formula, factor)
    if isinstance(formula, Table):
        values = tuple(value * factor for value in formula.values)
        return Table(formula.of, formula.places, values, formula.kind, formula.order)
    return scaled(formula, factor)


def _scaled(formula: Formula, factor: float) -> Formula:
    if isinstance(formula, Negative):
        return opposite(_times(formula.of, factor))
    if isinstance(formula, Sum):
        return added([_times(term, factor) for term in formula.terms])
    return multiplied([number(factor), *(formula.factors if isinstance(formula, Product) else (formula,))])


def _opposite(formula: Formula) -> Formula:
    return added([opposite(term) for term in formula.terms]) if isinstance(formula, Sum) else opposite(formula)
