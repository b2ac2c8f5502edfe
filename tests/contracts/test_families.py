"""What every family of rows keeps: derivatives are those of differences, and no point of a grid is above the extrema.

A new kind is a line in EXAMPLES.
"""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import Basis, BoundaryConditions, BSplines, Chebyshev, Pieces, residual_vibration
from tests.contracts.kinds import kinds
from tests.internals.balancing import B_loader, C_loader, D_loader
from tests.internals.synthesis import (
    ConeFamily,
    ConstraintFamily,
    EnergyFamily,
    FormulaFamily,
    KinkedIntegralFamily,
    LawSpace,
    PieceSeries,
    ProductFamily,
    named,
    space_of,
)

Array = NDArray[np.float64]

BOUND, QUIET = 0.7, 0.05
STEPS = (-6e-4, -3e-4, 3e-4, 6e-4)
BESIDE = 2.0**-50
WEIGHTS = np.array([0.3, 1.0, 0.2, 0.7])
SPLINES, PIECES = BSplines((0.0, 0.125, 0.5, 0.875, 1.0), 4, 2), Pieces(4, 5, 3)


def space(basis: Basis, *, symmetric: bool = False) -> LawSpace:
    """Laws from rest to rest."""
    return space_of(basis, BoundaryConditions.rest(4), symmetric=symmetric)


def slack(laws: LawSpace) -> Array:
    """A right side of two variables beyond the coordinates."""
    values = np.zeros(laws.terms + 2)
    values[-2:] = 1.0, -0.3
    return values


def random_cone(seed: int) -> ConeFamily:
    """Over four coordinates and one variable that bounds it."""
    numbers = np.random.default_rng(seed)
    series = numbers.normal(size=(7, 6)) + 1j * numbers.normal(size=(7, 6))
    series[:, 4] = 0.0
    return ConeFamily("cone", np.eye(5)[4], 0.5, table=PieceSeries.whole(series))


def vibration(laws: LawSpace) -> ConstraintFamily:
    """The rows of a residual vibration."""
    return residual_vibration(frequency=(11, 14), damping=0.02).families(laws, slack(laws), BOUND)[0]


def of_text(text: str, laws: LawSpace, room: Array) -> ConstraintFamily:
    """The first rows of a constant of a formula."""
    return named(text).families(laws, room, BOUND)[0]


SPACES = {
    "polynomials": space(Chebyshev(6)),
    "symmetric polynomials": space(Chebyshev(7), symmetric=True),
    "splines": space(SPLINES),
    "symmetric splines": space(SPLINES, symmetric=True),
    "pieces": space(PIECES),
    "symmetric pieces": space(PIECES, symmetric=True),
}
MAKERS: dict[str, Callable[[LawSpace, Array], ConstraintFamily]] = {
    "B": lambda laws, room: laws.derivative(1, "B", room, BOUND),
    "j upward": lambda laws, room: laws.derivative(3, "J", room, BOUND, (1.0,)),
    "cam": lambda laws, room: laws.combination(1, (1.0, 0.1, 0.02), "cam", room, BOUND),
    "backward": lambda laws, room: laws.backward(room, BOUND),
    "power": lambda laws, room: laws.power("D", room, BOUND),
    "norm": lambda laws, room: laws.norm(2, "rms_c", room, BOUND),
    "below the peak": lambda laws, room: laws.below(room),
    "forward": lambda laws, room: laws.forward(room),
    "from rest": lambda laws, room: laws.from_rest("b / sqrt(2k)", room),
    "to rest": lambda laws, room: laws.from_rest("b / sqrt(2 - 2k)", room, backward=True),
    "vibration": lambda laws, _: vibration(laws),
    "affine formula": lambda laws, room: of_text("peak(c + sin(3*k)*b)", laws, room),
    "affine formula with kinks": lambda laws, room: of_text(
        "peak(c + table(k, 0:0, 0.3:1, 1:0)*b, stop=0.45)", laws, room
    ),
    "curved formula": lambda laws, room: of_text("peak((1 + a^2)*c + a*b^2 + k*b, side=high, start=0.05)", laws, room),
    "integrated kinks": lambda laws, room: of_text("integral(abs(c - b) + a*b)", laws, room),
    "integrated greatest": lambda laws, room: of_text("integral(max((c + 0.5*b)*b, 0))", laws, room),
    "integrated squared greatest": lambda laws, room: of_text("integral(max(c, 0.5*b, 0)^2)", laws, room),
    "rooted kinks": lambda laws, room: of_text("rms(max(c, 0))", laws, room),
    "integrated formula": lambda laws, room: of_text("integral(c^2 + a*b)", laws, room),
    "rooted integral": lambda laws, room: of_text("rms(2 + c^2 + b^2)", laws, room),
    "velocity, loader": lambda laws, room: B_loader.families(laws, room, BOUND)[0],
    "acceleration, loader": lambda laws, room: C_loader.families(laws, room, BOUND)[0],
    "power, loader": lambda laws, room: D_loader.families(laws, room, BOUND)[0],
}
#: what not every space has: the other half of symmetric laws has no rows of its own, and loaders are of symmetric ones
ELSEWHERE = {"to rest": lambda where: "symmetric" not in where}
ELSEWHERE |= {name: lambda where: where == "symmetric polynomials" for name in MAKERS if name.endswith("loader")}


def examples() -> dict[str, ConstraintFamily]:
    """A family of every kind, of whole laws and of halves, with jumps and without."""
    found: dict[str, ConstraintFamily] = {f"a random cone, {seed}": random_cone(seed) for seed in range(8)}
    for where, laws in SPACES.items():
        asked = [what for what in MAKERS if what not in ELSEWHERE or ELSEWHERE[what](where)]
        found |= {f"{what} of {where}": MAKERS[what](laws, slack(laws)) for what in asked}
    return found


EXAMPLES = examples()
LAWS = {family: SPACES[where] for name, family in EXAMPLES.items() if (where := name.partition(" of ")[2])}
KINDS = sorted({type(family).__name__ for family in EXAMPLES.values()})


def every_family(test: Callable[[ConstraintFamily], None]) -> Callable[[str], None]:
    """A test for each kind, which holds all its examples to it."""

    @pytest.mark.parametrize("kind", KINDS)
    def of_kind(kind: str) -> None:
        for name, family in EXAMPLES.items():
            if type(family).__name__ == kind:
                try:
                    test(family)
                except AssertionError as error:
                    error.add_note(f"{kind}: {name}")
                    raise

    return of_kind


def point(family: ConstraintFamily, seed: int = 0) -> Array:
    """Random variables, the coordinates such that the law keeps its end conditions."""
    random = np.random.default_rng(seed).normal(size=len(family.slack))
    if family in LAWS:
        random[: LAWS[family].terms] = coordinates(LAWS[family], random)
    if isinstance(family, EnergyFamily):
        random *= QUIET  # those with one peak of velocity have a loader
    return random


def coordinates(laws: LawSpace, x: Array) -> Array:
    """The nearest ones that keep the equations."""
    found: Array = x[: laws.terms]
    if equations := laws.equations():
        rows, right = (
            np.array([equation.row for equation in equations]),
            np.array([equation.right for equation in equations]),
        )
        found = found - np.asarray(np.linalg.lstsq(rows, rows @ found - right)[0])
    return found


def grid(family: ConstraintFamily, count: int = 4001) -> Array:
    """The domain."""
    return np.linspace(*family.domain, count)


def corners(family: ConstraintFamily) -> Array:
    """Points at which nothing is smooth: the ends and the pinned ones."""
    _, low = family.domain
    nodes = family.nodes()
    pinned = np.empty(0) if nodes is None else nodes[family.pinned(nodes)]
    return np.concatenate([[-1.0, 1.0, low], pinned])


def inside(family: ConstraintFamily, count: int = 4, reach: float = 2e-3) -> Array:
    """Random points of the domain about which the family is smooth."""
    low, high = family.domain
    if low == high:
        return np.full(count, low)
    u = low + (high - low) * np.random.default_rng(5).random(400)
    away = np.abs(u[:, None] - corners(family)).min(axis=1) > 5 * reach
    found: Array = u[away][:count]
    return found


def slope(values: list[Array]) -> Array:
    """The derivative by differences of order four, of values at the steps."""
    before, left, right, after = values
    found: Array = (8.0 * (right - left) - (after - before)) / (12.0 * STEPS[2])
    return found


def test_every_kind_is_here() -> None:
    assert {type(family) for family in EXAMPLES.values()} == kinds(ConstraintFamily)


@every_family
def test_derivatives_by_the_place_are_those_of_differences(family: ConstraintFamily) -> None:
    x, u = point(family), inside(family)
    if family.domain[0] == family.domain[1]:
        assert not family.jet(x, u, np.ones(len(u))).slope.any()
        return
    for s in family.signs:
        signs = np.full(len(u), s)
        jet, around = family.jet(x, u, signs), {h: family.jet(x, u + h, signs) for h in STEPS}
        for of, got in (("value", jet.slope), ("slope", jet.curvature), ("gradient", jet.slope_gradient)):
            moved = slope([getattr(around[h], of) for h in STEPS])
            assert got == pytest.approx(moved, rel=1e-6, abs=1e-7 * (1.0 + np.abs(got).max()))


@pytest.mark.sample(2)
@every_family
def test_derivatives_by_the_variables_are_those_of_differences(family: ConstraintFamily) -> None:
    x, u = point(family), inside(family)
    if isinstance(family, KinkedIntegralFamily):
        # at rest c = b at both ends: a kink there comes and goes with coordinates that do not keep the ends
        x = x + 0.1 * np.random.default_rng(1).normal(size=len(x))
    signs = np.resize(family.signs, len(u))
    jet, hessian = family.jet(x, u, signs), family.hessian(x, u, WEIGHTS * signs)
    assert jet.value == pytest.approx(signs * family.value(x, u) - family.right_side(x), rel=1e-11, abs=1e-11)
    curved = np.zeros((len(x), len(x))) if hessian is None else hessian
    # no coordinate is at right angles to these directions, so that a wrong derivative by any of them shows
    for direction in np.random.default_rng(2).uniform(0.3, 1.0, (2, len(x))):
        around = [family.jet(x + h * direction, u, signs) for h in STEPS]
        value = slope([one.value for one in around])
        assert jet.gradient @ direction == pytest.approx(value, rel=1e-7, abs=1e-8 * (1.0 + np.abs(value).max()))
        expected = WEIGHTS @ slope([one.gradient for one in around])
        assert curved @ direction == pytest.approx(expected, rel=1e-7, abs=1e-8 * (1.0 + np.abs(expected).max()))


@pytest.mark.sample(2)
@every_family
def test_no_point_of_a_grid_is_above_the_extrema(family: ConstraintFamily) -> None:
    for seed in range(3):
        x, u = point(family, seed), grid(family)
        places, signs, residuals = family.extremes(x)
        assert set(family.domain) <= set(places)
        assert places.min() == family.domain[0]
        assert places.max() == family.domain[1]
        assert residuals == pytest.approx(family.jet(x, places, signs).value, rel=1e-9, abs=1e-9)
        value, room = family.value(x, u), family.right_side(x)
        for s in family.signs:
            sampled, greatest = float((s * value).max()), float(residuals[signs == s].max()) + room
            assert sampled <= greatest + 1e-10 * (1.0 + abs(greatest))
            assert greatest <= sampled + np.abs(np.diff(value)).max() + 1e-12 * (1.0 + abs(sampled))


@every_family
def test_extrema_are_ends_places_without_slope_or_pinned(family: ConstraintFamily) -> None:
    low, high = family.domain
    x = point(family)
    places, signs, residuals = family.extremes(x)
    for s in family.signs:
        best = np.flatnonzero(signs == s)[[int(np.argmax(residuals[signs == s]))]]
        u = places[best]
        jet = family.jet(x, u, signs[best])
        above = jet.value[0] - residuals[(signs == s) & np.isin(places, family.domain)].max()
        if not family.pinned(u)[0] and above > 1e-9 * (1.0 + abs(jet.value[0])):
            assert low < u[0] < high
            assert abs(jet.slope[0]) <= 1e-6 * (1.0 + abs(jet.value[0]) + abs(jet.curvature[0]))
            assert jet.curvature[0] <= 1e-6 * (1.0 + abs(jet.value[0]))


@every_family
def test_contacts_at_breaks_stay_where_they_are_and_no_others(family: ConstraintFamily) -> None:
    name = next(name for name, one in EXAMPLES.items() if one is family)
    low, high = family.domain
    if low < high:
        assert not family.pinned(inside(family)).any()
    pieces = name.endswith(("splines", "pieces")) and not name.startswith(("norm", "vibration"))
    breaks = 1.0 - 2.0 * np.array(PIECES.breaks if name.endswith("pieces") else SPLINES.breaks)[1:-1]
    # where the function jumps, the places are beside the break
    beside = [family.pinned(breaks + way) for way in (-BESIDE, 0.0, BESIDE)]
    there = (breaks >= low) & (breaks <= high) & (low < high)
    assert (np.any(beside, axis=0)[there] == pieces).all()


@every_family
def test_places_are_numbers_k_and_back(family: ConstraintFamily) -> None:
    u = grid(family, 41)
    k = family.k(u)
    assert ((k >= 0.0) & (k <= 1.0)).all()
    assert family.u(k) == pytest.approx(u, abs=1e-14)
    nodes = family.nodes()
    assert nodes is None or (np.abs(nodes) <= 1.0).all()


@every_family
def test_other_units_change_nothing(family: ConstraintFamily) -> None:
    x, u, unit = point(family), inside(family), 2.5
    units = np.random.default_rng(8).uniform(0.2, 5.0, len(x))
    other = family.in_units(units, unit)
    own = EnergyFamily | FormulaFamily
    divisor = unit * unit if isinstance(family, ProductFamily) else 1.0 if isinstance(family, own) else unit
    assert other.right_side(x / units) * divisor == pytest.approx(family.right_side(x), rel=1e-12)
    assert other.value(x / units, u) * divisor == pytest.approx(family.value(x, u), rel=1e-10)
    greatest = other.extremes(x / units)[2].max() * divisor
    assert greatest == pytest.approx(family.extremes(x)[2].max(), rel=1e-10, abs=1e-11)


@pytest.mark.parametrize("where", SPACES)
def test_values_are_those_of_the_law(where: str) -> None:
    laws = SPACES[where]
    x = point(EXAMPLES[f"B of {where}"])[: laws.terms]
    law, nothing = laws.law(x), np.zeros(laws.terms)
    expected: list[tuple[ConstraintFamily, Callable[[Array], object]]] = [
        (laws.derivative(2, "C", nothing), law.c),
        (laws.combination(1, (1.0, 0.1), "cam", nothing), lambda k: law.b(k) + 0.1 * law.c(k)),
        (laws.power("D", nothing), law.d),
        (laws.from_rest("b / sqrt(2k)", nothing), lambda k: law.b(k) / np.sqrt(2 * k)),
        (laws.norm(2, "rms_c", nothing), lambda _: np.full(25, law.rms(2))),
        (laws.backward(nothing, 0.0), law.b),
        (LawSpace.forward(laws, nothing), law.b),
    ]
    if not laws.symmetric:
        to_rest = laws.from_rest("b / sqrt(2 - 2k)", nothing, backward=True)
        expected.append((to_rest, lambda k: law.b(k) / np.sqrt(2 - 2 * k)))
    for family, of_law in expected:
        u = np.linspace(*family.domain, 27)[1:-1]
        assert family.value(x, u) == pytest.approx(of_law(family.k(u)), rel=1e-9, abs=1e-9), family.name
