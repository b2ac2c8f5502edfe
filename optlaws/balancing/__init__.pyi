# made by tests/contracts/faces.py from the table in __init__.py
from optlaws.balancing.balancing import Balancing as Balancing
from optlaws.balancing.dwells.choice import DwellComparison as DwellComparison
from optlaws.balancing.dwells.choice import compare_dwell_mechanisms as compare_dwell_mechanisms
from optlaws.balancing.dwells.choice import least_dwell as least_dwell
from optlaws.balancing.dwells.clutch import Clutch as Clutch
from optlaws.balancing.dwells.dwell_machine import DwellMachine as DwellMachine
from optlaws.balancing.dwells.dwell_machine import dwell_machine as dwell_machine
from optlaws.balancing.dwells.mechanism import DwellMechanism as DwellMechanism
from optlaws.balancing.dwells.mechanism import DwellType as DwellType
from optlaws.balancing.dwells.mechanism import dwell_mechanism as dwell_mechanism
from optlaws.balancing.dwells.sections import Section as Section
from optlaws.balancing.levers.design import find_torsion_levers as find_torsion_levers
from optlaws.balancing.levers.lever import TorsionLever as TorsionLever
from optlaws.balancing.levers.lever_cam import LeverCam as LeverCam
from optlaws.balancing.levers.lever_cam import rocker_law as rocker_law
from optlaws.balancing.levers.linkage import FourBar as FourBar
from optlaws.balancing.levers.motion import LeverMotion as LeverMotion
from optlaws.balancing.levers.sizing import LEAST_TRANSMISSION as LEAST_TRANSMISSION
from optlaws.balancing.levers.sizing import MOST_ROCKER_SWING as MOST_ROCKER_SWING
from optlaws.balancing.loaders.constants import B_loader as B_loader
from optlaws.balancing.loaders.constants import C_loader as C_loader
from optlaws.balancing.loaders.constants import D_loader as D_loader
from optlaws.balancing.loaders.law import LoaderLaw as LoaderLaw
from optlaws.balancing.loaders.limits import loader_acceleration_limit as loader_acceleration_limit
from optlaws.balancing.loaders.limits import loader_power_limit as loader_power_limit
from optlaws.balancing.loaders.limits import loader_velocity_limit as loader_velocity_limit
from optlaws.balancing.loaders.loader import Loader as Loader
from optlaws.balancing.loaders.loader import inertial_loader as inertial_loader
from optlaws.balancing.loaders.optimal import BalancedLaw as BalancedLaw
from optlaws.balancing.loaders.optimal import balanced_law as balanced_law
from optlaws.balancing.loaders.trapezium import TrapeziumSubstitute as TrapeziumSubstitute
from optlaws.balancing.loaders.trapezium import closed_form_Y as closed_form_Y

__all__ = [
    "LEAST_TRANSMISSION",
    "MOST_ROCKER_SWING",
    "B_loader",
    "BalancedLaw",
    "Balancing",
    "C_loader",
    "Clutch",
    "D_loader",
    "DwellComparison",
    "DwellMachine",
    "DwellMechanism",
    "DwellType",
    "FourBar",
    "LeverCam",
    "LeverMotion",
    "Loader",
    "LoaderLaw",
    "Section",
    "TorsionLever",
    "TrapeziumSubstitute",
    "balanced_law",
    "closed_form_Y",
    "compare_dwell_mechanisms",
    "dwell_machine",
    "dwell_mechanism",
    "find_torsion_levers",
    "inertial_loader",
    "least_dwell",
    "loader_acceleration_limit",
    "loader_power_limit",
    "loader_velocity_limit",
    "rocker_law",
]
