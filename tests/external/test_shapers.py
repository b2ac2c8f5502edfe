"""Input shapers of others: how long they take and over which frequencies they leave little."""

from typing import Any

import numpy as np
import pytest

from optlaws import Follower, InputError, shaped_law, smoothstep
from tests.external.published import cases

FREQUENCY = 60.0
#: by how many per cent of the frequency a band may be wider than its table says, in round numbers
COARSE = 12


def left(case: dict[str, Any], damping: float, per_cent: float) -> float:
    """What a shaped law leaves beside what the law alone leaves, as fast as it runs within the shaped one."""
    law, nu = smoothstep(3), FREQUENCY * (1.0 + per_cent / 100.0)
    shaped = shaped_law(law, FREQUENCY, damping, case["name"])
    period = 2.0 * np.pi / (FREQUENCY * (1.0 - damping**2) ** 0.5)
    alone = Follower(nu * (1.0 - case["duration"] * period), damping).response(law)
    return Follower(nu, damping).response(shaped).residual_displacement / alone.residual_displacement


@pytest.mark.parametrize("case", cases("shapers"), ids=lambda case: case["name"])
def test_shapers_leave_as_little_and_take_as_long_as_their_table_says(case: dict[str, Any]) -> None:
    for band, share in (("five", 0.05), ("ten", 0.10)):
        if band in case:
            low, high = case[band]
            assert max(left(case, case["damping"], off) for off in np.linspace(low, high, 13)) <= share
            assert min(left(case, case["damping"], off) for off in (low - COARSE, high + COARSE)) > share
    with pytest.raises(InputError, match=f"takes {case['duration']:g} of a period"):
        shaped_law(smoothstep(3), 2.0 * np.pi * case["duration"], 0.0, case["name"])


@pytest.mark.parametrize("case", cases("insensitivity"), ids=lambda case: case["name"])
def test_extra_insensitive_shapers_are_as_wide_as_their_authors_say(case: dict[str, Any]) -> None:
    half = 50.0 * (case["width"] - 0.006)  # printed to two digits
    assert max(left(case, 0.0, off) for off in np.linspace(-half, half, 17)) <= 0.0501
    assert min(left(case, 0.0, off) for off in (-half - 3.0, half + 3.0)) > 0.05
