"""What a generated program says of itself: its motion, its numbers, how exact it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from decimal import ROUND_CEILING, Context

from optlaws.exports.code.error_bounds import FloatingPoint, error_bounds
from optlaws.motion.polynomials import PiecewiseMotion

QUANTITIES = ("position", "velocity", "acceleration", "jerk")


@dataclass(frozen=True)
class Labels:
    """Units of master and slave as comments write them, and whatever else a program shall say.

    Examples
    --------
    >>> Labels("s", "mm").unit(2)
    'mm/s^2'
    """

    master: str = "s"
    slave: str = "mm"
    notes: tuple[str, ...] = ()

    def unit(self, nu: int) -> str:
        """The unit of a derivative."""
        return self.slave if nu == 0 else f"{self.slave}/{self.master}" + (f"^{nu}" if nu > 1 else "")


def heading(motion: PiecewiseMotion, labels: Labels, arithmetics: Sequence[FloatingPoint]) -> list[str]:
    """Lines that say what a program evaluates, its peaks, and the bound of its rounding errors.

    Examples
    --------
    >>> heading(PiecewiseMotion([0, 1], [[0, 0, 3, -2]]), Labels("s", "mm"), [])[0]
    'y(x) in mm for x from 0.0 to 1.0 s: 1 polynomial of degree 3'
    """
    count = len(motion.coefficients)
    plural = "s" if count > 1 else ""
    interval = f"for x from {motion.start!r} to {motion.stop!r} {labels.master}"
    lines = [
        f"y(x) in {labels.slave} {interval}: {count} polynomial{plural} of degree {motion.degree}",
        *labels.notes,
        *(_peaks(motion, nu, labels.unit(nu)) for nu in range(len(QUANTITIES))),
    ]
    for arithmetic in arithmetics:
        bounds = error_bounds(motion, arithmetic)
        bounds_in_words = ", ".join(f"{rounded_up(bound)} {labels.unit(nu)}" for nu, bound in enumerate(bounds))
        lines += [f"rounding in {arithmetic.name}, proven, at most: {bounds_in_words}"]
    return lines


def rounded_up(bound: float) -> str:
    """A bound in three digits, none below it.

    Examples
    --------
    >>> rounded_up(2.7101e-5)
    '2.72e-05'
    """
    return f"{Context(prec=3, rounding=ROUND_CEILING).create_decimal_from_float(bound):.2e}"


def _peaks(motion: PiecewiseMotion, nu: int, unit: str) -> str:
    low, high = motion.extremes(nu)
    return f"{QUANTITIES[nu]} from {low.value:.9g} at x = {low.x:.9g} to {high.value:.9g} at x = {high.x:.9g} {unit}"
