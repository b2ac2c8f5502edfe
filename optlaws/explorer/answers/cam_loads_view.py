"""What a cam bears, as the page shows it: contact force, torque at its shaft and pressure over the turn, the spring."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import lru_cache
from math import degrees
from typing import Any

import msgspec
import numpy as np

from optlaws.cams.forces import CamForces
from optlaws.cams.summary import Labelled, named_forces
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.explorer.answers.cam_view import AskedCam, cams_of, panel
from optlaws.explorer.answers.law_view import digits, drawn
from optlaws.jobs.cam.forces_and_files import Findings, ForcesEntries, forces_of
from optlaws.numbers import Array
from optlaws.numerics.enclosures.branch_and_bound import Extremes

_STEPS = 360
_PER_MEGAPASCAL = 1e6
_NOTHING = 1e-7
_FORCE = {"length": "N", "angle": "N m"}
_STIFFNESS = {"length": "N/m", "angle": "N m/rad"}


def answer(asked: AskedCam) -> dict[str, Any]:
    """Panels and words of a cam whose motion has a drive; none where it has none.

    Examples
    --------
    >>> from optlaws.explorer.answers.cam_view import example
    >>> answer(AskedCam(study=example()))
    {'panels': [], 'facts': []}
    """
    try:
        return _answered(json.dumps(asked.study, sort_keys=True))
    except (InfeasibleProblem, InputError, SolverFailure) as error:
        return {"panels": [], "facts": [str(error.args[0])]}


@lru_cache(maxsize=32)
def _answered(question: str) -> dict[str, Any]:
    spec, cams = cams_of(AskedCam(study=json.loads(question)))
    if spec.motion.drive is None:
        return {"panels": [], "facts": []}
    asked = msgspec.structs.replace(spec, forces=spec.forces or ForcesEntries())
    forces = forces_of(asked, cams.first, cams.cycle)
    assert forces is not None  # noqa: S101 - they were asked for
    return {"panels": _panels(forces), "facts": [*_facts(forces), *_spring(Findings(asked, cams.first, cams.cycle))]}


def _panels(forces: CamForces) -> list[dict[str, Any]]:
    values = (forces.contact_force, forces.shaft_torque, forces.contact_pressure)
    panels = [_panel(force, curve) for force, curve in zip(named_forces(forces), values, strict=False)]
    for pressed in panels[2:]:
        pressed["peaks"] = pressed["peaks"][-1:]
    return panels


def _panel(force: Labelled[Extremes], values: Callable[[Array], Any]) -> dict[str, Any]:
    """A curve over the turn with its least and greatest value."""
    name, extremes, unit, factor = force
    angles = np.linspace(0.0, 2.0 * np.pi, _STEPS + 1)
    ends = [(extremes.least, extremes.least_at), (extremes.most, extremes.most_at)]
    marks = [
        {"at": round(degrees(at), 4), "value": value * factor, "text": digits(value * factor, 6)}
        for value, at in ends
        if abs(value) > _NOTHING * extremes.peak
    ]
    return panel(name, unit, drawn(np.degrees(angles), 4), factor * np.asarray(values(angles)), marks)


def _facts(forces: CamForces) -> list[str]:
    """What is enclosed over the whole turn, in words."""
    contact, torque = forces.contact, forces.torque
    lifted = f"the follower lifts off at {digits(degrees(contact.least_at), 5)} deg: " if forces.lifts_off else ""
    turned = f"torque at the shaft {digits(torque.least, 6)} to {digits(torque.most, 6)} N m"
    told = [
        f"{lifted}contact force {digits(contact.least, 6)} to {digits(contact.most, 6)} N",
        f"{turned}, root mean square {digits(forces.rms_torque[1], 6)} N m",
    ]
    if forces.width is not None:
        told.append(f"Hertz's pressure up to {digits(forces.pressure.most / _PER_MEGAPASCAL, 6)} MPa")
    return told


def _spring(bodies: Findings) -> list[str]:
    """The least spring, where a range of speeds is asked; or why there is none."""
    try:
        spring = bodies.spring
    except (InfeasibleProblem, InputError) as error:
        return [f"no spring: {error.args[0]}"]
    if spring is None:
        return []
    axis = bodies.cam.displacement.axis
    preload = 0.0 if abs(spring.preload) <= _NOTHING * spring.greatest else spring.preload
    sizes = f"{digits(spring.stiffness, 6)} {_STIFFNESS[axis]}, preload {digits(preload, 6)} {_FORCE[axis]}"
    return [
        f"least spring without lift-off: {sizes}, up to {digits(spring.greatest, 6)} {_FORCE[axis]} on the follower"
    ]
