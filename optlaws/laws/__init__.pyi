from .constants import Constants as Constants
from .law import MotionLaw as MotionLaw, Peak as Peak
from .making.trapezoids import from_half as from_half
from .polynomial import PolynomialLaw as PolynomialLaw, smoothstep as smoothstep
