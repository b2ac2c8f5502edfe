"""The torsion levers of a study: every combination of lists of lengths, pre-twists and swings, within the limits."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import Annotated

import msgspec

from optlaws.errors import InputError
from optlaws.mechanisms.angles import deg
from optlaws.mechanisms.lever.lever import TorsionLever

Length = Annotated[float, msgspec.Meta(gt=0.0, le=1e6)]
Twist = Annotated[float, msgspec.Meta(ge=0.0, le=1e3)]
Degrees = Annotated[float, msgspec.Meta(gt=0.0, lt=180.0)]
Lengths = Annotated[list[Length], msgspec.Meta(min_length=1)]
Twists = Annotated[list[Twist], msgspec.Meta(min_length=1)]
Swings = Annotated[list[Degrees], msgspec.Meta(min_length=1)]


def levers(
    beta: float, swing: float, lam: Sequence[float], rho: Sequence[float], nu: Sequence[float]
) -> list[TorsionLever]:
    """The levers of one beta and one swing, degrees, that keep to the limits."""
    made = []
    for length, first, second in product(lam, rho, nu):
        try:
            made.append(TorsionLever(beta=beta, lam=length, rho=first, nu=second, swing=deg(swing)))
        except InputError:
            continue
    return made
