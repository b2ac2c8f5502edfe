# made by tests/contracts/faces.py from the table in __init__.py
from optlaws.mechanisms.follower.follower import Deviation as Deviation
from optlaws.mechanisms.follower.follower import Follower as Follower
from optlaws.mechanisms.follower.follower import off_design as off_design
from optlaws.mechanisms.follower.polydyne import mass_law as mass_law
from optlaws.mechanisms.follower.polydyne import polydyne as polydyne
from optlaws.mechanisms.follower.response import CycleResponse as CycleResponse
from optlaws.mechanisms.follower.response import Response as Response
from optlaws.mechanisms.linkages.bodies import Body as Body
from optlaws.mechanisms.linkages.bodies import Process as Process
from optlaws.mechanisms.linkages.mechanism import Mechanism as Mechanism
from optlaws.mechanisms.linkages.slider_crank import slider_crank as slider_crank
from optlaws.mechanisms.machine.machine import Machine as Machine
from optlaws.mechanisms.machine.masses import Link as Link
from optlaws.mechanisms.spectrum.residual import residual_functional as residual_functional
from optlaws.mechanisms.spectrum.residual import residual_phasor as residual_phasor
from optlaws.mechanisms.spectrum.spectrum import ResponseSpectrum as ResponseSpectrum
from optlaws.mechanisms.spectrum.spectrum import response_spectrum as response_spectrum
from optlaws.numbers import deg as deg

__all__ = [
    "Body",
    "CycleResponse",
    "Deviation",
    "Follower",
    "Link",
    "Machine",
    "Mechanism",
    "Process",
    "Response",
    "ResponseSpectrum",
    "deg",
    "mass_law",
    "off_design",
    "polydyne",
    "residual_functional",
    "residual_phasor",
    "response_spectrum",
    "slider_crank",
]
