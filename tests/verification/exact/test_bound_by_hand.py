"""Exact bounds of certificates made by hand, and what constants can be in laws that contradict a claim.

The laws are those of tests/synthesis/proof/test_certificate_by_hand.py: a base law with c = -6x and a multiple of one
with c = 2 P3(x), x = 2k - 1.
"""

from dataclasses import replace
from fractions import Fraction
from math import inf
from typing import Any

import pytest
from scipy.optimize import brentq

from optlaws import (
    BoundaryConditions,
    Certificate,
    Chebyshev,
    Contact,
    InputError,
    Link,
    Machine,
    Pieces,
    Problem,
    Window,
    at_most,
    peak,
    synthesize,
    via,
)
from optlaws.verification import exact_bound
from tests.internals.synthesis import VIOLATION
from tests.internals.verification import Along, ExactRows, prove
from tests.synthesis.proof.test_certificate_by_hand import C_BASE, GAUSS, c_at

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


def test_multipliers_that_do_not_add_up_are_charged() -> None:
    # with less than the weight the bound is less by as much; beyond it the claim is, and a tenth of it is charged
    assert proven(small(), c_at(-GAUSS, 0.9)) == pytest.approx(0.9 * C_BASE, rel=1e-12)
    assert proven(small(), c_at(-GAUSS, 1.1)) == pytest.approx(1.1 * C_BASE * (1.0 - 0.1), rel=1e-12)
    assert proven(small(), c_at(-GAUSS, 1.0), c_at(GAUSS, 0.5)) <= C_BASE * (1.0 + 1e-14)


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


def test_peaks_of_one_sign_may_be_negative_where_the_velocity_changes() -> None:
    turned = Certificate.of_leaf(small(**MOVING, minimise="2*C_plus + 3*max(C_minus, C_plus)"))
    least = ExactRows(turned).sublevel.least_values()
    assert least == {"C_plus": -1.5, "C_minus": 1.5, "max(C_minus, C_plus)": 1.5}
    assert prove(turned).value == Fraction(3, 2)
    free = small(order=1, minimise="C_plus", symmetric=False)
    assert ExactRows(Certificate.of_leaf(free)).sublevel.least_values() == {"C_plus": -inf}
    assert ExactRows(Certificate.of_leaf(small(minimise="C_plus"))).sublevel.least_values() == {"C_plus": 0}


def test_along_a_number_on_a_right_side_bounds_rise_as_the_optimum_and_along_others_there_are_none() -> None:
    problem = Problem(order=3, basis=Chebyshev(7), windows=(via("a", 0.25, at=0.4),), symmetric=False)
    solution = synthesize(problem)

    def along(window: Window) -> Any:
        step = replace(problem, windows=(window,))
        return step, prove(solution.certificate, Along(step, Fraction(1, 128), problem, 2.0 * solution.objective))

    step, proof = along(via("a", 0.25 + 1 / 128, at=0.4))
    low, high = map(float, proof.slope)
    there = synthesize(step).objective
    assert low <= high < low + 1e-9 * abs(low)
    assert there - 2e-2 * abs(high) / 128 <= float(proof.value) + high / 128 <= there * (1.0 + 1e-9)
    with pytest.raises(InputError, match="the number changes coefficients of constraints"):
        along(via("a", 0.25, at=0.4 + 1 / 128))


def test_a_formula_that_jumps_where_its_part_ends_is_taken_from_before() -> None:
    limit = peak("c*(1 + k)", stop=0.3)
    problem = Problem(order=2, basis=Pieces((0.0, 0.3, 0.7, 1.0), 4, 1), symmetric=False, bounds={limit: at_most(1.0)})
    rows = ExactRows(Certificate.of_leaf(problem, (), ()))
    at_end, before = (rows.row(Contact(limit.name, 1.0, k, 1.0)) for k in (0.3, 0.3 - 1e-9))
    assert at_end is not None
    assert before is not None
    assert list(map(float, at_end.functions)) == pytest.approx(list(map(float, before.functions)), abs=1e-6)
    solution = synthesize(problem)
    assert exact_bound(solution.certificate) == pytest.approx(solution.objective, rel=1e-9)
