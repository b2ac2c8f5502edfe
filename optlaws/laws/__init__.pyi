from .law import Constants as Constants, MotionLaw as MotionLaw, Peak as Peak
from .making.trapezoids import from_half as from_half
from .polynomial import PolynomialLaw as PolynomialLaw, smoothstep as smoothstep
