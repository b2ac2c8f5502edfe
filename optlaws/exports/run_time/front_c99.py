"""A front as a C99 header: a plan of bounded cost, and the motion at any time of it."""

from __future__ import annotations

from collections.abc import Sequence

from optlaws.exports.formats.c99 import c_name
from optlaws.exports.run_time.front_table import FrontTable
from optlaws.exports.text import real, safe, wrapped
from optlaws.files.writing import MARK
from optlaws.numbers import Array
from optlaws.tolerances import RUN_TIME_RANGE

_TYPES = """\
#include <math.h>

/* What is proven of a move; there is no motion from TOO_SHORT on. */
enum {{
    {NAME}_PROVEN = 0,    /* limits kept, within the gap of the best */
    {NAME}_AT_END = 1,    /* limits kept, by the law at an end of the front */
    {NAME}_JERK = 2,      /* limits kept, the jerk decides the time */
    {NAME}_TOO_SHORT = 3, /* no law of the front is as fast */
    {NAME}_REFUSED = 4    /* a stroke, time or limit that is none */
}};

/* A move: the mean of a law of the table and the next one, whose weight is the share. */
typedef struct {{
    int status;
    int law;
    double share;
    double stroke;
    double duration;
    double velocity;     /* magnitudes that the motion does not exceed */
    double acceleration;
    double jerk;
}} {name}_move;
"""
_PLANS = """\
static inline int {name}_in_range(double value)
{{
    return value >= {least} && value <= {most};
}}

static inline int {name}_set(double stroke, double duration, int status, int law, double share, {name}_move *move)
{{
    const double of_b = {name}_b[law] + share * ({name}_b[law + 1] - {name}_b[law]);
    const double of_c = {name}_c[law] + share * ({name}_c[law + 1] - {name}_c[law]);
    const double of_j = {name}_j[law] + share * ({name}_j[law + 1] - {name}_j[law]);
    const double moves = (status < {NAME}_TOO_SHORT && duration > 0.0) ? fabs(stroke) : 0.0;
    const double time = moves > 0.0 ? duration : 1.0;
    move->status = status;
    move->law = law;
    move->share = share;
    move->stroke = stroke;
    move->duration = duration;
    move->velocity = {wide} * of_b * (moves / time);
    move->acceleration = {wide} * of_c * (moves / time / time);
    move->jerk = {wide} * of_j * (moves / time / time / time);
    return status;
}}

static inline double {name}_share(int law, double z)
{{
    const double share = (z - {name}_b[law]) / ({name}_b[law + 1] - {name}_b[law]);
    return share < 0.0 ? 0.0 : (share > 1.0 ? 1.0 : share);
}}

/* The least time within limits of velocity, acceleration and jerk; the status, which the move holds too. */
static inline int {name}_least_time(double stroke, double velocity, double acceleration, double jerk,
                                    {name}_move *move)
{{
    double rate;
    double of_c;
    double of_j;
    double z;
    double by_jerk;
    int low = 0;
    int high = {count};
    if (!{name}_in_range(velocity) || !{name}_in_range(acceleration) || !{name}_in_range(jerk)
        || !(stroke == 0.0 || {name}_in_range(fabs(stroke)))) {{
        return {name}_set(0.0, 0.0, {NAME}_REFUSED, 0, 0.0, move);
    }}
    if (stroke == 0.0) {{
        return {name}_set(0.0, 0.0, {NAME}_PROVEN, 0, 0.0, move);
    }}
    rate = velocity / fabs(stroke);
    of_c = velocity / acceleration * rate;
    of_j = velocity / jerk * rate * rate;
    while (low < high) {{
        const int middle = (low + high) / 2;
        const double b = {name}_b[middle];
        if (b * b >= of_c * {name}_c[middle] && b * b * b >= of_j * {name}_j[middle]) {{
            high = middle;
        }} else {{
            low = middle + 1;
        }}
    }}
    if (low == 0) {{
        return {name}_set(stroke, {name}_b[0] / rate * {wide}, {first}, 0, 0.0, move);
    }}
    if (low == {count}) {{
        z = sqrt(of_c * {name}_c[{last}]);
        by_jerk = cbrt(of_j * {name}_j[{last}]);
        return {name}_set(stroke, (by_jerk > z ? by_jerk : z) / rate * {wide},
                          by_jerk > z ? {NAME}_JERK : {at_last}, {before}, 1.0, move);
    }}
    low -= 1;
    {{
        const double width = {name}_b[low + 1] - {name}_b[low];
        const double m = of_c * (({name}_c[low] - {name}_c[low + 1]) / width);
        const double n = of_c * {name}_c[low] + m * {name}_b[low];
        const double third = of_j * (({name}_j[low] - {name}_j[low + 1]) / width) / 3.0;
        const double right = of_j * {name}_j[low] + 3.0 * third * {name}_b[low];
        const double u = cbrt(0.5 * right + sqrt(0.25 * right * right + third * third * third));
        const double v = third / u;
        z = 2.0 * n / (m + sqrt(m * m + 4.0 * n));
        by_jerk = right / (u * u + third + v * v);
    }}
    {{
        const int status = by_jerk > z ? {NAME}_JERK : {NAME}_PROVEN;
        z = by_jerk > z ? by_jerk : z;
        z = z < {name}_b[low] ? {name}_b[low] : (z > {name}_b[low + 1] ? {name}_b[low + 1] : z);
        return {name}_set(stroke, z / rate * {wide}, status, low, {name}_share(low, z), move);
    }}
}}

/* The least acceleration in a given time within a limit of the velocity; the status, which the move holds too. */
static inline int {name}_in_time(double stroke, double duration, double velocity, {name}_move *move)
{{
    double z;
    int low = 0;
    int high = {last};
    if (!{name}_in_range(duration) || !{name}_in_range(velocity)
        || !(stroke == 0.0 || {name}_in_range(fabs(stroke)))) {{
        return {name}_set(0.0, 0.0, {NAME}_REFUSED, 0, 0.0, move);
    }}
    if (stroke == 0.0) {{
        return {name}_set(0.0, duration, {NAME}_PROVEN, 0, 0.0, move);
    }}
    z = velocity * duration / fabs(stroke) / {wide};
    if (z < {name}_b[0]) {{
        return {name}_set(0.0, 0.0, {NAME}_TOO_SHORT, 0, 0.0, move);
    }}
    if (z >= {name}_b[{last}]) {{
        return {name}_set(stroke, duration, {at_last}, {before}, 1.0, move);
    }}
    while (high - low > 1) {{
        const int middle = (low + high) / 2;
        if (z >= {name}_b[middle]) {{
            low = middle;
        }} else {{
            high = middle;
        }}
    }}
    return {name}_set(stroke, duration, {NAME}_PROVEN, low, {name}_share(low, z), move);
}}
"""
_MOTION = """\
/* Position, velocity, acceleration and jerk at a time since the move began; at rest before it and after it. */
static inline void {name}_motion(const {name}_move *move, double time, double motion[4])
{{
    double p0 = 0.0, p1 = 0.0, p2 = 0.0, p3 = 0.0;
    double q0 = 0.0, q1 = 0.0, q2 = 0.0, q3 = 0.0;
    double s0, s1, s2, s3;
    double k, x, y, rate;
    const double *row;
    const double *next;
    int n;
    motion[0] = 0.0;
    motion[1] = 0.0;
    motion[2] = 0.0;
    motion[3] = 0.0;
    if (move->status > {NAME}_JERK || move->stroke == 0.0 || !(time >= 0.0)) {{
        return;
    }}
    if (time > move->duration) {{
        motion[0] = move->stroke;
        return;
    }}
    k = time / move->duration;
{place}
    x = x < -1.0 ? -1.0 : (x > 1.0 ? 1.0 : x);
    y = 2.0 * x;
    for (n = {most}; n > 0; --n) {{
        const double c = row[n] + move->share * (next[n] - row[n]);
{step}    }}
{end}    motion[0] = move->stroke * s0;
    motion[1] = move->stroke * rate * s1;
    motion[2] = move->stroke * rate * rate * s2;
    motion[3] = move->stroke * rate * rate * rate * s3;
}}
"""
#: a step of the recurrence and of its derivatives: p is b_(n+1), q is b_(n+2), s becomes b_n
_STEP = """\
        s0 = y * p0 - q0 + c;
        s1 = y * p1 - q1 + 2.0 * p0;
        s2 = y * p2 - q2 + 4.0 * p1;
        s3 = y * p3 - q3 + 6.0 * p2;
"""
_MOVED = """\
        q0 = p0;
        q1 = p1;
        q2 = p2;
        q3 = p3;
        p0 = s0;
        p1 = s1;
        p2 = s2;
        p3 = s3;
"""
_END = """\
    s0 = x * p0 - q0 + (row[0] + move->share * (next[0] - row[0]));
    s1 = x * p1 - q1 + p0;
    s2 = x * p2 - q2 + 2.0 * p1;
    s3 = x * p3 - q3 + 3.0 * p2;
"""
#: of odd series the even coefficients are 0 but for the constant 1/2, so that two steps need one coefficient
_EVEN_STEP = """\
        p0 = y * s0 - p0;
        p1 = y * s1 - p1 + 2.0 * s0;
        p2 = y * s2 - p2 + 4.0 * s1;
        p3 = y * s3 - p3 + 6.0 * s2;
        q0 = s0;
        q1 = s1;
        q2 = s2;
        q3 = s3;
"""
_ODD_END = """\
    s0 = y * p0 - q0 + (row[0] + move->share * (next[0] - row[0]));
    s1 = y * p1 - q1 + 2.0 * p0;
    s2 = y * p2 - q2 + 4.0 * p1;
    s3 = y * p3 - q3 + 6.0 * p2;
    s3 = x * s3 - p3 + 3.0 * s2;
    s2 = x * s2 - p2 + 2.0 * s1;
    s1 = x * s1 - p1 + s0;
    s0 = x * s0 - p0 + 0.5;
"""
_SINGLE_PLACE = """\
    row = {name}_series[move->law];
    next = {name}_series[move->law + 1];
    rate = 2.0 / move->duration;
    x = 2.0 * k - 1.0;"""
_PLACE_IN_PIECES = """\
    {{
        int piece = 0;
        int high = {last_piece};
        while (piece < high) {{
            const int middle = (piece + high + 1) / 2;
            if (k >= {name}_breaks[middle]) {{
                piece = middle;
            }} else {{
                high = middle - 1;
            }}
        }}
        row = {name}_series[move->law][piece];
        next = {name}_series[move->law + 1][piece];
        rate = {name}_scales[piece] / move->duration;
        x = {name}_scales[piece] * (k - {name}_breaks[piece]) - 1.0;
    }}"""


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
    guard = f"OPTLAWS_{called.upper()}_H"
    comment = "\n".join(f" * {line}".rstrip() for line in safe([*heading, "", MARK]))
    texts = _texts(table, called)
    parts = [
        f"/* {called}: laws of a proven front, chosen at run time.\n *\n{comment}\n */\n",
        f"#ifndef {guard}\n#define {guard}\n",
        _TYPES.format(**texts),
        _tables(table, called),
        _PLANS.format(**texts),
        _motion(table, texts),
        f"#endif /* {guard} */\n",
    ]
    return "\n".join(parts)


def _texts(table: FrontTable, name: str) -> dict[str, object]:
    upper = name.upper()
    ends = [f"{upper}_{'PROVEN' if proven else 'AT_END'}" for proven in table.ends]
    return {
        "name": name,
        "NAME": upper,
        "least": real(RUN_TIME_RANGE),
        "most": real(1.0 / RUN_TIME_RANGE),
        "wide": real(1.0 + table.slack),
        "count": len(table),
        "last": len(table) - 1,
        "before": len(table) - 2,
        "first": ends[0],
        "at_last": ends[1],
    }


def _motion(table: FrontTable, texts: dict[str, object]) -> str:
    single = len(table.breaks) == 2
    place = _SINGLE_PLACE if single else _PLACE_IN_PIECES
    step, end = (_STEP + _EVEN_STEP, _ODD_END) if table.odd else (_STEP + _MOVED, _END)
    numbers = {**texts, "most": table.terms - 1, "last_piece": len(table.breaks) - 2}
    return _MOTION.format(**numbers, place=place.format(**numbers), step=step, end=end)


def _tables(table: FrontTable, name: str) -> str:
    lines = []
    for letter, values in (("b", table.velocities), ("c", table.accelerations), ("j", table.jerks)):
        lines += _array(f"{name}_{letter}[{len(values)}]", values)
    if len(table.breaks) > 2:
        scales = [2.0 / (high - low) for low, high in zip(table.breaks, table.breaks[1:], strict=False)]
        lines += _array(f"{name}_breaks[{len(table.breaks)}]", table.breaks)
        lines += _array(f"{name}_scales[{len(scales)}]", scales)
    pieces = table.series.shape[1]
    shape = f"[{len(table)}][{table.terms}]" if pieces == 1 else f"[{len(table)}][{pieces}][{table.terms}]"
    lines.append(f"static const double {name}_series{shape} = {{")
    for law in table.series:
        lines.append(_row(law[0]) if pieces == 1 else "    {\n" + "\n".join(map(_row, law)) + "\n    },")
    return "\n".join([*lines, "};\n"])


def _array(declared: str, values: Sequence[float]) -> list[str]:
    return [f"static const double {declared} = {{", *wrapped([real(value) for value in values], "    "), "};"]


def _row(values: Array) -> str:
    body = wrapped([real(value) for value in values.tolist()], "    ")
    return "    {" + "\n".join(body).lstrip() + "},"
