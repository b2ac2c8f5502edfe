"""A front as a function block of IEC 61131-3 in Structured Text: a plan of bounded cost, and the motion at any time."""

from __future__ import annotations

from collections.abc import Sequence

from optlaws.exports.run_time.front_table import FrontTable
from optlaws.exports.run_time.planning import MoveStatus
from optlaws.exports.text import iec_name, real, safe, wrapped
from optlaws.files.writing import MARK
from optlaws.tolerances import RUN_TIME_RANGE

_INTERFACE = """\
VAR_INPUT
    plan : BOOL;
    leastTime : BOOL;
    stroke : LREAL;
    givenTime : LREAL;
    velocityLimit : LREAL;
    accelerationLimit : LREAL;
    jerkLimit : LREAL;
    elapsed : LREAL;
END_VAR
VAR_OUTPUT
    status : INT := {refused};
    moveTime : LREAL;
    position : LREAL;
    velocity : LREAL;
    acceleration : LREAL;
    jerk : LREAL;
    peakVelocity : LREAL;
    peakAcceleration : LREAL;
    peakJerk : LREAL;
END_VAR
"""
_LOCALS = """\
VAR
    law : DINT;
    low : DINT;
    high : DINT;
    middle : DINT;
    piece : DINT;
    n : DINT;
    row : DINT;
    share : LREAL;
    way : LREAL;
    plannedStroke : LREAL;
    rate : LREAL;
    ofC : LREAL;
    ofJ : LREAL;
    m : LREAL;
    rhs : LREAL;
    third : LREAL;
    u : LREAL;
    v : LREAL;
    z : LREAL;
    byJerk : LREAL;
    k : LREAL;
    x : LREAL;
    y : LREAL;
    c : LREAL;
    p0 : LREAL;
    p1 : LREAL;
    p2 : LREAL;
    p3 : LREAL;
    q0 : LREAL;
    q1 : LREAL;
    q2 : LREAL;
    q3 : LREAL;
    s0 : LREAL;
    s1 : LREAL;
    s2 : LREAL;
    s3 : LREAL;
END_VAR
"""
_PLAN = """\
IF plan THEN
    law := 0;
    share := 0.0;
    moveTime := 0.0;
    plannedStroke := 0.0;
    status := {refused};
    way := ABS(stroke);
    IF velocityLimit >= {least} AND velocityLimit <= {most} AND way <= {most} AND (way >= {least} OR way = 0.0) THEN
        IF leastTime THEN
            z := MIN(accelerationLimit, jerkLimit);
            IF z >= {least} AND accelerationLimit <= {most} AND jerkLimit <= {most} THEN
                IF way = 0.0 THEN
                    status := {proven};
                ELSE
                    plannedStroke := stroke;
                    rate := velocityLimit / way;
                    ofC := velocityLimit / accelerationLimit * rate;
                    ofJ := velocityLimit / jerkLimit * rate * rate;
                    low := 0;
                    high := {count};
                    WHILE low < high DO
                        middle := (low + high) / 2;
                        z := tableB[middle];
                        IF z * z >= ofC * tableC[middle] AND z * z * z >= ofJ * tableJ[middle] THEN
                            high := middle;
                        ELSE
                            low := middle + 1;
                        END_IF;
                    END_WHILE;
                    IF low = 0 THEN
                        z := tableB[0];
                        status := {first};
                    ELSIF low = {count} THEN
                        law := {before};
                        share := 1.0;
                        status := {at_last};
                        z := SQRT(ofC * tableC[{last}]);
                        byJerk := EXP(LN(ofJ * tableJ[{last}]) / 3.0);
                        IF byJerk > z THEN
                            z := byJerk;
                            status := {jerk};
                        END_IF;
                    ELSE
                        law := low - 1;
                        status := {proven};
                        m := ofC * ((tableC[law] - tableC[low]) / (tableB[low] - tableB[law]));
                        rhs := ofC * tableC[law] + m * tableB[law];
                        z := 2.0 * rhs / (m + SQRT(m * m + 4.0 * rhs));
                        third := ofJ * ((tableJ[law] - tableJ[low]) / (tableB[low] - tableB[law])) / 3.0;
                        rhs := ofJ * tableJ[law] + 3.0 * third * tableB[law];
                        u := EXP(LN(0.5 * rhs + SQRT(0.25 * rhs * rhs + third * third * third)) / 3.0);
                        v := third / u;
                        byJerk := rhs / (u * u + third + v * v);
                        IF byJerk > z THEN
                            z := byJerk;
                            status := {jerk};
                        END_IF;
                        z := LIMIT(tableB[law], z, tableB[low]);
                        share := LIMIT(0.0, (z - tableB[law]) / (tableB[low] - tableB[law]), 1.0);
                    END_IF;
                    moveTime := z / rate * widened;
                END_IF;
            END_IF;
        ELSIF givenTime >= {least} AND givenTime <= {most} THEN
            IF way = 0.0 THEN
                status := {proven};
                moveTime := givenTime;
            ELSE
                z := velocityLimit * givenTime / way / widened;
                IF z < tableB[0] THEN
                    status := {too_short};
                ELSE
                    plannedStroke := stroke;
                    moveTime := givenTime;
                    IF z >= tableB[{last}] THEN
                        law := {before};
                        share := 1.0;
                        status := {at_last};
                    ELSE
                        low := 0;
                        high := {last};
                        WHILE high - low > 1 DO
                            middle := (low + high) / 2;
                            IF z >= tableB[middle] THEN
                                low := middle;
                            ELSE
                                high := middle;
                            END_IF;
                        END_WHILE;
                        law := low;
                        status := {proven};
                        share := LIMIT(0.0, (z - tableB[law]) / (tableB[law + 1] - tableB[law]), 1.0);
                    END_IF;
                END_IF;
            END_IF;
        END_IF;
    END_IF;
    peakVelocity := 0.0;
    peakAcceleration := 0.0;
    peakJerk := 0.0;
    IF plannedStroke <> 0.0 THEN
        way := widened * way / moveTime;
        peakVelocity := way * (tableB[law] + share * (tableB[law + 1] - tableB[law]));
        peakAcceleration := way / moveTime * (tableC[law] + share * (tableC[law + 1] - tableC[law]));
        peakJerk := way / moveTime / moveTime * (tableJ[law] + share * (tableJ[law + 1] - tableJ[law]));
    END_IF;
END_IF;
"""
_MOTION = """\
position := 0.0;
velocity := 0.0;
acceleration := 0.0;
jerk := 0.0;
IF plannedStroke <> 0.0 AND elapsed > moveTime THEN
    position := plannedStroke;
ELSIF plannedStroke <> 0.0 AND elapsed >= 0.0 THEN
    k := elapsed / moveTime;
{place}
    x := LIMIT(-1.0, x, 1.0);
    y := 2.0 * x;
    p0 := 0.0;
    p1 := 0.0;
    p2 := 0.0;
    p3 := 0.0;
    q0 := 0.0;
    q1 := 0.0;
    q2 := 0.0;
    q3 := 0.0;
    FOR n := {highest} TO 1 BY -1 DO
        c := series[row + n] + share * (series[row + {law_size} + n] - series[row + n]);
{step}    END_FOR;
    c := series[row] + share * (series[row + {law_size}] - series[row]);
{end}    position := plannedStroke * s0;
    velocity := plannedStroke * rate * s1;
    acceleration := plannedStroke * rate * rate * s2;
    jerk := plannedStroke * rate * rate * rate * s3;
END_IF;
"""
_STEP = """\
        s0 := y * p0 - q0 + c;
        s1 := y * p1 - q1 + 2.0 * p0;
        s2 := y * p2 - q2 + 4.0 * p1;
        s3 := y * p3 - q3 + 6.0 * p2;
"""
_MOVED = "".join(f"        q{m} := p{m};\n        p{m} := s{m};\n" for m in range(4))
_EVEN_STEP = """\
        p0 := y * s0 - p0;
        p1 := y * s1 - p1 + 2.0 * s0;
        p2 := y * s2 - p2 + 4.0 * s1;
        p3 := y * s3 - p3 + 6.0 * s2;
""" + "".join(f"        q{m} := s{m};\n" for m in range(4))
_END = """\
    s0 := x * p0 - q0 + c;
    s1 := x * p1 - q1 + p0;
    s2 := x * p2 - q2 + 2.0 * p1;
    s3 := x * p3 - q3 + 3.0 * p2;
"""
_ODD_END = f"""\
{_STEP.replace("        ", "    ")}\
    s3 := x * s3 - p3 + 3.0 * s2;
    s2 := x * s2 - p2 + 2.0 * s1;
    s1 := x * s1 - p1 + s0;
    s0 := x * s0 - p0 + 0.5;
"""
_SINGLE_PLACE = """\
    row := law * {terms};
    rate := 2.0 / moveTime;
    x := 2.0 * k - 1.0;"""
_PLACE_IN_PIECES = """\
    piece := 0;
    high := {last_piece};
    WHILE piece < high DO
        middle := (piece + high + 1) / 2;
        IF k >= breaks[middle] THEN
            piece := middle;
        ELSE
            high := middle - 1;
        END_IF;
    END_WHILE;
    row := law * {law_size} + piece * {terms};
    rate := scales[piece] / moveTime;
    x := scales[piece] * (k - breaks[piece]) - 1.0;"""


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
    called = iec_name(name, "IEC 61131-3")
    statuses = ", ".join(f"{status.value} {status.name}" for status in MoveStatus)
    comment = "\n".join(f"   {line}".rstrip() for line in safe([*heading, f"status: {statuses}", MARK]))
    texts = _texts(table)
    place = _SINGLE_PLACE if len(table.breaks) == 2 else _PLACE_IN_PIECES
    step, end = (_STEP + _EVEN_STEP, _ODD_END) if table.odd else (_STEP + _MOVED, _END)
    parts = [
        f"(* {called}: laws of a proven front, chosen at run time\n{comment}\n*)\nFUNCTION_BLOCK {called}\n",
        _INTERFACE.format(**texts),
        _tables(table),
        _LOCALS,
        _PLAN.format(**texts),
        _MOTION.format(**texts, place=place.format(**texts), step=step, end=end),
        "END_FUNCTION_BLOCK\n",
    ]
    return "".join(parts)


def _texts(table: FrontTable) -> dict[str, object]:
    first, last = ((MoveStatus.PROVEN if proven else MoveStatus.AT_END).value for proven in table.ends)
    return {
        **{status.name.lower(): status.value for status in MoveStatus},
        "least": real(RUN_TIME_RANGE),
        "most": real(1.0 / RUN_TIME_RANGE),
        "count": len(table),
        "last": len(table) - 1,
        "before": len(table) - 2,
        "first": first,
        "at_last": last,
        "highest": table.terms - 1,
        "terms": table.terms,
        "law_size": table.terms * table.series.shape[1],
        "last_piece": len(table.breaks) - 2,
    }


def _tables(table: FrontTable) -> str:
    arrays = {"tableB": table.velocities, "tableC": table.accelerations, "tableJ": table.jerks}
    if len(table.breaks) > 2:
        scales = [2.0 / (high - low) for low, high in zip(table.breaks, table.breaks[1:], strict=False)]
        arrays |= {"breaks": table.breaks, "scales": tuple(scales)}
    arrays |= {"series": tuple(table.series.ravel().tolist())}
    # literals in expressions may be REAL
    lines = ["VAR CONSTANT", f"    widened : LREAL := {real(1.0 + table.slack)};"]
    for name, values in arrays.items():
        lines.append(f"    {name} : ARRAY[0..{len(values) - 1}] OF LREAL := [")
        lines += [*wrapped([real(value) for value in values], "        "), "    ];"]
    return "\n".join([*lines, "END_VAR\n"])
