"""The command `optlaws`."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated, Any, Literal, NoReturn

from cyclopts import App, CycloptsError, Parameter, Token
from rich.console import Console
from rich.table import Table

from optlaws.cli.atlas import atlas
from optlaws.cli.balancing import dwell, loader
from optlaws.cli.follower import follower
from optlaws.cli.front import front
from optlaws.cli.laws import catalogue, constants_table, law
from optlaws.cli.lever import lever
from optlaws.cli.study import study
from optlaws.cli.verify import NotProven, verify
from optlaws.echo import cut
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError
from optlaws.synthesis import Basis, BoundaryConditions, Problem, Range, Solution, at_most, basis, construct, synthesize
from optlaws.synthesis.problem.ranges import read_bounds
from optlaws.synthesis.spaces.breaks import read_breaks

NOT_PROVEN, BAD_INPUT, INFEASIBLE, SOLVER_FAILURE, INTERRUPTED = 1, 2, 3, 4, 130


def _version() -> str:
    from importlib.metadata import version

    return version("optlaws")


def _whole(_: object, tokens: Sequence[Token]) -> int:
    # the parser itself would cut 2.5 to 2
    return int(tokens[0].value)


Whole = Annotated[int, Parameter(converter=_whole)]

app = App(
    name="optlaws",
    help="Optimal motion laws for cam mechanisms and servo axes, with proof of their optimality.",
    version=_version,
    help_format="plaintext",
    default_parameter=Parameter(negative=()),
    suppress_keyboard_interrupt=False,
)


@app.command
def run(*files: Path, out: Path | None = None) -> None:
    """Do the jobs of problem files and write their results.

    Parameters
    ----------
    files
        Problem files (TOML).
    out
        Folder for the results of a single file; otherwise results/NAME beside the folder of the problem file.
    """
    from optlaws.jobs import job

    if not files:
        raise InputError("name at least one problem file, for example problems/optimal_table.toml")
    if out is not None and len(files) > 1:
        raise InputError("--out takes the results of one problem file; several were named")
    progress, console = Console(stderr=True), Console()
    for file in files:
        with progress.status(f"{file}") if progress.is_terminal else nullcontext():
            written = job.run(file, out)
        for text in (w for w in written if w.suffix == ".md"):
            _show_markdown(console, text.read_text(encoding="utf-8"))
        for result in written:
            print(_near(result))  # noqa: T201


@app.command
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
    as_json: Annotated[bool, Parameter(name="--json")] = False,
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
    problem = Problem(
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
    solution = synthesize(problem, bound=bound)
    if output is not None:
        _save(output, solution)
    if as_json:
        print(json.dumps(_summary(solution)))  # noqa: T201
    else:
        _show_solution(solution)


def _basis(name: str, degree: int, breaks: str | None, continuity: int | None) -> Basis:
    piecewise = name in {"bsplines", "pieces"}
    if piecewise != (breaks is not None) or (continuity is not None and not piecewise):
        raise InputError("--basis bsplines and pieces need --breaks, the others take neither --breaks nor --continuity")
    shape: dict[str, Any] = {} if breaks is None else {"breaks": read_breaks(breaks)}
    return basis(name, degree, **shape, **({} if continuity is None else {"continuity": continuity}))


def _at_most(value: float | None) -> Range | None:
    return None if value is None else at_most(value)


@app.command
def constants(
    *,
    z: Annotated[str, Parameter(allow_leading_hyphen=True)],
    order: Whole,
    as_json: Annotated[bool, Parameter(name="--json")] = False,
) -> None:
    """Peak constants of the rest-to-rest law with a given Z(k).

    Parameters
    ----------
    z
        Coefficients of Z in ascending powers of k, separated by blanks: "148.4156 -553.8533 771.0667 -514.0444".
    order
        Number l of boundary conditions at each end.
    as_json
        Print one JSON object on stdout and nothing else.
    """
    try:
        numbers = [float(text) for text in z.replace(",", " ").split()]
    except ValueError as error:
        raise InputError(f"--z takes numbers separated by blanks: {error}") from None
    found = construct(BoundaryConditions.rest(order), numbers).constants
    if as_json:
        print(json.dumps(found.to_dict()))  # noqa: T201
    else:
        Console().print(constants_table(found))


app.command(verify)
app.command(front)
app.command(follower)
app.command(study)
app.command(atlas)
app.command(lever)
app.command(loader)
app.command(dwell)
app.command(law)
app.command(catalogue)


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run the command and exit.

    0 done, 1 a claim is not proven, 2 bad input, 3 infeasible, 4 solver failure, 130 interrupted.
    """
    sys.exit(exit_code(sys.argv[1:] if arguments is None else arguments))


def exit_code(arguments: Sequence[str]) -> int:
    """Run the command and return its exit code; an error is one clear text on stderr."""
    try:
        app(list(arguments), exit_on_error=False, print_error=False, result_action="return_none")
    except (CycloptsError, InputError) as error:
        text, code = cut(str(error)), BAD_INPUT
    except InfeasibleProblem as error:
        text, code = f"infeasible: {error}", INFEASIBLE
    except NotProven as error:
        text, code = str(error), NOT_PROVEN
    except OptlawsError as error:
        text, code = str(error), SOLVER_FAILURE
    except BrokenPipeError:
        # whoever read us has seen enough; the interpreter must not try to flush what is left
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        text, code = f"{error.strerror or error}{f': {error.filename}' if error.filename else ''}", BAD_INPUT
    except KeyboardInterrupt:
        text, code = "interrupted", INTERRUPTED
    else:
        return 0
    print(f"optlaws: {text}", file=sys.stderr)  # noqa: T201
    return code


def _summary(solution: Solution) -> dict[str, Any]:
    whole = solution.to_dict()
    names = ("status", "objective", "lower_bound", "gap", "limit", "constants", "z", "law", "iterations", "seconds")
    return {name: whole[name] for name in names}


def _save(file: Path, solution: Solution) -> None:
    from optlaws.files.writing import MARK, write

    write(file, json.dumps({"about": MARK, **solution.to_dict()}, indent=1) + "\n")


def _show_solution(solution: Solution) -> None:
    console = Console()
    table = Table(show_header=False, box=None, pad_edge=False)
    table.add_row("status", f"{solution.status.value}: {solution.status.advice}")
    table.add_row(str(solution.problem.minimise), f"{solution.objective:.10g}")
    table.add_row("lower bound", f"{solution.lower_bound:.10g} (gap {solution.gap:.1e})")
    if solution.limit is not None:
        table.add_row("limit", f"{solution.limit:.10g}, which no law of any degree can beat")
    if solution.starts:
        table.add_row("starts", f"{len(solution.starts)}, from {solution.starts[0]:.10g} to {solution.starts[-1]:.10g}")
    if solution.z is not None:
        table.add_row("Z(k)", " ".join(f"{one:.9g}" for one in solution.z) + f"  ({solution.problem.basis.name})")
    table.add_row("solved", f"{solution.problem!r}")
    table.add_row("", f"{solution.iterations} iterations of IPOPT, {1e3 * solution.seconds:.0f} ms")
    console.print(table)
    console.print(constants_table(solution.constants))


def _show_markdown(console: Console, text: str) -> None:
    # wide tables are printed as they are: a terminal scrolls, a file keeps its columns
    for line in text.splitlines():
        if not line.startswith("<!--"):
            console.print(line, markup=False, highlight=False, soft_wrap=True)


def _near(file: Path) -> Path:
    try:
        return file.relative_to(Path.cwd())
    except ValueError:
        return file
