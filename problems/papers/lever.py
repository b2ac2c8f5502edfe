"""Computations for the paper on the cam-lever mechanism with torsion bars: its formulas, its tables, its claims."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from itertools import pairwise, product
from math import cos, degrees, hypot, pi, sin, sqrt
from pathlib import Path

import numpy as np
from numpy.polynomial import Chebyshev as Series
from numpy.typing import NDArray
from scipy.optimize import brentq

from optlaws import InputError, deg
from optlaws.balancing import LEAST_TRANSMISSION, MOST_ROCKER_SWING, FourBar, TorsionLever

from .computing import Claim, Number, Quantities, computation, entries

Array = NDArray[np.float64]
_STUDY = "lever_parametric.toml"
_STRONG = (0.5, 1.5, 0.15, 0.15)
_EXTREMES = ("B1", "B3", "C1", "C3")


@cache
def _lever(beta: float, lam: float, rho: float, nu: float, swing: float) -> TorsionLever:
    """A lever, its swing in degrees."""
    return TorsionLever(beta=beta, lam=lam, rho=rho, nu=nu, swing=deg(swing))


@computation("lever.lever")
def lever(draw: np.random.Generator, beta: str = "any", swing: str = "usual") -> Quantities:
    """A lever drawn at random with stiffness and inertia: its linkage, its moment and its motions at one time each.

    n, q and p are the derivatives of the exact moment at rest, from an interpolant.
    """
    lever = _drawn(draw, beta, swing)
    c1, I = (float(part) for part in draw.uniform(0.5, 2.0, 2))
    quantities = {
        "beta": lever.beta,
        "lam": lever.lam,
        "rho": lever.rho,
        "nu": lever.nu,
        "X": lever.swing,
        "xi": lever.xi,
    }
    quantities |= {"alpha": _pivots(lever.linkage), "c1": c1, "I": I, "g01": lever.gamma01, "G": lever.twists[0]}
    quantities |= {name: getattr(lever.linkage, name) for name in "QPSR"}
    moment = Series.interpolate(lever.moment, 26, domain=[-0.3, 0.3])
    quantities |= {name: c1 * float(moment.deriv(i + 1)(0.0)) for i, name in enumerate("nqp")}
    return quantities | _placed(lever, c1, draw) | _exact(lever, c1, I, draw) | _asymptotic(lever, c1, I, draw)


def _drawn(draw: np.random.Generator, beta: str, swing: str) -> TorsionLever:
    low, high = {"any": (0.5, 1.3), "above 1": (1.2, 1.6), "below 1": (0.5, 0.8)}[beta]
    angle = {"usual": (20.0, 30.0) if beta == "above 1" else (30.0, 45.0), "small": (0.9, 1.1)}[swing]
    beta_, lam, rho, nu, degrees_ = (
        float(draw.uniform(*ends)) for ends in ((low, high), (1.0, 4.0), (0.05, 0.3), (0.05, 0.3), angle)
    )
    return TorsionLever(beta=beta_, lam=lam, rho=rho, nu=nu, swing=deg(degrees_))


def _pivots(linkage: FourBar) -> float:
    """Distance of the pivots, from the points of the linkage at rest."""
    _, A, _ = _points(linkage, 0.0)
    return hypot(float(A[0]) - cos(linkage.psi0), float(A[1]) - sin(linkage.psi0))


def _points(linkage: FourBar, chi: float) -> tuple[float, Array, Array]:
    """Direction of the coupler, and the points A and B, the pivot of the driven link being the origin."""
    psi, gamma = linkage.psi0 + chi, linkage.psi0 + float(linkage.rocker(chi))
    B = linkage.beta * np.array([np.cos(psi), np.sin(psi)])
    A = np.array([linkage.alpha + np.cos(gamma), np.sin(gamma)])
    return float(np.arctan2(*(A - B)[::-1])), A, B


def _placed(lever: TorsionLever, c1: float, draw: np.random.Generator) -> dict[str, float]:
    chi, small = float(draw.uniform(0.3, 0.9)) * lever.chi01, 0.01
    delta, _, _ = _points(lever.linkage, chi)
    gam = float(lever.linkage.rocker(chi))
    quantities = {
        "chi": chi,
        "M": c1 * float(lever.moment(chi)),
        "gam": gam,
        "psi": lever.linkage.psi0 + chi,
        "delta": delta,
    }
    quantities |= {"gamma": lever.linkage.psi0 + gam, "chi_s": small, "M_s": c1 * float(lever.moment(small))}
    return quantities


def _exact(lever: TorsionLever, c1: float, I: float, draw: np.random.Generator) -> dict[str, float]:
    t = float(draw.uniform(0.05, 0.2)) * lever.exact.period
    chi = float(lever.exact.chi(t))
    return {"chi_t": chi, "chi2_t": float(lever.exact.chi(t, 2)) * c1 / I, "M_t": c1 * float(lever.moment(chi))}


def _asymptotic(lever: TorsionLever, c1: float, I: float, draw: np.random.Generator) -> dict[str, float]:
    motion, unit = lever.asymptotic, (I / c1) ** 0.5
    quantities = {"T": motion.period * unit, "x01": motion.chi01, "x02": motion.chi02, "zeta": motion.zeta}
    quantities |= {"z": cos(2.0 * pi * motion.zeta), "T0": _small_period(lever) * unit}
    t = float(draw.uniform(0.1, 0.4)) * motion.period
    quantities |= {"phi": 2.0 * pi * t / motion.period, "chi_a": float(motion.chi(t))}
    quantities |= {name: getattr(motion, name) for name in _EXTREMES}
    for i, (start, end) in {1: (0.0, motion.zeta), 3: (motion.zeta, 0.5)}.items():
        at = float(draw.uniform(start + 0.02, end - 0.02)) * motion.period
        extreme = motion.chi01 if i == 1 else -motion.chi02
        displacement = 0.5 - float(motion.chi(at)) / (2.0 * extreme)
        low, high = (0.0, 0.5) if i == 1 else (0.5, 1.0)
        k = float(brentq(lambda x, a=displacement: motion.halves.a(x) - a, low, high, xtol=1e-15, rtol=1e-14))
        quantities |= {f"t{i}": at * unit, f"k{i}": k, f"phi{i}": 2.0 * pi * at / motion.period}
        quantities |= {f"{name}_p{i}": float(getattr(motion.halves, name)(k)) for name in "abcd"}
    return quantities


def _small_period(lever: TorsionLever) -> float:
    """Period of a swing too small for its moment to bend, from the exact motion of a lever of the same linkage."""
    stiffness = float(Series.interpolate(lever.moment, 26, domain=[-0.3, 0.3]).deriv()(0.0))
    return 2.0 * pi / sqrt(stiffness)


@computation("lever.coefficient")
def coefficient(name: str, beta: str, lam: str) -> Number:
    """Q, P, S or R of a linkage."""
    return Number(float(getattr(FourBar(float(beta), float(lam or "1")), name)) + 0.0)


@computation("lever.limit")
def limit(name: str) -> Number:
    """A limit of the linkage, degrees: least or greatest transmission angle, rocker's swing; or the angle at rest."""
    at_rest = float(FourBar(0.7, 1.3).at(np.zeros(1)).at_rocker[0])
    angles = {"least": LEAST_TRANSMISSION, "greatest": pi - LEAST_TRANSMISSION, "rocker": MOST_ROCKER_SWING}
    return Number(degrees({**angles, "at rest": at_rest}[name]))


@computation("lever.study")
def study(name: str, place: float, problems: Path) -> Number:
    """An entry of the parametric study: a length or a pre-twist."""
    return Number(float(entries(problems / _STUDY)[name][int(place)]))


@computation("lever.pairs")
def pairs(problems: Path) -> Number:
    """The number of pairs of pre-twists of the parametric study."""
    spec = entries(problems / _STUDY)
    return Number(float(len(spec["rho"]) * len(spec["nu"])))


@cache
def _within_limits(problems: Path, beta: float, swing: float) -> tuple[TorsionLever, ...]:
    spec = entries(problems / _STUDY)
    return tuple(_allowed(beta, swing, spec["lambda"], spec["rho"], spec["nu"]))


@cache
def _some_within_limits(problems: Path, beta: float, swing: float) -> tuple[TorsionLever, ...]:
    """The shortest, a middle and the longest coupler, with the least and the greatest pre-twists."""
    spec = entries(problems / _STUDY)
    lengths, rhos, nus = spec["lambda"], spec["rho"], spec["nu"]
    middle = lengths[len(lengths) // 2]
    return tuple(_allowed(beta, swing, [lengths[0], middle, lengths[-1]], [rhos[0], rhos[-1]], [nus[0], nus[-1]]))


def _allowed(
    beta: float, swing: float, lengths: list[float], rhos: list[float], nus: list[float]
) -> Iterator[TorsionLever]:
    for lam, rho, nu in product(lengths, rhos, nus):
        try:
            yield _lever(beta, lam, rho, nu, swing)
        except InputError:
            continue


@computation("lever.longest_swing")
def longest_swing(problems: Path) -> Number:
    """The longest swing, by 10 degrees, that any lever of the study makes within its limits."""
    betas = entries(problems / _STUDY)["beta"]
    return Number(
        next(swing for swing in range(120, 10, -10) if any(_some_within_limits(problems, b, swing) for b in betas))
    )


@computation("lever.taylor")
def taylor(problems: Path) -> Number:
    """The least accuracy of (4) over the study's levers at the swing they reach, percent of the greatest moment."""
    worst = 0.0
    for beta in entries(problems / _STUDY)["beta"]:
        swings = (swing for swing in range(100, 10, -10) if _some_within_limits(problems, beta, swing))
        for lever in _some_within_limits(problems, beta, next(swings, 20)):
            chi = np.linspace(lever.chi01 - lever.swing, lever.chi01, 41)
            exact = lever.moment(chi)
            worst = max(worst, float(np.abs(lever.taylor_moment(chi) - exact).max() / np.abs(exact).max()))
    return Number(100.0 * (1.0 - worst))


@computation("lever.spread")
def spread(names: list[str], least_lam: float, problems: Path) -> Number:
    """The greatest spread of constants over lambda, rho and nu at beta = 0.5 and a swing of 100 degrees, percent."""
    levers = [lever for lever in _within_limits(problems, 0.5, 100.0) if lever.lam >= least_lam]
    return Number(100.0 * max(_spread([getattr(lever.asymptotic, name) for lever in levers]) for name in names))


def _spread(values: list[float]) -> float:
    return (max(values) - min(values)) / abs(float(np.mean(values)))


def _departure(lever: TorsionLever) -> float:
    """How far the moment departs from its tangent at rest at the ends of the swing, as a share of the tangent."""
    chi = np.array([lever.chi01 - lever.swing, lever.chi01])
    return float(np.abs(lever.moment(chi) / (lever.n * chi) - 1.0).max())


@computation("lever.clearances")
def clearances(problems: Path) -> Claim:
    """The least twist that is left in a bar on its way, radians, over levers of the study."""
    levers = [*_within_limits(problems, 0.5, 60.0)[::7], *_within_limits(problems, 1.5, 30.0)[::7]]
    return Claim(min(min(lever.twists_left) for lever in levers), ">=", 0.0)


@computation("lever.unloaded")
def unloaded() -> Claim:
    """The greatest moment left on the cam in the exact swing, as a share of the bars' greatest moment."""
    lever = _lever(*_STRONG, 90.0)
    t = np.linspace(0.0, 0.5, 101) * lever.exact.period
    moment = lever.moment(lever.exact.chi(t))
    return Claim(float(np.abs(lever.exact.chi(t, 2) + moment).max() / np.abs(moment).max()), "<=", 1e-6)


@computation("lever.nonlinearity")
def nonlinearity() -> Claim:
    """The moment's departure from its tangent at beta = 0.5 and 100 degrees over that at beta = 2 and 25 degrees."""
    below, above = _lever(0.5, 3.0, 0.15, 0.15, 100.0), _lever(2.0, 3.0, 0.15, 0.15, 25.0)
    return Claim(_departure(below) / _departure(above), ">=", 1.0)


@computation("lever.shift")
def shift() -> Claim:
    """The least shift of mid-swing towards the softer side at beta = 0.5 and 2, radians."""
    shifts = []
    for lever in (_lever(0.5, 3.0, 0.15, 0.15, 100.0), _lever(2.0, 3.0, 0.15, 0.15, 25.0)):
        half = 0.5 * lever.swing
        softer = 1.0 if abs(float(lever.moment(half))) < abs(float(lever.moment(-half))) else -1.0
        shifts.append(softer * 0.5 * (lever.exact.chi01 + lever.exact.chi02))
    return Claim(min(shifts), ">=", 0.0)


@computation("lever.parallelogram")
def parallelogram() -> Claim:
    """The departure of the moment from its tangent, and of the extremes from one another, at beta = 1."""
    lever = _lever(1.0, 2.0, 0.15, 0.3, 50.0)
    return Claim(max(_departure(lever), abs(lever.exact.chi01 + lever.exact.chi02)), "<=", 1e-9)


@computation("lever.same_nonlinearity")
def same_nonlinearity(problems: Path) -> Claim:
    """The spread of the departure from the tangent over lambda, rho and nu at beta 0.5 and 60 degrees, beside 0.1."""
    return Claim(_spread([_departure(lever) for lever in _within_limits(problems, 0.5, 60.0)]), "<=", 0.1)


@computation("lever.by_beta_only")
def by_beta_only() -> Claim:
    """The greatest change of Q and S, from derivatives of moment and rocker at rest, between lambda = 1 and 5."""
    pairs = []
    for lam in (1.0, 5.0):
        lever = _lever(0.75, lam, 0.15, 0.15, 40.0)
        moment = Series.interpolate(lever.moment, 26, domain=[-0.3, 0.3])
        rocker = Series.interpolate(lever.linkage.rocker, 26, domain=[-0.3, 0.3])
        pairs.append((float(moment.deriv(2)(0.0)) / lever.twists[0], float(rocker.deriv(3)(0.0)) / 6.0))
    return Claim(max(abs(second / first - 1.0) for first, second in zip(*pairs, strict=True)), "<=", 1e-7)


@computation("lever.period_over_swing")
def period_over_swing() -> Claim:
    """The period at 100 degrees over that at 20, less 1."""
    long, short = (_lever(0.5, 3.0, 0.15, 0.15, swing).exact.period for swing in (100.0, 20.0))
    return Claim(abs(long / short - 1.0), ">=", 0.01)


@computation("lever.actual_swing")
def actual_swing(problems: Path) -> Claim:
    """The greatest difference of chi01 - chi02 by (9) and (10) from the nominal swing, as a share."""
    levers = [lever for swing in (60.0, 100.0) for lever in _within_limits(problems, 0.5, swing)]
    return Claim(max(abs(lever.asymptotic.swing / lever.swing - 1.0) for lever in levers), "<=", 0.02)


@computation("lever.trends")
def trends() -> Claim:
    """The least change, in the paper's sense, of B1, B3, |C1| and |C3| with the swing: at beta 0.5 and at 1.5."""
    changes = []
    for beta, swings, sense in ((0.5, (20.0, 60.0, 100.0), 1.0), (1.5, (15.0, 25.0, 35.0), -1.0)):
        motions = [_lever(beta, 3.0, 0.15, 0.15, swing).exact for swing in swings]
        for before, after in pairwise(motions):
            changes += [sense * (getattr(after, name) - getattr(before, name)) for name in ("B1", "B3")]
            changes += [sense * (abs(getattr(before, name)) - abs(getattr(after, name))) for name in ("C1", "C3")]
    return Claim(min(changes), ">=", 0.0)


@computation("lever.same_constants")
def same_constants(problems: Path) -> Claim:
    """The greatest spread of B1, B3, C1 and C3 over lambda, rho and nu at beta = 0.5 and 60 degrees, as a share."""
    levers = _within_limits(problems, 0.5, 60.0)
    return Claim(max(_spread([getattr(lever.asymptotic, name) for lever in levers]) for name in _EXTREMES), "<=", 0.02)


@computation("lever.nearly_harmonic")
def nearly_harmonic(problems: Path) -> Claim:
    """The greatest departure of T, B and C from the harmonic law's for 0.75 <= beta <= 1.25 up to 60 degrees."""
    worst = 0.0
    for beta, swing in product((0.75, 1.25), (20.0, 40.0, 60.0)):
        for lever in _within_limits(problems, beta, swing):
            motion = lever.asymptotic
            off = [motion.period / lever.T0, *(abs(getattr(motion, name)) / (pi / 2.0) for name in ("B1", "B3"))]
            off += [abs(getattr(motion, name)) / (pi**2 / 2.0) for name in ("C1", "C3")]
            worst = max(worst, *(abs(share - 1.0) for share in off))
    return Claim(worst, "<=", 0.1)


@computation("lever.power")
def power() -> Claim:
    """The greatest difference of d from b times c over both halves."""
    halves = _lever(*_STRONG, 60.0).asymptotic.halves
    k = np.linspace(0.01, 0.99, 99)
    return Claim(float(np.abs(halves.d(k) - halves.b(k) * halves.c(k)).max()), "<=", 1e-9)


@computation("lever.design")
def design() -> Claim:
    """What is left of (3), (12) and (13) for xi, gamma01 and chi01 that are found for given lengths and swing."""
    lever = _lever(*_STRONG, 60.0)
    x, G, S = lever.chi01, lever.twists[0], lever.linkage.S
    left = [lever.xi * (lever.swing - x) * (1.0 + lever.nu) / (lever.beta * G) - 1.0]
    left.append((lever.beta * x + S * x**3) / lever.gamma01 - 1.0)
    right = lever.swing * (768.0 * lever.n - 64.0 * lever.q * lever.swing + lever.p * lever.swing**2)
    left.append(1536.0 * lever.n * x / right - 1.0)
    return Claim(max(abs(part) for part in left), "<=", 1e-9)


@computation("lever.root")
def root() -> Claim:
    """What is left of chi(t) = 0 at the share zeta of the period that the root z of (17) gives, radians."""
    motion = _lever(*_STRONG, 60.0).asymptotic
    return Claim(abs(float(motion.chi(motion.zeta * motion.period))), "<=", 1e-12)
