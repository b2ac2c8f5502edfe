"""Source code as formats: a function block in Structured Text and a C99 header, which evaluate a motion themselves."""

from __future__ import annotations

from optlaws.exports.code.c99 import header
from optlaws.exports.code.error_bounds import SINGLE, as_stored
from optlaws.exports.code.structured_text import function_block
from optlaws.exports.controllers.polynomials_of import labels_of, leaps_in_words, leaps_of_single, polynomials_for
from optlaws.exports.format import Format, Request, Written, register
from optlaws.exports.pieces.fitting import Fitted, exactly
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion

#: of polynomials for laws that are none, and of laws whose own polynomials are taken
DEGREE, HIGHEST = 9, 40
MOST = 1000
NEAR = 1e-6


def _fit(motion: Motion, request: Request) -> tuple[Fitted, tuple[str, ...]]:
    """The law's own polynomials, cut short where their powers would lose digits; else near ones."""
    fit = polynomials_for(motion, request, DEGREE, MOST, near=NEAR) if request.points else exactly(motion, HIGHEST)
    fit = fit or polynomials_for(motion, request, DEGREE, MOST, near=NEAR)
    return fit, (fit.in_words(motion.units.slave),)


def _block(motion: Motion, request: Request, *, single: bool) -> Written:
    fit, notes = _fit(motion, request)
    text = function_block(fit.run, request.name, labels_of(motion, notes), single=single)
    if not single:
        return Written(text, fit.run, "polynomials in LREAL", fit.count, "segments", notes=notes)
    roundings = leaps_of_single(fit.run)
    notes = (*notes, leaps_in_words(motion, roundings))
    run = _single(fit.run)
    return Written(text, run, "polynomials in REAL", fit.count, "segments", notes=notes, roundings=roundings)


def _single(run: PiecewiseMotion) -> PiecewiseMotion:
    """The polynomials in REAL32 where the motion lies: its ends stay, which REAL32 may round."""
    stored = as_stored(run, SINGLE)
    return PiecewiseMotion((run.start, *stored.breaks[1:-1], run.stop), stored.coefficients)


def _lreal(motion: Motion, request: Request) -> Written:
    return _block(motion, request, single=False)


def _real(motion: Motion, request: Request) -> Written:
    return _block(motion, request, single=True)


def _header(motion: Motion, request: Request) -> Written:
    fit, notes = _fit(motion, request)
    text = header(fit.run, request.name, labels_of(motion, notes))
    return Written(text, fit.run, "polynomials in double", fit.count, "segments", notes=notes)


LREAL = register(
    Format(
        name="iec-st",
        target="IEC 61131-3, a function block in Structured Text",
        contents="breaks and coefficients (LREAL)",
        model=f"the law's own polynomials to degree {HIGHEST}, else of degree {DEGREE}",
        limits=f"at most {MOST} pieces",
        extension=".st",
        write=_lreal,
    )
)
REAL = register(
    Format(
        name="iec-st-real",
        target="IEC 61131-3, a function block in Structured Text, in REAL",
        contents="breaks and coefficients (REAL)",
        model=f"the law's own polynomials to degree {HIGHEST}, else of degree {DEGREE}, in REAL32",
        limits=f"at most {MOST} pieces, REAL32",
        extension=".st",
        write=_real,
    )
)
C99 = register(
    Format(
        name="c99",
        target="C99, a header for double and float",
        contents="breaks and coefficients (double and float)",
        model=f"the law's own polynomials to degree {HIGHEST}, else of degree {DEGREE}",
        limits=f"at most {MOST} pieces, float for the functions with _f",
        extension=".h",
        write=_header,
    )
)
