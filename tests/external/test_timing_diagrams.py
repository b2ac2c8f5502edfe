"""The timing diagram of a published machine, an indexing table under a die: what overlapping motions gain."""

import pytest
from scipy.optimize import brentq

from optlaws import Cycle, Dwell, Return, Rise, catalogue
from tests.external.published import numbers


def test_a_die_that_moves_while_its_table_does_needs_a_fifth_of_the_acceleration() -> None:
    """Its ways within the table and its dwell fill the time for which the table rests."""
    case, law = numbers()["timing_diagram"], catalogue["cycloidal"].law
    assert law(0.1) == pytest.approx(case["share_at_a_tenth"], abs=5e-5)
    enters = brentq(lambda k: float(law(k)) - case["above"] / 50, 0.0, 1.0)
    rest = 360 - case["table"]
    longest = (rest - 100) / (2 * (1 - enters))

    def acceleration(way: float) -> float:
        angle = f"{way} deg"
        moves = [Rise("50 mm", angle, law="cycloidal"), Dwell("100 deg"), Return("50 mm", angle, law="cycloidal")]
        return Cycle([*moves, Dwell()], speed="60 rpm").peak(2)

    assert rest == 100 + 2 * case["way"]
    assert acceleration(case["way"]) / acceleration(longest) == pytest.approx(case["gain"], rel=0.04)
