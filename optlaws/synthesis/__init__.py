"""How an optimal law is found: problems, their solution by CasADi and IPOPT, lower bounds and limits."""

from optlaws.synthesis.front import Front
from optlaws.synthesis.limits.closed_forms import acceleration_limit, limit
from optlaws.synthesis.limits.laws import limit_law
from optlaws.synthesis.pareto import pareto_front
from optlaws.synthesis.problem.constants import (
    FUNCTIONALS,
    B,
    C,
    C_minus,
    C_plus,
    D,
    Functional,
    J,
    jounce,
    rms_c,
    rms_j,
)
from optlaws.synthesis.problem.expression import Expression, Maximum, Term, maximum
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range, at_least, at_most, between
from optlaws.synthesis.problem.windows import Window, via
from optlaws.synthesis.proof.certificate import Certificate, Contact
from optlaws.synthesis.proof.power.certificate import PowerCertificate
from optlaws.synthesis.solution import Solution, Status
from optlaws.synthesis.solve import sweep, synthesize
from optlaws.synthesis.spaces.bases import Basis, Bernstein, Chebyshev, Pieces, PolynomialBasis, Powers, basis
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions, construct
from optlaws.synthesis.spaces.splines import BSplines, PiecewiseBasis

__all__ = [
    "FUNCTIONALS",
    "B",
    "BSplines",
    "Basis",
    "Bernstein",
    "BoundaryConditions",
    "C",
    "C_minus",
    "C_plus",
    "Certificate",
    "Chebyshev",
    "Contact",
    "D",
    "Expression",
    "Front",
    "Functional",
    "J",
    "Maximum",
    "Pieces",
    "PiecewiseBasis",
    "PolynomialBasis",
    "PowerCertificate",
    "Powers",
    "Problem",
    "Range",
    "Solution",
    "Status",
    "Term",
    "Window",
    "acceleration_limit",
    "at_least",
    "at_most",
    "basis",
    "between",
    "construct",
    "jounce",
    "limit",
    "limit_law",
    "maximum",
    "pareto_front",
    "rms_c",
    "rms_j",
    "sweep",
    "synthesize",
    "via",
]
