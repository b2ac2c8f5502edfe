"""Motion laws: what they are, their values and their peaks. Imports no optimiser."""

from optlaws.laws.law import MotionLaw
from optlaws.laws.peaks import Constants, Peak
from optlaws.laws.polynomial import PolynomialLaw, smoothstep

__all__ = ["Constants", "MotionLaw", "Peak", "PolynomialLaw", "smoothstep"]
