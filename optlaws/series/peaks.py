"""Peaks and constants of laws where pickles made before look for them."""

from optlaws.laws.constants import Constants
from optlaws.numerics.peaks import Peak

__all__ = ["Constants", "Peak"]
