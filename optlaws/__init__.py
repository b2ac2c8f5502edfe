"""Optimal motion laws for cam mechanisms and servo axes, with proof of their optimality."""

from optlaws.errors import InfeasibleProblem, InputError, OptlawsError, SolverFailure
from optlaws.laws import Constants, MotionLaw, Peak, PolynomialLaw, smoothstep
from optlaws.laws.savin import savin
from optlaws.synthesis import (
    Basis,
    BoundaryConditions,
    Certificate,
    Chebyshev,
    Contact,
    Powers,
    Problem,
    Solution,
    Status,
    acceleration_limit,
    construct,
    sweep,
    synthesize,
)

__all__ = [
    "Basis",
    "BoundaryConditions",
    "Certificate",
    "Chebyshev",
    "Constants",
    "Contact",
    "InfeasibleProblem",
    "InputError",
    "MotionLaw",
    "OptlawsError",
    "Peak",
    "PolynomialLaw",
    "Powers",
    "Problem",
    "Solution",
    "SolverFailure",
    "Status",
    "acceleration_limit",
    "construct",
    "savin",
    "smoothstep",
    "sweep",
    "synthesize",
]


def __getattr__(name: str) -> str:
    if name == "__version__":
        from importlib.metadata import version

        return version("optlaws")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
