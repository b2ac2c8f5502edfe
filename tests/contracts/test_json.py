"""What leaves the library as JSON is JSON: no Infinity and no NaN, whatever jumps a law has."""

import json
from dataclasses import replace
from typing import Any, NoReturn

import pytest

import optlaws
from optlaws import Chebyshev, Pieces, Powers, Problem, Solution, Window, deg, pareto_front, synthesize, verification
from tests.laws.examples import EXAMPLES

#: an acceleration that jumps: J has no bound
JUMPS = Problem(order=2, basis=Pieces(degree=3, breaks=4, continuity=1), B=1.8)


def refuse(constant: str) -> NoReturn:
    raise AssertionError(f"{constant} is not JSON")


def strict(text: str) -> object:
    return json.loads(text, parse_constant=refuse)


@pytest.fixture(scope="module")
def jumping() -> Solution:
    return synthesize(JUMPS)


def test_an_infinite_constant_is_null(jumping: Solution) -> None:
    assert jumping.constants.J.value == float("inf")
    assert jumping.to_dict()["constants"]["J"]["value"] is None
    assert jumping.constants.to_dict(rms=True)["J"] == jumping.constants.J.to_dict()


@pytest.mark.parametrize("name", EXAMPLES)
def test_laws_and_their_constants(name: str) -> None:
    law = EXAMPLES[name]
    assert strict(json.dumps([law.to_dict(), law.constants.to_dict(rms=True)]))


def values(jumping: Solution) -> dict[str, Any]:
    """A value of every kind that gives plain data, each with something infinite in it where it can have it."""
    mechanism = optlaws.dwell_mechanism(
        "I",
        law=optlaws.catalogue["K"].law,
        dwell=deg(120),
        rise=deg(90),
        swing=deg(20),
        clutch_angle=deg(15),
        radius_ratio=1.0,
        inertia_ratio=0.1,
    )
    return {
        "Solution": jumping,
        "Problem": jumping.problem,
        "Basis": jumping.problem.basis,
        "Certificate": jumping.certificate,
        "Certificate of boxes": synthesize(
            Problem(order=2, basis=Powers(3), B=1.8, minimise="D"), bound="tight"
        ).power_certificate,
        "Front": pareto_front(replace(JUMPS, B=None), points=2, between=(1.7, 1.9)),
        "Window": Window("b", high=1.9),
        "Loader": optlaws.loader(optlaws.catalogue["0050"].law),
        "BalancedLaw": optlaws.balanced_law(order=4, B=1.8, basis=Chebyshev(3)),
        "DwellMechanism": mechanism,
        "Verification": verification.verify(jumping.to_dict()),
        "Entry": optlaws.catalogue["constant velocity"],
        "Segment": EXAMPLES["power of time"].segments[0],  # type: ignore[attr-defined] # a piecewise law
    }


def test_every_value(jumping: Solution) -> None:
    for name, value in values(jumping).items():
        assert strict(json.dumps(value.to_dict())), name
