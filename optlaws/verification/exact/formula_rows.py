"""Affine formulas over the laws of a problem, in balls."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import pairwise

from flint import arb

from optlaws.errors import InputError
from optlaws.formulas.affine import degree
from optlaws.formulas.arithmetic import evaluate
from optlaws.formulas.of_motion import Motion
from optlaws.formulas.slopes import derivative
from optlaws.formulas.tree import Call, Formula
from optlaws.formulas.vocabulary import ORDERS
from optlaws.synthesis.functionals.curved_rows import Branch
from optlaws.verification.enclosing.ball_formulas import BALLS
from optlaws.verification.enclosing.balls import ball
from optlaws.verification.exact.space import ExactSpace


def formula_columns(space: ExactSpace, motion: Motion, k: Fraction) -> list[arb]:
    """An affine formula at k: of the free functions, then of the base law with what is left."""
    return _columns(space, motion, ball(k), space.piece(k))


def _columns(space: ExactSpace, motion: Motion, k: arb, piece: int) -> list[arb]:
    found = [arb(0)] * (space.terms + 1)
    for nu, factor in motion.weights.items():
        weight, values = evaluate(factor, {"k": k}, BALLS), space.on_piece(nu, piece, 2 * k - 1)
        found = [one + weight * value for one, value in zip(found, values, strict=True)]
    found[-1] += evaluate(motion.rest, {"k": k}, BALLS)
    return found


def tangent_columns(space: ExactSpace, branch: Branch, point: Sequence[float], k: Fraction) -> list[arb]:
    """The affine function that touches a convex formula where the derivatives are as given; nowhere above it.

    LookupError unless the point gives each of them.
    """
    formula = branch.motion.formula
    used = sorted(formula.names() & ORDERS.keys())
    if len(point) != len(used):
        raise LookupError
    at = {name: ball(value) for name, value in zip(used, point, strict=True)} | {"k": ball(k)}
    found = [arb(0)] * (space.terms + 1)
    found[-1] = evaluate(formula, at, BALLS)
    for name in used:
        slope = evaluate(derivative(formula, name), at, BALLS)
        values = space.values(ORDERS[name], k)
        found = [total + slope * value for total, value in zip(found, values, strict=True)]
        found[-1] -= slope * at[name]
    return [branch.sign * value for value in found]


def tangent_integral(space: ExactSpace, motion: Motion, point: Sequence[float], *, root: bool) -> list[arb]:
    """The affine function that touches the integral of a convex polynomial formula, or its root; nowhere above it.

    Raises
    ------
    InputError
        If the formula is no polynomial of k along a law. LookupError unless the point gives every derivative at every
        place of Gauss's rule.
    """
    used = sorted(motion.formula.names() & ORDERS.keys())
    rule = list(_rule(space, motion))
    if len(point) != len(used) * len(rule):
        raise LookupError
    found, total = [arb(0)] * (space.terms + 1), arb(0)
    slopes = {name: derivative(motion.formula, name) for name in used}
    for i, (k, weight) in enumerate(rule):
        at = {name: ball(point[j * len(rule) + i]) for j, name in enumerate(used)} | {"k": k}
        total += weight * evaluate(motion.formula, at, BALLS)
        for name in used:
            slope = weight * evaluate(slopes[name], at, BALLS)
            values = derivative_anywhere(space, name, k)
            found = [one + slope * value for one, value in zip(found, values, strict=True)]
            found[-1] -= slope * at[name]
    if not root:
        found[-1] += total
        return found
    size = total.sqrt()
    found = [one / (2 * size) for one in found]
    found[-1] += size
    return found


def _rule(space: ExactSpace, motion: Motion) -> Iterator[tuple[arb, arb]]:
    """Gauss's places and weights on every piece, as many as make the rule exact for the formula."""
    degrees = {name: space.degree_of(nu) for name, nu in ORDERS.items() if name in motion.formula.names()}
    degree_along = motion.degree(degrees)
    if degree_along is None or any(isinstance(part, Call) and part.names() for part in motion.formula.walk()):
        raise InputError(f"exact verification integrates polynomials of k along a law, not {motion.formula}")
    breaks = {*space.breaks, *(1 - k for k in space.breaks)} if space.problem.symmetric else set(space.breaks)
    inner = {k for k in (*breaks, *map(Fraction, motion.kinks)) if motion.start < k < motion.stop}
    count = degree_along // 2 + 1
    points = sorted((arb.legendre_p_root(count, i, weight=True) for i in range(count)), key=lambda p: float(p[0]))
    for low, high in pairwise(sorted({Fraction(motion.start), Fraction(motion.stop), *inner})):
        for x, weight in points:
            yield ball((low + high) / 2) + ball((high - low) / 2) * x, weight * ball((high - low) / 2)


def derivative_anywhere(space: ExactSpace, name: str, k: arb) -> list[arb]:
    """A derivative at any place in [0, 1]: of symmetric laws the second half is the first one's mirror image."""
    nu, later = ORDERS[name], space.problem.symmetric and bool(k > ball(Fraction(1, 2)))
    at = 1 - k if later else k
    piece = max(i for i, start in enumerate(space.breaks[:-1]) if not at < ball(start))
    found = space.on_piece(nu, piece, 2 * at - 1)
    if later and nu % 2 == 0:
        found = [-value for value in found]
        if nu == 0:
            found[-1] += 1
    return found


def formula_gauss(space: ExactSpace, motion: Motion) -> list[tuple[list[arb], arb]]:
    """Values at Gauss points of every piece, with weights that add up to the part's length; exact for squares.

    Raises
    ------
    InputError
        If a factor is no polynomial of k between the places of its tables.
    """
    inner = {k for k in (*space.breaks, *map(Fraction, motion.kinks)) if motion.start < k < motion.stop}
    edges = sorted({Fraction(motion.start), Fraction(motion.stop), *inner})
    found = []
    for low, high in pairwise(edges):
        count = 2 + max(_length(space, motion))
        middle, half = ball((low + high) / 2), ball((high - low) / 2)
        # the solver's points ascend in 1 - 2k on each piece
        points = sorted((arb.legendre_p_root(count, i, weight=True) for i in range(count)), key=lambda p: -float(p[0]))
        piece = space.piece((low + high) / 2)
        found += [(_columns(space, motion, middle + half * x, piece), weight * half) for x, weight in points]
    return found


def _length(space: ExactSpace, motion: Motion) -> list[int]:
    """Degrees of the terms in k."""
    factors: list[tuple[Formula, int]] = [(motion.rest, 0)]
    factors += [(factor, space.degree_of(nu)) for nu, factor in motion.weights.items()]
    found = []
    for factor, of_law in factors:
        own = degree(factor, {"k": 1})
        if own is None or any(isinstance(part, Call) and part.names() for part in factor.walk()):
            raise InputError(
                f"exact verification of an RMS needs factors that are polynomials of k or tables, not {factor}: what "
                "bounds it is checked with numpy alone, by Certificate.bound"
            )
        found.append(own + of_law)
    return found
