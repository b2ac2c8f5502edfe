# made by tests/contracts/faces.py from the table in typing.py
from optlaws.balancing.dwells.choice import DwellComparison as DwellComparison
from optlaws.balancing.dwells.clutch import Teeth as Teeth
from optlaws.balancing.dwells.mechanism import DwellMechanism as DwellMechanism
from optlaws.balancing.dwells.mechanism import DwellType as DwellType
from optlaws.balancing.levers.design import Span as Span
from optlaws.cams.as_manufactured import ManufacturedFormat as ManufacturedFormat
from optlaws.cams.barrel import Side as Side
from optlaws.cams.barrel import SpaceCurve as SpaceCurve
from optlaws.cams.best_laws import BestCam as BestCam
from optlaws.cams.best_laws import BestPrimeCircle as BestPrimeCircle
from optlaws.cams.best_offset import BestOffset as BestOffset
from optlaws.cams.curves.file_options import CutFormat as CutFormat
from optlaws.cams.curves.motion_by_angle import CamStretch as CamStretch
from optlaws.cams.curves.motion_by_angle import Direction as Direction
from optlaws.cams.curves.plane_curve import PlaneCurve as PlaneCurve
from optlaws.cams.curves.process_by_angle import ForceStretch as ForceStretch
from optlaws.cams.curves.process_by_angle import ProcessByAngle as ProcessByAngle
from optlaws.cams.disc import CutCurve as CutCurve
from optlaws.cams.disc import Turning as Turning
from optlaws.cams.followers.follower import CamFollower as CamFollower
from optlaws.cams.followers.follower import Place as Place
from optlaws.cams.followers.rollers_and_faces import FaceContact as FaceContact
from optlaws.cams.followers.rollers_and_faces import RollerContact as RollerContact
from optlaws.cams.least_sizes import GreatestRoller as GreatestRoller
from optlaws.cams.least_sizes import LeastPrimeCircle as LeastPrimeCircle
from optlaws.cycles.advising.advised_law import LawKind as LawKind
from optlaws.cycles.advising.advised_law import LawMeasure as LawMeasure
from optlaws.cycles.advising.advised_law import ProvenLeast as ProvenLeast
from optlaws.cycles.interchange import PlotOver as PlotOver
from optlaws.cycles.interlocks.enclosed_axis import Way as Way
from optlaws.cycles.interlocks.interlock import Interlock as Interlock
from optlaws.cycles.interlocks.interlock import LeastClearance as LeastClearance
from optlaws.cycles.limit_rows import LimitTaken as LimitTaken
from optlaws.cycles.machine_axes import AxesPicture as AxesPicture
from optlaws.cycles.machine_axes import Overlap as Overlap
from optlaws.cycles.moves.time_front import TimePoint as TimePoint
from optlaws.cycles.moves.transition_cam import TransitionKind as TransitionKind
from optlaws.cycles.old_tables.better_moves import MoveGain as MoveGain
from optlaws.cycles.old_tables.stretches import Stretch as Stretch
from optlaws.cycles.specification.segments import CycleSegment as CycleSegment
from optlaws.exports.run_time.front_export import FrontExport as FrontExport
from optlaws.exports.run_time.planning import MoveStatus as MoveStatus
from optlaws.exports.run_time.planning import RunTimeMove as RunTimeMove
from optlaws.formulas.tree import Formula as Formula
from optlaws.laws.curve import Many as Many
from optlaws.laws.exporting import Interpolation as Interpolation
from optlaws.laws.law import Jumps as Jumps
from optlaws.laws.making.input_shaping import Shaper as Shaper
from optlaws.laws.making.multiplier import Multiplier as Multiplier
from optlaws.laws.segments.segment import Segment as Segment
from optlaws.mechanisms.drives.drive_train import DimensionlessDrive as DimensionlessDrive
from optlaws.mechanisms.drives.effort import Effort as Effort
from optlaws.mechanisms.drives.effort import SegmentEffort as SegmentEffort
from optlaws.mechanisms.drives.motor import MotorLosses as MotorLosses
from optlaws.mechanisms.drives.motor import Train as Train
from optlaws.mechanisms.drives.sheet import BestRatio as BestRatio
from optlaws.mechanisms.drives.sheet import CycleSheet as CycleSheet
from optlaws.mechanisms.drives.sheet import DriveSheet as DriveSheet
from optlaws.mechanisms.drives.sheet import Margin as Margin
from optlaws.mechanisms.linkages.bodies import DrivenLink as DrivenLink
from optlaws.mechanisms.linkages.bodies import LoadPlace as LoadPlace
from optlaws.mechanisms.linkages.dimensionless import DimensionlessMechanism as DimensionlessMechanism
from optlaws.mechanisms.linkages.entries import TableKind as TableKind
from optlaws.mechanisms.linkages.four_bar import FourBarBranch as FourBarBranch
from optlaws.mechanisms.linkages.linear_force import LinearForce as LinearForce
from optlaws.mechanisms.linkages.mechanism import InputAxis as InputAxis
from optlaws.mechanisms.linkages.mechanism import LinkGeometry as LinkGeometry
from optlaws.mechanisms.linkages.move_limit import LimitedMove as LimitedMove
from optlaws.mechanisms.machine.follower import Change as Change
from optlaws.mechanisms.machine.output_constants import OutputPeak as OutputPeak
from optlaws.mechanisms.machine.output_constants import OutputRms as OutputRms
from optlaws.mechanisms.machine.over_time import MachineCycle as MachineCycle
from optlaws.mechanisms.machine.over_time import MachineResponse as MachineResponse
from optlaws.mechanisms.machine.residual_boxes import ModeResidual as ModeResidual
from optlaws.mechanisms.machine.state_space import Rows as Rows
from optlaws.mechanisms.machine.state_space import StateSpace as StateSpace
from optlaws.mechanisms.residual import Residual as Residual
from optlaws.motion.motion import Motion as Motion
from optlaws.motion.piece import Piece as Piece
from optlaws.motion.polynomials import Derivatives as Derivatives
from optlaws.motion.polynomials import Extreme as Extreme
from optlaws.numbers import Array as Array
from optlaws.numbers import Complex as Complex
from optlaws.numbers import NumberOrQuantity as NumberOrQuantity
from optlaws.numbers import Quantity as Quantity
from optlaws.numerics.branch_and_bound import Extremes as Extremes
from optlaws.numerics.exact import Polynomial as Polynomial
from optlaws.numerics.interval import Interval as Interval
from optlaws.numerics.taylor import Jet as Jet
from optlaws.shown.summary import Summary as Summary
from optlaws.studies.progress import Watch as Watch
from optlaws.studies.study import Study as Study
from optlaws.synthesis.arrays.problems import Entry as Entry
from optlaws.synthesis.families.active_set import ActiveSet as ActiveSet
from optlaws.synthesis.families.family import ConstraintFamily as ConstraintFamily
from optlaws.synthesis.functionals.makers import FormulaKind as FormulaKind
from optlaws.synthesis.functionals.makers import PeakSide as PeakSide
from optlaws.synthesis.least_time.follower_residual import FollowerResidual as FollowerResidual
from optlaws.synthesis.least_time.least_time import LeastTime as LeastTime
from optlaws.synthesis.least_time.motor_torque import MotorTorque as MotorTorque
from optlaws.synthesis.least_time.motor_torque import TimedLimit as TimedLimit
from optlaws.synthesis.least_time.move_limits import MoveLimits as MoveLimits
from optlaws.synthesis.least_time.move_limits import RateLimit as RateLimit
from optlaws.synthesis.least_time.move_limits import TimedMove as TimedMove
from optlaws.synthesis.least_time.move_objective import MoveObjective as MoveObjective
from optlaws.synthesis.least_time.time_proof import TimeProof as TimeProof
from optlaws.synthesis.limits.drive_limits import DriveObjective as DriveObjective
from optlaws.synthesis.limits.phase_plane import PhasePlane as PhasePlane
from optlaws.synthesis.problem.constants import ProblemView as ProblemView
from optlaws.synthesis.problem.expression import Maximum as Maximum
from optlaws.synthesis.problem.expression import Term as Term
from optlaws.synthesis.proof.nodes import Node as Node
from optlaws.synthesis.proven.front import LazySequence as LazySequence
from optlaws.synthesis.proven.swept_parameter import SweptParameter as SweptParameter
from optlaws.synthesis.solution_array import SolvedPart as SolvedPart
from optlaws.synthesis.solve import Bound as Bound
from optlaws.synthesis.solve_many import Errors as Errors
from optlaws.synthesis.solve_many import Result as Result
from optlaws.synthesis.spaces.bases import PolynomialBasis as PolynomialBasis
from optlaws.synthesis.spaces.space import LawSpace as LawSpace
from optlaws.synthesis.spaces.splines import PiecewiseBasis as PiecewiseBasis

__all__ = [
    "ActiveSet",
    "Array",
    "AxesPicture",
    "BestCam",
    "BestOffset",
    "BestPrimeCircle",
    "BestRatio",
    "Bound",
    "CamFollower",
    "CamStretch",
    "Change",
    "Complex",
    "ConstraintFamily",
    "CutCurve",
    "CutFormat",
    "CycleSegment",
    "CycleSheet",
    "Derivatives",
    "DimensionlessDrive",
    "DimensionlessMechanism",
    "Direction",
    "DriveObjective",
    "DriveSheet",
    "DrivenLink",
    "DwellComparison",
    "DwellMechanism",
    "DwellType",
    "Effort",
    "Entry",
    "Errors",
    "Extreme",
    "Extremes",
    "FaceContact",
    "FollowerResidual",
    "ForceStretch",
    "Formula",
    "FormulaKind",
    "FourBarBranch",
    "FrontExport",
    "GreatestRoller",
    "InputAxis",
    "Interlock",
    "Interpolation",
    "Interval",
    "Jet",
    "Jumps",
    "LawKind",
    "LawMeasure",
    "LawSpace",
    "LazySequence",
    "LeastClearance",
    "LeastPrimeCircle",
    "LeastTime",
    "LimitTaken",
    "LimitedMove",
    "LinearForce",
    "LinkGeometry",
    "LoadPlace",
    "MachineCycle",
    "MachineResponse",
    "ManufacturedFormat",
    "Many",
    "Margin",
    "Maximum",
    "ModeResidual",
    "Motion",
    "MotorLosses",
    "MotorTorque",
    "MoveGain",
    "MoveLimits",
    "MoveObjective",
    "MoveStatus",
    "Multiplier",
    "Node",
    "NumberOrQuantity",
    "OutputPeak",
    "OutputRms",
    "Overlap",
    "PeakSide",
    "PhasePlane",
    "Piece",
    "PiecewiseBasis",
    "Place",
    "PlaneCurve",
    "PlotOver",
    "Polynomial",
    "PolynomialBasis",
    "ProblemView",
    "ProcessByAngle",
    "ProvenLeast",
    "Quantity",
    "RateLimit",
    "Residual",
    "Result",
    "RollerContact",
    "Rows",
    "RunTimeMove",
    "Segment",
    "SegmentEffort",
    "Shaper",
    "Side",
    "SolvedPart",
    "SpaceCurve",
    "Span",
    "StateSpace",
    "Stretch",
    "Study",
    "Summary",
    "SweptParameter",
    "TableKind",
    "Teeth",
    "Term",
    "TimePoint",
    "TimeProof",
    "TimedLimit",
    "TimedMove",
    "Train",
    "TransitionKind",
    "Turning",
    "Watch",
    "Way",
]
