"""A motion as a C99 header: no allocation, no library, double and float, errors bounded and proven."""

from __future__ import annotations

import re
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.exports.error_bounds import DOUBLE, SINGLE, as_stored
from optlaws.exports.format import Request, Written, file_format
from optlaws.exports.formats.program_polynomials import SOURCE_MODEL, SOURCE_PIECES, labels_of, source_polynomials
from optlaws.exports.text import C_KEYWORDS, Labels, program_heading, real, safe, wrapped
from optlaws.files.writing import MARK
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.motion.quantities import QUANTITIES

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,30}")

_FUNCTIONS = """\
/* The piece that holds x: the first before the motion, the last after it. */
static inline int {name}_piece{f}({kind} x)
{{
    int low = 0;
    int high = {most};
    while (low < high) {{
        int middle = (low + high + 1) / 2;
        if (x >= {name}_breaks{f}[middle]) {{
            low = middle;
        }} else {{
            high = middle - 1;
        }}
    }}
    return low;
}}

/* Position, velocity, acceleration and jerk at x; outside the motion those of its nearer end. */
static inline void {name}_motion{f}({kind} x, {kind} motion[4])
{{
    const {kind} first = {name}_breaks{f}[0];
    const {kind} last = {name}_breaks{f}[{last}];
    const {kind} place = x < first ? first : (x < last ? x : last);
    const int piece = {name}_piece{f}(place);
    const {kind} *powers = {name}_coefficients{f}[piece];
    const {kind} s = place - {name}_breaks{f}[piece];
    {kind} position = powers[{degree}];
    {kind} velocity = {zero};
    {kind} acceleration = {zero};
    {kind} jerk = {zero};
    int power;
    for (power = {degree} - 1; power >= 0; --power) {{
        jerk = jerk * s + acceleration;
        acceleration = acceleration * s + velocity;
        velocity = velocity * s + position;
        position = position * s + powers[power];
    }}
    motion[0] = position;
    motion[1] = velocity;
    motion[2] = {two} * acceleration;
    motion[3] = {six} * jerk;
}}
"""
_ONE = """\

static inline {kind} {name}_{quantity}{f}({kind} x)
{{
    {kind} motion[4];
    {name}_motion{f}(x, motion);
    return motion[{nu}];
}}
"""


def header(motion: PiecewiseMotion, name: str = "motion", labels: Labels | None = None) -> str:
    """The source of a C99 header that evaluates a motion, in double and in float.

    For the name "press" it holds `press_position(x)`, `press_velocity`, `press_acceleration`, `press_jerk` and
    `press_motion(x, values)` for all four at once, and the same in float with the ending `_f`; tables are constant,
    nothing is allocated and nothing included. In float, x and the breaks are what float holds of them.

    Parameters
    ----------
    motion
        The motion.
    name
        Before every name of the header.
    labels
        Units and notes for its program_heading.

    Raises
    ------
    InputError
        If the name is none in C, or a number is beyond float.

    Examples
    --------
    >>> source = header(PiecewiseMotion([0.0, 0.1], [[0.0, 0.0, 300.0, -2000.0]]), "press")
    >>> [line for line in source.splitlines() if "double press_position" in line]
    ['static inline double press_position(double x)']
    """
    called = c_name(name)
    lines = program_heading(motion, labels or Labels(), [DOUBLE, SINGLE])
    comment = "\n".join(f" * {line}".rstrip() for line in safe([*lines, "", MARK]))
    guard = f"OPTLAWS_{called.upper()}_H"
    parts = [
        f"/* {called}: a motion law.\n *\n{comment}\n */\n#ifndef {guard}\n#define {guard}\n",
        *(_in(motion, called, single=single) for single in (False, True)),
        f"#endif /* {guard} */\n",
    ]
    return "\n".join(parts)


def c_name(name: Any) -> str:
    """The name of a function in C and C++, short enough for every compiler with what is added to it."""
    if isinstance(name, str) and _NAME.fullmatch(name) and name not in C_KEYWORDS and "__" not in name:
        return name
    words = re.sub(r"[^A-Za-z0-9]+", "_", name if isinstance(name, str) else "").strip("_")
    proposed = (words if words and words[0].isalpha() and words not in C_KEYWORDS else f"cam_{words}".rstrip("_"))[:31]
    raise InputError(
        f"C takes no name {shortened(name)}: letters, digits and single _, at most 31, no keyword; take {proposed!r}"
    )


def _in(motion: PiecewiseMotion, name: str, *, single: bool) -> str:
    """The tables and functions in one of the two floating-point types."""
    run = as_stored(motion, SINGLE if single else DOUBLE)
    f, suffix = ("_f", "F") if single else ("", "")
    texts = {
        "name": name,
        "f": f,
        "kind": "float" if single else "double",
        "last": len(run.breaks) - 1,
        "most": len(run.breaks) - 2,
        "degree": run.degree,
        "zero": f"0.0{suffix}",
        "two": f"2.0{suffix}",
        "six": f"6.0{suffix}",
    }
    functions = _FUNCTIONS.format(**texts)
    functions += "".join(_ONE.format(**texts, quantity=quantity, nu=nu) for nu, quantity in enumerate(QUANTITIES))
    return f"{_tables(run, texts['kind'], name + '_{}' + f, suffix)}\n{functions}"


def _tables(motion: PiecewiseMotion, kind: object, name: str, suffix: str) -> str:
    def numbers(values: tuple[float, ...] | list[float]) -> list[str]:
        return [real(value, single=bool(suffix)) + suffix for value in values]

    lines = [f"static const {kind} {name.format('breaks')}[{len(motion.breaks)}] = {{"]
    lines += [*wrapped(numbers(motion.breaks), "    "), "};"]
    lines += [
        f"static const {kind} {name.format('coefficients')}[{len(motion.coefficients)}][{motion.degree + 1}] = {{"
    ]
    for i, row in enumerate(motion.powers().tolist()):
        body = wrapped(numbers(row), "    ")
        body[0] = "    {" + body[0].lstrip()
        body[-1] += "}," if i + 1 < len(motion.coefficients) else "}"
        lines += body
    return "\n".join([*lines, "};\n"])


@file_format(
    "c99",
    target="C99, a header for double and float",
    contents="breaks and coefficients (double and float)",
    model=SOURCE_MODEL,
    limits=f"at most {SOURCE_PIECES} pieces, float for the functions with _f",
    extension=".h",
)
def _write(motion: Motion, request: Request) -> Written:
    fit, notes = source_polynomials(motion, request)
    text = header(fit.run, request.name, labels_of(motion, notes))
    return Written(text, fit.run, "polynomials in double", fit.count, "segments", notes=notes)
