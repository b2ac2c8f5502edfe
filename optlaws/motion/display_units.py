"""The units in which tables and pictures show what is computed in SI units."""

from __future__ import annotations

from math import pi

from optlaws.motion.quantities import TURN

#: how many of a unit make one of SI: thousandths, millionths, turns a minute, degrees
MILLI, MICRO, RPM, DEGREES = 1e3, 1e6, 30.0 / pi, 360.0 / TURN
#: the degrees of a turn of the master
TURN_DEG = 360.0
#: units of position, velocity, acceleration and jerk, and how many of them make one of SI
UNITS = {
    "length": (("mm", MILLI), ("mm/s", MILLI), ("m/s²", 1.0), ("m/s³", 1.0)),
    "angle": (("deg", DEGREES), ("deg/s", DEGREES), ("rad/s²", 1.0), ("rad/s³", 1.0)),
}
