"""Optima found another way: HiGHS or Clarabel on points that are exchanged, a linear system, or SLSQP.

Nothing here uses optlaws.synthesis beyond Problem and the terms of its objective. Laws are Chebyshev series in k over
the whole interval, S + k^l (k-1)^l Z with every coefficient of Z free, S by Hermite interpolation.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from math import isfinite
from typing import Any, Literal

import clarabel
import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import NDArray
from scipy.interpolate import BPoly
from scipy.optimize import linprog, minimize
from scipy.sparse import csc_matrix

from optlaws import Problem, Range
from optlaws.synthesis import Maximum, Term
from tests.synthesis.independent import DENSE, UNIT, extremes, polynomial
from tests.synthesis.judge import as_range

Array = NDArray[np.float64]
Terms = tuple[tuple[float, Term], ...]
PEAKS = {"C": 2, "C_plus": 2, "C_minus": 2, "J": 3, "snap": 4, "B": 1}
SIGNS = {"C_plus": (1.0,), "C_minus": (-1.0,)}
NORMS = {"rms_c": 2, "rms_j": 3}


class Undecided(Exception):  # noqa: N818
    """The other solver gave no answer good enough to compare with."""


class Laws:
    """Velocities of the base law and of the free functions, mixed so that accelerations are orthogonal."""

    def __init__(self, start: tuple[float, ...], end: tuple[float, ...], degree: int, *, odd: bool) -> None:
        order = len(start)
        k = Chebyshev([0.5, 0.5], domain=UNIT)
        edge = k * (k - 1)
        spline: Any = BPoly.from_derivatives([0.0, 1.0], [list(start), list(end)])
        nodes = (1.0 - np.cos((np.arange(2 * order + 2) + 0.5) * np.pi / (2 * order + 2))) / 2.0
        base = Chebyshev.fit(nodes, spline(nodes), 2 * order - 1, domain=UNIT)
        shapes = [edge**order * Chebyshev.basis(i, domain=UNIT) for i in range(degree + 1) if i % 2 or not odd]
        raw = [shape.deriv() for shape in shapes]
        values = np.column_stack([one.deriv()(DENSE) for one in raw])
        mixing = np.linalg.inv(np.linalg.qr(values)[1]) * 50.0
        free = [sum((w * one for w, one in zip(column, raw, strict=True)), 0.0 * raw[0]) for column in mixing.T]
        self.order = order
        self.velocities: list[Chebyshev] = [*free, base.deriv()]

    @property
    def free(self) -> int:
        """How many coordinates there are."""
        return len(self.velocities) - 1

    def derivative(self, nu: int) -> list[Chebyshev]:
        """Each function's derivative of order nu; the base law's last."""
        return [velocity.deriv(nu - 1) if nu > 1 else velocity for velocity in self.velocities]

    def row(self, nu: int, k: float) -> Array:
        """Values at one k."""
        return np.array([one(k) for one in self.derivative(nu)])

    def chord(self) -> list[Chebyshev]:
        """(b(1/2) - b) / (1-2k)², right where c(1/2) = 0."""
        k = Chebyshev([0.5, 0.5], domain=UNIT)
        return [(velocity(0.5) - velocity) // (2 * k - 1) ** 2 for velocity in self.velocities]

    def ratio(self) -> list[Chebyshev]:
        """B / (k(1-k))^(l-1) of laws at rest at both ends."""
        k = Chebyshev([0.5, 0.5], domain=UNIT)
        scale = 4.0 ** (self.order - 1)
        return [velocity // (scale * (k * (1 - k)) ** (self.order - 1)) for velocity in self.velocities]

    def norm(self, nu: int) -> Array:
        """Matrix M such that |M (x, 1)| is the RMS."""
        u, weights = np.polynomial.legendre.leggauss(60)
        values = np.column_stack([one((u + 1.0) / 2.0) for one in self.derivative(nu)])
        return np.asarray(np.sqrt(weights / 2.0)[:, None] * values)


@lru_cache(maxsize=64)
def laws(start: tuple[float, ...], end: tuple[float, ...], degree: int, *, odd: bool = False) -> Laws:
    """The laws, kept."""
    return Laws(start, end, degree, odd=odd)


def laws_of(problem: Problem, *, odd: bool = False) -> Laws:
    """Those of a problem, unsymmetric ones too."""
    conditions = problem.conditions
    start, end = (tuple(map(float, side)) for side in (conditions.start, conditions.end))
    return laws(start, end, polynomial(problem).degree, odd=odd)


@dataclass
class Rows:
    """The constraint s f(k) <= variable or number at every k, and the points at which it is held."""

    functions: list[Chebyshev]
    signs: tuple[float, ...]
    variable: int | None
    bound: float
    points: dict[float, Array] = field(default_factory=dict)

    def table(self, size: int) -> tuple[Array, Array]:
        rows, right = [], []
        for sign in self.signs:
            k = self.points[sign]
            values = sign * np.column_stack([function(k) for function in self.functions])
            block = np.zeros((len(k), size))
            block[:, : values.shape[1] - 1] = values[:, :-1]
            if self.variable is not None:
                block[:, self.variable] = -1.0
            rows.append(block)
            right.append(self.bound - values[:, -1])
        return np.vstack(rows), np.concatenate(right)

    def exchange(self, x: Array) -> float:
        """Add the extrema near or beyond the bound; returns the greatest excess, relative."""
        weights = np.append(x[: len(self.functions) - 1], 1.0)
        series = sum((w * f for w, f in zip(weights, self.functions, strict=True)), 0.0 * self.functions[0])
        room = self.bound + (x[self.variable] if self.variable is not None else 0.0)
        roots = np.real(series.deriv().roots()) if len(series.trim(1e-300).coef) > 1 else np.empty(0)
        k = np.concatenate([[0.0, 1.0], roots[(roots > 0.0) & (roots < 1.0)]])
        worst, scale = 0.0, max(1.0, abs(room))
        for sign in self.signs:
            excess = (sign * series(k) - room) / scale
            worst = max(worst, float(excess.max()))
            near = k[excess > -1e-3]
            # the true extrema take the place of points beside them
            old = self.points[sign]
            apart = np.abs(old[:, None] - near).min(axis=1, initial=1.0) > 1e-7
            self.points[sign] = np.concatenate([old[apart], near])
        return worst


class _Program:
    """Cost, rows, equations and norms of a convex problem over coordinates and one variable for each term."""

    def __init__(self, problem: Problem, one: Laws) -> None:
        names = list(_names(problem.objective.terms)) + (["B"] if problem.B is not None else [])
        self.laws = one
        self.places = {name: one.free + i for i, name in enumerate(dict.fromkeys(names))}
        self.size = one.free + len(self.places)
        self.start = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 3 * one.free + 12))
        self.families: list[Rows] = []
        self.fixed: list[tuple[Array, float]] = []
        self.equations: list[tuple[Array, float]] = []
        self.cost = self.sum(problem.objective.terms)
        self.epigraphs(problem.objective.terms)
        self.norms = [(one.norm(NORMS[name]), place) for name, place in self.places.items() if name in NORMS]
        expected = as_range(problem.B)
        placed = expected is not None and (problem.inflexion == 0.5 or (expected.fixed and expected.low > 1.0))
        in_the_middle = problem.boundary is None and placed
        for name in self.places:
            if name in PEAKS:
                # where the peak is in the middle, the chords to it say more than b <= B
                signs = (-1.0,) if name == "B" and in_the_middle else SIGNS.get(name, (1.0, -1.0))
                self.hold(one.derivative(PEAKS[name]), signs, name)
        if expected is not None:
            self.velocity(expected, in_the_middle=in_the_middle)
        if problem.monotone:
            self.hold(one.ratio() if problem.boundary is None else one.derivative(1), (-1.0,))
        for name in ("C", "J"):
            asked = as_range(getattr(problem, name))
            if asked is not None and isfinite(asked.high):
                self.hold(one.derivative(PEAKS[name]), (1.0, -1.0), None, asked.high)

    def unit(self, name: str, weight: float = 1.0) -> Array:
        row = np.zeros(self.size)
        row[self.places[name]] = weight
        return row

    def sum(self, terms: Terms) -> Array:
        return np.asarray(sum(self.unit(repr(term), weight) for weight, term in terms))

    def hold(
        self, functions: list[Chebyshev], signs: tuple[float, ...], name: str | None = None, bound: float = 0.0
    ) -> None:
        place = None if name is None else self.places[name]
        self.families.append(Rows(functions, signs, place, bound, dict.fromkeys(signs, self.start)))

    def epigraphs(self, terms: Terms) -> None:
        for _, term in terms:
            if isinstance(term, Maximum):
                for part in term.parts:
                    self.fixed.append((self.sum(part.terms) - self.unit(repr(term)), 0.0))
                    self.epigraphs(part.terms)

    def velocity(self, expected: Range, *, in_the_middle: bool) -> None:
        if in_the_middle:
            bend, middle = self.laws.row(2, 0.5), self.laws.row(1, 0.5)
            variables = np.zeros(len(self.places))
            if np.abs(bend).max() > 1e-9:
                self.equations.append((np.append(bend[:-1], variables), -bend[-1]))
            self.hold(self.laws.chord(), (-1.0,))
            self.equations.append((np.append(middle[:-1], variables) - self.unit("B"), -middle[-1]))
        if expected.fixed:
            self.equations.append((self.unit("B"), expected.high))
            return
        self.fixed.append((-self.unit("B"), -expected.low))
        if isfinite(expected.high):
            self.fixed.append((self.unit("B"), expected.high))


def _names(terms: Terms) -> Iterator[str]:
    for _, term in terms:
        yield repr(term)
        if isinstance(term, Maximum):
            for part in term.parts:
                yield from _names(part.terms)


def least(problem: Problem, rounds: int = 80, tolerance: float = 1e-10) -> float | None:
    """The least objective of a convex problem; None if no law has its constraints."""
    # a one-sided peak of a law is the other one of its mirror image: the mean of both is no better
    one_sided = any(name in str(problem.minimise) for name in SIGNS)
    program = _Program(problem, laws_of(problem, odd=problem.symmetric and one_sided))
    before = None
    for _ in range(rounds):
        parts = [family.table(program.size) for family in program.families]
        rows = np.vstack([np.empty((0, program.size)), *(a for a, _ in parts), *(a[None] for a, _ in program.fixed)])
        right = np.concatenate([*(h for _, h in parts), [h for _, h in program.fixed]])
        # at an end with a given value nothing is left of a row but rounding
        length = np.linalg.norm(rows, axis=1)
        kept = length > 1e-11
        assert (right[~kept] > -1e-9).all()
        rows, right = rows[kept] / length[kept, None], right[kept] / length[kept]
        x = (_clarabel if program.norms else _highs)(program, rows, right)
        if x is None:
            return None
        worth = float(program.cost @ x)
        worst = max((family.exchange(x) for family in program.families), default=0.0)
        settled = before is not None and abs(worth - before) < 1e-9 * abs(worth)
        if worst <= (1e-8 if settled else 1e-9 if program.norms else tolerance):
            return worth
        before = worth
    raise AssertionError(f"the exchange did not end: {worst:.1e} in {problem}")


def _equations(program: _Program) -> tuple[Array, Array]:
    rows = np.array([a for a, _ in program.equations]).reshape(-1, program.size)
    return rows, np.array([h for _, h in program.equations])


def _highs(program: _Program, rows: Array, right: Array) -> Array | None:
    equations, expected = _equations(program)
    ways: tuple[tuple[Literal["highs", "highs-ipm"], float], ...]
    ways = (("highs", 1e-10), ("highs", 1e-9), ("highs-ipm", 1e-9), ("highs", 1e-8))
    said = ""
    doubts = 0
    for method, tolerance in ways:
        answer = linprog(
            program.cost,
            A_ub=rows,
            b_ub=right,
            A_eq=equations if len(equations) else None,
            b_eq=expected if len(equations) else None,
            bounds=(None, None),
            method=method,
            options={"primal_feasibility_tolerance": tolerance, "dual_feasibility_tolerance": tolerance},
        )
        if answer.status == 0:
            return np.asarray(answer.x, dtype=float)
        doubts += answer.status == 2
        said = answer.message
    if doubts >= 3:
        return None
    raise AssertionError(f"HiGHS gave no answer: {said}")


def _clarabel(program: _Program, rows: Array, right: Array) -> Array | None:
    equations, expected = _equations(program)
    blocks, sides = [equations, rows], [expected, right]
    cones: list[Any] = [clarabel.ZeroConeT(len(expected)), clarabel.NonnegativeConeT(len(right))]
    for matrix, place in program.norms:
        # a cone is one whatever its unit; rows of lengths about 1, as the others have, are solved further
        unit = float(np.linalg.norm(matrix[:, :-1], axis=1).max())
        top = np.zeros((1, program.size))
        top[0, place] = -1.0 / unit
        lower = np.zeros((len(matrix), program.size))
        lower[:, : matrix.shape[1] - 1] = -matrix[:, :-1] / unit
        blocks += [top, lower]
        sides += [np.zeros(1), matrix[:, -1] / unit]
        cones.append(clarabel.SecondOrderConeT(len(matrix) + 1))
    nothing = csc_matrix((program.size, program.size))
    table, side = csc_matrix(np.vstack(blocks)), np.concatenate(sides)
    status = ""
    for tolerance in (1e-12, 1e-10, 1e-9, 1e-8):
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        for name in ("tol_gap_abs", "tol_gap_rel", "tol_feas"):
            setattr(settings, name, tolerance)
            setattr(settings, f"reduced_{name}", 1e-9)
        answer = clarabel.DefaultSolver(nothing, program.cost, table, side, cones, settings).solve()
        status = str(answer.status)
        if status == "PrimalInfeasible":
            return None
        met = abs(answer.obj_val - answer.obj_val_dual) <= 1e-8 * abs(answer.obj_val)
        if status == "Solved" or (tolerance == 1e-8 and met and max(answer.r_prim, answer.r_dual) <= 1e-8):
            return np.array(answer.x)
    raise Undecided(f"Clarabel said {status}")


def rms_by_a_linear_system(problem: Problem, nu: int) -> tuple[float, Chebyshev]:
    """Least RMS of a derivative with b(1/2) = B, or at any B, where no inequality binds; and the velocity found."""
    laws = laws_of(problem)
    matrix = laws.norm(nu)
    gram, pull = matrix[:, :-1].T @ matrix[:, :-1], matrix[:, :-1].T @ matrix[:, -1]
    rows = np.empty((0, laws.free))
    right = np.empty(0)
    if isinstance(problem.B, float):
        middle = laws.row(1, 0.5)
        rows, right = middle[None, :-1], np.array([problem.B - middle[-1]])
    system = np.block([[gram, rows.T], [rows, np.zeros((len(rows),) * 2)]])
    # where a whole family of laws is best, the shortest x
    x = np.linalg.lstsq(system, np.concatenate([-pull, right]), rcond=1e-13)[0][: laws.free]
    series = sum((w * f for w, f in zip(np.append(x, 1.0), laws.velocities, strict=True)), 0.0 * laws.velocities[0])
    return float(np.linalg.norm(matrix @ np.append(x, 1.0))), series


def power_of(b: Chebyshev) -> float:
    """Peak of |b c|."""
    c = b.deriv()
    roots = np.real((b * c).deriv().roots())
    k = np.concatenate([DENSE, roots[(roots > 0.0) & (roots < 1.0)]])
    return float(np.abs(b(k) * c(k)).max())


@dataclass(frozen=True)
class LocalLaw:
    """What SLSQP ended at: the law's true peak power, and by how much it breaks b <= B and b >= 0."""

    power: float
    excess: float


def power_by_slsqp(problem: Problem, start: Array, rounds: int = 6) -> LocalLaw:
    """D over symmetric laws with b(1/2) = B by SLSQP on points that are exchanged."""
    laws = laws_of(problem, odd=True)
    assert isinstance(problem.B, float)
    b0, c0 = laws.derivative(1), laws.derivative(2)
    middle = laws.row(1, 0.5)
    # a particular x, and the directions that leave b(1/2) alone
    x0 = middle[:-1] * ((problem.B - middle[-1]) / (middle[:-1] @ middle[:-1]))
    null = np.linalg.svd(middle[None, :-1])[2][1:].T
    chords, ratios = laws.chord(), laws.ratio()
    points = {name: np.linspace(0.0, 0.5, 60) for name in ("d", "chord", "ratio")}
    y = np.append(start[: null.shape[1]], 0.0)
    law = LocalLaw(np.inf, np.inf)
    for _ in range(rounds):

        def table(functions: list[Chebyshev], k: Array) -> tuple[Array, Array]:
            values = np.column_stack([f(k) for f in functions])
            return values[:, :-1] @ x0 + values[:, -1], values[:, :-1] @ null

        (vb, mb), (vc, mc) = (table(f, points["d"]) for f in (b0, c0))
        vq, mq = table(chords, points["chord"])
        vr, mr = table(ratios, points["ratio"])

        def room(y: Array, vb: Array = vb, mb: Array = mb, vc: Array = vc, mc: Array = mc) -> Array:
            d = (vb + mb @ y[:-1]) * (vc + mc @ y[:-1])
            return np.concatenate([y[-1] - d, y[-1] + d])

        def slope(y: Array, vb: Array = vb, mb: Array = mb, vc: Array = vc, mc: Array = mc) -> Array:
            d = (vb + mb @ y[:-1])[:, None] * mc + (vc + mc @ y[:-1])[:, None] * mb
            ones = np.ones((len(d), 1))
            return np.vstack([np.hstack([-d, ones]), np.hstack([d, ones])])

        linear, offset = mq, vq
        if problem.monotone:
            linear, offset = np.vstack([mq, mr]), np.concatenate([vq, vr])
        wide = np.hstack([linear, np.zeros((len(linear), 1))])
        y[-1] = float(np.abs(room(np.append(y[:-1], 0.0))).max())
        answer = _slsqp(y, room, slope, wide, offset)
        y = answer
        weights = np.append(x0 + null @ y[:-1], 1.0)
        b = sum((w * f for w, f in zip(weights, laws.velocities, strict=True)), 0.0 * laws.velocities[0])
        low, high = extremes(b)
        excess = max(high / problem.B - 1.0, -low if problem.monotone else 0.0)
        power = power_of(b)
        law = LocalLaw(power, excess)
        if excess < 1e-10 and power <= y[-1] * (1.0 + 1e-10):
            break
        for name, series in (
            ("d", b * b.deriv()),
            ("chord", sum((w * f for w, f in zip(weights, chords, strict=True)), 0.0 * chords[0])),
            ("ratio", sum((w * f for w, f in zip(weights, ratios, strict=True)), 0.0 * ratios[0])),
        ):
            roots = np.real(series.deriv().roots())
            points[name] = np.concatenate([points[name], roots[(roots > 0.0) & (roots < 0.5)]])
    return law


def _slsqp(
    start: Array, room: Callable[[Array], Array], slope: Callable[[Array], Array], wide: Array, offset: Array
) -> Array:
    goal = np.zeros(len(start))
    goal[-1] = 1.0
    solve: Any = minimize
    curved: Any = {"type": "ineq", "fun": room, "jac": slope}
    straight: Any = {"type": "ineq", "fun": lambda y: wide @ y + offset, "jac": lambda _: wide}
    answer = solve(
        lambda y: float(y[-1]),
        start,
        jac=lambda _: goal,
        constraints=[curved, straight],
        method="SLSQP",
        options={"maxiter": 300, "ftol": 1e-14},
    )
    return np.asarray(answer.x, dtype=float)


def least_power_of_energies(B: float, cells: int = 200_000) -> float:
    """What no D can be below, at b >= 0 and b(1/2) = B >= b, whatever the law: E = b²/2 has |E'| <= D.

    The stroke is the integral of sqrt(2E); with E(0) = 0 and E <= B²/2 it is at most that of min(Dk, B²/2), and with
    E(1/2) = B²/2 at least that of B²/2 - D |k - 1/2|. Both strokes are monotone in D, and must embrace 1.
    """
    k = (np.arange(cells) + 0.5) / (2 * cells)

    def strokes(D: float) -> tuple[float, float]:
        most = np.minimum(D * k, B * B / 2)
        fewest = np.maximum(B * B / 2 - D * (0.5 - k), 0.0)
        return float(np.sqrt(2 * fewest).mean()), float(np.sqrt(2 * most).mean())

    low, high = 0.1, 200.0
    for _ in range(60):
        D = (low + high) / 2
        fewest, most = strokes(D)
        low, high = (low, D) if fewest <= 1.0 <= most else (D, high)
    return high
