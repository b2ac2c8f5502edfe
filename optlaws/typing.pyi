from .balancing.dwells.choice import DwellComparison as DwellComparison
from .balancing.dwells.clutch import Teeth as Teeth
from .balancing.dwells.mechanism import DwellMechanism as DwellMechanism, DwellType as DwellType
from .balancing.levers.design import Span as Span
from .cams.as_manufactured import ManufacturedFormat as ManufacturedFormat
from .cams.barrel import Side as Side, SpaceCurve as SpaceCurve
from .cams.best_laws import BestCam as BestCam, BestPrimeCircle as BestPrimeCircle
from .cams.curves.cam_files import CutCurve as CutCurve, CutFormat as CutFormat
from .cams.curves.motion_by_angle import CamStretch as CamStretch, Direction as Direction
from .cams.curves.plane_curve import PlaneCurve as PlaneCurve
from .cams.disc import Turning as Turning
from .cams.followers.faces import FaceContact as FaceContact
from .cams.followers.follower import CamFollower as CamFollower, Place as Place
from .cams.followers.rollers import RollerContact as RollerContact
from .cams.forces import ForceStretch as ForceStretch, ProcessByAngle as ProcessByAngle
from .cams.least_sizes import (
    BestOffset as BestOffset,
    GreatestRoller as GreatestRoller,
    LeastPrimeCircle as LeastPrimeCircle,
)
from .cycles.advising.candidates import LawKind as LawKind, LawMeasure as LawMeasure, ProvenLeast as ProvenLeast
from .cycles.axes.enclosed import Way as Way
from .cycles.axes.interlock import Interlock as Interlock, LeastClearance as LeastClearance
from .cycles.axes.machine_answers import AxesPicture as AxesPicture
from .cycles.axes.machine_axes import Overlap as Overlap
from .cycles.answers import PlotOver as PlotOver
from .cycles.specification.limits import LimitTaken as LimitTaken
from .cycles.moves.time_front import TimePoint as TimePoint
from .cycles.transitions import TransitionKind as TransitionKind
from .cycles.old_tables.better_laws import MoveGain as MoveGain
from .cycles.old_tables.stretches import Stretch as Stretch
from .cycles.specification.segments import CycleSegment as CycleSegment
from .exports.front_export import FrontExport as FrontExport, MoveStatus as MoveStatus, RunTimeMove as RunTimeMove
from .formulas.tree import Formula as Formula
from .laws.curve import Many as Many
from .laws.law import Interpolation as Interpolation, Jumps as Jumps
from .laws.making.input_shaping import Shaper as Shaper
from .laws.making.multiplier import Multiplier as Multiplier
from .laws.segments.segment import Segment as Segment
from .mechanisms.drives.effort import (
    BestRatio as BestRatio,
    CycleSheet as CycleSheet,
    DriveSheet as DriveSheet,
    Effort as Effort,
    Margin as Margin,
    SegmentEffort as SegmentEffort,
)
from .mechanisms.linkages.mechanism_kinds import DrivenLink as DrivenLink, LoadPlace as LoadPlace
from .mechanisms.linkages.mechanism_formulas import (
    LinearForce as LinearForce,
    StrokeTorque as StrokeTorque,
    Train as Train,
)
from .mechanisms.linkages.mechanism_formulas import InputAxis as InputAxis, TableKind as TableKind
from .mechanisms.linkages.plane_linkages import FourBarBranch as FourBarBranch
from .mechanisms.linkages.mechanism import LinkGeometry as LinkGeometry
from .mechanisms.linkages.move_limit import LimitedMove as LimitedMove
from .mechanisms.machine.follower import Change as Change
from .mechanisms.machine.output_constants import OutputPeak as OutputPeak, OutputRms as OutputRms
from .mechanisms.machine.over_time import MachineMotion as MachineMotion
from .mechanisms.machine.residual import (
    BandResidual as BandResidual,
    ModeResidual as ModeResidual,
    Residual as Residual,
    Vibrating as Vibrating,
)
from .mechanisms.machine.state_space import Rows as Rows, StateSpace as StateSpace
from .motion.motion import Motion as Motion
from .motion.piece import Piece as Piece
from .motion.polynomials import Derivatives as Derivatives, Extreme as Extreme
from .numbers import Array as Array, Complex as Complex, NumberOrQuantity as NumberOrQuantity, Quantity as Quantity
from .numerics.branch_and_bound import Extremes as Extremes
from .numerics.exact import Polynomial as Polynomial
from .numerics.interval import Interval as Interval
from .numerics.taylor import Jet as Jet
from .shown.report import Report as Report
from .shown.summary import Summary as Summary
from .studies.progress import Watch as Watch
from .studies.study import Study as Study
from .synthesis.arrays.problems import Entry as Entry
from .synthesis.families.active_set import ActiveSet as ActiveSet
from .synthesis.families.family import ConstraintFamily as ConstraintFamily
from .synthesis.functionals.makers import FormulaKind as FormulaKind, PeakSide as PeakSide
from .synthesis.least_time.least_time import LeastTime as LeastTime, TimeProof as TimeProof
from .synthesis.least_time.motor_torque import MotorTorque as MotorTorque
from .synthesis.least_time.move_limits import (
    FollowerResidual as FollowerResidual,
    MoveLimits as MoveLimits,
    SpanLimit as SpanLimit,
    TimedLimit as TimedLimit,
)
from .synthesis.least_time.timed_move import MoveObjective as MoveObjective, TimedMove as TimedMove
from .synthesis.limits.plane_of_problem import DriveObjective as DriveObjective
from .synthesis.limits.phase_plane import PhasePlane as PhasePlane
from .synthesis.problem.constants import ProblemView as ProblemView
from .synthesis.problem.expression import Maximum as Maximum, Term as Term
from .synthesis.proof.nodes import Node as Node
from .synthesis.proven.front import LazySequence as LazySequence
from .synthesis.proven.swept_parameter import SweptParameter as SweptParameter
from .synthesis.solution_array import SolvedPart as SolvedPart
from .synthesis.method.exchange import Method as Method
from .synthesis.solve import Bound as Bound
from .synthesis.solve_many import Errors as Errors, Result as Result
from .synthesis.spaces.bases import PolynomialBasis as PolynomialBasis
from .synthesis.spaces.space import LawSpace as LawSpace
from .synthesis.spaces.bases import PiecewiseBasis as PiecewiseBasis
