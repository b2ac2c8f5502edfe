"""What a designer weighs in a cam: motion, pressure angle, sizes, forces and spring, each as a number with its unit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import degrees

from optlaws.cams.barrel import BarrelCam
from optlaws.cams.curves.motion_by_angle import CamMotion
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.follower import positive
from optlaws.cams.forces import CamForces
from optlaws.cams.springs_and_flywheels import CONTACT, GREATEST, Spring
from optlaws.cycles.cycle import Cycle, Plan
from optlaws.cycles.optimisation.objectives import SUMS, kind_of
from optlaws.cycles.report import objective_unit
from optlaws.errors import OptlawsError
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import MILLI, QUANTITIES
from optlaws.numbers import chop
from optlaws.shown.difference import Difference, Differences
from optlaws.tolerances import FORCE_ROUNDING

#: values with their units, by their names
Values = dict[str, tuple[float, str]]

#: a pressure angle below it is none
SMALLEST_ANGLE = 1e-100
#: of the power of a follower, where that of the shaft is another
WITHOUT_FRICTION = "without friction at the cam"
#: units of forces and of stiffness by what the follower's way is
SPRING_UNITS = {"length": ("N", "N/m"), "angle": ("N m", "N m/rad")}


def motion_values(cam: DiscCam, rate: float) -> Values:
    """Peak velocity, acceleration and jerk of the follower at a speed of the cam in rad/s, and the cam's angles.

    Examples
    --------
    >>> from optlaws import Cycle, Return, Rise, TranslatingRoller
    >>> cycle = Cycle([Rise("35 mm", "180 deg", law="cycloidal"), Return(law="cycloidal")], speed="60 rpm")
    >>> values = motion_values(DiscCam(cycle, "60 mm", TranslatingRoller("12 mm")), 6.283185307179586)
    >>> {name: (round(value, 4), unit) for name, (value, unit) in values.items()}["peak acceleration"]
    (0.8796, 'm/s²')
    """
    values = _peaks(cam.displacement, rate)
    if (pressed := cam.extremes.greatest_pressure_angle.value) > SMALLEST_ANGLE:
        values["greatest pressure angle"] = degrees(pressed), "deg"
    values["prime circle"] = MILLI * positive(cam.prime_radius, "prime_radius"), "mm"
    return values


def barrel_values(cam: BarrelCam, rate: float) -> Values:
    """The same of a barrel cam, its angles at the bottom of the groove, and how far its flanks are from cusps."""
    steep = max(abs(extreme.value) for extreme in cam.pressure_angles)
    return _peaks(cam.displacement, rate) | {
        "greatest pressure angle at the bottom": (degrees(steep), "deg"),
        "least travel of a flank per radian": (MILLI * cam.margin.value, "mm"),
    }


def _peaks(motion: CamMotion, rate: float) -> Values:
    """Peak velocity, acceleration and jerk of a follower at a speed of the cam in rad/s."""
    return {
        f"peak {name}": (rate**nu * max(map(abs, motion.extremes(nu))), unit_of(motion.axis, nu))
        for nu, name in enumerate(QUANTITIES[1:], 1)
    }


def force_values(forces: CamForces) -> Values:
    """Greatest contact force, peak and root mean square of the shaft's torque, and with a width Hertz's pressure."""
    values: Values = {
        "greatest contact force": (forces.contact.most, "N"),
        "peak torque at the shaft": (forces.torque.peak, "N m"),
        "root mean square of the torque": (forces.rms_torque[1], "N m"),
    }
    if forces.width is not None:
        values["greatest Hertz's pressure"] = forces.pressure.most / 1e6, "MPa"
    return values


def spring_values(spring: Spring, axis: str) -> Values:
    """Stiffness and preload of the least spring, and its greatest force."""
    force, stiffness = SPRING_UNITS[axis]
    contact = spring.objective == GREATEST[CONTACT]
    return {
        "stiffness of the least spring": (spring.stiffness, stiffness),
        "its preload": (chop(spring.preload, spring.greatest, FORCE_ROUNDING), force),
        f"its greatest {'contact force' if contact else 'force'}": (spring.greatest, "N" if contact else force),
    }


def known_values(*parts: Callable[[], Values]) -> Values:
    """The values of all parts that a cam has: one whose mechanism, forces or spring do not exist has fewer."""
    values = Values()
    for part in parts:
        try:
            values |= part()
        except OptlawsError:
            continue
    return values


def cam_differences(
    name: str, usual: Values, chosen: Values, objective: str = "", broken: Callable[[], Sequence[str]] = tuple
) -> Differences:
    """The values of a cam beside those with the usual law of a name, and what that breaks; first what was minimised."""
    return Differences(
        name,
        [Difference(what, unit, usual.get(what, (None, ""))[0], value) for what, (value, unit) in chosen.items()],
        objective,
        broken,
    )


def objective_name(plan: Plan) -> str:
    """What the laws of a cam have the least of, as its values name it; empty where no law was optimised."""
    name = plan.minimise
    whole = kind_of(name)[1] or kind_of(name)[0] in SUMS
    return "" if not plan.solutions else name if whole else f"peak {name}"


def objective_value(motion: Cycle | Plan, name: str) -> Values:
    """The value of what was minimised in SI units, of its laws or of others in the same cycle; or nothing."""
    objective = name.removeprefix("peak ").removesuffix(f" {WITHOUT_FRICTION}")
    return {name: (motion.value(objective), objective_unit(motion.solve(), objective))} if name else {}
