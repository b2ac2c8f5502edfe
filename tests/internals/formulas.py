"""Internals of `optlaws.formulas` that tests look at by themselves."""

from optlaws.formulas.arithmetic import NUMPY, Arithmetic, casadi_arithmetic, evaluate, horner, pieces
from optlaws.formulas.convexity import Curvature, Endpoints, Judge, affine, degree, enclosed, quadratic
from optlaws.formulas.jets import formula_jet
from optlaws.formulas.of_motion import MotionFormula, of_text
from optlaws.formulas.reading import DEEPEST, LONGEST, read
from optlaws.formulas.slopes import Slopes, derivative
from optlaws.formulas.tracing import Traced, traced
from optlaws.formulas.tree import ORDERS, SMOOTH_FUNCTIONS, Formula, Name, Table
