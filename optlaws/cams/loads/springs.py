"""Springs that keep a follower on its cam over a range of speeds: the least that does, with what proves it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import degrees
from typing import Any, NoReturn

import numpy as np

from optlaws.cams.disc import DiscCam
from optlaws.cams.loads.forces import CamForces
from optlaws.echo import shortened
from optlaws.errors import InfeasibleProblem, InputError
from optlaws.laws.storage import PlainNumbers
from optlaws.motion.quantities import quantity
from optlaws.numbers import Array, Quantity
from optlaws.numerics.branch_and_bound import Extremes, Function, extremes
from optlaws.numerics.interval import Interval
from optlaws.numerics.taylor import Jet
from optlaws.tolerances import LIFTED, PROGRAM_SLACK, SPRING_EXTREMES

_FIRST = 97
_STEPS = 40
_PARTS = 12
_UNITS = {"length": ("force", "stiffness"), "angle": ("torque", "torsional stiffness")}


@dataclass(frozen=True)
class Spring(PlainNumbers):
    """A spring that holds a follower on its cam; N and N/m, or N m and N m/rad for one that swings.

    Attributes
    ----------
    stiffness, preload
        Of the spring; the preload is its force where the displacement is 0.
    greatest
        The greatest force on the follower along its way, at any angle and speed.
    objective
        What was sought: "preload", "stiffness" or "greatest".
    lower_bound
        What it cannot be below, to the accuracy of a linear program: the least of springs that do at the angles that
        bind.
    margin
        Proven: along the follower's way the cam presses with at least this force at every angle and speed.
    critical
        Where the force is least: the cam's angle in degrees, and the speed in rad/s.

    Examples
    --------
    >>> Spring(3000.0, 20.0, 140.0, "stiffness", 3000.0, 0.0, (92.0, 31.4)).value
    3000.0
    """

    stiffness: float
    preload: float
    greatest: float
    objective: str
    lower_bound: float
    margin: float
    critical: tuple[float, float]

    @property
    def value(self) -> float:
        """The value of the objective that was sought."""
        return float(getattr(self, self.objective))


def least_spring(
    cam: DiscCam,
    *,
    drive: Mapping[str, Any],
    speeds: Sequence[Quantity],
    force: Quantity | None = None,
    stiffness: Quantity | None = None,
    preload: Quantity | None = None,
) -> Spring:
    """The least spring that keeps the follower on the cam at every speed of a range.

    The spring's preload is sought where its stiffness is given, its stiffness where the preload is, and where neither
    is, both, so that the greatest force on the follower is least. The problem is linear; at each angle the worst speed
    is known in closed form.

    Parameters
    ----------
    cam
        The cam.
    drive
        What else the follower moves: mass or inertia, gravity, viscous, dry.
    speeds
        The least and the greatest speed of the cam, such as ("0 rpm", "300 rpm").
    force
        What the cam shall press with at least, along the follower's way: "20 N"; 0 unless given.
    stiffness, preload
        Of the spring, where it is known: "3 N/mm", "60 N".

    Raises
    ------
    InputError
        If a quantity is of another dimension, or the drive has a spring of its own.
    InfeasibleProblem
        If no stiffness helps, as where the follower would lift off at displacement 0.

    Examples
    --------
    >>> from optlaws import Cycle, Dwell, Return, Rise
    >>> from optlaws.cams.followers.translating_roller import TranslatingRoller
    >>> moves = [Rise("40 mm", "120 deg", law="3-4-5"), Dwell("60 deg"), Return(law="3-4-5")]
    >>> cam = DiscCam(Cycle(moves, speed="200 rpm"), base_radius="80 mm", follower=TranslatingRoller("12 mm"))
    >>> spring = least_spring(cam, drive={"mass": "2 kg"}, speeds=("0 rpm", "300 rpm"), preload="20 N")
    >>> round(spring.stiffness, 3), round(spring.margin, 6) + 0.0, round(spring.critical[0], 3)
    (2273.443, 0.0, 91.667)
    """
    task = _task(cam, drive, speeds, force)
    force_unit, stiffness_unit = _UNITS[cam.displacement.axis]
    return _exchange(
        task, _KnownSpring(_known(preload, force_unit, "preload"), _known(stiffness, stiffness_unit, "stiffness"))
    )


@dataclass(frozen=True)
class _KnownSpring:
    """The given preload and stiffness of a spring."""

    preload: float | None
    stiffness: float | None

    @property
    def objective(self) -> str:
        if self.stiffness is not None:
            return "preload"
        return "greatest" if self.preload is None else "stiffness"


@dataclass(frozen=True)
class _SpringTask:
    """A cam, what its follower moves, between which speeds, and what the cam shall press with."""

    forces: CamForces
    slow: float
    fast: float
    least: float

    def displacement(self, angle: Array) -> Array:
        return np.asarray(self.forces.cam.displacement(angle))

    def rate(self, angle: float, side: float) -> float:
        """The speed at which the force is least (side 1) or greatest (-1): an end of the range, or between."""
        square, linear = (side * float(part.terms[0]) for part in self._moved(np.array(angle), 0))
        inner = min(max(-0.5 * linear / square, self.slow), self.fast) if square > 0.0 else self.slow
        return min((self.slow, self.fast, inner), key=lambda rate: square * rate**2 + linear * rate)

    def without_spring(self, angle: Array | Interval, side: float, order: int = 0) -> Jet:
        """The least (side 1) or greatest (-1) force on the follower at any speed, but for the spring's."""
        square, linear = (part * side for part in self._moved(angle, order))
        forces = [square * rate**2 + linear * rate for rate in (self.slow, self.fast)]
        if self.forces.load.viscous:
            # where the force bends up with the speed it is least where its slope vanishes, or at an end
            with np.errstate(divide="ignore", invalid="ignore"):
                rate = (linear / square * -0.5).clipped(self.slow, self.fast)
            forces.append((square * rate + linear) * rate)
        load, least = self.forces.load, forces[0]
        for force in forces[1:]:
            least = -(-least).maximum(-force)
        return least * side + (load.constant + load.dry * self.forces.direction(angle))

    def _moved(self, angle: Array | Interval, order: int) -> tuple[Jet, Jet]:
        s, load = self.forces.cam.displacement.jet(angle, order + 2), self.forces.load
        return s.slope().slope() * load.inertia, s.slope() * load.viscous


def _task(cam: DiscCam, drive: Mapping[str, Any], speeds: Sequence[Quantity], force: Quantity | None) -> _SpringTask:
    if not isinstance(speeds, tuple | list) or len(speeds) != 2:
        raise InputError(f"speeds must be two, the least and the greatest, got {shortened(speeds)}")
    for key in ("stiffness", "preload"):
        if key in drive:
            raise InputError(f"drive: the {key} is sought with the spring: to fix it give {key}=... beside the drive")
    slow, fast = (quantity(speed, "angular velocity", "speeds") for speed in speeds)
    if not 0.0 <= slow <= fast or fast == 0.0:
        raise InputError(f"speeds must rise from at least 0, got {shortened(speeds)}")
    least = 0.0 if force is None else quantity(force, _UNITS[cam.displacement.axis][0], "force")
    return _SpringTask(CamForces(cam, speed=speeds[1], drive=drive), slow, fast, least)


def _known(value: Quantity | None, dimension: str, name: str) -> float | None:
    if value is None:
        return None
    known = quantity(value, dimension, name)
    if known < 0.0:
        raise InputError(f"{name} must be at least 0, got {shortened(value)}")
    return known


def _exchange(task: _SpringTask, given: _KnownSpring) -> Spring:
    """The best spring by exchange: for some angles, then for those at which it is wrong too, until there are none."""
    edges = task.forces.edges
    angles = np.linspace(edges[0], edges[-1], _FIRST)
    for _ in range(_STEPS):
        best = _program(task, angles, given)
        force, pushed = _extremes(task, best)
        slack = PROGRAM_SLACK * max(pushed.peak, task.least)
        if force.low >= task.least - slack and (given.objective != "greatest" or pushed.high <= best[2] + slack):
            break
        angles = np.append(angles, [force.least_at, pushed.most_at])
    return _strengthened(task, given, best, force)


def _extremes(task: _SpringTask, spring: tuple[float, float, float]) -> tuple[Extremes, Extremes]:
    """The least and the greatest force on the follower at any speed, each enclosed over the turn."""

    def along(side: float) -> Function:
        def force(angle: Interval, order: int) -> Jet:
            spring_force = task.forces.cam.displacement.jet(angle, order) * spring[1] + spring[0]
            return task.without_spring(angle, side, order) + spring_force

        return force

    edges = task.forces.edges
    least, greatest = (extremes(along(side), edges, share=SPRING_EXTREMES, parts=_PARTS) for side in (1.0, -1.0))
    return least, greatest


def _program(task: _SpringTask, angles: Array, given: _KnownSpring) -> tuple[float, float, float]:
    """The best preload and stiffness for some angles, and the greatest force there: a linear program."""
    from scipy.optimize import linprog

    y = task.displacement(angles)
    low, high = (np.asarray(task.without_spring(angles, side).terms[0]) for side in (1.0, -1.0))
    unit = float(np.abs([low, high]).max() + abs(task.least)) or 1.0
    scale = float(np.abs(y).max())
    units = (unit, unit / scale)
    ones, y = np.ones_like(y), y / scale
    rows = np.concatenate([np.stack([-ones, -y, 0.0 * ones], axis=1), np.stack([ones, y, -ones], axis=1)])
    sides = np.concatenate([low - task.least, -high]) / unit
    known = (given.preload, given.stiffness)
    bounds = [(0.0, None) if value is None else (value / by,) * 2 for value, by in zip(known, units, strict=True)]
    weights = {"preload": (1.0, 0.0, 0.0), "stiffness": (0.0, 1.0, 0.0), "greatest": (0.0, 0.0, 1.0)}[given.objective]
    optimum = linprog(weights, A_ub=rows, b_ub=sides, bounds=[*bounds, (None, None)], method="highs")
    if optimum.status != 0 or optimum.x is None:
        _refuse(task, angles, given)
    preload, stiffness, greatest = (float(number) for number in optimum.x)
    return max(preload, 0.0) * unit, max(stiffness, 0.0) * units[1], greatest * unit


def _refuse(task: _SpringTask, angles: Array, given: _KnownSpring) -> NoReturn:
    missing = task.least - np.asarray(task.without_spring(angles, 1.0).terms[0]) - (given.preload or 0.0)
    worst = int(np.argmax(np.where(task.displacement(angles) <= 0.0, missing, -np.inf)))
    raise InfeasibleProblem(
        f"no stiffness keeps the follower on the cam: at {degrees(angles[worst]):.6g} deg of the cam, where the "
        f"displacement is not above 0, {missing[worst]:.6g} N (or N m) are missing; give so much more preload"
    )


def _strengthened(task: _SpringTask, given: _KnownSpring, best: tuple[float, float, float], force: Extremes) -> Spring:
    """The spring made stronger by what it may miss, and what is then left everywhere."""
    preload, stiffness, greatest = best
    bound = {"preload": preload, "stiffness": stiffness, "greatest": greatest}[given.objective]
    missing = max(task.least - force.low, 0.0)
    if given.preload is None:
        preload += missing
    elif (up := float(task.displacement(np.array(force.least_at)))) > LIFTED * task.forces.cam.displacement.range[1]:
        stiffness += missing / up
    least, pushed = _extremes(task, (preload, stiffness, greatest))
    return Spring(
        stiffness=stiffness,
        preload=preload,
        greatest=pushed.high,
        objective=given.objective,
        lower_bound=bound,
        margin=least.low,
        critical=(degrees(least.least_at), task.rate(least.least_at, 1.0)),
    )
