"""Springs that keep a follower on its cam over a range of speeds, and flywheels: the least sufficient, with proof.

A flywheel is sized by the fluctuation of a shaft's energy over a turn: the work above that of its mean power.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import degrees
from typing import Any, Literal, NoReturn

import numpy as np
from numpy.typing import NDArray

from optlaws.cams.disc import DiscCam
from optlaws.cams.forces import CamForces, process_on, read_process_by_angle
from optlaws.cycles.cycle import Cycle, Plan
from optlaws.echo import shortened
from optlaws.entries.declared import Declared, declared, documented_by, entry
from optlaws.entries.value_types import Choice, Measured, Together
from optlaws.errors import InfeasibleProblem, InputError
from optlaws.formulas.tree import table_places
from optlaws.kept import kept_property
from optlaws.laws.storage import PlainNumbers
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.motion.quantities import TURN, in_degrees, quantity
from optlaws.motion.smooth_parts import RealFunction, SmoothParts
from optlaws.numbers import Array, NumberOrQuantity, Quantity, finite
from optlaws.numerics.branch_and_bound import Extremes, Function, extremes_of_each, integral
from optlaws.numerics.interval import Interval, chosen
from optlaws.numerics.roots import bisect
from optlaws.numerics.taylor import Jet, variable
from optlaws.sentences import sentence
from optlaws.tolerances import BEFORE_BREAK, FORCE_EXTREMES, VALUE_ROUNDING

_PROGRAM_ROUNDING = 1e-10  # of the forces: by so much the best spring for some angles may miss what these need
_SPRING_SETTLED = 1e-9  # of a greatest force: that of the best spring for some angles is met everywhere to so much
_SPRING_LIFT = 1e-9  # of the stroke: below so much no stiffness adds a force
_PROGRAM_SLACK = 1e-7  # of the forces: to so much a spring keeps to what is needed everywhere
_SPRING_EXTREMES = 1e-12  # contact forces that a spring is sized by
_LIFTED = 1e-3  # of the stroke: so far up more stiffness is more force

_FIRST = 97
_STEPS = 40
_NEAR, _BESIDE = 0.03, 10
_PARTS = 12
CONTACT = "contact"
_SPEED = Measured("angular velocity", least=0.0)
#: what is sought by the greatest force that is to be least
GREATEST = {"force": "greatest", CONTACT: CONTACT}
#: what is sought by itself
_SOLE = ("stiffness", "preload")
_UNITS = {"length": ("force", "stiffness"), "angle": ("torque", "torsional stiffness")}


@declared
class SoughtSpring(Declared, title="a spring"):
    """What a spring is to do over a range of speeds, and what of it is known."""

    speeds: tuple[Quantity, Quantity] = entry(
        Together(_SPEED, _SPEED), "The least and the greatest speed of the cam.", example=["0 rpm", "300 rpm"]
    )
    force: Quantity | None = entry(
        Measured("force", "torque"),
        "The least force of the cam on the follower, in the follower's direction of motion; 0 unless given.",
        default=None,
        example="20 N",
    )
    stiffness: Quantity | None = entry(
        Measured("stiffness", "torsional stiffness", least=0.0), "A given stiffness.", default=None, example="3 N/mm"
    )
    preload: Quantity | None = entry(
        Measured("force", "torque", least=0.0), "A given preload.", default=None, example="60 N"
    )
    greatest: Literal["force", "contact"] = entry(
        Choice(*GREATEST),
        "Which greatest force is least where neither stiffness nor preload is given: the force on the follower along "
        "its way, or the contact force between cam and follower without friction.",
        default="force",
    )

    @property
    def range(self) -> tuple[float, float]:
        """The least and the greatest speed, rad/s."""
        slow, fast = self.speeds
        return quantity(slow, "angular velocity", "speeds"), quantity(fast, "angular velocity", "speeds")

    def _check(self) -> None:
        slow, fast = self.range
        if slow > fast or fast == 0.0:
            raise InputError(f"speeds must rise from at least 0, got {shortened(list(self.speeds))}")


@dataclass(frozen=True)
class Spring(PlainNumbers):
    """A spring that holds a follower on its cam; N and N/m, or N m and N m/rad for a follower that swings.

    Attributes
    ----------
    stiffness, preload
        Of the spring; the preload is its force where the displacement is 0.
    greatest
        The greatest force at any angle and speed: on the follower along its way, or the contact force, N, where
        `least_spring` had greatest="contact".
    objective
        What was minimised: "preload", "stiffness", "greatest" or "contact".
    lower_bound
        The lower bound of the objective, to the accuracy of a linear program: the least for the angles that bind.
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
        """The value of the objective."""
        return self.greatest if self.objective == CONTACT else float(getattr(self, self.objective))

    @property
    def remark(self) -> str:
        """Why a stiffness or preload is 0; empty where the spring needs both.

        >>> Spring(0.0, 500.0, 500.0, "stiffness", 0.0, 27.0, (92.0, 31.4)).remark
        'no stiffness is needed: the preload alone keeps the follower on the cam at every speed; a real spring has ...'
        """
        if self.stiffness == self.preload == 0.0:
            return "no spring is needed: its own forces keep the follower on the cam at every speed"
        if self.stiffness == 0.0 and self.objective != "preload":
            return (
                "no stiffness is needed: the preload alone keeps the follower on the cam at every speed; a real spring "
                "has some, and presses harder by it where the follower is up"
            )
        if self.preload == 0.0 and self.objective != "stiffness":
            return "no preload is needed: the stiffness alone keeps the follower on the cam at every speed"
        return ""


@documented_by(SoughtSpring)
def least_spring(
    cam: DiscCam,
    *,
    drive: Mapping[str, Any],
    speeds: Sequence[Quantity],
    force: Quantity | None = None,
    stiffness: Quantity | None = None,
    preload: Quantity | None = None,
    process: Mapping[str, Any] | None = None,
    greatest: Literal["force", "contact"] = "force",
) -> Spring:
    """The least spring that keeps the follower on the cam at every speed of a range.

    The least preload is computed for a given stiffness, the least stiffness for a given preload, and without either
    both, such that the greatest force is least; of several such springs the one whose mean force is least. The
    problem is linear; at each angle the worst speed is known in closed form. Where one of the two is 0, `Spring.remark`
    has the reason.

    Parameters
    ----------
    cam
        The cam.
    drive
        What else the follower moves: mass or inertia, gravity, viscous, dry.
    process
        The force of a process on the follower, as of `CamForces`, that of its cycle unless given; over the time only
        where both speeds are the same.

    Raises
    ------
    InputError
        If a quantity is of another dimension, or the drive has a spring of its own.
    InfeasibleProblem
        If no stiffness helps, as where the follower would lift off at displacement 0.

    Examples
    --------
    >>> from optlaws import Cycle, Dwell, Return, Rise
    >>> from optlaws import TranslatingRoller
    >>> moves = [Rise("40 mm", "120 deg", law="3-4-5"), Dwell("60 deg"), Return(law="3-4-5")]
    >>> cam = DiscCam(Cycle(moves, speed="200 rpm"), prime_radius="80 mm", follower=TranslatingRoller("12 mm"))
    >>> spring = least_spring(cam, drive={"mass": "2 kg"}, speeds=("0 rpm", "300 rpm"), preload="20 N")
    >>> round(spring.stiffness, 3), round(spring.margin, 6) + 0.0, round(spring.critical[0], 3)
    (2273.443, 0.0, 91.667)
    """
    sought = SoughtSpring(speeds, force, stiffness, preload, greatest)  # type: ignore[arg-type] # which it checks
    for key in _SOLE:
        if key in drive:
            raise InputError(f"drive: the {key} is sought with the spring: to fix it give {key}=... beside the drive")
    if sought.range[0] < sought.range[1]:  # a force over time, which is another at each speed, is refused
        read_process_by_angle(process_on(cam, process), cam.displacement, None)
    forces, units = CamForces(cam, sought.speeds[1], drive, process=process), _UNITS[cam.displacement.axis]
    given = {"force": force, "preload": preload, "stiffness": stiffness}
    least, *known = (
        None if value is None else quantity(value, units[name == "stiffness"], name) for name, value in given.items()
    )
    return _exchange(_SpringTask(forces, sought.range, least or 0.0, (known[0], known[1]), GREATEST[greatest]))


@dataclass(frozen=True)
class _SpringTask:
    """A cam, the masses its follower moves, the range of speeds, the required contact force, and what is known."""

    forces: CamForces
    speeds: tuple[float, float]
    least: float
    known: tuple[float | None, float | None]  #: the preload and the stiffness
    greatest: str

    @property
    def objective(self) -> str:
        preload, stiffness = self.known
        return "preload" if stiffness is not None else self.greatest if preload is None else "stiffness"

    @property
    def contact(self) -> bool:
        return self.greatest == CONTACT

    def lever(self, angle: Array | Interval, order: int) -> Jet:
        """The force on the follower for 1 N of the force that is least where it is greatest."""
        return self.forces.lever(angle, order) if self.contact else variable(angle, order) * 0.0 + 1.0

    def displacement(self, angle: Array) -> Array:
        return np.asarray(self.forces.cam.displacement(angle))

    def rate(self, angle: float, side: float) -> float:
        """The speed at which the force is least (side 1) or greatest (-1): an end of the range, or between."""
        square, linear = (side * float(part.terms[0]) for part in self._moved(np.array(angle), 0))
        slow, fast = self.speeds
        inner = min(max(-0.5 * linear / square, slow), fast) if square > 0.0 else slow
        return min((slow, fast, inner), key=lambda rate: square * rate**2 + linear * rate)

    def without_spring(self, angle: Array | Interval, side: float | Array, order: int = 0) -> Jet:
        """The least (side 1) or greatest (-1) force on the follower at any speed, without the spring's force."""
        square, linear = (part * side for part in self._moved(angle, order))
        forces = [square * rate**2 + linear * rate for rate in self.speeds]
        if self.forces.load.viscous:
            # where the force bends up with the speed it is least where its slope vanishes, or at an end
            with np.errstate(divide="ignore", invalid="ignore"):
                rate = (linear / square * -0.5).clipped(*self.speeds)
            forces.append((square * rate + linear) * rate)
        load, least = self.forces.load, forces[0]
        for force in forces[1:]:
            least = -(-least).maximum(-force)
        taken = self.forces.process_force.jet(angle, order)
        return least * side + (load.constant + load.dry * self.forces.direction(angle)) - taken

    @kept_property
    def sides(self) -> Array:
        """Angles beside the edges at which forces may jump, on both sides of each, ever nearer to it."""
        edges = self.forces.edges
        steps = np.multiply.outer(np.geomspace(BEFORE_BREAK, _NEAR, _BESIDE), np.diff(edges))
        return np.concatenate([(edges[:-1] + steps).ravel(), (edges[1:] - steps).ravel()])

    @kept_property
    def sums(self) -> tuple[float, float]:
        """The integrals over the turn of the forces that a unit preload and a unit stiffness add."""
        motion, edges = self.forces.cam.displacement, self.forces.edges
        shares: tuple[Function, ...] = (
            lambda angle, order: 1.0 / self.lever(angle, order),
            lambda angle, order: motion.jet(angle, order) / self.lever(angle, order),
        )
        preload, stiffness = (0.5 * sum(integral(share, edges, share=FORCE_EXTREMES)) for share in shares)
        return preload, stiffness

    def _moved(self, angle: Array | Interval, order: int) -> tuple[Jet, Jet]:
        s, load = self.forces.cam.displacement.jet(angle, order + 2), self.forces.load
        return s.slope().slope() * load.inertia, s.slope() * load.viscous


def _exchange(task: _SpringTask) -> Spring:
    """The best spring by exchange: for some angles first, then also for each angle at which it is too weak."""
    edges = task.forces.edges
    angles = np.concatenate([np.linspace(edges[0], edges[-1], _FIRST), task.sides])
    for _ in range(_STEPS):
        best = _program(task, angles)
        force, pushed = _extremes(task, best)
        slack = _PROGRAM_SLACK * max(pushed.peak, task.least)
        settled = task.objective in _SOLE or pushed.high <= best[2] * (1.0 + _SPRING_SETTLED)
        if force.low >= task.least - slack and settled:
            break
        angles = np.append(angles, [force.least_at, pushed.most_at])
    return _strengthened(task, best, force)


def _extremes(task: _SpringTask, spring: tuple[float, float, float]) -> tuple[Extremes, Extremes]:
    """The least and the greatest force on the follower at any speed, each enclosed over the turn."""

    def forces(angle: Interval, order: int, which: NDArray[np.intp]) -> Jet:
        spring_force = task.forces.cam.displacement.jet(angle, order) * spring[1] + spring[0]
        along_way = task.without_spring(angle, np.where(which == 0, 1.0, -1.0), order) + spring_force
        if not task.contact:
            return along_way
        pressed = (along_way / task.lever(angle, order)).terms
        return Jet([chosen(which == 0, *pair) for pair in zip(along_way.terms, pressed, strict=True)])

    edges = [task.forces.edges] * 2
    least, greatest = extremes_of_each(forces, edges, share=_SPRING_EXTREMES, parts=[_PARTS] * 2)
    return least, greatest


def _program(task: _SpringTask, angles: Array) -> tuple[float, float, float]:
    """The best preload and stiffness for some angles, and the least greatest force there.

    The preload that a stiffness needs, and with it the greatest force, are the greatest of linear functions of the
    stiffness: what is least lies where the slope changes its sign. Where the greatest force does not change, the mean
    force counts.
    """
    y, lever = task.displacement(angles), np.asarray(task.lever(angles, 0).terms[0])
    low, high = (np.asarray(task.without_spring(angles, side).terms[0]) for side in (1.0, -1.0))
    needed = task.least - low
    unit, scale = float(np.abs([low, high]).max() + abs(task.least)) or 1.0, float(np.abs(y).max())

    def preload_of(stiffness: float) -> tuple[float, float]:
        values = needed - stiffness * y
        worst = int(np.argmax(values))
        return (float(values[worst]), -float(y[worst])) if values[worst] > 0.0 else (0.0, 0.0)

    def falls(stiffness: float) -> bool:
        preload, slope = preload_of(stiffness)
        rise = slope + float(y[np.argmax((high + preload + stiffness * y) / lever)])
        if abs(rise) <= _SPRING_LIFT * scale:
            rise = task.sums[0] * slope + task.sums[1]
        return rise < 0.0

    fixed, known = task.known
    if known is not None:
        stiffness = known
    elif fixed is not None:
        missing, lifted = needed - fixed, y > _SPRING_LIFT * scale
        if np.any(missing[~lifted] > _PROGRAM_ROUNDING * unit):
            _refuse(task, angles)
        stiffness = max(0.0, float((missing[lifted] / y[lifted]).max(initial=0.0)))
    else:
        most = unit / scale
        while falls(most):
            most *= 2.0
        stiffness = bisect(falls, 0.0, most)[1] if falls(0.0) else 0.0
    preload = preload_of(stiffness)[0] if fixed is None or known is not None else fixed
    return preload, stiffness, float(((high + preload + stiffness * y) / lever).max())


def _refuse(task: _SpringTask, angles: Array) -> NoReturn:
    missing = task.least - np.asarray(task.without_spring(angles, 1.0).terms[0]) - (task.known[0] or 0.0)
    worst = int(np.argmax(np.where(task.displacement(angles) <= 0.0, missing, -np.inf)))
    raise InfeasibleProblem(
        sentence(
            "no stiffness keeps the follower on the cam: at {} of the cam, where the displacement is not above 0, {} N "
            "(or N m) are missing; give so much more preload",
            in_degrees(angles[worst]), f"{missing[worst]:.6g}",
        )
    )  # fmt: skip


def _strengthened(task: _SpringTask, best: tuple[float, float, float], force: Extremes) -> Spring:
    """The spring strengthened by its greatest possible shortfall, and the force that remains everywhere."""
    preload, stiffness, greatest = best
    bound = {"preload": preload, "stiffness": stiffness}.get(task.objective, greatest)
    missing = max(task.least - force.low, 0.0)
    if task.known[0] is None:
        preload += missing
    elif (up := float(task.displacement(np.array(force.least_at)))) > _LIFTED * task.forces.cam.displacement.range[1]:
        stiffness += missing / up
    least, pushed = _extremes(task, (preload, stiffness, greatest))
    return Spring(
        stiffness=stiffness,
        preload=preload,
        greatest=pushed.high,
        objective=task.objective,
        lower_bound=bound,
        margin=least.low,
        critical=(degrees(least.least_at), task.rate(least.least_at, 1.0)),
    )


@dataclass(frozen=True)
class EnergyFluctuation(PlainNumbers):
    """The torque of a shaft over a turn beside its mean, which a motor of constant torque gives, in SI units.

    Attributes
    ----------
    speed
        Mean angular velocity of the shaft, rad/s.
    mean_power, mean_torque
        Over the turn, W and N m: what friction and processes take.
    energy
        The greatest work above the mean, J: the shaft gives off so much between the angle at which it is fastest and
        the one at which it is slowest.
    fastest_at, slowest_at
        These angles, rad.

    Examples
    --------
    >>> fluctuation = EnergyFluctuation(4.0, 120.0, 30.0, 16.0, 0.5, 2.5)
    >>> fluctuation.flywheel(0.05)
    20.0
    """

    speed: float
    mean_power: float
    mean_torque: float
    energy: float
    fastest_at: float
    slowest_at: float

    def flywheel(self, irregularity: float) -> float:
        """The moment of inertia, kg m², with which the speed keeps within an irregularity: I = E/(K w²).

        Parameters
        ----------
        irregularity
            K, the greatest less the least speed over their mean, such as 0.05: the cyclic irregularity, or coefficient
            of fluctuation of speed. All that turns evenly with the shaft counts; what the cam or mechanism moves is in
            the torque.

        Raises
        ------
        InputError
            If it is not above 0 and below 2, beyond which the shaft would turn back.
        """
        spread = finite(irregularity, "irregularity")
        if not 0.0 < spread < 2.0:
            raise InputError(
                f"irregularity must be above 0 and below 2, as a share of the mean speed, got {shortened(irregularity)}"
            )
        return self.energy / (spread * self.speed**2)


def energy_fluctuation(
    machine: CamForces | Cycle | Plan | Mechanism, speed: NumberOrQuantity | None = None
) -> EnergyFluctuation:
    """Mean power, mean torque and the work above the mean of a shaft that turns once a cycle at an even speed.

    The torque is integrated by Gauss's rule between the angles at which it has kinks or jumps, or crosses its mean.

    Parameters
    ----------
    machine
        A cam with its forces, whose torque is that of the cam's shaft; a cycle with its drive, whose power is that of
        the shaft that turns once a cycle; or a mechanism whose input turns evenly.
    speed
        Of a mechanism's input, such as "60 rpm"; that of cams and cycles is theirs.

    Raises
    ------
    InputError
        If the machine makes no whole turn, has no drive, or is not of these kinds, or the speed is missing or not its.

    Examples
    --------
    >>> from optlaws import Cycle, DiscCam, Dwell, Return, Rise, TranslatingRoller
    >>> moves = [Rise("40 mm", "120 deg", law="3-4-5"), Dwell("60 deg"), Return(law="3-4-5")]
    >>> cycle = Cycle(moves, speed="200 rpm", drive={"mass": "2 kg", "stiffness": "3 N/mm", "preload": "60 N"})
    >>> cam = DiscCam(cycle, prime_radius="80 mm", follower=TranslatingRoller("12 mm"))
    >>> of_cam, of_cycle = energy_fluctuation(CamForces(cam)), energy_fluctuation(cycle)
    >>> round(of_cam.energy, 6), round(of_cycle.energy, 6), round(of_cam.flywheel(0.05), 6)
    (4.8, 4.8, 0.218854)
    """
    if not isinstance(machine, Mechanism) and speed is not None:
        raise InputError(f"speed is that of a mechanism: cams and cycles have one, got {shortened(speed)}")
    if isinstance(machine, CamForces):
        motion = machine.cam.displacement
        if not motion.closed:
            raise InputError("the cam moves over a part of the turn: take a Cycle for the whole of it")
        return _of_torque(lambda angle: np.asarray(machine.shaft_torque(angle)), machine.edges, machine.rate)
    if isinstance(machine, Cycle | Plan):
        rate = TURN / machine.duration
        edges = machine.smooth_times * rate
        return _of_torque(lambda angle: np.asarray(machine.power(angle / rate)) / rate, edges, rate)
    if not isinstance(machine, Mechanism):
        raise InputError(f"machine must be a CamForces, a Cycle or a Mechanism, got {shortened(machine)}")
    if machine.axis != "angle" or not (machine.over[0] <= 0.0 and machine.over[1] >= TURN):
        raise InputError("machine: the mechanism's input makes no whole turn from 0 to 360 deg")
    if speed is None:
        raise InputError("speed is missing: give that of the mechanism's input, such as speed='60 rpm'")
    known = quantity(speed, "angular velocity", "speed", above=0.0)
    kinks = (table_places(part, "x") for part in (machine.inertia_formula, machine.load_formula))
    inner = sorted({place for places in kinks for place in places if 0.0 < place < TURN})
    edges = np.array([0.0, *inner, TURN])
    return _of_torque(lambda angle: np.asarray(machine.torque(angle, known, 0.0)), edges, known)


def _of_torque(torque: RealFunction, edges: Array, speed: float) -> EnergyFluctuation:
    """Mean and fluctuation of a torque, from the first to the last of the edges between which it is smooth."""
    start, stop = float(edges[0]), float(edges[-1])
    even = SmoothParts.between(start, stop, breaks=edges).halved(torque)
    mean = even.integral(torque) / (stop - start)
    parts = SmoothParts.between(start, stop, breaks=even.edges, signs=[lambda angle: torque(angle) - mean])
    works = parts.integrals(lambda angle: torque(angle) - mean)
    work, size = np.concatenate([[0.0], np.cumsum(works)]), float(np.abs(works).sum())
    # of angles at which the work is the same but for rounding, as in a dwell, the first
    least, most = work.min() + VALUE_ROUNDING * size, work.max() - VALUE_ROUNDING * size
    fastest, slowest = float(parts.edges[np.argmax(work <= least)]), float(parts.edges[np.argmax(work >= most)])
    if abs(mean) * (stop - start) <= VALUE_ROUNDING * size:
        mean = 0.0
    return EnergyFluctuation(speed, mean * speed, mean, float(work.max() - work.min()), fastest, slowest)
