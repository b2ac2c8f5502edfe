from .arrays.problems import ProblemArray as ProblemArray, map_arrays as map_arrays
from .limits.closed_forms import acceleration_limit as acceleration_limit, limit as limit
from .limits.drive_limits import DriveLimit as DriveLimit, drive_limit as drive_limit
from .limits.closed_forms import limit_law as limit_law
from .pareto import Front as Front, pareto_front as pareto_front
from .problem.constants import (
    FUNCTIONALS as FUNCTIONALS,
    B as B,
    C as C,
    C_minus as C_minus,
    C_plus as C_plus,
    D as D,
    Functional as Functional,
    J as J,
    rms_c as rms_c,
    rms_j as rms_j,
    rms_snap as rms_snap,
    snap as snap,
)
from .problem.expression import Expression as Expression, Maximum as Maximum, Term as Term, maximum as maximum
from .problem.problem import Problem as Problem
from .problem.ranges import Range as Range, at_least as at_least, at_most as at_most, between as between
from .problem.windows import Window as Window, via as via
from .proof.certificate import Certificate as Certificate
from .proof.nodes import Contact as Contact, Leaf as Leaf, Split as Split, Tightening as Tightening
from .proven.front import FrontPoint as FrontPoint, ProvenFront as ProvenFront
from .proven.refine import proven_front as proven_front
from .solution import Solution as Solution
from .solution_array import SolutionArray as SolutionArray
from .solve import synthesize as synthesize
from .solve_many import (
    sweep as sweep,
    synthesize_array as synthesize_array,
    synthesize_chunks as synthesize_chunks,
    synthesize_many as synthesize_many,
)
from .spaces.bases import (
    Basis as Basis,
    Bernstein as Bernstein,
    Chebyshev as Chebyshev,
    Pieces as Pieces,
    PolynomialBasis as PolynomialBasis,
    Powers as Powers,
    basis as basis,
)
from .spaces.end_conditions import BoundaryConditions as BoundaryConditions, law_from_z as law_from_z
from .spaces.bases import BSplines as BSplines, PiecewiseBasis as PiecewiseBasis
from .status import Status as Status
