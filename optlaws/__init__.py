"""Optimal motion laws for cam mechanisms and servo axes, with proof of their optimality."""

from typing import Any

from optlaws import laws, mechanisms, synthesis  # noqa: F401  # faces: they import nothing before a name is used
from optlaws.lazy import declare, face

_load, __dir__, __all__ = face(
    __name__,
    {
        "optlaws.balancing": "balanced_law BalancedLaw Balancing Clutch compare_dwell_mechanisms dwell_machine "
        "dwell_mechanism DwellMachine find_torsion_levers inertial_loader LeverCam Loader "
        "rocker_law TorsionLever TrapeziumSubstitute",
        "optlaws.cams.at_shaft": "cam_mechanism",
        "optlaws.cams.barrel": "BarrelCam",
        "optlaws.cams.best_laws": "best_prime_circle best_cam",
        "optlaws.cams.best_offset": "best_offset",
        "optlaws.cams.conjugate": "conjugate_cam",
        "optlaws.cams.curves.motion_by_angle": "CamMotion",
        "optlaws.cams.disc": "DiscCam",
        "optlaws.cams.sizing.energy_fluctuation": "EnergyFluctuation energy_fluctuation",
        "optlaws.cams.forces": "CamForces",
        "optlaws.cams.sizing.springs": "Spring least_spring",
        "optlaws.cams.as_manufactured": "AsMade as_made with_profile_error",
        "optlaws.cams.followers.inclined_flat": "InclinedFlat",
        "optlaws.cams.followers.oscillating_flat": "OscillatingFlat",
        "optlaws.cams.followers.oscillating_roller": "OscillatingRoller",
        "optlaws.cams.followers.translating_flat": "TranslatingFlat",
        "optlaws.cams.followers.translating_roller": "TranslatingRoller",
        "optlaws.cams.least_sizes": "greatest_roller least_prime_circle",
        "optlaws.cycles.advising.advice": "Advice",
        "optlaws.cycles.advising.advised_law": "AdvisedLaw",
        "optlaws.cycles.advising.advised_motion": "advise",
        "optlaws.cycles.advising.recommendation": "Recommendation",
        "optlaws.cycles.fastest_cycle": "FastestCycle LeastDuration LimitGain",
        "optlaws.cycles.interlocks.after": "After",
        "optlaws.cycles.interlocks.clearance": "Clearance",
        "optlaws.cycles.interlocks.forbidden_region": "Forbidden",
        "optlaws.cycles.interlocks.synchronous": "Synchronous",
        "optlaws.cycles.machine_axes": "Axes",
        "optlaws.cycles.cycle": "Cycle",
        "optlaws.cycles.old_tables.table": "OldTable read_cycle_table split_table",
        "optlaws.cycles.moves.fastest_move": "FastestMove",
        "optlaws.cycles.moves.front_over_time": "time_front",
        "optlaws.cycles.moves.time_front": "TimeFront",
        "optlaws.cycles.moves.timed_moves": "fastest fastest_moves",
        "optlaws.cycles.moves.transition_cam": "TransitionCam",
        "optlaws.cycles.specification.segments": "ConstantVelocity Dwell Free Move Return Rise",
        "optlaws.errors": "InfeasibleProblem InputError NoisyTable NotNormalised OptlawsError SolverFailure",
        "optlaws.files.schemas": "json_schema",
        "optlaws.motion.polynomials": "PiecewiseMotion",
        "optlaws.laws.catalogue.catalogue": "catalogue",
        "optlaws.laws.catalogue.reading": "read_law",
        "optlaws.laws.making.through_points": "law_through",
        "optlaws.laws.constants": "Constants",
        "optlaws.laws.law": "MotionLaw",
        "optlaws.laws.making.formula_law": "formula_law",
        "optlaws.laws.making.input_shaping": "shaped_law",
        "optlaws.laws.making.multiplier": "multiplied_law multiplier_for",
        "optlaws.laws.making.transform": "mirrored_law reversed_law with_end_velocity",
        "optlaws.laws.making.trapezoids": "scca trapezoid",
        "optlaws.laws.segments.piecewise": "PiecewiseLaw",
        "optlaws.laws.polynomial": "PolynomialLaw smoothstep",
        "optlaws.laws.savin": "SavinFamily savin",
        "optlaws.numbers": "deg",
        "optlaws.mechanisms.cam_constants": "cam_constant",
        "optlaws.mechanisms.machine.flat_output": "driving_law flat_output",
        "optlaws.mechanisms.polydyne_cam": "mass_law polydyne",
        "optlaws.mechanisms.machine.response": "CycleResponse Response",
        "optlaws.mechanisms.machine.follower": "Deviation Follower off_design",
        "optlaws.mechanisms.drives.drive_train": "Drive",
        "optlaws.mechanisms.drives.motor": "Motor read_motors",
        "optlaws.mechanisms.linkages.bodies": "Body Loads",
        "optlaws.mechanisms.linkages.mechanism": "Mechanism",
        "optlaws.mechanisms.linkages.four_bar": "four_bar",
        "optlaws.mechanisms.linkages.motions": "belt mechanism_of_motion rack screw",
        "optlaws.mechanisms.linkages.move_limit": "MoveLimit",
        "optlaws.mechanisms.linkages.slider_crank": "slider_crank",
        "optlaws.mechanisms.linkages.toggle": "toggle",
        "optlaws.mechanisms.machine.machine": "Machine",
        "optlaws.mechanisms.machine.masses": "Link",
        "optlaws.mechanisms.machine.parameters": "MachineSpectrum machine_spectrum",
        "optlaws.cycles.law_comparison": "Comparison compare_laws",
        "optlaws.mechanisms.measured_spectrum": "read_spectrum",
        "optlaws.mechanisms.residual": "residual_functional residual_phasor residual_vibration",
        "optlaws.mechanisms.spectrum": "ResponseSpectrum response_spectrum",
        "optlaws.numerics.peaks": "Peak",
        "optlaws.studies.run": "run_study",
        "optlaws.studies.study": "open_study",
        "optlaws.synthesis.arrays.problems": "ProblemArray map_arrays",
        "optlaws.synthesis.functionals.makers": "drive_torque functional integral peak rms value",
        "optlaws.synthesis.limits.closed_forms": "acceleration_limit limit",
        "optlaws.synthesis.limits.drive_limits": "DriveLimit drive_limit",
        "optlaws.synthesis.limits.laws": "limit_law",
        "optlaws.synthesis.pareto": "Front pareto_front",
        "optlaws.synthesis.problem.constants": "FUNCTIONALS B C C_minus C_plus D Functional J snap "
        "rms_c rms_j rms_snap",
        "optlaws.synthesis.problem.expression": "Expression maximum",
        "optlaws.synthesis.problem.problem": "Problem",
        "optlaws.synthesis.problem.ranges": "Range at_least at_most between",
        "optlaws.synthesis.problem.windows": "Window via",
        "optlaws.synthesis.proof.certificate": "Certificate",
        "optlaws.synthesis.proof.nodes": "Contact Leaf Split Tightening",
        "optlaws.synthesis.proven.front": "FrontPoint ProvenFront",
        "optlaws.synthesis.proven.refine": "proven_front",
        "optlaws.synthesis.solution": "Solution",
        "optlaws.synthesis.status": "Status",
        "optlaws.synthesis.solve": "synthesize",
        "optlaws.synthesis.solution_array": "SolutionArray",
        "optlaws.synthesis.solve_many": "sweep synthesize_array synthesize_chunks synthesize_many",
        "optlaws.synthesis.spaces.bases": "Basis Bernstein Chebyshev Pieces Powers",
        "optlaws.synthesis.spaces.end_conditions": "BoundaryConditions law_from_z",
        "optlaws.synthesis.spaces.periodic_pieces": "PeriodicPieces",
        "optlaws.synthesis.spaces.splines": "BSplines",
    },
    removed={
        "best_breaks": "export(...) to a format of polynomials takes the fewest that are near enough, or points=6 that "
        "many",
        "MachineFollower": "Follower.from_vibration('16.7 Hz', duration='0.1 s') is the follower of a machine",
        "machine_follower": "Follower.from_vibration('16.7 Hz', duration='0.1 s') is the follower of a machine, and "
        "its response(law).in_units('35 mm', duration='0.1 s') answers in units",
        "jerk_limited_move": "plan such moves by the motion functions of the controller, export a known one by "
        "fastest(...).export(...), or smooth ones for a controller by proven_front(...).export('c99')",
    },
)

declare(
    "law",
    {
        "optlaws.laws.segments.piecewise": "piecewise",
        "optlaws.laws.polynomial": "polynomial",
        "optlaws.balancing.loaders.law": "loader",
    },
)
declare(
    "segment",
    {
        "optlaws.laws.segments.fractional": "fractional",
        "optlaws.laws.segments.constant_power": "power",
        "optlaws.laws.segments.segment": "polynomial",
        "optlaws.laws.segments.sine": "harmonics sine",
        "optlaws.balancing.dwells.sections": "part",
        "optlaws.balancing.loaders.segment": "loader",
    },
)
declare(
    "basis",
    {
        "optlaws.synthesis.spaces.bases": "bernstein chebyshev pieces powers",
        "optlaws.synthesis.spaces.periodic_pieces": "periodic",
        "optlaws.synthesis.spaces.splines": "bsplines",
    },
)
declare(
    "export format",
    {
        "optlaws.exports.formats.br": "br-acp10",
        "optlaws.exports.formats.c99": "c99",
        "optlaws.exports.formats.codesys": "codesys-cambuilder codesys-xy codesys-xyva",
        "optlaws.exports.formats.plain": "csv isg kas lenze plcopen sew technosoft",
        "optlaws.exports.formats.rockwell": "rockwell-cam rockwell-cam-extended rockwell-cam-profile",
        "optlaws.exports.formats.ros": "ros2",
        "optlaws.exports.formats.siemens": "siemens-elements siemens-points siemens-polynomials",
        "optlaws.exports.formats.structured_text": "iec-st iec-st-real",
        "optlaws.exports.formats.twincat": "twincat-mc3 twincat-nc2 twincat-table",
    },
)
declare(
    "what moves",
    {"optlaws.mechanisms.linkages.mechanism": "mechanism", "optlaws.mechanisms.drives.drive_train": "drive"},
)
declare("plain constant", {"optlaws.balancing.loaders.constants": "B_loader C_loader D_loader"})
declare(
    "constant",
    {
        "optlaws.mechanisms.cam_constants": "B_cam C_cam C_minus_cam C_plus_cam D_cam J_cam",
        "optlaws.mechanisms.machine.output_constants": "output_peak output_rms",
        "optlaws.mechanisms.machine.residual_boxes": "mode_residual",
        "optlaws.mechanisms.residual": "residual",
        "optlaws.synthesis.functionals.makers": "integral peak rms value",
    },
)


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("optlaws")
    return _load(name)
