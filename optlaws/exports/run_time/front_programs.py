"""A front as a C99 header or a function block of IEC 61131-3: a plan of bounded cost, and the motion at any time."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from optlaws.exports.formats.c99 import c_name
from optlaws.exports.program_text import c_array, c_row, filled, st_array, template
from optlaws.exports.run_time.front_table import FrontTable
from optlaws.exports.run_time.planning import MoveStatus
from optlaws.exports.text import iec_name, real, safe
from optlaws.files.writing import MARK
from optlaws.tolerances import RUN_TIME_RANGE


def front_header(table: FrontTable, name: str, heading: Sequence[str]) -> str:
    """The source of a C99 header that plans moves by the table of a front and evaluates them.

    Parameters
    ----------
    table
        Of the front.
    name
        Before every name of the header.
    heading
        Lines of its comment.

    Raises
    ------
    InputError
        If the name is none in C.

    Examples
    --------
    >>> from optlaws.exports.run_time.front_table import front_table
    >>> from optlaws import smoothstep
    >>> table = front_table((1.5, 1.875), (smoothstep(2), smoothstep(3)), 1.0, (False, False))
    >>> [line for line in front_header(table, "lift", []).splitlines() if "int lift_in_time" in line]
    ['static inline int lift_in_time(double stroke, double duration, double velocity, lift_move *move)']
    """
    called = c_name(name)
    upper = called.upper()
    letters = {"velocities": "b", "accelerations": "c", "jerks": "j"}
    arrays = {letters.get(array, array): values for array, values in _arrays(table).items()}
    series = table.series[:, 0] if table.series.shape[1] == 1 else table.series
    shape = "".join(f"[{count}]" for count in series.shape)
    rows = [[c_row(list(map(real, row))) for row in law] for law in table.series.tolist()]
    words = {
        **_numbers(table),
        "name": called,
        "NAME": upper,
        "GUARD": f"OPTLAWS_{upper}_H",
        "HEADING": safe([*heading, "", MARK]),
        "AT_FIRST": f"{upper}_{_status(table, 0).name}",
        "AT_LAST": f"{upper}_{_status(table, 1).name}",
        "TABLES": [
            *(
                line
                for array, values in arrays.items()
                for line in c_array(f"double {called}_{array}[{len(values)}]", list(map(real, values)))
            ),
            f"static const double {called}_series{shape} = {{",
            *(f"{law[0]}," if series.ndim == 2 else "    {\n" + ",\n".join(law) + ",\n    }," for law in rows),
            "};",
        ],
    }
    return filled(template("front.h"), words, _choices(table))


def front_block(table: FrontTable, name: str, heading: Sequence[str]) -> str:
    """The source of a function block that plans moves by the table of a front and evaluates them.

    In a call with `plan` the move is planned from the inputs; other calls evaluate it at the time `elapsed` since it
    began, whatever the other inputs are then.

    Parameters
    ----------
    table
        Of the front.
    name
        Of the function block.
    heading
        Lines of its comment.

    Raises
    ------
    InputError
        If the name is none for a function block.

    Examples
    --------
    >>> from optlaws.exports.run_time.front_table import front_table
    >>> from optlaws import smoothstep
    >>> table = front_table((1.5, 1.875), (smoothstep(2), smoothstep(3)), 1.0, (False, False))
    >>> front_block(table, "FB_Lift", []).splitlines()[4]
    'FUNCTION_BLOCK FB_Lift'
    """
    letters = {"velocities": "tableB", "accelerations": "tableC", "jerks": "tableJ"}
    arrays = {**_arrays(table), "series": table.series.ravel().tolist()}
    words = {
        **_numbers(table),
        **{status.name: status.value for status in MoveStatus},
        "NAME": iec_name(name, "IEC 61131-3"),
        "HEADING": safe([*heading, f"status: {', '.join(f'{each.value} {each.name}' for each in MoveStatus)}", MARK]),
        "AT_FIRST": _status(table, 0).value,
        "AT_LAST": _status(table, 1).value,
        "TERMS": table.terms,
        "LAW_SIZE": table.terms * table.series.shape[1],
        "TABLES": [
            # literals in expressions may be REAL
            f"    widened : LREAL := {real(1.0 + table.slack)};",
            *(
                line
                for array, values in arrays.items()
                for line in st_array(letters.get(array, array), "LREAL", list(map(real, values)))
            ),
        ],
    }
    return filled(template("front.st"), words, _choices(table))


def _numbers(table: FrontTable) -> dict[str, object]:
    return {
        "LEAST": real(RUN_TIME_RANGE),
        "MOST": real(1.0 / RUN_TIME_RANGE),
        "WIDENED": real(1.0 + table.slack),
        "COUNT": len(table),
        "LAST": len(table) - 1,
        "BEFORE": len(table) - 2,
        "HIGHEST": table.terms - 1,
        "LAST_PIECE": len(table.breaks) - 2,
    }


def _choices(table: FrontTable) -> set[str]:
    return {*(["ODD"] if table.odd else []), *(["PIECES"] if len(table.breaks) > 2 else [])}


def _status(table: FrontTable, end: int) -> MoveStatus:
    return MoveStatus.PROVEN if table.ends[end] else MoveStatus.AT_END


def _arrays(table: FrontTable) -> dict[str, Sequence[float]]:
    arrays: dict[str, Sequence[float]] = {
        "velocities": table.velocities,
        "accelerations": table.accelerations,
        "jerks": table.jerks,
    }
    if len(table.breaks) > 2:
        arrays |= {"breaks": table.breaks, "scales": [2.0 / (high - low) for low, high in pairwise(table.breaks)]}
    return arrays
