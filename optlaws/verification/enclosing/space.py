"""The laws of a problem as a linear space of piecewise polynomials, in exact rational arithmetic, by kind of basis."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cache, lru_cache, singledispatch
from itertools import pairwise
from math import factorial
from typing import NamedTuple

from flint import arb, fmpq, fmpq_mat, fmpq_poly

from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.spaces.bases import Basis, Pieces, PiecewiseBasis, PolynomialBasis
from optlaws.synthesis.spaces.free_pieces import PeriodicPieces
from optlaws.verification.enclosing.balls import at, ball, rational

Functions = list[fmpq_poly]


class EndValues(NamedTuple):
    """Consequences of the end conditions for every law: b(0), b(1) - b(0) (None if free) and the stroke."""

    start_velocity: fmpq | None
    velocity_change: fmpq | None
    stroke: fmpq


class Condition(NamedTuple):
    """The derivative of order nu has a value at k in every law, or so much more than at `less`."""

    nu: int
    k: Fraction
    value: Fraction
    less: Fraction | None = None


class ExactSpace:
    """Laws base + sum of z_i f_i, all polynomials in x = 2k - 1 between breaks.

    Parameters
    ----------
    problem
        Whose laws.
    breaks
        From 0 to 1, or to 1/2 where the rest follows by symmetry.
    functions
        On each piece the free functions, then the base law.
    continuity
        Order up to which the derivatives are continuous at the breaks; None for polynomials.
    conditions
        What every law keeps beside, in the order of the certificate's equations.
    divided
        Whether rows b >= 0 are divided by what rest at the ends makes vanish there.
    """

    def __init__(
        self,
        problem: Problem,
        breaks: Sequence[Fraction],
        functions: Sequence[Functions],
        *,
        continuity: int | None = None,
        conditions: Sequence[Condition] = (),
        divided: bool = False,
    ) -> None:
        self.problem, self.breaks, self.continuity = problem, list(breaks), continuity
        self.divided = divided
        self.conditions = list(conditions)
        self.terms = len(functions[0]) - 1
        self._derivatives = [list(functions)]

    def piece(self, k: Fraction) -> int:
        """The piece that contains k, the later one at a break; LookupError beyond the breaks."""
        if not self.breaks[0] <= k <= self.breaks[-1]:
            raise LookupError
        return max(i for i, start in enumerate(self.breaks[:-1]) if start <= k)

    def derivative(self, nu: int) -> list[Functions]:
        """Derivatives of order nu by k, on each piece."""
        while len(self._derivatives) <= nu:
            self._derivatives.append(
                [[2 * function.derivative() for function in part] for part in self._derivatives[-1]]
            )
        return self._derivatives[nu]

    def values(self, nu: int, k: Fraction) -> list[arb]:
        """Values of the derivatives of order nu at k."""
        return values(self.derivative(nu)[self.piece(k)], x_of(k))

    def condition(self, condition: Condition) -> list[arb]:
        """The row of a condition: what each function has of it, the base law last."""
        row = self.values(condition.nu, condition.k)
        if condition.less is None:
            return row
        return [entry - other for entry, other in zip(row, self.values(condition.nu, condition.less), strict=True)]

    def on_piece(self, nu: int, piece: int, x: arb) -> list[arb]:
        """Values of the derivatives of order nu at x = 2k - 1, by the polynomials of a piece."""
        return values(self.derivative(nu)[piece], x)

    def degree_of(self, nu: int) -> int:
        """The greatest degree of a derivative of order nu."""
        return max(0, *(polynomial.degree() for part in self.derivative(nu) for polynomial in part))

    def combination(self, nu: int, weights: tuple[Fraction, ...], k: Fraction) -> list[arb]:
        """Values of w0 a^(nu) + w1 a^(nu+1) + ... at k."""
        terms = [[ball(w) * value for value in self.values(nu + i, k)] for i, w in enumerate(weights) if w]
        return [sum(column, arb(0)) for column in zip(*terms, strict=True)]

    def chord(self, peak: Fraction, k: Fraction) -> list[arb]:
        """(b - b(peak)) / w of laws with c = 0 at the peak, w > 0: (x - x of the peak)² on the piece with the peak.

        On other pieces w is the least value of this there. If c may jump at the peak it is the distance and not its
        square.
        """
        piece = self.piece(k)
        divided = values(self._chords(peak)[piece], x_of(k))
        high = self.breaks[piece + 1]
        falling = not self._smooth_at(peak) and high == peak
        return [-value for value in divided] if falling else divided

    def _smooth_at(self, k: Fraction) -> bool:
        return self.continuity is None or self.continuity > 1 or k not in self.breaks

    @kept_property
    def _chords(self) -> Callable[[Fraction], list[Functions]]:
        return cache(self._computed_chords)

    def _computed_chords(self, peak: Fraction) -> list[Functions]:
        centre, power = rational(2 * peak - 1), 2 if (smooth := self._smooth_at(peak)) else 1
        edges = [rational(2 * k - 1) for k in self.breaks]
        touching = [i for i, (low, high) in enumerate(pairwise(self.breaks)) if low <= peak <= high]
        if not touching:
            raise LookupError
        b, c = self.derivative(1), self.derivative(2)
        heights = [function(centre) for function in b[touching[0]]]
        chords = []
        for i, part in enumerate(b):
            if i in touching:
                # what c = 0 makes vanish is the rest of the division
                way = fmpq_poly([-centre, 1]) ** power
                chords.append(
                    [divmod(function - height, way)[0] for function, height in zip(part, heights, strict=True)]
                )
                continue
            before = i < touching[0]
            inner, joint = (touching[0], edges[touching[0]]) if before else (touching[-1], edges[touching[-1] + 1])
            slopes = [function(centre) / 2 * (joint - centre) if smooth else fmpq(0) for function in c[inner]]
            scale = abs(edges[i + 1 if before else i] - centre) ** power
            together = zip(part, heights, slopes, strict=True)
            chords.append([(function - height - slope) / scale for function, height, slope in together])
        return chords

    def ratio(self, k: Fraction) -> list[arb]:
        """-b / w at k of laws from rest to rest, w > 0: (k(1-k))^(l-1), in units of the base law's."""
        return values(self._ratio[self.piece(k)], x_of(k))

    @kept_property
    def _ratio(self) -> list[Functions]:
        weight, b = fmpq_poly([1, 0, -1]) ** (self.problem.order - 1), self.derivative(1)
        middle = b[self.piece(Fraction(1, 2))][-1](fmpq(0))
        return [[divmod(velocity, weight)[0] / -middle for velocity in part] for part in b]

    @kept_property
    def bounds(self) -> EndValues:
        """Consequences of the end conditions."""
        conditions = self.problem.conditions
        start, end = ([rational(Fraction(v)) for v in part] for part in (conditions.start, conditions.end))
        stroke = end[0] - start[0]
        if len(start) == 1:
            return EndValues(None, None, stroke)
        return EndValues(start[1], end[1] - start[1], stroke)

    def moments(self, nu: int) -> list[list[list[arb]]]:
        """On each piece, integrals over k of the derivatives of order nu times functions at most 1 in magnitude.

        These are Legendre polynomials; one list for each that sees a free function.
        """
        return [[[arb(entry) for entry in row] for row in piece] for piece in self._moments(nu)]

    @kept_property
    def _moments(self) -> Callable[[int], list[list[list[fmpq]]]]:
        return cache(self._computed_moments)

    def _computed_moments(self, nu: int) -> list[list[list[fmpq]]]:
        moments: list[list[list[fmpq]]] = []
        for part, (low, high) in zip(self.derivative(nu), pairwise(self.breaks), strict=True):
            local = fmpq_poly([rational(low + high - 1), rational(high - low)])
            functions = [function(local) for function in part]
            degree = max((function.degree() for function in functions[:-1]), default=-1)
            size = max(degree, functions[-1].degree()) + 1
            powers = fmpq_mat([[function[i] for i in range(size)] for function in functions])
            rows = (rational(high - low) * _of_legendre(degree + 1, size) * powers.transpose()).tolist()
            moments.append([row for row in rows if any(row[:-1])])
        return moments

    def gauss(self, nu: int, count: int) -> list[tuple[list[arb], arb]]:
        """Values of the derivatives of order nu at a number of Gauss points, with weights that add up to 1.

        LookupError unless the rule is exact for squares.
        """
        pieces, functions = len(self.breaks) - 1, self.derivative(nu)
        each, rest = divmod(count, pieces)
        if rest or each <= max(function.degree() for part in functions for function in part):
            raise LookupError
        # the solver's points ascend in 1 - 2k on each piece
        rule = sorted(
            (arb.legendre_p_root(each, i, weight=True) for i in range(each)), key=lambda point: -float(point[0])
        )
        whole = self.breaks[-1] - self.breaks[0]
        points = []
        for part, (low, high) in zip(functions, pairwise(self.breaks), strict=True):
            middle, half, share = ball(low + high - 1), ball(high - low), ball((high - low) / whole / 2)
            points += [(values(part, middle + half * x), weight * share) for x, weight in rule]
        return points


def _of_legendre(count: int, size: int) -> fmpq_mat:
    """Halves of the integrals from -1 to 1 of Legendre's polynomials times powers of x, a row for each polynomial."""
    rows = []
    for m in range(count):
        legendre = fmpq_poly.legendre_p(m)
        # of x^(i+j) none where i + j is odd
        rows.append([sum((legendre[j] / (i + j + 1) for j in range(i % 2, m + 1, 2)), fmpq(0)) for i in range(size)])
    return fmpq_mat(count, size, [entry for row in rows for entry in row])


def values(polynomials: Functions, x: arb) -> list[arb]:
    """Values of all polynomials at one place."""
    return [at(polynomial, x) for polynomial in polynomials]


def x_of(k: Fraction) -> arb:
    """The place x = 2k - 1 of a k."""
    return ball(2 * k - 1)


_HALF = Fraction(1, 2)
_X = fmpq_poly([0, 1])
_K = (_X + 1) * fmpq(1, 2)
_ZERO = fmpq_poly([0])


def exact_space(problem: Problem) -> ExactSpace:
    """The laws of a problem as a space in exact numbers.

    >>> from optlaws import Chebyshev
    >>> exact_space(Problem(B=1.6, order=1, basis=Chebyshev(1))).derivative(1)
    [[3/2*x^2 + (-1/2), 1]]
    """
    return _of_shape(problem.shape)


@lru_cache(maxsize=16)
def _of_shape(problem: Problem) -> ExactSpace:
    return _space(problem.basis, problem)


@singledispatch
def _space(basis: Basis, problem: Problem) -> ExactSpace:  # noqa: ARG001 - of a known basis
    raise unknown_basis(basis)


def unknown_basis(basis: Basis) -> InputError:
    """The error to raise for a basis of a kind that nobody has put into exact arithmetic."""
    return InputError(
        f"exact verification knows laws with Z in polynomials or in splines, and laws of pieces, not {basis!r}"
    )


@_space.register
def _(basis: PolynomialBasis, problem: Problem) -> ExactSpace:
    odd = problem.symmetric
    powers = [_X**i for i in range(1 if odd else 0, basis.degree + 1, 2 if odd else 1)]
    functions = [*(_edge(problem) * z for z in powers), _base(problem)]
    return ExactSpace(problem, [Fraction(0), Fraction(1)], [functions], divided=problem.boundary is None)


@_space.register
def _(basis: PiecewiseBasis, problem: Problem) -> ExactSpace:
    breaks = [Fraction(k) for k in basis.breaks]
    dimension = (len(breaks) - 1) * (basis.degree - basis.continuity) + basis.continuity + 1
    if basis.size != dimension:
        raise InputError(
            f"exact verification needs a basis of all splines with its breaks, degree and continuity, {dimension} "
            f"functions; {basis!r} has {basis.size}"
        )
    if problem.symmetric:
        breaks, free = _odd_splines(breaks, basis.degree, basis.continuity)
    else:
        free = _splines(breaks, basis.degree, basis.continuity)
    functions = [[*(_edge(problem) * z for z in part), _base(problem)] for part in free]
    return ExactSpace(problem, breaks, functions, continuity=basis.continuity, divided=problem.boundary is None)


@_space.register
def _(basis: Pieces, problem: Problem) -> ExactSpace:
    start, end = ([Fraction(v) for v in part] for part in (problem.conditions.start, problem.conditions.end))
    breaks = [Fraction(k) for k in basis.breaks if not problem.symmetric or k <= _HALF]
    equations = [Condition(nu, Fraction(0), start[nu]) for nu in range(2, problem.order)]
    if problem.symmetric:
        equations.append(Condition(0, _HALF, (start[0] + end[0]) / 2))
        equations += [Condition(nu, _HALF, Fraction(0)) for nu in range(2, min(basis.continuity, basis.degree) + 1, 2)]
    else:
        equations += [Condition(nu, Fraction(1), value) for nu, value in enumerate(end)]
    base = sum((rational(v / factorial(i)) * _K**i for i, v in enumerate(start[: basis.degree + 1])), _ZERO)
    splines = _splines(breaks, basis.degree, basis.continuity, lowest=problem.order)
    functions = [[*part, base] for part in splines]
    divided = problem.boundary is None and problem.order > 1 and (problem.symmetric or len(breaks) > 2)
    return _FreePieces(problem, breaks, functions, continuity=basis.continuity, conditions=equations, divided=divided)


@_space.register
def _(basis: PeriodicPieces, problem: Problem) -> ExactSpace:
    start, end = (Fraction(part[0]) for part in (problem.conditions.start, problem.conditions.end))
    breaks = [Fraction(k) for k in basis.breaks]
    free = _periodic(basis, _splines(breaks, basis.degree, basis.continuity, lowest=1))
    equations = [Condition(0, Fraction(1), end), Condition(1, Fraction(1), Fraction(0), less=Fraction(0))]
    base = fmpq_poly([rational(start)])
    functions = [[*part, base] for part in free]
    return ExactSpace(problem, breaks, functions, continuity=basis.continuity, conditions=equations)


def _periodic(basis: PeriodicPieces, functions: list[Functions]) -> list[Functions]:
    """The combinations of functions whose acceleration is periodic, and 0 on straight pieces."""
    bent = [[4 * function.derivative().derivative() for function in part] for part in functions]
    rows = [[function[i] for function in bent[piece]] for piece in basis.straight for i in range(basis.degree - 1)]
    first, last = bent[0], bent[-1]
    for _ in range(basis.continuity - 1):
        rows.append([after(fmpq(1)) - before(fmpq(-1)) for before, after in zip(first, last, strict=True)])
        first, last = ([function.derivative() for function in part] for part in (first, last))
    free = _null_space(rows)
    return [
        [sum((w * function for w, function in zip(way, part, strict=True) if w != 0), _ZERO) for way in free]
        for part in functions
    ]


def _null_space(rows: list[list[fmpq]]) -> list[list[fmpq]]:
    """Independent vectors that every row maps to 0, as many as exist."""
    whole, _ = fmpq_mat(rows).numer_denom()
    vectors, count = whole.nullspace()
    return [[fmpq(vectors[i, j]) for i in range(whole.ncols())] for j in range(count)]


class _FreePieces(ExactSpace):
    @kept_property
    def _ratio(self) -> list[Functions]:
        # w = (k/k1)^(l-1) on the first piece, likewise on one that ends with 1, and 1 between
        power = self.problem.order - 1
        ways = [fmpq_poly([1]) for _ in self.breaks[1:]]
        ways[0] = (_K / rational(self.breaks[1])) ** power
        if self.breaks[-1] == 1:
            ways[-1] = ((1 - _K) / rational(1 - self.breaks[-2])) ** power
        return [
            [-divmod(velocity, way)[0] for velocity in part] for part, way in zip(self.derivative(1), ways, strict=True)
        ]


def _splines(breaks: list[Fraction], degree: int, continuity: int, lowest: int = 0) -> list[Functions]:
    """On each piece: powers of k from the lowest on, then what begins at each inner break."""
    functions: list[Functions] = []
    for start in breaks[:-1]:
        part = [_K**i for i in range(lowest, degree + 1)]
        for place in breaks[1:-1]:
            begun = [(_K - rational(place)) ** j for j in range(continuity + 1, degree + 1)]
            part += begun if place <= start else [_ZERO] * len(begun)
        functions.append(part)
    return functions


def _odd_splines(breaks: list[Fraction], degree: int, continuity: int) -> tuple[list[Fraction], list[Functions]]:
    """Breaks of the first half, and all splines that are odd about 1/2, there."""
    inner = [k for k in breaks if 0 < k < _HALF]
    way = fmpq_poly([fmpq(1, 2)]) - _K
    functions: list[Functions] = []
    starts = [Fraction(0), *inner]
    for start in starts:
        part = [way**j for j in range(1, degree + 1, 2)]
        if _HALF in breaks:
            part += [way**j for j in range(2, degree + 1, 2) if j > continuity]
        for place in inner:
            gone = [(rational(place) - _K) ** j for j in range(continuity + 1, degree + 1)]
            part += gone if start < place else [_ZERO] * len(gone)
        functions.append(part)
    return [*starts, _HALF], functions


def _edge(problem: Problem) -> fmpq_poly:
    return (_K * (_K - 1)) ** problem.order


def _base(problem: Problem) -> fmpq_poly:
    a0, a1 = (
        fmpq_poly([rational(value) for value in part])(_K)
        for part in (problem.conditions.a0(), problem.conditions.a1())
    )
    return a0 + _K**problem.order * a1
