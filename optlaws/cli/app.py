"""The commands of `optlaws`, and the one way out: an exit code, and one clear text for an error."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Sequence
from typing import Any

from cyclopts import App, CycloptsError, Parameter

from optlaws.echo import cut
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError

NOT_PROVEN, BAD_INPUT, INFEASIBLE, SOLVER_FAILURE, INTERRUPTED = 1, 2, 3, 4, 130

#: commands by their files, with the name where it is another, imported when one runs; what each does, in a sentence
COMMANDS = {
    "laws.catalogue": "List the standard laws, or those that a text may mean, the likeliest first.",
    "laws.compare": "Compare laws: their constants, their peaks in a machine, the vibration they leave behind.",
    "laws.constants": "Peak constants of the rest-to-rest law with a given Z(k).",
    "laws.explore": (
        "Explore laws, fronts and cycles in the browser, from this machine alone: drag a point and the law follows."
    ),
    "laws.export": (
        "Write a law or a cycle in the format of a controller, and say what the controller will run.\n\n"
        "The file goes to --output or, without it, to stdout and the report to stderr."
    ),
    "laws.law": (
        "Show a law of the catalogue, a coded law, a member of Savin's families or a stored law, with its constants."
    ),
    "laws.cycle:cam": (
        "Cams of cycles: curves, enclosed pressure angles and curvatures, proof of no undercut, least sizes."
    ),
    "laws.cycle": (
        "Whole cycles of a machine in physical units, optimal as a whole: peaks, joints, drives, tables and pictures."
    ),
    "laws.dwell": (
        "Balancing mechanisms of types I, II and III for an executive link that dwells, and which of them to take."
    ),
    "laws.follower": (
        "Response of an elastic follower's mass: peaks, dynamic factor, residual vibration, and the same off design."
    ),
    "laws.lever": (
        "Law of motion of a mass that swings between torsion bars on a cam-lever mechanism: exact and asymptotic."
    ),
    "laws.loader": (
        "Inertial loader that balances a law: energy parameter Y, peaks of its motion, its mass or stroke."
    ),
    "synthesis.atlas": (
        "Look a law up in the atlas: the nearest point that keeps what is asked, then the law as asked."
    ),
    "synthesis.front": "Find the laws that exchange constants for one another: each the best of its own problem.",
    "synthesis.ledger": (
        "Show printed numbers, formulas, figures and claims, computed again, with their verdicts.\n\n"
        "Ends with 0 if every verdict that is declared holds, 1 if one does not, 2 if an item cannot be computed."
    ),
    "synthesis.run": "Do the jobs of problem files and write their results.",
    "synthesis.solve": "Find the law with the least peak constant or mixture of constants, and prove it.",
    "synthesis.study": "Solve every point of a study; the same command goes on where an interrupted one stopped.",
    "synthesis.verify": (
        "Check solutions or certificates with every rounding enclosed; no solver takes part.\n\n"
        "Ends with 0 if every claim of every file is proven, 1 if one is false or not proven, 2 if a file cannot be "
        "checked."
    ),
}


def _version() -> str:
    from importlib.metadata import version

    return version("optlaws")


app = App(
    name="optlaws",
    help="Optimal motion laws for cam mechanisms and servo axes, with proof of their optimality.",
    version=_version,
    help_format="plaintext",
    default_parameter=Parameter(negative=()),
    suppress_keyboard_interrupt=False,
)


for _file, _about in COMMANDS.items():
    _module, _, _name = _file.partition(":")
    _name = _name or _module.rpartition(".")[2]
    app.command(f"optlaws.cli.{_module}:{_name}", name=_name, help=_about)


class NotProven(OptlawsError):  # noqa: N818
    """A file claims something that is false or not proven; the message says what.

    Examples
    --------
    >>> issubclass(NotProven, OptlawsError)
    True
    """


def exit_code(arguments: Sequence[str]) -> int:
    """Run the command and return its exit code; an error is one clear text on stderr."""
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _warn
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
    print(f"optlaws: {text}", file=sys.stderr)
    return code


def _warn(message: Warning | str, *_: Any, **__: Any) -> None:
    print(f"optlaws: {message}", file=sys.stderr)
