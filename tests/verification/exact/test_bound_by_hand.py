"""Exact bounds of certificates made by hand, and what constants can be in laws that contradict a claim.

The laws are those of tests/synthesis/proof/test_certificate_by_hand.py: a base law with c = -6x and a multiple of one
with c = 2 P3(x), x = 2k - 1.
"""

from dataclasses import replace
from fractions import Fraction
from math import inf, nextafter
from typing import Any

import pytest
from scipy.optimize import brentq

from optlaws import (
    BoundaryConditions,
    Certificate,
    Chebyshev,
    Contact,
    Link,
    Machine,
    Problem,
    at_least,
    at_most,
    synthesize,
)
from optlaws.verification import exact_bound
from tests.internals.synthesis import RELAXED, VIOLATION, expression, spread
from tests.internals.verification import ExactRows, prove
from tests.synthesis.proof.test_certificate_by_hand import C_BASE, FLAT, GAUSS, J_BASE, c_at, j_at

pytestmark = pytest.mark.filterwarnings("ignore::optlaws.errors.NotNormalised")
MOVING = {"boundary": BoundaryConditions((0, 0.5), (1, -1)), "symmetric": False}


def small(**asked: Any) -> Problem:
    order: dict[str, Any] = {} if "boundary" in asked else {"order": 2}
    return Problem(**{**order, "basis": Chebyshev(1), **asked})


def proven(problem: Problem, *contacts: Contact, equations: tuple[float, ...] = ()) -> float:
    value = exact_bound(Certificate.of_leaf(problem, contacts, equations))
    assert value is not None
    return float(value)


def test_the_bound_of_one_contact_is_exact() -> None:
    proof = prove(Certificate.of_leaf(small(), (c_at(-GAUSS, 1.0),), ()))
    assert float(proof.value or 0) == pytest.approx(C_BASE, rel=1e-14)
    assert (proof.negative, proof.unknown) == (0, 0)
    # what rounding of the root leaves of the slope by the free function
    assert 0.0 < proof.charge < 1e-14
    assert proven(small(minimise="0.5*C"), c_at(-GAUSS, 0.5)) == pytest.approx(C_BASE / 2.0, rel=1e-14)
    assert proven(small(minimise="0.25*C + 2*J"), c_at(-GAUSS, 0.25), j_at(-FLAT, 2.0)) == pytest.approx(
        0.25 * C_BASE + 2.0 * J_BASE, rel=1e-14
    )


def test_multipliers_that_do_not_add_up_are_charged() -> None:
    # with less than the weight the bound is less by as much; beyond it the claim is, and a tenth of it is charged
    assert proven(small(), c_at(-GAUSS, 0.9)) == pytest.approx(0.9 * C_BASE, rel=1e-12)
    assert proven(small(), c_at(-GAUSS, 1.1)) == pytest.approx(1.1 * C_BASE * (1.0 - 0.1), rel=1e-12)
    assert proven(small(), c_at(-GAUSS, 1.0), c_at(GAUSS, 0.5)) <= C_BASE * (1.0 + 1e-14)


def test_the_parts_of_a_maximum_share_its_weight() -> None:
    name = "max(0.5*C, 0.041666666666666664*J)"
    parts = (Contact(f"part 1 of {name}", 1.0, 0.5, 0.25), Contact(f"part 2 of {name}", 1.0, 0.5, 0.75))
    proof = proven(small(minimise="C + max(C/2, J/24)"), c_at(-GAUSS, 1.125), j_at(-FLAT, 0.75 / 24.0), *parts)
    assert proof == pytest.approx(1.125 * C_BASE + 0.75 / 24.0 * J_BASE, rel=1e-12)


def test_a_fixed_b_makes_every_place_a_contact() -> None:
    for x in (-0.9, -0.2):
        free = 5.0 * x**3 - 3.0 * x
        proof = proven(small(B=1.6), c_at(x, 1.0), equations=(-8.0 * free,))
        assert proof == pytest.approx(-6.0 * x + 0.8 * free, rel=1e-9)


def test_contacts_that_do_not_count_are_counted() -> None:
    others = (c_at(-0.3, -2.0), c_at(-0.2, -1.0), Contact("J", 1.0, 0.2, 1.0), Contact("nothing", 1.0, 0.2, 1.0))
    proof = prove(Certificate.of_leaf(small(), (c_at(-GAUSS, 1.0), *others), ()))
    assert (proof.negative, proof.unknown) == (2, 2)
    assert float(proof.value or 0) == pytest.approx(C_BASE, rel=1e-14)


def test_without_contacts_a_constant_is_at_least_0() -> None:
    assert prove(Certificate.of_leaf(small(), (), ())).value == 0
    assert prove(Certificate.of_leaf(small(C=at_most(4.0)), (), (), VIOLATION)).value in {None, 0}


def test_a_contradiction_is_measured() -> None:
    contact = c_at(-GAUSS, 1.0)
    value = exact_bound(Certificate.of_leaf(small(C=at_most(4.0)), (contact,), (), VIOLATION))
    assert value is not None
    assert value > 0
    feasible = exact_bound(Certificate.of_leaf(small(C=at_most(4.7)), (contact,), (), VIOLATION))
    assert feasible is None or feasible <= 0


@pytest.mark.parametrize("times", [8, 64])
def test_a_charge_is_in_units_of_the_objective(times: int) -> None:
    def charged(times: int) -> tuple[float, float]:
        minimise = f"peak({times}*c)"
        contact = Contact(minimise, 1.0, (1.0 - 0.776) / 2.0, 1.0)
        proof = prove(Certificate.of_leaf(small(minimise=minimise), (contact,), ()))
        return float(proof.value or 0), proof.charge

    value, charge = charged(1)
    assert charge > 0.1
    assert charged(times) == pytest.approx((times * value, times * charge), rel=1e-9)


@pytest.mark.parametrize("multiplier", [0.9, 0.99])
@pytest.mark.parametrize("share", [0.3, 0.6, 1.01, 1.5, 3.0])
def test_what_a_sum_leaves_of_a_constant_pays_for_the_law_it_bounds(multiplier: float, share: float) -> None:
    # a velocity may be anything below 0, so that no claim says what C is; the moment of the free function is 2/7
    left = share * (1.0 - multiplier) / 3.5
    x = brentq(lambda x: multiplier * (5.0 * x**3 - 3.0 * x) + 1.0 / 8.0 - left, -1.0, -0.7)
    contacts = (c_at(x, multiplier), Contact("value(b, at=0.5)", 1.0, 0.5, 1.0))
    value = exact_bound(Certificate.of_leaf(small(minimise="C + value(b, at=0.5)"), contacts, ()))
    if share > 1.0:
        assert value is None
    else:
        assert float(value or 0) == pytest.approx(-6.0 * x * multiplier + 1.5, rel=1e-12)


@pytest.mark.parametrize("multiplier", [0.9, 0.99])
@pytest.mark.parametrize("share", [0.3, 0.49, 0.51, 0.9, 1.5, 3.0])
def test_a_constant_of_one_sign_pays_twice_for_the_law_it_bounds(multiplier: float, share: float) -> None:
    # what is above 0 and what is below are as large: the mean size of c is at most twice C_plus
    left = share * (1.0 - multiplier) / 3.5
    x = brentq(lambda x: multiplier * (5.0 * x**3 - 3.0 * x) + 1.0 / 8.0 - left, -1.0, -0.7)
    highest = Contact("C_plus", 1.0, (1.0 + x) / 2.0, multiplier)
    contacts = (highest, Contact("value(b, at=0.5)", 1.0, 0.5, 1.0))
    value = exact_bound(Certificate.of_leaf(small(minimise="C_plus + value(b, at=0.5)"), contacts, ()))
    if share > 0.5:
        assert value is None
    else:
        assert float(value or 0) == pytest.approx(-6.0 * x * multiplier + 1.5, rel=1e-12)


@pytest.mark.parametrize("minimise", ["C + value(b, at=0.5)", "C_plus + value(b, at=0.5)", "J + value(b, at=0.5)"])
def test_where_no_claim_bounds_the_laws_the_optimum_is_proven(minimise: str) -> None:
    # a velocity may be anything below 0, so that no claim says what the others are
    solution = synthesize(small(minimise=minimise))
    sublevel = ExactRows(solution.certificate).sublevel
    assert not sublevel.means(sublevel.greatest_values(Fraction(solution.objective)))
    proof = prove(solution.certificate)
    assert float(proof.value or 0) == pytest.approx(solution.objective, rel=1e-9)
    assert float(proof.value or 0) <= solution.objective
    first, *others = solution.certificate.contacts
    heavier = solution.certificate.with_leaf(contacts=(replace(first, multiplier=1.01 * first.multiplier), *others))
    bound = prove(heavier).value
    assert bound is None or bound <= solution.objective


def test_an_output_that_alone_says_how_large_the_law_is_proves_its_own_least_mean() -> None:
    machine = Machine.from_masses(
        {"motor": 0.8e-4, "carriage": 2.4e-4},
        [Link("motor", "carriage", 9.0, 0.0018)],
        drive="motor",
        outputs={"torque": "drive force"},
        duration=0.1,
        stroke=4.0,
    )
    problem = small(order=3, symmetric=False, minimise=machine.rms("torque", cycle=(0.2, 0.3)))
    solution = synthesize(problem)
    assert ExactRows(solution.certificate).sublevel.means({}) == {}
    assert exact_bound(solution.certificate) == pytest.approx(solution.objective, rel=1e-9)


def test_a_tree_that_holds_proves_its_claim_by_rows() -> None:
    tree = synthesize(Problem(B=1.641, order=4, minimise="D"), bound="tight").power_certificate
    assert tree is not None
    proof = prove(tree)
    assert proof.value == Fraction(tree.claim or 0)
    assert (proof.charge, proof.negative, proof.unknown) == (0.0, 0, 0)
    assert proof.by_rows
    assert not prove(Certificate.of_leaf(small(), (), ())).by_rows
    assert prove(replace(tree, claim=2.0 * (tree.claim or 0))).value is None


# --- what constants can be ---


def above(value: float) -> float:
    """Rounded up by one unit at most."""
    return nextafter(value, inf)


@pytest.mark.parametrize(
    ("minimise", "least", "expected"),
    [
        ("C", {}, {"C": 6.0}),
        ("2*C", {}, {"C": 3.0}),
        ("0.5*C + 4*J", {}, {"C": 12.0, "J": 1.5}),
        ("2*C + 0.5*max(0.25*J, 4*C)", {}, {"C": 3.0, "J": 48.0, "max(0.25*J, 4.0*C)": 12.0}),
        ("2*C_plus + 4*C_minus", {"C_plus": 1.0, "C_minus": -1.0}, {"C_plus": 5.0, "C_minus": 1.0}),
        ("2*C_plus + 4*C_minus", {"C_plus": Fraction(1), "C_minus": Fraction(4)}, {"C_plus": 1.0, "C_minus": 4.0}),
    ],
)
def test_each_term_is_at_most_the_claim_by_its_weight(
    minimise: str, least: dict[str, Any], expected: dict[str, float]
) -> None:
    found: dict[str, float] = {}
    exact = {name: Fraction(least.get(name, 0)) for name in expected}
    spread(expression(minimise), Fraction(6), found, exact, Fraction)
    assert set(found) == set(expected)
    for name, value in expected.items():
        assert value <= found[name] <= above(value)
    tight = dict.fromkeys(expected, 0.5)
    if not least:
        spread(expression(minimise), Fraction(6), tight, exact, Fraction)
        assert tight == dict.fromkeys(expected, 0.5)


def test_a_term_beside_one_that_may_be_anything_is_unknown() -> None:
    found: dict[str, float] = {}
    spread(expression("C + C_plus"), Fraction(6), found, {"C": Fraction(0), "C_plus": -inf}, Fraction)
    assert found == {"C": inf, "C_plus": Fraction(6)}


@pytest.mark.parametrize(
    ("problem", "expected"),
    [
        (small(), {"C": 5.0}),
        (small(J=at_most(50.0), B=at_most(1.8)), {"C": 5.0, "J": 50.0, "B": 1.8}),
        (small(C=at_most(4.0), minimise="C + J"), {"C": 4.0, "J": 5.0}),
        (small(D=at_most(9.0)), {"C": 5.0, "D": 9.0, "root of D": 3.0}),
        (small(symmetric=False, inflexion=0.4, B=at_least(1.2)), {"C": 5.0, "B": 5.0}),
        (
            small(symmetric=False, inflexion=0.4, B=at_least(1.2), bounds={"rms_c": at_most(4.0)}),
            {"C": 5.0, "rms_c": 4.0, "B": 4.0},
        ),
        (small(**MOVING, inflexion=0.4, B=at_least(1.2)), {"C": 5.0, "B": 5.5}),
    ],
    ids=repr,
)
def test_the_greatest_constants_of_laws_that_contradict_a_claim(problem: Problem, expected: dict[str, float]) -> None:
    certificate = Certificate.of_leaf(problem, (), (), RELAXED if "D" in expected else "objective")
    greatest = ExactRows(certificate).sublevel.greatest_values(Fraction(5))
    finite = {name: value for name, value in greatest.items() if value < inf}
    assert finite == pytest.approx(expected, rel=1e-14)
    assert all(value >= expected[name] for name, value in finite.items())


def test_a_contradiction_has_no_claim() -> None:
    certificate = Certificate.of_leaf(small(C=at_most(4.0)), (), (), VIOLATION)
    assert ExactRows(certificate).sublevel.greatest_values(Fraction(7)) == {"C": 4, "t": 0}


@pytest.mark.parametrize(
    ("problem", "greatest", "expected"),
    [
        (small(), {"C": 5.0}, {2: 5.0}),
        (small(), {"C": 5.0, "rms_c": 4.0, "J": 50.0, "snap": 60.0}, {2: 4.0, 3: 50.0, 4: 60.0}),
        (small(), {"C": 5.0, "rms_j": 40.0}, {2: 5.0, 3: 40.0}),
        (small(), {"C_plus": 5.0}, {2: 10.0}),
        (small(), {"C_minus": 4.0, "C_plus": 5.0}, {2: 8.0}),
        (small(), {"C_plus": -5.0}, {2: 0.0}),
        # what is above 0 less what is below is the change of velocity, -3/2
        (small(**MOVING), {"C_plus": 5.0}, {2: 11.5}),
        (small(**MOVING), {"C_minus": 5.0}, {2: 8.5}),
        (small(), {"B": 1.8}, {1: 2.6}),
        (small(monotone=True), {"B": 1.8}, {1: 1.0}),
        (small(minimise="D"), {"D": 4.0}, {1: 2.0}),
        (small(**MOVING, minimise="D"), {"D": 4.0}, {}),
        (small(), {}, {}),
    ],
    ids=repr,
)
def test_the_mean_size_of_derivatives(problem: Problem, greatest: dict[str, float], expected: dict[int, float]) -> None:
    exact = {name: Fraction(most) for name, most in greatest.items()}
    mean_values = ExactRows(Certificate.of_leaf(problem, (), ())).sublevel.means(exact)
    assert {nu: float(one) for nu, one in mean_values.items()} == pytest.approx(expected, rel=1e-14)


def test_peaks_of_one_sign_may_be_negative_where_the_velocity_changes() -> None:
    turned = Certificate.of_leaf(small(**MOVING, minimise="2*C_plus + 3*max(C_minus, C_plus)"))
    least = ExactRows(turned).sublevel.least_values()
    assert least == {"C_plus": -1.5, "C_minus": 1.5, "max(C_minus, C_plus)": 1.5}
    assert prove(turned).value == Fraction(3, 2)
    free = small(order=1, minimise="C_plus", symmetric=False)
    assert ExactRows(Certificate.of_leaf(free)).sublevel.least_values() == {"C_plus": -inf}
    assert ExactRows(Certificate.of_leaf(small(minimise="C_plus"))).sublevel.least_values() == {"C_plus": 0}
