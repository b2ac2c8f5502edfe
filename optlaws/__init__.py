"""Optimal motion laws for cam mechanisms and servo axes, with proof of their optimality."""

from optlaws.lazy import declare, face

_load, __dir__, _names = face(
    __name__,
    __file__,
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
# with * come names, not the packages that have more of them
__all__ = [name for name in _names if name not in {"laws", "mechanisms", "synthesis"}]

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
        "optlaws.laws.segments.fractional": "fractional power",
        "optlaws.laws.segments.segment": "polynomial",
        "optlaws.laws.segments.sine": "harmonics sine",
        "optlaws.balancing.dwells.sections": "part",
        "optlaws.balancing.loaders.segment": "loader",
    },
)
declare(
    "basis",
    {
        "optlaws.synthesis.spaces.bases": "bernstein bsplines chebyshev pieces powers",
        "optlaws.synthesis.spaces.free_pieces": "periodic",
    },
)
declare(
    "export format",
    {
        "optlaws.exports.formats.controllers": "br-acp10 codesys-cambuilder codesys-xy codesys-xyva rockwell-cam "
        "rockwell-cam-extended rockwell-cam-profile siemens-elements siemens-points siemens-polynomials twincat-mc3 "
        "twincat-nc2 twincat-table",
        "optlaws.exports.formats.plain": "csv isg kas lenze plcopen ros2 sew technosoft",
        "optlaws.exports.formats.source_code": "c99 iec-st iec-st-real",
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
        "optlaws.mechanisms.machine.polydyne": "B_cam C_cam C_minus_cam C_plus_cam D_cam J_cam",
        "optlaws.mechanisms.machine.output_constants": "output_peak output_rms",
        "optlaws.mechanisms.machine.residual": "mode_residual residual",
        "optlaws.synthesis.functionals.makers": "integral peak rms value",
    },
)


def __getattr__(name: str) -> object:
    if name == "__version__":
        from importlib.metadata import version

        return version("optlaws")
    return _load(name)
