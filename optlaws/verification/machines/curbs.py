"""How large a law can be whose output is small: what the inverse machine makes of the output."""

from __future__ import annotations

from fractions import Fraction
from math import inf

from flint import acb_mat, arb, arb_mat, fmpq, fmpq_poly

from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.verification.enclosing.balls import ball, rational
from optlaws.verification.machines.output_motion import Motion, Stretch
from optlaws.verification.machines.outputs import OutputConstant, OutputPeak
from optlaws.verification.machines.taylor_cells import mean_magnitude
from optlaws.verification.machines.transfer import Rational, Transfer

_S = fmpq_poly([0, 1])


def floor(constant: Functional, conditions: BoundaryConditions) -> Fraction | float:
    """What a constant is at least in laws with these end conditions; minus infinity where nothing is known.

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


def curb(constant: OutputConstant) -> tuple[int, arb] | None:
    """An order and a factor: the mean of |a^(order)| is at most the factor times that of |output|.

    That is so in laws from rest at 0, the latter over all the time that counts. The highest derivative that enters the
    output at once is a share of the output, and the integral of an impulse's response of the inverse machine times the
    output. None where nothing enters at once, where the law's interval does not count from its start on, or for
    one side.
    """
    first, last = map(Fraction, constant.within)
    if isinstance(constant, OutputPeak) and len(constant.signs) == 1:
        return None
    transfer = Transfer(constant.machine, constant.output)
    order = transfer.order + transfer.direct.degree()
    if constant.steady or constant.cycle is not None or first > 0 or last < 1 or order < transfer.order:
        return None
    inverse = Rational(transfer.denominator * _S ** (order - transfer.order), transfer.numerator)
    share = abs(arb(inverse.direct[0]))
    return order, (share + _impulse(inverse)) * ball(last)


def _impulse(inverse: Rational) -> arb:
    """The integral over [0, 1] of the magnitude of the response to an impulse, but for the impulse itself."""
    poles = inverse.poles()
    free = [acb_mat([[share] for share in pole.shares]) for pole in poles]
    start, stop = Fraction(0), Fraction(1)
    return mean_magnitude(Motion(poles, [Stretch(start, stop, arb_mat(1, 1), free)], 1), start, stop)
