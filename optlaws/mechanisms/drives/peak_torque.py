"""The peak torque that no motion of a drive from rest to rest has less than, by its energy.

Over the position the kinetic energy K = J v²/2 of motor and load changes by K' = T - L, with the torque T and what
load, friction and the losses of the gear take, L. With |T| <= P it is no more than what P gives it from the start on,
nor than what P brakes until the end, whatever the inertia does. Where either falls below 0 the torque P is too little:
so are the mean torques of the work on every part of the stroke from its start or to its end. A motion with no more than
this K takes no less time than 1/v integrates to, so that the least P that allows both is the least peak torque.

The source of the method, for robots along a path: J. E. Bobrow, S. Dubowsky, J. S. Gibson, Time-optimal control of
robotic manipulators along specified paths, Int. J. of Robotics Research 4 (1985) 3-17.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from optlaws.formulas.tree import table_places
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.numbers import Array
from optlaws.tolerances import VALUE_ROUNDING

_CELLS = 2000
_SLOWER = 1e-4  # of the duration: sums over the cells are nearer to the integrals
_TORQUES, _ROUNDS = 33, 5  # that are tried at once, and how often between the two around the least


def least_peak_torque(drive: Drive, start: float, stroke: float, duration: float) -> float:
    """The torque at the motor, N m, that no motion which never turns back has a lower peak than; computed in doubles.

    It is 0 where the inertia vanishes somewhere, as at the dead centres of a crank without one: there the energy
    says nothing of the velocity.

    Parameters
    ----------
    drive
        Whose load does not depend on the time.
    start, stroke, duration
        Of the mechanism's input: rad or m, and s; a stroke below 0 moves backwards.

    Examples
    --------
    >>> from optlaws import Mechanism
    >>> table = Drive.of_input(Mechanism("0.8 kg m^2"))
    >>> round(least_peak_torque(table, 0.0, 1.0, 0.5), 2), round(4 * 0.8 / 0.5**2, 2)
    (12.8, 12.8)
    >>> lifted = Drive.of_input(Mechanism("2 kg", load="19.62 N", axis="length"))
    >>> round(least_peak_torque(lifted, 0.0, 0.3, 60.0), 2)
    19.62
    """
    path = _Path.of(drive, start, stroke)
    inertia = path.turning + path.inertia
    if float(inertia.min()) <= VALUE_ROUNDING * float(inertia.max()):
        return 0.0
    low, high = 0.0, 1.0
    while not path.allows(np.array([high]), duration)[0]:
        low, high = high, 4.0 * high
    for _ in range(_ROUNDS):
        torques = np.linspace(low, high, _TORQUES)
        first = int(np.argmax(np.append(path.allows(torques[:-1], duration), True)))
        low, high = float(torques[max(first - 1, 0)]), float(torques[first])
    return low


class _Path(NamedTuple):
    """A drive along a stroke, all at the motor and in the direction of the stroke, at places along it."""

    places: Array
    load: Array  #: of the mechanism with its dry friction
    inertia: Array  #: of the mechanism
    slope: Array  #: of this inertia over the position
    turning: float  #: inertia before the gear
    viscous: tuple[float, float]  #: friction of motor and mechanism by the velocity
    dry: float  #: friction before the gear
    through: tuple[float, float]  #: how much of the mechanism's torque the motor feels, while it drives and brakes

    @classmethod
    def of(cls, drive: Drive, start: float, stroke: float) -> _Path:
        way, length, ratio = float(np.sign(stroke)), abs(stroke), drive.ratio
        corners = [(x - start) * way for x in table_places(drive.mechanism.load_formula, "x")]
        inside = [s for s in corners if 0.0 < s < length]
        places = np.unique(np.concatenate([np.linspace(0.0, length, _CELLS + 1), inside]))

        def torque(velocity: float, acceleration: float) -> Array:
            taken = drive.mechanism.torque(start + way * places, way * velocity, way * acceleration, way)
            return way * np.asarray(taken) / ratio + 0.0 * places

        load, train = torque(0.0, 0.0), drive.train
        viscous = drive.mechanism.viscous / ratio
        slope = 2.0 * (torque(1.0, 0.0) - load - viscous)
        before = ratio * train.inertia, (ratio * train.viscous, viscous), train.coulomb
        return cls(places, load, torque(0.0, 1.0) - load, slope, *before, (1.0 / train.to_load, train.back))

    def allows(self, torques: Array, duration: float) -> Array:
        """With which greatest torques a motion from rest to rest takes no more than the duration."""
        last = len(self.places) - 1
        energy = np.empty((len(self.places), len(torques)))
        braked = np.zeros_like(energy)
        energy[0] = 0.0
        for i in range(last):
            energy[i + 1] = self._next(energy[i], i, i + 1, torques)
        for i in range(last, 0, -1):
            braked[i - 1] = self._next(braked[i], i, i - 1, -torques)
        energy = np.minimum(energy, braked)
        possible = np.asarray((energy[1:-1] > 0.0).all(axis=0))
        whole = self.turning + self.inertia
        least = np.minimum(whole[1:], whole[:-1])
        roots = np.sqrt(np.maximum(energy, 0.0))
        with np.errstate(divide="ignore"):
            times = (np.diff(self.places) * np.sqrt(2.0 * least))[:, None] / (roots[1:] + roots[:-1])
        return np.asarray(possible & (times.sum(axis=0) <= duration * (1.0 + _SLOWER)))

    def _next(self, energy: Array, i: int, other: int, torques: Array) -> Array:
        """The energy at a neighbouring place by Heun's method; the torques are below 0 where the stroke is braked."""
        step = self.places[other] - self.places[i]
        first = self._change(energy, i, torques)
        return np.asarray(energy + 0.5 * step * (first + self._change(energy + step * first, other, torques)))

    def _change(self, energy: Array, i: int, torques: Array) -> Array:
        """The greatest, or of braking the least, change of the energy over the position with a torque."""
        whole = self.turning + self.inertia[i]
        square = 2.0 * np.maximum(energy, 0.0) / whole
        speed, turned = np.sqrt(square), 0.5 * self.slope[i] * square
        taken = self.load[i] + turned + self.viscous[1] * speed
        left = torques - self.dry - self.viscous[0] * speed
        # the gear takes the greater of both, whichever way the power flows
        ahead = [(left - share * taken) / (self.turning + share * self.inertia[i]) for share in self.through]
        return np.asarray(whole * np.minimum(*ahead) + turned)
