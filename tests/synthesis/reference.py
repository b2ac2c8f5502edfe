"""Optima found another way: HiGHS or Clarabel on points that are exchanged, or a linear system.

Nothing here uses optlaws.synthesis beyond Problem and the terms of its objective; laws are numpy series. On points a
program asks less than everywhere, so its least value is never above the true one; the exchange brings it there.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise, repeat
from math import inf, isfinite, sqrt
from typing import Any, Literal

import clarabel
import numpy as np
from numpy.polynomial import Chebyshev, legendre
from numpy.typing import NDArray
from scipy.optimize import linprog
from scipy.sparse import csc_matrix

from optlaws import Functional, Problem
from optlaws.synthesis import Maximum, Term
from tests.internals.mechanisms import BandResidual, CamPeak
from tests.synthesis.judge import SQUARES, as_range, peak_in_the_middle
from tests.synthesis.numpy_laws import Laws, Undecided, grid, laws_of

Array = NDArray[np.float64]
Terms = Iterable[tuple[float, Term]]
DERIVATIVES = {"B": 1, "C": 2, "C_plus": 2, "C_minus": 2, "J": 3, "snap": 4}
SIGNS = {"C_plus": (1.0,), "C_minus": (-1.0,)}


@dataclass
class Rows:
    """The constraint s f(k) <= variable or number on an interval, and the points of each piece at which it is held."""

    laws: Laws
    functions: Sequence[Array]
    signs: tuple[float, ...]
    variable: int | None
    bound: float
    start: float = 0.0
    stop: float = 1.0
    points: dict[tuple[int, float], Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for piece, (begin, end) in enumerate(pairwise(self.laws.breaks)):
            low, high = max(begin, self.start), min(end, self.stop)
            if low < high or low == high == self.start:
                places = grid(low, high, 2 * len(self.functions[piece]) + 10) if low < high else np.array([low])
                self.points |= {(piece, sign): places for sign in self.signs}

    def table(self, size: int) -> tuple[Array, Array]:
        rows, right = [], []
        for (piece, sign), k in self.points.items():
            values = sign * self.laws.rows(self.functions, piece, k)
            block = np.zeros((len(k), size))
            block[:, : values.shape[1] - 1] = values[:, :-1]
            if self.variable is not None:
                block[:, self.variable] = -1.0
            rows.append(block)
            right.append(self.bound - values[:, -1])
        return np.vstack(rows), np.concatenate(right)

    def exchange(self, x: Array) -> float:
        """Add the extrema near or beyond the bound; returns the greatest excess, relative."""
        weights = np.append(x[: self.laws.free], 1.0)
        room = self.bound + (x[self.variable] if self.variable is not None else 0.0)
        worst = 0.0
        for (piece, sign), old in self.points.items():
            low, high = self.laws.breaks[piece : piece + 2]
            series = Chebyshev(self.functions[piece] @ weights, domain=(low, high))
            slope = series.deriv().trim(1e-13 * float(np.abs(series.coef).max()))
            inner = np.real(slope.roots()) if len(slope.coef) > 1 else np.empty(0)
            first, last = max(low, self.start), min(high, self.stop)
            k = np.concatenate([[first, last], inner[(inner > first) & (inner < last)]])
            excess = (sign * series(k) - room) / max(1.0, abs(room))
            worst = max(worst, float(excess.max()))
            near = k[excess > -1e-3]
            apart = np.abs(old[:, None] - near).min(axis=1, initial=1.0) > 1e-7
            self.points[piece, sign] = np.concatenate([old[apart], near])
        return worst


class Program:
    """Cost, rows, equations and cones of a problem over coordinates and one variable for each term."""

    def __init__(self, problem: Problem, laws: Laws) -> None:
        self.problem, self.laws = problem, laws
        names = dict.fromkeys(["peak velocity", *_names(problem.objective.terms)])
        self.places = {name: self.laws.free + i for i, name in enumerate(names)}
        self.size = self.laws.free + len(names)
        self.families: list[Rows] = []
        self.fixed: list[tuple[Array, float]] = []
        self.equations: list[tuple[Array, float]] = []
        self.means: list[tuple[Array, int | None, float]] = []
        self.residuals: list[Residuals] = []
        self.cost = self.sum(problem.objective.terms)
        self.epigraphs(problem.objective.terms)
        for one, asked in problem.bounded:
            if isfinite(asked.high):
                self.constant(one, None, asked.high)
        self.velocity()
        self.windows()

    def unit(self, name: str, weight: float = 1.0) -> Array:
        row = np.zeros(self.size)
        row[self.places[name]] = weight
        return row

    def widened(self, row: Array) -> Array:
        return np.append(row[:-1], np.zeros(len(self.places)))

    def sum(self, terms: Terms) -> Array:
        return np.asarray(sum(self.unit(repr(term), weight) for weight, term in terms))

    def epigraphs(self, terms: Terms) -> None:
        for _, term in terms:
            if isinstance(term, Maximum):
                for part in term.parts:
                    self.fixed.append((self.sum(part.terms) - self.unit(repr(term)), 0.0))
                    self.epigraphs(part.terms)
            else:
                assert isinstance(term, Functional)
                self.constant(term, self.places[repr(term)], 0.0)

    def constant(self, one: Functional, place: int | None, bound: float) -> None:
        """Hold a constant below a variable or a number."""
        if isinstance(one, CamPeak):
            weights = (1.0, 2.0 * one.damping / one.frequency, 1.0 / one.frequency**2)
            self.families.append(Rows(self.laws, self.laws.combined(one.nu, weights), one.signs, place, bound))
        elif isinstance(one, BandResidual):
            self.residuals.append(Residuals(self.laws, one, place, bound))
        elif one.name in SQUARES:
            self.means.append((self.laws.mean(SQUARES[one.name]), place, bound))
        else:
            functions = self.laws.derivative(DERIVATIVES[one.name])
            self.families.append(Rows(self.laws, functions, SIGNS.get(one.name, (1.0, -1.0)), place, bound))

    def velocity(self) -> None:
        problem, b = self.problem, self.laws.derivative(1)
        expected, place = as_range(problem.B), problem.inflexion
        if peak_in_the_middle(problem):
            place = 0.5
        if expected is not None and isfinite(expected.high) and not (place is not None and expected.fixed):
            self.families.append(Rows(self.laws, b, (1.0, -1.0), None, expected.high))
        if problem.monotone:
            one = b if problem.boundary is not None else self.laws.ratio(problem.order)
            self.families.append(Rows(self.laws, one, (-1.0,), None, 0.0))
        top = self.unit("peak velocity")
        if place is None:
            self.equations.append((top, 0.0))
            return
        bend, height = self.laws.row(2, place), self.laws.row(1, place)
        if np.abs(bend).max() > 1e-9:
            self.equations.append((self.widened(bend), -bend[-1]))
        self.equations.append((self.widened(height) - top, -height[-1]))
        # about the place chords to the peak say more than b <= B, which has next to no room there
        chord, start, stop = self.laws.chord(place)
        self.families.append(Rows(self.laws, chord, (-1.0,), None, 0.0, start, stop))
        for low, high in ((0.0, start), (stop, 1.0)):
            self.families.append(Rows(self.laws, b, (1.0,), self.places["peak velocity"], 0.0, low, high))
        if expected is not None:
            self.fixed.append((-top, -expected.low))
            if isfinite(expected.high):
                self.fixed.append((top, expected.high))

    def windows(self) -> None:
        for window in self.problem.windows:
            nu = "abcj".index(window.quantity)
            if window.value:
                row = self.laws.row(nu, window.start)
                self.equations.append((self.widened(row), window.low - row[-1]))
                continue
            for sign, bound in ((1.0, window.high), (-1.0, -window.low)):
                if bound < inf:
                    functions = self.laws.derivative(nu)
                    self.families.append(Rows(self.laws, functions, (sign,), None, bound, window.start, window.stop))


def _names(terms: Terms) -> Iterator[str]:
    for _, term in terms:
        yield repr(term)
        if isinstance(term, Maximum):
            for part in term.parts:
                yield from _names(part.terms)


class Residuals:
    """nu² times the amplitude that a follower's vibration is left with, below a variable or a number."""

    def __init__(self, laws: Laws, one: BandResidual, variable: int | None, bound: float) -> None:
        self.one, self.variable, self.bound = one, variable, bound
        design = one.design
        weights = (1.0,) if design is None else (1.0, 2.0 * one.design_damping / design, 1.0 / design**2)
        functions = laws.combined(1, weights)
        x, measure = legendre.leggauss(80)
        times, velocities = [], []
        for piece, (low, high) in enumerate(pairwise(laws.breaks)):
            k = low + (high - low) * (x + 1.0) / 2.0
            times.append(k)
            velocities.append((high - low) / 2.0 * measure[:, None] * laws.rows(functions, piece, k))
        self.times, self.velocities = np.concatenate(times), np.vstack(velocities)
        single = one.low == one.high
        self.frequencies = np.linspace(one.low, one.high, 1 if single else 25)
        every = np.linspace(one.low, one.high, 1 if single else 1501)
        self.every = every, np.stack([self.amplitude(nu) for nu in every])

    def amplitude(self, nu: float) -> Array:
        """Rows of the real and of the imaginary part."""
        w = complex(-self.one.damping * nu, nu * sqrt(1.0 - self.one.damping**2))
        found = nu**2 * w.conjugate() / w.imag * (np.exp(w * (1.0 - self.times)) @ self.velocities)
        return np.vstack([found.real, found.imag])

    def cones(self) -> list[tuple[Array, int | None, float]]:
        return [(self.amplitude(nu), self.variable, self.bound) for nu in self.frequencies]

    def exchange(self, x: Array) -> float:
        """Add the frequencies where most is left; returns the greatest excess, relative."""
        room = self.bound + (x[self.variable] if self.variable is not None else 0.0)
        nu, rows = self.every
        sizes = np.linalg.norm(rows @ np.append(x[: rows.shape[2] - 1], 1.0), axis=1)
        padded = np.pad(sizes, 1, constant_values=-inf)
        tops = nu[(sizes >= padded[:-2]) & (sizes >= padded[2:]) & (sizes > 0.999 * room)]
        self.frequencies = np.unique(np.concatenate([self.frequencies, tops]))
        return float(sizes.max() - room) / max(abs(room), 1e-6)


def least(
    problem: Problem, rounds: int = 80, tolerance: float = 1e-10, *, of_unsymmetric_laws: bool = False
) -> float | None:
    """The least objective of a convex problem; None if no law has its constraints.

    Of symmetric problems, those that are their own mirror image have no better law among the unsymmetric ones.
    """
    laws = laws_of(replace(problem, symmetric=False) if of_unsymmetric_laws else problem)
    program = Program(problem, laws)
    conic = bool(program.means or program.residuals)
    before, worst = None, inf
    for _ in range(rounds):
        x = _solved(program, 100.0 * tolerance)
        if x is None:
            return None
        # a root mean square is never below 0, as Clarabel's may be by its own tolerance
        norms = [place for _, place, _ in program.means if place is not None]
        x[norms] = np.maximum(x[norms], 0.0)
        worth = float(program.cost @ x)
        exchanges = [
            *map(Rows.exchange, program.families, repeat(x)),
            *map(Residuals.exchange, program.residuals, repeat(x)),
        ]
        worst = max(exchanges, default=0.0)
        settled = before is not None and abs(worth - before) < 1e-9 * abs(worth)
        if worst <= max(tolerance, 1e-8 if settled else 1e-9 if conic else 0.0):
            return worth
        before = worth
    raise Undecided(f"the exchange did not end: {worst:.1e} in {problem}")


def least_share(duration: float, stroke: float, limits: Mapping[str, float], **space: Any) -> float | None:
    """The greatest share that a move takes of its limits, by the names of constants, where it is least.

    At most 1 are those of all times in which the move is possible; 1 itself is that of the least time.
    """
    orders = {"B": 1, "C": 2, "C_plus": 2, "C_minus": 2, "J": 3}
    parts = [f"{name}/{most * duration ** orders[name] / stroke!r}" for name, most in limits.items()]
    return least(Problem(minimise=f"max({', '.join(parts)})", symmetric=False, **space), tolerance=1e-7)


def _solved(program: Program, reduced: float) -> Array | None:
    parts = [family.table(program.size) for family in program.families if family.points]
    rows = np.vstack([np.empty((0, program.size)), *(a for a, _ in parts), *(a[None] for a, _ in program.fixed)])
    right = np.concatenate([*(h for _, h in parts), [h for _, h in program.fixed]])
    # at an end with a given value nothing is left of a row but rounding
    length = np.linalg.norm(rows, axis=1)
    kept = length > 1e-9
    if (right[~kept] < -1e-7).any():
        return None
    rows, right = rows[kept] / length[kept, None], right[kept] / length[kept]
    equations = np.array([a for a, _ in program.equations]).reshape(-1, program.size)
    expected = np.array([h for _, h in program.equations])
    norms = [*program.means, *(cone for residual in program.residuals for cone in residual.cones())]
    if not norms:
        return _highs(program.cost, (rows, right), (equations, expected))
    blocks, sides = [equations, rows], [expected, right]
    cones: list[Any] = [clarabel.ZeroConeT(len(expected)), clarabel.NonnegativeConeT(len(right))]
    for matrix, place, bound in norms:
        variable = np.zeros(program.size)
        if place is not None:
            variable[place] = 1.0
        lower = np.zeros((len(matrix), program.size))
        lower[:, : matrix.shape[1] - 1] = -matrix[:, :-1]
        # with rows as long as the others: Clarabel called a law almost solved that was 28 % above the least
        # and a derivative beyond the laws' degree is 0 in all of them
        unit = float(np.linalg.norm(matrix[:, :-1], axis=1).max()) or 1.0
        blocks += [-variable[None] / unit, lower / unit]
        sides += [np.array([bound]) / unit, matrix[:, -1] / unit]
        cones.append(clarabel.SecondOrderConeT(len(matrix) + 1))
    return _clarabel(program.cost, np.vstack(blocks), np.concatenate(sides), cones, reduced)


def _highs(cost: Array, rows: tuple[Array, Array], equations: tuple[Array, Array]) -> Array | None:
    ways: tuple[tuple[Literal["highs", "highs-ipm"], float], ...]
    ways = (("highs", 1e-10), ("highs", 1e-9), ("highs-ipm", 1e-9), ("highs", 1e-8))
    doubts, message = 0, ""
    for method, tolerance in ways:
        answer = linprog(
            cost,
            *rows,
            *equations,
            bounds=(None, None),
            method=method,
            options={"primal_feasibility_tolerance": tolerance, "dual_feasibility_tolerance": tolerance},
        )
        if answer.status == 0:
            return np.asarray(answer.x, dtype=float)
        doubts += answer.status == 2
        message = answer.message
    if doubts >= 3:
        return None
    raise Undecided(f"HiGHS gave no answer: {message}")


def _clarabel(cost: Array, table: Array, side: Array, cones: list[Any], reduced: float) -> Array | None:
    nothing = csc_matrix((len(cost), len(cost)))
    almost, status = None, ""
    for tolerance in (1e-12, 1e-10, 1e-9, 1e-8):
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        for name in ("tol_gap_abs", "tol_gap_rel", "tol_feas"):
            setattr(settings, name, tolerance)
            setattr(settings, f"reduced_{name}", reduced)
        answer = clarabel.DefaultSolver(nothing, cost, csc_matrix(table), side, cones, settings).solve()
        status = str(answer.status)
        if status == "PrimalInfeasible":
            return None
        if status == "Solved":
            return np.array(answer.x)
        met = abs(answer.obj_val - answer.obj_val_dual) <= reduced * abs(answer.obj_val)
        if almost is None and (status == "AlmostSolved" or (met and max(answer.r_prim, answer.r_dual) <= reduced)):
            almost = np.array(answer.x)
    if almost is None:
        raise Undecided(f"Clarabel said {status}")
    return almost


def rms_by_a_linear_system(problem: Problem, nu: int) -> tuple[float, Chebyshev]:
    """Least RMS of a derivative with b(1/2) = B, or at any B, where no inequality binds; and the velocity found."""
    laws = laws_of(replace(problem, symmetric=False))
    matrix = laws.mean(nu)
    gram, pull = matrix[:, :-1].T @ matrix[:, :-1], matrix[:, :-1].T @ matrix[:, -1]
    rows = np.empty((0, laws.free))
    right = np.empty(0)
    if isinstance(problem.B, float):
        middle = laws.row(1, 0.5)
        rows, right = middle[None, :-1], np.array([problem.B - middle[-1]])
    system = np.block([[gram, rows.T], [rows, np.zeros((len(rows),) * 2)]])
    # where a whole family of laws is best, the shortest x
    x = np.linalg.lstsq(system, np.concatenate([-pull, right]), rcond=1e-13)[0][: laws.free]
    x = np.append(x, 1.0)
    return float(np.linalg.norm(matrix @ x)), _series(laws.derivative(1), x)


def _series(functions: Sequence[Array], x: Array) -> Chebyshev:
    """The sum of functions on one piece."""
    (columns,) = functions
    return Chebyshev(columns @ x, domain=(0.0, 1.0))


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
