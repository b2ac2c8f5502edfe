"""Internals of `optlaws.balancing` that tests look at by themselves."""

from optlaws.balancing.dwells.choice import least_dwell
from optlaws.balancing.dwells.mechanism import DwellMechanism, DwellType
from optlaws.balancing.dwells.sections import PartSegment
from optlaws.balancing.levers.design import QUANTITIES
from optlaws.balancing.levers.lever import swung, upper_extreme
from optlaws.balancing.levers.linkage import FourBar
from optlaws.balancing.levers.motion import LeverMotion
from optlaws.balancing.loaders.constants import NAMES, B_loader, C_loader, D_loader, LoaderPeak
from optlaws.balancing.loaders.law import LoaderLaw
from optlaws.balancing.loaders.limits import loader_acceleration_limit, loader_power_limit, loader_velocity_limit
from optlaws.balancing.loaders.segment import LoaderSegment
from optlaws.balancing.loaders.trapezium import closed_form_Y
