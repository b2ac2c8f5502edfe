"""The cam of a torsion lever: the rocker's motion as a law to cut, and the torque that is left on the cam's shaft."""

from __future__ import annotations

from math import pi

import numpy as np

from optlaws.balancing.levers.lever import TorsionLever
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.specification.segments import Dwell, Return, Rise
from optlaws.echo import shortened
from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Measured
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import PolynomialLaw
from optlaws.motion.quantities import TURN, Exact, quantity
from optlaws.numbers import Array, NumberOrQuantity, positive
from optlaws.numerics import chebyshev
from optlaws.numerics.branch_and_bound import Extremes, extremes
from optlaws.numerics.interval import Interval
from optlaws.numerics.taylor import Jet, variable
from optlaws.tolerances import ROUNDOFF

_TORQUE_EXTREMES = 1e-8  # torques of a lever's cam

_EDGES = 9


def rocker_law(lever: TorsionLever) -> PolynomialLaw:
    """The law of the cam's rocker over a stroke of a torsion lever, from chi01 to chi02, exact to rounding.

    The driven link swings as its bars would have it; the rocker goes with it through the linkage, and this is what its
    cam is cut for: a = (gamma01 - gamma)/(gamma01 - gamma02) over k = 2t/T.

    Examples
    --------
    >>> from math import radians
    >>> law = rocker_law(TorsionLever(beta=0.75, lam=1, rho=0.15, nu=0.15, swing=radians(60)))
    >>> round(law.constants.B.value, 6), round(law.a(1.0), 12)
    (1.615143, 1.0)
    """
    high, low = (float(lever.linkage.rocker(chi)) for chi in (lever.exact.chi01, lever.exact.chi02))

    def c(x: Array) -> Array:
        half = 0.5 * lever.exact.period
        time = 0.5 * (x + 1.0) * half
        at = lever.linkage.at(lever.exact.chi(time))
        bent = at.ratio * lever.exact.chi(time, 2) + at.slope * lever.exact.chi(time, 1) ** 2
        return np.asarray(-(half**2) / (high - low) * bent)

    return PolynomialLaw(tuple(chebyshev.interpolated(c, "acceleration of the rocker").tolist()))


@declared
class LeverCam(Declared, title="a torsion lever in a machine"):
    """A torsion lever in a machine: bars designed for the cam's speed, and the torque at the cam's shaft.

    At the speed for which the bars are designed they swing the link by themselves, and the cam only keeps the time. At
    another the difference of the inertia is left: (w²/w0² - 1) I chi'', and without bars all of it.

    Raises
    ------
    InputError
        If a quantity is of another dimension or out of its range.

    Examples
    --------
    >>> from math import radians
    >>> lever = TorsionLever(beta=0.75, lam=1, rho=0.15, nu=0.15, swing=radians(60))
    >>> lever_cam = LeverCam(lever, inertia="0.05 kg m^2", stroke="120 deg", speed="150 rpm")
    >>> round(lever_cam.stiffness, 3), round(lever_cam.torque(1.0).peak, 9), round(lever_cam.torque(1.1).peak, 6)
    (26.17, 0.0, 1.23782)
    >>> round(lever_cam.unbalanced(1.0).peak, 6)
    5.89438
    """

    lever: TorsionLever = entry(ValueOf(TorsionLever), "The lever.")
    inertia: NumberOrQuantity = entry(Measured("moment of inertia", above=0.0), "Of what the driven link moves.")
    stroke: NumberOrQuantity = entry(
        Measured("angle", above=0.0), "Angle of the cam in which the link swings from one extreme to the other."
    )
    speed: NumberOrQuantity = entry(
        Measured("angular velocity", above=0.0), "Of the cam, for which the bars are designed."
    )

    def _check(self) -> None:
        self.angle  # noqa: B018 - beyond half a turn it is refused at once

    @kept_property
    def moved(self) -> float:
        """The moment of inertia, kg m²."""
        return quantity(self.inertia, "moment of inertia", "inertia")

    @kept_property
    def angle(self) -> float:
        """The angle of the cam during the stroke, rad."""
        angle = quantity(self.stroke, "angle", "stroke")
        if angle > pi:
            raise InputError(f"stroke must be above 0 and at most 180 deg, got {shortened(self.stroke)}")
        return angle

    @kept_property
    def rate(self) -> float:
        """The cam's angular velocity, rad/s."""
        return quantity(self.speed, "angular velocity", "speed")

    @property
    def stiffness(self) -> float:
        """Stiffness c1 of the first bar, N m/rad; the second one's is `lever.xi` times that."""
        return self.lever.exact.stiffness(2.0 * self.angle / self.rate, self.moved)

    @kept_property
    def cycle(self) -> Cycle:
        """The rocker's motion as a cycle for a cam: swing, dwell, swing back, dwell; both dwells are equally long."""
        exact, linkage = self.lever.exact, self.lever.linkage
        swing = float(linkage.rocker(exact.chi01) - linkage.rocker(exact.chi02))
        turn, rest = Exact(self.angle, "rad"), Exact(0.5 * (TURN - 2.0 * self.angle), "rad")
        law = rocker_law(self.lever)
        rests = [Dwell(rest)] if self.angle < pi else []
        back = Return(Exact(swing, "rad"), turn, law=law)
        return Cycle([Rise(Exact(swing, "rad"), turn, law=law), *rests, back, *rests], speed=Exact(self.rate, "rad/s"))

    def torque(self, speed_ratio: float = 1.0) -> Extremes:
        """The torque at the cam's shaft over the stroke, enclosed, N m; the speed is relative to the design speed.

        The bars balance the inertia at their own speed as the equation of motion has it, which the swing keeps to
        rounding; what is enclosed is the rest.

        Raises
        ------
        InputError
            If the ratio is not above 0.
        """
        return self._inertia_torque(positive(speed_ratio, "speed_ratio") ** 2 - 1.0)

    def unbalanced(self, speed_ratio: float = 1.0) -> Extremes:
        """The torque at the cam's shaft over the stroke without torsion bars, enclosed, N m."""
        return self._inertia_torque(positive(speed_ratio, "speed_ratio") ** 2)

    def at(self, k: Array, speed_ratio: float) -> Array:
        """The torque at k of the stroke: the inertia that the bars do not balance, times the velocity of the link."""
        moment = self.stiffness * self.lever.moment(self._chi(k, 0))
        inertia = self.moved * self.rate**2 * self._chi(k, 2)
        return np.asarray((speed_ratio**2 * inertia + moment) * self._chi(k, 1))

    def _inertia_torque(self, share: float) -> Extremes:
        """A share of the inertia's torque at the bars' own speed."""

        def torque(k: Interval, order: int) -> Jet:
            phase = variable(k, order + 2) * Interval(np.array(pi), np.array(2.0 * ROUNDOFF * pi))
            waves = [(phase * float(i)).waves()[1] * size for i, size in enumerate(self.lever.exact.amplitudes) if i]
            slope = sum(waves[1:], start=waves[0]).slope()
            return slope * slope.slope() * (share * self.moved * self.rate**2 / self.angle**3)

        return extremes(torque, np.linspace(0.0, 1.0, _EDGES), share=_TORQUE_EXTREMES)

    def _chi(self, k: Array, nu: int) -> Array:
        """Derivatives of the link's deviation by the cam's angle."""
        half = 0.5 * self.lever.exact.period
        return self.lever.exact.chi(np.asarray(k) * half, nu) * (half / self.angle) ** nu
