"""Lower bounds of constants, in exact numbers for machines' constants."""

from __future__ import annotations

from fractions import Fraction
from math import inf

from flint import fmpq

from optlaws.mechanisms.machine.output_constants import OutputPeak
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.verification.enclosing.balls import rational
from optlaws.verification.machines.transfer import Transfer


def floor(constant: Functional, conditions: BoundaryConditions) -> Fraction | float:
    """A lower bound of a constant in laws with these end conditions; minus infinity if nothing is known.

    A peak of one side of an output may be below 0, but not below the output where the law begins.
    """
    if not isinstance(constant, OutputPeak) or len(constant.signs) == 2:
        return constant.floor(conditions)
    start = conditions.start
    if constant.steady or constant.cycle is not None or constant.within[0] > 0.0:
        return -inf
    transfer = Transfer(constant.machine, constant.output)
    order, direct = transfer.order, transfer.direct
    drifts = transfer.characteristic(fmpq(0)) == 0
    if order + direct.degree() >= len(start) or (start[0] and drifts):
        return -inf
    still = transfer.laurent(0)[0] * rational(start[0]) if start[0] and not order else fmpq(0)
    begun = sum((direct[i - order] * rational(start[i]) for i in range(1, order + direct.degree() + 1)), fmpq(0))
    value = (still + begun) * int(constant.signs[0])
    return Fraction(int(value.p), int(value.q)) + Fraction(constant.signs[0]) * Fraction(constant.offset)
