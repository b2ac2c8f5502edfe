"""Affine formulas over the laws of a problem, in balls."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

from flint import arb

from optlaws.errors import InputError
from optlaws.formulas.arithmetic import evaluate
from optlaws.formulas.degree import degree
from optlaws.formulas.of_motion import Motion
from optlaws.formulas.tree import Call, Formula
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
