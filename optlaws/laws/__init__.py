"""Motion laws: what they are, their values and their peaks. Imports no optimiser."""

from optlaws.laws.law import MotionLaw
from optlaws.laws.polynomial import PolynomialLaw, smoothstep
from optlaws.series.peaks import Constants, Peak

__all__ = ["Constants", "MotionLaw", "Peak", "PolynomialLaw", "smoothstep"]
