"""Random problems that use every public option; most are drawn around a law that keeps all their conditions.

`Drawn.witness` is that law, so such a problem has an answer no worse than its `worth`. A constant, basis or entry of
Problem that nothing here draws fails tests/synthesis/test_random_options.py.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from math import inf, isfinite
from typing import Any

import numpy as np

from optlaws import (
    FUNCTIONALS,
    Basis,
    Bernstein,
    BoundaryConditions,
    BSplines,
    Chebyshev,
    Expression,
    Functional,
    Machine,
    MotionLaw,
    Pieces,
    Powers,
    Problem,
    Range,
    Window,
    at_least,
    at_most,
    between,
    cam_constant,
    integral,
    law_from_z,
    maximum,
    peak,
    residual_vibration,
    rms,
    value,
    via,
)
from optlaws.synthesis import PiecewiseBasis, PolynomialBasis
from tests.internals.synthesis import OfFormula
from tests.synthesis.judge import Judged, broken

Numbers = np.random.Generator
QUANTITIES = ("a", "b", "c", "j")
OWN_ENTRY = ("B", "C", "D", "J")


@dataclass(frozen=True)
class Drawn:
    """A problem, and a law that keeps its conditions where one is known."""

    problem: Problem
    witness: MotionLaw | None


@dataclass(frozen=True)
class Frame:
    """What a law is sought in."""

    order: int
    boundary: BoundaryConditions | None
    symmetric: bool
    basis: Basis
    #: whether constants of formulas and machines are drawn too, and weights and windows, in units from 1e-12 to 1e9
    units: bool = False

    @property
    def conditions(self) -> BoundaryConditions:
        return self.boundary or BoundaryConditions.rest(self.order)


# --- bases ---


def _breaks(numbers: Numbers, *, symmetric: bool, middle: bool = False) -> int | list[float]:
    """A number of pieces, or breaks that are symmetric where they must be."""
    if numbers.random() < 0.5:
        return 2 * int(numbers.integers(1, 6))
    inner = sorted(round(float(k), 3) for k in numbers.uniform(0.06, 0.44, int(numbers.integers(1, 4))))
    left = [0.0, *dict.fromkeys(inner)]
    right = [round(1.0 - k, 3) for k in reversed(left)]
    if symmetric or numbers.random() < 0.5:
        return [*left, *([0.5] if middle or numbers.random() < 0.5 else []), *right]
    return [*left, 0.5 + round(float(numbers.uniform(-0.04, 0.04)), 3), 1.0]


def _smoothness(numbers: Numbers, degree: int) -> int:
    return int(numbers.integers(min(2, degree - 1), degree))


def _powers(numbers: Numbers, _: bool, __: int) -> Basis:  # noqa: FBT001
    return Powers(int(numbers.integers(1, 12)))


def _chebyshev(numbers: Numbers, _: bool, __: int) -> Basis:  # noqa: FBT001
    return Chebyshev(int(numbers.integers(1, 18)))


def _bernstein(numbers: Numbers, _: bool, __: int) -> Basis:  # noqa: FBT001
    return Bernstein(int(numbers.integers(1, 16)))


def _bsplines(numbers: Numbers, symmetric: bool, _: int) -> Basis:  # noqa: FBT001
    degree = int(numbers.integers(3, 6))
    return BSplines(_breaks(numbers, symmetric=symmetric), degree, _smoothness(numbers, degree))


def _pieces(numbers: Numbers, symmetric: bool, order: int) -> Basis:  # noqa: FBT001
    degree = max(order + 1, int(numbers.integers(4, 8)))
    return Pieces(_breaks(numbers, symmetric=symmetric, middle=True), degree, _smoothness(numbers, min(degree, 6)))


def _pieces_around(numbers: Numbers, _: bool, order: int) -> Basis:  # noqa: FBT001
    switch = round(float(numbers.uniform(0.15, 0.35)), 3)
    width = round(float(numbers.uniform(0.02, 0.1)), 3)
    return Pieces.around((0.0, switch, 0.5, 1.0 - switch, 1.0), width, degree=max(5, order + 2), continuity=3)


#: by the name of the basis, all ways in which one can be asked
BASES: Mapping[str, tuple[Callable[[Numbers, bool, int], Basis], ...]] = {
    "powers": (_powers,),
    "chebyshev": (_chebyshev,),
    "bernstein": (_bernstein,),
    "bsplines": (_bsplines,),
    "pieces": (_pieces, _pieces_around),
}


# --- ends ---


def _end(numbers: Numbers, place: float, order: int, *, only_velocity: bool) -> tuple[float, ...]:
    spread = np.array([0.8, 3.0, 10.0, 30.0, 100.0])[: order - 1]
    higher = [round(float(value), 3) for value in numbers.uniform(-1.0, 1.0, order - 1) * spread]
    return (place, *(value if i == 0 or not only_velocity else 0.0 for i, value in enumerate(higher)))


def _boundary(numbers: Numbers, order: int) -> BoundaryConditions:
    """Velocities of both signs, higher derivatives, another start or stroke, strokes of 0 and below."""
    stroke = float(numbers.choice([1.0, 1.0, 0.0, 0.0, -1.0, 0.4]))
    start = float(numbers.choice([0.0, 0.0, 0.25]))
    plain = bool(numbers.random() < 0.6)
    ends = (_end(numbers, place, order, only_velocity=plain) for place in (start, start + stroke))
    return BoundaryConditions(*ends)


def _frame(numbers: Numbers, *, units: bool) -> Frame:
    order = int(numbers.choice(6, p=[0.06, 0.2, 0.24, 0.24, 0.18, 0.08])) + 1
    boundary = _boundary(numbers, order) if numbers.random() < 0.25 else None
    symmetric = boundary in {None, BoundaryConditions.rest(order)} and bool(numbers.random() < 0.5)
    name = str(numbers.choice(list(BASES), p=[0.12, 0.4, 0.16, 0.16, 0.16]))
    make = BASES[name][int(numbers.integers(len(BASES[name])))]
    return Frame(order, boundary, symmetric, make(numbers, symmetric, order), units)


# --- a law that keeps what is asked ---


def _coefficients(numbers: Numbers, count: int, size: float) -> list[float]:
    return list(map(float, size * numbers.uniform(-1.0, 1.0, count) / (1.0 + np.arange(count))))


def _law(numbers: Numbers, frame: Frame) -> MotionLaw | None:
    """A law of the frame; None for pieces, whose laws have no Z. Some are symmetric though none need be."""
    if not isinstance(frame.basis, PolynomialBasis | PiecewiseBasis):
        return None
    odd = frame.symmetric or bool(numbers.random() < 0.4)
    # k^l (1-k)^l is at most 4^-l
    size = 4.0**frame.order * float(numbers.choice([0.02, 0.1, 0.3]))
    if isinstance(frame.basis, PolynomialBasis):
        series = np.array(_coefficients(numbers, frame.basis.size, size))
        if odd:
            series[::2] = 0.0
        return law_from_z(frame.conditions, frame.basis.coefficients(series), frame.basis)
    z = np.array(_coefficients(numbers, frame.basis.size, size))
    return law_from_z(frame.conditions, ((z - z[::-1]) / 2.0 if odd else z).tolist(), frame.basis)


# --- constants ---


def _named(name: str) -> Callable[[Numbers], Functional]:
    return lambda _: FUNCTIONALS[name]


def _cam(name: str) -> Callable[[Numbers], Functional]:
    def made(numbers: Numbers) -> Functional:
        damping = round(float(numbers.choice([0.0, 0.05, 0.2, 0.6])), 3)
        return cam_constant(name, frequency=round(float(numbers.uniform(5.0, 40.0)), 2), damping=damping)

    return made


def _residual(numbers: Numbers) -> Functional:
    low = round(float(numbers.uniform(6.0, 40.0)), 2)
    nu: Any = low if numbers.random() < 0.4 else (low, round(low * float(numbers.uniform(1.05, 1.4)), 2))
    damping = float(numbers.choice([0.0, 0.03, 0.1]))
    design = round(low * 1.1, 2) if numbers.random() < 0.3 else None
    design_damping = 0.02 if design is not None and numbers.random() < 0.5 else None
    return residual_vibration(frequency=nu, damping=damping, design=design, design_damping=design_damping)


#: by the name that text calls them by, all constants there are
CONSTANTS: Mapping[str, Callable[[Numbers], Functional]] = {
    **{name: _named(name) for name in ("B", "C", "C_plus", "C_minus", "D", "J", "snap", "rms_c", "rms_j", "rms_snap")},
    **{f"{name}_cam": _cam(name) for name in ("B", "C", "C_plus", "C_minus", "D", "J")},
    "residual": _residual,
}


def _unit(numbers: Numbers) -> float:
    return float(f"{10.0 ** float(numbers.uniform(-12.0, 9.0)):.3g}")


def _mixed(numbers: Numbers, parts: tuple[str, ...]) -> str:
    """A formula in a unit: `u` in the parts stands for it, times a number near 1."""
    unit, part = _unit(numbers), str(numbers.choice(parts))
    while "u" in part:
        part = part.replace("u", repr(float(f"{unit * float(numbers.uniform(0.3, 3.0)):.3g}")), 1)
    return part


def _window_of_formula(numbers: Numbers) -> str:
    return _mixed(numbers, ("u*c + u*b", "u*(1 + k)*c - u*b", "u*b - u*a"))


def _machine(numbers: Numbers) -> Machine:
    output = str(numbers.choice(["deflection", "acceleration", "position"]))
    mode = (round(float(numbers.uniform(2.0, 60.0)), 2), float(numbers.choice([0.01, 0.1])))
    return Machine.from_modes([mode], duration=1.0, stroke=_unit(numbers), outputs=[output])


#: constants of formulas and of machines, in units, and the order and continuity that they need
IN_UNITS: Mapping[str, tuple[Callable[[Numbers], Functional], int, int]] = {
    "peak": (lambda n: peak(_mixed(n, ("u*c + u*b", "u*(1 + k)*c", "u*(c^2 + 3*b^2)", "u*abs(c) + u*abs(b)"))), 0, 0),
    "one side": (lambda n: peak(_mixed(n, ("max(u*c, u*b)", "u*c - u*b", "u*c^2 + u*c")), side="high"), 2, 0),
    "power": (lambda n: peak(_mixed(n, ("u*d", "u*d + u*c"))), 2, 1),
    "rms": (lambda n: rms(_mixed(n, ("u*c + u*b", "norm(u*c, u*b)", "u*(1 + k)*c"))), 0, 0),
    "integral": (lambda n: integral(_mixed(n, ("u*c^2", "u*b^2 + u*c^2", "u*(1 + k)*b^2"))), 0, 0),
    "value": (lambda n: value(_mixed(n, ("u*c^2 + u*b", "u*abs(c)")), at=0.3), 0, 0),
    "output peak": (lambda n: _machine(n).peak(), 3, 2),
    "output rms": (lambda n: _machine(n).rms(), 3, 2),
    "mode residual": (lambda n: _machine(n).residual(spread=0.05 * float(n.integers(2))), 3, 2),
}


#: the order of the rests at both ends and the continuity at breaks that a constant needs; none where it is not here
NEEDS: Mapping[str, tuple[int, int]] = {
    "J": (0, 2),
    "rms_j": (0, 2),
    "snap": (0, 3),
    "rms_snap": (0, 3),
    "residual": (4, 3),
    "J_cam": (5, 4),
    **{f"{name}_cam": (4, 3) for name in ("B", "C", "C_plus", "C_minus", "D")},
}


def _constant(numbers: Numbers, frame: Frame) -> Functional:
    """One that laws of the frame have."""
    resting = frame.order if frame.boundary is None else 0
    smooth = getattr(frame.basis, "continuity", inf)
    names = []
    if frame.units and numbers.random() < 0.6:
        own = [make for make, order, continuity in IN_UNITS.values() if order <= resting and continuity <= smooth]
        return own[int(numbers.integers(len(own)))](numbers)
    for name in CONSTANTS:
        order, continuity = NEEDS.get(name, (0, 0))
        if order <= resting and continuity <= smooth:
            names.append(name)
    weights = np.array([0.5 if name in {"B", "D", "D_cam"} else 1.0 for name in names])
    return CONSTANTS[str(numbers.choice(names, p=weights / weights.sum()))](numbers)


# --- what is asked of them ---


def _exactly(value: float, _: float) -> float:
    return value


def _between(value: float, room: float) -> Range:
    return between(value * (1.0 - room / 2.0), value * (1.0 + room))


#: what can be asked of a constant that a law has at a value, with some room
ASKED: Mapping[str, Callable[[float, float], float | Range]] = {
    "number": _exactly,
    "at_most": lambda value, room: at_most(value * (1.0 + room)),
    "at_least": lambda value, room: at_least(value * (1.0 - room)),
    "between": _between,
}


def _asked(numbers: Numbers, value: float, *, p: tuple[float, ...]) -> float | Range:
    room = float(numbers.choice([0.0, 0.02, 0.15, 0.5], p=[0.05, 0.25, 0.4, 0.3]))
    return ASKED[str(numbers.choice(list(ASKED), p=p))](value, room)


def _part(numbers: Numbers, frame: Frame, judged: "Guess") -> Expression:
    constant = _constant(numbers, frame)
    value = judged.value(constant)
    size = value if isfinite(value) and value > 1e-3 * constant.scale else 1.0
    return round(float(numbers.uniform(0.1, 1.0)), 2) * constant / float(f"{size:.3g}")


def _objective(numbers: Numbers, frame: Frame, judged: "Guess") -> Any:
    part = partial(_part, numbers, frame, judged)
    kind = str(numbers.choice(["constant", "sum", "max", "sum of max", "max of max"], p=[0.5, 0.2, 0.15, 0.1, 0.05]))
    if kind == "constant":
        found: Any = _constant(numbers, frame)
    elif kind == "sum":
        found = part() + part()
    elif kind == "max":
        found = maximum(part(), part())
    elif kind == "sum of max":
        found = part() + 0.5 * maximum(part(), part() + part())
    else:
        found = maximum(part(), maximum(part(), part()))
    if frame.units and numbers.random() < 0.2:
        found = _unit(numbers) * found
    return repr(found) if numbers.random() < 0.5 else found


@dataclass(frozen=True)
class Guess:
    """Constants of the law that a problem is drawn around, or of one like those that it has."""

    law: MotionLaw

    @cached_property
    def judged(self) -> Judged:
        return Judged(self.law)

    def value(self, constant: Functional) -> float:
        return float(self.judged.value(constant))


def _bounds(numbers: Numbers, frame: Frame, judged: Guess) -> dict[str, Any]:
    """Entries of Problem: constants of their own, or among the bounds by name or as themselves."""
    entries: dict[str, Any] = {}
    bounds: dict[Any, Any] = {}
    names = set()
    for _ in range(int(numbers.choice(4, p=[0.5, 0.3, 0.15, 0.05]))):
        constant = _constant(numbers, frame)
        value = judged.value(constant)
        if constant.name in names or constant.name == "B" or not 1e-6 * constant.scale < value < inf:
            continue
        names.add(constant.name)
        # a cam of a damped follower is not symmetric though its law is: its constants have no lower bounds then, nor
        # have formulas, of which the halves may differ and which may have branches
        uneven = frame.symmetric and "_cam(" in constant.name and "damping" in constant.name
        uneven |= isinstance(constant, OfFormula)
        asked = _asked(numbers, value, p=(0.0, 1.0, 0.0, 0.0) if uneven else (0.06, 0.74, 0.1, 0.1))
        if constant.name in OWN_ENTRY and numbers.random() < 0.6:
            entries[constant.name] = asked
        else:
            bounds[constant if numbers.random() < 0.5 else constant.name] = asked
    return entries | ({"bounds": bounds} if bounds else {})


def _velocity(numbers: Numbers, frame: Frame, law: MotionLaw, judged: Guess) -> dict[str, Any]:
    """What is asked of B, and where its peak is to be."""
    highest = law.extrema(1)[1]
    entries: dict[str, Any] = {}
    inside = 1e-6 < highest.k < 1.0 - 1e-6
    if not frame.symmetric and numbers.random() < 0.2:
        placed = inside and numbers.random() < 0.7
        entries["inflexion"] = highest.k if placed else round(float(numbers.uniform(0.2, 0.8)), 3)
    value = highest.value if "inflexion" in entries else judged.value(FUNCTIONALS["B"])
    if numbers.random() < 0.6 and value > 1.0:
        entries["B"] = _asked(numbers, value, p=(0.4, 0.35, 0.1, 0.15))
    return entries


# --- windows ---


def _window(numbers: Numbers, law: MotionLaw, *, units: bool) -> Window:
    """A value or a window that the law keeps."""
    quantity, judged = str(numbers.choice(QUANTITIES)), Judged(law)
    curve: Callable[[Any], Any] = judged.derivatives[QUANTITIES.index(quantity)]
    if units and numbers.random() < 0.7:
        quantity = _window_of_formula(numbers)
        curve = judged.signal(quantity)
    start = round(float(numbers.uniform(0.05, 0.9)), 3)
    if numbers.random() < 0.4:
        return via(quantity, float(curve(start)), at=start)
    stop = round(min(1.0, start + float(numbers.uniform(0.01, 0.4))), 3)
    values = np.asarray(curve(np.linspace(start, stop, 401)))
    size = float(np.abs(values).max()) + 0.1 * (1.0 if quantity in QUANTITIES else float(np.abs(values).max()))
    room = 0.01 * size + size * float(numbers.choice([0.01, 0.1, 0.4]))
    low, high = float(values.min()) - room, float(values.max()) + room
    side = str(numbers.choice(["low", "high", "both"]))
    ends = {"low": (low, inf), "high": (-inf, high), "both": (low, high)}[side]
    if numbers.random() < 0.15:
        return Window(quantity, *ends, start, start)
    return Window(quantity, *ends, start, stop)


# --- all together ---


def drawn(numbers: Numbers, *, units: bool = False) -> Drawn:
    """One problem."""
    frame = _frame(numbers, units=units)
    law = _law(numbers, frame)
    typical = law or law_from_z(frame.conditions)
    judged = Guess(typical)
    entries = _bounds(numbers, frame, judged) | _velocity(numbers, frame, typical, judged)
    lowest = typical.extrema(1)[0].value
    if numbers.random() < (0.5 if lowest >= 0.0 else 0.05):
        entries["monotone"] = True
    if numbers.random() < 0.25:
        entries["windows"] = tuple(_window(numbers, typical, units=units) for _ in range(int(numbers.integers(1, 4))))
    problem = Problem(
        order=frame.order,
        boundary=frame.boundary,
        symmetric=frame.symmetric,
        basis=frame.basis,
        minimise=_objective(numbers, frame, judged),
        **entries,
    )
    return Drawn(problem, law if law is not None and keeps(problem, law) else None)


def keeps(problem: Problem, law: MotionLaw) -> bool:
    """Whether a law keeps the conditions."""
    return broken(problem, law, 1e-11) == []


def every_option(seed: int, count: int) -> list[Drawn]:
    """The same ones at every run."""
    numbers = np.random.default_rng([seed, 18])
    return [drawn(numbers) for _ in range(count)]


def every_unit(seed: int, count: int) -> list[Drawn]:
    """The same with formulas, machines, weights and windows in units from 1e-12 to 1e9."""
    numbers = np.random.default_rng([seed, 24])
    return [drawn(numbers, units=True) for _ in range(count)]
