"""Among which laws the best of a cycle is looked for, in words, and where the best of all motions is among them."""

from __future__ import annotations

from collections.abc import Sequence

from optlaws.cycles.optimisation.joined import place
from optlaws.cycles.specification.joints import LawSpan
from optlaws.cycles.specification.programme import is_optimal
from optlaws.synthesis.problem.constants import FUNCTIONALS, RootMeanSquare
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.spaces.bases import Pieces, PolynomialBasis
from optlaws.synthesis.spaces.pieces.periodic import PeriodicPieces

ALL_MOTIONS = "all motions through the joints"


def minimised_rms(problem: Problem) -> int | None:
    """The order of the derivative whose root mean square a problem minimises; None if it minimises something else.

    Examples
    --------
    >>> minimised_rms(Problem(order=3, minimise="rms_j")), minimised_rms(Problem(order=3, minimise="C"))
    (3, None)
    """
    constant = FUNCTIONALS.get(problem.minimise) if isinstance(problem.minimise, str) else None
    return constant.nu if isinstance(constant, RootMeanSquare) else None


def search_space(problem: Problem, span: LawSpan, order: int) -> str:
    """Among which laws the solution of a span's problem is the best, in words.

    A polynomial of degree 2 nu - 1 between two joints has the least root mean square of the derivative of order nu, if
    its ends ask for no more than nu conditions each.

    Examples
    --------
    >>> from optlaws import Cycle, Return, Rise
    >>> def space(minimise):
    ...     return Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm", minimise=minimise).search_space
    >>> space("acceleration"), space("rms jerk")
    ('laws of order 3 with Z of degree 9', 'all motions through the joints')
    """
    nu, basis = minimised_rms(problem), problem.basis
    if isinstance(basis, Pieces):
        if nu is not None and basis == splines_of_least_rms(span, order, nu):
            return ALL_MOTIONS
        return f"splines of degree {basis.degree} in {len(basis.breaks) - 1} pieces"
    degree = basis.degree if isinstance(basis, PolynomialBasis) else 0
    rich = nu is not None and problem.order <= nu and 2 * nu <= 2 * problem.order + degree + 1
    if rich and not (problem.bounded or problem.windows or problem.monotone):
        return ALL_MOTIONS
    return f"laws of order {problem.order} with Z of degree {degree}"


def remark_on_degrees(problems: Sequence[tuple[LawSpan, Problem]], degree: int) -> tuple[str, ...]:
    """Which spans have a Z of another degree than was asked for."""
    raised = [(span, problem.basis) for span, problem in problems]
    return tuple(
        f"{span.where}: Z has the degree {basis.degree}, not {degree}, for the velocities at its ends"
        for span, basis in raised
        if isinstance(basis, PolynomialBasis) and basis.degree != degree
    )


def splines_of_least_rms(span: LawSpan, order: int, nu: int) -> Pieces | None:
    """The splines that hold the motion of least root mean square of the derivative of order nu, of all motions.

    They are of degree 2 nu - 1 with breaks at the joints alone, and as smooth as can be but where more than the
    position is known. None where such a motion would break what the order asks of its ends: then none is the best.

    Examples
    --------
    >>> from optlaws import Cycle, Dwell, Free
    >>> motions = [Dwell("0.1 s"), Free("30 mm", "0.2 s"), Free("-30 mm")]
    >>> (solution,) = Cycle(motions, period="0.5 s", minimise="rms jerk").solutions
    >>> solution.problem.basis
    Pieces(breaks=(0.0, 0.5, 1.0), degree=5, continuity=4)
    """
    known = not span.turns or any(state is not None for state in span.states)
    if order > (nu if known else 2 * nu - 1):
        return None
    times = sorted({*span.starts, *(time for time, _ in span.via), span.stop})
    breaks = [place(span, time) for time in times]
    if not span.turns:
        return Pieces(breaks, 2 * nu - 1, 2 * nu - 2)
    fixed = [start for stretch, start in zip(span.stretches, span.starts, strict=True) if not is_optimal(stretch.given)]
    straight = [times.index(start) for start in fixed]
    return PeriodicPieces(breaks, 2 * nu - 1, nu - 1 if known else 2 * nu - 2, straight)
