from . import laws as laws, mechanisms as mechanisms, synthesis as synthesis
from .balancing import (
    BalancedLaw as BalancedLaw,
    Balancing as Balancing,
    Clutch as Clutch,
    DwellMachine as DwellMachine,
    LeverCam as LeverCam,
    Loader as Loader,
    TorsionLever as TorsionLever,
    TrapeziumSubstitute as TrapeziumSubstitute,
    balanced_law as balanced_law,
    compare_dwell_mechanisms as compare_dwell_mechanisms,
    dwell_machine as dwell_machine,
    dwell_mechanism as dwell_mechanism,
    find_torsion_levers as find_torsion_levers,
    inertial_loader as inertial_loader,
    rocker_law as rocker_law,
)
from .cams.as_manufactured import AsMade as AsMade, as_made as as_made, with_profile_error as with_profile_error
from .cams.at_shaft import cam_mechanism as cam_mechanism
from .cams.barrel import BarrelCam as BarrelCam
from .cams.best_laws import best_cam as best_cam, best_prime_circle as best_prime_circle
from .cams.conjugate import conjugate_cam as conjugate_cam
from .cams.curves.motion_by_angle import CamMotion as CamMotion
from .cams.disc import DiscCam as DiscCam
from .cams.followers.faces import (
    InclinedFlat as InclinedFlat,
    OscillatingFlat as OscillatingFlat,
    TranslatingFlat as TranslatingFlat,
)
from .cams.followers.rollers import OscillatingRoller as OscillatingRoller, TranslatingRoller as TranslatingRoller
from .cams.forces import CamForces as CamForces
from .cams.least_sizes import (
    best_offset as best_offset,
    greatest_roller as greatest_roller,
    least_prime_circle as least_prime_circle,
)
from .cams.springs_and_flywheels import (
    EnergyFluctuation as EnergyFluctuation,
    Spring as Spring,
    energy_fluctuation as energy_fluctuation,
    least_spring as least_spring,
)
from .cycles.advising.advice import Advice as Advice, advise as advise
from .cycles.advising.candidates import AdvisedLaw as AdvisedLaw
from .cycles.advising.recommendation import Recommendation as Recommendation
from .cycles.axes.interlock import After as After, Clearance as Clearance
from .cycles.axes.interlock import Forbidden as Forbidden, Synchronous as Synchronous
from .cycles.axes.machine_axes import Axes as Axes
from .cycles.cycle import Cycle as Cycle, Plan as Plan
from .cycles.fastest_cycle import FastestCycle as FastestCycle, LeastDuration as LeastDuration, LimitGain as LimitGain
from .cycles.law_comparison import Comparison as Comparison, compare_laws as compare_laws
from .cycles.moves.fastest_move import FastestMove as FastestMove
from .cycles.moves.time_front import TimeFront as TimeFront, time_front as time_front
from .cycles.moves.timed_moves import fastest as fastest, fastest_moves as fastest_moves
from .cycles.transitions import TransitionCam as TransitionCam
from .cycles.old_tables.splitting import read_cycle_table as read_cycle_table, split_table as split_table
from .cycles.old_tables.table import OldTable as OldTable
from .cycles.specification.segments import (
    ConstantVelocity as ConstantVelocity,
    Dwell as Dwell,
    Free as Free,
    Move as Move,
    Return as Return,
    Rise as Rise,
)
from .errors import (
    CallError as CallError,
    InfeasibleProblem as InfeasibleProblem,
    InputError as InputError,
    NoisyTable as NoisyTable,
    NotNormalised as NotNormalised,
    OptlawsError as OptlawsError,
    SolverFailure as SolverFailure,
)
from .laws.catalogue.catalogue import catalogue as catalogue
from .laws.catalogue.reading import read_law as read_law
from .laws.law import Constants as Constants, MotionLaw as MotionLaw
from .laws.making.formula_law import formula_law as formula_law
from .laws.making.input_shaping import shaped_law as shaped_law
from .laws.making.multiplier import multiplied_law as multiplied_law, multiplier_for as multiplier_for
from .laws.making.through_points import law_through as law_through
from .laws.making.transform import (
    mirrored_law as mirrored_law,
    reversed_law as reversed_law,
    with_end_velocity as with_end_velocity,
)
from .laws.making.trapezoids import scca as scca, trapezoid as trapezoid
from .laws.polynomial import PolynomialLaw as PolynomialLaw, smoothstep as smoothstep
from .laws.savin import SavinFamily as SavinFamily, savin as savin
from .laws.segments.piecewise import PiecewiseLaw as PiecewiseLaw
from .mechanisms.drives.drive_train import Drive as Drive
from .mechanisms.drives.motor import Motor as Motor, read_motors as read_motors
from .mechanisms.linkages.mechanism import Mechanism as Mechanism
from .mechanisms.linkages.mechanism_kinds import (
    Body as Body,
    Loads as Loads,
    belt as belt,
    mechanism_of_motion as mechanism_of_motion,
    rack as rack,
    screw as screw,
)
from .mechanisms.linkages.move_limit import MoveLimit as MoveLimit
from .mechanisms.linkages.plane_linkages import (
    four_bar as four_bar,
    slider_crank as slider_crank,
    toggle as toggle,
)
from .mechanisms.machine.follower import Deviation as Deviation, Follower as Follower, off_design as off_design
from .mechanisms.machine.machine import (
    Machine as Machine,
    MachineSpectrum as MachineSpectrum,
    machine_spectrum as machine_spectrum,
)
from .mechanisms.machine.models import Link as Link
from .mechanisms.machine.polydyne import (
    cam_constant as cam_constant,
    driving_law as driving_law,
    flat_output as flat_output,
    mass_law as mass_law,
    polydyne as polydyne,
)
from .mechanisms.machine.residual import residual_vibration as residual_vibration
from .mechanisms.machine.response import CycleResponse as CycleResponse, Response as Response
from .mechanisms.machine.spectrum import (
    ResponseSpectrum as ResponseSpectrum,
    read_spectrum as read_spectrum,
    response_spectrum as response_spectrum,
)
from .mechanisms.machine.transforms import (
    residual_functional as residual_functional,
    residual_phasor as residual_phasor,
)
from .motion.polynomials import PiecewiseMotion as PiecewiseMotion
from .numbers import deg as deg
from .numerics.peaks import Peak as Peak
from .schemas import json_schema as json_schema
from .studies.run import run_study as run_study
from .studies.study import open_study as open_study
from .synthesis.arrays.problems import ProblemArray as ProblemArray, map_arrays as map_arrays
from .synthesis.functionals.makers import (
    drive_torque as drive_torque,
    functional as functional,
    integral as integral,
    peak as peak,
    rms as rms,
    value as value,
)
from .synthesis.limits.closed_forms import acceleration_limit as acceleration_limit, limit as limit
from .synthesis.limits.drive_limits import DriveLimit as DriveLimit, drive_limit as drive_limit
from .synthesis.limits.closed_forms import limit_law as limit_law
from .synthesis.pareto import Front as Front, pareto_front as pareto_front
from .synthesis.problem.constants import (
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
from .synthesis.problem.expression import Expression as Expression, maximum as maximum
from .synthesis.problem.problem import Problem as Problem
from .synthesis.problem.ranges import Range as Range, at_least as at_least, at_most as at_most, between as between
from .synthesis.problem.windows import Window as Window, via as via
from .synthesis.proof.certificate import Certificate as Certificate
from .synthesis.proof.nodes import Contact as Contact, Leaf as Leaf, Split as Split, Tightening as Tightening
from .synthesis.proven.front import FrontPoint as FrontPoint, ProvenFront as ProvenFront
from .synthesis.proven.refine import proven_front as proven_front
from .synthesis.solution import Solution as Solution
from .synthesis.solution_array import SolutionArray as SolutionArray
from .synthesis.solve import synthesize as synthesize
from .synthesis.solve_many import (
    sweep as sweep,
    synthesize_array as synthesize_array,
    synthesize_chunks as synthesize_chunks,
    synthesize_many as synthesize_many,
)
from .synthesis.spaces.bases import (
    Basis as Basis,
    Bernstein as Bernstein,
    Chebyshev as Chebyshev,
    Pieces as Pieces,
    Powers as Powers,
)
from .synthesis.spaces.end_conditions import BoundaryConditions as BoundaryConditions, law_from_z as law_from_z
from .synthesis.spaces.free_pieces import PeriodicPieces as PeriodicPieces
from .synthesis.spaces.bases import BSplines as BSplines
from .synthesis.status import Status as Status

__version__: str
