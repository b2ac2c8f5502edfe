"""Computations for "Synthesis of optimal laws of periodic motion": its construction, its table, its claims."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np

from optlaws import (
    BoundaryConditions,
    Chebyshev,
    MotionLaw,
    PolynomialLaw,
    Powers,
    Problem,
    SavinFamily,
    Solution,
    at_most,
    law_from_z,
    results,
    savin,
    smoothstep,
    synthesize,
)

from ..optimal_table import COLUMNS, Table, on_paper_grid, printed_law
from ..own_search import search as searched
from .computing import Claim, Number, Quantities, computation

_TABLE = "optimal_table.toml"
_CUBIC = 3


@cache
def _table(problems: Path) -> tuple[Table, Mapping[str, Mapping[str, str]]]:
    file = problems / _TABLE
    spec = results.read(file, Table)
    return spec, {row["B"]: row for row in results.rows(file.parent / spec.printed, COLUMNS)}


@cache
def _law(problems: Path, row: str) -> PolynomialLaw:
    spec, rows = _table(problems)
    return printed_law(spec, rows[row])


@cache
def _least_C(B: float, order: int = 4, degree: int = _CUBIC) -> float:
    """The least C at a given B, proven."""
    solution: Solution = synthesize(Problem(B=B, order=order, basis=Chebyshev(degree)))
    return solution.objective


@computation("optimal.constant")
def constant(row: str, name: str, problems: Path) -> Number:
    """B, C or D of the law that a row's Z(k) gives, exact and as the greatest value at the paper's grid."""
    law = _law(problems, row)
    return Number(getattr(law.constants, name).value, on_paper_grid(_table(problems)[0], law)[name])


@computation("optimal.coefficient")
def coefficient(row: str, i: str, problems: Path) -> Number:
    """The coefficient z_i with which c(1/2) = 0 (z0) or b(1/2) = B (the others), the rest being as printed.

    The table gives B to four digits, so that z1 and the later ones are known to 256 * 1e-3 / i only.
    """
    spec, rows = _table(problems)
    line = rows[row]
    place, nu, target = int(i), *((2, 0.0) if i == "0" else (1, float(row)))
    z = line["z"].split()
    changed = [*z[:place], f"{float(z[place]) + 1.0!r}", *z[place + 1 :]]
    at, moved = (printed_law(spec, {**line, "z": " ".join(part)})(0.5, nu) for part in (z, changed))
    return Number(float(z[place]) + (target - at) / (moved - at))


@computation("optimal.smooth_constant")
def smooth_constant(order: int, name: str, steps: int) -> Number:
    """B, C or D of the law k^l a1(k) with l conditions of rest at each end, and its greatest value on a grid."""
    return _seen(smoothstep(int(order)), name, int(steps))


@computation("optimal.family_constant")
def family_constant(B: float, name: str, steps: int) -> Number:
    """A constant of Savin's family II at a given B, and its greatest value on a grid."""
    return _seen(savin("II", B=B), name, int(steps))


def _seen(law: MotionLaw, name: str, steps: int) -> Number:
    k = np.linspace(0.0, 1.0, steps + 1)
    values = {"B": law.b, "C": law.c, "D": law.d}[name](k)
    return Number(getattr(law.constants, name).value, float(np.abs(values).max()))


@computation("optimal.rounded_power")
def rounded_power(order: int, at: float) -> Number:
    """D of the smooth law of an order, and b times c at one k, each rounded to three decimals before."""
    law = smoothstep(int(order))
    return Number(law.constants.D.value, round(law.b(at), 3) * round(law.c(at), 3))


def family_ends() -> tuple[float, float]:
    """The least and the greatest B of Savin's family III."""
    ends = [SavinFamily.of("III").B(float(alpha)).value for alpha in SavinFamily.of("III").range]
    return min(ends), max(ends)


@computation("optimal.family_range")
def family_range(end: str) -> Number:
    """The least or greatest B of Savin's family III."""
    return Number(family_ends()[end == "high"])


def table_ends(problems: Path) -> tuple[float, float]:
    """The least and the greatest B of the printed table's laws, computed from their Z(k)."""
    peaks = [_law(problems, row).constants.B.value for row in _table(problems)[1]]
    return min(peaks), max(peaks)


@computation("optimal.range")
def table_range(end: str, problems: Path) -> Number:
    """The least or greatest B of the printed table's laws."""
    return Number(table_ends(problems)[end == "high"])


@computation("optimal.construction")
def construction(draw: np.random.Generator) -> Quantities:
    """A law with four conditions at each end, drawn at random: what is asked of it, its parts, its values at one k."""
    start, end = draw.uniform(-2.0, 2.0, (2, 4))
    start[0], end[0] = 0.0, 1.0
    z = draw.uniform(-3.0, 3.0, 3)
    k = draw.uniform(0.1, 0.9)
    law = law_from_z(BoundaryConditions(tuple(start), tuple(end)), z)
    plain = law_from_z(BoundaryConditions(tuple(start), tuple(end)), [0.0])
    a0 = np.polynomial.Polynomial(start / [1, 1, 2, 6])
    whole = (np.polynomial.Polynomial(plain.to_powers()) - a0).coef
    a1 = np.polynomial.Polynomial(whole[4:])
    W = np.polynomial.Polynomial((np.polynomial.Polynomial(law.to_powers()) - a0).coef[4:])
    quantities = {"k": k, "l": 4.0, "a": law(k), "b": law.b(k), "c": law.c(k), "j": law.j(k)}
    quantities |= {f"z{i + 1}": float(part) for i, part in enumerate(z)} | {"Z": float(np.polynomial.Polynomial(z)(k))}
    quantities |= {
        "W": W(k),
        "a0": a0(k),
        "a1": a1(k),
        "W_end": W(1.0),
        "W1_end": W.deriv()(1.0),
        "W2_end": W.deriv(2)(1.0),
    }
    quantities |= {f"a0_{i}_end": float(a0.deriv(i)(1.0)) if i else a0(1.0) for i in range(4)}
    names = ("a", "b", "c", "j")
    values = law.boundary_values(4)
    quantities |= {f"{name}_start": values[0][i] for i, name in enumerate(names)}
    quantities |= {f"{name}_end": values[1][i] for i, name in enumerate(names)}
    quantities |= {f"given_{name}_start": start[i] for i, name in enumerate(names)}
    return quantities | {f"given_{name}_end": end[i] for i, name in enumerate(names)}


@computation("optimal.known_law")
def known_law(order: int, draw: np.random.Generator) -> Quantities:
    """A smooth law at one k, and the Z(k) over the law of two conditions that gives it."""
    k = draw.uniform(0.1, 0.9)
    law, base = smoothstep(int(order)), smoothstep(2)
    return {"k": k, "a": law(k), "Z": (law(k) - base(k)) / (k**2 * (k - 1.0) ** 2)}


@computation("optimal.functional")
def functional(draw: np.random.Generator) -> Quantities:
    """A proven optimum: I is its objective, C the peak of its c, and b and c in the middle."""
    B = float(draw.uniform(1.55, 2.4))
    solution = synthesize(Problem(B=B, order=4, basis=Powers(_CUBIC)))
    law = solution.law
    return {
        "I": solution.objective,
        "C": law.peak(2).value,
        "B": B,
        "b_middle": law.b(0.5),
        "one": 1.0,
        "c_middle": 1.0 + law.c(0.5),
    }


@computation("optimal.any_Z")
def any_Z() -> Claim:
    """The worst breach of 2 x 4 conditions by 20 laws with a random Z of degree 12."""
    draw = np.random.default_rng(2)
    conditions = BoundaryConditions((0.0, 0.5, -1.0, 2.0), (1.0, 0.3, 0.7, -2.0))
    target = np.array([conditions.start, conditions.end])
    laws = (law_from_z(conditions, draw.uniform(-1.0, 1.0, 13)) for _ in range(20))
    return Claim(max(float(np.abs(np.array(law.boundary_values(4)) - target).max()) for law in laws), "<=", 1e-9)


@computation("optimal.base_laws")
def base_laws() -> Claim:
    """The greatest distance of the laws with 3, 4 and 5 conditions from the laws over l = 2 with their Z."""
    k = np.linspace(0.0, 1.0, 201)
    worst = 0.0
    for order in (3, 4, 5):
        base, law = smoothstep(2), smoothstep(order)
        left = np.polynomial.Polynomial(law.to_powers()) - np.polynomial.Polynomial(base.to_powers())
        Z, rest = divmod(left, np.polynomial.Polynomial([0, 0, 1, -2, 1]))
        composed = law_from_z(BoundaryConditions.rest(2), Z.coef)
        worst = max(worst, float(np.abs(composed(k) - law(k)).max()), float(np.abs(rest.coef).max()))
    return Claim(worst, "<=", 1e-9)


@computation("optimal.asymmetry")
def asymmetry() -> Claim:
    """|a(k) + a(1-k) - 1| of a law with b(1/2) = B and c(1/2) = 0 and another Z."""
    # an even part of Z with a root of order three in the middle changes neither
    law = law_from_z(BoundaryConditions.rest(4), np.poly1d([0.5] * 4, r=True).coef[::-1] * 500.0)
    k = np.linspace(0.0, 1.0, 201)
    change = max(abs(law.b(0.5) - smoothstep(4).b(0.5)), abs(law.c(0.5)))
    broken = float(np.abs(law(k) + law(1.0 - k) - 1.0).max())
    return Claim(broken if change <= 1e-9 else 0.0, "<=", 1e-9)


@computation("optimal.gain_of_degree")
def gain_of_degree(degree: int, problems: Path) -> Claim:
    """The least share by which a richer Z lowers C over the rows' B, beside 1 %: no gain, if the claim holds."""
    shares = [1.0 - _least_C(float(row), 4, int(degree)) / _least_C(float(row)) for row in _table(problems)[1]]
    return Claim(min(shares), "<=", 0.01)


@computation("optimal.price_of_order")
def price_of_order(B: float, degree: int) -> Claim:
    """C with five conditions over C with four, at one B: the constants grow by a tenth at least, if the claim holds."""
    return Claim(_least_C(B, 5, int(degree)) / _least_C(B, 4, int(degree)), ">=", 1.1)


@computation("optimal.beside_family")
def beside_family(name: str, problems: Path) -> Claim:
    """The greatest C or D of a printed law over that of Savin's law with the same B, where family III has one."""
    shares = []
    for row in _table(problems)[1]:
        for alpha in SavinFamily.of("III").alphas(B=float(row)) if _within_family(float(row)) else ():
            ours, theirs = (getattr(law.constants, name).value for law in (_law(problems, row), savin("III", alpha)))
            shares.append(ours / theirs)
    return Claim(max(shares), "<=", 1.0)


def _within_family(B: float) -> bool:
    low, high = family_ends()
    return low <= B <= high


@computation("optimal.off_optimum")
def off_optimum(row: str, problems: Path) -> Claim:
    """How far C of a row is above the least C of its shape, beside 1 %: it needs a better start, if the claim holds."""
    exact = _law(problems, row).constants.C.value
    return Claim(exact / _least_C(float(row)) - 1.0, ">=", 0.01)


@computation("optimal.least_of_others")
def least_of_others() -> Claim:
    """The greatest gap of laws that are least in B, C or D while the other two are bounded."""
    problems = (
        Problem(order=4, minimise="B", C=at_most(6.0), D=at_most(6.0), basis=Chebyshev(_CUBIC)),
        Problem(order=4, minimise="C", B=at_most(1.9), D=at_most(6.5), basis=Chebyshev(_CUBIC)),
        Problem(order=4, minimise="D", B=at_most(1.9), C=at_most(6.0), basis=Chebyshev(_CUBIC)),
    )
    return Claim(max(synthesize(problem, bound="tight").gap for problem in problems), "<=", 1e-6)


@computation("optimal.from_starts")
def from_starts() -> Claim:
    """The spread of C that a minimiser finds from the paper's usual start and from its start for B = 1.969, there.

    To a tenth: where such a search stops depends on the last digits of its steps.
    """
    starts = {"usual": [1.0, 0.0, 0.0, 0.0], "chosen": [-1110.0, -333.0, -1111.0, 0.0]}
    peaks = [searched(1.969, z, 4)[0].constants.C.value for z in starts.values()]
    return Claim(round(max(peaks) / min(peaks) - 1.0, 1), ">=", 0.01)


@computation("optimal.search")
def search() -> Claim:
    """Gap of the constrained minimum of (10) at B = 1.969."""
    return Claim(synthesize(Problem(B=1.969, order=4, basis=Chebyshev(_CUBIC))).gap, "<=", 1e-8)


@computation("optimal.enough")
def enough(B: float) -> Number:
    """The number of coefficients of Z from which on C is within one percent of its least at degree 41."""
    least = _least_C(B, 4, 41)
    return Number(next(n for n in range(4, 43, 2) if _least_C(B, 4, n - 1) <= 1.01 * least))


@computation("optimal.most_coefficients")
def most_coefficients(problems: Path) -> Number:
    """The greatest number of coefficients of a printed Z."""
    return Number(max(len(row["z"].split()) for row in _table(problems)[1].values()))


@computation("optimal.wider")
def wider(problems: Path) -> Claim:
    """How far the printed laws go beyond the least and the greatest B of family III, at the nearer end."""
    (low, high), (least, greatest) = family_ends(), table_ends(problems)
    return Claim(min(low - least, greatest - high), ">=", 0.0)
