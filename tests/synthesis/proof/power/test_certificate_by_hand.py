"""Steps made by hand where one law alone is left: with one coordinate and B given, its velocity at k = 1/4 is known."""

from dataclasses import replace

import numpy as np
import pytest

from optlaws import Chebyshev, Contact, Problem, synthesize
from optlaws.synthesis.proof.power.box import Box
from optlaws.synthesis.proof.power.certificate import Cut, PowerCertificate, Step, least_sum, moved_by
from optlaws.synthesis.proof.power.rows import PowerRows

ONE_LAW = Problem(B=1.75, order=4, basis=Chebyshev(1), minimise="D")
CLAIM = 10.0
ROWS = PowerRows(ONE_LAW, CLAIM, (0.25,))
#: the only equation over the velocity v at 1/4 and D: slope v + base = 0
SLOPE, BASE = float(ROWS.equations()[0, 0]), float(ROWS.equations()[0, -1])
LAW = synthesize(ONE_LAW).law
V = LAW.b(0.25)
RAISE, LOWER = Step(0, 1, (), (-1.0 / SLOPE,)), Step(0, -1, (), (1.0 / SLOPE,))


def narrowed(low: float, high: float) -> Box:
    root = ROWS.root()
    return replace(root, low=np.array([low, root.low[1]]), high=np.array([high, root.high[1]]))


def moved(box: Box, step: Step) -> Box:
    after = moved_by(ROWS, box, step)
    assert after is not None
    return after


def test_the_equation_alone_says_what_the_velocity_is() -> None:
    assert pytest.approx(V, rel=1e-13) == -BASE / SLOPE
    assert V - 1e-10 < least_sum(ROWS, ROWS.root(), RAISE) < V
    assert -V - 1e-10 < least_sum(ROWS, ROWS.root(), LOWER) < -V


def test_a_step_moves_the_side_it_names_and_no_other() -> None:
    root = ROWS.root()
    raised, lowered = moved(root, RAISE), moved(root, LOWER)
    assert raised.low.tolist() == pytest.approx([V, 0.0], rel=1e-10)
    assert raised.low[0] < V < lowered.high[0]
    assert raised.high.tolist() == root.high.tolist()
    assert lowered.high.tolist() == pytest.approx([V, CLAIM], rel=1e-10)
    assert lowered.low.tolist() == root.low.tolist()
    # its second variable is D, of which the equation says nothing
    assert moved(root, replace(RAISE, variable=1)).low[1] == 0.0


def test_a_step_that_says_less_than_the_box_leaves_it() -> None:
    box = narrowed(V - 0.1, V + 0.1)
    for side in (1, -1):
        assert moved_by(ROWS, box, Step(0, side, (), ())) is box
        assert moved_by(ROWS, box, Step(-1, side, (), ())) is box


def test_sides_that_cross_leave_no_law() -> None:
    beyond, short = narrowed(V + 1e-6, V + 1.0), narrowed(V - 1.0, V - 1e-6)
    assert moved_by(ROWS, beyond, LOWER) is None
    assert moved_by(ROWS, short, RAISE) is None
    # each of the other steps says nothing against the box
    assert moved_by(ROWS, beyond, RAISE) is beyond
    assert moved_by(ROWS, short, LOWER) is short


def test_a_sum_above_nothing_leaves_no_law() -> None:
    empty = replace(LOWER, variable=-1)  # v - V
    assert moved_by(ROWS, narrowed(V + 1e-6, V + 1.0), empty) is None
    box = narrowed(V - 1e-6, V + 1.0)
    assert moved_by(ROWS, box, empty) is box


@pytest.mark.parametrize(("claim", "shift"), [(0.5, -0.5 * CLAIM), (2.0, -2.0 * CLAIM), (-3.0, 0.0)])
def test_the_claim_joins_with_its_weight_and_never_against_itself(claim: float, shift: float) -> None:
    # D less the claim, in a box where D is at least 0
    assert least_sum(ROWS, ROWS.root(), replace(RAISE, claim=claim)) == pytest.approx(V + shift, rel=1e-10)


def proof(claim: float, *, weight: float = 1.0) -> PowerCertificate:
    """Both sides to the one velocity, then c <= D / b there."""
    last = Step(-1, 1, (Contact("power", 1.0, 0.25, weight * V),), (), claim=weight)
    return PowerCertificate(ONE_LAW, claim, (0.25,), (RAISE, LOWER, last))


@pytest.mark.parametrize("share", [0.75, 0.9, 1.0 - 1e-6])
def test_every_claim_below_the_power_of_the_law_is_proven(share: float) -> None:
    claim = share * LAW.d(0.25)
    assert proof(claim).bound == claim


def test_no_claim_above_it_is() -> None:
    D = LAW.d(0.25)
    assert not proof(D * (1.0 + 1e-6)).proven
    assert not proof(0.9 * D, weight=-1.0).proven


def test_what_is_cut_off_is_to_be_emptied_too() -> None:
    whole = proof(5.0)
    assert whole.proven
    # the part below the one velocity is emptied by the step that raises it, the part above is as before
    assert replace(whole, steps=(Cut(0, V - 0.1), RAISE, *whole.steps)).proven
    assert replace(whole, steps=(Cut(0, V + 0.1), *whole.steps, LOWER)).proven
    assert not replace(whole, steps=(Cut(0, V - 0.1), RAISE)).proven
    assert not replace(whole, steps=(Cut(0, V + 0.1), *whole.steps)).proven


@pytest.mark.parametrize(
    "step", [Step(2, 1, (), ()), Step(-2, 1, (), ()), Step(99, -1, (), ()), Cut(-1, 1.0), Cut(2, 1.0)], ids=str
)
def test_steps_about_no_variable_prove_nothing(step: Step | Cut) -> None:
    whole = proof(5.0)
    assert not replace(whole, steps=(step, *whole.steps)).proven
    # a variable that there is changes nothing
    assert replace(whole, steps=(Step(1, 1, (), ()), *whole.steps)).proven
