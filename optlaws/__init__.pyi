# made by tests/contracts/faces.py from the table in __init__.py
from optlaws import laws as laws
from optlaws import mechanisms as mechanisms
from optlaws import synthesis as synthesis
from optlaws.balancing import BalancedLaw as BalancedLaw
from optlaws.balancing import Balancing as Balancing
from optlaws.balancing import Clutch as Clutch
from optlaws.balancing import DwellMachine as DwellMachine
from optlaws.balancing import LeverCam as LeverCam
from optlaws.balancing import Loader as Loader
from optlaws.balancing import TorsionLever as TorsionLever
from optlaws.balancing import TrapeziumSubstitute as TrapeziumSubstitute
from optlaws.balancing import balanced_law as balanced_law
from optlaws.balancing import compare_dwell_mechanisms as compare_dwell_mechanisms
from optlaws.balancing import dwell_machine as dwell_machine
from optlaws.balancing import dwell_mechanism as dwell_mechanism
from optlaws.balancing import find_torsion_levers as find_torsion_levers
from optlaws.balancing import inertial_loader as inertial_loader
from optlaws.balancing import rocker_law as rocker_law
from optlaws.cams.as_manufactured import AsMade as AsMade
from optlaws.cams.as_manufactured import as_made as as_made
from optlaws.cams.as_manufactured import with_profile_error as with_profile_error
from optlaws.cams.at_shaft import cam_mechanism as cam_mechanism
from optlaws.cams.barrel import BarrelCam as BarrelCam
from optlaws.cams.best_laws import best_cam as best_cam
from optlaws.cams.best_laws import best_prime_circle as best_prime_circle
from optlaws.cams.best_offset import best_offset as best_offset
from optlaws.cams.conjugate import conjugate_cam as conjugate_cam
from optlaws.cams.curves.motion_by_angle import CamMotion as CamMotion
from optlaws.cams.disc import DiscCam as DiscCam
from optlaws.cams.followers.inclined_flat import InclinedFlat as InclinedFlat
from optlaws.cams.followers.oscillating_flat import OscillatingFlat as OscillatingFlat
from optlaws.cams.followers.oscillating_roller import OscillatingRoller as OscillatingRoller
from optlaws.cams.followers.translating_flat import TranslatingFlat as TranslatingFlat
from optlaws.cams.followers.translating_roller import TranslatingRoller as TranslatingRoller
from optlaws.cams.forces import CamForces as CamForces
from optlaws.cams.least_sizes import greatest_roller as greatest_roller
from optlaws.cams.least_sizes import least_prime_circle as least_prime_circle
from optlaws.cams.sizing.energy_fluctuation import EnergyFluctuation as EnergyFluctuation
from optlaws.cams.sizing.energy_fluctuation import energy_fluctuation as energy_fluctuation
from optlaws.cams.sizing.springs import Spring as Spring
from optlaws.cams.sizing.springs import least_spring as least_spring
from optlaws.cycles.advising.advice import Advice as Advice
from optlaws.cycles.advising.advised_law import AdvisedLaw as AdvisedLaw
from optlaws.cycles.advising.advised_motion import advise as advise
from optlaws.cycles.advising.recommendation import Recommendation as Recommendation
from optlaws.cycles.cycle import Cycle as Cycle
from optlaws.cycles.fastest_cycle import FastestCycle as FastestCycle
from optlaws.cycles.fastest_cycle import LeastDuration as LeastDuration
from optlaws.cycles.fastest_cycle import LimitGain as LimitGain
from optlaws.cycles.interlocks.after import After as After
from optlaws.cycles.interlocks.clearance import Clearance as Clearance
from optlaws.cycles.interlocks.forbidden_region import Forbidden as Forbidden
from optlaws.cycles.interlocks.synchronous import Synchronous as Synchronous
from optlaws.cycles.law_comparison import Comparison as Comparison
from optlaws.cycles.law_comparison import compare_laws as compare_laws
from optlaws.cycles.machine_axes import Axes as Axes
from optlaws.cycles.moves.fastest_move import FastestMove as FastestMove
from optlaws.cycles.moves.front_over_time import time_front as time_front
from optlaws.cycles.moves.time_front import TimeFront as TimeFront
from optlaws.cycles.moves.timed_moves import fastest as fastest
from optlaws.cycles.moves.timed_moves import fastest_moves as fastest_moves
from optlaws.cycles.moves.transition_cam import TransitionCam as TransitionCam
from optlaws.cycles.old_tables.table import OldTable as OldTable
from optlaws.cycles.old_tables.table import read_cycle_table as read_cycle_table
from optlaws.cycles.old_tables.table import split_table as split_table
from optlaws.cycles.specification.segments import ConstantVelocity as ConstantVelocity
from optlaws.cycles.specification.segments import Dwell as Dwell
from optlaws.cycles.specification.segments import Free as Free
from optlaws.cycles.specification.segments import Move as Move
from optlaws.cycles.specification.segments import Return as Return
from optlaws.cycles.specification.segments import Rise as Rise
from optlaws.errors import InfeasibleProblem as InfeasibleProblem
from optlaws.errors import InputError as InputError
from optlaws.errors import NoisyTable as NoisyTable
from optlaws.errors import NotNormalised as NotNormalised
from optlaws.errors import OptlawsError as OptlawsError
from optlaws.errors import SolverFailure as SolverFailure
from optlaws.files.schemas import json_schema as json_schema
from optlaws.laws.catalogue.catalogue import catalogue as catalogue
from optlaws.laws.catalogue.reading import read_law as read_law
from optlaws.laws.constants import Constants as Constants
from optlaws.laws.law import MotionLaw as MotionLaw
from optlaws.laws.making.formula_law import formula_law as formula_law
from optlaws.laws.making.input_shaping import shaped_law as shaped_law
from optlaws.laws.making.multiplier import multiplied_law as multiplied_law
from optlaws.laws.making.multiplier import multiplier_for as multiplier_for
from optlaws.laws.making.through_points import law_through as law_through
from optlaws.laws.making.transform import mirrored_law as mirrored_law
from optlaws.laws.making.transform import reversed_law as reversed_law
from optlaws.laws.making.transform import with_end_velocity as with_end_velocity
from optlaws.laws.making.trapezoids import scca as scca
from optlaws.laws.making.trapezoids import trapezoid as trapezoid
from optlaws.laws.polynomial import PolynomialLaw as PolynomialLaw
from optlaws.laws.polynomial import smoothstep as smoothstep
from optlaws.laws.savin import SavinFamily as SavinFamily
from optlaws.laws.savin import savin as savin
from optlaws.laws.segments.piecewise import PiecewiseLaw as PiecewiseLaw
from optlaws.mechanisms.cam_constants import cam_constant as cam_constant
from optlaws.mechanisms.drives.drive_train import Drive as Drive
from optlaws.mechanisms.drives.motor import Motor as Motor
from optlaws.mechanisms.drives.motor import read_motors as read_motors
from optlaws.mechanisms.linkages.bodies import Body as Body
from optlaws.mechanisms.linkages.bodies import Loads as Loads
from optlaws.mechanisms.linkages.four_bar import four_bar as four_bar
from optlaws.mechanisms.linkages.mechanism import Mechanism as Mechanism
from optlaws.mechanisms.linkages.motions import belt as belt
from optlaws.mechanisms.linkages.motions import mechanism_of_motion as mechanism_of_motion
from optlaws.mechanisms.linkages.motions import rack as rack
from optlaws.mechanisms.linkages.motions import screw as screw
from optlaws.mechanisms.linkages.move_limit import MoveLimit as MoveLimit
from optlaws.mechanisms.linkages.slider_crank import slider_crank as slider_crank
from optlaws.mechanisms.linkages.toggle import toggle as toggle
from optlaws.mechanisms.machine.flat_output import driving_law as driving_law
from optlaws.mechanisms.machine.flat_output import flat_output as flat_output
from optlaws.mechanisms.machine.follower import Deviation as Deviation
from optlaws.mechanisms.machine.follower import Follower as Follower
from optlaws.mechanisms.machine.follower import off_design as off_design
from optlaws.mechanisms.machine.machine import Machine as Machine
from optlaws.mechanisms.machine.masses import Link as Link
from optlaws.mechanisms.machine.parameters import MachineSpectrum as MachineSpectrum
from optlaws.mechanisms.machine.parameters import machine_spectrum as machine_spectrum
from optlaws.mechanisms.machine.response import CycleResponse as CycleResponse
from optlaws.mechanisms.machine.response import Response as Response
from optlaws.mechanisms.measured_spectrum import read_spectrum as read_spectrum
from optlaws.mechanisms.polydyne_cam import mass_law as mass_law
from optlaws.mechanisms.polydyne_cam import polydyne as polydyne
from optlaws.mechanisms.residual import residual_functional as residual_functional
from optlaws.mechanisms.residual import residual_phasor as residual_phasor
from optlaws.mechanisms.residual import residual_vibration as residual_vibration
from optlaws.mechanisms.spectrum import ResponseSpectrum as ResponseSpectrum
from optlaws.mechanisms.spectrum import response_spectrum as response_spectrum
from optlaws.motion.polynomials import PiecewiseMotion as PiecewiseMotion
from optlaws.numbers import deg as deg
from optlaws.numerics.peaks import Peak as Peak
from optlaws.studies.run import run_study as run_study
from optlaws.studies.study import open_study as open_study
from optlaws.synthesis.arrays.problems import ProblemArray as ProblemArray
from optlaws.synthesis.arrays.problems import map_arrays as map_arrays
from optlaws.synthesis.functionals.makers import drive_torque as drive_torque
from optlaws.synthesis.functionals.makers import functional as functional
from optlaws.synthesis.functionals.makers import integral as integral
from optlaws.synthesis.functionals.makers import peak as peak
from optlaws.synthesis.functionals.makers import rms as rms
from optlaws.synthesis.functionals.makers import value as value
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
from optlaws.synthesis.spaces.bases import Powers as Powers
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions as BoundaryConditions
from optlaws.synthesis.spaces.end_conditions import law_from_z as law_from_z
from optlaws.synthesis.spaces.periodic_pieces import PeriodicPieces as PeriodicPieces
from optlaws.synthesis.spaces.splines import BSplines as BSplines
from optlaws.synthesis.status import Status as Status

__version__: str

__all__ = [
    "FUNCTIONALS",
    "Advice",
    "AdvisedLaw",
    "After",
    "AsMade",
    "Axes",
    "B",
    "BSplines",
    "BalancedLaw",
    "Balancing",
    "BarrelCam",
    "Basis",
    "Bernstein",
    "Body",
    "BoundaryConditions",
    "C",
    "C_minus",
    "C_plus",
    "CamForces",
    "CamMotion",
    "Certificate",
    "Chebyshev",
    "Clearance",
    "Clutch",
    "Comparison",
    "ConstantVelocity",
    "Constants",
    "Contact",
    "Cycle",
    "CycleResponse",
    "D",
    "Deviation",
    "DiscCam",
    "Drive",
    "DriveLimit",
    "Dwell",
    "DwellMachine",
    "EnergyFluctuation",
    "Expression",
    "FastestCycle",
    "FastestMove",
    "Follower",
    "Forbidden",
    "Free",
    "Front",
    "FrontPoint",
    "Functional",
    "InclinedFlat",
    "InfeasibleProblem",
    "InputError",
    "J",
    "Leaf",
    "LeastDuration",
    "LeverCam",
    "LimitGain",
    "Link",
    "Loader",
    "Loads",
    "Machine",
    "MachineSpectrum",
    "Mechanism",
    "MotionLaw",
    "Motor",
    "Move",
    "MoveLimit",
    "NoisyTable",
    "NotNormalised",
    "OldTable",
    "OptlawsError",
    "OscillatingFlat",
    "OscillatingRoller",
    "Peak",
    "PeriodicPieces",
    "Pieces",
    "PiecewiseLaw",
    "PiecewiseMotion",
    "PolynomialLaw",
    "Powers",
    "Problem",
    "ProblemArray",
    "ProvenFront",
    "Range",
    "Recommendation",
    "Response",
    "ResponseSpectrum",
    "Return",
    "Rise",
    "SavinFamily",
    "Solution",
    "SolutionArray",
    "SolverFailure",
    "Split",
    "Spring",
    "Status",
    "Synchronous",
    "Tightening",
    "TimeFront",
    "TorsionLever",
    "TransitionCam",
    "TranslatingFlat",
    "TranslatingRoller",
    "TrapeziumSubstitute",
    "Window",
    "acceleration_limit",
    "advise",
    "as_made",
    "at_least",
    "at_most",
    "balanced_law",
    "belt",
    "best_cam",
    "best_offset",
    "best_prime_circle",
    "between",
    "cam_constant",
    "cam_mechanism",
    "catalogue",
    "compare_dwell_mechanisms",
    "compare_laws",
    "conjugate_cam",
    "deg",
    "drive_limit",
    "drive_torque",
    "driving_law",
    "dwell_machine",
    "dwell_mechanism",
    "energy_fluctuation",
    "fastest",
    "fastest_moves",
    "find_torsion_levers",
    "flat_output",
    "formula_law",
    "four_bar",
    "functional",
    "greatest_roller",
    "inertial_loader",
    "integral",
    "json_schema",
    "law_from_z",
    "law_through",
    "least_prime_circle",
    "least_spring",
    "limit",
    "limit_law",
    "machine_spectrum",
    "map_arrays",
    "mass_law",
    "maximum",
    "mechanism_of_motion",
    "mirrored_law",
    "multiplied_law",
    "multiplier_for",
    "off_design",
    "open_study",
    "pareto_front",
    "peak",
    "polydyne",
    "proven_front",
    "rack",
    "read_cycle_table",
    "read_law",
    "read_motors",
    "read_spectrum",
    "residual_functional",
    "residual_phasor",
    "residual_vibration",
    "response_spectrum",
    "reversed_law",
    "rms",
    "rms_c",
    "rms_j",
    "rms_snap",
    "rocker_law",
    "run_study",
    "savin",
    "scca",
    "screw",
    "shaped_law",
    "slider_crank",
    "smoothstep",
    "snap",
    "split_table",
    "sweep",
    "synthesize",
    "synthesize_array",
    "synthesize_chunks",
    "synthesize_many",
    "time_front",
    "toggle",
    "trapezoid",
    "value",
    "via",
    "with_end_velocity",
    "with_profile_error",
]
