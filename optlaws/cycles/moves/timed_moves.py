"""Least times of single moves in machine units: strokes, limits, motors and elastic followers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import inf, isfinite, tau
from typing import Any

from optlaws.cycles.moves.fastest_move import AXES, FastestMove
from optlaws.cycles.optimisation.objectives import curve_lines
from optlaws.cycles.specification.limits import AXES as SI
from optlaws.cycles.specification.limits import (
    DECELERATION,
    LIMITS_OF_MOVE,
    OF_WHOLE,
    Limits,
    Side,
    amount,
    greatest,
    read_limits,
    sides,
    tightest,
)
from optlaws.echo import shortened
from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Either, Listed, Measured, Number, is_list
from optlaws.errors import InputError
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import Kind, either, quantity
from optlaws.numbers import NumberOrQuantity, Quantity, listed
from optlaws.sentences import sentence
from optlaws.synthesis.least_time.least_time import LeastTime
from optlaws.synthesis.least_time.motor_torque import LossyGear, MotorTorque
from optlaws.synthesis.least_time.move_limits import RESIDUAL, RESIDUALS, FollowerResidual, MoveLimits
from optlaws.synthesis.least_time.time_search import least_time
from optlaws.synthesis.least_time.timed_move import TimedMove
from optlaws.synthesis.problem.problem import Problem

_MOST = 100_000
_SIDES = (
    ("velocity", Kind.VELOCITY, 1.0),
    ("acceleration", Kind.ACCELERATION, 1.0),
    (DECELERATION, Kind.ACCELERATION, -1.0),
    ("jerk", Kind.JERK, 1.0),
    ("snap", Kind.SNAP, 1.0),
)
_EXAMPLE = '{"frequency": ("15.9 Hz", "17.5 Hz"), "damping": 0.05}'


def fastest(
    problem: Problem,
    *,
    stroke: Quantity,
    limits: Mapping[str, Any],
    start_velocity: Quantity | None = None,
    end_velocity: Quantity | None = None,
    drive: Drive | None = None,
    start: NumberOrQuantity = 0.0,
    follower: Mapping[str, Any] | None = None,
) -> FastestMove:
    """The least time of a single move within limits in machine units, and the proof that no law is faster.

    Parameters
    ----------
    problem
        The space of laws: order, basis, windows, monotone, symmetric. Its B, C, D and J are free, and it minimises
        nothing. Where limits or ends are not the same both ways its laws need not be symmetric.
    stroke
        How far, above 0: "100 mm" or "90 deg".
    limits
        By name: "velocity", "acceleration", "deceleration", "jerk", "snap", such as "1 m/s", of both signs. The
        acceleration may be a pair of the least and the greatest, the velocity a pair that begins with 0 for a move
        that never turns back. "deceleration" is the greatest acceleration against the stroke.
    start_velocity, end_velocity
        Velocities at the ends, such as "0.2 m/s"; rest unless given. The acceleration is 0 there from order 3 on.
    drive
        A motor that moves the axis through a mechanism and a gear, which may lose power: the stroke is that of the
        mechanism's input. Limits may name the "torque" at the motor and its "rms torque" over the move; the torque is
        at most the motor's peak torque and below its curve over the speed, and the speed at most its greatest speed.
        Laws never turn back then.
    start
        Position of the mechanism's input where the move begins.
    follower
        What the axis drives elastically, as {"frequency": ("15.9 Hz", "17.5 Hz"), "damping": 0.05}: its natural
        frequency, or the least and the greatest, and its damping ratio, 0 unless given. Limits then name the "residual
        acceleration" or the "residual displacement", the amplitude that vibrates on after the move.

    Returns
    -------
    FastestMove
        The least time, its law, which limits bind, the proof, and the limit of all laws.

    Raises
    ------
    InputError
        If a quantity is wrong, or every time satisfies the limits.
    InfeasibleProblem
        If no law keeps the problem's windows, however long it takes.
    SolverFailure
        If the steps of the time do not settle.

    Examples
    --------
    >>> import optlaws
    >>> limits = {"velocity": "1 m/s", "acceleration": ("-8 m/s^2", "12 m/s^2"), "jerk": "300 m/s^3"}
    >>> move = fastest(optlaws.Problem(order=3), stroke="100 mm", limits=limits)
    >>> round(move.duration, 6), round(move.best_possible, 6), move.binding
    (0.243994, 0.240161, ('acceleration', 'deceleration', 'jerk'))
    """
    move, unit = _timed(problem, stroke, limits, (start_velocity, end_velocity), drive, start, follower)
    return FastestMove(least_time(move), unit)


def fastest_moves(
    problem: Problem,
    *,
    strokes: Sequence[Quantity],
    limits: Mapping[str, Any],
    start_velocity: Quantity | None = None,
    end_velocity: Quantity | None = None,
    drive: Drive | None = None,
    start: NumberOrQuantity = 0.0,
    follower: Mapping[str, Any] | None = None,
) -> tuple[FastestMove, ...]:
    """The least times of many strokes within the same limits, each with its law and its proof.

    From rest to rest each begins from the next shorter stroke, whose multipliers say up to which time its own limits
    are too tight, or whose contacts are near its own.

    Parameters
    ----------
    problem, limits, start_velocity, end_velocity, drive, start, follower
        As `fastest` takes them; all moves begin at one position of the mechanism.
    strokes
        Strokes, all lengths or all angles; the moves are in their order.

    Raises
    ------
    InputError, InfeasibleProblem, SolverFailure
        As `fastest`, for the first stroke where it does.

    Examples
    --------
    >>> import optlaws
    >>> limits = {"velocity": "1 m/s", "jerk": "300 m/s^3"}
    >>> moves = fastest_moves(optlaws.Problem(order=3), strokes=["400 mm", "50 mm"], limits=limits)
    >>> [(round(move.duration, 6), move.binding) for move in moves]
    [(0.528054, ('velocity', 'jerk')), (0.178846, ('jerk',))]
    """
    machine = (limits, (start_velocity, end_velocity), drive, start, follower)
    moves = [_timed(problem, stroke, *machine) for stroke in listed(strokes, "strokes", _MOST)]
    answers: dict[int, FastestMove] = {}
    last: LeastTime[TimedMove] | None = None
    for i in sorted(range(len(moves)), key=lambda place: moves[place][0].stroke):
        move, unit = moves[i]
        last = least_time(move, last if follower is None else None)
        answers[i] = FastestMove(last, unit)
    return tuple(answers[i] for i in range(len(moves)))


def _timed(
    problem: Any,
    stroke: Any,
    limits: Mapping[str, Any],
    ends: tuple[Quantity | None, Quantity | None],
    drive: Drive | None,
    start: NumberOrQuantity,
    follower: Mapping[str, Any] | None,
) -> tuple[TimedMove, str]:
    """The move whose time is sought within all its limits in SI units, and the unit of its stroke."""
    entries = LIMITS_OF_MOVE.read(limits, "limits")
    dimension, far = either(stroke, tuple(AXES.values()), "stroke")
    if not far > 0.0:
        remedy = "turn the axis and its limits round" if far else "give how far it moves, such as '100 mm'"
        raise InputError(f"stroke must be above 0, got {shortened(stroke)}: {remedy}")
    allowed, torque, residual = read_limits(entries, dimension, "limits"), None, None
    left = [name for name in RESIDUALS if name in entries]
    if len(left) > 1:
        raise InputError(f"limits: {left[0]} and {left[1]} are of one vibration: give one of them")
    if follower is not None:
        if not left:
            raise InputError(f'a follower, as in {_EXAMPLE}, needs limits={{"{RESIDUAL}": "0.5 m/s^2"}}')
        most, of = allowed[OF_WHOLE[left[0]]][1], left[0].removeprefix("residual ")
        residual = replace(read_follower(follower), most=most, of=of)
    elif left:
        raise InputError(f"limits: {left[0]} is that of a follower: give the follower")
    if drive is not None:
        torque = motor_torque(drive, start, stroke, allowed)
        most = drive.motor.greatest_speed / drive.ratio
        allowed = tightest(allowed, {Kind.VELOCITY: (-most, most)})
    elif Kind.FORCE in allowed or Kind.RMS_FORCE in allowed:
        name = "torque" if Kind.FORCE in allowed else "rms torque"
        raise InputError(f"limits: {name} is at a motor: give its drive")
    if not isinstance(problem, Problem):
        raise InputError(f"a least time is sought of a Problem, got {type(problem).__name__}")
    first, last = (
        0.0 if value is None else quantity(value, SI[dimension][1], name)
        for name, value in zip(("start_velocity", "end_velocity"), ends, strict=True)
    )
    forward = Kind.VELOCITY_ALONG in allowed or torque is not None
    space = replace(problem, monotone=True) if forward else problem
    if DECELERATION in entries and is_list(entries.get("acceleration")):
        raise InputError("limits: the acceleration is a pair, so that deceleration is given twice")
    return TimedMove(
        space, far, move_limits(sides(allowed, 1.0), 1.0, dimension), first, last, torque, residual
    ), unit_of(dimension)


def move_limits(limits: Mapping[Side, float], direction: float, axis: str) -> MoveLimits:
    """The limits of a move in a direction; an `InputError` where one but that of the acceleration has two sides."""
    for key, most in limits.items():
        alone = key.kind in {Kind.ACCELERATION, Kind.VELOCITY_ALONG}
        if key.sign and not alone and greatest(limits, key.kind, -key.sign) != most:
            remedy = " or begin with 0" if key.kind is Kind.VELOCITY else ""
            ends = (amount(Side(key.kind, sign), sign * greatest(limits, key.kind, sign), axis) for sign in (-1.0, 1.0))
            text = sentence("its two values must be opposite{}, got {} and {}", remedy, *ends)
            raise InputError(sentence("limits: {}: {}", key.name, text))
    least = {name: greatest(limits, kind, side * direction) for name, kind, side in _SIDES}
    return MoveLimits(**{name: most for name, most in least.items() if isfinite(most)})


_FREQUENCY = Measured("frequency", above=0.0)


@declared
class VibratingFollower(Declared, title="a follower"):
    """An elastic follower that a move leaves vibrating.

    Examples
    --------
    >>> VibratingFollower(["27 Hz", "33 Hz"], damping=0.05).frequency
    ('27 Hz', '33 Hz')
    """

    frequency: Quantity | Sequence[Quantity] = entry(
        Either(_FREQUENCY, Listed(_FREQUENCY, least=2, most=2), which=is_list),
        "Its natural frequency, or the least and the greatest.",
        example=["27 Hz", "33 Hz"],
    )
    damping: float = entry(Number(least=0.0), "Its damping ratio.", default=0.0, example=0.05)


def read_follower(follower: VibratingFollower | Mapping[str, Any]) -> FollowerResidual:
    """The residual acceleration of a follower in SI units, its limit 1.

    Raises
    ------
    InputError
        If an entry is unknown, missing or wrong.

    Examples
    --------
    >>> known = read_follower({"frequency": ("10 Hz", "12 Hz"), "damping": 0.05})
    >>> round(known.lowest, 6), round(known.highest, 6), known.most
    (62.831853, 75.398224, 1.0)
    """
    read = ValueOf(VibratingFollower).read(follower, "follower")
    pair = read.frequency if isinstance(read.frequency, tuple) else (read.frequency, read.frequency)
    low, high = (tau * quantity(each, "frequency", "follower: frequency") for each in pair)
    return FollowerResidual(low, high, read.damping, 1.0)


def motor_torque(drive: Drive, start: NumberOrQuantity, stroke: NumberOrQuantity, limits: Limits) -> MotorTorque:
    """The torque at the motor over a stroke of the mechanism's input, and its limit.

    Raises
    ------
    InputError
        If the stroke leaves the range of the mechanism, the motor's curve is not concave, nothing limits the torque, or
        the load alone is above the limit.

    Examples
    --------
    >>> from optlaws import Mechanism, Motor
    >>> drive = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2", peak_torque="4 N m"), ratio=20)
    >>> torque = motor_torque(drive, "0 deg", "45 deg", {Kind.RMS_FORCE: (-2.0, 2.0)})
    >>> torque.inertia, torque.friction, torque.load, torque.peak, torque.rms
    ('1.15', 0.0, '0.0', 4.0, 2.0)
    """

    def total(number: float, formula: str) -> str:
        try:
            return repr(number + float(formula))
        except ValueError:
            return f"{number!r} + {formula}" if number else formula

    lines = curve_lines(drive.motor)
    greatest = min(drive.motor.peak_torque, max((torque for _, torque in drive.motor.curve), default=inf))
    within = tightest(limits, {Kind.FORCE: (-greatest, greatest)})
    known = (("torque", Kind.FORCE), ("rms torque", Kind.RMS_FORCE))
    most = {name: within[kind][1] for name, kind in known if kind in within and isfinite(within[kind][1])}
    if not most:
        raise InputError('nothing limits the torque: give limits={"torque": "3 N m"}, or a motor with a peak torque')
    moved = drive.dimensionless(start, stroke, 1.0)
    inertia, friction, coulomb = moved.of_motor
    to_load, back = drive.efficiencies
    gear = LossyGear(1.0 / to_load, back, inertia, friction, coulomb) if moved.train.loses else None
    return MotorTorque(
        moved.inertia if gear else total(inertia, moved.inertia),
        float(moved.friction) + (0.0 if gear else friction),
        moved.load if gear else total(coulomb, moved.load),
        moved.unit,
        most.get("torque"),
        most.get("rms torque"),
        gear,
        tuple((torque, -slope * drive.ratio * abs(moved.stroke)) for torque, slope in lines if slope),
    )
