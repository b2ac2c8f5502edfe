"""Source code as formats: a function block in Structured Text and a C99 header, which evaluate a motion themselves."""

from __future__ import annotations

from optlaws.exports.code.c99 import header
from optlaws.exports.code.error_bounds import SINGLE, held
from optlaws.exports.code.structured_text import function_block
from optlaws.exports.controllers.polynomials_of import asked, labels_of, leaps_of_single, said_of_leaps
from optlaws.exports.format import Format, Request, Written, declared
from optlaws.exports.motion import Motion
from optlaws.exports.pieces.fitting import Fitted, exactly
from optlaws.exports.polynomials import PiecewiseMotion

#: of polynomials for laws that are none, and of laws whose own polynomials are taken
DEGREE, HIGHEST = 9, 40
MOST = 1000
NEAR = 1e-6


def _made(motion: Motion, request: Request) -> tuple[Fitted, tuple[str, ...]]:
    """The law's own polynomials, cut short where their powers would lose digits; else near ones."""
    made = asked(motion, request, DEGREE, MOST, near=NEAR) if request.points else exactly(motion, HIGHEST)
    made = made or asked(motion, request, DEGREE, MOST, near=NEAR)
    return made, (made.said(motion.units.slave),)


def _block(motion: Motion, request: Request, *, single: bool) -> Written:
    made, notes = _made(motion, request)
    text = function_block(made.run, request.name, labels_of(motion, notes), single=single)
    if not single:
        return Written(text, made.run, "polynomials in LREAL", made.count, "segments", notes=notes)
    roundings = leaps_of_single(made.run)
    notes = (*notes, said_of_leaps(motion, roundings))
    run = _single(made.run)
    return Written(text, run, "polynomials in REAL", made.count, "segments", notes=notes, roundings=roundings)


def _single(run: PiecewiseMotion) -> PiecewiseMotion:
    """The polynomials in REAL32 where the motion lies: its ends stay, which REAL32 may round."""
    made = held(run, SINGLE)
    return PiecewiseMotion((run.start, *made.breaks[1:-1], run.stop), made.coefficients)


def _lreal(motion: Motion, request: Request) -> Written:
    return _block(motion, request, single=False)


def _real(motion: Motion, request: Request) -> Written:
    return _block(motion, request, single=True)


def _header(motion: Motion, request: Request) -> Written:
    made, notes = _made(motion, request)
    text = header(made.run, request.name, labels_of(motion, notes))
    return Written(text, made.run, "polynomials in double", made.count, "segments", notes=notes)


LREAL = declared(
    Format(
        name="iec-st",
        target="IEC 61131-3, a function block in Structured Text",
        held="breaks and coefficients (LREAL)",
        model=f"the law's own polynomials to degree {HIGHEST}, else of degree {DEGREE}",
        limits=f"at most {MOST} pieces",
        extension=".st",
        write=_lreal,
    )
)
REAL = declared(
    Format(
        name="iec-st-real",
        target="IEC 61131-3, a function block in Structured Text, in REAL",
        held="breaks and coefficients (REAL)",
        model=f"the law's own polynomials to degree {HIGHEST}, else of degree {DEGREE}, in REAL32",
        limits=f"at most {MOST} pieces, REAL32",
        extension=".st",
        write=_real,
    )
)
C99 = declared(
    Format(
        name="c99",
        target="C99, a header for double and float",
        held="breaks and coefficients (double and float)",
        model=f"the law's own polynomials to degree {HIGHEST}, else of degree {DEGREE}",
        limits=f"at most {MOST} pieces, float for the functions with _f",
        extension=".h",
        write=_header,
    )
)
