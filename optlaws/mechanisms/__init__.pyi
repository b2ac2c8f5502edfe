from .drives.drive_train import Drive as Drive
from .drives.motor import Motor as Motor, read_motors as read_motors
from .linkages.mechanism import Mechanism as Mechanism
from .linkages.mechanism_kinds import (
    Body as Body,
    Loads as Loads,
    belt as belt,
    mechanism_of_motion as mechanism_of_motion,
    rack as rack,
    screw as screw,
)
from .linkages.move_limit import MoveLimit as MoveLimit
from .linkages.plane_linkages import four_bar as four_bar, slider_crank as slider_crank, toggle as toggle
from .machine.follower import Deviation as Deviation, Follower as Follower, off_design as off_design
from .machine.machine import Machine as Machine
from .machine.models import Link as Link
from .machine.polydyne import mass_law as mass_law, polydyne as polydyne
from .machine.response import CycleResponse as CycleResponse, Response as Response
from .machine.spectrum import ResponseSpectrum as ResponseSpectrum, response_spectrum as response_spectrum
from .machine.transforms import residual_functional as residual_functional, residual_phasor as residual_phasor
