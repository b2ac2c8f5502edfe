"""The frame of a table: the length of its turn, what it advances by in one, and its rows in order."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.motion.quantities import either, quantity
from optlaws.numbers import Array, NumberOrQuantity, Quantity, whole

_TURNS = {"deg": 360.0, "gon": 400.0, "rad": 2.0 * np.pi, "turn": 1.0, "rev": 1.0}
_NEAR = 1e-3  # of the positions: by how much more the last one may be off the first one than steps beside it are
_BESIDE = 4  # steps beside each end, by some of which noise is seen
_ROWS_OVER_SEAM = 7  # on each side, whose slopes are alike where a motion goes on
_FINE = 100  # rows in a turn: in fewer the motion may change between those on each side of a seam
_ALIKE = 0.25  # of the steps beside the ends of a table: by how much they may differ
_MOST_LOBES = 100
_LONG_STEP = 5  # times the median step: a longer one between equal positions is a rest
_STEP_OF_TURN = 0.25  # a position that goes on over the end of its turn makes no longer step
_WHOLE = 1e-6  # of a turn: by how much the last row may be off its end, as digits leave it
_STEP_OFF = 0.02  # of a step, as digits of radians leave it, by how much the last row may be off a step before the end


def in_order(
    places: Array, heights: Array, turn: float | None = None, lines: Sequence[int] = ()
) -> tuple[Array, Array]:
    """Rows with increasing places: reversed ones are turned round, and of equal ones one is left.

    Rows that begin anywhere in a turn, and go on at its beginning, are those of a turn from the first one on. Errors
    name the lines of the file where they are known.

    Raises
    ------
    InputError
        If the places neither increase nor decrease, or one has two positions.

    Examples
    --------
    >>> in_order(np.array([3.0, 2.0, 2.0, 1.0]), np.array([0.0, 1.0, 1.0, 0.0]))
    (array([1., 2., 3.]), array([0., 1., 0.]))
    >>> in_order(np.array([270.0, 350.0, 0.0, 90.0]), np.arange(4.0), 360.0)[0].tolist()
    [270.0, 350.0, 360.0, 450.0]
    """
    if np.all(np.diff(places) <= 0.0):
        places, heights, lines = places[::-1], heights[::-1], lines[::-1]
    steps = np.diff(places)
    falls = np.flatnonzero(steps < 0.0)
    if turn is not None and len(falls) == 1 and falls[0] < len(steps) - 1:
        following = places[falls[0] + 1 :] + turn
        length = following[-1] - places[0]
        if following[0] > places[falls[0]] and np.all(np.diff(following) > 0.0) and length <= turn * (1.0 + _WHOLE):
            places = np.concatenate([places[: falls[0] + 1], following])
            steps = np.diff(places)
    if np.any(steps < 0.0):
        row = int(falls[0])
        where = f"lines {lines[row]} and {lines[row + 1]}" if lines else f"rows {row + 1} and {row + 2} of its points"
        raise InputError(
            f"the places of a table must increase, and {places[row + 1]:.9g} follows {places[row]:.9g} ({where}): mend "
            "them; rows says how many count where spare ones follow"
        )
    twice = np.flatnonzero(steps == 0.0)
    if np.any(heights[twice] != heights[twice + 1]):
        row = int(twice[np.argmax(heights[twice] != heights[twice + 1])])
        where = f"lines {lines[row]} and {lines[row + 1]}: " if lines else ""
        raise InputError(
            f"{where}the place {places[row]:.9g} has two positions, {heights[row]:.9g} and {heights[row + 1]:.9g}: "
            "leave one out"
        )
    return np.delete(places, twice + 1), np.delete(heights, twice + 1)


def unwound(heights: Array, unit: str) -> Array:
    """Positions that go on where an encoder of one turn begins again; others, and those of lengths, as they are.

    Examples
    --------
    >>> unwound(np.array([340.0, 350.0, 359.5, 10.0, 12.0]), "deg").tolist()
    [340.0, 350.0, 359.5, 370.0, 372.0]
    """
    turn = _TURNS.get(unit)
    jumps = np.abs(np.diff(heights)) > 0.5 * (turn or np.inf)
    if turn is None or not jumps.any() or np.any(jumps[1:] & jumps[:-1]):
        return heights
    going_on = np.unwrap(heights, period=turn)
    return going_on if np.abs(np.diff(going_on)).max() <= _STEP_OF_TURN * turn else heights


def closed(
    places: Array, heights: Array, turn: float | None, advance: float | None, *, supposed: float | None = None
) -> tuple[Array, Array]:
    """Rows from the beginning of a turn to its end; the row of the end is that of the beginning where it is missing.

    Parameters
    ----------
    places, heights
        Arrays of shape (n,), of increasing places.
    turn, advance
        The length of the turn, and what the position advances by in it; what the rows have unless given.
    supposed
        The turn of an angle where none is given: rows that end a step before it are those of a turn.

    Raises
    ------
    InputError
        If the rows are longer than the turn, or advance by something else.

    Examples
    --------
    >>> x, y = closed(np.arange(0.0, 1500.0, 10.0), np.zeros(150), 1500.0, None)
    >>> len(x), float(x[-1])
    (151, 1500.0)
    """
    length, step = float(np.ptp(places)), float(np.diff(places)[-1])
    whole = turn or supposed or 0.0
    if abs(length + step - whole) <= max(_WHOLE * whole, _STEP_OFF * step):
        advances = advance is None and abs(heights[-1] - heights[0]) > beside_ends(heights)
        advance = _advance_over_seam(places, heights, whole) if advances else advance
        turn = turn if advances and advance is None else whole
    if turn is None or abs(turn - length) <= _WHOLE * turn:
        if advance is not None and abs(heights[-1] - heights[0] - advance) > 1e-3 * np.ptp(heights):
            raise InputError(
                f"the rows advance by {heights[-1] - heights[0]:.9g} over their turn, not by {advance:.9g}: leave "
                "advance out, or give a longer turn where the row of its end is missing"
            )
        return places, heights
    if turn < length:
        raise InputError(
            f"the rows go over {length:.9g} of the master, more than a turn of {turn:.9g}: give a longer turn, or by "
            "rows how many of them count"
        )
    return np.append(places, places[0] + turn), np.append(heights, heights[0] + (advance or 0.0))


def _advance_over_seam(places: Array, heights: Array, turn: float) -> float | None:
    """What an endless motion advances by, whose rows end a step before the seam; None where it does not go on there."""
    if len(places) < _FINE:
        return None
    sides = (slice(-_ROWS_OVER_SEAM, None), places[0] + turn), (slice(_ROWS_OVER_SEAM), places[0])
    lines, bent = (
        [np.polynomial.Polynomial.fit(places[rows] - seam, heights[rows], degree) for rows, seam in sides]
        for degree in (1, 2)
    )
    slopes = [float(line.deriv()(0.0)) for line in lines]
    if abs(slopes[0] - slopes[1]) * float(np.diff(places)[-1]) > _ALIKE * beside_ends(heights):
        return None
    return float(bent[0](0.0) - bent[1](0.0))


def begun(places: Array, heights: Array, begin: float | None, advance: float | None) -> tuple[Array, Array]:
    """Rows of a whole turn from the one at a place on; those before it follow behind the last one.

    Raises
    ------
    InputError
        If the place is not in the turn.

    Examples
    --------
    >>> x, y = begun(np.array([0.0, 90.0, 180.0, 270.0, 360.0]), np.array([1.0, 2.0, 0.0, 0.0, 1.0]), 180.0, None)
    >>> x.tolist(), y.tolist()
    ([180.0, 270.0, 360.0, 450.0, 540.0], [0.0, 0.0, 1.0, 2.0, 0.0])
    """
    if begin is None:
        return places, heights
    length = float(np.ptp(places))
    if not places[0] <= begin <= places[-1]:
        raise InputError(f"begin must be from {places[0]:.9g} to {places[-1]:.9g}, in the turn, got {begin:.9g}")
    first = int(np.searchsorted(places[:-1], begin - _WHOLE * length)) % (len(places) - 1)
    apart = float(heights[-1] - heights[0])
    rise = apart if advance is None and abs(apart) > beside_ends(heights) else advance or 0.0
    return (
        np.concatenate([places[first:-1], places[: first + 1] + length]),
        np.concatenate([heights[first:-1], heights[: first + 1] + rise]),
    )


def with_rests(places: Array, heights: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Rows with further ones in rests of which a table has the ends alone, and which rows it has itself.

    A rest is a step of many times the length of others between two equal positions.

    Examples
    --------
    >>> x, y, given = with_rests(np.array([0.0, 1.0, 2.0, 3.0, 8.0]), np.array([0.0, 1.0, 2.0, 4.0, 4.0]))
    >>> x.tolist(), y.tolist(), np.flatnonzero(given).tolist()
    ([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0], [0.0, 1.0, 2.0, 4.0, 4.0, 4.0, 4.0, 4.0, 4.0], [0, 1, 2, 3, 8])
    """
    steps = np.diff(places)
    parts = np.round(steps / np.median(steps)).astype(int)
    parts = np.where((heights[1:] == heights[:-1]) & (parts >= _LONG_STEP), parts, 1)
    first = np.concatenate([[0], np.cumsum(parts)])
    at = np.arange(first[-1] + 1)
    return np.interp(at, first, places), np.interp(at, first, heights), np.isin(at, first)


def beside_ends(heights: Array) -> float:
    """By how much the last position may be off the first one for both to be one."""
    steps = np.abs(np.diff(heights))
    return float(2.0 * max(steps[:_BESIDE].max(), steps[-_BESIDE:].max()) + _NEAR * np.ptp(heights))


def whole_turn(turn: float | None, master: str) -> float | None:
    """The length of a turn: as given, or 360 deg in the units of an angle; None where the rows alone say it.

    >>> whole_turn(None, "deg"), whole_turn(720.0, "deg"), whole_turn(None, "mm")
    (360.0, 720.0, None)
    """
    return turn or _TURNS.get(master)


def of_lobe(lobes: int, turn: float | None, advance: float | None, master: str) -> tuple[float | None, float | None]:
    """The length of one of the lobes of a turn, and its share of the advance.

    >>> of_lobe(4, None, 40.0, "deg"), of_lobe(1, None, None, "deg")
    ((90.0, 10.0), (None, None))
    """
    count = whole(lobes, "lobes", 1, _MOST_LOBES)
    of_turn = turn if count == 1 else whole_turn(turn, master)
    return (None if of_turn is None else of_turn / count), (None if advance is None else advance / count)


def in_unit(text: Quantity | None, unit: str, dimensions: Sequence[str], name: str) -> float | None:
    """A quantity as a number of units; None where none is given."""
    if text is None:
        return None
    dimension, size = either(f"1 {unit}", tuple(dimensions), name)
    return quantity(text, dimension, name) / size


def period_of(turn: float, master: str, speed: NumberOrQuantity) -> float:
    """The time of a turn of the master at its speed, in s; a master of lengths may turn at an angular velocity too.

    Examples
    --------
    >>> period_of(1500.0, "mm", "300 mm/s"), period_of(720.0, "deg", "4000 rpm"), period_of(1500.0, "mm", "60 rpm")
    (5.0, 0.03, 1.0)
    """
    dimension, unit = either(f"1 {master}", ("length", "angle"), "master")
    if dimension == "angle":
        return turn * unit / quantity(speed, "angular velocity", "speed", above=0.0)
    of_speed, rate = either(speed, ("velocity", "angular velocity"), "speed")
    if not rate > 0.0:
        raise InputError(f"speed must be above 0, got {speed}")
    return turn * unit / rate if of_speed == "velocity" else 2.0 * np.pi / rate
