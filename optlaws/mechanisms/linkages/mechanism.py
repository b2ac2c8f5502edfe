"""Mechanisms of one degree of freedom: inertia and load as formulas of the input's position, and their reports."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, fields
from typing import TYPE_CHECKING, Any, TypeAlias, get_args

import numpy as np

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, ValueOf, declared, entries_of, entry
from optlaws.entries.value_types import Choice, Kept, Listed, Measured, Text, pairs
from optlaws.entries.value_types import Table as TableOf
from optlaws.entries.value_types import Together as Tuple
from optlaws.errors import InputError
from optlaws.files.reading import check_names, of_known_format
from optlaws.formulas.arithmetic import NUMPY, Together, evaluate
from optlaws.formulas.slopes import added
from optlaws.formulas.tree import Formula, Name, Table
from optlaws.kept import kept_property
from optlaws.mechanisms.linkages.mechanism_formulas import (
    DIMENSIONS,
    FORMULA,
    MOVED,
    InputAxis,
    LinearForce,
    OverPlace,
    StrokeTorque,
    dimensionless,
    extremes_over,
    formula_of,
    line_of,
    rescaled,
    sign_over,
    slope_of,
    without_value,
)
from optlaws.motion.quantities import DEGREES, MILLI, TURN, check_scale, either, in_small_units, quantity
from optlaws.numbers import Array, NumberOrQuantity, derivative, finite, positive, real_times
from optlaws.shown.report import Panel, Series
from optlaws.tolerances import CLOSURE, VALUE_ROUNDING

if TYPE_CHECKING:
    from optlaws.mechanisms.linkages.move_limit import MoveLimit
    from optlaws.synthesis.limits.plane_of_problem import DriveObjective

FORMAT = 1
_POSITIONS = 721
#: by what the input is: its unit, how many of them make one of SI, and those of the inertia, of its slope, of the load
INPUTS = {
    "angle": ("deg", DEGREES, ("kg m²", "kg m²/rad", "N m")),
    "length": ("mm", MILLI, ("kg", "kg/m", "N")),
}

Driven: TypeAlias = Kept[
    "tuple[tuple[str, Formula], ...]", "tuple[tuple[str, Formula], ...] | Mapping[str, Formula | str]"
]


@declared
class LinkGeometry(Declared, title="a linkage"):
    """Geometry of a mechanism's links beyond inertia and load."""

    writes_defaults = True

    driven: Driven = entry(
        TableOf(FORMULA, keep=pairs), "Positions of driven links over x, by their names.", default=()
    )
    chains: tuple[tuple[tuple[Formula, Formula], ...], ...] = entry(
        Listed(Listed(Tuple(FORMULA, FORMULA))),
        "Of points in m, each of two coordinates over x, that a picture joins by lines; a chain of one point is a "
        "pivot.",
        default=(),
    )


NO_LINKAGE = LinkGeometry()


@declared
class Mechanism(Declared, title="a mechanism"):
    """A mechanism of one degree of freedom: inertia J(x) and load T(x) at its input, friction, and where it is defined.

    The torque (or force) that moves the input is J(x) x'' + J'(x) x'²/2 + viscous x' + coulomb sign(x') + T(x): the
    inertia and the load are all masses and forces of the mechanism, reduced to the input. `slider_crank`, `four_bar`,
    `toggle`, `rack`, `belt` and `screw` make one from lengths and masses, `mechanism_of_motion` from a function.

    Raises
    ------
    InputError
        If a quantity is of another dimension, the inertia is below 0 somewhere or has no derivative, a formula has no
        finite value somewhere, or a table ends within the range; the error names the place and the numbers. Both are
        proven over the whole range; where it has no ends and a formula no bounds, over a stroke when it is moved.

    Examples
    --------
    >>> table = Mechanism("0.8 kg m^2", load="2*sin(x)", coulomb="0.5 N m", over=("0 deg", "90 deg"))
    >>> round(float(table.torque(0.5, 1.0, 10.0)), 6)
    9.458851
    >>> print(table.dimensionless("0 deg", "45 deg", "0.25 s").torque)
    c + 0.04973591971621729 + 0.1989436788648692*sin(0.7853981633974483*a)
    """

    writes_defaults = True

    inertia_formula: Formula = entry(
        OverPlace("x"),
        "Of all masses at the input, over its position x in rad or m; a formula such as "
        '"0.02 + 0.01*sin(x)^2" is in SI units, and a table is interpolated by a smooth curve.',
        name="inertia",
        example="0.8 kg m^2",
    )
    load_formula: Formula = entry(
        OverPlace("x"),
        'What resists the motion to greater x; tables are straight lines, and a curve is "spline(x, 0:1, ...)".',
        default=0.0,
        name="load",
        example="2*sin(x)",
    )
    _: KW_ONLY
    coulomb: float = entry(
        Measured("torque", "force", bare=True, least=0.0),
        "Friction that does not depend on the speed, at the input.",
        default=0.0,
        example="0.5 N m",
    )
    viscous: float = entry(
        Measured("rotary viscous friction", "viscous friction", bare=True, least=0.0),
        "Friction in proportion to the speed, at the input.",
        default=0.0,
        example="0.02 N m s/rad",
    )
    over: tuple[float, float] = entry(
        Listed(Measured("angle", "length", bare=True), least=2, most=2),
        "The range of x where it is defined; that of its tables unless given, and without tables no bound.",
        default=None,
        example=["0 deg", "180 deg"],
    )
    axis: InputAxis = entry(
        Choice(*get_args(InputAxis)), "Whether the input turns or slides; as `over` says unless given.", default=None
    )
    name: str = entry(Text(), "What pictures and texts call it.", default="mechanism", shown=False)
    linkage: LinkGeometry = entry(
        ValueOf(LinkGeometry),
        "Positions of its driven links, and what a picture draws.",
        default=NO_LINKAGE,
        shown=False,
    )

    def __init__(
        self,
        inertia: NumberOrQuantity | Formula | Mapping[Any, Any] | Sequence[Any] = 0.0,
        load: NumberOrQuantity | Formula | Mapping[Any, Any] | Sequence[Any] = 0.0,
        *,
        coulomb: NumberOrQuantity = 0.0,
        viscous: NumberOrQuantity = 0.0,
        over: tuple[NumberOrQuantity, NumberOrQuantity] | None = None,
        axis: InputAxis | None = None,
        name: str = "mechanism",
        linkage: LinkGeometry = NO_LINKAGE,
    ) -> None:
        given = (inertia, load, coulomb, viscous, over, axis, name, linkage)
        for each, value in zip(entries_of(Mechanism).values(), given, strict=True):
            object.__setattr__(self, each.field, each.read(value))
        self._check()

    def _check(self) -> None:
        kind, ends = _axis_and_ends(self.over, self.axis)
        known = DIMENSIONS[kind]
        inertia = formula_of(self.inertia_formula, (kind, known["inertia"]), "inertia")
        load = formula_of(self.load_formula, (kind, known["load"]), "load", interpolation="lines")
        friction = {"coulomb": known["load"], "viscous": known["viscous"]}
        numbers = {name: float(quantity(getattr(self, name), of, name, bare=True)) for name, of in friction.items()}
        over = _range({"inertia": inertia, "load": load}, ends, kind)
        vars(self).update(inertia_formula=inertia, load_formula=load, over=over, axis=kind, **numbers)
        if any(isinstance(part, Table) and part.kinked for part in inertia.different):
            raise InputError(
                "the inertia has corners, where the torque would jump: a table is joined by a smooth curve, and in a "
                "formula monotone(x, ...) is one"
            )
        slope_of(inertia, 1)
        self._check_over(*(over if self.has_end else (-np.pi, np.pi)))

    def _check_over(self, low: float, high: float) -> None:
        """Refuse formulas without a finite value between two positions, and an inertia that is below 0 there."""
        known_by_place = {"inertia": self.inertia_formula} | ({} if self.varies else {"load": self.load_formula})
        for what, formula in known_by_place.items():
            if (pole := without_value(formula, low, high)) is not None:
                place = self._shown(pole)
                raise InputError(
                    f"the {what} has no finite value at {place}: take a range in over= without that position"
                )
        curved = line_of(self.inertia_formula) is None
        is_positive = curved and sign_over(self.inertia_formula, low, high)[0] > 0
        known = None if is_positive else extremes_over(self.inertia_formula, low, high)
        if known is not None and known.least < -VALUE_ROUNDING * known.peak:
            raise InputError(
                f"the inertia must be at least 0, and it is {known.least:.6g} at {self._shown(known.least_at)}: check "
                "its signs"
            )

    def _shown(self, x: float) -> str:
        return in_small_units(float(x), self.axis)

    @kept_property
    def _of_torque(self) -> Together:
        return Together((self.inertia_formula, slope_of(self.inertia_formula, 1), self.load_formula))

    def _values(self, formula: Formula, x: Any) -> Array:
        return np.broadcast_to(np.asarray(evaluate(formula, {"x": x, "t": 0.0}, NUMPY), dtype=np.float64), np.shape(x))

    @kept_property
    def linear(self) -> LinearForce | None:
        """Its force where inertia is constant and the load a straight line over x; None where they are not."""
        inertia, load = line_of(self.inertia_formula), line_of(self.load_formula)
        if inertia is None or load is None or inertia[0] != 0.0:
            return None
        return LinearForce(inertia[1], self.viscous, *load, self.coulomb)

    @property
    def varies(self) -> bool:
        """Whether the load depends on the time t, as that of a process may."""
        return "t" in self.load_formula.names()

    @property
    def has_end(self) -> bool:
        """Whether its range has ends."""
        return bool(np.isfinite(self.over[1] - self.over[0]))

    def position(self, x: Any) -> Any:
        """A position of the input in rad or m, from a number or a quantity, which must be in the range.

        Raises
        ------
        InputError
            If it is not; the error names the range.
        """
        at = real_times(quantity(x, self.axis, "position", bare=True))
        low, high = self.over
        slack = CLOSURE * (high - low) if self.has_end else 0.0
        if np.any((at < low - slack) | (at > high + slack)):
            beyond = at[(at < low - slack) | (at > high + slack)].flat[0] if np.ndim(at) else at
            reached = f"{self._shown(low)} to {self._shown(high)}"
            raise InputError(f"the {self.name} is defined from {reached}, got {self._shown(float(beyond))}")
        return at

    def inertia(self, x: Any, nu: int = 0) -> Any:
        """The inertia at the input, kg m² or kg, or a derivative of it by x.

        Parameters
        ----------
        x
            Positions of the input: a number in rad or m, a quantity, or an array.
        nu
            The order of the derivative.
        """
        return self._given(self.inertia_formula, x, nu)

    def greatest_inertia(self, low: float, high: float) -> float:
        """The greatest inertia between two positions in rad or m, enclosed over the whole range between them.

        Examples
        --------
        >>> round(Mechanism("0.02 + 0.01*sin(x)^2").greatest_inertia(0.0, 3.0), 12)
        0.03
        """
        return extremes_over(self.inertia_formula, low, high).most

    def load(self, x: Any, nu: int = 0) -> Any:
        """The load at the input, N m or N, above 0 where it resists motion to greater x, or a derivative of it by x."""
        return self._given(self.load_formula, x, nu)

    def driven_position(self, name: str, x: Any, nu: int = 0) -> Any:
        """The position of a driven link, m or rad, or a derivative of it by x.

        Raises
        ------
        InputError
            If no driven link has this name.
        """
        driven = dict(self.linkage.driven)
        check_names([name], driven, "driven link")
        return self._given(driven[name], x, nu)

    def _given(self, formula: Formula, x: Any, nu: int) -> Any:
        values = self._values(slope_of(formula, derivative(nu)), self.position(x))
        return values if np.ndim(values) else float(values)

    def torque(self, position: Any, velocity: Any, acceleration: Any, direction: Any = None, *, time: Any = 0.0) -> Any:
        """The torque, N m, or force, N, that moves the input: J x'' + J' x'²/2 + friction + load, all in SI units.

        Parameters
        ----------
        position, velocity, acceleration
            Of the input: numbers in rad or m and their like by the second, quantities, or arrays.
        direction
            In which friction resists: 1, -1, or 0 at rest; the sign of the velocity unless given.
        time
            In s, of a load that depends on it.
        """
        known = DIMENSIONS[self.axis]
        x = self.position(position)
        v = real_times(quantity(velocity, known["velocity"], "velocity", bare=True))
        w = real_times(quantity(acceleration, known["acceleration"], "acceleration", bare=True))
        inertia, slope_of_inertia, load = self._of_torque.values({"x": x, "t": time}, NUMPY)
        inertial, turning = inertia * w, slope_of_inertia * v * v / 2.0
        way = np.sign(v) if direction is None else direction
        values = np.asarray(inertial + turning + self.viscous * v + self.coulomb * way + load)
        return values if np.ndim(values) else float(values)

    def dimensionless(
        self,
        start: NumberOrQuantity,
        stroke: NumberOrQuantity,
        duration: NumberOrQuantity,
        *,
        process: Formula | None = None,
        begins: float = 0.0,
    ) -> StrokeTorque:
        """The mechanism over a stroke x = start + stroke a in a duration: texts in a, and the units of their numbers.

        Parameters
        ----------
        start
            The position of the input at which the stroke begins: a number in rad or m, or a quantity.
        stroke
            How far the input moves; below 0 for motion to smaller x.
        duration
            In seconds, or a quantity.
        process
            A formula of x and k that is added to the load.
        begins
            When the stroke begins, in s, of a load that depends on the time.

        Raises
        ------
        InputError
            If the stroke leaves the range of the mechanism, or is 0; the error names both.

        Examples
        --------
        >>> from optlaws import slider_crank
        >>> press = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
        >>> moved = press.dimensionless("0 deg", "180 deg", "0.3 s")
        >>> from optlaws import rms, smoothstep
        >>> round(rms(moved.torque).value(smoothstep(3)) * moved.unit, 6)
        7.979021
        """
        first = finite(quantity(start, self.axis, "start", bare=True), "start")
        way = finite(quantity(stroke, self.axis, "stroke", bare=True), "stroke")
        time = positive(quantity(duration, "time", "duration", bare=True), "duration")
        check_scale(time, "s", "duration", duration)
        if way == 0.0:
            raise InputError(
                "stroke must not be 0: give how far the input moves, such as "
                f"'{'45 deg' if self.axis == 'angle' else '35 mm'}'; at rest it takes its load"
            )
        check_scale(way, "rad" if self.axis == "angle" else "m", "stroke", stroke)
        self.position(np.array([first, first + way]))
        if not (self.has_end or self.varies or self.linear):
            self._check_over(*sorted((first, first + way)))
        load = rescaled(self.load_formula, "t", "k", (begins, time)) if self.varies else self.load_formula
        load = load if process is None else added([load, process])
        return dimensionless(self.inertia_formula, load, (self.coulomb, self.viscous), (first, way, time))

    def limit(
        self,
        minimise: DriveObjective,
        start: NumberOrQuantity,
        stroke: NumberOrQuantity,
        duration: NumberOrQuantity | None = None,
        *,
        limits: Mapping[str, Any] | None = None,
        recovered: float = 0.0,
        heat: float = 0.0,
    ) -> MoveLimit:
        """A proven lower bound at the input for motions from rest to rest that never turn back, in SI units.

        Parameters
        ----------
        minimise
            "peak torque", "rms torque", "energy" (without what is recovered) or "time"; a force where the input slides.
        start, stroke, duration
            As `dimensionless` takes them; the least time has no duration.
        limits
            Greatest "velocity", "acceleration" and "torque" (or "force") of the input, each a quantity, or a list of
            parts of the way such as [("10 deg", "20 deg", "2 rad/s")].
        recovered
            Which share of the braking energy is used again, 0 to 1.
        heat
            Copper heat, in W a squared N m (or N), that is minimised together with the energy.

        Raises
        ------
        InputError
            If the stroke leaves the range, or nothing keeps the acceleration finite.
        InfeasibleProblem
            If no motion keeps the limits; the error states what is reachable, and its `proof` proves it.

        Examples
        --------
        >>> table = Mechanism("0.8 kg m^2")
        >>> print(table.limit("time", "0 deg", "45 deg", limits={"torque": "50 N m", "velocity": "6 rad/s"}))
        time at least 0.2269 s
        """
        from optlaws.mechanisms.linkages.move_limit import limit_of

        return limit_of(self, minimise, (start, stroke), duration, limits, recovered=recovered, heat=heat)

    def with_friction(self, *, coulomb: NumberOrQuantity = 0.0, viscous: NumberOrQuantity = 0.0) -> Mechanism:
        """The mechanism with this friction at its input in place of its own."""
        return self._changed(coulomb=coulomb, viscous=viscous)

    def with_inertia(self, inertia: NumberOrQuantity) -> Mechanism:
        """The mechanism with a further constant inertia at its input, as of a coupling."""
        more = formula_of(inertia, (self.axis, DIMENSIONS[self.axis]["inertia"]), "inertia")
        return self._changed(inertia=added([more, self.inertia_formula]))

    def _changed(self, **changed: Any) -> Mechanism:
        known = {each.name: getattr(self, each.field) for each in entries_of(Mechanism).values()}
        return Mechanism(**{**known, "over": self.over if self.has_end else None, **changed})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Mechanism) and self.to_dict() == other.to_dict()

    def __hash__(self) -> int:
        return hash((self.name, self.over, str(self.inertia_formula), str(self.load_formula)))

    def __repr__(self) -> str:
        ends = f"{self._shown(self.over[0])} to {self._shown(self.over[1])}" if self.has_end else "everywhere"
        return f"Mechanism({self.name!r}, {ends})"

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:
        """Draw the mechanism in several positions beside its inertia, load and the slope of its inertia over x.

        `ax` is four pairs of axes, or one for the mechanism alone; a new figure unless given. `style` is what
        `Axes.plot` takes, for the curves.
        """
        from optlaws.plots.machine import draw_mechanism

        return draw_mechanism(self, ax, **style)

    def to_dict(self) -> dict[str, Any]:
        """The formulas and numbers of the mechanism as plain data, in SI units.

        Examples
        --------
        >>> Mechanism("0.8 kg m^2", over=("0 deg", "90 deg")).to_dict()["inertia"]
        '0.8'
        """
        return {"format": FORMAT, **super().to_dict(), **({} if self.has_end else {"over": None})}

    @classmethod
    def _from_earlier(cls, data: dict[str, Any]) -> dict[str, Any]:
        return of_known_format(data, "a mechanism")


MOVED["mechanism"] = Mechanism


def loaded(mechanism: Mechanism, load: Formula) -> Mechanism:
    """The mechanism with a further load over x and the time t, of which tables may end within its range."""
    other = object.__new__(Mechanism)
    known = {each.name: getattr(mechanism, each.name) for each in fields(mechanism)}
    vars(other).update({**known, "load_formula": added([mechanism.load_formula, load])})
    return other


@dataclass(frozen=True)
class MechanismReport:
    """The report of a mechanism; where its input has no ends, over what is `used` of it, else a turn or 0.1 m."""

    mechanism: Mechanism
    used: tuple[float, float] | None = None

    @property
    def positions(self) -> Array:
        """Positions of the input at which it is drawn, rad or m."""
        mechanism = self.mechanism
        usual = self.used or (0.0, TURN if mechanism.axis == "angle" else 0.1)
        return np.linspace(*(mechanism.over if mechanism.has_end else usual), _POSITIONS)

    @property
    def panels(self) -> tuple[Panel, ...]:
        """The inertia J, its slope J' and the load T over the input, which is in degrees or millimetres."""
        x, (of_input, factor, units) = self.positions, INPUTS[self.mechanism.axis]
        values = self.mechanism.inertia(x), self.mechanism.inertia(x, 1), self.mechanism.load(x)
        return tuple(
            Panel(name, unit, (Series(factor * x, np.asarray(curve)),), (), (), ends, f"input, {of_input}", 1.0)
            for name, unit, curve in zip(("J", "J'", "T"), units, values, strict=True)
            for ends in [(float(np.min(curve)), float(np.max(curve)))]
        )

    def chains(self, x: Array) -> list[Array]:
        """The joints of each chain of links at positions of the input, in mm, of shape (joints, 2, positions)."""
        return [
            MILLI * np.array([[evaluate(part, {"x": x}, NUMPY) + 0.0 * x for part in point] for point in chain])
            for chain in self.mechanism.linkage.chains
        ]

    @property
    def moving(self) -> list[list[bool]]:
        """Which joints of each chain move."""
        chains = self.mechanism.linkage.chains
        return [[bool(point[0].names() | point[1].names()) for point in chain] for chain in chains]


def _range(formulas: Mapping[str, Formula], ends: tuple[float, float] | None, axis: InputAxis) -> tuple[float, float]:
    """The range of x, which all tables over x must cover."""
    tables = [
        (what, part)
        for what, formula in formulas.items()
        for part in formula.different
        if isinstance(part, Table) and part.of == Name("x")
    ]
    if ends is None:
        low = max((table.places[0] for _, table in tables), default=-np.inf)
        return low, min((table.places[-1] for _, table in tables), default=np.inf)
    slack = CLOSURE * (ends[1] - ends[0])
    for what, table in tables:
        if table.places[0] > ends[0] + slack or table.places[-1] < ends[1] - slack:
            shown = [in_small_units(x, axis) for x in (table.places[0], table.places[-1], *ends)]
            raise InputError(
                f"the table of the {what} goes from {shown[0]} to {shown[1]}, and the mechanism from {shown[2]} to "
                f"{shown[3]}: give a table over the whole range, or a shorter range in over="
            )
    return ends


def _axis_and_ends(over: Any, axis: InputAxis | None) -> tuple[InputAxis, tuple[float, float] | None]:
    """The kind of the input's position, and the ends of its range if there are any."""
    if over is None:
        return axis or "angle", None
    known = (axis,) if axis else tuple(DIMENSIONS)
    read_ends: list[tuple[Any, float]] = [
        either(each, known, "over") if isinstance(each, str) else (None, float(each)) for each in over
    ]
    kinds = {kind for kind, _ in read_ends if kind is not None} | ({axis} if axis else set())
    if len(kinds) > 1:
        raise InputError(f"over: an input that turns has angles, one that slides lengths, got {shortened(over)}")
    low, high = (value for _, value in read_ends)
    if not low < high:
        raise InputError(f"over must be two positions that ascend, got {shortened(over)}")
    return (kinds.pop() if kinds else "angle"), (low, high)
