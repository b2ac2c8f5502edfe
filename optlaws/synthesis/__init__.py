"""How an optimal law is found: problems, their solution by CasADi and IPOPT, lower bounds and limits."""

from optlaws.synthesis.bases import Basis, Chebyshev, Powers, basis
from optlaws.synthesis.boundary import BoundaryConditions, construct
from optlaws.synthesis.certificate import Certificate, Contact
from optlaws.synthesis.limits import acceleration_limit
from optlaws.synthesis.problem import Problem
from optlaws.synthesis.solution import Solution, Status
from optlaws.synthesis.solve import sweep, synthesize

__all__ = [
    "Basis",
    "BoundaryConditions",
    "Certificate",
    "Chebyshev",
    "Contact",
    "Powers",
    "Problem",
    "Solution",
    "Status",
    "acceleration_limit",
    "basis",
    "construct",
    "sweep",
    "synthesize",
]
