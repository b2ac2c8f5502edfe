"""The constants of a law as a value, as plain data and in pickles of before."""

import base64
import pickle
from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from optlaws.laws import Constants, Peak, smoothstep

# of smoothstep(2), made where `Constants` stood beside the peaks of a function
PICKLED = (
    "fCQDW000000001t6mM{JY+-kEE^}paX=QURaAjd@bCiq;LvL<#bYX6EbCi>mDS?z-lqhHbj08|+VQZ9=lqrFfU6d$CKllIu00000"
    "M?c^I000000A*rm1}TA*U6d$CKo|f300000M*si-000000A*rm1}TA*U6d$CKnu2d=vYjvM?cF9v2@>=#${q?1}TA*U6d$CKqvqJ"
    "00000M*si-000000A*rFKnu2d=vYjuWnwM"
)


def test_peaks_are_values() -> None:
    one, again = (Constants(Peak(1.0, 0.1), Peak(2.0, 0.2), Peak(3.0, 0.3), Peak(4.0, 0.4), 2.0) for _ in range(2))
    assert {one: one.B}[again] == Peak(1.0, 0.1)
    with pytest.raises(FrozenInstanceError):
        one.rms_c = 3.0  # type: ignore[misc]


def test_constants_as_plain_data() -> None:
    constants = Constants(Peak(1.0, 0.1), Peak(2.0, 0.2), Peak(3.0, 0.3), Peak(np.inf, 0.4), np.inf)
    plain = {"B": {"value": 1.0, "k": 0.1}, "C": {"value": 2.0, "k": 0.2}, "D": {"value": 3.0, "k": 0.3}}
    assert constants.to_dict() == plain | {"J": {"value": None, "k": 0.4}}
    assert constants.to_dict() == plain | {"J": {"value": None, "k": 0.4}, "rms_c": None}
    assert Constants(constants.B, constants.C, constants.D, constants.J, 2.5).to_dict(rms=True)["rms_c"] == 2.5


def test_a_pickle_names_the_place_where_constants_stood_before() -> None:
    assert pickle.loads(base64.b85decode(PICKLED)) == smoothstep(2).constants  # noqa: S301
