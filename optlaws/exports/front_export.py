"""A proven front as functions of a controller: what was written, its size and its gap, and its moves in Python."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from fractions import Fraction
from itertools import pairwise
from math import cbrt, sqrt
from typing import Any

import numpy as np

from optlaws.errors import InputError
from optlaws.exports.error_bounds import ORDERS, summation_bounds
from optlaws.exports.format import FORMATS, format_of
from optlaws.exports.polynomial_pieces import stretches
from optlaws.exports.text import (
    TextFile,
    c_array,
    c_name,
    c_row,
    filled,
    iec_name,
    real,
    rounded_up,
    safe,
    st_array,
    template,
)
from optlaws.files.writing import MARK
from optlaws.laws import MotionLaw
from optlaws.laws.making.transform import law_between
from optlaws.numbers import Array, finite
from optlaws.numerics import exact
from optlaws.shown.summary import Row, Summary
from optlaws.tolerances import JUMP, LIMIT_ROUNDING, RUN_TIME_RANGE

_BYTES = 8
#: the highest degree of a law, whose series are summed term by term
MOST_DEGREE = 80


@dataclass(frozen=True)
class FrontTable:
    """Laws from rest to rest at ascending peak velocities, whose weighted means a controller runs.

    Attributes
    ----------
    velocities, accelerations, jerks
        B of the laws, ascending; C and J, none below that of a later law: bounds of the peaks, and between two laws the
        weighted mean bounds those of the weighted mean. Dimensionless.
    series
        For each law and piece the Chebyshev coefficients of its displacement in x from -1 to 1, shape (laws, pieces,
        terms).
    breaks
        Of the pieces, shape (pieces + 1,), in k.
    odd
        Whether the laws are of one piece and antisymmetric about its middle: only odd coefficients are stored then, and
        the constant is 1/2.
    gap
        What is proven of C: no law of the problem with at most this B has one that is less by more than this share.
    ends
        Whether this holds for the first and the last law against laws of all B: no law is as much slower or better.
    errors
        By how much a, b, c, d of a weighted mean may be missed in double precision, dimensionless.
    slack
        By which share times are lengthened, so that limits are satisfied in spite of rounding.
    """

    velocities: tuple[float, ...]
    accelerations: tuple[float, ...]
    jerks: tuple[float, ...]
    series: Array
    breaks: tuple[float, ...]
    odd: bool
    gap: float
    ends: tuple[bool, bool]
    errors: tuple[float, ...]
    slack: float

    def __len__(self) -> int:
        return len(self.velocities)

    @property
    def terms(self) -> int:
        """How many coefficients a piece has."""
        return int(self.series.shape[2])

    @property
    def degree(self) -> int:
        """The degree of the laws."""
        return 2 * self.terms - 1 if self.odd else self.terms - 1

    def end_status(self, *, last: bool) -> MoveStatus:
        """The status of a move by the first or the last law."""
        return MoveStatus.PROVEN if self.ends[last] else MoveStatus.AT_END

    @property
    def size(self) -> int:
        """Bytes of the table in double precision."""
        breaks = 0 if len(self.breaks) == 2 else 2 * len(self.breaks) - 1
        return _BYTES * (self.series.size + 3 * len(self) + breaks)


def front_table(
    velocities: Sequence[float], laws: Sequence[MotionLaw], gap: float, ends: tuple[bool, bool]
) -> FrontTable:
    """The table of certified laws at ascending B, which are polynomials between the same breaks, from rest to rest."""
    ends_of_laws = [value for law in laws for value in (law.a(0.0), law.a(1.0) - 1.0, law.b(0.0), law.b(1.0))]
    if max(map(abs, ends_of_laws)) > JUMP:
        raise InputError("functions at run time move from rest to rest: take a front of laws whose ends rest")
    breaks, series, exact_series = _series(laws)
    odd = len(breaks) == 2 and not any(value for law in exact_series for value in law[0][2::2])
    peaks = np.array([[law.constants.B.value, law.constants.C.value, law.constants.J.value] for law in laws])
    peaks[:, 0] = np.maximum(peaks[:, 0], velocities)
    peaks[:, 1:] = np.maximum.accumulate(peaks[::-1, 1:])[::-1]
    if not (np.diff(peaks[:, 0]) > 0.0).all() or not np.isfinite(peaks).all():
        raise InputError("a table needs laws of ascending B and finite C and J: take a front of order 3 or more")
    stored = np.ascontiguousarray(series[:, :, 1::2]) if odd else series
    errors = _errors(series, exact_series, breaks, odd=odd)
    b, c, j = (tuple(column) for column in peaks.T.tolist())
    return FrontTable(b, c, j, stored, breaks, odd, gap, ends, errors, _slack(peaks, errors))


def _series(laws: Sequence[MotionLaw]) -> tuple[tuple[float, ...], Array, list[list[list[Fraction]]]]:
    """Breaks, and for each law and piece the series of its displacement: rounded, an array, and exact."""
    parts = [list(stretches(law)) for law in laws]
    if not all(parts):
        raise InputError("functions at run time take laws of polynomials: take a front of such laws")
    breaks, *others = [(float(part[0][0]), *(float(high) for _, high, _ in part)) for part in parts]
    if any(other != breaks for other in others):
        raise InputError("a table of laws needs laws with the same breaks")
    rows = [
        [exact.exact_chebyshev([c * (high - low) ** n for n, c in enumerate(powers)]) for low, high, powers in part]
        for part in parts
    ]
    terms = max(len(row) for law in rows for row in law)
    if terms > MOST_DEGREE + 1:
        raise InputError(f"laws at run time have degrees to {MOST_DEGREE}, got {terms - 1}: take a lower degree")
    every = [[row + [Fraction(0)] * (terms - len(row)) for row in law] for law in rows]
    return breaks, np.array([[exact.rounded(row) for row in law] for law in every]), every


def _errors(
    series: Array, exact_series: list[list[list[Fraction]]], breaks: tuple[float, ...], *, odd: bool
) -> tuple[float, ...]:
    """The greatest of all pieces: of the summation, and of the coefficients' own rounding."""
    errors = np.zeros(ORDERS)
    for piece, (low, high) in enumerate(pairwise(breaks)):
        stored = series[:, piece].copy()
        stored[:, 0] = 0.5 if odd else stored[:, 0]
        missed = np.array(
            [
                [abs(float(value - Fraction(number))) for value, number in zip(law[piece], row, strict=True)]
                for law, row in zip(exact_series, stored.tolist(), strict=True)
            ]
        )
        scale = 2.0 / (high - low)
        of_sum, _ = summation_bounds(np.abs(stored).max(axis=0), scale)
        _, of_table = summation_bounds(missed.max(axis=0), scale)
        errors = np.maximum(errors, np.add(of_sum, of_table))
    return tuple(errors.tolist())


def _slack(peaks: Array, errors: tuple[float, ...]) -> float:
    """Twice the greatest rounding of velocity, acceleration and jerk, and the effect of a rounded weight.

    A weight that is off by the rounding of B moves C and J by as much, times their logarithmic slopes along the front.
    """
    added = max(errors[1] / peaks[0, 0], errors[2] / peaks[-1, 1], errors[3] / peaks[-1, 2])
    width = np.diff(peaks[:, 0]) / peaks[1:, 0]
    steepest = (-np.diff(peaks[:, 1:], axis=0) / peaks[1:, 1:] / width[:, None]).max()
    return float(2.0 * (added + LIMIT_ROUNDING * (2.0 + steepest)))


class MoveStatus(IntEnum):
    """Status codes of a function block at run time.

    Attributes
    ----------
    PROVEN
        The limits hold, and no law of the front's problem within them takes less time, or less acceleration in this
        time, by more than the gap.
    AT_END
        The limits hold for the law at an end of the front; a law beyond may be better.
    JERK
        The limits hold; the jerk decides the time, which is least among the laws of the table.
    TOO_SHORT
        No law of the front moves so far in this time within the velocity: there is no motion.
    REFUSED
        A stroke, a time or a limit is not finite, not positive or out of all proportion: there is no motion.
    """

    PROVEN = 0
    AT_END = 1
    JERK = 2
    TOO_SHORT = 3
    REFUSED = 4

    @property
    def moves(self) -> bool:
        """Whether there is a motion."""
        return self <= MoveStatus.JERK


@dataclass(frozen=True)
class RunTimeMove:
    """A move as a controller plans it: a weighted mean of two neighbouring laws, a stroke and a time.

    Attributes
    ----------
    status
        What is proven of it.
    law, share
        The mean of this law of the table and the next one, which has the weight `share`.
    stroke, duration
        In the units that were given.
    velocity, acceleration, jerk
        Bounds that no magnitude of the motion exceeds, in these units.
    """

    status: MoveStatus
    law: int = 0
    share: float = 0.0
    stroke: float = 0.0
    duration: float = 0.0
    velocity: float = 0.0
    acceleration: float = 0.0
    jerk: float = 0.0


def _summed(table: FrontTable, mixed: Array, x: Array) -> list[Array]:
    """The series and its three derivatives by x, by Clenshaw's recurrence and its derivatives."""
    now, before = ([np.zeros_like(x) for _ in range(4)] for _ in range(2))
    for n in range(table.degree, 0, -1):
        given = mixed[..., n // 2 if table.odd else n] if n % 2 or not table.odd else np.zeros_like(x)
        lower = [given, *(2.0 * m * now[m - 1] for m in (1, 2, 3))]
        now, before = [2.0 * x * p - q + c for p, q, c in zip(now, before, lower, strict=True)], now
    first = np.full_like(x, 0.5) if table.odd else mixed[..., 0]
    lower = [first, *(m * now[m - 1] for m in (1, 2, 3))]
    return [x * p - q + c for p, q, c in zip(now, before, lower, strict=True)]


def _fastest(table: FrontTable, of_c: float, of_j: float) -> tuple[MoveStatus, int, float, float]:
    """What is proven of the first place where the velocity decides, z = B, for z² >= of_c C and z³ >= of_j J.

    With it the law before that place, the next one's weight, and z.
    """
    b, c, j = table.velocities, table.accelerations, table.jerks
    count = len(table)
    low = bisect_left(range(count), x=True, key=lambda i: b[i] * b[i] >= of_c * c[i] and b[i] ** 3 >= of_j * j[i])
    if low == 0:
        return table.end_status(last=False), 0, 0.0, b[0]
    if low == count:
        by_acceleration, by_jerk = sqrt(of_c * c[-1]), cbrt(of_j * j[-1])
        status = MoveStatus.JERK if by_jerk > by_acceleration else table.end_status(last=True)
        return status, low - 2, 1.0, max(by_acceleration, by_jerk)
    i = low - 1
    by_acceleration, by_jerk = _of_quadratic(of_c, b, c, i), _of_cubic(of_j, b, j, i)
    z = min(max(by_acceleration, by_jerk, b[i]), b[low])
    return MoveStatus.JERK if by_jerk > by_acceleration else MoveStatus.PROVEN, i, _share(table, i, z), z


def _line(factor: float, b: tuple[float, ...], peak: tuple[float, ...], i: int) -> tuple[float, float]:
    """Value at B = 0 and fall of factor times a peak that is linear in B between two laws."""
    fall = factor * ((peak[i] - peak[i + 1]) / (b[i + 1] - b[i]))
    return factor * peak[i] + fall * b[i], fall


def _of_quadratic(factor: float, b: tuple[float, ...], c: tuple[float, ...], i: int) -> float:
    """z > 0 of z² + m z = n, without a difference."""
    n, m = _line(factor, b, c, i)
    return 2.0 * n / (m + sqrt(m * m + 4.0 * n))


def _of_cubic(factor: float, b: tuple[float, ...], j: tuple[float, ...], i: int) -> float:
    """z > 0 of z³ + m z = n, without a difference."""
    n, m = _line(factor, b, j, i)
    third = m / 3.0
    u = cbrt(0.5 * n + sqrt(0.25 * n * n + third * third * third))
    v = third / u
    return n / (u * u + third + v * v)


def _share(table: FrontTable, i: int, z: float) -> float:
    b = table.velocities
    return min(max((z - b[i]) / (b[i + 1] - b[i]), 0.0), 1.0)


def _move(table: FrontTable, status: MoveStatus, i: int, share: float, stroke: float, duration: float) -> RunTimeMove:
    """The move by a law and the weight of the next one, with what is proven of it."""
    bounds = (
        (p[i] + share * (p[i + 1] - p[i])) * (1.0 + table.slack) * (abs(stroke) / duration**nu)
        for nu, p in enumerate((table.velocities, table.accelerations, table.jerks), start=1)
    )
    return RunTimeMove(status, i, share, stroke, duration, *bounds)


def _still(stroke: float, *others: float, duration: float = 0.0) -> RunTimeMove | None:
    """The answer to what is out of all proportion, or to a stroke of 0; None where there is a motion."""
    if not all(RUN_TIME_RANGE <= each <= NO_LIMIT for each in (*others, abs(stroke) or 1.0)):
        return RunTimeMove(MoveStatus.REFUSED)
    return None if stroke else RunTimeMove(MoveStatus.PROVEN, duration=duration)


#: a jerk that limits nothing
NO_LIMIT = 1.0 / RUN_TIME_RANGE


@dataclass(frozen=True)
class FrontExport(TextFile):
    """A proven front in the language of a controller, which chooses a law for stroke, time and limits while it runs.

    Attributes
    ----------
    format
        "c99" or "iec-st".
    text
        The file.
    table
        What it holds.
    laws
        The certified laws of the table.

    Examples
    --------
    >>> from optlaws import Problem, proven_front
    >>> export = proven_front(Problem(order=4), ("at_most.B", "C"), gap=1e-4).export("c99", gap=1e-2, name="lift")
    >>> export.points, export.size, export.gap <= 1e-2
    (10, 960, True)
    >>> move = export.least_time(stroke=0.5, velocity=1.2, acceleration=6.0, jerk=400.0)
    >>> move.status.name, round(move.duration, 3), round(export.law(move).constants.C.value, 3)
    ('PROVEN', 0.661, 5.239)
    """

    format: str
    text: str
    table: FrontTable
    laws: tuple[MotionLaw, ...]

    @property
    def points(self) -> int:
        """How many laws the table has."""
        return len(self.table)

    @property
    def size(self) -> int:
        """Size of the table in bytes."""
        return self.table.size

    @property
    def gap(self) -> float:
        """The proven gap: no law of the problem with at most this B has a C that is less by more than this share."""
        return self.table.gap

    def least_time(self, *, stroke: float, velocity: float, acceleration: float, jerk: float = NO_LIMIT) -> RunTimeMove:
        """The move of least time within limits, in one system of units, as the controller plans it.

        With z = v T/h, which is B at the limit of the velocity, the acceleration is at its limit where
        z² = (v²/(a h)) C, and the jerk where z³ = (v³/(j h²)) J. Along the front B ascends, C and J do not: the
        interval is searched by halving, and C and J being linear in it, the roots of a quadratic and of a cubic are
        the place.

        Raises
        ------
        InputError
            If an entry is no finite number.
        """
        given = {"stroke": stroke, "velocity": velocity, "acceleration": acceleration, "jerk": jerk}
        stroke, velocity, acceleration, jerk = (finite(value, name) for name, value in given.items())
        still = _still(stroke, velocity, acceleration, jerk)
        if still is not None:
            return still
        rate = velocity / abs(stroke)
        status, i, share, z = _fastest(self.table, velocity / acceleration * rate, velocity / jerk * rate * rate)
        return _move(self.table, status, i, share, stroke, z / rate * (1.0 + self.table.slack))

    def in_time(self, *, stroke: float, duration: float, velocity: float) -> RunTimeMove:
        """The move of least acceleration in a given time within a velocity, as the controller plans it.

        Raises
        ------
        InputError
            If an entry is no finite number.
        """
        given = {"stroke": stroke, "duration": duration, "velocity": velocity}
        stroke, duration, velocity = (finite(value, name) for name, value in given.items())
        still, table = _still(stroke, duration, velocity, duration=duration), self.table
        if still is not None:
            return still
        z = velocity * duration / abs(stroke) / (1.0 + table.slack)
        if z < table.velocities[0]:
            return RunTimeMove(MoveStatus.TOO_SHORT)
        if z >= table.velocities[-1]:
            return _move(table, table.end_status(last=True), len(table) - 2, 1.0, stroke, duration)
        low = bisect_right(table.velocities, z) - 1
        return _move(table, MoveStatus.PROVEN, low, _share(table, low, z), stroke, duration)

    def motion(self, move: RunTimeMove, times: Any) -> Array:
        """Position, velocity, acceleration and jerk of a move at times since it began, shape (4, ...).

        It is at rest before it and after it.
        """
        table, t = self.table, np.asarray(times, dtype=np.float64)
        values = np.zeros((4, *t.shape))
        if not move.status.moves or move.stroke == 0.0:
            return values
        inside = (t >= 0.0) & (t <= move.duration)
        values[0] = np.where(t > move.duration, move.stroke, 0.0)
        k = np.clip(np.where(inside, t, 0.0) / move.duration, 0.0, 1.0)
        edges = np.array(table.breaks)
        piece = np.clip(np.searchsorted(edges, k, side="right") - 1, 0, len(edges) - 2)
        scale = 2.0 / np.diff(edges)[piece]
        x = np.clip(scale * (k - edges[piece]) - 1.0, -1.0, 1.0)
        first, following = table.series[move.law][piece], table.series[move.law + 1][piece]
        for nu, value in enumerate(_summed(table, first + move.share * (following - first), x)):
            values[nu] = np.where(inside, move.stroke * (scale / move.duration) ** nu * value, values[nu])
        return values

    def law(self, move: RunTimeMove) -> MotionLaw:
        """The law of a move: the weighted mean of two certified laws.

        Raises
        ------
        InputError
            If the move has no motion.
        """
        if not move.status.moves:
            raise InputError(f"there is no law of a move of status {move.status.name}")
        return law_between(self.laws[move.law], self.laws[move.law + 1], move.share)

    def results(self) -> dict[str, Any]:
        """The export as plain data: everything but the text and the table."""
        table = self.table
        return {
            "format": self.format,
            "laws": self.points,
            "bytes": self.size,
            "degree": table.degree,
            "gap": self.gap,
            "B": [table.velocities[0], table.velocities[-1]],
            "C": [table.accelerations[0], table.accelerations[-1]],
            "proven_ends": list(table.ends),
            "rounding": list(table.errors),
            "lengthened_by": table.slack,
        }

    def summary(self) -> Summary:
        """The export as rows: size, gap, range and bounds of roundings."""
        table = self.table
        rows = [
            Row("format", self.format, note=FORMATS[self.format].target),
            Row("certified laws", self.points, note=f"of degree {table.degree}"),
            Row("table", self.size, "bytes"),
            Row("gap of C, proven", self.gap),
            Row("B", table.velocities[0], note=f"to {table.velocities[-1]:.7g}"),
            Row("C", table.accelerations[0], note=f"to {table.accelerations[-1]:.7g}"),
            *(Row(f"rounding of {name}, proven", error) for name, error in zip("abcd", table.errors, strict=True)),
            Row("times lengthened by", table.slack, note="so that the limits hold in spite of rounding"),
        ]
        return Summary(rows)

    def __str__(self) -> str:
        return "\n".join(_heading(self.table, ""))


def export_front(
    to: object,
    name: str,
    velocities: Sequence[float],
    laws: Sequence[MotionLaw],
    proof: tuple[float, tuple[bool, bool]],
    about: str,
) -> FrontExport:
    """The export of certified laws at ascending B, with the gap and the ends that are proven."""
    form = function_format(to)
    table = front_table(velocities, laws, *proof)
    return FrontExport(form, _WRITERS[form](table, name, _heading(table, about)), table, tuple(laws))


def function_format(to: object) -> str:
    """The name of a format that has functions."""
    form = format_of(to).name
    if form not in _WRITERS:
        raise InputError(
            f"to: {form} holds one motion and no functions; a front is exported to {' or '.join(_WRITERS)}"
        )
    return form


def _heading(table: FrontTable, about: str) -> list[str]:
    errors = ", ".join(map(rounded_up, table.errors))
    first, last = table.velocities[0], table.velocities[-1]
    lines = [
        *([about] if about else []),
        f"{len(table)} certified laws of degree {table.degree}, B from {first:.9g} to {last:.9g}, {table.size} bytes",
        f"proven: no law within the same B has a C less by more than {rounded_up(table.gap)} of it",
        "units: any that fit each other, such as mm, mm/s, mm/s^2, mm/s^3 and s",
        "rounding in LREAL, proven, at most, times stroke/duration^n for n = 0, 1, 2, 3: " + errors,
        f"times are lengthened by {rounded_up(table.slack)} of them, so that the limits hold in spite of rounding",
    ]
    beyond = [end for end, proven in zip(("first", "last"), table.ends, strict=True) if not proven]
    return lines + [
        f"AT_END: beyond the {end} law there may be better ones, which the front does not contain" for end in beyond
    ]


def _header(table: FrontTable, name: str, heading: list[str]) -> str:
    """A C99 header that plans moves by the table and evaluates them."""
    called = c_name(name)
    upper, arrays = called.upper(), _arrays(table, "b", "c", "j")
    rows = [[c_row(list(map(real, row))) for row in law] for law in table.series.tolist()]
    laws, pieces, terms = table.series.shape
    shape = f"[{laws}][{terms}]" if pieces == 1 else f"[{laws}][{pieces}][{terms}]"
    words = {
        "name": called,
        "NAME": upper,
        "GUARD": f"OPTLAWS_{upper}_H",
        "HEADING": safe([*heading, "", MARK]),
        "AT_FIRST": f"{upper}_{table.end_status(last=False).name}",
        "AT_LAST": f"{upper}_{table.end_status(last=True).name}",
        "TABLES": [
            *(
                line
                for array, values in arrays.items()
                for line in c_array(f"double {called}_{array}[{len(values)}]", list(map(real, values)))
            ),
            f"static const double {called}_series{shape} = {{",
            *(f"{law[0]}," if len(law) == 1 else "    {\n" + ",\n".join(law) + ",\n    }," for law in rows),
            "};",
        ],
    }
    return _filled(template("front.h"), table, words)


def _block(table: FrontTable, name: str, heading: list[str]) -> str:
    """A function block that plans a move in a call with `plan`; other calls evaluate it at the time since it began."""
    arrays = {**_arrays(table, "tableB", "tableC", "tableJ"), "series": table.series.ravel().tolist()}
    words = {
        **{status.name: status.value for status in MoveStatus},
        "NAME": iec_name(name, "IEC 61131-3"),
        "HEADING": safe([*heading, f"status: {', '.join(f'{each.value} {each.name}' for each in MoveStatus)}", MARK]),
        "AT_FIRST": table.end_status(last=False).value,
        "AT_LAST": table.end_status(last=True).value,
        "TERMS": table.terms,
        "LAW_SIZE": table.terms * table.series.shape[1],
        "TABLES": [
            # literals in expressions may be REAL
            f"    widened : LREAL := {real(1.0 + table.slack)};",
            *(line for array, values in arrays.items() for line in st_array(array, "LREAL", list(map(real, values)))),
        ],
    }
    return _filled(template("front.st"), table, words)


def _arrays(table: FrontTable, *names: str) -> dict[str, tuple[float, ...]]:
    """The arrays of B, C and J under their names in a language, and of the breaks of several pieces."""
    arrays = dict(zip(names, (table.velocities, table.accelerations, table.jerks), strict=True))
    if len(table.breaks) > 2:
        scales = tuple(2.0 / (high - low) for low, high in pairwise(table.breaks))
        arrays |= {"breaks": table.breaks, "scales": scales}
    return arrays


def _filled(source: str, table: FrontTable, words: Mapping[str, object]) -> str:
    numbers = {
        "LEAST": real(RUN_TIME_RANGE),
        "MOST": real(1.0 / RUN_TIME_RANGE),
        "WIDENED": real(1.0 + table.slack),
        "COUNT": len(table),
        "LAST": len(table) - 1,
        "BEFORE": len(table) - 2,
        "HIGHEST": table.terms - 1,
        "LAST_PIECE": len(table.breaks) - 2,
    }
    choices = {"ODD": table.odd, "PIECES": len(table.breaks) > 2}
    return filled(source, {**numbers, **words}, [name for name, chosen in choices.items() if chosen])


_WRITERS = {"c99": _header, "iec-st": _block}
