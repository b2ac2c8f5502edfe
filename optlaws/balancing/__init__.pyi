from .balancing import Balancing as Balancing
from .dwells.choice import (
    DwellComparison as DwellComparison,
    compare_dwell_mechanisms as compare_dwell_mechanisms,
    least_dwell as least_dwell,
)
from .dwells.clutch import Clutch as Clutch
from .dwells.dwell_machine import DwellMachine as DwellMachine, dwell_machine as dwell_machine
from .dwells.mechanism import (
    DwellMechanism as DwellMechanism,
    DwellType as DwellType,
    dwell_mechanism as dwell_mechanism,
)
from .dwells.sections import Section as Section
from .levers.design import find_torsion_levers as find_torsion_levers
from .levers.lever import TorsionLever as TorsionLever
from .levers.lever_cam import LeverCam as LeverCam, rocker_law as rocker_law
from .levers.linkage import FourBar as FourBar
from .levers.motion import LeverMotion as LeverMotion
from .levers.sizing import LEAST_TRANSMISSION as LEAST_TRANSMISSION, MOST_ROCKER_SWING as MOST_ROCKER_SWING
from .loaders.constants import B_loader as B_loader, C_loader as C_loader, D_loader as D_loader
from .loaders.law import LoaderLaw as LoaderLaw
from .loaders.limits import (
    loader_acceleration_limit as loader_acceleration_limit,
    loader_power_limit as loader_power_limit,
    loader_velocity_limit as loader_velocity_limit,
)
from .loaders.loader import Loader as Loader, inertial_loader as inertial_loader
from .loaders.optimal import BalancedLaw as BalancedLaw, balanced_law as balanced_law
from .loaders.trapezium import TrapeziumSubstitute as TrapeziumSubstitute, closed_form_Y as closed_form_Y
