"""Jerk-limited moves by seven segments as source code: C99, and Structured Text of IEC 61131-3."""

from __future__ import annotations

from collections.abc import Sequence

from optlaws.exports.formats.c99 import c_name
from optlaws.exports.text import iec_name, real, safe
from optlaws.files.writing import MARK
from optlaws.tolerances import OPERATIONS_ROUNDING, RUN_TIME_RANGE

_C99 = """\
#include <math.h>

/* A move: four times the jerk, twice the acceleration and once the velocity are constant for so long. */
typedef struct {{
    int status; /* 0 least time, 4 a stroke or limit that is none: there is no motion */
    double stroke;
    double jerk;
    double jerk_time;
    double acceleration_time;
    double cruise_time;
    double duration;
}} {name}_move;

static inline int {name}_in_range(double value)
{{
    return value >= {least} && value <= {most};
}}

/* The least time from rest to rest within limits of velocity, acceleration and jerk; the status. */
static inline int {name}_least_time(double stroke, double velocity, double acceleration, double jerk,
                                    {name}_move *move)
{{
    const double way = fabs(stroke);
    const double v = velocity * {narrow};
    const double a = acceleration * {narrow};
    const double j = jerk * {narrow};
    double ramp;
    move->status = 4;
    move->stroke = 0.0;
    move->jerk = 0.0;
    move->jerk_time = 0.0;
    move->acceleration_time = 0.0;
    move->cruise_time = 0.0;
    move->duration = 0.0;
    if (!{name}_in_range(velocity) || !{name}_in_range(acceleration) || !{name}_in_range(jerk)
        || !(stroke == 0.0 || {name}_in_range(way))) {{
        return 4;
    }}
    move->status = 0;
    if (stroke == 0.0) {{
        return 0;
    }}
    move->stroke = stroke;
    move->jerk = stroke < 0.0 ? -j : j;
    ramp = v >= a * (a / j) ? v / a + a / j : 2.0 * sqrt(v / j);
    if (way >= v * ramp) {{
        move->jerk_time = v >= a * (a / j) ? a / j : sqrt(v / j);
        move->acceleration_time = v >= a * (a / j) ? v / a - a / j : 0.0;
        move->cruise_time = way / v - ramp;
    }} else if (way >= 2.0 * a * (a / j) * (a / j)) {{
        move->jerk_time = a / j;
        move->acceleration_time = 2.0 * (way / a) / (a / j + sqrt(a / j * (a / j) + 4.0 * (way / a))) - a / j;
    }} else {{
        move->jerk_time = cbrt(0.5 * (way / j));
    }}
    move->acceleration_time = move->acceleration_time > 0.0 ? move->acceleration_time : 0.0;
    move->duration = 4.0 * move->jerk_time + 2.0 * move->acceleration_time + move->cruise_time;
    return 0;
}}

/* Position, velocity, acceleration and jerk at a time since the move began; at rest before it and after it. */
static inline void {name}_motion(const {name}_move *move, double time, double motion[4])
{{
    const double j = move->jerk;
    const double tj = move->jerk_time;
    const double ta = move->acceleration_time;
    const int second = time > 0.5 * move->duration;
    double t = second ? move->duration - time : time;
    double s;
    motion[0] = 0.0;
    motion[1] = 0.0;
    motion[2] = 0.0;
    motion[3] = 0.0;
    if (move->status != 0 || move->stroke == 0.0 || !(time >= 0.0)) {{
        return;
    }}
    if (time > move->duration) {{
        motion[0] = move->stroke;
        return;
    }}
    if (t < tj) {{
        motion[0] = j * t * t * t / 6.0;
        motion[1] = 0.5 * j * t * t;
        motion[2] = j * t;
        motion[3] = j;
    }} else if (t < tj + ta) {{
        s = t - tj;
        motion[0] = j * tj * (tj * tj / 6.0 + 0.5 * s * (tj + s));
        motion[1] = j * tj * (0.5 * tj + s);
        motion[2] = j * tj;
    }} else {{
        /* what is left of the ramp, counted back from its end */
        s = 2.0 * tj + ta - t;
        s = s < 0.0 ? 0.0 : (s > tj ? tj : s);
        motion[0] = j * tj * (tj + ta) * (t - 0.5 * (2.0 * tj + ta)) + j * s * s * s / 6.0;
        motion[1] = j * tj * (tj + ta) - 0.5 * j * s * s;
        motion[2] = j * s;
        motion[3] = s > 0.0 ? -j : 0.0;
    }}
    if (second) {{
        motion[0] = move->stroke - motion[0];
        motion[2] = -motion[2];
    }}
}}
"""
_ST = """\
VAR_INPUT
    plan : BOOL;
    stroke : LREAL;
    velocityLimit : LREAL;
    accelerationLimit : LREAL;
    jerkLimit : LREAL;
    elapsed : LREAL;
END_VAR
VAR_OUTPUT
    status : INT := 4;
    moveTime : LREAL;
    position : LREAL;
    velocity : LREAL;
    acceleration : LREAL;
    jerk : LREAL;
END_VAR
VAR CONSTANT
    narrowed : LREAL := {narrow};
END_VAR
VAR
    plannedStroke : LREAL;
    plannedJerk : LREAL;
    jerkTime : LREAL;
    accelerationTime : LREAL;
    cruiseTime : LREAL;
    way : LREAL;
    v : LREAL;
    a : LREAL;
    j : LREAL;
    rampTime : LREAL;
    least : LREAL;
    most : LREAL;
    t : LREAL;
    s : LREAL;
END_VAR
IF plan THEN
    status := 4;
    plannedStroke := 0.0;
    jerkTime := 0.0;
    accelerationTime := 0.0;
    cruiseTime := 0.0;
    moveTime := 0.0;
    way := ABS(stroke);
    least := MIN(velocityLimit, MIN(accelerationLimit, jerkLimit));
    most := MAX(velocityLimit, MAX(accelerationLimit, jerkLimit));
    IF least >= {least} AND most <= {most} AND way <= {most} AND (way >= {least} OR way = 0.0) THEN
        status := 0;
        IF way > 0.0 THEN
            plannedStroke := stroke;
            v := velocityLimit * narrowed;
            a := accelerationLimit * narrowed;
            j := jerkLimit * narrowed;
            plannedJerk := j;
            IF stroke < 0.0 THEN
                plannedJerk := -j;
            END_IF;
            IF v >= a * (a / j) THEN
                jerkTime := a / j;
                accelerationTime := v / a - a / j;
                rampTime := v / a + a / j;
            ELSE
                jerkTime := SQRT(v / j);
                rampTime := 2.0 * SQRT(v / j);
            END_IF;
            IF way >= v * rampTime THEN
                cruiseTime := way / v - rampTime;
            ELSIF way >= 2.0 * a * (a / j) * (a / j) THEN
                jerkTime := a / j;
                accelerationTime := 2.0 * (way / a) / (a / j + SQRT(a / j * (a / j) + 4.0 * (way / a))) - a / j;
            ELSE
                jerkTime := EXP(LN(0.5 * (way / j)) / 3.0);
                accelerationTime := 0.0;
            END_IF;
            accelerationTime := MAX(accelerationTime, 0.0);
            moveTime := 4.0 * jerkTime + 2.0 * accelerationTime + cruiseTime;
        END_IF;
    END_IF;
END_IF;
position := 0.0;
velocity := 0.0;
acceleration := 0.0;
jerk := 0.0;
IF plannedStroke <> 0.0 AND elapsed > moveTime THEN
    position := plannedStroke;
ELSIF plannedStroke <> 0.0 AND elapsed >= 0.0 THEN
    t := MIN(elapsed, moveTime - elapsed);
    IF t < jerkTime THEN
        position := plannedJerk * t * t * t / 6.0;
        velocity := 0.5 * plannedJerk * t * t;
        acceleration := plannedJerk * t;
        jerk := plannedJerk;
    ELSIF t < jerkTime + accelerationTime THEN
        s := t - jerkTime;
        position := plannedJerk * jerkTime * (jerkTime * jerkTime / 6.0 + 0.5 * s * (jerkTime + s));
        velocity := plannedJerk * jerkTime * (0.5 * jerkTime + s);
        acceleration := plannedJerk * jerkTime;
    ELSE
        s := LIMIT(0.0, 2.0 * jerkTime + accelerationTime - t, jerkTime);
        velocity := plannedJerk * jerkTime * (jerkTime + accelerationTime);
        position := velocity * (t - 0.5 * (2.0 * jerkTime + accelerationTime)) + plannedJerk * s * s * s / 6.0;
        velocity := velocity - 0.5 * plannedJerk * s * s;
        acceleration := plannedJerk * s;
        IF s > 0.0 THEN
            jerk := -plannedJerk;
        END_IF;
    END_IF;
    IF elapsed > 0.5 * moveTime THEN
        position := plannedStroke - position;
        acceleration := -acceleration;
    END_IF;
END_IF;
"""


def _texts() -> dict[str, str]:
    return {
        "least": real(RUN_TIME_RANGE),
        "most": real(1.0 / RUN_TIME_RANGE),
        "narrow": real(1.0 - OPERATIONS_ROUNDING),
    }


def segments_header(name: str, heading: Sequence[str]) -> str:
    """The source of a C99 header that plans jerk-limited moves and evaluates them.

    Raises
    ------
    InputError
        If the name is none in C.

    Examples
    --------
    >>> [line for line in segments_header("axis", []).splitlines() if "axis_motion" in line]
    ['static inline void axis_motion(const axis_move *move, double time, double motion[4])']
    """
    called = c_name(name)
    guard = f"OPTLAWS_{called.upper()}_H"
    comment = "\n".join(
        f" * {line}".rstrip() for line in safe([f"{called}: {heading[0] if heading else ''}", *heading[1:], "", MARK])
    )
    body = _C99.format(name=called, **_texts())
    return f"/*\n{comment}\n */\n#ifndef {guard}\n#define {guard}\n\n{body}\n#endif /* {guard} */\n"


def segments_block(name: str, heading: Sequence[str]) -> str:
    """The source of a function block that plans jerk-limited moves and evaluates them.

    Raises
    ------
    InputError
        If the name is none for a function block.

    Examples
    --------
    >>> segments_block("FB_Axis", []).splitlines()[-1]
    'END_FUNCTION_BLOCK'
    """
    called = iec_name(name, "IEC 61131-3")
    comment = "\n".join(f"   {line}".rstrip() for line in safe([called, *heading, MARK]))
    return f"(*\n{comment}\n*)\nFUNCTION_BLOCK {called}\n{_ST.format(**_texts())}END_FUNCTION_BLOCK\n"
