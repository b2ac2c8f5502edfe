"""The fluctuation of energy of a shaft that turns once a cycle: mean power, work above the mean, and its flywheel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from optlaws.cams.forces import CamForces
from optlaws.cycles.cycle import Cycle
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.formulas.tree import table_places
from optlaws.laws.storage import PlainNumbers
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.motion.quantities import TURN, positive_quantity
from optlaws.motion.smooth_parts import RealFunction, SmoothParts
from optlaws.numbers import Array, Quantity, finite
from optlaws.tolerances import VALUE_ROUNDING

_MOST_IRREGULARITY = 2.0


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
        if not 0.0 < spread < _MOST_IRREGULARITY:
            raise InputError(
                f"irregularity must be above 0 and below 2, as a share of the mean speed, got {shortened(irregularity)}"
            )
        return self.energy / (spread * self.speed**2)


def energy_fluctuation(machine: CamForces | Cycle | Mechanism, speed: Quantity | None = None) -> EnergyFluctuation:
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
    if isinstance(machine, Cycle):
        rate = TURN / machine.duration
        edges = machine.smooth_times * rate
        return _of_torque(lambda angle: np.asarray(machine.power(angle / rate)) / rate, edges, rate)
    if not isinstance(machine, Mechanism):
        raise InputError(f"machine must be a CamForces, a Cycle or a Mechanism, got {shortened(machine)}")
    if machine.axis != "angle" or not (machine.over[0] <= 0.0 and machine.over[1] >= TURN):
        raise InputError("machine: the mechanism's input makes no whole turn from 0 to 360 deg")
    if speed is None:
        raise InputError("speed is missing: give that of the mechanism's input, such as speed='60 rpm'")
    known = positive_quantity(speed, "angular velocity", "speed")
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
