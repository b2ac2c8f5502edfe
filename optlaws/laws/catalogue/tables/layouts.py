"""Layouts of cam tables in the files of controllers, by their fields."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from optlaws.laws.catalogue.tables.table_points import NO_UNITS, TableUnits


@dataclass(frozen=True)
class FieldLayout:
    """Fields of the structure of a controller, by their contents.

    `fields` says what a field holds and its name: x, y, v, a, j of points; x0, y0, ... and x1, y1, ... of the ends of a
    piece; c0, c1, ... of powers counted from where a piece begins; "type" of what runs after a point, "skip" of
    whether that is ignored.
    """

    name: str
    fields: str
    profiles: Mapping[str, str] | None = None  #: what numbers stand for in the field of the type
    units: TableUnits = NO_UNITS  #: of master and positions, where the structure says them

    @cached_property
    def roles(self) -> dict[str, str]:
        """Meanings of fields by their names in lower case."""
        pairs = (field.split("=") for field in self.fields.split())
        return {name.lower(): role for role, name in pairs}

    @cached_property
    def needed(self) -> frozenset[str]:
        """Names of the fields without which it is another layout."""
        optional = {"v", "a", "j", "j0", "type", "skip"}
        return frozenset(name for name, role in self.roles.items() if role not in optional)


_ENDS = (
    "x0=leadingValueStart x1=leadingValueEnd y0=followingValueStart y1=followingValueEnd v0=geoVeloStart "
    "v1=geoVeloEnd a0=geoAccelStart a1=geoAccelEnd"
)
#: numbers of MC_MotionFunctionType; its names are in the catalogue, apart from those of polynomials
_NC2 = {
    "0": "NOTDEF",
    "1": "POLYNOM1",
    "3": "POLYNOM3",
    "5": "POLYNOM5",
    "7": "POLYNOM7",
    "10": "SINUSLINIE",
    "11": "MODSINUSLINIE",
    "12": "BESTEHORN",
    "13": "BESCHLTRAPEZ",
    "15": "POLYNOM5_MM",
    "24": "POLYNOM7_MM",
}
#: numbers of EMotionFunctionType
_MC3 = {
    "0": "Undefined",
    "1": "Linear",
    "2": "Polynomial3",
    "3": "Polynomial5",
    "4": "Polynomial7",
    "8": "ModifiedSinusoid",
}
#: numbers of LCamHdl_ProfileConstants; the polynomial of all that is given has no name
_LCAMHDL = {"2": "DWELL", "3": "POLYNOM1", "4": "POLYNOM3", "5": "POLYNOM5", "44": ""}

LAYOUTS = (
    FieldLayout("CODESYS SMC_CAMXYVA", "x=dX y=dY v=dV a=dA"),
    FieldLayout(
        "CODESYS Poly7_Coeffs", "x0=x0 x1=x1 c0=a0 c1=a1 c2=a2 c3=a3 c4=a4 c5=a5 c6=a6 c7=a7",
    ),
    FieldLayout(
        "TwinCAT MC_MotionFunctionPoint",
        "x=MasterPos y=SlavePos v=SlaveVelo a=SlaveAcc j=SlaveJerk type=FunctionType skip=PointType",
        _NC2,
    ),
    FieldLayout(
        "TwinCAT MotionFunctionPoint",
        "x=MasterPosition y=SlavePosition v=SlaveVelocity a=SlaveAcceleration j=SlaveJerk type=FunctionType "
        "skip=Ignored",
        _MC3,
    ),
    FieldLayout(
        "Siemens LCamHdl_typeBasicPoint", "x=leadingValue y=followingValue v=velocityRatio a=accelerationRatio",
    ),
    FieldLayout("Siemens LCamHdl elements", f"{_ENDS} j0=geoJerkStart type=camProfileType", _LCAMHDL),
    FieldLayout("Rockwell CAM", "x=Master y=Slave"),
    FieldLayout("B&R MC_CAMPROFILE_TYP", "c0=a c1=b c2=c c3=d c4=e c5=f c6=g x1=x"),
    FieldLayout(
        "ABB MC_PPROFILE", "x=master_position y=interpolation_point v=Velocity_ratio a=Acceleration_ratio",
    ),
    FieldLayout(
        "ROS 2 JointTrajectory", "y=positions v=velocities a=accelerations x=time_from_start", units=TableUnits("s"),
    ),
)  # fmt: skip
