"""The exact space of each kind of basis, one function for each kind; others are refused."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache, singledispatch
from math import factorial

from flint import fmpq, fmpq_mat, fmpq_poly

from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.spaces.bases import Basis, Pieces, PolynomialBasis
from optlaws.synthesis.spaces.periodic_pieces import PeriodicPieces
from optlaws.synthesis.spaces.splines import PiecewiseBasis
from optlaws.verification.enclosing.balls import rational
from optlaws.verification.enclosing.space import Condition, ExactSpace, Functions

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
