"""What every basis keeps: a plain, frozen value with its name in texts and files, a space of laws, a z that makes them.

A new kind is a line in EXAMPLES.
"""

import copy
import dataclasses
import json
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import BPoly

import optlaws
from optlaws import (
    Basis,
    Bernstein,
    BoundaryConditions,
    BSplines,
    Chebyshev,
    InputError,
    PeriodicPieces,
    Pieces,
    Powers,
    law_from_z,
)
from optlaws.synthesis import PiecewiseBasis, PolynomialBasis
from tests.contracts.kinds import kinds
from tests.contracts.test_families import coordinates
from tests.internals.synthesis import LawSpace, space_of
from tests.internals.synthesis import basis as basis_called

Array = NDArray[np.float64]

UNEVEN = (0.0, 0.2, 0.45, 1.0)
EXAMPLES: tuple[Basis, ...] = (
    Powers(0),
    Powers(4),
    Powers(11),
    Chebyshev(0),
    Chebyshev(4),
    Chebyshev(9),
    Bernstein(0),
    Bernstein(5),
    BSplines(1, 3),
    BSplines(4, 4, 2),
    BSplines((0.0, 0.2, 0.5, 0.8, 1.0), 3),
    BSplines(UNEVEN, 3, 2),
    Pieces(4, 5, 3),
    Pieces(6, 3, 2),
    Pieces((0.0, 0.2, 0.5, 0.8, 1.0), 6, 4),
    Pieces(UNEVEN, 7, 3),
    PeriodicPieces(UNEVEN, 5, 3),
    PeriodicPieces(5, 4, 2, straight=(1, 4)),
)
#: by name: one that leaves symmetric laws no freedom, or cannot be symmetric
REFUSED = {"powers": Powers(0), "chebyshev": Chebyshev(0), "bernstein": Bernstein(0), "bsplines": BSplines(UNEVEN)}
REFUSED |= {"pieces": Pieces(3), "periodic": PeriodicPieces(3)}
ENDS = (
    BoundaryConditions.rest(2),
    BoundaryConditions.rest(3),
    BoundaryConditions((0.0, 0.5), (1.0, 0.25)),
    BoundaryConditions((0.25, 0.5, -1.0), (1.0, -0.25, 3.0)),
)
#: laws that repeat have no others
TURNS = (BoundaryConditions((0.0,), (0.0,)), BoundaryConditions((0.25,), (1.0,)))
K = np.linspace(0.0, 1.0, 61)
#: Z by others' hands, of the polynomial bases
FUNCTIONS: dict[str, Callable[[Array], Array]] = {
    "powers": lambda z: np.polynomial.Polynomial(z)(K),
    "chebyshev": lambda z: np.asarray(np.polynomial.chebyshev.chebval(2 * K - 1, z), dtype=float),
    "bernstein": lambda z: BPoly(z[:, None], [0.0, 1.0])(K),
}

every_basis = pytest.mark.parametrize("basis", EXAMPLES, ids=repr)


def entries(basis: Basis) -> dict[str, Any]:
    """What a file holds of it, read again."""
    return dict(json.loads(json.dumps(basis.to_dict(), allow_nan=False)))


def spaces(basis: Basis) -> list[LawSpace]:
    """Unsymmetric laws with every end conditions, symmetric ones from rest to rest where there are any."""
    ends = TURNS if isinstance(basis, PeriodicPieces) else ENDS
    found = [space_of(basis, end, symmetric=False) for end in ends]
    if basis.mirrored and basis != REFUSED[basis.name]:
        found += [space_of(basis, BoundaryConditions.rest(order), symmetric=True) for order in (2, 3)]
    return found


def point(space: LawSpace, seed: int = 0) -> Array:
    """Random coordinates of a law that keeps the end conditions."""
    return coordinates(space, np.random.default_rng(seed).normal(size=space.terms))


def test_every_kind_is_here_and_has_a_name() -> None:
    found = kinds(Basis)
    assert {type(basis) for basis in EXAMPLES} == found
    named = {kind.name: kind for kind in found if issubclass(kind, Basis)}
    # other tests may have bases of their own
    assert dict(Basis.kinds).items() >= named.items()
    assert len(named) == len(found)
    assert REFUSED.keys() == named.keys()


@every_basis
def test_it_is_a_plain_value(basis: Basis) -> None:
    same = [pickle.loads(pickle.dumps(basis)), copy.deepcopy(basis)]  # noqa: S301
    same += [basis_called(entry.pop("basis"), **entry) for entry in [entries(basis)]]
    same += [eval(repr(basis), vars(optlaws) | {type(basis).__name__: type(basis)})]  # noqa: S307 - its own repr
    for one in same:
        assert one == basis
        assert type(one) is type(basis)
        assert hash(one) == hash(basis)
        assert one.to_dict() == basis.to_dict()
    assert [other for other in EXAMPLES if other == basis] == [basis]
    assert basis.to_dict()["basis"] == basis.name
    for field in dataclasses.fields(basis):  # type: ignore[arg-type] # every basis is a dataclass
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(basis, field.name, 1)


@every_basis
def test_wrong_parameters_are_refused_by_name(basis: Basis) -> None:
    entry = entries(basis)
    name = entry.pop("basis")
    for wrong in ({"degree": 2.5}, {"degree": -1}, {"degree": True}):
        with pytest.raises(InputError, match="degree"):
            basis_called(name, **{**entry, **wrong})
    with pytest.raises(InputError, match="nonsense"):
        basis_called(name, **entry, nonsense=1)


@pytest.mark.parametrize("name", REFUSED)
def test_symmetric_laws_without_freedom_are_refused(name: str) -> None:
    with pytest.raises(InputError, match=r"freedom|symmetric about 1/2"):
        REFUSED[name].check(symmetric=True)
    for basis in EXAMPLES:
        if basis.name == name:
            basis.check(symmetric=False)
            if basis.mirrored and basis != REFUSED[name]:
                basis.check(symmetric=True)


@pytest.mark.sample(2)
@every_basis
def test_its_laws_keep_the_end_conditions_the_symmetry_and_the_continuity(basis: Basis) -> None:
    for space in spaces(basis):
        law, order = space.law(point(space)), space.boundary.order
        start, end = law.boundary_values(order)
        sizes = [1.0 + law.peak(nu).value for nu in range(order)]
        assert np.array(start) / sizes == pytest.approx(np.array(space.boundary.start, float) / sizes, abs=1e-11)
        assert np.array(end) / sizes == pytest.approx(np.array(space.boundary.end, float) / sizes, abs=1e-11)
        assert space.stroke == pytest.approx(float(space.boundary.end[0] - space.boundary.start[0]), abs=1e-12)
        if space.symmetric:
            assert law.a(K) + law.a(1.0 - K) == pytest.approx(1.0, abs=1e-11)
        assert [law.jumps(nu) for nu in range(1, min(getattr(basis, "continuity", 0), 3) + 1) if law.jumps(nu)] == []


@pytest.mark.sample(3)
@every_basis
def test_rows_are_the_law(basis: Basis) -> None:
    for space in spaces(basis):
        x = point(space)
        law = space.law(x)
        inner = K[(K <= 0.5) | (not space.symmetric)]
        for nu in range(3):
            rows = np.array([space.row(nu, k) for k in inner.tolist()])
            assert rows.shape == (len(inner), space.terms + 1)
            size = 1.0 + law.peak(nu).value
            assert rows @ np.append(x, 1.0) == pytest.approx(law(inner, nu), abs=1e-11 * size)


@every_basis
def test_the_mirror_image_of_a_law_is_in_the_space_if_it_says_so(basis: Basis) -> None:
    ends = TURNS[1] if isinstance(basis, PeriodicPieces) else BoundaryConditions.rest(3)
    space = space_of(basis, ends, symmetric=False)
    nothing = coordinates(space, np.zeros(space.terms))
    laws = [space.law(nothing).b(K), *(space.law(point(space, seed)).b(K) for seed in range(space.terms + 1))]
    free = np.array([law - laws[0] for law in laws[1:]]).T
    image = space.law(point(space, 99)).b(1.0 - K) - laws[0]
    left = image - free @ np.linalg.lstsq(free, image)[0]
    there = np.abs(left).max() < 1e-9 * (1.0 + np.abs(image).max())
    assert there == basis.mirrored


@pytest.mark.sample(3)
@every_basis
def test_z_goes_there_and_back_and_makes_the_law(basis: Basis) -> None:
    for space in spaces(basis):
        x = point(space)
        law, series = space.law(x), space.z_series(x)
        assert (series.size > 0) == isinstance(basis, PolynomialBasis | PiecewiseBasis)
        if not isinstance(basis, PolynomialBasis | PiecewiseBasis):
            continue
        z = basis.coefficients(series)
        assert len(z) == basis.size
        again = law_from_z(space.boundary, z, basis)
        for nu in range(3):
            assert again(K, nu) == pytest.approx(law(K, nu), abs=1e-8 * (1.0 + law.peak(nu).value))
        # what rounding each z to a double may change, no function being above 1
        rounding = 2.0**-50 * float(np.abs(z).sum())
        assert np.ravel(basis.series(z)) == pytest.approx(series, abs=1e-11 * np.abs(series).max() + rounding)
        whole = np.random.default_rng(3).integers(-50, 50, basis.size).astype(float).tolist()
        assert basis.coefficients(basis.series(whole)) == pytest.approx(whole, rel=1e-12, abs=1e-11)


@every_basis
def test_z_of_another_length_is_refused(basis: Basis) -> None:
    if not isinstance(basis, PolynomialBasis | PiecewiseBasis):
        return
    for size in {0, basis.size - 1, basis.size + 1, basis.size + 2}:
        for call in (basis.series, lambda z: law_from_z(BoundaryConditions.rest(2), z, basis)):
            with pytest.raises(InputError, match=f"{basis.size} coefficients"):
                call([1.0] * size)


@pytest.mark.parametrize("basis", [one for one in EXAMPLES if isinstance(one, PolynomialBasis)], ids=repr)
def test_z_belongs_to_the_functions_of_its_name(basis: PolynomialBasis) -> None:
    z = np.random.default_rng(3).integers(-50, 50, basis.size).astype(float)
    series = np.polynomial.Chebyshev(basis.series(z.tolist()), domain=(0.0, 1.0))(K)
    assert series == pytest.approx(FUNCTIONS[basis.name](z), rel=1e-12, abs=1e-9)
