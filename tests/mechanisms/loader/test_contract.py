"""The law of a loader does what every law must do: the contract suite, run on loaders of executives of every kind."""

import inspect
from collections.abc import Callable

import numpy as np
import pytest

from optlaws.laws import MotionLaw, PolynomialLaw, smoothstep
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.sine import SineSegment
from optlaws.mechanisms.loader.law import LoaderLaw
from tests.laws import test_contract
from tests.laws.examples import cut_sine, free_function_law

COSINE = PiecewiseLaw([0, 1], [SineSegment(amplitude=np.pi**2 / 2, frequency=np.pi, phase=np.pi / 2)])
LOADERS = {
    "cosine": LoaderLaw(COSINE),
    "cycloid": LoaderLaw(cut_sine()),
    "S_2": LoaderLaw(smoothstep(2)),
    "S_4": LoaderLaw(smoothstep(4)),
    "Z of degree 5, unsymmetric": LoaderLaw(free_function_law(3, 4, 6)),
    "from moving to moving": LoaderLaw(PolynomialLaw.from_powers([0.0, 0.5, 1.5, -1.0])),
}
# laws with a break outside the middle, or acceleration without bound, leave the suite's quadratures; they have
# tests of their own
CHECKS = {
    name: check
    for name, check in vars(test_contract).items()
    if name.startswith("test_") and "law" in inspect.signature(check).parameters
}
OPTIONS = {"nu": range(4), "end": [0.1, 0.5, 0.83, 1.0], "k": [0.21, 0.5, 0.87]}
WRONG = {
    "test_k_outside_the_interval_is_refused": [-1e-9, 1.5, np.nan, "0.5", None],
    "test_orders_of_derivatives_are_integers_from_0": [-1, 1.0, "1", None, True],
}


def cases(name: str, check: Callable[..., None]) -> list[dict[str, object]]:
    found: list[dict[str, object]] = [{}]
    for argument in (one for one in inspect.signature(check).parameters if one != "law"):
        values = WRONG.get(name, OPTIONS[argument])
        found = [{**one, argument: value} for one in found for value in values]
    return found


@pytest.mark.parametrize("law", LOADERS.values(), ids=LOADERS.keys())
@pytest.mark.parametrize("name", CHECKS)
def test_the_contract_holds(name: str, law: MotionLaw) -> None:
    for case in cases(name, CHECKS[name]):
        CHECKS[name](law=law, **case)
