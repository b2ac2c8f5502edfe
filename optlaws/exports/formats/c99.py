"""A motion as a C99 header: no allocation, no library, double and float, errors bounded and proven."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.exports.error_bounds import DOUBLE, SINGLE, as_stored
from optlaws.exports.format import Request, Written, file_format
from optlaws.exports.formats.program_polynomials import SOURCE_MODEL, SOURCE_PIECES, labels_of, source_polynomials
from optlaws.exports.program_text import c_array, c_row, filled, template
from optlaws.exports.text import C_KEYWORDS, Labels, program_heading, real, safe
from optlaws.files.writing import MARK
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,30}")


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
    run, source = as_stored(motion, SINGLE if single else DOUBLE), template("motion.h")
    kind, f, suffix = ("float", "_f", "F") if single else ("double", "", "")
    if single:
        source = re.sub(r"\bname_\w+", r"\g<0>_f", source.replace("double", kind))
        source = re.sub(r"\b\d\.\d", r"\g<0>F", source)

    def numbers(values: Sequence[float]) -> list[str]:
        return [real(value, single=single) + suffix for value in values]

    rows, last = run.powers().tolist(), len(run.breaks) - 1
    tables = [
        *c_array(f"{kind} {name}_breaks{f}[{last + 1}]", numbers(run.breaks)),
        f"static const {kind} {name}_coefficients{f}[{last}][{run.degree + 1}] = {{",
        ",\n".join(c_row(numbers(row)) for row in rows),
        "};",
    ]
    words = {"name": name, "LAST": last, "LAST_PIECE": last - 1, "DEGREE": run.degree, "TABLES": tables}
    return filled(source, words)


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
