# made by tests/contracts/faces.py from the table in __init__.py
from optlaws.laws.constants import Constants as Constants
from optlaws.laws.law import MotionLaw as MotionLaw
from optlaws.laws.making.trapezoids import from_half as from_half
from optlaws.laws.polynomial import PolynomialLaw as PolynomialLaw
from optlaws.laws.polynomial import smoothstep as smoothstep
from optlaws.numerics.peaks import Peak as Peak

__all__ = [
    "Constants",
    "MotionLaw",
    "Peak",
    "PolynomialLaw",
    "from_half",
    "smoothstep",
]
