"""Computations for Savin's paper: base laws, four families, the elastic follower, laws that take it into account."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from math import factorial, sqrt
from pathlib import Path

import numpy as np

from optlaws import (
    Follower,
    InputError,
    MotionLaw,
    PolynomialLaw,
    SavinFamily,
    catalogue,
    mass_law,
    multiplied_law,
    polydyne,
    savin,
    smoothstep,
    with_end_velocity,
)

from .computing import Claim, Number, Quantities, computation, entries

_EXPERIMENT = "savin_follower.toml"
_FAMILIES = ("I", "II", "III", "IV")
_SPEEDS = (-10.0, -5.0, 5.0, 10.0)


@computation("savin.base")
def base(u: int, draw: np.random.Generator) -> Quantities:
    """A base law at one k, with the derivatives of its start and its ends."""
    law, k = smoothstep(int(u) + 2), float(draw.uniform(0.1, 0.45))
    ends = {f"{name}_{place}": value for name, place, value in _at_ends(law)}
    quantities = {"k": k, "u": float(u), "a": law(k), "b": law.b(k), "c": law.c(k)} | ends
    return quantities | {"c_middle": law.c(0.5), "H": 2.0 * law.c(0.25) / (0.25 * 0.75) ** int(u) / 0.5}


def _at_ends(law: MotionLaw) -> list[tuple[str, str, float]]:
    values = dict(zip(("start", "end"), law.boundary_values(3), strict=True))
    return [(name, place, values[place][i]) for place in values for i, name in enumerate("abc")]


@computation("savin.H")
def H(u: int) -> Number:
    """H of a base law, from its c at k = 1/4."""
    law, k = smoothstep(int(u) + 2), 0.25
    return Number(round(law.c(k) / (k * (1.0 - k)) ** int(u) / (0.5 - k), 9))


@computation("savin.family")
def family(name: str, draw: np.random.Generator) -> Quantities:
    """A member of a family, alpha drawn from 0.5 to 5, at one k, with the derivatives of its start."""
    family, alpha, k = SavinFamily.of(name), float(draw.uniform(0.5, 5.0)), float(draw.uniform(0.1, 0.45))
    law, origin = family.law(alpha), smoothstep(family.u + 2)
    quantities = {
        "k": k,
        "alpha": alpha,
        "delta": float(family.M) + 1.0 / alpha,
        "a": law(k),
        "b": law.b(k),
        "c": law.c(k),
    }
    quantities |= {"H": float(family.H), "u": float(family.u), "c_base": origin.c(k), "y": law.c(k) / origin.c(k)}
    at_middle = law(0.5, 3) / origin(0.5, 3)
    quantities |= {"y0": at_middle, "a_end": law(1.0)} | {f"a{i}_start": law(0.0, i) for i in range(2, 6)}
    return quantities


@computation("savin.end_velocity")
def end_velocity(draw: np.random.Generator) -> Quantities:
    """A law with an end velocity, made of a member of a family, at one k."""
    law, k, b0 = savin("II", 3.0), float(draw.uniform(0.1, 0.9)), float(draw.uniform(-0.5, 0.8))
    changed = with_end_velocity(law, b0)
    quantities = {"k": k, "b0": b0, "a": law(k), "b": law.b(k), "c": law.c(k)}
    return quantities | {"a_v": changed(k), "b_v": changed.b(k), "c_v": changed.c(k)}


@computation("savin.range")
def alpha_end(name: str, end: str) -> Number:
    """The least or greatest alpha of a family, from the sign of its multiplier."""
    family = SavinFamily.of(name)
    k = np.linspace(0.0, 0.5, 2001)
    shape = k * k - k + float(family.M)  # y = 1 + alpha shape
    return Number(float(-1.0 / shape.max()) if end == "low" else float(-1.0 / shape.min()))


@computation("savin.follower")
def follower(draw: np.random.Generator, family: str = "III") -> Quantities:
    """A follower in physical units under a cam, at one k of its free and forced motion."""
    T, m, kappa = float(draw.uniform(0.05, 0.3)), float(draw.uniform(0.5, 3.0)), float(draw.uniform(2e4, 9e4))
    system = Follower.from_units(mass=m, stiffness=kappa, duration=T, damping=float(draw.uniform(5.0, 60.0)))
    cam, k = savin(family, float(draw.uniform(1.0, 5.0))), float(draw.uniform(0.2, 0.8))
    response, forced = system.response(cam), mass_law(cam, system.frequency, system.damping)
    h = 2.0 * system.n * m / T
    quantities = {"k": k, "T": T, "m": m, "kappa": kappa, "h": h, "nu": system.frequency, "n": system.n, "a": cam(k)}
    quantities |= {f"am{i}": float(response(k, i)) for i in range(3)}
    quantities |= {
        "psi": quantities["am0"],
        "psi1": quantities["am1"] / T,
        "psi2": quantities["am2"] / T**2,
        "gamma": cam(k),
    }
    quantities |= {
        "P": forced(k),
        "P0": forced(0.0),
        "P1": forced.b(0.0),
        "lam": sqrt(system.frequency**2 - system.n**2),
    }
    free = {
        "A": sqrt(quantities["P0"] ** 2 + ((quantities["P1"] + system.n * quantities["P0"]) / quantities["lam"]) ** 2)
    }
    free["beta"] = float(
        np.arctan2(quantities["lam"] * quantities["P0"], quantities["P1"] + system.n * quantities["P0"])
    )
    return quantities | free | _powers("q", cam) | _powers("Q", forced) | _operating(system, T, draw)


def _powers(letter: str, law: PolynomialLaw) -> dict[str, float]:
    powers = law.to_powers()
    return {f"{letter}{i}": powers[i] if i < len(powers) else 0.0 for i in range(14)}


def _operating(system: Follower, T: float, draw: np.random.Generator) -> dict[str, float]:
    n_c = float(draw.uniform(60.0, 300.0))
    phi = 2.0 * np.pi * n_c / 60.0 * T
    return {"n_c": n_c, "phi": float(phi), "T_k": 2.0 * np.pi * T / system.frequency}


@computation("savin.synthesis")
def synthesis(name: str, draw: np.random.Generator) -> Quantities:
    """A family's law meant for the mass, and the cam that makes it: coefficients Q and q, and starts."""
    alpha, nu = float(draw.uniform(1.0, 5.0)), float(draw.uniform(15.0, 25.0))
    n = float(draw.uniform(0.5, 2.0))
    law, family = savin(name, alpha), SavinFamily.of(name)
    cam = polydyne(law, nu, n / nu)
    assert isinstance(cam, PolynomialLaw)
    quantities = {"alpha": alpha, "delta": float(family.M) + 1.0 / alpha, "nu": nu, "n": n}
    return quantities | _powers("Q", law) | _powers("q", cam)


@computation("savin.entry")
def entry(cam: str, name: str, problems: Path) -> Number:
    """A number of the experiment's problem file: nu, or alpha of a cam."""
    spec = entries(problems / _EXPERIMENT)
    if name == "nu":
        return Number(float(spec["frequency"]))
    return Number(float(next(entry for entry in spec["cam"] if entry["name"] == cam)[name]))


@computation("savin.deviation")
def deviation(problems: Path) -> Number:
    """The greatest deviation of the experiment's problem file, percent."""
    return Number(float(max(entries(problems / _EXPERIMENT)["deviations"])))


@computation("savin.bases")
def bases() -> Number:
    """The greatest u whose family the product has, counted from 0."""
    return Number(float(max(SavinFamily.of(name).u for name in _FAMILIES)))


@computation("savin.start")
def start(alpha: float) -> Number:
    """c(0) of family I."""
    return Number(SavinFamily.of("I").law(alpha).c(0.0))


@computation("savin.whole_Q")
def whole_Q(name: str, alpha: float) -> Claim:
    """The greatest distance of a family's coefficients Q_i from whole numbers, with the alpha that is read."""
    powers = savin(name, alpha).to_powers()
    return Claim(max(abs(part - round(part)) for part in powers), "<=", 1e-9)


@computation("savin.dynamic_factor")
def dynamic_factor(deviation: float) -> Number:
    """Dynamic factor of family III's cam without damping at a deviation of the cam's speed, percent.

    nu is inverse to the speed.
    """
    law = savin("III", 7.2)
    at = Follower(20.0 / (1.0 + deviation / 100.0))
    return Number(at.response(polydyne(law, 20.0)).dynamic_factor(reference=law))


@cache
def _off_design(name: str, alpha: float, damping: float) -> tuple[float, ...]:
    law = savin(name, alpha)
    cam = polydyne(law, 20.0, damping)
    at = (Follower(20.0 / (1.0 + speed / 100.0), damping) for speed in _SPEEDS)
    return tuple(follower.response(cam).dynamic_factor(reference=law) for follower in at)


@computation("savin.near_design")
def near_design(damping: float) -> Claim:
    """The greatest change of the dynamic factor within 10 percent of the design speed, families III and IV."""
    factors = (*_off_design("III", 7.2, damping), *_off_design("IV", 11.0, damping))
    return Claim(max(abs(factor - 1.0) for factor in factors), "<=", 0.1)


@computation("savin.left_vibration")
def left_vibration() -> Claim:
    """The greatest free vibration at the end of the rise within 10 percent of the speed, as a share of C, damped."""
    worst = 0.0
    for name, alpha in (("III", 7.2), ("IV", 11.0)):
        law = savin(name, alpha)
        cam = polydyne(law, 20.0, 0.05)
        for speed in _SPEEDS:
            left = Follower(20.0 / (1.0 + speed / 100.0), 0.05).response(cam).residual_acceleration
            worst = max(worst, left / law.constants.C.value)
    return Claim(worst, "<=", 0.01)


@computation("savin.direct_cosine")
def direct_cosine() -> Claim:
    """Least dynamic factor of a cosine law cut directly over the greatest of III and IV corrected, undamped."""
    K = catalogue["simple harmonic"].law
    direct = [Follower(20.0 / (1.0 + s / 100.0)).response(K).dynamic_factor(reference=K) for s in (-10.0, 0.0, 10.0)]
    return Claim(min(direct) / max(*_off_design("III", 7.2, 0.0), *_off_design("IV", 11.0, 0.0)), ">=", 1.2)


@computation("savin.any_law")
def any_law() -> Claim:
    """The greatest distance of the cycloidal law's acceleration from a polynomial of degree 15 that fits it."""
    law, k = catalogue["cycloidal"].law, np.linspace(0.0, 1.0, 400)
    fit = np.polynomial.Chebyshev.fit(k, law.c(k), 15)
    return Claim(float(np.abs(fit(k) - law.c(k)).max()), "<=", 1e-6)


@computation("savin.known_laws")
def known_laws() -> Claim:
    """The greatest distance of c = H k^u (1-k)^u (1/2-k) from the laws of degrees 3, 5, 7 and 9."""
    k, worst = np.linspace(0.0, 1.0, 101), 0.0
    for u in range(4):
        law = smoothstep(u + 2)
        H = 2.0 * factorial(2 * u + 3) / (factorial(u) * factorial(u + 1))
        worst = max(worst, float(np.abs(law.c(k) - H * (k * (1.0 - k)) ** u * (0.5 - k)).max()))
    return Claim(worst, "<=", 1e-9)


@computation("savin.multiplier")
def multiplier() -> Claim:
    """The greatest breach of a(1) = 1 and a symmetric c by a law multiplied by an even positive function."""
    changed = multiplied_law(smoothstep(3), (2, -1, 1))
    k = np.linspace(0.0, 0.5, 51)
    breach = float(np.abs(changed.c(k) + changed.c(1.0 - k)).max())
    return Claim(max(breach, abs(changed(1.0) - 1.0)), "<=", 1e-9)


@computation("savin.centroid")
def centroid() -> Claim:
    """The least shift of the accelerating area towards the start for alpha = 5, and to the middle for -4."""

    def place(law: MotionLaw) -> float:
        k = np.linspace(0.0, 0.5, 2001)
        return float(np.trapezoid(k * law.c(k), k) / np.trapezoid(law.c(k), k))

    shifts = []
    for name in _FAMILIES:
        middle = place(savin(name, 0.0))
        shifts += [middle - place(savin(name, 5.0)), place(savin(name, -4.0)) - middle]
    return Claim(min(shifts), ">=", 0.0)


@computation("savin.chain")
def chain() -> Claim:
    """The greatest distance of each family's last law from the base law of the next."""
    k, worst = np.linspace(0.0, 1.0, 101), 0.0
    for name, after in pairwise((*_FAMILIES, "")):
        family = SavinFamily.of(name)
        last = family.law(float(family.range[0]))
        following = smoothstep(family.u + 3) if not after else SavinFamily.of(after).law(0.0)
        worst = max(worst, float(np.abs(last(k) - following(k)).max()))
    return Claim(worst, "<=", 1e-9)


@computation("savin.choice")
def choice() -> Claim:
    """The greatest distance of B, C or D from what is asked of a member that is chosen by it."""
    off = [abs(savin("II", B=1.7).constants.B.value - 1.7)]
    family = SavinFamily.of("III")
    off += [abs(family.law(alpha).constants.D.value - 7.0) for alpha in family.alphas(D=7.0)]
    off += [abs(family.law(alpha).constants.C.value - 7.0) for alpha in family.alphas(C=7.0)]
    return Claim(max(off), "<=", 1e-8)


@computation("savin.any_end_velocity")
def any_end_velocity() -> Claim:
    """The greatest breach of b = 0.4 at both ends and a(1) = 1 by laws with that end velocity."""
    laws = [with_end_velocity(law, 0.4) for law in (savin("I", 2.0), savin("IV", 8.0), catalogue["cycloidal"].law)]
    breaches = [part for law in laws for part in (law.b(0.0) - 0.4, law.b(1.0) - 0.4, law(1.0) - 1.0)]
    return Claim(max(abs(part) for part in breaches), "<=", 1e-9)


@computation("savin.usable")
def usable() -> Claim:
    """The number of families whose laws the cam of an elastic follower can make without jumps of its own velocity."""

    def is_usable(name: str) -> bool:
        try:
            polydyne(savin(name, 2.0), 20.0)
        except InputError:
            return False
        return True

    return Claim(float([is_usable(name) for name in _FAMILIES] == [False, False, True, True]), ">=", 1.0)


@computation("savin.starts")
def starts() -> Claim:
    """c(0) of the cam of family III over that of family IV, which must be nothing: 1 if III starts with it alone."""
    third, fourth = (polydyne(savin(name, alpha), 20.0).c(0.0) for name, alpha in (("III", 7.2), ("IV", 11.0)))
    return Claim(float(abs(third) > 1.0 and abs(fourth) <= 1e-9), ">=", 1.0)


@computation("savin.no_free_vibration")
def no_free_vibration() -> Claim:
    """The free vibration at the design frequency, as a share of C, families III and IV, damped and not."""
    worst = 0.0
    for name, alpha in (("III", 7.2), ("IV", 11.0)):
        for damping in (0.0, 0.05):
            response = Follower(20.0, damping).response(polydyne(savin(name, alpha), 20.0, damping))
            worst = max(worst, response.residual_acceleration / savin(name, alpha).constants.C.value)
    return Claim(worst, "<=", 1e-9)


@computation("savin.zeros_needed")
def zeros_needed() -> Claim:
    """The greatest of q_0 to q_m for laws with Q_0 to Q_(m+2) = 0, m = 1 and 2."""
    first = polydyne(savin("III", 7.2), 20.0, 0.05)
    second = polydyne(savin("IV", 11.0), 20.0, 0.05)
    assert isinstance(first, PolynomialLaw)
    assert isinstance(second, PolynomialLaw)
    return Claim(max(abs(part) for part in (*first.to_powers()[:2], *second.to_powers()[:3])), "<=", 1e-12)


@computation("savin.steps")
def steps() -> Claim:
    """The greatest distance of the mass from the law meant for it, by the four steps from a machine's numbers."""
    system = Follower.from_speed(speed_rpm=105.0, rise_angle_deg=120.0, natural_period=0.0598, damping=0.05)
    law = savin("III", 7.2)
    cam = polydyne(law, system.frequency, system.damping)
    k = np.linspace(0.0, 1.0, 361)
    return Claim(float(np.abs(system.response(cam)(k) - law(k)).max()), "<=", 1e-9)
