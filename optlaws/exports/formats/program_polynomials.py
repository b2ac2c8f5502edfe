"""The polynomials of a request, and the comments, fields and checks that formats of polynomials share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from optlaws.errors import InputError
from optlaws.exports.error_bounds import SINGLE, error_bounds
from optlaws.exports.format import BEST, Request
from optlaws.exports.polynomial_pieces import OFF, Fitted, exactly, fitted
from optlaws.exports.text import Labels, iec_comment, program_heading, real, rounded_up
from optlaws.files.writing import MARK
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion

_POLYNOMIAL_ROUNDING = 1e-9  # of a derivative: where polynomials of a controller meet
_SOURCE_CODE_OFF = 1e-6  # of the acceleration's peak: how far polynomials of source code may be off

#: of source code: the degree of polynomials for laws that are none, and of laws whose own polynomials are taken
SOURCE_DEGREE, OWN_DEGREE = 9, 40
SOURCE_PIECES = 1000
SOURCE_MODEL = f"the law's own polynomials to degree {OWN_DEGREE}, else of degree {SOURCE_DEGREE}"


def polynomials_for(
    motion: Motion, request: Request, degree: int, most: int, *, points: bool = False, near: float = OFF
) -> Fitted:
    """Polynomials up to a degree: a given number, or as few as the accuracy `near` of the acceleration needs.

    The request's `points` are segments, or points, of which there is one more, where `points` says so.
    """
    if request.points is None:
        return fitted(motion, degree, most, near=near)
    if request.points == BEST:
        # said for one version more, in which scripts may still have it
        raise InputError(
            "points: 'best' is of tables of points: leave points out for the fewest polynomials that keep the "
            "acceleration within a thousandth of its peak, or give their number"
        )
    count = int(request.points) - points
    if count > most:
        raise InputError(f"points must be at most {most + points}, which the target holds, got {request.points}")
    return fitted(motion, degree, most, count)


def source_polynomials(motion: Motion, request: Request) -> tuple[Fitted, tuple[str, ...]]:
    """The polynomials of source code: the law's own, cut where powers would lose digits, or approximations."""
    fit = None if request.points else exactly(motion, OWN_DEGREE)
    fit = fit or polynomials_for(motion, request, SOURCE_DEGREE, SOURCE_PIECES, near=_SOURCE_CODE_OFF)
    return fit, (fit.in_words(motion.units.slave),)


def labels_of(motion: Motion, notes: Sequence[str] = ()) -> Labels:
    """Units of a motion, and notes, for comments."""
    rate = motion.units.rate
    speed = (
        [] if rate is None or motion.units.master == "s" else [f"the master goes {rate:.9g} {motion.units.master}/s"]
    )
    return Labels(motion.units.master, motion.units.slave, (*speed, *motion.proof, *notes))


def iec_heading(title: str, motion: Motion, run: PiecewiseMotion, notes: Sequence[str]) -> str:
    """The comment at the head of a program in a language of IEC 61131-3."""
    return iec_comment((title, *program_heading(run, labels_of(motion, notes), []), MARK))


def fields(**values: object) -> str:
    """Fields of a structure with their values, floats as literals.

    >>> fields(PointIndex=1, MasterPos=0.5)
    'PointIndex := 1, MasterPos := 0.5'
    """
    texts = ((name, real(value) if isinstance(value, float) else str(value)) for name, value in values.items())
    return ", ".join(f"{name} := {text}" for name, text in texts)


def jumps_of_single(run: PiecewiseMotion) -> tuple[float, ...]:
    """The greatest jumps of velocity, acceleration and jerk where polynomials meet, for the rounding of REAL32."""
    return tuple(2.0 * bound for bound in error_bounds(run, SINGLE)[1:])


def jumps_in_words(motion: Motion, jumps: tuple[float, ...]) -> str:
    """The jumps of a motion in words."""
    units = labels_of(motion)
    words = ", ".join(f"{rounded_up(jump)} {units.unit(nu)}" for nu, jump in enumerate(jumps, start=1))
    return f"jumps at joints by at most {words} are roundings of REAL32"


class Ends(NamedTuple):
    """A piece by its ends: places of the master, and y, V, A, ... just inside each."""

    x: tuple[float, float]
    first: tuple[float, ...]
    last: tuple[float, ...]


def ends_of(motion: Motion, run: PiecewiseMotion, orders: int) -> list[Ends]:
    """Pieces by their ends; where nothing but rounding jumps both sides of a joint have the same values.

    Positions that powers end at miss by their roundings; what the next piece begins with, and the motion's own end,
    do not.
    """
    firsts, lasts = [], []
    for nu in range(orders):
        first, ends_here = run.ends(nu)
        known = np.append(first[1:], motion.ends(nu)[1])
        lasts.append(np.where(np.abs(known - ends_here) <= rounding(run, nu), known, ends_here).tolist())
        firsts.append(first.tolist())
    places = zip(run.breaks, run.breaks[1:], strict=False)
    return [Ends(*joint) for joint in zip(places, zip(*firsts, strict=True), zip(*lasts, strict=True), strict=True)]


def rounding(run: PiecewiseMotion, nu: int) -> float:
    """The greatest jump of the derivative of order nu that is no more than rounding."""
    size = max(abs(extreme.value) for extreme in run.extremes(nu))
    # positions are rounded, and what is left of that in a derivative grows as pieces get shorter
    return float(max(_POLYNOMIAL_ROUNDING * size, 2.0**-44 * run.peak(0).value / float(run.lengths.min()) ** nu))


def jumping(run: PiecewiseMotion, nu: int) -> float | None:
    """The first break where the derivative of order nu jumps by more than rounding; None without such a break."""
    small = rounding(run, nu)
    for x, jump in zip(run.breaks[1:], run.jumps(nu).tolist(), strict=False):
        if abs(jump) > small:
            return x
    return None


def refuse_jumps(motion: Motion, run: PiecewiseMotion, holder: str, remedy: str) -> None:
    """Refuse polynomials whose velocity or acceleration jumps, for what holds one value of each at a point."""
    for nu, quantity in ((1, "velocity"), (2, "acceleration")):
        x = jumping(run, nu)
        if x is not None:
            place = f"x = {x:.9g} {motion.units.master}"
            raise InputError(f"the {quantity} jumps at {place}, and {holder} holds one value of it: {remedy}")
