"""Certificates made by hand, whose bound and charge are known in closed form.

Symmetric laws of order 2 with a Z of degree 1 are a base law with c = -6x and j = -12, x = 2k - 1, and a multiple of
one with c = 2 P3(x) and j = 30x² - 6. A contact at a root of these speaks of the base law alone; elsewhere the claim
must bound what the free function can do: its moment with P3 is 2/7.
"""

from dataclasses import replace
from fractions import Fraction
from math import inf, nextafter, sqrt
from typing import Any

import pytest
from scipy.optimize import brentq

from optlaws import (
    BoundaryConditions,
    Certificate,
    Chebyshev,
    Contact,
    InputError,
    Leaf,
    Problem,
    Split,
    at_least,
    at_most,
)
from tests.internals.synthesis import RELAXED, VIOLATION, Sublevel, expression, model_of_leaf, spread
from tests.internals.verification import ExactRows

pytestmark = pytest.mark.filterwarnings("ignore::optlaws.errors.NotNormalised")
#: roots of P3 and of P3'
GAUSS, FLAT = sqrt(0.6), sqrt(0.2)
C_BASE, J_BASE = 6.0 * GAUSS, 12.0


def at(x: float) -> float:
    return (1.0 + x) / 2.0


def p3(x: float) -> float:
    return (5.0 * x**3 - 3.0 * x) / 2.0


def small(**asked: Any) -> Problem:
    return Problem(order=2, basis=Chebyshev(1), **asked)


ENDS = BoundaryConditions((0, 0.5), (1, -1.0))
MOVING = Problem(boundary=ENDS, symmetric=False, basis=Chebyshev(1))
FAST = small(symmetric=False, inflexion=0.4, B=at_least(1.2))


def bound(problem: Problem, *contacts: Contact, equations: tuple[float, ...] = ()) -> float:
    return Certificate.of_leaf(problem, contacts, equations).bound


def charged(problem: Problem, *contacts: Contact, equations: tuple[float, ...] = ()) -> float:
    """The bound of the multipliers as they are, less what the sum still depends on."""
    return Certificate.of_leaf(problem, contacts, equations).estimate


def c_at(x: float, multiplier: float) -> Contact:
    return Contact("C", 1.0 if x < 0.0 else -1.0, at(x), multiplier)


def j_at(x: float, multiplier: float) -> Contact:
    return Contact("J", -1.0, at(x), multiplier)


def test_one_contact_proves_what_its_base_law_has_there() -> None:
    assert bound(small(), c_at(-GAUSS, 1.0)) == pytest.approx(C_BASE, rel=1e-12)
    assert bound(small(minimise="0.5*C"), c_at(-GAUSS, 0.5)) == pytest.approx(C_BASE / 2.0, rel=1e-12)
    assert bound(small(minimise="J"), j_at(-FLAT, 1.0)) == pytest.approx(J_BASE, rel=1e-12)
    assert bound(small(minimise="0.25*C + 2*J"), c_at(-GAUSS, 0.25), j_at(-FLAT, 2.0)) == pytest.approx(
        0.25 * C_BASE + 2.0 * J_BASE, rel=1e-12
    )


@pytest.mark.parametrize("x", [-0.8, -0.75, -0.776])
@pytest.mark.parametrize("weight", [1.0, 0.5, 3.0])
def test_elsewhere_the_claim_bounds_what_the_free_function_can_do(x: float, weight: float) -> None:
    claim = -6.0 * x  # what C is below, in a law that contradicts the claim; c of the base law has no moment along P3
    charge = claim * abs(2.0 * p3(x)) * 3.5
    least = bound(small(minimise=f"{weight}*C"), c_at(x, weight))
    assert least == pytest.approx(weight * (claim - charge), rel=1e-9)


def test_a_multiplier_above_the_weight_is_charged_by_what_the_constant_can_be() -> None:
    # 1.1 of the contact leaves -0.1 C, and C is below the claim
    assert charged(small(), c_at(-GAUSS, 1.1)) == pytest.approx(1.1 * C_BASE * (1.0 - 0.1), rel=1e-9)
    assert charged(small(minimise="2*C"), c_at(-GAUSS, 2.5)) == pytest.approx(2.5 * C_BASE * (1.0 - 0.25), rel=1e-9)
    # less than the weight proves the less
    assert bound(small(), c_at(-GAUSS, 0.9)) == pytest.approx(0.9 * C_BASE, rel=1e-12)
    # a bound of C is less than the claim, and charged
    asked = small(minimise="J", C=at_most(5.0))
    assert charged(asked, c_at(-GAUSS, 1.0)) == pytest.approx(C_BASE - 5.0, rel=1e-9)
    # but J, which is minimised, is never below 0
    assert bound(asked, c_at(-GAUSS, 1.0)) == pytest.approx(max(C_BASE - 5.0, 0.0), rel=1e-9)


def test_the_parts_of_a_maximum_share_its_weight() -> None:
    problem = small(minimise="C + max(C/2, J/24)")
    name = "max(0.5*C, 0.041666666666666664*J)"
    parts = (Contact(f"part 1 of {name}", 1.0, 0.5, 0.25), Contact(f"part 2 of {name}", 1.0, 0.5, 0.75))
    exact = 1.125 * C_BASE + 0.75 / 24.0 * J_BASE
    assert bound(problem, c_at(-GAUSS, 1.125), j_at(-FLAT, 0.75 / 24.0), *parts) == pytest.approx(exact, rel=1e-12)


def test_an_equation_cancels_the_free_function() -> None:
    # b(1/2) is 3/2 in the base law and 1/8 in the free one: B alone fixes the law, and what c is at any place
    for B in (1.4, 1.6):
        for x in (-0.9, -0.2):
            free, half = 2.0 * p3(x), 1.0 / 8.0
            exact = -6.0 * x + free * (B - 1.5) / half
            assert bound(small(B=B), c_at(x, 1.0), equations=(-free / half,)) == pytest.approx(exact, rel=1e-9)
            assert charged(small(B=B), c_at(x, 1.0), equations=(free / half,)) < exact - 0.1
            # that multiplier of the equation is repaired
            assert bound(small(B=B), c_at(x, 1.0), equations=(free / half,)) == pytest.approx(exact, rel=1e-9)


def test_contacts_that_do_not_count() -> None:
    good = c_at(-GAUSS, 1.0)
    exact = bound(small(), good)
    for other in (
        c_at(-0.3, -2.0),
        Contact("J", 1.0, 0.2, 1.0),
        Contact("nothing", 1.0, 0.2, 1.0),
        Contact("ratio", 1.0, 0.2, 0.0),
    ):
        assert bound(small(), good, other) == pytest.approx(exact, rel=1e-15)
    great = replace(good, multiplier=1e308)
    assert (charged(small(), great, great), bound(small(), great, great)) == (-inf, 0.0)


def test_an_rms_in_a_direction() -> None:
    # c of the base law lies along P1: no direction proves more than its length, and P1 proves it whole
    problem = small(minimise="rms_c")
    families = model_of_leaf(Certificate.of_leaf(problem, (), ())).program.families
    matrix = next(family for family in families if family.name == "rms_c").matrix  # type: ignore[attr-defined]
    along = matrix[:, -1] / sqrt(float(matrix[:, -1] @ matrix[:, -1]))
    for length, share in ((1.0, 1.0), (0.5, 0.5), (2.0, 1.0)):
        contact = Contact("rms_c", 1.0, 0.5, 1.0, tuple(float(length * one) for one in along))
        assert bound(problem, contact) == pytest.approx(share * sqrt(12.0), rel=1e-12)


@pytest.mark.parametrize("c", [4.0, 5.0, C_BASE])
def test_a_formula_is_nowhere_below_its_tangent(c: float) -> None:
    problem = small(minimise="peak(c^2 + 2)")
    contact = Contact("peak(c^2 + 2)", 1.0, at(-GAUSS), 1.0, (c,))
    assert bound(problem, contact) == pytest.approx(2.0 + 2.0 * c * C_BASE - c * c, rel=1e-12)
    # a direction of another length is none of the formula's parts
    assert bound(problem, replace(contact, direction=(c, c))) == 0.0


# --- what constants can be in a law that contradicts a claim ---


@pytest.mark.parametrize(
    ("minimise", "least", "expected"),
    [
        ("C", {}, {"C": 6.0}),
        ("2*C", {}, {"C": 3.0}),
        ("0.5*C + 4*J", {}, {"C": 12.0, "J": 1.5}),
        ("max(C, 2*J)", {}, {"max(C, 2.0*J)": 6.0, "C": 6.0, "J": 3.0}),
        ("2*C + 0.5*max(0.25*J, 4*C)", {}, {"C": 3.0, "J": 48.0, "max(0.25*J, 4.0*C)": 12.0}),
        ("2*C + 0.5*max(0.25*J, 5*C)", {}, {"C": 2.4, "J": 48.0, "max(0.25*J, 5.0*C)": 12.0}),
        ("2*C_plus + 4*C_minus", {"C_plus": 1.0, "C_minus": -1.0}, {"C_plus": 5.0, "C_minus": 1.0}),
        ("2*C_plus + 4*C_minus", {"C_plus": 1.0, "C_minus": 4.0}, {"C_plus": 1.0, "C_minus": 4.0}),
    ],
)
@pytest.mark.parametrize("number", [float, Fraction])
def test_each_term_is_at_most_the_claim_by_its_weight(
    number: Any, minimise: str, least: dict[str, float], expected: dict[str, float]
) -> None:
    known = {name: number(least.get(name, 0)) for name in expected}
    found: dict[str, Any] = {}
    spread(expression(minimise), number(6), found, known, number)
    assert found == pytest.approx(expected, rel=1e-15)
    if number is Fraction:
        assert all(value <= found[name] <= nextafter(value, inf) for name, value in expected.items())
    if not least:
        tight = dict.fromkeys(expected, 0.5)
        spread(expression(minimise), number(6), tight, known, number)
        assert tight == dict.fromkeys(expected, 0.5)


def test_a_term_beside_one_that_may_be_anything_is_unknown() -> None:
    found: dict[str, float] = {}
    spread(expression("C + C_plus"), Fraction(6), found, {"C": Fraction(0), "C_plus": -inf}, Fraction)
    assert found == {"C": inf, "C_plus": Fraction(6)}


def sublevels(problem: Problem, program: str = "objective") -> list[tuple[Any, Any]]:
    """What constants are in laws that contradict a claim, in doubles and exactly, each with its numbers."""
    certificate = Certificate.of_leaf(problem, (), (), program)
    return [(Sublevel.of(model_of_leaf(certificate)), float), (ExactRows(certificate).sublevel, Fraction)]


@pytest.mark.parametrize(
    ("problem", "claim", "expected"),
    [
        (small(), 5, {"C": 5.0}),
        (small(), -5, {"C": 0.0}),
        (small(J=at_most(50.0), B=at_most(1.8)), 5, {"C": 5.0, "J": 50.0, "B": 1.8}),
        (small(C=at_most(4.0), minimise="C + J"), 5, {"C": 4.0, "J": 5.0}),
        (small(bounds={"rms_c": at_most(4.0)}), 5, {"C": 5.0, "rms_c": 4.0}),
        (small(D=at_most(9.0)), 5, {"C": 5.0, "D": 9.0, "root of D": 3.0}),
        (small(B=1.6, minimise="2*D"), 18, {"D": 9.0, "root of D": 3.0, "B": 1.6}),
        (FAST, 5, {"C": 5.0, "B": 5.0}),
        (replace(FAST, bounds={"rms_c": at_most(4.0)}), 5, {"C": 5.0, "rms_c": 4.0, "B": 4.0}),
        (replace(FAST, minimise="C_plus"), 5, {"C_plus": 5.0, "B": 10.0}),
        (replace(FAST, order=2, boundary=ENDS, basis=Chebyshev(3)), 5, {"C": 5.0, "B": 5.5}),
    ],
    ids=repr,
)
def test_the_greatest_constants_of_laws_that_contradict_a_claim(
    problem: Problem, claim: int, expected: dict[str, float]
) -> None:
    for sublevel, number in sublevels(problem, RELAXED if "D" in expected else "objective"):
        greatest = sublevel.greatest_values(number(claim))
        finite = {name: value for name, value in greatest.items() if value < inf}
        assert finite == pytest.approx(expected, rel=1e-14)
        assert number is float or all(value >= expected[name] for name, value in finite.items())


def test_a_contradiction_has_no_claim() -> None:
    for sublevel, number in sublevels(small(C=at_most(4.0)), VIOLATION):
        assert sublevel.greatest_values(number(7)) == {"t": 0, "C": 4}


@pytest.mark.parametrize(
    ("problem", "greatest", "expected"),
    [
        (small(), {"C": 5.0}, {2: 5.0}),
        (small(), {"C": 5.0, "rms_c": 4.0, "J": 50.0, "snap": 60.0}, {2: 4.0, 3: 50.0, 4: 60.0}),
        (small(), {"C": 5.0, "rms_j": 40.0}, {2: 5.0, 3: 40.0}),
        (small(), {"C_plus": 5.0, "rms_j": 40.0, "J": 50.0}, {2: 10.0, 3: 40.0}),
        (small(), {"C_minus": 4.0, "C_plus": 5.0}, {2: 8.0}),
        (small(), {"C_plus": -5.0}, {2: 0.0}),
        # what is above 0 less what is below is the change of velocity, -3/2
        (MOVING, {"C_plus": 5.0}, {2: 11.5}),
        (MOVING, {"C_minus": 5.0}, {2: 8.5}),
        (small(), {"B": 1.8}, {1: 2.6}),
        (small(), {"D": 9.0}, {1: 3.0}),
        (small(), {"D": 9.0, "B": 1.1}, {1: 1.2}),
        (small(minimise="D"), {"D": 4.0}, {1: 2.0}),
        (replace(MOVING, minimise="D"), {"D": 4.0}, {}),
        (small(monotone=True), {"B": 1.8}, {1: 1.0}),
        (small(), {}, {}),
    ],
    ids=repr,
)
def test_the_mean_size_of_derivatives(problem: Problem, greatest: dict[str, float], expected: dict[int, float]) -> None:
    for sublevel, number in sublevels(problem):
        means = sublevel.means({name: number(most) for name, most in greatest.items()})
        assert {nu: float(one) for nu, one in means.items()} == pytest.approx(expected, rel=1e-12)


def test_a_power_bounds_the_mean_velocity_only_from_rest() -> None:
    free = Problem(order=1, basis=Chebyshev(1))
    moving = [
        Problem(boundary=BoundaryConditions((0, speed), (1, 0)), symmetric=False, basis=Chebyshev(1))
        for speed in (0.5, -0.5)
    ]
    for problem in (*moving, free):
        certificate = Certificate.of_leaf(problem, (), ())
        assert 1 not in Sublevel.of(model_of_leaf(certificate)).means({"D": 9.0})


@pytest.mark.parametrize("x", [-GAUSS, -0.7, -0.9])
def test_a_contradiction_is_worth_what_the_base_law_breaks(x: float) -> None:
    # C <= 4 cannot be: c of every law is -6x at the root of P3, 4.65
    problem = small(C=at_most(4.0))
    proof = Certificate.of_leaf(problem, (Contact("C", 1.0, at(x), 1.0),), (), VIOLATION)
    assert proof.proves_infeasible == (x == -GAUSS)
    assert not Certificate.of_leaf(small(C=at_most(4.7)), proof.contacts, (), VIOLATION).proves_infeasible
    assert not Certificate.of_leaf(small(C=at_least(4.0)), proof.contacts, (), VIOLATION).proves_infeasible


@pytest.mark.parametrize(
    ("minimise", "least"),
    [
        # the mean of c is the change of velocity, -2: c is above it somewhere, and below it somewhere
        ("C_plus", {"C_plus": -2.0}),
        ("C_minus", {"C_minus": 2.0}),
        ("C + J", {"C": 0.0, "J": 0.0}),
        ("max(3.0*C_plus, 0.5*C_minus)", {"C_plus": -2.0, "C_minus": 2.0, "max(3.0*C_plus, 0.5*C_minus)": 1.0}),
        ("max(3.0*C_plus, 0.5*C_plus)", {"C_plus": -2.0, "max(3.0*C_plus, 0.5*C_plus)": -1.0}),
    ],
)
def test_what_constants_are_at_least_where_the_velocity_changes(minimise: str, least: dict[str, float]) -> None:
    slowing = Problem(
        boundary=BoundaryConditions((0, 2), (1, 0)), symmetric=False, basis=Chebyshev(1), minimise=minimise
    )
    assert Sublevel.of(model_of_leaf(Certificate.of_leaf(slowing, (), ()))).least_values() == pytest.approx(least)


def test_where_the_order_leaves_the_velocity_free_it_may_change_by_either_sign() -> None:
    for minimise, least in (
        ("C_plus", {"C_plus": -inf}),
        ("C_minus", {"C_minus": -inf}),
        ("max(C_plus, C_minus)", {"C_plus": -inf, "C_minus": -inf, "max(C_plus, C_minus)": 0.0}),
        ("C", {"C": 0.0}),
    ):
        problem = Problem(order=1, symmetric=False, basis=Chebyshev(1), minimise=minimise)
        assert Sublevel.of(model_of_leaf(Certificate.of_leaf(problem, (), ()))).least_values() == least


def test_means_that_grow_with_a_constant() -> None:
    model = model_of_leaf(Certificate.of_leaf(small(), (), ()))
    sublevel = Sublevel.of(model)
    assert list(sublevel.means_by("C")) == [(2, 0.0, 1.0)]
    # where the constant is 0 the line of the mean of b is minus the stroke
    assert list(sublevel.means_by("B")) == [(1, -1.0, 2.0)]
    # the root of a power does not grow in proportion
    assert list(sublevel.means_by("D")) == []


@pytest.mark.parametrize("multiplier", [0.9, 0.99])
@pytest.mark.parametrize(("share", "pays"), [(0.6, True), (0.99, True), (0.9995, True), (1.0005, False), (1.5, False)])
def test_what_a_sum_leaves_of_a_constant_pays_for_the_law_it_bounds(
    multiplier: float, share: float, *, pays: bool
) -> None:
    # a velocity may be anything below 0, so that no claim says what C is; 3.5 is the moment with P3, as above
    problem = small(minimise="C + value(b, at=0.5)")
    left = share * (1.0 - multiplier) / 3.5
    x = brentq(lambda x: multiplier * 2.0 * p3(x) + 1.0 / 8.0 - left, -1.0, -0.7)
    proven = bound(problem, c_at(x, multiplier), Contact("value(b, at=0.5)", 1.0, 0.5, 1.0))
    assert proven == (pytest.approx(-6.0 * x * multiplier + 1.5, rel=1e-12) if pays else -inf)


# --- what is no tree ---


@pytest.mark.parametrize(
    "made",
    [
        lambda problem: Certificate(problem, None, ()),
        lambda problem: Certificate(problem, None, (Leaf(), Leaf())),
        lambda problem: Certificate(problem, None, (Split(0, 0.5),)),
        lambda problem: Certificate(problem, 5.0, (Leaf(),)),
        lambda problem: Certificate(problem, None, (Leaf(),), points=(0.5,)),
        lambda problem: Certificate(problem, inf, (Leaf(),), peak="B"),
        lambda problem: Certificate(problem, 5.0, (Leaf(),), points=(0.5,), peak="B"),
        lambda problem: Certificate(problem, 5.0, (Leaf(),), points=(1.5,)),
        lambda problem: Certificate(problem, -5.0, (Leaf(),), points=(0.5,)),
        lambda problem: Certificate(problem, float("nan"), (Leaf(),), points=(0.5,)),
        lambda problem: Certificate(problem, None, (Leaf(),), tangent=inf),
        lambda problem: Certificate.of_leaf(problem, program="wishful"),
        lambda _: Leaf(equations=(inf,)),
        lambda _: Leaf(claim=float("nan")),
    ],
)
def test_what_is_neither_a_leaf_nor_a_tree_with_a_claim_is_refused(made: Any) -> None:
    with pytest.raises(InputError):
        made(small())


def test_an_infinite_claim_says_that_there_is_no_law() -> None:
    proof = Certificate(small(C=at_most(4.0)), float("inf"), (Leaf((c_at(-GAUSS, 1.0),)),))
    assert (proof.program, proof.bound, proof.proven, proof.proves_infeasible) == ("violation", -inf, True, True)


def test_a_claim_is_what_the_kind_of_proof_says() -> None:
    good = Certificate.of_leaf(small(), (c_at(-GAUSS, 1.0),))
    assert (good.claim, good.program, good.proven) == (None, "objective", True)
    none = Certificate.of_leaf(small(C=at_most(4.0)), (c_at(-GAUSS, 1.0),), (), VIOLATION)
    assert (none.claim, none.program, none.bound, none.proves_infeasible) == (inf, "violation", -inf, True)
    assert not good.with_leaf(contacts=()).proves_infeasible
    assert Certificate.from_dict(none.to_dict()) == none
    assert Certificate.from_dict(good.to_dict()) == good
