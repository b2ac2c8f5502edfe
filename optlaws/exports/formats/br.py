"""B&R ACP10: cam profiles of REAL32 polynomials to degree 6 over whole-number periods (MC_CAMPROFILE_TYP)."""

from __future__ import annotations

from fractions import Fraction

from optlaws.errors import InputError
from optlaws.exports.error_bounds import SINGLE, as_stored
from optlaws.exports.format import Request, Written, file_format
from optlaws.exports.polynomial_pieces import iec_heading, jumps_in_words, jumps_of_single, polynomials_for
from optlaws.exports.text import iec_name, real
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion

_WHOLE_NUMBER = 1e-6  # a number of a controller so near to a whole one is meant to be whole

DEGREE = 6
MOST = 64
LARGEST = 2**31 - 1
CLOSES = 0.1  # warning 37111 of the drive begins there
_LETTERS = "abcdefgx"


@file_format(
    "br-acp10",
    target="B&R ACP10, MC_CAMPROFILE_TYP",
    contents="MasterPeriod, SlavePeriod (DINT), PolynomialNumber, a ... g, x (REAL32)",
    model="REAL32 polynomials to degree 6",
    limits=f"at most {MOST} polynomials, whole-number periods, REAL32, the first begins at 0 (error 5304)",
    extension=".var",
    takes=("points", "counts"),
)
def _write(motion: Motion, request: Request) -> Written:
    name = iec_name(request.name, "B&R")
    scale = 1.0 if request.counts is None else request.counts / motion.stroke
    master = _period(motion.length, "master", motion.units.master, least=1)
    slave = _period(scale * motion.advance, "slave", motion.units.slave, least=-LARGEST)
    fit = polynomials_for(motion, request, DEGREE, MOST)
    profile = _profile(fit.run, scale, master, slave)
    run, roundings = _as_run(profile, fit.run, scale), jumps_of_single(fit.run)
    notes = (
        fit.in_words(motion.units.slave),
        jumps_in_words(motion, roundings),
        "powers of each polynomial count from where it begins, x is where it ends: compare a point before use",
        *(() if request.counts is None else (f"slave in increments, {request.counts} over the stroke",)),
    )
    rows = [
        ", ".join(
            f"{letter} := {real(number, single=True)}"
            for letter, number in zip(_LETTERS, (*row, *[0.0] * (DEGREE + 1 - len(row)), x), strict=True)
        )
        for row, x in zip(profile.coefficients, profile.breaks[1:], strict=True)
    ]
    head = f"MasterPeriod := {master}, SlavePeriod := {slave}, PolynomialNumber := {len(rows)}"
    text = "\n".join(
        [
            iec_heading(f"{name}: a cam profile for B&R ACP10, MC_CAMPROFILE_TYP", motion, run, notes) + "VAR",
            f"    {name} : MC_CAMPROFILE_TYP := ({head}, PolynomialData := [",
            ",\n".join(f"        ({row})" for row in rows) + "]);",
            "END_VAR",
            "",
        ]
    )
    return Written(text, run, "REAL32 polynomials to degree 6", len(rows), "segments", notes=notes, roundings=roundings)


def _period(value: float, of: str, unit: str, least: int) -> int:
    whole = round(value)
    if abs(value - whole) > _WHOLE_NUMBER * max(1.0, abs(value)) or not least <= whole <= LARGEST:
        remedies = {"master": "master='360 deg'", "slave": "another unit or stroke, or counts=..."}
        raise InputError(
            f"B&R takes whole-number periods (DINT), and that of the {of} is {value:.9g} {unit}: choose {remedies[of]}"
        )
    return whole


def _profile(run: PiecewiseMotion, scale: float, master: int, slave: int) -> PiecewiseMotion:
    """The polynomials from 0 to the master's period in REAL32, the first from 0; the drive's checks pass."""
    first = Fraction(run.coefficients[0][0])
    rows = [[Fraction(c) * Fraction(scale) for c in row] for row in run.coefficients]
    for row in rows:
        row[0] -= first * Fraction(scale)
    breaks = [float(Fraction(x) - Fraction(run.start)) for x in run.breaks[:-1]] + [float(master)]
    stored = as_stored(PiecewiseMotion(breaks, [[float(c) for c in row] for row in rows]), SINGLE)
    off = abs(float(stored.ends(0)[1][-1]) - slave)
    if off > CLOSES:
        raise InputError(
            f"in REAL32 the last polynomial ends {off:.3g} beside the slave's period {slave}, which the drive refuses "
            f"(5304, 37111: at most {CLOSES}): take fewer counts, a larger unit, or more pieces"
        )
    return stored


def _as_run(profile: PiecewiseMotion, exact: PiecewiseMotion, scale: float) -> PiecewiseMotion:
    """The motion that the drive runs, where the exact one lies and in its units."""
    rows = [[c / scale for c in row] for row in profile.coefficients]
    for row in rows:
        row[0] += exact.coefficients[0][0]
    breaks = [x + exact.start for x in profile.breaks[:-1]] + [exact.stop]
    return PiecewiseMotion(breaks, rows)
