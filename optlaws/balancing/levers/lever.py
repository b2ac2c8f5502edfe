"""The cam-lever mechanism with torsion bars: what swings, and the law of its motion."""

from __future__ import annotations

from collections.abc import Callable
from math import degrees, pi, sqrt
from typing import Any

import numpy as np

from optlaws.balancing.levers.linkage import FourBar
from optlaws.balancing.levers.motion import LeverMotion
from optlaws.balancing.levers.sizing import LEAST_TRANSMISSION, MOST_ROCKER_SWING, Sizing, sized
from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import InSI, Number, SINumber
from optlaws.errors import InputError, SolverFailure
from optlaws.kept import kept_property
from optlaws.laws import PolynomialLaw
from optlaws.numbers import Array

_SWING_SETTLED = 1e-14  # of a swing: a step of Newton's method that is the last
_SWING_RESOLVED = 1e-15  # of a swing: what its last amplitudes leave
_SWING_INTEGRATED = 1e-9  # of a swing: amplitudes that are integrated at first

Function = Callable[[Array], Array]

POINTS = (96, 256, 768)  # of the quadrature: more where fewer do not resolve the motion
MOST = 400  # cosines

_STEPS = 12
_TRIED = 65


def upper_extreme(potential: Function, swing: float, reach: tuple[float, float], guess: float) -> float:
    """The extreme chi01, nearest to a guess, from which the link swings to chi01 - swing at the same potential energy.

    The linkage can move between the deviations `reach`; angles in radians.
    """
    from scipy.optimize import brentq

    def excess(chi: Array) -> Array:
        return potential(chi) - potential(chi - swing)

    low, high = max(0.0, reach[0] + swing), min(swing, reach[1])
    tried = np.linspace(low, max(low, high), _TRIED)
    values = excess(tried)
    crossings = np.flatnonzero((values[:-1] < 0.0) & (values[1:] >= 0.0))
    if not len(crossings):
        raise InputError(
            f"no swing of {np.degrees(swing):.6g} deg: the linkage can move from {np.degrees(reach[0]):.6g} to "
            f"{np.degrees(reach[1]):.6g} deg about rest, to its dead points, and the bars do not bring it to rest "
            "twice on so long a way; reduce swing"
        )
    first = crossings[np.argmin(np.abs(tried[crossings] - guess))]
    return float(brentq(lambda chi: float(excess(chi)), tried[first], tried[first + 1], xtol=4e-16, rtol=1e-15))


def swung(
    potential: Function, moment: Callable[[Array], tuple[Array, Array]], chi01: float, swing: float
) -> LeverMotion:
    """The motion between the extremes chi01 and chi01 - swing.

    The time on the way is integrated over the phase of a cosine, which gives the amplitudes; a few steps of Newton's
    method on the equation of motion itself, at as many points as there are amplitudes, take them to rounding. `moment`
    gives M_R with its derivative.
    """
    for points in POINTS:
        amplitudes, frequency = _integrated(potential, chi01, swing, points)
        last = int(np.flatnonzero(np.abs(amplitudes) > _SWING_INTEGRATED * swing)[-1])
        if 4 * last < points:
            break
    count = 16 + 2 * last
    while count <= MOST:
        start = np.zeros(count + 1)
        start[: len(amplitudes)] = amplitudes[: count + 1]
        amplitudes, frequency = _settled(moment, start, frequency, swing)
        if np.abs(amplitudes[-3:]).max() <= _SWING_RESOLVED * swing:
            known = np.flatnonzero(np.abs(amplitudes) > 0.01 * _SWING_RESOLVED * swing)
            return LeverMotion(tuple(amplitudes[: known[-1] + 1].tolist()), float(2.0 * pi / np.sqrt(frequency)))
        count = 3 * count // 2
    raise SolverFailure(
        f"the swing needs more than {MOST} cosines: it nearly comes to rest on its way; reduce swing",
        problem={"chi01": chi01, "swing": swing},
    )


def _integrated(potential: Function, chi01: float, swing: float, points: int) -> tuple[Array, float]:
    """Amplitudes and squared frequency by quadrature over chi = middle + swing/2 cos(phase)."""
    phase = (np.arange(points) + 0.5) * pi / points
    chi = chi01 - swing * np.sin(0.5 * phase) ** 2
    square = 2.0 * (potential(np.array(chi01)) - potential(chi))
    if not square.min() > 0.0:
        raise InputError(
            f"the link does not reach {np.degrees(chi01 - swing):.6g} deg from {np.degrees(chi01):.6g} deg: it comes "
            "to rest on its way, for the moment is not restoring everywhere; reduce swing"
        )
    pace = 0.5 * swing * np.sin(phase) / np.sqrt(square)
    order = np.arange(1, points)
    mean = float(pace.mean())
    share = 2.0 / points * (np.cos(np.multiply.outer(order, phase)) @ pace) / mean
    turned = phase + np.sin(np.multiply.outer(phase, order)) @ (share / order)
    # at higher orders the uneven points alias
    amplitudes = 2.0 / points * (np.cos(np.multiply.outer(np.arange(points // 3), turned)) @ (chi * pace / mean))
    amplitudes[0] *= 0.5
    return amplitudes, mean**-2


def _settled(
    moment: Callable[[Array], tuple[Array, Array]], amplitudes: Array, frequency: float, swing: float
) -> tuple[Array, float]:
    """Newton's method on -w² sum i² a_i cos(i phi) + M_R = 0 at equally spaced phi, and on the swing."""
    count = len(amplitudes)
    order = np.arange(count)
    cosines = np.cos(np.multiply.outer(np.arange(count) * pi / (count - 1), order))
    second = cosines * order**2
    ends = 2.0 * (order % 2)
    jacobian = np.zeros((count + 1, count + 1))
    jacobian[-1, :-1] = ends
    for _ in range(_STEPS):
        value, slope = moment(cosines @ amplitudes)
        curve = second @ amplitudes
        jacobian[:-1, :-1] = slope[:, None] * cosines - frequency * second
        jacobian[:-1, -1] = -curve
        step = np.linalg.solve(jacobian, np.append(value - frequency * curve, ends @ amplitudes - swing))
        amplitudes = amplitudes - step[:-1]
        frequency -= float(step[-1])
        if np.abs(step[:-1]).max() <= _SWING_SETTLED * swing:
            return amplitudes, frequency
    raise SolverFailure(
        "the equation of motion did not settle; reduce swing",
        problem={"chi01": float(amplitudes.sum()), "swing": swing},
    )


_ANGLE_LIMIT = 1e-9  # rad: an angle so far beyond its limit is still within


_ANGLE = InSI("angle")


@declared
class TorsionLever(Declared, title="a torsion lever"):
    """A driven mass that swings between two pre-twisted torsion bars through a four-bar linkage.

    Bar 1, of stiffness c1, holds the cam's rocker, bar 2, of stiffness xi c1, the driven link; they pull against each
    other, which takes up the clearances, and carry the mass from one extreme to the other, which unloads the cam.
    Angles have a unit, "60 deg", or are numbers in radians (`deg` turns degrees into radians); lengths are in units of
    the rocker, moments in units of c1, times in units of sqrt(I / c1).

    Raises
    ------
    InputError
        If a number is out of range, the asymptotic formulas have no solution, or a limit is exceeded.

    Examples
    --------
    >>> lever = TorsionLever(beta=0.75, lam=1, rho=0.15, nu=0.15, swing="60 deg")
    >>> law = lever.law()
    >>> round(law.constants.B.value, 6), round(law.constants.C.value, 6)
    (1.580859, 5.023235)
    >>> round(lever.xi, 6), round(lever.exact.period, 6), round(lever.asymptotic.period, 6)
    (0.537689, 6.100747, 6.091704)
    """

    beta: float = entry(Number(above=0.0), "Length of the driven link.")
    lam: float = entry(Number(above=0.0), "Length of the coupler, lambda.")
    rho: float = entry(
        Number(),
        "Of the pre-twist of bar 1, which is twisted by gamma01 (1 + rho) at rest: what is left at the extreme.",
    )
    nu: float = entry(Number(), "Of that of bar 2, likewise, which is twisted by |chi02| (1 + nu).")
    swing: SINumber = entry(_ANGLE, "Of the driven link, from extreme to extreme.")
    least_transmission: SINumber = entry(
        _ANGLE,
        "The angles between the coupler and both links must stay between this and its supplement; 30 degrees.",
        default=LEAST_TRANSMISSION,
    )
    most_rocker_swing: SINumber = entry(
        _ANGLE, "The rocker must not swing farther; 60 degrees.", default=MOST_ROCKER_SWING
    )

    def _check(self) -> None:
        for name in ("rho", "nu"):
            if getattr(self, name) < 0.0:
                raise InputError(f"{name} must be at least 0, or the bar goes slack, got {getattr(self, name)!r}")
        for name, most in (("swing", pi), ("least_transmission", 0.5 * pi), ("most_rocker_swing", pi)):
            if not 0.0 < getattr(self, name) < most:
                raise InputError(
                    f"{name} must be above 0 and below {degrees(most):g} deg, in radians, got {getattr(self, name)!r}; "
                    'write "60 deg" for 60 degrees'
                )
        n, p = self.n, self.p
        chi02 = self.chi01 - self.swing - p * self.swing**3 / (768.0 * n)
        self._check_limits(chi02, self.chi01, "by eq. (9), (10)")

    def _check_limits(self, chi02: float, chi01: float, where: str) -> None:
        """Refuse a motion from chi02 to chi01, radians, beyond the linkage's limits; `where` is added to the error."""
        ends = f"between {degrees(chi02):.6g} and {degrees(chi01):.6g} deg ({where})"
        low, high = self.linkage.range
        if not low < chi02 < chi01 < high:
            raise InputError(
                f"the linkage passes a dead point {ends}: it can move from {degrees(low):.6g} to {degrees(high):.6g} "
                "deg; reduce swing or change lam"
            )
        least = self.least_transmission
        angles = self.linkage.transmission(chi02, chi01)
        for (smallest, greatest), link in zip(angles, ("rocker", "driven link"), strict=True):
            for angle, beyond, limit in (
                (smallest, least - smallest, least),
                (greatest, greatest - pi + least, pi - least),
            ):
                if beyond > _ANGLE_LIMIT:
                    raise InputError(
                        f"the angle between coupler and {link} is {degrees(angle):.6g} deg {ends}, the limit is "
                        f"{degrees(limit):.6g} deg (least_transmission); reduce swing or change beta or lam"
                    )
        swing = float(np.diff(self.linkage.rocker(np.array([chi02, chi01])))[0])
        if swing - self.most_rocker_swing > _ANGLE_LIMIT:
            raise InputError(
                f"the rocker swings by {degrees(swing):.6g} deg {ends}, the limit is "
                f"{degrees(self.most_rocker_swing):.6g} deg (most_rocker_swing); reduce swing or beta"
            )

    @kept_property
    def linkage(self) -> FourBar:
        """The four-bar linkage between rocker and driven link."""
        return FourBar(self.beta, self.lam)

    @kept_property
    def _sizing(self) -> Sizing:
        return sized(self.linkage, self.rho, self.nu, self.swing)

    @property
    def chi01(self) -> float:
        """The extreme beyond rest by eq. (13), radians."""
        return self._sizing.chi01

    @property
    def gamma01(self) -> float:
        """Deviation of the rocker at chi01 by eq. (12), radians."""
        return self._sizing.gamma01

    @property
    def xi(self) -> float:
        """Stiffness of bar 2 divided by the stiffness of bar 1, eq. (3): the moment is zero at rest."""
        return self._sizing.xi

    @property
    def twists(self) -> tuple[float, float]:
        """Twists of bar 1 and bar 2 at rest, gamma01 (1 + rho) and |chi02| (1 + nu), radians."""
        return self.gamma01 * (1.0 + self.rho), (self.swing - self.chi01) * (1.0 + self.nu)

    @kept_property
    def twists_left(self) -> tuple[float, float]:
        """Least twists of bar 1 and bar 2 on the way, exact, radians; a negative one opens the clearances there.

        Bar 1 has it at chi01, bar 2 at chi02; the asymptotic formulas plan gamma01 rho and |chi02| nu.
        """
        first, second = self.twists
        return first - float(self.linkage.rocker(self.exact.chi01)), second + self.exact.chi02

    @property
    def n(self) -> float:
        """Coefficient of chi in the moment, eq. (5), in units of c1."""
        return self.xi + self.beta**2

    @property
    def q(self) -> float:
        """Coefficient of chi²/2 in the moment, eq. (5), in units of c1."""
        return self.linkage.Q * self.twists[0]

    @property
    def p(self) -> float:
        """Coefficient of chi³/6 in the moment, eq. (5), in units of c1."""
        return self.linkage.P - self.linkage.R * self.twists[0]

    @property
    def T0(self) -> float:
        """Period of small swings, 2 pi / sqrt(n), in units of sqrt(I / c1)."""
        return 2.0 * pi / sqrt(self.n)

    def moment(self, chi: Any) -> Array:
        """Moment M_R of the bars on the driven link against its deviation chi, exact, eq. (2), in units of c1."""
        return self._moment(np.asarray(chi, dtype=np.float64))[0]

    def taylor_moment(self, chi: Any) -> Array:
        """The moment to the third power of chi, eq. (4), in units of c1."""
        chi = np.asarray(chi, dtype=np.float64)
        return np.asarray(chi * (self.n + chi * (self.q / 2.0 + chi * (self.p / 6.0))))

    def potential(self, chi: Any) -> Array:
        """Energy stored in the bars less the energy at rest, in units of c1: the moment's integral from 0 to chi."""
        chi = np.asarray(chi, dtype=np.float64)
        rocker = self.linkage.rocker(chi)
        # xi times the second twist is beta times the first, eq. (3)
        return np.asarray(0.5 * (self.xi * chi**2 + rocker**2) + self.twists[0] * (self.beta * chi - rocker))

    @kept_property
    def exact(self) -> LeverMotion:
        """The swing that satisfies the exact equation of motion (1), (2), to rounding.

        Raises
        ------
        InputError
            If the exact extremes exceed a limit, or the link does not swing so far.
        """
        chi01 = upper_extreme(self.potential, self.swing, self.linkage.range, self.chi01)
        self._check_limits(chi01 - self.swing, chi01, "in the exact motion")
        return swung(self.potential, self._moment, chi01, self.swing)

    @kept_property
    def asymptotic(self) -> LeverMotion:
        """The swing by the asymptotic formulas (7), (8).

        Raises
        ------
        InputError
            If the formulas give no period, or a motion that turns back.
        """
        n, q, p, swing = self.n, self.q, self.p, self.swing
        square = 1.0 + swing**2 * (768.0 * n * p + p**2 * swing**2 - 1280.0 * q**2) / (24576.0 * n**2)
        if square <= 0.0:
            raise InputError(f"eq. (8) gives no period for {self!r}; reduce swing")
        second = q * swing**2 / (48.0 * n)
        amplitudes = (-3.0 * second, 0.5 * swing, second, p * swing**3 / (1536.0 * n))
        return LeverMotion(amplitudes, self.T0 / sqrt(square))

    def law(self) -> PolynomialLaw:
        """The law of the stroke from chi01 to chi02, exact: a = (chi01 - chi)/swing of k = 2t/T.

        The halves before and after rest are unlike; `exact.halves` is the law in units of each half.
        """
        return self.exact.law

    @kept_property
    def errors(self) -> dict[str, float]:
        """The errors of the asymptotic motion: relative errors of T, chi01, chi02, zeta, B1, B3, C1, C3, and max |da|.

        The last is the greatest difference of the displacements of the two `halves`.

        Examples
        --------
        >>> from math import radians
        >>> lever = TorsionLever(beta=0.75, lam=1, rho=0.15, nu=0.15, swing=radians(60))
        >>> round(lever.errors["T"], 6), round(lever.errors["max |da|"], 6)
        (-0.001482, 0.000417)
        """
        names = {"T": "period"} | {name: name for name in ("chi01", "chi02", "zeta", "B1", "B3", "C1", "C3")}
        pairs = {name: [getattr(half, key) for half in (self.asymptotic, self.exact)] for name, key in names.items()}
        off = {name: near / exact - 1.0 for name, (near, exact) in pairs.items()}
        k = np.linspace(0.0, 1.0, 801)
        apart = np.abs(self.asymptotic.halves.a(k) - self.exact.halves.a(k))
        return {**off, "max |da|": float(apart.max())}

    def _moment(self, chi: Array) -> tuple[Array, Array]:
        """The moment and its derivative."""
        first, at = self.twists[0], self.linkage.at(chi)
        # xi times the second twist is beta times the first, eq. (3)
        return (
            np.asarray(self.xi * chi + at.rocker * at.ratio + first * (self.beta - at.ratio)),
            np.asarray(self.xi + at.ratio**2 - (first - at.rocker) * at.slope),
        )
