"""What every constant keeps: its value by another hand, rows that hold if it is bounded, convexity, curbs, its name.

A new kind is a line in EXAMPLES. The other hand is `Judged`, numpy's series from the stored law alone, whose values
are held to dense grids and quadratures here.
"""

import copy
import pickle
import re
from dataclasses import FrozenInstanceError
from functools import cache
from math import isnan, sqrt

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import (
    FUNCTIONALS,
    BoundaryConditions,
    BSplines,
    Chebyshev,
    Functional,
    InputError,
    Machine,
    MotionLaw,
    Pieces,
)
from tests.contracts.kinds import kinds
from tests.contracts.test_families import coordinates
from tests.internals.balancing import LoaderPeak
from tests.internals.formulas import ORDERS
from tests.internals.mechanisms import BandResidual, CamPeak, CamPower, ModeResidual, OutputConstant
from tests.internals.synthesis import (
    ALIASES,
    MAKERS,
    PLAIN,
    FormulaIntegral,
    FormulaPeak,
    FormulaRms,
    FormulaValue,
    LawSpace,
    OfFormula,
    PeakConstant,
    PowerConstant,
    RootMeanSquare,
    expression,
    is_named,
    named,
    space_of,
)
from tests.synthesis.judge import Judged

Array = NDArray[np.float64]

TEXTS = (
    *FUNCTIONALS,
    *PLAIN,
    "B_cam(frequency=20.0)",
    "C_cam(frequency=7.5, damping=0.05)",
    "C_plus_cam(frequency=20.0)",
    "C_minus_cam(frequency=12.0, damping=0.1)",
    "D_cam(frequency=20.0, damping=0.05)",
    "J_cam(frequency=20.0, damping=1.5)",
    "residual(frequency=18.0)",
    "residual(frequency=(18.0, 22.0), damping=0.03)",
    "residual(frequency=(8.0, 12.0), design=10.0)",
    "residual(frequency=(9.0, 11.0), damping=0.02, design=10.0, design_damping=0.05)",
    "residual(frequency=(18.0, 22.0), damping=0.03, of=displacement)",
    "peak(c + 0.2*b)",
    "peak((1 + k)*c - a, side=high)",
    "peak(j + sin(6*k)*c, side=low, start=0.1, stop=0.6)",
    "peak(c + table(k, 0:0, 0.5:3, 1:1)*b)",
    "rms(c + 3*b)",
    "rms(c + spline(k, 0:0, 0.3:1, 0.6:0, 1:2)*a, start=0.2)",
    "value(c - 2*b, at=0.3)",
    "peak(c^2 + (1 + k)*b^2)",
    "peak(norm(c, 3*b), start=0.05, stop=0.9)",
    "peak(abs(c) + 2*abs(b))",
    "peak(max(c, 3*b, -a), side=high)",
    "peak((1 + a^2)*c + a*b^2)",
    "peak(b*c + 0.1*abs(b), side=high)",
    "rms(c^2 + b^2)",
    "rms(b*c)",
    "integral(c^2 + (1 + k)*b^2)",
    "integral(exp(c/40), start=0.3)",
    "integral(a*c, start=0.2, stop=0.8)",
    "rms(exp(c/5))",
    "value(c^2 + b*j, at=0.3)",
)
AXIS = Machine.from_masses(
    {"motor": 1.0, "carriage": 2.0, "tool": 0.5},
    [("motor", "carriage", 600.0, 4.0), ("carriage", "tool", 250.0, 1.0)],
    drive="motor",
    outputs={"motor torque": "drive force", "tool": "acceleration tool"},
)
OF_MACHINES: tuple[Functional, ...] = (
    AXIS.peak("motor torque"),
    AXIS.peak("tool", within=(0.25, 1.5)),
    AXIS.peak("tool", cycle=(0.25, 0.5)),
    AXIS.peak("motor torque", side="high", offset=-2.0),
    AXIS.peak("tool", within=(0.25, 1.5), side="low"),
    AXIS.rms("motor torque", dwell=0.5),
    AXIS.rms("motor torque", offset=3.0),
    AXIS.rms("tool", cycle=(0.0, 0.5)),
    AXIS.residual(1, "tool"),
    AXIS.residual(2, "motor torque", spread=0.1, damping=(0.0, 0.1)),
)
EXAMPLES: dict[str, Functional] = {text: named(text) for text in TEXTS} | {one.name: one for one in OF_MACHINES}
ORDER = 5
SPACES: dict[str, LawSpace] = {
    repr((basis, symmetric)): space_of(basis, BoundaryConditions.rest(ORDER), symmetric=symmetric)
    for basis, symmetric in (
        (Chebyshev(7), False),
        (Chebyshev(7), True),
        (BSplines(4, 6, 5), False),
        (Pieces(4, 8, 5), True),
    )
}
GRID = np.linspace(0.0, 1.0, 4001)
X, WEIGHTS = np.polynomial.legendre.leggauss(60)

every_constant = pytest.mark.parametrize("name", EXAMPLES)


def kind_of(name: str) -> type:
    """Of which kind a constant is."""
    return type(EXAMPLES[name])


@cache
def point(where: str, seed: int, size: float = 1.0) -> tuple[Array, MotionLaw]:
    """Random coordinates and their law; `size` is how far it is from the base law."""
    space = SPACES[where]
    least = coordinates(space, np.zeros(space.terms))
    x = coordinates(space, np.random.default_rng(seed).normal(size=space.terms) * 3.0)
    moved = least + size * (x - least)
    return moved, space.law(moved)


def quiet(name: str) -> float:
    """How far from the base law random laws may be: those with a loader have one peak of velocity."""
    return 0.05 if isinstance(EXAMPLES[name], LoaderPeak) else 1.0


def places_of(name: str) -> list[str]:
    """The spaces in which a constant has a value for every law."""
    return [where for where in SPACES if not isinstance(EXAMPLES[name], LoaderPeak) or "Chebyshev" in where]


def has_rows(name: str, where: str) -> bool:
    """Whether a constant can be sought among the laws of a space: loaders turn in the middle of symmetric ones."""
    return not isinstance(EXAMPLES[name], LoaderPeak) or where == repr((Chebyshev(7), True))


def combination(law: MotionLaw, nu: int, frequency: float, damping: float, k: Array) -> Array:
    """A derivative of the cam law a + 2 damping b/frequency + c/frequency²."""
    return np.asarray(law(k, nu) + 2.0 * damping / frequency * law(k, nu + 1) + law(k, nu + 2) / frequency**2)


def sampled(constant: Functional, law: MotionLaw) -> tuple[float, float]:
    """The constant on a dense grid, and by how much it may be above that between the points."""
    if isinstance(constant, RootMeanSquare):
        breaks = np.linspace(0.0, 1.0, 5)
        k = (breaks[:-1, None] + np.diff(breaks)[:, None] * (1.0 + X) / 2.0).ravel()
        return sqrt(float(np.resize(WEIGHTS / 8.0, len(k)) @ law(k, constant.nu) ** 2)), 0.0
    if isinstance(constant, BandResidual):
        return vibration(constant, law)
    if isinstance(constant, LoaderPeak):
        return of_loader(constant, law)
    if isinstance(constant, OfFormula):
        return of_formula(constant, law)
    if isinstance(constant, OutputConstant | ModeResidual):
        return Judged(law).value(constant), 1e-8  # stepped by matrix exponentials: a grid of its own
    values = signal(constant, law)
    signs = constant.signs if isinstance(constant, PeakConstant | CamPeak) else (1.0, -1.0)
    greatest = max(float((sign * values).max()) for sign in signs)
    # between the points a smooth function is above them by an eighth of the second difference, at a break by a step
    return greatest, float(np.abs(np.diff(values, 1 if "breaks" in law.to_dict() else 2)).max())


def signal(constant: Functional, law: MotionLaw) -> Array:
    """The function of k whose peak a constant is."""
    if isinstance(constant, CamPeak):
        return combination(law, constant.nu, constant.frequency, constant.damping, GRID)
    if isinstance(constant, CamPower):
        b, c = (combination(law, nu, constant.frequency, constant.damping, GRID) for nu in (1, 2))
        return b * c
    if isinstance(constant, PeakConstant):
        return np.asarray(law(GRID, constant.nu))
    assert type(constant) is PowerConstant
    return np.asarray(law.b(GRID) * law.c(GRID))


def vibration(constant: BandResidual, law: MotionLaw) -> tuple[float, float]:
    """The amplitude left at k = 1, or nu² times it, by Simpson's rule, over frequencies."""
    weights = np.concatenate([[1.0], np.resize([4.0, 2.0], len(GRID) - 2), [1.0]]) / (3.0 * (len(GRID) - 1))
    b = np.asarray(law.b(GRID))
    if constant.design is not None:
        b = combination(law, 1, constant.design, constant.design_damping, GRID)
    frequencies = np.linspace(constant.low, constant.high, 41 if constant.high > constant.low else 1)
    w = frequencies * complex(-constant.damping, sqrt(1.0 - constant.damping**2))
    unit = np.ones_like(frequencies) if constant.displacement else frequencies**2
    values = np.abs(unit * w.conj() / w.imag * (np.exp(np.outer(w, 1.0 - GRID)) @ (weights * b)))
    return float(values.max()), float(np.abs(np.diff(values)).max(initial=0.0))


def of_loader(constant: LoaderPeak, law: MotionLaw) -> tuple[float, float]:
    """The loader's energy and the law's add up: its velocity is Y sqrt(B² - b²), its stroke 1."""
    top = law.peak(1)
    k = np.concatenate([top.k * (1.0 + X) / 2.0, top.k + (1.0 - top.k) * (1.0 + X) / 2.0])
    measure = np.concatenate([top.k * WEIGHTS, (1.0 - top.k) * WEIGHTS]) / 2.0
    factor = 1.0 / float(measure @ np.sqrt(np.maximum(top.value**2 - law.b(k) ** 2, 0.0)))
    if constant.of == "B":
        return factor * top.value, 1e-9
    if constant.of == "D":
        values = factor**2 * np.abs(law.d(GRID))
        return float(values.max()), float(np.abs(np.diff(values, 2)).max())
    away = GRID[np.abs(GRID - top.k) > 2e-3]
    values = np.abs(law.d(away)) / np.sqrt(top.value**2 - law.b(away) ** 2) * factor
    return float(values.max()), 5.0 * float(np.abs(np.diff(values)).max())


def of_formula(constant: OfFormula, law: MotionLaw) -> tuple[float, float]:
    """A formula on a grid of its part; a mean square by the trapezoidal rule on it."""
    motion = constant.motion
    k = motion.start + (motion.stop - motion.start) * GRID
    values = np.broadcast_to(motion.values({"k": k, **{name: law(k, nu) for name, nu in ORDERS.items()}}), k.shape)
    if isinstance(constant, FormulaIntegral):
        whole = float(np.trapezoid(values, k))
        spare = 1e-5 * float(np.abs(values).max())
        return whole - spare, 2.0 * spare
    if isinstance(constant, FormulaRms):
        return sqrt(float(np.trapezoid(values**2, GRID))) * (1.0 - 1e-5), 2e-5 * float(np.abs(values).max())
    if isinstance(constant, FormulaValue):
        return float(values[0]), 0.0
    assert isinstance(constant, FormulaPeak)
    greatest = max(float((sign * values).max()) for sign in constant.signs)
    return greatest, float(np.abs(np.diff(values)).max())


def test_every_kind_name_and_maker_is_here() -> None:
    assert {type(constant) for constant in EXAMPLES.values()} == kinds(Functional)
    assert {*FUNCTIONALS, *PLAIN} <= EXAMPLES.keys()
    assert {*MAKERS} == {name.partition("(")[0] for name in EXAMPLES if "(" in name}
    assert {*ALIASES.values()} <= {*FUNCTIONALS.values()}


@pytest.mark.sample(2, kind=kind_of)
@every_constant
def test_its_value_is_that_of_a_grid_and_of_numpy(name: str) -> None:
    constant = EXAMPLES[name]
    for where in places_of(name):
        law = point(where, 0, quiet(name))[1]
        value, (low, spare) = constant.value(law), sampled(constant, law)
        rounding = 1e-9 * abs(low)
        assert low - rounding <= value <= low + rounding + spare, where
        if not isinstance(constant, LoaderPeak):
            assert value == pytest.approx(Judged(law).value(constant), rel=1e-8), where


@pytest.mark.sample(3, kind=kind_of)
@every_constant
def test_its_rows_hold_if_and_only_if_it_is_bounded(name: str) -> None:
    constant = EXAMPLES[name]
    for where, space in SPACES.items():
        if not has_rows(name, where):
            with pytest.raises(InputError, match=re.escape(f"{name} needs symmetric laws")):
                constant.families(space, np.zeros(space.terms), 1.0)
            continue
        x, law = point(where, 0, quiet(name))
        value = constant.value(law)
        variable, nothing = np.eye(space.terms + 1)[-1], np.zeros(space.terms + 1)
        for step, holds in ((1e-6, True), (-1e-6, False)):
            limit = value + step * abs(value)
            for slack, bound in ((variable, 0.0), (nothing, limit)):
                rows = constant.families(space, slack, bound)
                full = np.append(x, limit)
                assert (max(family.extremes(full)[2].max() for family in rows) <= 0.0) == holds, where


@pytest.mark.sample(3, kind=kind_of)
@every_constant
def test_it_is_convex_if_it_says_so(name: str) -> None:
    constant = EXAMPLES[name]
    # far from each other, and so near that hardly more than one place counts
    pairs = [(0, 1.0), (2, 0.02), (4, 0.02)]
    excesses = [excess(name, where, seed, share) for where in places_of(name) for seed, share in pairs]
    if constant.convex:
        assert max(excesses) <= 1e-11
    else:
        assert any(excess(name, where, 2 * seed, 0.02) > 1e-9 for seed in range(30) for where in places_of(name))


def excess(name: str, where: str, seed: int, share: float) -> float:
    """By how much the constant of a law between two others is above their mean, relative."""
    space, value = SPACES[where], EXAMPLES[name].value
    one, other = (point(where, seed + i, quiet(name))[0] for i in (0, 1))
    first, middle, last = (value(space.law(one + part * share * (other - one))) for part in (0.0, 0.5, 1.0))
    return (2.0 * middle - first - last) / (abs(first) + abs(last))


@pytest.mark.sample(3, kind=kind_of)
@every_constant
def test_no_law_is_below_its_least_value_or_beyond_its_curbs(name: str) -> None:
    constant = EXAMPLES[name]
    for where in places_of(name):
        for seed in range(2):
            law = point(where, seed, quiet(name))[1]
            value, least = constant.value(law), constant.least(ORDER)
            assert isnan(least) or value >= least
            size = sqrt(value) if isinstance(constant, PowerConstant) else value
            for nu, factor in constant.curbs():
                assert np.abs(law(GRID, nu)).mean() <= factor * size * (1.0 + 1e-3)
            assert value >= constant.floor(SPACES[where].boundary)
            for nu, factor, offset in constant.sizes(SPACES[where]):
                assert np.abs(law(GRID, nu)).mean() <= (factor * size + offset) * (1.0 + 1e-3)


@every_constant
def test_it_is_a_value_that_its_name_stands_for(name: str) -> None:
    constant = EXAMPLES[name]
    assert repr(constant) == constant.name == name
    for one in (pickle.loads(pickle.dumps(constant)), copy.deepcopy(constant)):  # noqa: S301
        assert (one, hash(one)) == (constant, hash(constant))
    assert [other for other in EXAMPLES.values() if other == constant] == [constant]
    assert is_named(constant)
    mixed = 0.25 * constant + 2.0 * EXAMPLES["C"]
    assert name == "C" or expression(repr(mixed)) == mixed
    with pytest.raises(FrozenInstanceError):
        constant.name = "other"  # type: ignore[misc]
