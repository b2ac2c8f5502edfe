"""Forces of a pair of cams without a spring: at each angle one of the two cams presses its follower."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from optlaws.cams.disc import DiscCam
from optlaws.cams.forces import MPA, CamForces, ForceCurve, ProcessByAngle, plain_extremes, roots
from optlaws.kept import kept_property
from optlaws.mechanisms.linkages.mechanism_formulas import LinearForce
from optlaws.numbers import Array
from optlaws.numerics.branch_and_bound import Extremes
from optlaws.numerics.interval import Interval, chosen, middle
from optlaws.numerics.roots import bisect
from optlaws.numerics.taylor import Jet

_OF_CONTACT = ("friction", "width", "materials")
#: angles between edges at which the sign of the force is looked at
_LOOKED_AT = 64
_INSIDE = 1e-9  # of the way between edges: at these the force may jump


@dataclass(frozen=True)
class ReturnForces(CamForces):
    """The forces of the return cam of a pair, whose follower takes what the first one does in the other direction."""

    first: CamForces | None = None

    @property
    def rate(self) -> float:
        """The cam's angular velocity, rad/s."""
        return self._of_first.rate

    @property
    def load(self) -> LinearForce:
        """The inertia, spring and friction that both followers move, in SI units."""
        return self._of_first.load

    @property
    def process_force(self) -> ProcessByAngle:
        """The force of the process on the first follower over the cam's angle."""
        return self._of_first.process_force

    @property
    def _of_first(self) -> CamForces:
        assert self.first is not None  # noqa: S101 - given wherever there is one
        return self.first

    def _taken(self, s: Jet, angle: Array | Interval) -> Jet:
        first = self._of_first
        return -first._taken(first.cam.displacement.jet(angle, s.order), angle)  # noqa: SLF001 - of the same class


@dataclass(frozen=True)
class PairForces(CamForces):
    """The forces of a pair of cams: contact force, torque and pressure at each angle are of the cam that presses.

    Parameters
    ----------
    second
        The return cam, as `conjugate_cam` gives it.

    Examples
    --------
    >>> from optlaws import Cycle, Dwell, Return, Rise, TranslatingRoller, conjugate_cam
    >>> moves = [Rise("40 mm", "120 deg", law="3-4-5"), Dwell("60 deg"), Return(law="3-4-5")]
    >>> cam = DiscCam(Cycle(moves, speed="200 rpm"), prime_radius="80 mm", follower=TranslatingRoller("12 mm"))
    >>> pair = PairForces(cam, drive={"mass": "2 kg"}, second=conjugate_cam(cam, distance="240 mm"))
    >>> [round(each.most, 1) for each in (pair.contact, pair.contact_of_return)], pair.lifts_off
    ([47.1, 46.6], False)
    >>> [[round(float(np.degrees(angle)), 3) for angle in part] for part in pair.pressed_by_return]
    [[60.0, 120.0], [180.0, 270.0]]
    """

    second: DiscCam | None = None

    @kept_property
    def alone(self) -> CamForces:
        """The forces of the first cam, below 0 where the return cam presses."""
        of_contact = {name: getattr(self, name) for name in _OF_CONTACT}
        return CamForces(self.cam, self.speed, self.drive, process=self.process, **of_contact)

    @kept_property
    def on_return(self) -> ReturnForces:
        """The forces of the return cam, below 0 where the first cam presses."""
        assert self.second is not None  # noqa: S101 - a pair has two cams
        return ReturnForces(self.second, **{name: getattr(self, name) for name in _OF_CONTACT}, first=self.alone)

    @kept_property
    def edges(self) -> Array:
        """Angles between which forces are smooth, rad: also where the other cam begins to press."""
        given, places = self.alone.edges, list[float]()
        for low, high in pairwise(given.tolist()):
            inside = _INSIDE * (high - low)
            at = np.linspace(low + inside, high - inside, _LOOKED_AT)
            presses = self._presses(at)
            for i in np.flatnonzero(presses[1:] != presses[:-1]):
                as_before = partial(self._presses_as, presses[i])
                places.append(bisect(as_before, at[i], at[i + 1])[0])
        return np.unique(np.concatenate([given, places]))

    def _presses(self, angle: Any) -> Any:
        """Whether the first cam presses: where the follower has to be pushed along its way."""
        return np.asarray(self.alone.follower_force(angle)) >= 0.0

    def _presses_as(self, presses: Any, angle: float) -> bool:
        return bool(self._presses(angle) == presses)

    @property
    def lifts_off(self) -> bool:
        """Whether a follower leaves both cams: never, as the pair holds it."""
        return False

    @kept_property
    def contact_of_return(self) -> Extremes:
        """Least and greatest contact force of the return cam, 0 where the first one presses, enclosed over the turn."""
        return self._enclosed(self._return_contact)

    @kept_property
    def pressure_of_return(self) -> Extremes:
        """Least and greatest of Hertz's pressure of the return cam, enclosed over the turn."""
        return roots(self._enclosed(self._return_squared_pressure))

    @property
    def curves(self) -> list[ForceCurve]:
        """Those of a cam, and the contact force and pressure of the return cam, 0 where the first one presses."""
        name, contact = "contact force of the return cam", partial(self._given, self._return_contact)
        curves = [*super().curves, ForceCurve(name, contact, self.contact_of_return, "N")]
        if self.width is not None:
            name, pressure = "Hertz's pressure of the return cam", partial(self._root, self._return_squared_pressure)
            curves.append(ForceCurve(name, pressure, self.pressure_of_return, "MPa", MPA))
        return curves

    @property
    def pressed_by_return(self) -> list[tuple[float, float]]:
        """From which angle to which the return cam presses, rad."""
        parts: list[tuple[float, float]] = []
        for (low, high), first in zip(pairwise(self.edges.tolist()), self._pressed_by_first, strict=True):
            if not first:
                parts = [*parts[:-1], (parts[-1][0], high)] if parts and parts[-1][1] == low else [*parts, (low, high)]
        return parts

    def results(self) -> dict[str, Any]:
        """Those of a cam, and the peaks of the return cam."""
        contact = {"return_contact": self.contact_of_return}
        pressure = {} if self.width is None else {"return_pressure": self.pressure_of_return}
        return super().results() | {name: plain_extremes(each) for name, each in (contact | pressure).items()}

    @kept_property
    def _pressed_by_first(self) -> Array:
        middles = 0.5 * (self.edges[1:] + self.edges[:-1])
        return np.asarray(self._presses(middles))

    def _contact_force(self, angle: Array | Interval, order: int) -> Jet:
        return self._of_pressing(self.alone._contact_force, self.on_return._contact_force, angle, order)  # noqa: SLF001

    def _torque(self, angle: Array | Interval, order: int) -> Jet:
        return self._of_pressing(self.alone._torque, self.on_return._torque, angle, order)  # noqa: SLF001

    def _squared_pressure(self, angle: Array | Interval, order: int) -> Jet:
        # of the first cam alone, as the surfaces of the two are not the same
        first = self.alone._squared_pressure  # noqa: SLF001
        return self._of_pressing(first, lambda at, most: first(at, most) * 0.0, angle, order)

    def _return_contact(self, angle: Array | Interval, order: int) -> Jet:
        return self._only_of_return(self.on_return._contact_force, angle, order)  # noqa: SLF001

    def _return_squared_pressure(self, angle: Array | Interval, order: int) -> Jet:
        return self._only_of_return(self.on_return._squared_pressure, angle, order)  # noqa: SLF001

    def _only_of_return(self, function: Any, angle: Array | Interval, order: int) -> Jet:
        return self._of_pressing(lambda at, most: function(at, most) * 0.0, function, angle, order)

    def _of_pressing(self, first: Any, second: Any, angle: Array | Interval, order: int) -> Jet:
        """One function where the first cam presses, the other one where the return cam does."""
        which = np.searchsorted(self.edges[1:-1], self.cam.displacement.within(middle(angle)), side="right")
        pressed = self._pressed_by_first[which]
        both = zip(first(angle, order).terms, second(angle, order).terms, strict=True)
        if isinstance(angle, Interval):
            return Jet([chosen(pressed, *pair) for pair in both])
        return Jet([np.where(pressed, *pair) for pair in both])
