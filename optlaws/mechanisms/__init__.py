"""What laws do in machines: elastic followers and the cams made for them."""

from optlaws.mechanisms.angles import deg
from optlaws.mechanisms.follower.cycle import CycleResponse
from optlaws.mechanisms.follower.follower import Follower
from optlaws.mechanisms.follower.off_design import Deviation, off_design
from optlaws.mechanisms.follower.response import Response
from optlaws.mechanisms.lever.design import find_torsion_levers
from optlaws.mechanisms.lever.lever import TorsionLever
from optlaws.mechanisms.lever.motion import LeverMotion
from optlaws.mechanisms.polydyne.polydyne import mass_law, polydyne
from optlaws.mechanisms.spectrum.residual import residual_functional, residual_phasor
from optlaws.mechanisms.spectrum.spectrum import ResponseSpectrum, response_spectrum

__all__ = [
    "CycleResponse",
    "Deviation",
    "Follower",
    "LeverMotion",
    "Response",
    "ResponseSpectrum",
    "TorsionLever",
    "deg",
    "find_torsion_levers",
    "mass_law",
    "off_design",
    "polydyne",
    "residual_functional",
    "residual_phasor",
    "response_spectrum",
]
