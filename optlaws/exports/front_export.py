"""A proven front as functions of a controller: what was written, its size and its gap, and its moves in Python."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from optlaws.errors import InputError
from optlaws.exports.format import FORMATS, format_of
from optlaws.exports.front_table import (
    FrontTable,
    MoveStatus,
    RunTimeMove,
    end_status,
    front_table,
    in_time,
    least_time,
    motion_at,
)
from optlaws.exports.text import c_array, c_name, c_row, filled, iec_name, real, rounded_up, safe, st_array, template
from optlaws.files import writing
from optlaws.files.writing import MARK
from optlaws.laws import MotionLaw
from optlaws.laws.making.transform import law_between
from optlaws.numbers import Array, finite
from optlaws.shown.summary import Row, Summary
from optlaws.tolerances import RUN_TIME_RANGE

#: a jerk that limits nothing
NO_LIMIT = 1.0 / RUN_TIME_RANGE


@dataclass(frozen=True)
class FrontExport:
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

        Raises
        ------
        InputError
            If an entry is no finite number.
        """
        return least_time(self.table, **_finite(stroke=stroke, velocity=velocity, acceleration=acceleration, jerk=jerk))

    def in_time(self, *, stroke: float, duration: float, velocity: float) -> RunTimeMove:
        """The move of least acceleration in a given time within a velocity, as the controller plans it.

        Raises
        ------
        InputError
            If an entry is no finite number.
        """
        return in_time(self.table, **_finite(stroke=stroke, duration=duration, velocity=velocity))

    def motion(self, move: RunTimeMove, times: Any) -> Array:
        """Position, velocity, acceleration and jerk of a move at times since it began, shape (4, ...)."""
        return motion_at(self.table, move, times)

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

    def write(self, file: str | Path, *, force: bool = False) -> Path:
        """Write the file, completely or not at all.

        Raises
        ------
        InputError
            If it is there with other contents, and these are not to be replaced (`force`).
        """
        return writing.write(Path(file), self.text, exact=True, force=force)

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
            Row("times lengthened by", table.slack, note="so that limits are kept whatever is rounded"),
        ]
        return Summary(rows)

    def __str__(self) -> str:
        return "\n".join(_heading(self.table, ""))

    def _repr_html_(self) -> str:
        return self.summary()._repr_html_()


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
    """The name of a format that has functions.

    >>> function_format("csv")
    Traceback (most recent call last):
    optlaws.errors.InputError: to: csv holds one motion and no functions; a front is exported to c99 or iec-st
    """
    form = format_of(to).name
    if form not in _WRITERS:
        raise InputError(
            f"to: {form} holds one motion and no functions; a front is exported to {' or '.join(_WRITERS)}"
        )
    return form


def _finite(**values: float) -> dict[str, float]:
    return {name: finite(value, name) for name, value in values.items()}


def _heading(table: FrontTable, about: str) -> list[str]:
    errors = ", ".join(map(rounded_up, table.errors))
    first, last = table.velocities[0], table.velocities[-1]
    lines = [
        *([about] if about else []),
        f"{len(table)} certified laws of degree {table.degree}, B from {first:.9g} to {last:.9g}, {table.size} bytes",
        f"proven: no law within the same B has a C less by more than {rounded_up(table.gap)} of it",
        "units: any that fit each other, such as mm, mm/s, mm/s^2, mm/s^3 and s",
        "rounding in LREAL, proven, at most, times stroke/duration^n for n = 0, 1, 2, 3: " + errors,
        f"times are lengthened by {rounded_up(table.slack)} of them, so that limits are kept whatever is rounded",
    ]
    beyond = [end for end, proven in zip(("first", "last"), table.ends, strict=True) if not proven]
    return lines + [
        f"AT_END: beyond the {end} law there may be better ones, which the front does not hold" for end in beyond
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
        "AT_FIRST": f"{upper}_{end_status(table, last=False).name}",
        "AT_LAST": f"{upper}_{end_status(table, last=True).name}",
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
        "AT_FIRST": end_status(table, last=False).value,
        "AT_LAST": end_status(table, last=True).value,
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
