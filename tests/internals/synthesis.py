"""Internals of `optlaws.synthesis` that tests look at by themselves."""

from optlaws.numerics.exact import not_above, root_rounded_down, rounded_down, rounded_up
from optlaws.synthesis import solve as search
from optlaws.synthesis import solve_many
from optlaws.synthesis.arrays.continuation import StructureSegment, laws_along
from optlaws.synthesis.arrays.lines import least_power, on_global_branch
from optlaws.synthesis.arrays.newton_steps import States, converged, locally_optimal
from optlaws.synthesis.arrays.programs import Path, SolvedBatch, between
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.cone import ConeFamily, stationary_places
from optlaws.synthesis.families.curved import CurvedFamily, FormulaFamily
from optlaws.synthesis.families.energy import EnergyFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, Points, ProductFamily, Program
from optlaws.synthesis.families.kinked import KinkedIntegralFamily
from optlaws.synthesis.families.names import RowName
from optlaws.synthesis.families.piece_series import PieceSeries, peaks
from optlaws.synthesis.functionals.kinds import FormulaIntegral, FormulaPeak, FormulaRms, FormulaValue, OfFormula
from optlaws.synthesis.least_time import time_search
from optlaws.synthesis.least_time.least_time import LeastTime
from optlaws.synthesis.least_time.motor_torque import MotorTorque
from optlaws.synthesis.least_time.move_limits import FollowerResidual, LimitSegments, MoveLimits, segment_times
from optlaws.synthesis.least_time.time_search import least_time
from optlaws.synthesis.least_time.timed_move import MoveObjective, TimedMove
from optlaws.synthesis.limits import closed_forms
from optlaws.synthesis.limits.closed_forms import (
    acceleration_limit_at_jerk,
    best_velocity,
    jerk_limit,
    power_limit,
    rms_limit,
)
from optlaws.synthesis.limits.drive_limits import LONG, limit_beside, limit_of_plane, phase_torque
from optlaws.synthesis.limits.of_problem import known_limit
from optlaws.synthesis.limits.phase_plane import TorqueLimit, VelocityLimit
from optlaws.synthesis.limits.phase_plane_program import optimum
from optlaws.synthesis.limits.standing import Standing
from optlaws.synthesis.method import exchange, starts
from optlaws.synthesis.method.discretised import ipopt, quadratic_steps
from optlaws.synthesis.method.discretised.ipopt import KINDS, RowShape
from optlaws.synthesis.method.discretised.on_points import Answer, first_points, optimum_on_points, vertex_on_points
from optlaws.synthesis.method.discretised.quadratic_steps import stepwise_on_points
from optlaws.synthesis.method.exchange import Outcome, solve
from optlaws.synthesis.method.presolve import contradiction, independent, units_of
from optlaws.synthesis.pareto import HEADINGS, undominated, value_of
from optlaws.synthesis.problem.constants import (
    ALIASES,
    MAKERS,
    PLAIN,
    PeakConstant,
    PowerConstant,
    RootMeanSquare,
    warn_of_mixture,
)
from optlaws.synthesis.problem.expression import leaves
from optlaws.synthesis.problem.named_constants import expression, is_named, named, parse
from optlaws.synthesis.problem.problem import ENTRIES, PROBLEM
from optlaws.synthesis.problem.ranges import Bounds, read_bounds
from optlaws.synthesis.problem.windows import QUANTITIES, read_window
from optlaws.synthesis.program import writer
from optlaws.synthesis.program.writer import (
    Model,
    evaluate,
    extreme_velocity,
    least_violation,
    model_of,
    relaxed,
    shortfalls,
)
from optlaws.synthesis.proof import make
from optlaws.synthesis.proof.certificate import RELAXED, VIOLATION, model_of_leaf
from optlaws.synthesis.proof.duality import Sublevel, lines_of, row_of, spread, sum_of_rows, summed
from optlaws.synthesis.proof.infeasible import failure
from optlaws.synthesis.proof.nodes import PlaceRange
from optlaws.synthesis.proof.peak_rows import PeakRows
from optlaws.synthesis.proof.power.box import Box, BoxRows
from optlaws.synthesis.proof.power.rows import (
    Anchors,
    FormulaRows,
    PowerRows,
    applies_to_formulas,
    rows_of,
    velocity_brackets,
)
from optlaws.synthesis.proof.power.search import Region, _points, searched
from optlaws.synthesis.proof.power.shared_energy import secant_over_inverse, secant_over_root
from optlaws.synthesis.solve import LawSearch, _neighbours, attempt
from optlaws.synthesis.solve_many import _together, solved
from optlaws.synthesis.spaces.bases import basis
from optlaws.synthesis.spaces.free_pieces import PieceSpace
from optlaws.synthesis.spaces.of_basis import space_of
from optlaws.synthesis.spaces.space import LawSpace
