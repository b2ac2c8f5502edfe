"""Nodes made by hand where one law alone is left: with one coordinate and B given, its velocity at k = 1/4 is known."""

from dataclasses import replace

import numpy as np
import pytest

from optlaws import Certificate, Chebyshev, Contact, Leaf, Problem, Split, Tightening, synthesize
from tests.internals.synthesis import Box, PowerRows, Region

ONE_LAW = Problem(B=1.75, order=4, basis=Chebyshev(1), minimise="D")
CLAIM = 10.0
ROWS = PowerRows(ONE_LAW, CLAIM, (0.25,))
#: the only equation over the velocity v at 1/4 and D: slope v + base = 0
SLOPE, BASE = float(ROWS.equations()[0, 0]), float(ROWS.equations()[0, -1])
LAW = synthesize(ONE_LAW).law
V = LAW.b(0.25)
RAISE, LOWER = (Tightening((), (-side / SLOPE,), variable=0, side=side) for side in (1, -1))


def narrowed(low: float, high: float) -> Box:
    root = ROWS.root()
    return replace(root, low=np.array([low, root.low[1]]), high=np.array([high, root.high[1]]))


def moved(box: Box, node: Leaf) -> Box:
    (after,) = ROWS.moved(box, node)
    return after


def leaves_as_it_is(box: Box, node: Leaf) -> bool:
    return moved(box, node) is box


def test_the_equation_alone_says_what_the_velocity_is() -> None:
    assert pytest.approx(V, rel=1e-13) == -BASE / SLOPE
    assert V - 1e-10 < ROWS.least_sum(ROWS.root(), RAISE) < V
    assert -V - 1e-10 < ROWS.least_sum(ROWS.root(), LOWER) < -V


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
        assert leaves_as_it_is(box, Tightening(variable=0, side=side))
    assert leaves_as_it_is(box, Leaf())


def test_sides_that_cross_leave_no_law() -> None:
    beyond, short = narrowed(V + 1e-6, V + 1.0), narrowed(V - 1.0, V - 1e-6)
    assert ROWS.moved(beyond, LOWER) == []
    assert ROWS.moved(short, RAISE) == []
    # each of the other steps says nothing against the box
    assert leaves_as_it_is(beyond, RAISE)
    assert leaves_as_it_is(short, LOWER)


def test_a_node_counts_only_where_the_box_is_empty_with_either_rounding() -> None:
    whole, below = narrowed(V - 1.0, V + 1.0), narrowed(V - 1.0, V - 1e-9)
    lowest, highest = (ROWS.least_sum(whole, RAISE, rounded=rounded) for rounded in (-1, 1))
    assert lowest < V < highest < lowest + 1e-10
    empty, unsure = Region(below, below), Region(*[narrowed(V - 1.0, (V + lowest) / 2)] * 2)
    assert empty.moved(ROWS, RAISE) is None
    assert ROWS.moved(unsure.box, RAISE), "rounded down it is not empty"
    assert not ROWS.moved(unsure.inner, RAISE, rounded=1), "rounded up it is"
    assert unsure.moved(ROWS, RAISE) is unsure
    both = Region(whole, whole).moved(ROWS, RAISE)
    assert both is not None
    assert (both.box.low[0], both.inner.low[0]) == (lowest, highest)


def test_a_sum_above_nothing_leaves_no_law() -> None:
    empty = Leaf((), LOWER.equations)  # v - V
    assert ROWS.moved(narrowed(V + 1e-6, V + 1.0), empty) == []
    box = narrowed(V - 1e-6, V + 1.0)
    assert leaves_as_it_is(box, empty)


@pytest.mark.parametrize(("claim", "shift"), [(0.5, -0.5 * CLAIM), (2.0, -2.0 * CLAIM), (-3.0, 0.0)])
def test_the_claim_joins_with_its_weight_and_never_against_itself(claim: float, shift: float) -> None:
    # D less the claim, in a box where D is at least 0
    assert ROWS.least_sum(ROWS.root(), replace(RAISE, claim=claim)) == pytest.approx(V + shift, rel=1e-10)


def proof(claim: float, *, weight: float = 1.0) -> Certificate:
    """Both sides to the one velocity, then c <= D / b there."""
    last = Leaf((Contact("power", 1.0, 0.25, weight * V),), claim=weight)
    return Certificate(ONE_LAW, claim, (RAISE, LOWER, last), points=(0.25,))


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
    assert replace(whole, tree=(Split(0, V - 0.1), RAISE, *whole.tree)).proven
    assert replace(whole, tree=(Split(0, V + 0.1), *whole.tree, LOWER)).proven
    assert not replace(whole, tree=(Split(0, V - 0.1), RAISE)).proven
    assert not replace(whole, tree=(Split(0, V + 0.1), *whole.tree)).proven


@pytest.mark.parametrize(
    "node",
    [*(Tightening(variable=variable, side=1) for variable in (2, -2, 99)), Split(-1, 1.0), Split(2, 1.0)],
    ids=str,
)
def test_nodes_about_no_variable_prove_nothing(node: Leaf | Split) -> None:
    whole = proof(5.0)
    assert not replace(whole, tree=(node, *whole.tree)).proven
    # a variable that there is changes nothing
    assert replace(whole, tree=(Tightening(variable=1, side=1), *whole.tree)).proven
