"""Random problems over everything that can be asked: objectives, constants, orders, bases, degrees, ends."""

from dataclasses import replace

import numpy as np

from optlaws import (
    Bernstein,
    BoundaryConditions,
    BSplines,
    C,
    Chebyshev,
    D,
    J,
    Pieces,
    Powers,
    Problem,
    Range,
    at_least,
    at_most,
    between,
)
from tests.synthesis.independent import polynomial

CONVEX = (
    "C",
    "J",
    "snap",
    "rms_c",
    "rms_j",
    "C_plus",
    "C_minus",
    "0.5*C/4 + 0.5*J/32",
    "max(C/4, J/32)",
    "C/4 + max(J/32, rms_c/3.5)",
    "0.3*rms_c/3.5 + 0.7*C/4",
)
CURVED = ("D", "0.6*C/4 + 0.4*D/2.25", "max(C/4, D/2.25)", "D/2.25 + 0.1*J/32")
FREE, FIXED, BETWEEN, AT_MOST, AT_LEAST = range(5)


def random_problem(numbers: np.random.Generator) -> Problem:
    """One of them; most have a law."""
    order = int(numbers.integers(2, 6))
    degree = int(numbers.integers(5, 16))
    curved = numbers.random() < 0.3
    minimise = str(numbers.choice(CURVED if curved else CONVEX))
    monotone = bool(numbers.random() < 0.4)
    general = numbers.random() < 0.2
    boundary = None
    if general:
        boundary = BoundaryConditions(*(_end(numbers, place, order) for place in (0.0, 1.0)))
        monotone = monotone and boundary.start[1] >= 0 and boundary.end[1] >= 0
    symmetric = not general and bool(numbers.random() < 0.75)
    B = round(float(numbers.uniform(1.4, 2.6)), 4)
    velocity: float | Range | None
    velocity = (None, B, between(B, B + 0.2), at_most(B + 0.4), at_least(B))[
        int(numbers.choice(5, p=[0.2, 0.45, 0.15, 0.15, 0.05]))
    ]
    if general and not isinstance(velocity, float):
        velocity = None if velocity is None else at_most(B + 0.4)
    elif general:
        velocity = None
    bounds: dict[str, Range] = {}
    for name, least, chance in (("C", 6.0, 0.15), ("J", 80.0, 0.2), ("D", 6.0, 0.08)):
        if numbers.random() < chance:
            bounds[name] = at_most(round(float(least * numbers.uniform(1.0, 3.0)), 3))
    return Problem(
        B=velocity,
        order=order,
        basis=Chebyshev(degree),
        minimise=minimise,
        monotone=monotone,
        symmetric=symmetric,
        boundary=boundary,
        C=bounds.get("C"),
        J=bounds.get("J"),
        D=bounds.get("D"),
    )


def _end(numbers: np.random.Generator, place: float, order: int) -> tuple[float, ...]:
    higher = [
        round(float(v), 3)
        for v in numbers.uniform(-1.0, 1.0, order - 1) * np.array([0.5, 3.0, 10.0, 30.0])[: order - 1]
    ]
    return (place, *higher)


def _varied(numbers: np.random.Generator, problem: Problem) -> Problem:
    """In another basis, or with a peak bounded from below, where dice say so."""
    kind = str(numbers.choice(["", "powers", "bernstein", "splines", "pieces"], p=[0.5, 0.15, 0.15, 0.1, 0.1]))
    count = 2 * int(numbers.integers(2, 5))
    degree = polynomial(problem).degree
    if kind == "powers":
        problem = replace(problem, basis=Powers(min(degree, 11)))
    elif kind == "bernstein":
        problem = replace(problem, basis=Bernstein(degree))
    elif kind == "splines":
        problem = replace(problem, basis=BSplines(count, 4))
    elif kind == "pieces":
        problem = replace(problem, basis=Pieces(count, 6, 4))
    if numbers.random() < 0.08:
        constant = (C, J, D)[int(numbers.integers(3))]
        own = problem.range(constant.name)
        low = {C: 6.0, J: 80.0, D: 5.0}[constant] * float(numbers.uniform(1.0, 1.6))
        asked = at_least(round(low, 3)) if own is None else between(round(0.9 * own.high, 3), own.high)
        cleared = replace(problem, C=None, J=None, D=None)
        problem = replace(cleared, bounds={**dict(problem.bounded), constant: asked})
    return problem


def random_problems(seed: int, count: int) -> list[Problem]:
    """The same ones at every run, in every basis."""
    numbers, others = np.random.default_rng(seed), np.random.default_rng([seed, 1])
    return [_varied(others, random_problem(numbers)) for _ in range(count)]
