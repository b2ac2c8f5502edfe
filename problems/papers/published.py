"""Computations for what manuals, help pages and papers beside the five print of standard laws."""

from __future__ import annotations

from functools import cache
from math import pi
from statistics import median

import numpy as np

from optlaws import InputError, MotionLaw, PiecewiseLaw, catalogue, scca
from optlaws.laws import from_half
from optlaws.laws.segments import HarmonicSegment, PolynomialSegment, Segment
from optlaws.results import unknown_key

from .computing import Claim, Number, Quantities, computation

#: the profiles from dwell to dwell of a controller's library, by its names, as laws of the catalogue
PROFILES = {
    "PARABOLA": "constant acceleration",
    "BASIC_SINE": "simple harmonic",
    "POLY_3": "cubic",
    "POLY_5": "3-4-5 polynomial",
    "POLY_7": "4-5-6-7 polynomial",
    "INCLINED_SINE": "cycloidal",
    "MOD_ACCEL_TRAPEZOID": "modified trapezoid",
    "MOD_SINE": "modified sine",
}
_PLACES = np.linspace(0.0, 1.0, 1001)
#: so many derivatives are limited
_JERK, _SNAP = 3, 4


# --- constants of the catalogue ---


@computation("published.constant")
def constant(law: str, name: str) -> Number:
    """B, C, D or J of a law of the catalogue."""
    return Number(_peak(catalogue[law].law, name))


@computation("published.constants")
def constants(law: str, draw: np.random.Generator) -> Quantities:  # noqa: ARG001 - nothing is drawn
    """B, C, D and J of a law of the catalogue, for closed forms."""
    return {name: _peak(catalogue[law].law, name) for name in "BCDJ"}


@computation("published.percent_less")
def percent_less(law: str, than: str, name: str) -> Number:
    """By how many percent a constant of a law is less than that of another."""
    return Number(100.0 * (1.0 - _peak(catalogue[law].law, name) / _peak(catalogue[than].law, name)))


def _peak(law: MotionLaw, name: str) -> float:
    return float(getattr(law.constants, name).value)


# --- laws of three harmonics ---


@computation("published.third_harmonic")
def third_harmonic(first: float, second: float) -> Number:
    """The amplitude of sin(6 pi k) that gives the stroke 1, for those of sin(2 pi k) and sin(4 pi k)."""
    return Number(6.0 * pi * (1.0 - first / (2.0 * pi) - second / (4.0 * pi)))


@cache
def triple_harmonic(first: float, second: float) -> PiecewiseLaw:
    """The law c = H1 sin(2 pi k) + H2 sin(4 pi k) + H3 sin(6 pi k) whose H3 gives the stroke 1.

    Examples
    --------
    >>> triple_harmonic(5.1968, 1.769)
    PiecewiseLaw(segments=1, B=1.7184..., C=6.07..., D=5.26..., J=66.2...)
    """
    amplitudes = (first, second, third_harmonic(first, second).exact)
    frequencies = (2.0 * pi, 4.0 * pi, 6.0 * pi)
    return PiecewiseLaw([0.0, 1.0], [HarmonicSegment(amplitudes, frequencies, (0.0, 0.0, 0.0))])


@computation("published.harmonic_stroke")
def harmonic_stroke(first: float, second: float, third: float) -> Claim:
    """How far the stroke that three amplitudes give is from 1: no more than their rounding to three digits."""
    return Claim(abs(first / (2.0 * pi) + second / (4.0 * pi) + third / (6.0 * pi) - 1.0), "<=", 1e-3)


@computation("published.harmonic_ratio")
def harmonic_ratio(first: float, second: float, law: str, name: str) -> Claim:
    """A constant of three harmonics over that of the law they stand for is at least 1."""
    return Claim(_peak(triple_harmonic(first, second), name) / _peak(catalogue[law].law, name), ">=", 1.0)


@computation("published.harmonic_near")
def harmonic_near(first: float, second: float, law: str, name: str, within: float) -> Claim:
    """A constant of three harmonics is that of the law they stand for, within a share of it."""
    ratio = _peak(triple_harmonic(first, second), name) / _peak(catalogue[law].law, name)
    return Claim(abs(ratio - 1.0), "<=", within)


@computation("published.harmonic_displacement")
def harmonic_displacement(first: float, second: float, law: str) -> Claim:
    """The displacement of three harmonics is that of the law they stand for, within a hundredth of the stroke."""
    apart = triple_harmonic(first, second)(_PLACES) - catalogue[law].law(_PLACES)
    return Claim(float(np.abs(apart).max()), "<=", 0.01)


@computation("published.still_harmonics")
def still_harmonics(draw: np.random.Generator) -> Quantities:  # noqa: ARG001 - nothing is drawn
    """The amplitudes, found from its c at three places, of the catalogue's law without jerk at its ends and middle."""
    places = np.array([0.1, 0.2, 0.4])
    sines = np.sin(2.0 * pi * np.outer(places, (1, 2, 3)))
    H1, H2, H3 = np.linalg.solve(sines, catalogue["zero-jerk triple harmonic"].law.c(places))
    return {"H1": float(H1), "H2": float(H2), "H3": float(H3)}


@computation("published.still_jerk")
def still_jerk() -> Claim:
    """The jerk of that law at its ends and in the middle, as a share of its peak."""
    law = catalogue["zero-jerk triple harmonic"].law
    return Claim(float(np.abs(law.j(np.array([0.0, 0.5, 1.0]))).max()) / _peak(law, "J"), "<=", 1e-9)


# --- the curves of a controller's manuals ---


@computation("published.curve")
def curve(law: str, draw: np.random.Generator) -> Quantities:
    """A law of the catalogue at one T of the first half and at the one that mirrors it."""
    T = float(draw.uniform(0.05, 0.45))
    first, second = catalogue[law].law.c(np.array([T, 1.0 - T]))
    return {"T": T, "A": float(first), "A_second": float(second), "Am": _peak(catalogue[law].law, "C")}


@computation("published.distorted_trapezoid")
def distorted_trapezoid(section: int, draw: np.random.Generator) -> Quantities:
    """The modified trapezoid with ramps of any length Ta at one T of a section, and where the fourth section begins."""
    Ta = float(draw.uniform(0.05, 0.2))
    law = scca(2.0 * Ta, 1.0 - 4.0 * Ta, 2.0 * Ta)
    ends = (0.0, Ta, 0.5 - Ta, 0.5 + Ta, 1.0 - Ta, 1.0)
    place = int(section)
    T = float(draw.uniform(ends[place - 1], ends[place]))
    Am = _peak(law, "C")
    braked = next(k for k in law.breaks if law.c(k) < -Am * (1.0 - 1e-9))
    return {"Ta": Ta, "T": T, "A": law.c(T), "Am": Am, "T_IV": braked}


# --- motions at all their limits ---


def limited(lengths: list[float]) -> PiecewiseLaw:
    """A symmetric motion that is at a limit of a derivative everywhere: lengths of its stretches by the order limited.

    Two lengths are those at full acceleration and at full velocity; three begin with the full jerk, four with the full
    snap. Each limit is reached, and stretches of one kind are of one length.

    Examples
    --------
    >>> limited([1.0, 1.0])
    PiecewiseLaw(segments=3, B=1.5, C=4.5, D=6.75, J=inf)
    >>> limited([1.0, 1.0, 1.0])
    PiecewiseLaw(segments=7, B=1.75, C=6.125, D=..., J=42.875)
    """
    *ramps, plateau, coast = lengths
    rise = _rise(ramps)
    whole = 2.0 * (2.0 * sum(length for length, _ in rise) + plateau) + coast
    fall = [(length, segment.backwards(length).scaled(length, -1.0)) for length, segment in rise[::-1]]
    shape = [*rise, (plateau, PolynomialSegment((1.0,))), *fall]
    return from_half([(length / whole, segment) for length, segment in shape])


def _rise(ramps: list[float]) -> list[tuple[float, Segment]]:
    """How the acceleration comes to 1: at full jerk, whose own rise and fall are at full snap if they are given."""
    if not ramps:
        return []
    if len(ramps) == 1:
        return [(ramps[0], PolynomialSegment((0.5, 0.5)))]
    snap, jerk = ramps
    # with the jerk 1 on its plateau: snap/2, then jerk, then snap/2 of acceleration
    full = snap + jerk
    first = [0.0, 0.0, 0.5 * snap / full]
    middle = [0.5 * snap / full, jerk / full]
    last = [1.0 - 0.5 * snap / full, snap / full, -0.5 * snap / full]
    return [
        (length, PolynomialSegment(_chebyshev(powers)))
        for length, powers in ((snap, first), (jerk, middle), (snap, last))
    ]


def _chebyshev(powers: list[float]) -> tuple[float, ...]:
    """Coefficients over [0, 1] in Chebyshev polynomials of those in powers."""
    polynomial = np.polynomial.Polynomial(powers, domain=[0.0, 1.0], window=[0.0, 1.0])
    return tuple(polynomial.convert(kind=np.polynomial.Chebyshev, domain=[0.0, 1.0]).coef.tolist())


@computation("published.time_horizon")
def time_horizon(limits: int, draw: np.random.Generator) -> Quantities:
    """A motion at all its limits, of random lengths, stroke and time: its constants, and the limits in units."""
    law = limited(list(draw.uniform(0.2, 1.0, int(limits))))
    h, T = draw.uniform(0.5, 5.0, 2)
    quantities = {"h": h, "T": T, "one": 1.0, "B": _peak(law, "B"), "C": _peak(law, "C")}
    quantities |= {"v": quantities["B"] * h / T, "a": quantities["C"] * h / T**2}
    if limits >= _JERK:
        quantities |= {"J": _peak(law, "J"), "j": _peak(law, "J") * h / T**3}
    if limits >= _SNAP:
        quantities |= {"S": _snap(law), "s": _snap(law) * h / T**4}
    return {name: float(value) for name, value in quantities.items()}


def _snap(law: PiecewiseLaw) -> float:
    """The peak of the fourth derivative of a motion in which it is constant between the breaks."""
    middles = 0.5 * (np.array(law.breaks[1:]) + np.array(law.breaks[:-1]))
    return float(np.abs(law(middles, 4)).max())


# --- what a controller's library says of its profiles ---


@cache
def _profiles(name: str) -> dict[str, float]:
    return {profile: _peak(catalogue[law].law, name) for profile, law in PROFILES.items()}


def _of_profile(profile: str, name: str) -> float:
    if profile not in PROFILES:
        raise InputError(unknown_key(profile, PROFILES, "profile"))
    return _profiles(name)[profile]


@computation("published.least")
def least(profile: str, name: str, beside: list[str]) -> Claim:
    """A constant of a profile is the least of those beside it."""
    return Claim(_of_profile(profile, name), "<=", min(_of_profile(other, name) for other in beside))


@computation("published.greater")
def greater(profile: str, name: str, than: str) -> Claim:
    """A constant of a profile is greater than that of another."""
    return Claim(_of_profile(profile, name), ">=", _of_profile(than, name))


@computation("published.low")
def low(profile: str, name: str) -> Claim:
    """A constant of a profile is at most the median of all profiles."""
    return Claim(_of_profile(profile, name), "<=", median(_profiles(name).values()))


@computation("published.sine_with_line")
def sine_with_line(share: float, name: str) -> Claim:
    """B, or C, of a sine of which so much is left, the rest being run at full velocity, beside those of the sine."""
    return Claim(_peak(scca(0.0, 0.0, share), name), "<=" if name == "B" else ">=", _of_profile("BASIC_SINE", name))
