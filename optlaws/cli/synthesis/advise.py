"""The command `optlaws advise`: the law to choose for a move or the axes of a cycle, with its gain and its cost."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import optlaws
from optlaws.cli.app import Stopped
from optlaws.cli.law_options import LIMITS, one_or_two, read_axes
from optlaws.cli.options import Signed, Written, given, options, takes
from optlaws.cli.show import Answer, save
from optlaws.errors import InputError, Interrupted, located
from optlaws.sentences import listed

if TYPE_CHECKING:
    from optlaws.cycles.advising.advice import Advice


_FOLLOWER: dict[str, Any] = {
    "name": "--frequency",
    "type": list[str],
    "read": one_or_two,
    "about": "Natural frequency of an elastic follower such as 30Hz, or twice for the least and the greatest.",
}


@takes(
    "Draw what is minimised over what decides, with the front, into this file, PNG or SVG; of one axis.",
    move=options("optlaws.motion.motion:motion_of_law", "stroke", "duration", group="A single move in place of a file"),
    wishes=options(
        "optlaws.cycles.advising.advice:advise",
        *("minimise", "degree", "points", "speed"),
        limits=LIMITS,
        laws={"name": "--law", "type": list[str], "default": None},
        follower=_FOLLOWER,
    ),
    damper=options("optlaws.mechanisms.machine.follower:from_vibration", "damping"),
)
def advise(
    file: Path | None = None,
    /,
    *,
    axis: str | None = None,
    move: Mapping[str, str | None],
    mass: Signed = None,
    wishes: dict[str, Any],
    damper: Mapping[str, float],
    output: Written = None,
) -> Answer:
    """Recommend a law: standard and optimal laws side by side, the cost of each, and the proven bounds.

    Parameters
    ----------
    file
        A problem file whose job is "cycle" or "cam", or the name of one that comes with optlaws, such as cycle_press;
        in its place --stroke and --duration, which with --speed is an angle, such as 110deg.
    axis
        The axis of the file; all of them unless given.
    mass
        What a single move accelerates, such as 2kg, or "0.05 kg m^2" of an angle: forces, power and energy are listed.
    output
        Write the proofs of all optimal laws to this JSON file, which `optlaws verify` checks.
    """
    if wishes["follower"] is not None:
        wishes["follower"] = {"frequency": wishes["follower"], **damper}
    if file is not None and given({**move, "mass": mass}):
        raise InputError("--stroke, --duration and --mass are of a single move: a file has its own")
    wishes = given(wishes)
    advice: dict[str, Advice] = {}
    failure: Stopped | None = None
    ways: dict[str, Callable[[], Advice]] = {"": lambda: _of_move(**move, mass=mass, wishes=wishes)}
    left_out = ""
    if file is not None:
        left_out = _left_out(file)
        ways = {name: partial(optlaws.advise, cycle, **wishes) for name, cycle in read_axes(file, axis, "cam").items()}
    for name, make in ways.items():
        try:
            with located(f"{file}: axis {name}") if file is not None else nullcontext():
                advice[name] = make()
        except Interrupted as stopped:
            advice[name], failure = stopped.partial, Stopped(str(stopped))
            break
    if output is not None:
        proofs = {name: each.proofs() for name, each in advice.items()}
        save(output, {"axes": proofs} if file is not None else {"move": proofs[""]})
    return Answer(
        lambda: _shown(advice, left_out), lambda: _data(advice, alone=file is None), lambda: _drawn(advice), failure
    )


def _data(advice: Mapping[str, Advice], *, alone: bool) -> dict[str, Any]:
    brief = {name: each.report().data for name, each in advice.items()}
    for law in (law for data in brief.values() for law in (*data["laws"], *data["front"])):
        law.pop("solutions", None)  # which --output writes
    return brief[""] if alone else brief


def _drawn(advice: Mapping[str, Advice]) -> Any:
    if len(advice) > 1:
        raise InputError(f"--plot draws one axis: choose it by --axis, of {', '.join(advice)}")
    return next(iter(advice.values())).plot()


def _of_move(stroke: str | None, duration: str | None, mass: str | None, wishes: Mapping[str, Any]) -> Advice:
    if stroke is None or duration is None:
        raise InputError("give a problem file, or --stroke such as 35mm and --duration such as 0.1s")
    from optlaws.motion.quantities import either

    dimension, _ = either(stroke, ("length", "angle"), "--stroke")
    if either(duration, ("time", "angle"), "--duration")[0] == "angle" and "speed" not in wishes:
        raise InputError(f"--duration {duration} is an angle of the master: give its --speed too, such as 180rpm")
    drive = None if mass is None else {"mass" if dimension == "length" else "inertia": mass}
    return optlaws.advise(optlaws.Rise(stroke, duration), drive=drive, **wishes)


#: of a cam, what its motion alone does not know
_OF_CAM = ("pressure_angle", "radius_of_curvature", "spring")


def _left_out(file: Path) -> str:
    """What of the file of a cam is no part of the advice, which is of its motion alone; blank of a cycle."""
    from optlaws.jobs.job import problem_of_job

    _, entries = problem_of_job(file, "cycle", "cam")
    left = [name for name in _OF_CAM if name in entries]
    if entries.get("job") != "cam" or not left:
        return ""
    return f"The advice is of the motion by itself, without {listed(left)} of the cam: `optlaws run` counts them."


def _shown(advice: Mapping[str, Advice], left_out: str) -> Iterable[Any]:
    """The laws of each axis, why some are missing, the recommendation, and what of the file is no part of it."""
    for axis, each in advice.items():
        report = each.report()
        yield from ([f"axis {axis}"] if len(advice) > 1 else [])
        yield from (*report.tables, *each.remarks, report.facts)
    yield from ([left_out] if left_out else [])
