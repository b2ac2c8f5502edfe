"""Moves of a cutter's centre as lines of G-code: G1 along a polygon, or G2 and G3 along arcs."""

from __future__ import annotations

import numpy as np

from optlaws.cams.cutting.biarcs import arcs
from optlaws.cams.cutting.chords import polygon
from optlaws.cams.cutting.outline import Outline
from optlaws.cams.cutting.wanted import Cutting
from optlaws.files.writing import MARK


def as_line_moves(outline: Outline, asked: Cutting) -> str:
    """G1 from corner to corner, once around, back to the first."""
    corners = 1e3 * polygon(outline, asked.metres).corners
    moves = [f"G1 {_at(corner, asked)}" for corner in (*corners[1:], corners[0])]
    return _program(corners[0], moves, asked)


def as_arc_moves(outline: Outline, asked: Cutting) -> str:
    """G2 (clockwise) and G3 with I and J from where the move begins, G1 where it is straight."""
    made = arcs(outline, asked.metres)
    rows = zip(1e3 * made.points, 1e3 * made.ends, 1e3 * made.centres, made.bulges, strict=True)
    moves = []
    for start, stop, centre, bulge in rows:
        if bulge == 0.0:
            moves.append(f"G1 {_at(stop, asked)}")
            continue
        i, j = centre - start
        turn = "G3" if bulge > 0.0 else "G2"
        moves.append(f"{turn} {_at(stop, asked)} I{asked.rounded(float(i))} J{asked.rounded(float(j))}")
    return _program(1e3 * made.points[0], moves, asked)


def _program(start: np.ndarray, moves: list[str], asked: Cutting) -> str:
    """Units, plane and mode, the way to the start, and the moves: spindle, depth and compensation are the user's."""
    feed = f" F{asked.feed_rate:.9g}" if asked.feed is not None else ""
    return "\n".join(
        [
            f"({asked.line}; {MARK})",
            "G21 G17 G90 G40",
            f"G0 {_at(start, asked)}",
            moves[0] + feed,
            *moves[1:],
            "",
        ]
    )


def _at(point: np.ndarray, asked: Cutting) -> str:
    return f"X{asked.rounded(float(point[0]))} Y{asked.rounded(float(point[1]))}"
