"""How an optimal law is found: problems, their solution by CasADi and IPOPT, lower bounds and limits."""

from optlaws.synthesis.bases import Basis, Bernstein, Chebyshev, Pieces, PolynomialBasis, Powers, basis
from optlaws.synthesis.boundary import BoundaryConditions, construct
from optlaws.synthesis.bounds import Range, at_least, at_most, between
from optlaws.synthesis.certificate import Certificate, Contact
from optlaws.synthesis.expression import Expression, Maximum, Term, maximum
from optlaws.synthesis.fronts import Front
from optlaws.synthesis.functionals import FUNCTIONALS, B, C, C_minus, C_plus, D, Functional, J, jounce, rms_c, rms_j
from optlaws.synthesis.limit_laws import limit_law
from optlaws.synthesis.limits import acceleration_limit, limit
from optlaws.synthesis.pareto import pareto_front
from optlaws.synthesis.power_certificate import PowerCertificate
from optlaws.synthesis.problem import Problem
from optlaws.synthesis.solution import Solution, Status
from optlaws.synthesis.solve import sweep, synthesize
from optlaws.synthesis.spline_bases import BSplines, PiecewiseBasis
from optlaws.synthesis.windows import Window, via

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
