"""What laws do in machines: elastic followers and the cams made for them."""

from optlaws.mechanisms.angles import deg
from optlaws.mechanisms.cycle import CycleResponse
from optlaws.mechanisms.follower import Follower
from optlaws.mechanisms.off_design import Deviation, off_design
from optlaws.mechanisms.polydyne import mass_law, polydyne
from optlaws.mechanisms.residual import residual_functional, residual_phasor
from optlaws.mechanisms.response import Response
from optlaws.mechanisms.spectrum import ResponseSpectrum, response_spectrum
from optlaws.mechanisms.torsion_design import find_torsion_levers
from optlaws.mechanisms.torsion_lever import TorsionLever
from optlaws.mechanisms.torsion_motion import LeverMotion

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
