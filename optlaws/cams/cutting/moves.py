"""Moves of a cutter's centre as lines of G-code: G1 along a polygon, or G2 and G3 along arcs."""

from __future__ import annotations

import numpy as np

from optlaws.cams.cutting.biarcs import arcs
from optlaws.cams.cutting.chords import polygon
from optlaws.cams.cutting.file_options import Cutting
from optlaws.cams.cutting.outline import Outline
from optlaws.files.writing import MARK


def as_line_moves(outline: Outline, options: Cutting) -> str:
    """G1 from corner to corner, once around, back to the first."""
    corners = 1e3 * polygon(outline, options.metres).corners
    moves = [f"G1 {_at(corner, options)}" for corner in (*corners[1:], corners[0])]
    return _program(corners[0], moves, options)


def as_arc_moves(outline: Outline, options: Cutting) -> str:
    """G2 (clockwise) and G3 with I and J from where the move begins, G1 where it is straight."""
    chain = arcs(outline, options.metres)
    rows = zip(1e3 * chain.points, 1e3 * chain.ends, 1e3 * chain.centres, chain.bulges, strict=True)
    moves = []
    for start, stop, centre, bulge in rows:
        if bulge == 0.0:
            moves.append(f"G1 {_at(stop, options)}")
            continue
        i, j = centre - start
        turn = "G3" if bulge > 0.0 else "G2"
        moves.append(f"{turn} {_at(stop, options)} I{options.rounded(float(i))} J{options.rounded(float(j))}")
    return _program(1e3 * chain.points[0], moves, options)


def _program(start: np.ndarray, moves: list[str], options: Cutting) -> str:
    """Units, plane and mode, the way to the start, and the moves: spindle, depth and compensation are the user's."""
    feed = f" F{options.feed_rate:.9g}" if options.feed is not None else ""
    return "\n".join(
        [
            f"({options.line}; {MARK})",
            "G21 G17 G90 G40",
            f"G0 {_at(start, options)}",
            moves[0] + feed,
            *moves[1:],
            "",
        ]
    )


def _at(point: np.ndarray, options: Cutting) -> str:
    return f"X{options.rounded(float(point[0]))} Y{options.rounded(float(point[1]))}"
