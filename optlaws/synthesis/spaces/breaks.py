"""Breaks between which a law or its Z is one polynomial."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from numbers import Integral

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.numbers import MOST_DEGREE, MOST_PIECES, listed, numbers, whole
from optlaws.numerics.tolerances import MIRROR


def places(breaks: int | Sequence[float]) -> tuple[float, ...]:
    """Breaks as floats; a number asks for so many pieces of equal length.

    Examples
    --------
    >>> places(4), places([0, 0.3, 1])
    ((0.0, 0.25, 0.5, 0.75, 1.0), (0.0, 0.3, 1.0))
    """
    if isinstance(breaks, Integral):
        number = whole(breaks, "number of pieces", least=1, most=MOST_PIECES)
        return tuple(i / number for i in range(number + 1))
    places = numbers(listed(breaks, "breaks", MOST_PIECES + 1), "breaks")
    if len(places) < 2 or places[0] != 0.0 or places[-1] != 1.0 or not all(a < b for a, b in pairwise(places)):
        raise InputError(f"breaks must increase from 0 to 1, got {shortened(places)}")
    return places


def mirrored(breaks: Sequence[float]) -> bool:
    """Whether the breaks are symmetric about 1/2.

    Examples
    --------
    >>> mirrored((0.0, 0.3, 0.7, 1.0)), mirrored((0.0, 0.3, 1.0))
    (True, False)
    """
    return all(abs(place + other - 1.0) <= MIRROR for place, other in zip(breaks, reversed(breaks), strict=True))


def order_of_continuity(continuity: int, degree: int) -> int:
    """The order up to which derivatives are continuous at the breaks, checked.

    Examples
    --------
    >>> order_of_continuity(2, 3)
    2
    """
    order = whole(continuity, "continuity", least=1, most=MOST_DEGREE)
    if order >= degree:
        raise InputError(f"continuity must be below the degree {degree}, got {order}")
    return order


def read_breaks(text: str) -> int | list[float]:
    """Breaks from text: a number of equal pieces, or the places separated by blanks.

    Examples
    --------
    >>> read_breaks("8"), read_breaks("0 0.3 1")
    (8, [0.0, 0.3, 1.0])
    """
    try:
        places = [float(word) for word in text.replace(",", " ").split()]
    except ValueError as error:
        raise InputError(f"breaks are a number of pieces or places separated by blanks: {error}") from None
    return int(places[0]) if len(places) == 1 and places[0].is_integer() else places
