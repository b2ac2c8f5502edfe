"""Tables that state what runs between their points: dwells and moves are these functions, and nothing is fitted."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby, pairwise
from math import inf

import numpy as np
from numpy.polynomial import Polynomial

from optlaws.cycles.old_tables.peak_intervals import PeakInterval
from optlaws.cycles.old_tables.stretches import Stretch, StretchKind
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.catalogue.tables.curve_pieces import APART, REAL32, CurvePiece, law_of_pieces

#: positions, or positions, velocities and accelerations, at points inside a move that tell its law, whatever a
#: controller runs between these
_ENOUGH = 8
_PLACES = 201
_WITHIN = np.linspace(0.0, 1.0, 9)


def stretches_of_pieces(pieces: Sequence[CurvePiece], room: float = 0.0) -> tuple[Stretch, ...]:
    """The dwells and moves of pieces that follow each other.

    Parameters
    ----------
    pieces
        From the first place to the last one.
    room
        How far a standard law may be off.

    Raises
    ------
    InputError
        If they never move.

    Examples
    --------
    >>> from optlaws.laws.catalogue.tables.curve_pieces import hermite
    >>> up = hermite(0.0, 120.0, [0.0, 0.0, 0.0], [35.0, 0.0, 0.0])
    >>> rest, down = hermite(120.0, 240.0, [35.0], [35.0]), hermite(240.0, 360.0, [35.0], [0.0])
    >>> [(part.kind, part.stop, part.law) for part in stretches_of_pieces([up, rest, down])]
    [('rise', 120.0, '3-4-5 polynomial'), ('dwell', 240.0, None), ('return', 360.0, 'constant velocity')]
    """
    parts = [part for piece in pieces for part in _between_turns(piece)]
    levels = [height for part in parts for height in part.ends]
    size = max(levels) - min(levels)
    speeds = [float(np.abs(part.at(_WITHIN, 1)).max()) for part in parts]
    if not size or not max(speeds):
        raise InputError("the table never moves: all its positions are the same")
    moves = [[parts[0]]]
    for i, (before, after) in enumerate(pairwise(parts)):
        if _goes_on(before, after, APART * max(speeds), APART * min(speeds[i : i + 2])):
            moves[-1].append(after)
        else:
            moves.append([after])
    divided = [part for move in moves for part in _stretches(move, APART * size, max(room, APART * size))]
    known = list[float]()
    heights = [_level(height, known, APART * size) for height in (*(part.low for part in divided), divided[-1].high)]
    stretches = list[Stretch]()
    for part, low, high in zip(divided, heights, heights[1:], strict=False):
        if part.law is None and stretches and stretches[-1].law is None:
            stretches[-1] = replace(stretches[-1], stop=part.stop)
        else:
            stretches.append(replace(part, low=low, high=high))
    return tuple(stretches)


def _level(height: float, known: list[float], apart: float) -> float:
    """A height that is known already where one is so near, else itself, which is known from now on."""
    near = min(known, key=lambda level: abs(level - height), default=inf)
    if abs(near - height) <= apart:
        return near
    known.append(height)
    return height


def _between_turns(piece: CurvePiece) -> list[CurvePiece]:
    """A piece divided where it turns; standard laws do not."""
    slopes = [n * value for n, value in enumerate(piece.values)][1:]
    if piece.law or len(slopes) < 2 or abs(slopes[0]) >= sum(map(abs, slopes[1:])):
        return [piece]
    roots = np.atleast_1d(Polynomial(np.trim_zeros(piece.values, "b")).deriv().roots())
    turns = sorted(float(root.real) for root in roots if abs(root.imag) <= APART < root.real < 1.0 - APART)
    places, least = [0.0], REAL32 * sum(map(abs, piece.values[1:]))
    for turn in turns:
        before, here, last = piece.at(np.array([places[-1], turn, 1.0])).tolist()
        if min(abs(here - before), abs(last - here)) > least:
            places.append(turn)
    return [piece.between(*ends) for ends in pairwise([*places, 1.0])] if len(places) > 1 else [piece]


def _goes_on(before: CurvePiece, after: CurvePiece, jump: float, rest: float) -> bool:
    """Whether two pieces are of one stretch: both rest, or the motion passes from one to the other in its direction."""
    moving = [any(piece.values[1:]) for piece in (before, after)]
    if not all(moving):
        return not any(moving)
    velocities = before.at(np.array([1.0]), 1)[0], after.at(np.array([0.0]), 1)[0]
    same = (before.ends[1] > before.ends[0]) == (after.ends[1] > after.ends[0])
    return bool(same and abs(velocities[1] - velocities[0]) <= jump and abs(velocities[0]) > rest)


def _stretches(move: Sequence[CurvePiece], apart: float, room: float) -> Iterator[Stretch]:
    """A move or a dwell; a move that is no standard law is divided where parts of it have constant velocity."""
    low, high = move[0].ends[0], move[-1].ends[1]
    if abs(high - low) <= apart:
        yield Stretch("dwell", move[0].start, move[-1].stop, low, low)
        return
    whole = _stretch(move, room)
    parts = [list(part) for _, part in groupby(move, _is_straight)]
    if isinstance(whole.law, str) or len(parts) == 1:
        yield whole
        return
    for part in parts:
        yield _stretch(part, room)


def _is_straight(piece: CurvePiece) -> bool:
    return not piece.law and sum(map(abs, piece.values[2:])) <= APART * abs(piece.values[1])


def _stretch(move: Sequence[CurvePiece], room: float) -> Stretch:
    """A move with its own law, or the standard law that it is, or that its points are."""
    start, stop, low, high = move[0].start, move[-1].stop, move[0].ends[0], move[-1].ends[1]
    law, stroke = law_of_pieces(move), high - low
    joints = (np.array([piece.start for piece in move[1:]]) - start) / (stop - start)
    count = len(joints)
    places = np.concatenate([joints, np.linspace(0.0, 1.0, _PLACES)])
    values = [np.asarray(law(places if nu == 0 else joints, nu)) for nu in range(3)]

    def apart(name: str, only: int | None = None) -> float:
        return float(abs(stroke) * np.abs(values[0] - np.asarray(catalogue[name].law(places)))[:only].max())

    def off_points(name: str) -> float:
        """The distance at the points where these tell the law, else that of the functions between them."""
        other = catalogue[name].law
        decided = count >= _ENOUGH or (
            3 * count >= _ENOUGH
            and all(np.abs(values[nu] - other(joints, nu)).max() <= APART * other.peak(nu).value for nu in (1, 2))
        )
        return apart(name, count if decided else None)

    nearest = move[0].law or min(catalogue, key=apart)
    name = nearest if off_points(nearest) <= room else min(catalogue, key=off_points)
    laws: list[MotionLaw] = [law]
    if off_points(name) <= room:
        laws, nearest = [law, catalogue[name].law], name
    sizes = [[abs(stroke) / (stop - start) ** nu * float(each.peak(nu).value) for each in laws] for nu in (1, 2, 3)]
    kind: StretchKind = "rise" if stroke > 0.0 else "return"
    return Stretch(
        kind, start, stop, low, high, nearest if len(laws) > 1 else law, nearest, apart(nearest),
        peaks=tuple(PeakInterval(min(each), max(each)) for each in sizes),
    )  # fmt: skip
