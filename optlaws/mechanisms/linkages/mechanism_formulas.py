"""Formulas of a mechanism: from what people give, proven over a range, and over one stroke as those of a law."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from math import ceil, factorial
from numbers import Real
from typing import Any, Literal, NamedTuple

import numpy as np

from optlaws.echo import shortened
from optlaws.entries.value_types import ReadBy, ValueType
from optlaws.errors import InputError, located
from optlaws.formulas.arithmetic import NUMPY, evaluate, horner, pieces
from optlaws.formulas.convexity import Endpoints, affine, enclosed
from optlaws.formulas.jets import formula_jet
from optlaws.formulas.reading import read
from optlaws.formulas.slopes import added, constant, derivative, multiplied, opposite, scaled
from optlaws.formulas.tree import (
    Call,
    Exponentiation,
    Formula,
    Name,
    Negative,
    Reciprocal,
    Sum,
    Table,
    TableJoin,
    number,
    rebuilt,
    table_places,
)
from optlaws.lazy import Registry
from optlaws.motion.piece import factor
from optlaws.motion.quantities import quantity, written
from optlaws.numbers import NumberOrQuantity, finite, real
from optlaws.numerics.branch_and_bound import Extremes, extremes
from optlaws.numerics.interval import Interval, between, exact
from optlaws.numerics.taylor import Jet, variable
from optlaws.synthesis.functionals.makers import drive_torque
from optlaws.tolerances import OPERATIONS_ROUNDING, ROUNDOFF, TINY, VALUE_ROUNDING

InputAxis = Literal["angle", "length"]
#: of the inertia, of the load, of viscous friction, and of the input's velocity and acceleration
DIMENSIONS: dict[InputAxis, dict[str, str]] = {
    "angle": {
        "inertia": "moment of inertia",
        "load": "torque",
        "viscous": "rotary viscous friction",
        "velocity": "angular velocity",
        "acceleration": "angular acceleration",
    },
    "length": {
        "inertia": "mass",
        "load": "force",
        "viscous": "viscous friction",
        "velocity": "velocity",
        "acceleration": "acceleration",
    },
}
#: classes of what a move moves, by the entry that describes it
MOVED: Registry[Any] = Registry("what moves")
_PLACES = 721
TableKind = Literal["spline", "lines"]
#: how tables of values are joined: a spline of values keeps their shape
JOINED: dict[str, TableJoin] = {"spline": "monotone", "lines": "table"}
_FEWEST = 2
#: places at which a formula is looked at first, cells, how often these are cut, and how many of unknown sign at most
_LOOKS, _CELLS, _CUTS, _MOST = 1441, 64, 9, 512
#: a number with a unit behind it; in formulas a number is followed by a sign
_FILE = re.compile(r"\.(csv|tsv|txt|dat|json|xlsx?)\s*$", re.IGNORECASE)
_WITH_UNIT = re.compile(r"\s*[+-]?[\d./]*\d(?:[eE][+-]?\d+)?+\s*[^\W\d_]")


@dataclass(frozen=True)
class OverPlace(ValueType):
    """What `formula_of` reads, kept as it is given: its dimension is that of what it acts on.

    >>> OverPlace("x").read(True, "load")
    Traceback (most recent call last):
    optlaws.errors.InputError: load must be a number, a quantity, a formula of x, or a table of places and values, ...
    """

    of: str  #: the variables of formulas, in words

    def read(self, value: Any, name: str) -> Any:
        if isinstance(value, Formula | str | Mapping | list | tuple) or hasattr(value, "units"):
            return written(value)
        if isinstance(value, bool) or not isinstance(value, Real):
            raise InputError(f"{name} must be {self.words}, got {shortened(value)}")
        return finite(value, name)

    def plain(self, value: Any) -> Any:
        return str(value) if isinstance(value, Formula) else value

    @property
    def words(self) -> str:
        return f"a number, a quantity, a formula of {self.of}, or a table of places and values"

    def schema(self) -> dict[str, Any]:
        return {"type": ["number", "string", "array", "object"]}


#: a formula of x, as a text
FORMULA = ReadBy(lambda value: value if isinstance(value, Formula) else read(value, ("x",)), "a formula of x", str)


def formula_of(
    given: Any,
    dimensions: tuple[str, str],
    name: str,
    *,
    variable: str = "x",
    interpolation: TableKind = "spline",
) -> Formula:
    """The formula of a number, a quantity, a text, a formula or a table; errors call it `name`.

    Parameters
    ----------
    given
        A number in SI units, a quantity such as "0.02 kg m^2", a text such as "0.02 + 0.01*sin(x)^2" in SI units, a
        formula, or a table: pairs of a place and a value, or a mapping of places to values.
    dimensions
        Of the variable and of the value.
    name
        What an error calls it.
    variable
        The name of the variable in texts.
    interpolation
        Of tables: "spline", a smooth curve that rises and falls as the values do and is nowhere beyond its two
        neighbours, or straight "lines".

    Raises
    ------
    InputError
        If it is none of these.

    Examples
    --------
    >>> formula_of("0.02 kg m^2", ("angle", "moment of inertia"), "inertia")
    0.02
    >>> formula_of({"0 deg": "0 N m", "180 deg": "3 N m"}, ("angle", "torque"), "load", interpolation="lines")
    table(x, 0:0, 3.141592653589793:3)
    >>> formula_of("load.csv", ("angle", "torque"), "load")
    Traceback (most recent call last):
    optlaws.errors.InputError: load cannot be read from a file: give the rows of 'load.csv' in a list, as pairs of a ...
    """
    if isinstance(given, Formula):
        return given
    if isinstance(given, Mapping | list | tuple):
        pairs = list(given.items() if isinstance(given, Mapping) else given)
        numbers = table_numbers(pairs, dimensions, name)
        for i, ((place, _), (following, _)) in enumerate(pairwise(numbers)):
            if place >= following:
                raise InputError(
                    f"{name}: the places of a table must ascend, got {shortened(pairs[i][0])} before "
                    f"{shortened(pairs[i + 1][0])}"
                )
        places, values = zip(*numbers, strict=True)
        return Table(Name(variable), places, values, JOINED[interpolation])
    if isinstance(given, str) and _WITH_UNIT.match(given) is None:
        if _FILE.search(given):
            raise InputError(
                f"{name} cannot be read from a file: give the rows of {shortened(given)} in a list, as pairs of a "
                f"place and a value with units, or a formula of {variable}"
            )
        with located(name):
            formula = read(given, (variable,))
        for part in formula.different:
            if isinstance(part, Table) and part.kind == "spline":
                _check_shape(part, name)
        return formula
    return number(finite(quantity(given, dimensions[1], name, bare=True), name))


def _check_shape(table: Table, name: str) -> None:
    """Refuse a cubic spline that leaves the range of two neighbours: there it would be what nobody measured."""
    rows, rounding = pieces(replace(table, order=0)), VALUE_ROUNDING * max(map(abs, table.values))
    for i, (start, slope, bend, twist) in enumerate(rows.tolist()):
        length = table.places[i + 1] - table.places[i]
        turns = [
            at.real for at in np.roots([3.0 * twist, 2.0 * bend, slope]) if at.imag == 0.0 and 0.0 < at.real < length
        ]
        low, high = sorted((table.values[i], table.values[i + 1]))
        reached = (horner((start, slope, bend, twist), at) for at in turns)
        beyond = max((max(low - at, at - high) for at in reached), default=0.0)
        if beyond > rounding:
            raise InputError(
                f"{name}: between {table.places[i]:g} and {table.places[i + 1]:g} the spline is {beyond:.3g} beyond "
                "the values beside it: monotone(...) in its place never is, nor is a table of places and values"
            )


def table_numbers(pairs: list[Any], dimensions: tuple[str, str], name: str) -> list[tuple[float, float]]:
    """Places and values of a table in SI units, whether they ascend or not.

    >>> table_numbers([("0 deg", "1 kN"), ("90 deg", "0 N")], ("angle", "force"), "force")
    [(0.0, 1000.0), (1.5707963267948966, 0.0)]
    """
    if len(pairs) < _FEWEST or any(not isinstance(pair, list | tuple) or len(pair) != 2 for pair in pairs):
        raise InputError(
            f"{name}: a table needs {_FEWEST} pairs of a place and a value at least, got {shortened(pairs)}"
        )

    def in_si(value: Any, dimension: str, what: str) -> float:
        plain = real(value)
        return quantity(value, dimension, what) if plain is None else finite(plain, what)

    return [
        (in_si(place, dimensions[0], f"{name}: place {n}"), in_si(value, dimensions[1], f"{name}: value {n}"))
        for n, (place, value) in enumerate(pairs, 1)
    ]


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


def rescaled(formula: Formula, name: str, other: str, line: tuple[float, float]) -> Formula:
    """The formula with first + slope times another name for one; tables over it become tables over the other.

    >>> from optlaws.formulas.reading import read
    >>> rescaled(read("3*t"), "t", "m", (0.0, 0.5))
    3*0.5*m
    """
    first, slope = line
    if isinstance(formula, Name):
        way = multiplied([number(slope), Name(other)])
        return added([number(first), way]) if formula.name == name else formula
    if isinstance(formula, Table) and formula.of == Name(name):
        pairs = sorted(
            ((place - first) / slope, value) for place, value in zip(formula.places, formula.values, strict=True)
        )
        places, values = zip(*pairs, strict=True)
        table = Table(Name(other), places, values, formula.kind, formula.order)
        return times(table, slope**-formula.order)
    return rebuilt(formula, [rescaled(part, name, other, line) for part in formula.parts])


def times(formula: Formula, factor: float) -> Formula:
    """A factor of either sign times a formula, taken into sums, products and tables."""
    if factor < 0.0:
        terms = formula.terms if isinstance(formula, Sum) else (formula,)
        return times(added([opposite(term) for term in terms]), -factor)
    if isinstance(formula, Negative):
        return opposite(times(formula.of, factor))
    if isinstance(formula, Sum):
        return added([times(term, factor) for term in formula.terms])
    if isinstance(formula, Table):
        return replace(formula, values=tuple(value * factor for value in formula.values))
    return scaled(formula, factor)


@lru_cache(maxsize=256)
def slope_of(formula: Formula, nu: int) -> Formula:
    """The derivative of a formula by x of an order."""
    return formula if nu == 0 else derivative(slope_of(formula, nu - 1), "x")


@lru_cache(maxsize=256)
def extremes_over(formula: Formula, low: float, high: float) -> Extremes:
    """The extremes of a smooth formula of x between two positions, proven by enclosures of all between them.

    >>> from optlaws.formulas.reading import read
    >>> round(extremes_over(read("0.02 + 0.01*sin(x)^2", ("x",)), 0.0, 3.0).most, 12)
    0.03
    """

    def jet(x: Interval, order: int) -> Jet:
        at = {"x": Endpoints(x.low, x.high)}
        values = [enclosed(slope_of(formula, nu), at) for nu in range(order + 1)]
        ends = [np.broadcast_arrays(each.low, each.high, x.low)[:2] for each in values]
        return Jet([between(*each) / factorial(nu) for nu, each in enumerate(ends)])

    if low == high or line_of(formula) is not None:
        first, last = (float(evaluate(formula, {"x": x}, NUMPY)) for x in (low, high))
        (least, least_at), (most, most_at) = sorted([(first, low), (last, high)])
        return Extremes(least, least_at, least, most, most_at, most)
    edges = [low, *(place for place in table_places(formula, "x") if low < place < high), high]
    return extremes(jet, edges, share=ROUNDOFF, parts=ceil(_CELLS / (len(edges) - 1)))


@lru_cache(maxsize=256)
def sign_over(formula: Formula, low: float, high: float) -> tuple[int, float]:
    """The sign that a formula of x has everywhere between two positions, proven; else 0, and where it may be 0.

    >>> from optlaws.formulas.reading import read
    >>> [sign_over(read(text, ("x",)), 0.0, 3.0)[0] for text in ("2 + cos(x)", "-1 - x^2", "sin(x)")]
    [1, -1, 0]
    """
    signs, starts, stops = set[int](), np.array([low]), np.array([high])
    for _ in range(_CUTS):
        ends = np.linspace(starts, stops, _CELLS + 1)
        starts, stops = ends[:-1].ravel(), ends[1:].ravel()
        middles = 0.5 * (starts + stops)
        cells = between(np.append(middles, starts), np.append(middles, stops))
        with np.errstate(all="ignore"):
            value, slope = formula_jet(formula, "x", variable(cells, 1)).terms
        count, steps = len(starts), between(starts, stops) - exact(middles)
        # of the mean value, and of the values themselves
        known = [value[:count] + slope[count:] * steps, value[count:]]
        above = np.any([each.low > 0.0 for each in known], axis=0)
        below = np.any([each.high < 0.0 for each in known], axis=0)
        signs |= {1} if np.any(above) else set()
        signs |= {-1} if np.any(below) else set()
        unknown = ~(above | below)
        starts, stops = starts[unknown], stops[unknown]
        if not 0 < len(starts) <= _MOST:
            break
    return (0, float(starts[0])) if len(starts) else (signs.pop(), low)


@lru_cache(maxsize=256)
def without_value(formula: Formula, low: float, high: float) -> float | None:
    """A position between two others at which a formula of x has no finite value; None where it has one everywhere.

    >>> from optlaws.formulas.reading import read
    >>> without_value(read("1/(x - 0.5)", ("x",)), 0.0, 3.0), without_value(read("1/(x + 0.5)", ("x",)), 0.0, 3.0)
    (0.5, None)
    """
    x = np.linspace(low, high, _LOOKS if formula.names() else 2)
    with np.errstate(all="ignore"):
        values = np.broadcast_to(evaluate(formula, {"x": x}, NUMPY), x.shape)
    if not np.isfinite(values).all():
        return float(x[~np.isfinite(values)][0])
    for step in formula.steps:
        needed = _needed(step.formula)
        if needed is not None:
            part, signs = needed
            sign, place = sign_over(part, low, high)
            if sign not in signs:
                if 0 not in signs:
                    return place
                known = extremes_over(part, low, high)
                if known.least < -VALUE_ROUNDING * known.peak:
                    return known.least_at
    return None


def _needed(part: Formula) -> tuple[Formula, set[int]] | None:
    """A formula whose sign must be one of some everywhere, so that a part of a formula has a value."""
    if isinstance(part, Reciprocal):
        of = part.of.of if isinstance(part.of, Negative) else part.of
        is_root = isinstance(of, Call) and of.function == "sqrt"
        return (of.parts[0], {1}) if is_root else (of, {1, -1})
    if isinstance(part, Call) and part.function in {"log", "sqrt"}:
        return part.arguments[0], {1} if part.function == "log" else {0, 1}
    if isinstance(part, Call) and part.function == "tan":
        return Call("cos", part.arguments), {1, -1}
    if isinstance(part, Exponentiation):
        exponent = constant(part.exponent)
        whole = exponent is not None and exponent == int(exponent)
        above = exponent is not None and exponent > 0.0
        # whatever is raised to 0 is 1, 0 too
        everywhere = whole and (above or exponent == 0.0)
        return None if everywhere else (part.base, {1, -1} if whole else {0, 1} if above else {1})
    return None


def duration_of(minimise: str, duration: NumberOrQuantity | None) -> NumberOrQuantity:
    """The duration of a move, or one second where the least time is sought; errors name what is missing."""
    if (duration is None) != (minimise == "time"):
        raise InputError(
            "duration is missing, such as '0.25 s'" if duration is None else "leave out the duration: it is minimised"
        )
    return 1.0 if duration is None else duration


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
        damper, inertia = self.viscous * factor(stroke, duration, 1), self.inertia * factor(stroke, duration, 2)
        return self.stiffness * stroke, damper, inertia


class Train(NamedTuple):
    """Motor and gear before a mechanism, in SI units; unless given, the mechanism is driven at its input."""

    inertia: float = 0.0  #: this and friction at the motor's shaft
    viscous: float = 0.0
    coulomb: float = 0.0
    to_load: float = 1.0  #: the gear's efficiency while power flows to the load
    back: float = 1.0
    ratio: float = 1.0  #: turns of the motor with a turn of the mechanism's input
    regeneration: float = 0.0  #: the share of the braking energy that is fed back
    copper: float = 0.0  #: the copper heat by the squared torque, W/(N m)²; 0 without a motor constant

    @property
    def loses(self) -> bool:
        """Whether the gear loses power, so that the torque at the motor is the greater of two."""
        return (self.to_load, self.back) != (1.0, 1.0)


_AT_INPUT = Train()


@dataclass(frozen=True)
class StrokeTorque:
    """A drive over the stroke x = start + stroke a(k), k = t/duration: texts in a, b and c, with the units of numbers.

    The torque in the direction of the stroke is unit times `torque`: above 0 where the motor drives, whichever way x
    goes. That of the mechanism is I(a) c + I'(a) b²/2 + f b + T(a). Friction that does not depend on the speed is in T,
    for laws that never turn back.

    Attributes
    ----------
    inertia, load
        I(a) and T(a) of the mechanism.
    friction
        f, of its viscous friction.
    unit
        Of the torque, N m or N: at the motor, or without one at the mechanism's input.
    start, stroke, duration
        Of the mechanism's input, in rad or m, and s; the stroke is below 0 for motion to smaller x.
    holding
        The load without friction: what holds it at rest.
    train
        Motor and gear.
    """

    inertia: str
    friction: str
    load: str
    unit: float
    start: float
    stroke: float
    duration: float
    holding: str
    train: Train = _AT_INPUT

    @property
    def torque(self) -> str:
        """The torque as a formula of a, b and c, for `peak`, `rms` and `integral`.

        Where a gear loses power, its magnitude is no maximum of smooth formulas: `peak` takes it with side="high", and
        the last branch with side="low", which braking never passes.
        """
        return " + ".join([*self._motor, _greatest(self._through)])

    @property
    def branches(self) -> tuple[str, ...]:
        """The torques of which it is the greatest: where a gear loses power, of power to the load and of power back."""
        return tuple(" + ".join([*self._motor, load]) for load in self._through)

    @property
    def power(self) -> str:
        """The power, above 0 where the motor drives: torque times b."""
        return _greatest(self._powers)

    @property
    def energy(self) -> str:
        """A formula of which the integral is the energy of the move: braking counts by the share that is fed back."""
        return recovering(self._powers, self.train.regeneration)

    @property
    def heat(self) -> str:
        """A formula of which the integral is the copper heat and the braking energy that is not fed back.

        It is empty of a motor without a motor constant.
        """
        if not self.train.copper:
            return ""
        burnt = f"(max({', '.join(self._powers)}, 0) - {self.power})"
        return f"{self.copper!r}*({self.torque})^2 + {1.0 - self.train.regeneration!r}*{burnt}"

    @property
    def copper(self) -> float:
        """What the integral of the squared torque over k is of the copper heat, in the unit of the energy."""
        return self.unit**2 * self.duration * self.train.copper / self.energy_unit

    @property
    def energy_unit(self) -> float:
        """The unit of an integral of torque times b over k, J."""
        return self.unit * self.train.ratio * abs(self.stroke)

    @property
    def of_motor(self) -> tuple[float, float, float]:
        """The torques that motor and gear take themselves in the unit: by c, by b, and always."""
        train, speed = self.train, self.train.ratio * abs(self.stroke) / self.duration
        inertia, viscous = train.inertia * speed / self.duration, train.viscous * speed
        return inertia / self.unit, viscous / self.unit, train.coulomb / self.unit

    @property
    def _motor(self) -> list[str]:
        return [f"{size!r}{name}" for size, name in zip(self.of_motor, ("*c", "*b", ""), strict=True) if size]

    @property
    def _through(self) -> list[str]:
        """The torque of the mechanism at the motor, for each way that power flows through the gear."""
        torque = drive_torque(inertia=self.inertia, friction=self.friction, load=self.load)
        shares = (1.0 / self.train.to_load, self.train.back) if self.train.loses else (1.0,)
        return [f"{share!r}*({torque})" if share != 1.0 else torque for share in shares]

    @property
    def _powers(self) -> list[str]:
        return [f"({branch})*b" for branch in self.branches]


def _greatest(formulas: Sequence[str]) -> str:
    return formulas[0] if len(formulas) == 1 else f"max({', '.join(formulas)})"


def recovering(powers: Sequence[str], share: float) -> str:
    """The greatest of powers, and the share that is fed back of it where it is below 0.

    >>> recovering(["c*b"], 0.5)
    'max(c*b, 0.5*c*b)'
    """
    fed_back = [f"{share!r}*{power}" for power in powers] if share else ["0"]
    return _greatest([*powers, *(fed_back if share != 1.0 else [])])


def dimensionless(
    inertia: Formula, load: Formula, friction: tuple[float, float], stroke: tuple[float, float, float]
) -> StrokeTorque:
    """A mechanism with Coulomb and viscous friction over a stroke, known by its start, its length and its duration."""
    (coulomb, viscous), (start, way, time) = friction, stroke
    x = start + way * np.linspace(0.0, 1.0, _PLACES)
    accelerating, direction = abs(way) / time**2, float(np.sign(way))
    moved = viscous * abs(way) / time
    places = {"x": x, "k": np.linspace(0.0, 1.0, _PLACES)}
    greatest = (float(np.max(np.abs(evaluate(formula, places, NUMPY)))) for formula in (inertia, load))
    unit = max(next(greatest) * accelerating, next(greatest), moved, coulomb)
    if unit < TINY:
        raise InputError("the mechanism has neither inertia nor load nor friction on this stroke: nothing drives it")
    resisting = times(rescaled(load, "x", "a", (start, way)), direction / unit)
    return StrokeTorque(
        str(times(rescaled(inertia, "x", "a", (start, way)), accelerating / unit)),
        str(number(moved / unit)),
        str(added([number(coulomb / unit), resisting])),
        unit,
        start,
        way,
        time,
        str(resisting),
    )
