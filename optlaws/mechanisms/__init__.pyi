# made by tests/contracts/faces.py from the table in __init__.py
from optlaws.mechanisms.follower import Deviation as Deviation
from optlaws.mechanisms.follower import Follower as Follower
from optlaws.mechanisms.follower import off_design as off_design
from optlaws.mechanisms.machine.machine import Machine as Machine
from optlaws.mechanisms.machine.masses import Link as Link
from optlaws.mechanisms.polydyne_cam import mass_law as mass_law
from optlaws.mechanisms.polydyne_cam import polydyne as polydyne
from optlaws.mechanisms.residual import residual_functional as residual_functional
from optlaws.mechanisms.residual import residual_phasor as residual_phasor
from optlaws.mechanisms.response import CycleResponse as CycleResponse
from optlaws.mechanisms.response import Response as Response
from optlaws.mechanisms.spectrum import ResponseSpectrum as ResponseSpectrum
from optlaws.mechanisms.spectrum import response_spectrum as response_spectrum
from optlaws.numbers import deg as deg

__all__ = [
    "CycleResponse",
    "Deviation",
    "Follower",
    "Link",
    "Machine",
    "Response",
    "ResponseSpectrum",
    "deg",
    "mass_law",
    "off_design",
    "polydyne",
    "residual_functional",
    "residual_phasor",
    "response_spectrum",
]
