from optlaws.synthesis.bases import Basis, Chebyshev, Powers, basis
from optlaws.synthesis.boundary import BoundaryConditions, construct
from optlaws.synthesis.bounds import Range, at_least, at_most, between
from optlaws.synthesis.expression import Expression, maximum
from optlaws.synthesis.functionals import FUNCTIONALS, B, C, C_minus, C_plus, D, Functional, J, jounce, rms_c, rms_j
from optlaws.synthesis.problem import Problem
