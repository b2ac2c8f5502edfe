"""The constants of a law as a value and as plain data."""

from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from optlaws import Constants, Peak


def test_peaks_are_values() -> None:
    one, again = (Constants(Peak(1.0, 0.1), Peak(2.0, 0.2), Peak(3.0, 0.3), Peak(4.0, 0.4), 2.0) for _ in range(2))
    assert {one: one.B}[again] == Peak(1.0, 0.1)
    with pytest.raises(FrozenInstanceError):
        one.rms_c = 3.0  # type: ignore[misc]


def test_constants_as_plain_data() -> None:
    constants = Constants(Peak(1.0, 0.1), Peak(2.0, 0.2), Peak(3.0, 0.3), Peak(np.inf, 0.4), np.inf)
    plain = {"B": {"value": 1.0, "k": 0.1}, "C": {"value": 2.0, "k": 0.2}, "D": {"value": 3.0, "k": 0.3}}
    assert constants.to_dict(rms=False) == plain | {"J": {"value": None, "k": 0.4}}
    assert constants.to_dict() == plain | {"J": {"value": None, "k": 0.4}, "rms_c": None}
    assert Constants(constants.B, constants.C, constants.D, constants.J, 2.5).to_dict(rms=True)["rms_c"] == 2.5
