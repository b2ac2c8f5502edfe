"""Polydyne laws: the cam with which an elastic follower's mass executes a given law (1.27), and back (1.25)."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws import MotionLaw, PolynomialLaw
from optlaws.laws.law import motion_law
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.numbers import Array, not_negative, positive
from optlaws.numerics import chebyshev
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
    >>> from optlaws import savin
    >>> from optlaws import Follower
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
    frequency
        Frequency nu of the follower.
    damping
        Ratio zeta = n/nu.

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
        for k, value in zip((0.0, 1.0), law([0.0, 1.0], order).tolist(), strict=True):
            size = _size(law, order)
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


def _size(law: MotionLaw, nu: int) -> float:
    size = np.abs(law(np.linspace(0.0, 1.0, 33), nu))
    return max(1.0, float(size[np.isfinite(size)].max(initial=0.0)))
