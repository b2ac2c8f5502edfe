"""Tables of whole cycles, read from files or given as rows, and divided into dwells, rises and returns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from optlaws.cycles.old_tables.frame import (
    begun,
    closed,
    in_order,
    in_unit,
    of_lobe,
    unwound,
    whole_turn,
    with_rests,
)
from optlaws.cycles.old_tables.motion import motion_of
from optlaws.cycles.old_tables.reading import points_in
from optlaws.cycles.old_tables.rests_and_lines import NOISE_ROOM
from optlaws.cycles.old_tables.samples import samples_of
from optlaws.cycles.old_tables.smoothed_noise import as_independent
from optlaws.cycles.old_tables.stated_functions import stretches_of_pieces
from optlaws.cycles.old_tables.stretches import seam_of, stretches_of
from optlaws.cycles.old_tables.table import OldTable
from optlaws.cycles.old_tables.waves import waves_of, with_waves
from optlaws.errors import InputError, located
from optlaws.files import reading
from optlaws.laws.catalogue.tables.columns import LARGEST_TABLE
from optlaws.laws.catalogue.tables.controller_files import FEWEST_POINTS
from optlaws.laws.catalogue.tables.curve_pieces import APART, CurvePiece, TablePoints, TableUnits
from optlaws.motion.quantities import either
from optlaws.numbers import Array, Quantity, not_negative, numbers

_LESS_NOISE = 0.5  # of the noise by differences: where rows are nearer to the fitted motion that is the noise
_STANDARD_LAW_ROOM = 1e-7  # of the stroke of a table with all digits: by how much a standard law may be off its points


def read_cycle_table(
    file: str | Path,
    *,
    tolerance: float | None = None,
    columns: Sequence[int | str] | None = None,
    unit: str | None = None,
    master: str | None = None,
    cam: str | None = None,
    turn: Quantity | None = None,
    advance: Quantity | None = None,
    rows: int | None = None,
    lobes: int = 1,
    begin: Quantity | None = None,
) -> OldTable:
    r"""A table of a whole cycle from a file, divided into dwells, rises and returns.

    Parameters
    ----------
    file
        Points in columns, as `read_law` takes them, with derivatives in further ones, or what a controller has: every
        format that optlaws writes, Structured Text with the structures of CODESYS, TwinCAT, Siemens, ABB, B&R or
        Rockwell, XML of PLCopen, a project of Logix Designer (.L5X), a trajectory of ROS. Its content decides the
        layout, not its name.
    tolerance
        How far laws may be off the points, in units of the table; the last digit, or what the noise requires, unless
        given.
    columns
        Columns that hold the master and the position, by headings or numbers from 1; behind these the derivatives of
        the position by the master, or, of 12 points or more, by the second.
    unit
        The unit of positions, such as "mm", or "0.01 mm" where numbers count these. What the file says unless given,
        else "mm".
    master
        The master's unit, such as "deg", "s", "mm" or "0.1 deg": an angle, a time or a length. What the file says
        unless given, else "deg", "turn" or "rad" by its length.
    cam
        Which cam of a file with several: a tag of Logix Designer, a joint of ROS, a heading of a column.
    turn
        How much of the master is a turn, such as "720 deg" of a crank or "1500 mm" of a web, where the row of its end
        is missing or it is none of 360 deg; from the first to the last row unless given.
    advance
        What the position advances by in a turn, of an endless motion whose last row is missing.
    rows
        How many rows count, from the first one on, where spare ones follow.
    lobes
        How often the rows follow each other in a turn, where they are one lobe of several; each advances by as much.
    begin
        Where the cycle begins on the master, such as "220 deg" in a rest of a table that moves where it begins.

    Raises
    ------
    InputError
        If the file cannot be read or is damaged, or its points make no cycle of dwells and moves from rest to rest.

    Examples
    --------
    >>> from optlaws import catalogue
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> law = catalogue["3-4-5 polynomial"].law
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "index.txt"
    ...     _ = file.write_text("\n".join(f"{x} {45 * law(min(x / 180, 1)):.4f}" for x in range(361)))
    ...     table = read_cycle_table(file, unit="deg")
    >>> table.stretches[0].law, table.seam
    ('3-4-5 polynomial', 45.0)
    """
    path = Path(file)
    content = reading.text(path, LARGEST_TABLE, legacy=True)
    points = points_in(content, path, columns, unit=unit, master=master, cam=cam)
    return table_of(points, path, tolerance, turn=turn, advance=advance, rows=rows, lobes=lobes, begin=begin)


def table_of(
    points: TablePoints,
    path: Path,
    tolerance: float | None = None,
    *,
    turn: Quantity | None = None,
    advance: Quantity | None = None,
    rows: int | None = None,
    lobes: int = 1,
    begin: Quantity | None = None,
) -> OldTable:
    """The table of points with units, divided as by `read_cycle_table`; errors call the table `path`."""
    units, fewest = points.units, 2 if points.pieces else FEWEST_POINTS
    with located(str(path)):
        if rows is not None and not fewest <= rows <= len(points.places):
            raise InputError(f"rows must be from {fewest} to the {len(points.places)} points that it has, got {rows}")
        places, heights = points.places[:rows], points.heights[:rows]
        length = in_unit(turn, units.master, ("angle", "time", "length"), "turn")
        step = in_unit(advance, units.slave, ("length", "angle"), "advance")
        first = in_unit(begin, units.master, ("angle", "time", "length"), "begin")
        if points.pieces:
            if first is not None:
                raise InputError(
                    "begin is of a table of positions alone: leave it out, what runs between these is known"
                )
            pieces = points.pieces[: len(places) - 1]
            table = _of_pieces(pieces, places, heights, units, length, step, tolerance, lobes)
        else:
            places, heights = in_order(places, heights, whole_turn(length, units.master), points.lines[:rows])
            table = split_table(
                places, heights, turn=length, advance=step, lobes=lobes, begin=first, tolerance=tolerance,
                unit=units.slave, master=units.master, digit=points.digit,
            )  # fmt: skip
    added = len(table.places) == lobes * len(places) + 1
    layout = f"{points.layout}, {len(places)} rows with the end of their turn added" if added else points.layout
    return replace(table, layout=layout, rate=points.rate)


def _of_pieces(
    pieces: Sequence[CurvePiece],
    places: Array,
    heights: Array,
    units: TableUnits,
    turn: float | None,
    advance: float | None,
    tolerance: float | None,
    lobes: int,
) -> OldTable:
    """The table of functions that are stated between points."""
    if len(closed(places, heights, *of_lobe(lobes, turn, advance, units.master))[0]) > len(places):
        raise InputError(
            f"what runs from the last point, at {places[-1]:.9g}, to the end of the turn is not stated: add the point "
            "of its end, or leave turn out"
        )
    room = max(not_negative(tolerance or 0.0, "tolerance"), APART * float(np.ptp(heights)))
    whole = turn is not None or either(f"1 {units.master}", ("angle", "time", "length"), "master")[0] == "length"
    stretches, seam = stretches_of_pieces(pieces, room), seam_of(heights, room)
    table = OldTable(stretches, room, 0.0, seam, units.slave, units.master, places, heights, whole=whole)
    return _repeated(table, lobes)


def _repeated(table: OldTable, count: int) -> OldTable:
    """A table whose rows follow each other so many times."""
    length, rise = float(np.ptp(table.places)), table.stretches[-1].high - table.stretches[0].low if table.seam else 0.0
    stretches = list(table.stretches)
    for i in range(1, count):
        for part in table.stretches:
            shifted = replace(
                part, start=part.start + i * length, stop=part.stop + i * length, low=part.low + i * rise,
                high=part.high + i * rise,
            )  # fmt: skip
            before = stretches[-1]
            if shifted.law is None and before.law is None:
                stretches[-1] = replace(before, stop=shifted.stop)
            else:
                stretches.append(shifted)
    rows, turns = len(table.places) - 1, np.arange(count)[:, None]
    places = np.append((table.places[:-1] + turns * length).ravel(), table.places[-1] + (count - 1) * length)
    heights = np.append((table.heights[:-1] + turns * rise).ravel(), table.heights[-1] + (count - 1) * rise)
    outliers = tuple(i * rows + each for i in range(count) for each in table.outliers)
    return replace(
        table, stretches=tuple(stretches), seam=count * table.seam, places=places, heights=heights, outliers=outliers
    )


def split_table(
    x: Sequence[float] | Array,
    y: Sequence[float] | Array,
    *,
    tolerance: float | None = None,
    unit: str = "mm",
    master: str = "deg",
    digit: float = 0.0,
    turn: float | None = None,
    advance: float | None = None,
    lobes: int = 1,
    begin: float | None = None,
) -> OldTable:
    """The dwells, rises and returns of a table of a whole cycle.

    Parameters
    ----------
    x, y
        Increasing places of the master and positions there, as many, at least 12.
    tolerance
        The tolerance of the laws about the points; by default, the noise of the points.
    unit, master
        The units of positions and places.
    digit
        The unit of the last digit of the positions, where they are rounded.
    turn, advance
        The length of a turn of the master, and what the positions advance by in it, where the row of its end is missing
        or it is none of 360 deg; what the rows have unless given.
    lobes
        How often the points follow each other in a turn, where they are one lobe of several.
    begin
        Where the cycle begins on the master; at the first point unless given.

    Raises
    ------
    InputError
        If the points are too few, do not increase, never move, or turn without rest in a way that no law fits.

    Examples
    --------
    >>> from optlaws import catalogue
    >>> x = np.linspace(0.0, 360.0, 181)
    >>> rise, back = np.clip(x / 100.0, 0.0, 1.0), np.clip((x - 160.0) / 100.0, 0.0, 1.0)
    >>> law = catalogue["modified trapezoid"].law
    >>> print(split_table(x, np.round(20.0 * (law(rise) - law(back)), 4), digit=1e-4))
    rise   0 to 100 deg, +20 mm: modified trapezoid (within 4.2e-05 mm)
    dwell  100 to 160 deg
    return 160 to 260 deg, -20 mm: modified trapezoid (within 4.2e-05 mm)
    dwell  260 to 360 deg
    within 0.0001 mm of the points
    greatest velocity 0.3992 to 0.4004 mm/deg, acceleration 0.009775 to 0.009786 mm/deg², jerk 0.00119 to 0.00123 ...
    """
    places, heights = np.array(numbers(x, "x")), np.array(numbers(y, "y"))
    if places.shape != heights.shape or places.ndim != 1 or len(places) < FEWEST_POINTS:
        positions = "" if heights.size == places.size else f" and {heights.size} positions"
        raise InputError(
            f"a cycle's table has at least {FEWEST_POINTS} points, as many places as positions, got {places.size}"
            f"{positions and ' places'}{positions}: a file of fewer has to state what runs between them, by functions "
            "or derivatives"
        )
    if not np.all(np.isfinite(places)) or not np.all(np.isfinite(heights)):
        raise InputError("the places and positions of a table must be finite numbers")
    whole = turn is not None or either(f"1 {master}", ("angle", "time", "length"), "master")[0] == "length"
    of_one = of_lobe(lobes, turn, advance, master)
    ordered = in_order(places, heights, whole_turn(turn, master))
    supposed = whole_turn(None, master) if lobes == 1 else None
    places, heights = closed(ordered[0], unwound(ordered[1], unit), *of_one, supposed=supposed)
    places, heights = begun(places, heights, begin, of_one[1])
    stroke = float(np.ptp(heights))
    if stroke == 0.0:
        raise InputError("the table never moves: all its positions are the same")
    all_places, all_heights, given = with_rests(places, heights)
    samples = as_independent(samples_of(all_places, all_heights, digit))
    least = max(samples.digit if digit else 0.0, _STANDARD_LAW_ROOM * stroke)
    room = least if tolerance is None else max(not_negative(tolerance, "tolerance"), _STANDARD_LAW_ROOM * stroke)
    scatter = samples.scatter
    if tolerance is not None:
        samples = replace(samples, noise=np.maximum(samples.noise, room / NOISE_ROOM))
    motion = motion_of(samples)
    independent = samples.averaged == 1 and not samples.rounded
    if tolerance is None and independent and scatter and motion.variance < _LESS_NOISE**2:
        # of few rows with all digits, differences show the motion itself
        samples = samples.with_noise(float(np.sqrt(motion.variance)))
        motion, scatter = motion_of(samples), samples.scatter
    if not motion.moves:
        raise InputError("the table never moves as far as its noise tells: its positions scatter about one level")
    if tolerance is None:
        room = max(room, NOISE_ROOM * scatter)
    table = OldTable(
        tuple(stretches_of(motion)), room, scatter, seam_of(samples.heights[given], room), unit, master,
        samples.places[given], heights, whole=whole, averaged=samples.averaged,
    )  # fmt: skip
    left_out = motion.samples.suspects[given] | (samples.heights[given] != heights)
    far = left_out & (np.abs(table.at(table.places) - heights) > room)
    table = replace(table, outliers=tuple(np.flatnonzero(far).tolist()))
    waves = waves_of(table.places[~left_out], (heights - table.at(table.places))[~left_out], scatter)
    table = replace(table, waves=waves, stretches=tuple(with_waves(table.stretches, waves)))
    return _repeated(table, lobes)
