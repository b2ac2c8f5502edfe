"""Optimal motion laws for cam mechanisms and servo axes, with proof of their optimality."""

from typing import TYPE_CHECKING, Any

from optlaws.errors import InfeasibleProblem, InputError, NotNormalised, OptlawsError, SolverFailure
from optlaws.laws import Constants, MotionLaw, Peak, PolynomialLaw, smoothstep
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.making.multiplier import multiplied
from optlaws.laws.making.transform import mirrored_law, reversed_law, with_end_velocity
from optlaws.laws.making.trapezoids import scca, trapezoid
from optlaws.laws.savin.family import SavinFamily
from optlaws.laws.savin.savin import savin
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.mechanisms.angles import deg
from optlaws.mechanisms.dwell.choice import compare_dwell_mechanisms
from optlaws.mechanisms.dwell.clutch import Clutch
from optlaws.mechanisms.dwell.mechanism import dwell_mechanism
from optlaws.mechanisms.follower.cycle import CycleResponse
from optlaws.mechanisms.follower.follower import Follower
from optlaws.mechanisms.follower.off_design import Deviation, off_design
from optlaws.mechanisms.follower.response import Response
from optlaws.mechanisms.lever.design import find_torsion_levers
from optlaws.mechanisms.lever.lever import TorsionLever
from optlaws.mechanisms.loader.loader import Loader, loader
from optlaws.mechanisms.loader.optimal import BalancedLaw, balanced_law
from optlaws.mechanisms.loader.trapezium import TrapeziumSubstitute
from optlaws.mechanisms.polydyne.cam_constants import cam_constant
from optlaws.mechanisms.polydyne.polydyne import mass_law, polydyne
from optlaws.mechanisms.spectrum.residual import residual_functional, residual_phasor
from optlaws.mechanisms.spectrum.robust import residual
from optlaws.mechanisms.spectrum.spectrum import ResponseSpectrum, response_spectrum
from optlaws.synthesis import (
    FUNCTIONALS,
    B,
    Basis,
    Bernstein,
    BoundaryConditions,
    BSplines,
    C,
    C_minus,
    C_plus,
    Certificate,
    Chebyshev,
    Contact,
    D,
    Expression,
    Front,
    Functional,
    J,
    Pieces,
    PowerCertificate,
    Powers,
    Problem,
    Range,
    Solution,
    Status,
    Window,
    acceleration_limit,
    at_least,
    at_most,
    between,
    construct,
    jounce,
    limit,
    limit_law,
    maximum,
    pareto_front,
    rms_c,
    rms_j,
    sweep,
    synthesize,
    via,
)

if TYPE_CHECKING:
    from optlaws.studies.run import run_study
    from optlaws.studies.study import open_study

__all__ = [
    "FUNCTIONALS",
    "B",
    "BSplines",
    "BalancedLaw",
    "Basis",
    "Bernstein",
    "BoundaryConditions",
    "C",
    "C_minus",
    "C_plus",
    "Certificate",
    "Chebyshev",
    "Clutch",
    "Constants",
    "Contact",
    "CycleResponse",
    "D",
    "Deviation",
    "Expression",
    "Follower",
    "Front",
    "Functional",
    "InfeasibleProblem",
    "InputError",
    "J",
    "Loader",
    "MotionLaw",
    "NotNormalised",
    "OptlawsError",
    "Peak",
    "Pieces",
    "PiecewiseLaw",
    "PolynomialLaw",
    "PowerCertificate",
    "Powers",
    "Problem",
    "Range",
    "Response",
    "ResponseSpectrum",
    "SavinFamily",
    "Solution",
    "SolverFailure",
    "Status",
    "TorsionLever",
    "TrapeziumSubstitute",
    "Window",
    "acceleration_limit",
    "at_least",
    "at_most",
    "balanced_law",
    "between",
    "cam_constant",
    "catalogue",
    "compare_dwell_mechanisms",
    "construct",
    "deg",
    "dwell_mechanism",
    "find_torsion_levers",
    "jounce",
    "limit",
    "limit_law",
    "loader",
    "mass_law",
    "maximum",
    "mirrored_law",
    "multiplied",
    "off_design",
    "open_study",
    "pareto_front",
    "polydyne",
    "residual",
    "residual_functional",
    "residual_phasor",
    "response_spectrum",
    "reversed_law",
    "rms_c",
    "rms_j",
    "run_study",
    "savin",
    "scca",
    "smoothstep",
    "sweep",
    "synthesize",
    "trapezoid",
    "via",
    "with_end_velocity",
]


def __getattr__(name: str) -> Any:  # noqa: ANN401 - text or a function
    if name == "__version__":
        from importlib.metadata import version

        return version("optlaws")
    if name == "open_study":
        from optlaws.studies.study import open_study

        return open_study
    if name == "run_study":
        from optlaws.studies.run import run_study

        return run_study
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
