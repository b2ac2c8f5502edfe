"""A law at its place in a motion: the only conversion of dimensionless laws to machine units.

A law a(k) with the stroke h in the duration T moves the machine by y = y0 + h a(t/T). So

| machine | law |
|---|---|
| velocity v | B h/T |
| acceleration | C h/T² |
| jerk | J h/T³ |
| kinetic power per mass | D h²/T³ |
| root mean square of the acceleration | rms_c h/T² |

and every limit in machine units, divided by the same factor, is one of the law.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.law import direction_of
from optlaws.numbers import Array
from optlaws.tolerances import CLOSURE, INSIDE_PIECE, JUMP, SAME_TIME


def named_law(given: Any, where: str) -> MotionLaw:
    """The law with a name, from a file or as a value; errors call the segment `where`."""
    try:
        law = given if isinstance(given, MotionLaw) else _read(given)
    except InputError as error:
        raise InputError(f"{where}: law: {error}") from None
    return of_stroke_one(law, f"{where}: its law", "by")


def of_stroke_one(law: MotionLaw, name: str, multiplier: str) -> MotionLaw:
    """The law, refused under a name where it has not the stroke 1, which an entry multiplies."""
    stroke = float(law.a(1.0)) - float(law.a(0.0))
    if abs(stroke - 1.0) > CLOSURE:
        raise InputError(f"{name} must have the stroke 1, which `{multiplier}` multiplies, but it has {stroke:g}")
    return law


def _read(given: Any) -> MotionLaw:
    if not isinstance(given, str):
        raise InputError(
            f"a law, a name of the catalogue, a formula, a JSON or CSV file or 'optimal', got {shortened(given)}"
        )
    from optlaws.laws.catalogue.reading import is_file, read_law

    return read_law(given) if is_file(given) else _law_of_name(given)


@lru_cache(maxsize=64)
def _law_of_name(name: str) -> MotionLaw:
    from optlaws.laws.catalogue.reading import read_law

    return read_law(name)


_JUMPS = 2


def factor(stroke: float, duration: float, nu: int) -> float:
    """The factor that turns the derivative of order nu of a law into machine units: h/T^nu."""
    return stroke / duration**nu


def moves_at(law: MotionLaw, *sides: int) -> bool:
    """Whether a law is in motion at its start (side 0) or its end (side 1), by more than rounding."""
    return any(abs(law.b(float(side))) > JUMP * law.peak(1).value for side in sides)


def unit_of(axis: str, nu: int = 0) -> str:
    """The SI unit of a derivative by time of a length or an angle."""
    return {"length": "m", "angle": "rad"}[axis] + ("", "/s", "/s²", "/s³", "/s⁴")[nu]


@dataclass(frozen=True)
class Piece:
    """A law in its place in a cycle: y = offset + stroke (a(k) - a(0)), k = (t - start)/duration, in SI units."""

    start: float
    duration: float
    offset: float
    stroke: float
    law: MotionLaw

    @property
    def stop(self) -> float:
        return self.start + self.duration

    def places(self, times: Array) -> Array:
        """The k of times in it."""
        return np.clip((times - self.start) / self.duration, 0.0, 1.0)

    def values(self, times: Array, nu: int) -> Array:
        """The derivative of order nu in SI units at times in it."""
        base = self._origin if nu == 0 else 0.0
        return base + factor(self.stroke, self.duration, nu) * self.law(self.places(times), nu)

    def direction(self, times: Array) -> Array:
        """The direction of the motion at times in it: 1 towards greater positions, -1 towards lesser ones, 0 at rest.

        It is that of the law, whatever the rounding of a velocity near rest.
        """
        if not self.stroke:
            return np.zeros(np.shape(times))
        return np.asarray(np.copysign(1.0, self.stroke) * direction_of(self.law)(self.places(times)))

    @property
    def turns(self) -> tuple[float, ...]:
        """The times inside at which the direction changes."""
        places = direction_of(self.law).turns if self.stroke else ()
        return tuple(self.start + self.duration * float(k) for k in places)

    def end(self, nu: int, side: int) -> float:
        """The derivative of order nu at its start (side 0) or its end (side 1)."""
        if nu not in self._ends:
            first, last = self.values(np.array([self.start, self.stop]), nu).tolist()
            self._ends[nu] = first, last
        return self._ends[nu][side]

    def leaves(self, side: int) -> bool:
        """Whether it is in motion at its start (side 0) or its end (side 1), by more than rounding."""
        return moves_at(self.law, side)

    def jump(self, time: float, nu: int) -> float:
        """The jump of the derivative of order nu at a time inside."""
        places = ((self.start + k * self.duration, jump) for k, jump in self.law.jumps(nu))
        near = (jump for place, jump in places if abs(place - time) <= SAME_TIME * time)
        return factor(self.stroke, self.duration, nu) * sum(near)

    def extremes(self, nu: int, first: float, last: float) -> tuple[tuple[float, float], tuple[float, float]]:
        """Least and greatest value with their times, over the whole of the stretch from `first` to `last`."""
        low, high = (float(place) for place in self.places(np.array([first, last])))
        if nu >= _JUMPS:
            # what jumps where a segment ends has the value of the segment, not of its neighbour
            inside = min(INSIDE_PIECE, 0.25 * (high - low))
            low, high = low + inside * (low > 0.0), high - inside * (high < 1.0)
        base, size = self._origin if nu == 0 else 0.0, factor(self.stroke, self.duration, nu)
        sized = [
            (base + size * extreme.value if self.stroke else base, self.start + extreme.k * self.duration)
            for extreme in self.law.extrema(nu, within=(low, high))
        ]
        return min(sized), max(sized)

    @kept_property
    def _origin(self) -> float:
        return self.offset - self.stroke * float(self.law.a(0.0))

    @kept_property
    def _ends(self) -> dict[int, tuple[float, float]]:
        return {}

    def mean_square(self, nu: int) -> float:
        """Mean of the square of the derivative of order nu over its duration."""
        return (factor(self.stroke, self.duration, nu) * self.law.rms(nu)) ** 2 if self.stroke else 0.0


def values_of_pieces(pieces: Sequence[Piece], times: Array, nu: int) -> Array:
    """The derivative of order nu of consecutive pieces; at a joint, the later piece's value."""
    return by_pieces(pieces, [partial(piece.values, nu=nu) for piece in pieces], times)


def by_pieces(pieces: Sequence[Piece], functions: Sequence[Callable[[Array], Array]], times: Array) -> Array:
    """The values of functions of the time, one for each piece; at a joint, the later piece's value."""
    which = np.searchsorted([piece.start for piece in pieces[1:]], times, side="right")
    values = np.empty(np.shape(times))
    for i, function in enumerate(functions):
        here = which == i
        if here.any():
            values[here] = function(times[here])
    return values


def jump_beside(piece: Piece, pieces: Sequence[Piece], period: float) -> float | None:
    """The time at which a piece begins or ends with an acceleration that its neighbour does not have; None of none.

    Its neighbours are the pieces that end and begin there, also a turn away; one that is not known has the same.
    """
    for side, time in enumerate((piece.start, piece.stop)):
        for other in pieces:
            apart = (other.start if side else other.stop) - time
            if abs(apart - period * round(apart / period)) <= SAME_TIME * period:
                sizes = (abs(factor(p.stroke, p.duration, 2)) * p.law.peak(2).value for p in (piece, other) if p.stroke)
                c, rounding = piece.end(2, side), JUMP * max(sizes, default=0.0)
                if min(abs(c), abs(c - other.end(2, 1 - side))) > rounding:
                    return time
    return None
