"""Mechanisms of problem files: a kind, its lengths, bodies and loads, and friction at the input."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from inspect import Parameter, signature
from pathlib import Path
from typing import Any

from optlaws.cams.at_shaft import cam_mechanism
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.follower import CamFollower, stated_prime_radius
from optlaws.cycles.cycle import Cycle
from optlaws.echo import shortened
from optlaws.errors import InputError, located
from optlaws.files.problem_file import convert
from optlaws.jobs.axes.segment_entries import SegmentEntries, segment_of
from optlaws.mechanisms.linkages.bodies import NO_LOADS, Body, Loads
from optlaws.mechanisms.linkages.four_bar import four_bar
from optlaws.mechanisms.linkages.mechanism import LinkGeometry, Mechanism
from optlaws.mechanisms.linkages.motions import belt, rack, screw
from optlaws.mechanisms.linkages.slider_crank import slider_crank
from optlaws.mechanisms.linkages.toggle import toggle
from optlaws.motion.quantities import quantity
from optlaws.suggest import unknown_key

_FRICTION = ("coulomb", "viscous")
_BY_TIME = ("velocity", "start_velocity", "end_velocity")


def _cam(
    *,
    prime_radius: Any,
    follower: Any,
    segment: Any,
    moved: Any,
    turning: Any = "counterclockwise",
    inertia: Any = 0.0,
    loads: Loads = NO_LOADS,
    over: Any = None,
) -> Mechanism:
    """The mechanism of a cam and its follower, whose motion over the cam's angle consists of segments."""
    cam = _disc(prime_radius, follower, segment, turning)
    return cam_mechanism(cam, moved, inertia=inertia, loads=loads, over=over)


def _disc(prime_radius: Any, follower: Any, segment: Any, turning: Any) -> DiscCam:
    if not isinstance(follower, Mapping):
        raise InputError(f"follower must be a table with its kind, got {shortened(follower)}")
    return DiscCam(_motion(segment), prime_radius, CamFollower.from_dict(follower), turning=turning)


def cam_of(entries: Mapping[str, Any]) -> DiscCam:
    """The cam of a mechanism of the kind "cam", for what draws it.

    Raises
    ------
    InputError
        If an entry of the cam is missing or wrong.

    Examples
    --------
    >>> segments = [{"kind": "rise", "by": "40 mm", "duration": "120 deg"}, {"kind": "return", "duration": "240 deg"}]
    >>> follower = {"kind": "translating roller", "radius": "12 mm"}
    >>> cam_of({"kind": "cam", "prime_radius": "60 mm", "follower": follower, "segment": segments}).base_radius
    0.048
    """
    with located("mechanism"):
        turning = entries.get("turning", "counterclockwise")
        return _disc(entries.get("prime_radius"), entries.get("follower"), entries.get("segment"), turning)


def _motion(segments: Any) -> Cycle:
    """The follower's motion over a turn of its cam, of segments whose durations are angles."""
    if not isinstance(segments, list) or not segments:
        raise InputError(f"segment must be a list of tables such as {{ kind = 'dwell' }}, got {shortened(segments)}")
    given = []
    for number, data in enumerate(segments, 1):
        if not isinstance(data, Mapping):
            raise InputError(f"segment {number} must be a table such as {{ kind = 'dwell' }}, got {shortened(data)}")
        entries = convert(data, SegmentEntries, Path(f"segment {number}"))
        durations = entries.duration if isinstance(entries.duration, list) else [entries.duration]
        for duration in durations:
            if duration is not None:
                quantity(duration, "angle", f"segment {number}: duration over a turn of the cam")
        if any(getattr(entries, name) is not None for name in _BY_TIME):
            raise InputError(f"segment {number}: a cam's motion is over its angle: it takes no velocity by the time")
        given.append(segment_of(entries, number))
    return Cycle(given, period="1 s")


#: what makes the mechanism of each kind; the entries of the kind are the names of its parameters
MAKERS: dict[str, Callable[..., Mechanism]] = {
    "slider crank": slider_crank,
    "four bar": four_bar,
    "toggle": toggle,
    "rack": rack,
    "belt": belt,
    "screw": screw,
    "cam": _cam,
    "table": Mechanism,
}


def mechanism_of(entries: Any) -> Mechanism:
    """The mechanism that a table of a problem file describes.

    Parameters
    ----------
    entries
        Its `kind`, and what the function of that kind takes by the same names: lengths, `bodies`, `loads`, `over`;
        friction at the input, `coulomb` and `viscous`, is an entry of all kinds.

    Raises
    ------
    InputError
        If an entry is unknown, missing or wrong; the error names it.

    Examples
    --------
    >>> press = mechanism_of(
    ...     {"kind": "slider crank", "crank": "0.1 m", "rod": "0.4 m", "bodies": {"slider": "5 kg"}, "coulomb": "1 N m"}
    ... )
    >>> round(press.inertia("90 deg"), 9), press.coulomb
    (0.05, 1.0)
    >>> mechanism_of({"kind": "slider crank", "cranck": "0.1 m"})
    Traceback (most recent call last):
    optlaws.errors.InputError: mechanism: unknown entry of a slider crank 'cranck'; did you mean 'crank'?
    """
    with located("mechanism"):
        if not isinstance(entries, Mapping):
            raise InputError(f"it must be a table with its kind, got {shortened(entries)}")
        kind = entries.get("kind")
        if kind is None:
            raise InputError(f"kind is missing: give one of {', '.join(MAKERS)}")
        if not isinstance(kind, str) or kind not in MAKERS:
            raise InputError(unknown_key(kind, MAKERS, "kind"))
        given = {name: value for name, value in entries.items() if name != "kind"}
        if kind == "cam" and isinstance(given.get("follower"), Mapping) and "base_radius" in given:  # of earlier files
            former, follower = given.pop("base_radius"), CamFollower.from_dict(given["follower"])
            given["prime_radius"] = stated_prime_radius(given.get("prime_radius"), former, follower)
        _check_names(given, kind)
        friction = {} if kind == "table" else {name: given.pop(name) for name in _FRICTION if name in given}
        for name, read in _READERS.items():
            if name in given:
                given[name] = read(given[name])
        mechanism = MAKERS[kind](**given)
        return mechanism.with_friction(**friction) if friction else mechanism


def _check_names(given: Mapping[str, Any], kind: str) -> None:
    parameters = signature(MAKERS[kind]).parameters
    known = dict.fromkeys([*parameters, *_FRICTION])
    for name in given:
        if name not in known:
            raise InputError(unknown_key(name, known, f"entry of a {kind}"))
    needed = [name for name, parameter in parameters.items() if parameter.default is Parameter.empty]
    needed += ["inertia"] * (kind == "table")
    missing = [name for name in needed if name not in given]
    if missing:
        raise InputError(f"a {kind} needs {', '.join(missing)} too")


def _bodies(given: Any) -> Any:
    """Bodies as a linkage takes them: tables of mass, centre and inertia become values."""
    if not isinstance(given, Mapping):
        return given
    return {
        name: _value(Body, ("mass", "centre", "inertia"), f"bodies: {name}", value)
        if isinstance(value, Mapping)
        else value
        for name, value in given.items()
    }


def _lengths(given: Any) -> Any:
    if not isinstance(given, Mapping):
        raise InputError(f"lengths must be a table such as {{ crank = '60 mm' }}, got {shortened(given)}")
    return given


def _value(kind: Callable[..., Any], names: Sequence[str], where: str, given: Any) -> Any:
    """A value of a kind from its table."""
    with located(where):
        if not isinstance(given, Mapping):
            raise InputError(f"it must be a table of {', '.join(names)}, got {shortened(given)}")
        for name in given:
            if name not in names:
                raise InputError(unknown_key(name, names))
        return kind(**given)


_LOADS = ("force", "over", "interpolation", "stiffness", "free", "gravity")
_READERS: dict[str, Callable[[Any], Any]] = {
    "bodies": _bodies,
    "lengths": _lengths,
    "loads": partial(_value, Loads, _LOADS, "loads"),
    "linkage": LinkGeometry.from_dict,
}
