"""Cycles made of cycles: the same laws at another speed, and the cam that makes an elastic follower move so."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from optlaws.cycles.asked.conversion import Piece
from optlaws.cycles.asked.programme import TURN, Programme, Stretch
from optlaws.cycles.asked.quantities import quantity
from optlaws.cycles.asked.segments import ConstantVelocity, CycleSegment, Dwell, Move
from optlaws.errors import InputError
from optlaws.mechanisms.cam.polydyne import polydyne


@dataclass(frozen=True)
class Made:
    """A cycle with its laws: what was asked, as given and as numbers, and the laws in their places."""

    segments: Sequence[CycleSegment]
    programme: Programme
    pieces: Sequence[Piece]

    def by_segment(self, why: str) -> Iterator[tuple[Stretch, CycleSegment, Piece]]:
        """Segments with their pieces, where each has one.

        Raises
        ------
        InputError
            If one law is of several segments.
        """
        if len(self.pieces) != len(self.segments):
            raise InputError(f"{why}: take moves in place of free motions that meet")
        return zip(self.programme.stretches, self.segments, self.pieces, strict=True)

    def shown(self, displacement: float) -> str:
        """A displacement as a text with its unit."""
        return f"{displacement!r} {'m' if self.programme.axis == 'length' else 'rad'}"


def segments_at(cycle: Made, share: float) -> list[CycleSegment]:
    """Every law as it is, every duration as many times as long as `share` says.

    Raises
    ------
    InputError
        If a law is of several segments, or moves to where it begins.
    """
    made: list[CycleSegment] = []
    for one, given, piece in cycle.by_segment("another speed is given to laws of single segments"):
        time, name = f"{piece.duration * share!r} s", given.label
        if isinstance(given, ConstantVelocity):
            made.append(ConstantVelocity(cycle.shown(piece.end(1, 0) / share) + "/s", time, name=name))
        elif piece.stroke == 0.0:
            made.append(Dwell(time, name=name))
        elif piece.stroke == one.displacement:
            made.append(Move(cycle.shown(piece.stroke), time, law=piece.law, name=name))
        else:
            raise InputError(f"{one.where} ends where it begins: give it to a Cycle of its own at the other speed")
    return made


def cam_segments(cycle: Made, period: Any, damping: float) -> list[CycleSegment]:  # noqa: ANN401 - a quantity
    """Every move corrected by the follower's frequency over its own duration.

    Raises
    ------
    InputError
        If a move is not from rest to rest by a law whose jerk is continuous and 0 at both ends.
    """
    natural = quantity(period, "time", "follower: period")
    if natural <= 0.0:
        raise InputError(f"follower: period must be above 0, got {period!r}")
    made: list[CycleSegment] = []
    for one, given, piece in cycle.by_segment("the cam of an elastic follower is made move by move"):
        time = f"{piece.duration!r} s"
        if piece.stroke == 0.0:
            made.append(Dwell(time, name=given.label))
            continue
        try:
            law = polydyne(piece.law, TURN * piece.duration / natural, damping)
        except InputError as error:
            raise InputError(f"{one.where}: {error}") from None
        made.append(Move(cycle.shown(one.displacement), time, law=law, name=given.label))
    return made
