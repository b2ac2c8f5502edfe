"""Laws between one with a constant too small and one with it too great: some law between has it as asked.

Where the constant is itself what is minimised, every law that has it is an optimum, and no contact shows the way.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.synthesis.families.family import Family, NormFamily
from optlaws.synthesis.method.aligned import aligned
from optlaws.synthesis.method.exchange import solve
from optlaws.synthesis.method.newton import ActiveSet
from optlaws.synthesis.problem.constants import B, Functional, RootMeanSquare
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, model

Array = NDArray[np.float64]

_PLACES = 5
_HALVINGS = 60
_ROUNDS = 4
_SMOOTH = {"C": "rms_c", "C_plus": "rms_c", "C_minus": "rms_c", "J": "rms_j", "D": "rms_c", "B": "rms_c"}


def family_of(found: Model, constant: Functional) -> Family:
    """The rows of a constant that is to be held up.

    Raises
    ------
    InputError
        If there are several families of them.
    """
    families = constant.families(found.space, np.zeros(found.program.size), 0.0)
    if len(families) != 1:
        raise InputError(f"{constant!r} is made of {len(families)} families of rows: it cannot be bounded from below")
    return replace(families[0], name=f"{constant.name} at least")


def places(problem: Problem, family: Family) -> Array:
    """Some places of a family's domain, ends included; those of one half where the mirror image of a law is as good."""
    low, high = family.domain
    if problem.mirrored:
        low = (low + high) / 2.0
    count = _PLACES if problem.symmetric or problem.mirrored else 2 * _PLACES - 1
    return (low + high) / 2.0 + (high - low) / 2.0 * np.cos(np.linspace(0.0, np.pi, count))


def between(problem: Problem, found: Model, plain: ActiveSet, constant: Functional, low: float) -> Iterator[ActiveSet]:
    """Laws between the optimum without the lower bound and smooth laws beyond it that have the constant at `low`."""
    other = model(_without(problem, constant))
    family = family_of(other, constant)
    terms = found.space.terms

    def value(coordinates: Array) -> float:
        return constant.value(found.space.law(coordinates))

    laws: Iterator[ActiveSet]
    if isinstance(family, NormFamily):
        begin = solve(other.program).optimum
        laws = iter(()) if begin is None else (state for _, state in aligned(other.program, family, begin, low))
    else:
        laws = _at_places(problem, other, family, low)
    for beyond in laws:
        if value(beyond.x[:terms]) >= low:
            x = plain.x.copy()
            x[:terms] = _met(value, low, x[:terms], beyond.x[:terms])
            yield replace(plain, x=x)


def _at_places(problem: Problem, other: Model, family: Family, low: float) -> Iterator[ActiveSet]:
    """Smooth laws with the peak at one place after the other."""
    for u in places(problem, family).tolist():
        for s in family.signs:
            row = replace(family, signs=(-s,), bound=-low, domain=(u, u))
            beyond = solve(replace(other.program, families=(*other.program.families, row)), rounds=_ROUNDS).optimum
            if beyond is not None:
                yield beyond


def _without(problem: Problem, constant: Functional) -> Problem:
    """The same laws with nothing asked of the constant; what is minimised makes them smooth."""
    bounds = {one: asked for one, asked in problem.bounded if one != constant}
    # a norm is held up by linear rows: what is minimised beside it had better be linear too
    minimise = "C" if isinstance(constant, RootMeanSquare) else _SMOOTH.get(constant.name, "rms_c")
    smooth = replace(problem, minimise=minimise, C=None, D=None, J=None, bounds=bounds)
    # where B is held up at a place, |b| <= B would hold it there from both sides
    return replace(smooth, B=None) if constant == B else smooth


def _met(value: Callable[[Array], float], low: float, short: Array, beyond: Array) -> Array:
    """On the way from a law with too little to one with enough, the first found that has enough: by halving."""
    begin, end = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = (begin + end) / 2.0
        if value(short + middle * (beyond - short)) < low:
            begin = middle
        else:
            end = middle
    return short + end * (beyond - short)
