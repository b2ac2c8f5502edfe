"""A motion as a function block of IEC 61131-3 in Structured Text: position and derivatives at a time or a master."""

from __future__ import annotations

from optlaws.exports.code.error_bounds import DOUBLE, SINGLE, as_stored
from optlaws.exports.code.heading import Labels, heading
from optlaws.exports.code.literals import real, safe, wrapped
from optlaws.exports.identifiers import iec_name
from optlaws.files.writing import MARK
from optlaws.motion.polynomials import PiecewiseMotion

_BODY = """\
place := LIMIT(breaks[0], x, breaks[{last}]);
inside := (place = x);
WHILE piece > 0 AND place < breaks[piece] DO
    piece := piece - 1;
END_WHILE
WHILE piece < {most} AND place >= breaks[piece + 1] DO
    piece := piece + 1;
END_WHILE
s := place - breaks[piece];
position := coefficients[piece * {width} + {degree}];
velocity := 0.0;
acceleration := 0.0;
jerk := 0.0;
FOR power := {degree} - 1 TO 0 BY -1 DO
    jerk := jerk * s + acceleration;
    acceleration := acceleration * s + velocity;
    velocity := velocity * s + position;
    position := position * s + coefficients[piece * {width} + power];
END_FOR
acceleration := 2.0 * acceleration;
jerk := 6.0 * jerk;
"""
_INTERFACE = """\
VAR_INPUT
    x : {kind};
END_VAR
VAR_OUTPUT
    position : {kind};
    velocity : {kind};
    acceleration : {kind};
    jerk : {kind};
    inside : BOOL;
END_VAR
"""
_LOCALS = """\
VAR
    piece : DINT := 0;
    power : DINT;
    place : {kind};
    s : {kind};
END_VAR
"""


def function_block(
    motion: PiecewiseMotion, name: str = "FB_Motion", labels: Labels | None = None, *, single: bool = False
) -> str:
    """The source of a function block that evaluates a motion by Horner's scheme.

    Its output is position, velocity, acceleration and jerk at the input x; outside the motion x is brought to the
    nearer end, and `inside` says so. The piece is kept from call to call, so that a master that moves on costs one
    comparison. Nothing but arithmetic, arrays and loops is used, which every target of the standard has.

    Parameters
    ----------
    motion
        The motion.
    name
        Of the function block.
    labels
        Units and notes for its heading.
    single
        REAL in place of LREAL.

    Raises
    ------
    InputError
        If the name is none for a function block, or a number is beyond REAL.

    Examples
    --------
    >>> source = function_block(PiecewiseMotion([0.0, 0.1], [[0.0, 0.0, 300.0, -2000.0]]), "FB_Press")
    >>> [line for line in source.splitlines() if "coefficients :" in line]
    ['    coefficients : ARRAY[0..3] OF LREAL := [']
    """
    called = iec_name(name, "IEC 61131-3")
    arithmetic = SINGLE if single else DOUBLE
    run, kind = as_stored(motion, arithmetic), arithmetic.name
    lines = heading(motion, labels or Labels(), [arithmetic])
    comment = "\n".join(f"   {line}".rstrip() for line in safe([*lines, MARK]))
    numbers = {"last": len(run.breaks) - 1, "most": len(run.breaks) - 2, "degree": run.degree}
    parts = [
        f"(* {called}\n{comment}\n*)\nFUNCTION_BLOCK {called}\n",
        _INTERFACE.format(kind=kind),
        _tables(run, kind, single=single),
        _LOCALS.format(kind=kind),
        _BODY.format(**numbers, width=run.degree + 1),
        "END_FUNCTION_BLOCK\n",
    ]
    return "".join(parts)


def _tables(motion: PiecewiseMotion, kind: str, *, single: bool) -> str:
    flat = motion.powers().ravel().tolist()
    lines = ["VAR CONSTANT"]
    for name, values in (("breaks", motion.breaks), ("coefficients", flat)):
        lines.append(f"    {name} : ARRAY[0..{len(values) - 1}] OF {kind} := [")
        lines += wrapped([real(value, single=single) for value in values], "        ")
        lines.append("    ];")
    return "\n".join([*lines, "END_VAR\n"])
