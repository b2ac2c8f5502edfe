"""The optimum of any convex problem found again: Clarabel on points that are exchanged, laws as numpy series.

Nothing here uses optlaws.synthesis beyond Problem and the terms of its objective. On points a program asks less than
everywhere, so its least value is never above the true one; the exchange brings it there.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise, repeat
from math import inf, isfinite, sqrt
from typing import Any

import clarabel
import numpy as np
from numpy.polynomial import Chebyshev, legendre
from numpy.typing import NDArray
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

    def __init__(self, problem: Problem) -> None:
        self.problem, self.laws = problem, laws_of(problem)
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
        self.families.append(Rows(self.laws, b, (1.0,), self.places["peak velocity"], 0.0))
        self.near(place)
        if expected is not None:
            self.fixed.append((-top, -expected.low))
            if isfinite(expected.high):
                self.fixed.append((top, expected.high))

    def near(self, place: float) -> None:
        """Rows b(k) <= b(place) on points that crowd about the place, and j <= 0 at it."""
        height, bend = self.laws.row(1, place), self.laws.row(3, place)
        self.fixed.append((self.widened(bend), -bend[-1]))
        for distance in np.geomspace(1e-3, 0.3, 80):
            for k in (place - distance, place + distance):
                if 0.0 < k < 1.0:
                    row = (self.laws.row(1, k) - height) / distance**2
                    self.fixed.append((self.widened(row), -row[-1]))

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


def least(problem: Problem, rounds: int = 25, tolerance: float = 1e-6) -> float | None:
    """The least objective of a convex problem; None if no law has its constraints."""
    program = Program(problem)
    for _ in range(rounds):
        x = _solved(program)
        if x is None:
            return None
        exchanges = [
            *map(Rows.exchange, program.families, repeat(x)),
            *map(Residuals.exchange, program.residuals, repeat(x)),
        ]
        worst = max(exchanges, default=0.0)
        if worst <= tolerance:
            # a root mean square is never below 0, as Clarabel's may be by its own tolerance
            norms = [place for _, place, _ in program.means if place is not None]
            x[norms] = np.maximum(x[norms], 0.0)
            return float(program.cost @ x)
    raise Undecided(f"the exchange did not end: {worst:.1e}")


def _solved(program: Program) -> Array | None:
    parts = [family.table(program.size) for family in program.families]
    rows = np.vstack([np.empty((0, program.size)), *(a for a, _ in parts), *(a[None] for a, _ in program.fixed)])
    right = np.concatenate([*(h for _, h in parts), [h for _, h in program.fixed]])
    length = np.linalg.norm(rows, axis=1)
    kept = length > 1e-9
    if (right[~kept] < -1e-7).any():
        return None
    equations = np.array([a for a, _ in program.equations]).reshape(-1, program.size)
    expected = np.array([h for _, h in program.equations])
    blocks: list[Array] = [equations, rows[kept] / length[kept, None]]
    sides: list[Array] = [expected, right[kept] / length[kept]]
    cones: list[Any] = [clarabel.ZeroConeT(len(expected)), clarabel.NonnegativeConeT(int(kept.sum()))]
    for matrix, place, bound in [
        *program.means,
        *(cone for residual in program.residuals for cone in residual.cones()),
    ]:
        variable = np.zeros(program.size)
        if place is not None:
            variable[place] = 1.0
        lower = np.zeros((len(matrix), program.size))
        lower[:, : matrix.shape[1] - 1] = -matrix[:, :-1]
        # with rows as long as the others: Clarabel called a law almost solved that was 28 % above the least
        # and a derivative beyond the laws' degree is 0 in all of them
        unit = float(np.abs(matrix).max()) or 1.0
        blocks += [-variable[None] / unit, lower / unit]
        sides += [np.array([bound]) / unit, matrix[:, -1] / unit]
        cones.append(clarabel.SecondOrderConeT(len(matrix) + 1))
    return _clarabel(program, np.vstack(blocks), np.concatenate(sides), cones)


def _clarabel(program: Program, table: Array, side: Array, cones: list[Any]) -> Array | None:
    nothing = csc_matrix((program.size, program.size))
    status = ""
    for tolerance in (1e-10, 1e-8):
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        for name in ("tol_gap_abs", "tol_gap_rel", "tol_feas"):
            setattr(settings, name, tolerance)
        answer = clarabel.DefaultSolver(nothing, program.cost, csc_matrix(table), side, cones, settings).solve()
        status = str(answer.status)
        if status == "PrimalInfeasible":
            return None
        if status in {"Solved", "AlmostSolved"}:
            return np.array(answer.x)
    raise Undecided(f"Clarabel said {status}")
