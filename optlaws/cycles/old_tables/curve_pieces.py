"""Pieces of a cam as controllers run them: polynomials by their ends or their powers, and standard laws."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.numbers import Array

_POLYNOMIAL = re.compile(r"POLY(?:NOM(?:IAL)?)?_?([1357])(?:_MM)?", re.IGNORECASE)
_LINE = ("linear", "line")
#: profiles after the last point, which run nowhere
_NONE = ("notdef", "undefined", "nonextsegment")


class CurvePiece(NamedTuple):
    """A piece of a cam: where it begins and ends, and its positions over the distance from where it begins."""

    start: float
    stop: float
    position: Callable[[Array], Array]


def powers(start: float, stop: float, coefficients: Sequence[float]) -> CurvePiece:
    """The piece of ascending powers of the distance from where it begins.

    >>> powers(10.0, 12.0, [1.0, 0.0, 0.5]).position(np.array([0.0, 2.0])).tolist()
    [1.0, 3.0]
    """
    _check(start, stop)
    return CurvePiece(start, stop, np.polynomial.Polynomial(list(coefficients)))


def hermite(start: float, stop: float, first: Sequence[float], last: Sequence[float]) -> CurvePiece:
    """The polynomial with a position and derivatives by the master at each end, as many as are given there.

    >>> hermite(0.0, 2.0, [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]).position(np.array([1.0])).tolist()
    [0.5]
    """
    from scipy.interpolate import BPoly

    _check(start, stop)
    return CurvePiece(start, stop, BPoly.from_derivatives([0.0, stop - start], [list(first), list(last)]))


def of_profile(
    profile: str | None, places: tuple[float, float], first: Sequence[float], last: Sequence[float]
) -> CurvePiece:
    """The piece of a profile by its name, between positions with derivatives.

    Parameters
    ----------
    profile
        A polynomial ("POLYNOM5_MM", "Polynomial5", "Linear"), or a law of the catalogue between two rests; None for the
        polynomial of all that is given.
    places
        Where it begins and ends.
    first, last
        The position and its derivatives at each end.

    Raises
    ------
    InputError
        If there is no such profile, too little is given for it, or a law from rest to rest has velocities at its ends.
    """
    start, stop = places
    if profile is None or profile.lower() in _NONE:
        return hermite(start, stop, first, last)
    polynomial = _POLYNOMIAL.fullmatch(profile)
    if polynomial or profile.lower() in _LINE or profile.lower() == "polyfive":
        degree = int(polynomial[1]) if polynomial else (5 if profile.lower() == "polyfive" else 1)
        orders = (degree + 1) // 2
        if min(len(first), len(last)) < orders:
            raise InputError(f"{profile} needs the position and {orders - 1} derivatives at both ends")
        return hermite(start, stop, first[:orders], last[:orders])
    if profile.lower() == "dwell":
        return hermite(start, stop, first[:1], last[:1])
    try:
        law = catalogue[profile].law
    except InputError:
        raise InputError(f"there is no profile {shortened(profile)} that is known here") from None
    if any(first[1:2]) or any(last[1:2]):
        raise InputError(f"{profile} goes from rest to rest, and a velocity is given at an end: it is not known here")
    _check(start, stop)
    length = stop - start
    return CurvePiece(start, stop, lambda d: first[0] + (last[0] - first[0]) * law(np.clip(d / length, 0.0, 1.0)))


def _check(start: float, stop: float) -> None:
    if not stop > start:
        raise InputError(
            f"the master goes from {start:.9g} to {stop:.9g}: places must increase, and a file hold one cam"
        )
