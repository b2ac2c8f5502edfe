"""The command `optlaws solve`: one problem, its law and its proof."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from cyclopts import Parameter

import optlaws
from optlaws.cli.options import AsJson, Whole, save
from optlaws.cli.show import constants_table, print_json, show, table
from optlaws.errors import InputError


def solve(
    *,
    order: Whole,
    degree: Whole,
    minimise: str = "C",
    peak_velocity: float | None = None,
    most_acceleration: float | None = None,
    most_power: float | None = None,
    most_jerk: float | None = None,
    most: list[str] | None = None,
    least: list[str] | None = None,
    inflexion: float | None = None,
    basis_name: Annotated[
        Literal["powers", "chebyshev", "bernstein", "bsplines", "pieces"], Parameter(name="--basis")
    ] = "powers",
    breaks: str | None = None,
    continuity: Whole | None = None,
    monotone: bool = False,
    unsymmetric: bool = False,
    bound: Literal["quick", "tight"] = "quick",
    as_json: AsJson = False,
    output: Path | None = None,
) -> None:
    """Find the law with the least peak constant or mixture of constants, and prove it.

    Parameters
    ----------
    order
        Number l of boundary conditions at each end: 2 for velocity 0, 3 for acceleration 0 too, 4 for jerk 0 too.
    degree
        Degree of Z(k), or of the law on each piece with --basis pieces.
    minimise
        What to minimise: C, D, J, rms_c, ... or a sum or maximum such as "0.6*C/4 + 0.4*D/2.25".
    peak_velocity
        B, above 1 (dimensionless; the mean velocity is 1); free unless given.
    most_acceleration
        C at most this.
    most_power
        D at most this.
    most_jerk
        J at most this.
    most
        Any constant at most a value, such as rms_c=4; may be repeated.
    least
        Any constant at least a value; may be repeated.
    inflexion
        The k of the peak velocity, where c is 0; asks for unsymmetric laws.
    basis_name
        Basis of Z(k).
    breaks
        For bsplines and pieces: where pieces begin and end, such as "0 0.3 0.7 1", or how many equal ones, such as 8.
    continuity
        For bsplines and pieces: order up to which the derivatives are continuous at the breaks.
    monotone
        Ask b >= 0 too: no return within the motion.
    unsymmetric
        Seek among unsymmetric laws too.
    bound
        Where D is in the problem: tight searches all laws, for a bound that usually meets the objective.
    as_json
        Print one JSON object on stdout and nothing else.
    output
        Write the whole solution, with its problem and certificate, to this JSON file.
    """
    from optlaws.synthesis.problem.ranges import read_bounds

    problem = optlaws.Problem(
        B=peak_velocity,
        C=_at_most(most_acceleration),
        D=_at_most(most_power),
        J=_at_most(most_jerk),
        order=order,
        basis=_basis(basis_name, degree, breaks, continuity),
        minimise=minimise,
        monotone=monotone,
        symmetric=not unsymmetric and inflexion is None,
        bounds=read_bounds(most or [], least or []),
        inflexion=inflexion,
    )
    solution = optlaws.synthesize(problem, bound=bound)
    if output is not None:
        save(output, solution.to_dict())
    if as_json:
        print_json(_summary(solution))
    else:
        _show(solution)


def _basis(name: str, degree: int, breaks: str | None, continuity: int | None) -> optlaws.Basis:
    from optlaws.synthesis import basis
    from optlaws.synthesis.spaces.breaks import read_breaks

    piecewise = name in {"bsplines", "pieces"}
    if piecewise != (breaks is not None) or (continuity is not None and not piecewise):
        raise InputError("--basis bsplines and pieces need --breaks, the others take neither --breaks nor --continuity")
    shape: dict[str, Any] = {} if breaks is None else {"breaks": read_breaks(breaks)}
    return basis(name, degree, **shape, **({} if continuity is None else {"continuity": continuity}))


def _at_most(value: float | None) -> optlaws.Range | None:
    return None if value is None else optlaws.at_most(value)


def _summary(solution: optlaws.Solution) -> dict[str, Any]:
    whole = solution.to_dict()
    names = ("status", "objective", "lower_bound", "gap", "limit", "constants", "z", "law", "iterations", "seconds")
    return {name: whole[name] for name in names}


def _show(solution: optlaws.Solution) -> None:
    facts = table()
    facts.add_row("status", f"{solution.status.value}: {solution.status.advice}")
    facts.add_row(str(solution.problem.minimise), f"{solution.objective:.10g}")
    facts.add_row("lower bound", f"{solution.lower_bound:.10g} (gap {solution.gap:.1e})")
    if solution.limit is not None:
        facts.add_row("limit", f"{solution.limit:.10g}, which no law of any degree can beat")
    if solution.starts:
        facts.add_row("starts", f"{len(solution.starts)}, from {solution.starts[0]:.10g} to {solution.starts[-1]:.10g}")
    if solution.z is not None:
        facts.add_row("Z(k)", " ".join(f"{one:.9g}" for one in solution.z) + f"  ({solution.problem.basis.name})")
    facts.add_row("solved", f"{solution.problem!r}")
    facts.add_row("", f"{solution.iterations} iterations of IPOPT, {1e3 * solution.seconds:.0f} ms")
    show(facts, constants_table(solution.constants))
