"""Sums of weighted rows against exact ones."""

from fractions import Fraction

import numpy as np

from tests.internals.synthesis import sums_of_rows


def test_sums_that_cancel_are_rounded_once() -> None:
    rng = np.random.default_rng(5)
    weights, rows = rng.normal(size=(6, 9)) * 1e9, rng.normal(size=(6, 9, 4))
    # the last row takes away nearly all that the others add
    rows[:, -1] = -np.einsum("lr,lrn->ln", weights[:, :-1], rows[:, :-1]) / weights[:, -1:]
    found = sums_of_rows(np.ones(4), weights, rows)
    for law in range(6):
        for n in range(4):
            exactly = [[Fraction(float(one)) for one in some] for some in (weights[law], rows[law, :, n])]
            parts = [weight * entry for weight, entry in zip(*exactly, strict=True)]
            exact = 1 + sum(parts)
            most = Fraction(2.0**-53) * abs(exact) + Fraction(2.0**-96) * sum(map(abs, parts))
            assert abs(Fraction(float(found[law, n])) - exact) <= most
