"""Active sets: contacts that are one, and sides of a break, which are two."""

import numpy as np

from tests.internals.synthesis import ActiveSet


def test_contacts_on_both_sides_of_a_break_stay_two() -> None:
    """Snap jumps at a break of pieces: one contact for both sides would leave one of them without a bound."""
    sides = (0.5 - 2.0**-50, 0.5)
    contacts = [(0, u, 1.0, False, 1.0) for u in sides]
    beside = [(0, 0.2, 1.0, True, 1.0), (0, 0.2 + 1e-12, 1.0, True, 1.0)]
    state = ActiveSet.of_contacts(np.zeros(1), [*beside, *contacts], np.zeros(0))
    merged = state.merged(1e-6)
    assert merged.u[1:].tolist() == list(sides)
    assert len(merged.u) == 3
