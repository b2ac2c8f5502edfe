"""Conjugate cams: the return cam of a pair, whose follower is fixed to the other follower and always in contact."""

from __future__ import annotations

from math import degrees, pi

from optlaws.cams.disc import TURNINGS, DiscCam
from optlaws.cams.followers.follower import CamFollower, positive, shown
from optlaws.entries.declared import Declared, ValueOf, declared, documented_by, entries_of, entry
from optlaws.entries.value_types import Measured
from optlaws.errors import InputError
from optlaws.motion.quantities import Exact, quantity
from optlaws.numbers import NumberOrQuantity

#: what gives a pair by what its follower's way is
_GIVEN_BY = {"length": "distance", "angle": "angle"}


@declared
class ReturnFollower(Declared, title="a pair"):
    """The second follower of a pair of cams: how it is fixed to the first one, and what it is where it is another."""

    distance: NumberOrQuantity | None = entry(
        Measured("length", above=0.0),
        "Between rollers or faces along a slide's way.",
        default=None,
        example="170 mm",
    )
    angle: NumberOrQuantity | None = entry(
        Measured("angle"), "Between the two arms on a pivot.", default=None, example="110 deg"
    )
    follower: CamFollower | None = entry(ValueOf(CamFollower), "The first one's unless given.", default=None)


@documented_by(ReturnFollower)
def conjugate_cam(
    cam: DiscCam,
    follower: CamFollower | None = None,
    *,
    distance: NumberOrQuantity | None = None,
    angle: NumberOrQuantity | None = None,
) -> DiscCam:
    """The return cam of a pair on one shaft, in the coordinates of the first cam.

    Its follower is fixed to the first one: on the slide beneath the shaft, or on the pivot with its arm on the
    other side. So the two cams hold their followers without a spring.

    Parameters
    ----------
    cam
        The first cam.

    Raises
    ------
    InputError
        If the followers are not of one kind or pivot, or there is no such mechanism; the error states the remedy.

    Examples
    --------
    >>> from optlaws import CamMotion
    >>> rise = CamMotion.of_law("cycloidal", "40 mm", "120 deg")
    >>> from optlaws import TranslatingRoller
    >>> first = DiscCam(rise, "60 mm", TranslatingRoller("12 mm"))
    >>> second = conjugate_cam(first, distance="160 mm")
    >>> round(float((first.pitch_curve(1.0) - second.pitch_curve(1.0)) @ [0.0, 1.0]) / 0.16, 9)
    0.540302306
    """
    second = cam.follower if follower is None else follower
    if type(second) is not type(cam.follower):
        raise InputError(f"follower: the second one of a pair must be a {type(cam.follower).__name__}, as the first")
    if second.pivot != cam.follower.pivot:
        raise InputError("follower: the second one of a pair is on the pivot of the first: give it its pivot_distance")
    name, given = _GIVEN_BY[second.axis], {"distance": distance, "angle": angle}
    if given[name] is None or sum(value is not None for value in given.values()) != 1:
        such = f"{name}={entries_of(ReturnFollower)[name].example!r}"
        raise InputError(f"a pair of {type(second).__name__} is given by its {name} alone, such as {such}")
    motion, phase = cam.displacement, quantity(cam.phase, "angle", "phase")
    size = positive(distance, name) if name == "distance" else quantity(angle, "angle", name)
    least = size - cam.contact.level - (motion.range[1] - motion.range[0])
    if name == "distance" and least <= 0.0:
        raise InputError(
            f"distance {shown(size)} is too short: the first follower is up to {shown(size - least)} above the"
            " shaft, and the second must be beneath it: make it longer"
        )
    if name == "angle" and not 0.0 < least < pi:
        raise InputError(
            f"angle {degrees(size):.6g} deg leaves {degrees(least):.6g} deg between the second arm and the line to the"
            f" cam's centre: give more than {degrees(size - least):.6g} deg and less than half a turn beyond"
        )
    circle = motion.reversed(), Exact(second.prime_radius(least), "m")
    if name == "distance":  # as seen from beneath the shaft the cam is turned by half a turn
        return DiscCam(*circle, second.from_beneath(), turning=cam.turning, phase=Exact(phase + pi, "rad"))
    # on the other side of the line to the pivot, seen in a mirror, it turns the other way
    other = next(name for name, turning in TURNINGS.items() if turning == -cam.contact.turning)
    return DiscCam(*circle, second, turning=other, phase=Exact(-phase, "rad"), mirrored=not cam.mirrored)
