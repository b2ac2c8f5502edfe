"""Computations for the paper on inertial loaders: its formulas, its trapezium, its twelve rows."""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
from scipy.integrate import quad

from optlaws import InputError, MotionLaw, catalogue, savin
from optlaws.balancing import Loader, TrapeziumSubstitute, inertial_loader
from optlaws.results import rows

from ..loader_table import COLUMNS, Row, recomputed
from .computing import Claim, Number, Quantities, computation, entries

_TABLE = "loader_table.toml"
#: laws of which trapezia are close, and those whose acceleration ends with no slope
_SMOOTH_TURN = ("KC00", "KC05", "0307(1,5)", "0317(1,5)", "0312(1,75)")


@cache
def _rows(problems: Path) -> dict[str, Row]:
    spec = entries(problems / _TABLE)
    given = rows(problems / spec["printed"], COLUMNS)
    return {row["code"]: recomputed(row, spec["grid"]) for row in given}


@computation("loader.constant")
def constant(row: str, name: str, problems: Path) -> Number:
    """B, C or D of the loader of a law, exact and as the greatest value at the paper's grid."""
    printed_row = _rows(problems)[row]
    return Number(printed_row.exact[name], printed_row.on_grid[name])


@computation("loader.codes")
def codes(problems: Path) -> Number:
    """The number of coded laws in the table."""
    return Number(float(len(_rows(problems))))


@computation("loader.law")
def law(draw: np.random.Generator) -> Quantities:
    """A symmetric law and its loader at one k before the turn, with peaks and with masses drawn at random."""
    executive: MotionLaw = savin("II", float(draw.uniform(0.0, 5.0)))
    balancing, k = inertial_loader(executive), float(draw.uniform(0.05, 0.45))
    B = executive.peak(1).value
    area, _ = quad(lambda x: np.sqrt(np.maximum(B**2 - executive.b(x) ** 2, 0.0)), 0.0, k, epsabs=1e-13, epsrel=1e-13)
    quantities = {
        "k": k,
        "a_l": balancing.law(k),
        "b_l": balancing.law.b(k),
        "c_l": balancing.law.c(k),
        "d_l": balancing.law.d(k),
    }
    quantities |= {
        "b": executive.b(k),
        "c": executive.c(k),
        "d": executive.d(k),
        "B": B,
        "Y": balancing.Y,
        "area": float(area),
    }
    power = executive.power_peak()
    quantities |= {
        "D": power.value,
        "B_l": balancing.B,
        "C_l": balancing.C,
        "D_l": -abs(balancing.law.d(power.k)),
        "j05": -executive.j(0.5),
    }
    quantities |= {"C": executive.peak(2).value} | _masses(balancing, draw)
    return quantities


def _masses(balancing: Loader, draw: np.random.Generator) -> dict[str, float]:
    mass, stroke, loader_stroke = (float(part) for part in draw.uniform(0.1, 2.0, 3))
    loaded = balancing.mass(executive_mass=mass, executive_stroke=stroke, stroke=loader_stroke)
    return {"m_e": mass, "S_e": stroke, "m_l": loaded, "S_l": loader_stroke}


@computation("loader.trapezium")
def trapezium(part: str, draw: np.random.Generator) -> Quantities:
    """A trapezium and its loader at one k on its ramp, its plateau or its fall."""
    substitute = _trapezium(draw)
    m, n, A, Y = substitute.m, substitute.n, substitute.A, inertial_loader(substitute.law).Y
    low, high = {"ramp": (0.05 * m, 0.6 * m), "plateau": (m, m + n), "fall": (m + n, 0.499)}[part]
    k = float(draw.uniform(low, high))
    B, C = substitute.law.peak(1).value, substitute.law.peak(2).value
    moved = inertial_loader(substitute.law).law
    quantities = {
        "e": substitute.e13,
        "g": substitute.gamma_w,
        "m": m,
        "n": n,
        "L": 0.5 - m - n,
        "A": A,
        "B": B,
        "C": C,
        "Y": Y,
        "k": k,
    }
    quantities |= {
        "b": substitute.law.b(k),
        "c": substitute.law.c(k),
        "b_l": moved.b(k),
        "k1": 0.5 - k,
        "c_k1": substitute.law.c(k),
    }
    quantities |= {
        "b_k1": B - substitute.law.b(k),
        "a_l": moved(k),
        "a_m": moved(m),
        "a_mn": moved(m + n),
        "a_half": moved(0.5),
    }
    return quantities


def _trapezium(draw: np.random.Generator) -> TrapeziumSubstitute:
    while True:
        try:
            substitute = TrapeziumSubstitute(float(draw.uniform(0.5, 0.66)), float(draw.uniform(0.26, 0.4)))
        except InputError:
            continue
        if min(substitute.m, substitute.n, 0.5 - substitute.m - substitute.n) > 0.02:
            return substitute


@computation("loader.growth")
def growth(over: str) -> Claim:
    """The least rise of Y along e13, or the greatest along gamma_w, from one trapezium of a grid to the next."""
    e13, gamma_w = np.linspace(0.56, 0.62, 7), np.linspace(0.27, 0.31, 5)
    Y = np.array([[TrapeziumSubstitute(float(e), float(g)).Y for e in e13] for g in gamma_w])
    if over == "e13":
        return Claim(min(float(after - before) for line in Y for before, after in pairwise(line)), ">=", 0.0)
    return Claim(max(float(after - before) for line in Y.T for before, after in pairwise(line)), "<=", 0.0)


@computation("loader.series")
def series() -> Claim:
    """The greatest relative error of Y by (25), with four terms of the series, over 50 trapezia drawn at random."""
    draw = np.random.default_rng(4)
    balancing = [_trapezium(draw) for _ in range(50)]
    return Claim(
        max(abs(substitute.Y / inertial_loader(substitute.law).Y - 1.0) for substitute in balancing), "<=", 1e-5
    )


@computation("loader.substitute")
def substitute() -> Claim:
    """The greatest relative error of Y by the trapezium that stands for a law of the table, where there is one."""
    errors = []
    for name in (*_SMOOTH_TURN, "K", "Co", "3-4-5 polynomial"):
        try:
            errors.append(
                abs(TrapeziumSubstitute.of(catalogue[name].law).Y / inertial_loader(catalogue[name].law).Y - 1.0)
            )
        except InputError:
            continue
    return Claim(max(errors), "<=", 0.01)


@computation("loader.half_way")
def half_way() -> Claim:
    """The greatest distance of the loader's way at the turn from one half, over the laws of the table."""
    laws = [catalogue[name].law for name in (*_SMOOTH_TURN, "K", "Co", "3-4-5 polynomial")]
    return Claim(max(abs(inertial_loader(law).law(0.5) - 0.5) for law in laws), "<=", 1e-9)


@computation("loader.peak_at_turn")
def peak_at_turn() -> Claim:
    """C of the loader of KC00 by the paper's formula, over the true peak: 1, if the formula were general."""
    balancing = inertial_loader(catalogue["KC00"].law)
    return Claim(balancing.C_at_turn / balancing.C, ">=", 0.99)
