# made by tests/contracts/faces.py from the table in __init__.py
from optlaws.synthesis.arrays.problems import ProblemArray as ProblemArray
from optlaws.synthesis.arrays.problems import map_arrays as map_arrays
from optlaws.synthesis.limits.closed_forms import acceleration_limit as acceleration_limit
from optlaws.synthesis.limits.closed_forms import limit as limit
from optlaws.synthesis.limits.drive_limits import DriveLimit as DriveLimit
from optlaws.synthesis.limits.drive_limits import drive_limit as drive_limit
from optlaws.synthesis.limits.laws import limit_law as limit_law
from optlaws.synthesis.pareto import Front as Front
from optlaws.synthesis.pareto import pareto_front as pareto_front
from optlaws.synthesis.problem.constants import FUNCTIONALS as FUNCTIONALS
from optlaws.synthesis.problem.constants import B as B
from optlaws.synthesis.problem.constants import C as C
from optlaws.synthesis.problem.constants import C_minus as C_minus
from optlaws.synthesis.problem.constants import C_plus as C_plus
from optlaws.synthesis.problem.constants import D as D
from optlaws.synthesis.problem.constants import Functional as Functional
from optlaws.synthesis.problem.constants import J as J
from optlaws.synthesis.problem.constants import rms_c as rms_c
from optlaws.synthesis.problem.constants import rms_j as rms_j
from optlaws.synthesis.problem.constants import rms_snap as rms_snap
from optlaws.synthesis.problem.constants import snap as snap
from optlaws.synthesis.problem.expression import Expression as Expression
from optlaws.synthesis.problem.expression import Maximum as Maximum
from optlaws.synthesis.problem.expression import Term as Term
from optlaws.synthesis.problem.expression import maximum as maximum
from optlaws.synthesis.problem.problem import Problem as Problem
from optlaws.synthesis.problem.ranges import Range as Range
from optlaws.synthesis.problem.ranges import at_least as at_least
from optlaws.synthesis.problem.ranges import at_most as at_most
from optlaws.synthesis.problem.ranges import between as between
from optlaws.synthesis.problem.windows import Window as Window
from optlaws.synthesis.problem.windows import via as via
from optlaws.synthesis.proof.certificate import Certificate as Certificate
from optlaws.synthesis.proof.nodes import Contact as Contact
from optlaws.synthesis.proof.nodes import Leaf as Leaf
from optlaws.synthesis.proof.nodes import Split as Split
from optlaws.synthesis.proof.nodes import Tightening as Tightening
from optlaws.synthesis.proven.front import FrontPoint as FrontPoint
from optlaws.synthesis.proven.front import ProvenFront as ProvenFront
from optlaws.synthesis.proven.refine import proven_front as proven_front
from optlaws.synthesis.solution import Solution as Solution
from optlaws.synthesis.solution_array import SolutionArray as SolutionArray
from optlaws.synthesis.solve import synthesize as synthesize
from optlaws.synthesis.solve_many import sweep as sweep
from optlaws.synthesis.solve_many import synthesize_array as synthesize_array
from optlaws.synthesis.solve_many import synthesize_chunks as synthesize_chunks
from optlaws.synthesis.solve_many import synthesize_many as synthesize_many
from optlaws.synthesis.spaces.bases import Basis as Basis
from optlaws.synthesis.spaces.bases import Bernstein as Bernstein
from optlaws.synthesis.spaces.bases import Chebyshev as Chebyshev
from optlaws.synthesis.spaces.bases import Pieces as Pieces
from optlaws.synthesis.spaces.bases import PolynomialBasis as PolynomialBasis
from optlaws.synthesis.spaces.bases import Powers as Powers
from optlaws.synthesis.spaces.bases import basis as basis
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions as BoundaryConditions
from optlaws.synthesis.spaces.end_conditions import law_from_z as law_from_z
from optlaws.synthesis.spaces.splines import BSplines as BSplines
from optlaws.synthesis.spaces.splines import PiecewiseBasis as PiecewiseBasis
from optlaws.synthesis.status import Status as Status

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
    "DriveLimit",
    "Expression",
    "Front",
    "FrontPoint",
    "Functional",
    "J",
    "Leaf",
    "Maximum",
    "Pieces",
    "PiecewiseBasis",
    "PolynomialBasis",
    "Powers",
    "Problem",
    "ProblemArray",
    "ProvenFront",
    "Range",
    "Solution",
    "SolutionArray",
    "Split",
    "Status",
    "Term",
    "Tightening",
    "Window",
    "acceleration_limit",
    "at_least",
    "at_most",
    "basis",
    "between",
    "drive_limit",
    "law_from_z",
    "limit",
    "limit_law",
    "map_arrays",
    "maximum",
    "pareto_front",
    "proven_front",
    "rms_c",
    "rms_j",
    "rms_snap",
    "snap",
    "sweep",
    "synthesize",
    "synthesize_array",
    "synthesize_chunks",
    "synthesize_many",
    "via",
]
