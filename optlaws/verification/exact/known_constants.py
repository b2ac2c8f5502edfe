"""Which constants are known exactly: those that optlaws itself defines, not what a subclass makes of them."""

from __future__ import annotations

from fractions import Fraction

from optlaws.errors import InputError
from optlaws.synthesis.functionals.kinds import FormulaIntegral, FormulaPeak, FormulaRms, FormulaValue
from optlaws.synthesis.problem.combined import CombinedPeak, CombinedPower
from optlaws.synthesis.problem.constants import PeakConstant, PeakJerk, PowerConstant, RootMeanSquare
from optlaws.synthesis.problem.expression import Term
from optlaws.synthesis.problem.named_constants import is_named
from optlaws.verification.machines.mode_residuals import ModeConstant
from optlaws.verification.machines.outputs import KnownOutput
from optlaws.verification.machines.residuals import ResidualConstant

OfFormula = FormulaIntegral | FormulaPeak | FormulaRms | FormulaValue
_OF_FORMULAS = {FormulaIntegral, FormulaPeak, FormulaRms, FormulaValue}
OfMachine = ResidualConstant | ModeConstant | KnownOutput
Known = PeakConstant | PowerConstant | RootMeanSquare | CombinedPeak | OfMachine | OfFormula

_OF_CAMS = tuple(f"{name}_cam(" for name in ("B", "C", "C_plus", "C_minus", "D", "J"))
_TOLD = (*_OF_CAMS, "residual(", "mode_residual(", "output_peak(", "output_rms(")


def known(term: Term) -> Known:
    """The constant, if it is one of a law, of its cam, of a machine, or of a formula, as optlaws itself defines them.

    Raises
    ------
    InputError
        If it is any other: what a subclass means, nobody has put into exact arithmetic.

    Examples
    --------
    >>> from optlaws.synthesis.problem.constants import C
    >>> known(C).nu
    2
    """
    if type(term) in {PeakConstant, PeakJerk, RootMeanSquare} and isinstance(term, PeakConstant | RootMeanSquare):
        return term
    if type(term) is PowerConstant and tuple(term.weights) == (Fraction(1),):
        return term
    if isinstance(term, CombinedPeak | CombinedPower | OfMachine) and repr(term).startswith(_TOLD) and is_named(term):
        return term
    if type(term) in _OF_FORMULAS and isinstance(term, OfFormula) and is_named(term):
        return term
    raise InputError(
        "exact verification knows peaks, power and RMS of derivatives, constants of cams, of machines and "
        f"of formulas as optlaws defines them, not {term!r}: what bounds it is checked with numpy alone, by "
        "Certificate.bound"
    )
