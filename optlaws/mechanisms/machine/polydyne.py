"""Laws for the driven end: the cam with which a mass executes a law (1.27), its constants, and that of any machine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from itertools import pairwise
from math import sqrt
from typing import Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.laws import MotionLaw, PolynomialLaw
from optlaws.laws.law import motion_law
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.mechanisms.machine.state_space import StateSpace
from optlaws.numbers import Array, not_negative, positive
from optlaws.numerics import chebyshev
from optlaws.synthesis.problem.constants import FUNCTIONALS, MAKERS, CombinedPeak, CombinedPower, Functional
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.tolerances import JUMP


def polydyne(law: MotionLaw, frequency: float, damping: float = 0.0) -> MotionLaw:
    """The cam law whose follower's mass, at rest at first, moves exactly by `law`: a + 2 n b/nu² + c/nu² (1.27).

    A polynomial gives a polynomial, by exact arithmetic. A piecewise law gives a piecewise law: polynomials, sines
    and powers of time stay what they are. Anything else becomes a polynomial, to machine accuracy.

    Parameters
    ----------
    law
        Motion meant for the mass, from rest to rest: b, c and j zero at both ends, j continuous in between.
    frequency
        Frequency nu at which the cam is to run.
    damping
        Ratio zeta = n/nu.

    Raises
    ------
    InputError
        If the law is not smooth enough (the message states which derivative and where), or a number is out of range.

    Examples
    --------
    >>> from optlaws import Follower, savin
    >>> law = savin("III", 7.2)
    >>> cam = polydyne(law, frequency=20, damping=0.05)
    >>> cam.c(0.0), cam.constants.C
    (4.62, Peak(value=5.755781, k=0.772243))
    >>> Follower(frequency=20, damping=0.05).response(cam).dynamic_factor(reference=law)
    1.000000
    >>> polydyne(savin("II", 7.0), frequency=20)
    Traceback (most recent call last):
    optlaws.errors.InputError: the mass law has jerk j(0) = 120, so the velocity of the cam would jump there; ...
    """
    frequency, ratio = positive(frequency, "frequency"), not_negative(damping, "damping")
    law = motion_law(law)
    check_mass_law(law)
    if isinstance(law, PolynomialLaw):
        # what the checks let pass as zero at the start is rounding, and would be a step of the cam
        powers = cam_powers(law.exact_powers(), frequency, ratio)[2:]
        return PolynomialLaw.from_powers([Fraction(law.a0), Fraction(law.b0), *powers])
    once, twice = (float(factor) for factor in cam_factors(frequency, ratio))
    if isinstance(law, PiecewiseLaw):
        places = zip(law.segments, pairwise(law.breaks), strict=True)
        return PiecewiseLaw(
            law.breaks, [segment.plus_derivatives(high - low, once, twice) for segment, (low, high) in places], law.a0
        )

    def c(x: Array) -> Array:
        k = 0.5 * (x + 1.0)
        return law(k, 2) + once * law(k, 3) + twice * law(k, 4)

    return PolynomialLaw(chebyshev.interpolated(c, "acceleration of the cam"), float(law.a(0.0)))


def mass_law(cam: MotionLaw, frequency: float, damping: float = 0.0) -> PolynomialLaw:
    """The polynomial by which the mass moves under a polynomial cam if it starts on it without vibration (1.25).

    It is the particular solution Pk; the mass, at rest at first, follows it where Pk and its velocity start from
    zero. Of a cam of `polydyne` from a polynomial it is that polynomial. With small nu the coefficients of any
    other cam's Pk are huge; `Follower.response` gives its motion without this detour.

    Parameters
    ----------
    cam
        Law of the cam.
    frequency, damping
        As of `polydyne`.

    Raises
    ------
    InputError
        If the law is no polynomial, or a number is out of range.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> back = mass_law(polydyne(smoothstep(4), frequency=20), frequency=20)
    >>> [round(value, 9) for value in back.to_powers()]
    [0.0, 0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0]
    """
    moves = motion_law(cam, "cam")
    if not isinstance(moves, PolynomialLaw):
        raise InputError(
            f"cam must be a PolynomialLaw; Follower(frequency, damping).response(cam) takes any law, "
            f"got {shortened(cam)}"
        )
    frequency, ratio = positive(frequency, "frequency"), not_negative(damping, "damping")
    return PolynomialLaw.from_powers(mass_powers(moves.exact_powers(), frequency, ratio))


def cam_powers(mass: tuple[Fraction, ...], frequency: float, damping: float) -> list[Fraction]:
    """Coefficients q of the cam from Q of the mass, in ascending powers of k, exactly (1.27).

    >>> cam_powers((Fraction(0), Fraction(0), Fraction(1)), 2.0, 0.5)
    [Fraction(1, 2), Fraction(1, 1), Fraction(1, 1)]
    """
    once, twice = cam_factors(frequency, damping)
    Q = [*mass, Fraction(0), Fraction(0)]
    return [Q[i] + (i + 1) * (once * Q[i + 1] + (i + 2) * twice * Q[i + 2]) for i in range(len(mass))]


def mass_powers(cam: tuple[Fraction, ...], frequency: float, damping: float) -> list[Fraction]:
    """Coefficients Q of the mass's particular solution from q of the cam, exactly (1.25)."""
    once, twice = cam_factors(frequency, damping)
    Q = [*cam, Fraction(0), Fraction(0)]
    for i in range(len(cam) - 1, -1, -1):
        Q[i] -= (i + 1) * (once * Q[i + 1] + (i + 2) * twice * Q[i + 2])
    return Q[: len(cam)]


def cam_factors(frequency: float, damping: float) -> tuple[Fraction, Fraction]:
    """Factors 2 n/nu² of b and 1/nu² of c in (1.27), exactly."""
    exact = Fraction(frequency)
    return 2 * Fraction(damping) / exact, 1 / exact**2


_NAMES = {1: ("velocity", "b"), 2: ("acceleration", "c"), 3: ("jerk", "j")}
_REMEDY = (
    "use a law whose b, c and j are zero at both ends, such as smoothstep(4), a member of Savin's family III or IV, "
    "or a solution of order 4"
)


def check_mass_law(law: MotionLaw) -> None:
    """Refuse a mass law whose cam would have to jump in displacement or velocity.

    The cam's displacement holds the mass's b and c, and its velocity c and j; in the rests before and after the motion
    all of them are zero.
    """
    for order, (name, letter) in _NAMES.items():
        cam = "velocity" if order == 3 else "displacement"
        sizes = np.abs(law(np.linspace(0.0, 1.0, 33), order))
        size = max(1.0, float(sizes[np.isfinite(sizes)].max(initial=0.0)))
        for k, value in zip((0.0, 1.0), law([0.0, 1.0], order).tolist(), strict=True):
            if not abs(value) <= JUMP * size:
                raise InputError(
                    f"the mass law has {name} {letter}({k:g}) = {value:.6g}, so the {cam} of the cam would jump there; "
                    f"{_REMEDY}"
                )
        if jumps := law.jumps(order):
            k, height = jumps[0]
            raise InputError(
                f"the mass law has a jump of its {name} {letter} by {height:.6g} at k = {k:.6g}, so the {cam} of the "
                f"cam would jump there; {_REMEDY}"
            )


_BASES = {"B": 1, "C": 2, "C_plus": 2, "C_minus": 2, "D": 1, "J": 3}
_SIGNS = {"C_plus": (1.0,), "C_minus": (-1.0,)}
_ORDER, _JERK_ORDER = 4, 5


@dataclass(frozen=True, repr=False)
class CamPeak(CombinedPeak):
    """Peak of a derivative of the cam law; constructed by `cam_constant`."""

    frequency: float = 1.0
    damping: float = 0.0

    def value(self, law: MotionLaw) -> float:
        lowest, highest = cam_law(law, self.frequency, self.damping).extrema(self.nu)
        return max(sign * extreme.value for sign in self.signs for extreme in (lowest, highest))

    def check(self, space: LawSpace) -> None:
        check_order(self.name, space, _JERK_ORDER if self.nu == _BASES["J"] else _ORDER)

    def curbs(self) -> tuple[tuple[int, float], ...]:
        """The mass's derivative is the response to the cam's, which is at most `gain` times as much in the mean."""
        sides = 2.0 if len(self.signs) == 1 else 1.0
        return ((self.nu, sides * gain(self.frequency, self.damping)),)


@dataclass(frozen=True, repr=False)
class CamPower(CombinedPower):
    """Peak of the power b c of the cam law; constructed by `cam_constant`."""

    frequency: float = 1.0
    damping: float = 0.0

    def value(self, law: MotionLaw) -> float:
        return cam_law(law, self.frequency, self.damping).power_peak().value

    def check(self, space: LawSpace) -> None:
        check_order(self.name, space, _ORDER)

    def curbs(self) -> tuple[tuple[int, float], ...]:
        """A bound of the velocity: from rest to rest b of the cam is at most the root of 2 D k and of 2 D (1-k)."""
        return ((1, gain(self.frequency, self.damping)),)


def cam_constant(name: str, *, frequency: float, damping: float = 0.0) -> Functional:
    """A constant of the cam law with which an elastic follower's mass executes the sought law.

    Parameters
    ----------
    name
        "B", "C", "C_plus", "C_minus", "D" or "J": which constant of the cam.
    frequency, damping
        As of `polydyne`.

    Raises
    ------
    InputError
        If the name is unknown or a number out of range.

    Examples
    --------
    >>> from optlaws import savin
    >>> C_cam = cam_constant("C", frequency=20, damping=0.05)
    >>> C_cam, round(C_cam.value(savin("III", 7.2)), 6)
    (C_cam(frequency=20.0, damping=0.05), 5.755781)
    """
    check_names([name], _BASES, "constant of the cam")
    frequency, ratio = positive(frequency, "frequency"), not_negative(damping, "damping")
    written = f"{name}_cam(frequency={frequency!r}{f', damping={ratio!r}' if ratio else ''})"
    weights = (Fraction(1), *cam_factors(frequency, ratio))
    known = FUNCTIONALS[name]
    if name == "D":
        return CamPower(written, known.reference, convex=False, weights=weights, frequency=frequency, damping=ratio)
    sides: dict[str, Any] = {"nu": _BASES[name], "signs": _SIGNS.get(name, (1.0, -1.0))}
    return CamPeak(written, known.reference, convex=True, weights=weights, frequency=frequency, damping=ratio, **sides)


def cam_law(law: MotionLaw, frequency: float, damping: float) -> MotionLaw:
    """The law of `polydyne`, computed quickly and without checks for a polynomial, whose ends the problem checks."""
    if not isinstance(law, PolynomialLaw):
        return polydyne(law, frequency, damping)
    once, twice = map(float, cam_factors(frequency, damping))
    return PolynomialLaw(_combination(law, (1.0, once, twice)), a0=law.a0, b0=law.b0)


def _combination(law: PolynomialLaw, weights: Sequence[float]) -> Array:
    """The series of the acceleration and its derivatives, weighed."""
    series = np.array(law.acceleration or (0.0,))
    total = weights[0] * series
    for weight in weights[1:]:
        series = chebyshev.derivative(series)
        total[: len(series)] += weight * series
    return total


def gain(frequency: float, damping: float) -> float:
    """The greatest mean of |c| of the mass, in units of the mean of |c| of its cam.

    It is nu² times the integral over the rise of the magnitude of the response to an impulse, which is at most k,
    and exp(-n k)/lambda below critical damping; from critical damping on it has no zero and the whole is at most 1.

    >>> gain(20.0, 0.0), gain(0.5, 0.0), gain(20.0, 1.0)
    (20.0, 0.125, 1.0)
    """
    greatest = 0.5 * frequency**2
    return min(greatest, frequency / sqrt(1.0 - damping**2) if damping < 1.0 else 1.0)


def check_order(name: str, space: LawSpace, order: int) -> None:
    """Refuse laws that do not begin and end smoothly enough for a cam."""
    boundary = space.boundary
    jump = "acceleration" if order > _ORDER else "velocity"
    if boundary.order < order:
        raise InputError(
            f"{name} needs mass laws of order {order} at least, whose cam's {jump} does not jump at the ends; "
            f"the problem has order {boundary.order}"
        )
    if any(boundary.start[1:order]) or any(boundary.end[1:order]):
        raise InputError(
            f"{name} needs mass laws from rest to rest, derivatives 1 to {order - 1} zero at both ends, "
            f"got {shortened(boundary)}"
        )
    if space.continuity < order - 1:
        raise InputError(
            f"{name} needs mass laws whose derivatives up to {order - 1} are continuous at the breaks, so that its "
            f"cam's {jump} does not jump; give a continuity of at least {order - 1}, got {space.continuity}"
        )


for _name in _BASES:
    MAKERS.setdefault(f"{_name}_cam", partial(cam_constant, _name))


_FLAT_OUTPUT_JUMP = 1e-7  # the same of the derivatives from which a machine's input is computed
_FEEDTHROUGH = 1e-9  # of what a coefficient is computed from: less is rounding


def flat_output(machine: StateSpace, output: str | None = None) -> tuple[float, ...]:
    """The weights w0, w1, ... of the law that drives the machine: a = w0 y + w1 y' + w2 y'' + ..., y being the output.

    Parameters
    ----------
    output
        Which output; the first one unless given.

    Raises
    ------
    InputError
        If the output is not flat; the error states why.

    Examples
    --------
    >>> from optlaws import Machine
    >>> flat_output(Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"]))
    (1.0, 0.005, 0.0025)
    """
    place = machine.place(output)
    name = machine.outputs[place]
    A, load, direct = np.array(machine.A), machine.load, machine.direct[place]
    row, column = np.array(machine.C[place]), load[:, 0] + A @ (load[:, 1] + A @ load[:, 2])
    feeds = [direct[2], direct[1] + row @ load[:, 2], direct[0] + row @ (load[:, 1] + A @ load[:, 2])]
    size, fastest = len(A), max(1.0, float(np.abs(machine.dynamics.roots).max()))
    if any(abs(coefficient) > _FEEDTHROUGH * fastest**i for i, coefficient in enumerate(feeds)):
        raise InputError(f"{name!r} is not flat: the law enters it directly, so that it has as many zeros as roots")
    reach, most = row, np.abs(row)
    for order in range(1, size + 1):
        gain, scale = float(reach @ column), float(most @ np.abs(column))
        if abs(gain) > _FEEDTHROUGH * scale and order < size:
            raise InputError(f"{name!r} is not flat: {_zeros(A, column, row)}")
        if order < size:
            reach, most = reach @ A, most @ np.abs(A)
    if abs(gain) <= _FEEDTHROUGH * scale:
        raise InputError(f"{name!r} is not flat: the law does not move it, or a vibration does not show in it")
    return tuple((np.poly(A)[::-1] / gain).tolist())


def driving_law(machine: StateSpace, law: MotionLaw, output: str | None = None) -> PolynomialLaw:
    """The law that drives a machine so that its flat output moves by a given law; `polydyne` for any machine.

    Parameters
    ----------
    law
        The output's law, a polynomial; for a machine of n states its derivatives 1 to n + 1 vanish at both ends.
    output
        Which output; the first one unless given.

    Raises
    ------
    InputError
        If the output is not flat, or the law is no polynomial or not smooth enough at its ends.

    Examples
    --------
    >>> from optlaws import Machine, smoothstep
    >>> machine = Machine([[0, 1], [-400, -2]], [[0], [400]], [[1, 0]], outputs=["position"])
    >>> cam = driving_law(machine, smoothstep(4))
    >>> round(machine.response(cam)["position"](0.3) - smoothstep(4)(0.3), 12)
    0.0
    """
    moves = motion_law(law)
    if not isinstance(moves, PolynomialLaw):
        raise InputError(
            "the output's law must be a polynomial: one whose pieces join does not let the drive be smooth"
        )
    weights = flat_output(machine, output)
    for order in range(1, len(weights) + 1):
        ends = np.abs(moves([0.0, 1.0], order))
        if ends.max() > _FLAT_OUTPUT_JUMP * moves.peak(order).value:
            raise InputError(
                f"the output's law must be of order {len(weights) + 1} at least, its derivatives 1 to {len(weights)} "
                f"zero at both ends, for the driving law not to jump: that of order {order} is {float(ends.max()):.6g}"
            )
    return PolynomialLaw(_combination(moves, weights), a0=weights[0] * moves.a0)


def _zeros(A: Array, column: Array, row: Array) -> str:
    from scipy.linalg import eigvals

    size = len(A)
    pencil = np.block([[A, column[:, None]], [row[None, :], np.zeros((1, 1))]])
    zeros = eigvals(pencil, np.diag([*np.ones(size), 0.0]))
    finite = zeros[np.isfinite(zeros) & (np.abs(zeros) < 1e6 * max(1.0, float(np.linalg.norm(A, 2))))]
    listed = ", ".join(f"{zero.real:.4g}{zero.imag:+.4g}i" if zero.imag else f"{zero.real:.4g}" for zero in finite)
    return (
        f"its transfer function has zeros ({listed}), such as dampers between masses make, so that the law that drives "
        "it would move on after the output has come to rest"
    )
