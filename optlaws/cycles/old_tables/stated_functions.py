"""Tables that state what runs between their points: dwells and moves are these functions, and nothing is fitted."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby, pairwise

import numpy as np
from numpy.polynomial import Polynomial

from optlaws.cycles.old_tables.peak_intervals import PeakInterval
from optlaws.cycles.old_tables.stretches import Stretch, StretchKind
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.catalogue.tables.curve_pieces import APART, CurvePiece, law_of_pieces

#: positions, or positions, velocities and accelerations, at points inside a move that tell its law, whatever a
#: controller runs between these
_TOLD = 8
_PLACES = 201
#: of the length of a piece: a turning point that is nearer to an end is there
_AT_END = 1e-6
_CONSTANT = "constant velocity"


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
    levels = [height for piece in pieces for height in piece.ends]
    size = max(levels) - min(levels)
    monotone = [part for piece in pieces for part in _between_turns(piece, size)]
    fastest = max(float(np.abs(part.at(np.linspace(0.0, 1.0, 9), 1)).max()) for part in monotone)
    if not size or not fastest:
        raise InputError("the table never moves: all its positions are the same")
    least = max(room, APART * size)
    moves = [[monotone[0]]]
    for before, after in pairwise(monotone):
        if _goes_on(before, after, size, fastest):
            moves[-1].append(after)
        else:
            moves.append([after])
    return tuple(part for move in moves for part in _stretches(move, size, least))


def _between_turns(piece: CurvePiece, size: float) -> list[CurvePiece]:
    """A piece divided where it turns; standard laws do not."""
    if piece.law or _rests(piece, size):
        return [piece]
    roots = Polynomial(np.trim_zeros(piece.values, "b")).deriv().roots()
    turns = sorted(float(root.real) for root in np.atleast_1d(roots) if abs(root.imag) <= _AT_END)
    places = [0.0]
    for turn in [*(u for u in turns if _AT_END < u < 1.0 - _AT_END), 1.0]:
        heights = piece.at(np.array([places[-1], turn, 1.0]))
        if turn == 1.0 or min(abs(heights[1] - heights[0]), abs(heights[2] - heights[1])) > APART * size:
            places.append(turn)
    return [piece.between(*ends) for ends in pairwise(places)] if len(places) > 2 else [piece]


def _rests(piece: CurvePiece, size: float) -> bool:
    return sum(map(abs, piece.values[1:])) <= APART * size


def _goes_on(before: CurvePiece, after: CurvePiece, size: float, fastest: float) -> bool:
    """Whether two pieces are of one stretch: both rest, or the motion passes from one to the other in its direction."""
    if _rests(before, size) or _rests(after, size):
        return _rests(before, size) and _rests(after, size)
    velocities = before.at(np.array([1.0]), 1)[0], after.at(np.array([0.0]), 1)[0]
    same = (before.ends[1] > before.ends[0]) == (after.ends[1] > after.ends[0])
    return same and abs(velocities[1] - velocities[0]) <= APART * fastest < abs(velocities[0])


def _stretches(move: Sequence[CurvePiece], size: float, room: float) -> Iterator[Stretch]:
    """A move or a dwell; a move that is no standard law is divided where parts of it have constant velocity."""
    if _rests(move[0], size):
        yield Stretch("dwell", move[0].start, move[-1].stop, move[0].ends[0], move[0].ends[0])
        return
    whole, flat = _stretch(move, room), APART * size
    parts = [
        list(part) for _, part in groupby(move, lambda piece: max(map(abs, piece.values[2:]), default=0.0) <= flat)
    ]
    if isinstance(whole.law, str) or len(parts) == 1:
        yield whole
        return
    for part in parts:
        yield _stretch(part, room)


def _stretch(move: Sequence[CurvePiece], room: float) -> Stretch:
    """A move with its own law, or the standard law that it is, or that its points are."""
    start, stop, low, high = move[0].start, move[-1].stop, move[0].ends[0], move[-1].ends[1]
    law, stroke = law_of_pieces(move), high - low
    joints = (np.array([piece.start for piece in move[1:]]) - start) / (stop - start)
    places = np.concatenate([joints, np.linspace(0.0, 1.0, _PLACES)])
    curve = np.asarray(law(places))

    def distance(name: str) -> float:
        return float(abs(stroke) * np.abs(curve - np.asarray(catalogue[name].law(places))).max())

    def off_points(name: str) -> float:
        """The distance at the points where these tell the law, else that of the functions between them."""
        other, count = catalogue[name].law, len(joints)
        decided = count >= _TOLD
        if not decided and 3 * count >= _TOLD:
            decided = all(
                np.abs(law(joints, nu) - other(joints, nu)).max() <= APART * other.peak(nu).value for nu in (1, 2)
            )
        return float(abs(stroke) * np.abs(curve - np.asarray(other(places)))[: count if decided else None].max())

    nearest = move[0].law or min(catalogue, key=distance)
    name = nearest if off_points(nearest) <= room else min(catalogue, key=off_points)
    known = off_points(name) <= room
    laws: list[MotionLaw] = [law, catalogue[name].law] if known else [law]
    sizes = [[abs(stroke) / (stop - start) ** nu * float(each.peak(nu).value) for each in laws] for nu in (1, 2, 3)]
    kind: StretchKind = "rise" if stroke > 0.0 else "return"
    return Stretch(
        kind, start, stop, low, high, name if known else law, name if known else nearest,
        distance(name if known else nearest), peaks=tuple(PeakInterval(min(each), max(each)) for each in sizes),
    )  # fmt: skip
