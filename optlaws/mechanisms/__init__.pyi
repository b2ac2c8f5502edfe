# made by tests/contracts/faces.py from the table in __init__.py
from optlaws.mechanisms.drives.drive_train import Drive as Drive
from optlaws.mechanisms.drives.motor import Motor as Motor
from optlaws.mechanisms.drives.motor import read_motors as read_motors
from optlaws.mechanisms.linkages.bodies import Body as Body
from optlaws.mechanisms.linkages.bodies import Loads as Loads
from optlaws.mechanisms.linkages.four_bar import four_bar as four_bar
from optlaws.mechanisms.linkages.mechanism import Mechanism as Mechanism
from optlaws.mechanisms.linkages.motions import belt as belt
from optlaws.mechanisms.linkages.motions import mechanism_of_motion as mechanism_of_motion
from optlaws.mechanisms.linkages.motions import rack as rack
from optlaws.mechanisms.linkages.motions import screw as screw
from optlaws.mechanisms.linkages.move_limit import MoveLimit as MoveLimit
from optlaws.mechanisms.linkages.slider_crank import slider_crank as slider_crank
from optlaws.mechanisms.linkages.toggle import toggle as toggle
from optlaws.mechanisms.machine.follower import Deviation as Deviation
from optlaws.mechanisms.machine.follower import Follower as Follower
from optlaws.mechanisms.machine.follower import off_design as off_design
from optlaws.mechanisms.machine.machine import Machine as Machine
from optlaws.mechanisms.machine.masses import Link as Link
from optlaws.mechanisms.machine.response import CycleResponse as CycleResponse
from optlaws.mechanisms.machine.response import Response as Response
from optlaws.mechanisms.polydyne_cam import mass_law as mass_law
from optlaws.mechanisms.polydyne_cam import polydyne as polydyne
from optlaws.mechanisms.residual import residual_functional as residual_functional
from optlaws.mechanisms.residual import residual_phasor as residual_phasor
from optlaws.mechanisms.spectrum import ResponseSpectrum as ResponseSpectrum
from optlaws.mechanisms.spectrum import response_spectrum as response_spectrum
from optlaws.numbers import deg as deg

__all__ = [
    "Body",
    "CycleResponse",
    "Deviation",
    "Drive",
    "Follower",
    "Link",
    "Loads",
    "Machine",
    "Mechanism",
    "Motor",
    "MoveLimit",
    "Response",
    "ResponseSpectrum",
    "belt",
    "deg",
    "four_bar",
    "mass_law",
    "mechanism_of_motion",
    "off_design",
    "polydyne",
    "rack",
    "read_motors",
    "residual_functional",
    "residual_phasor",
    "response_spectrum",
    "screw",
    "slider_crank",
    "toggle",
]
