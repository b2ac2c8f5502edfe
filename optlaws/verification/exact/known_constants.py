"""Which constants are known exactly: those that optlaws itself defines, not what a subclass makes of them."""

from __future__ import annotations

from fractions import Fraction

from optlaws.errors import InputError
from optlaws.synthesis.problem.constants import Peak, PeakJerk, Power, RootMeanSquare
from optlaws.synthesis.problem.expression import Term

Known = Peak | Power | RootMeanSquare


def known(term: Term) -> Known:
    """The constant, if it is a peak, the power or an RMS.

    Raises
    ------
    InputError
        If it is of any other class: what a subclass means, nobody has put into exact arithmetic.

    Examples
    --------
    >>> from optlaws.synthesis.problem.constants import C
    >>> known(C).nu
    2
    """
    if type(term) in {Peak, PeakJerk, RootMeanSquare} and isinstance(term, Peak | RootMeanSquare):
        return term
    if type(term) is Power and tuple(term.weights) == (Fraction(1),):
        return term
    raise InputError(
        f"exact verification knows peaks, power and RMS of derivatives as optlaws defines them, not {term!r}: "
        "what bounds it is checked with numpy alone, by Certificate.bound"
    )
