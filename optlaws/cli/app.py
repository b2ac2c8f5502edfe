"""The commands of `optlaws`, and the one way out: an exit code, and one clear text for an error."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import NoReturn

from cyclopts import App, CycloptsError, Parameter

from optlaws.echo import cut
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError

NOT_PROVEN, BAD_INPUT, INFEASIBLE, SOLVER_FAILURE, INTERRUPTED = 1, 2, 3, 4, 130

#: commands by the folder that holds the file of each; a file is imported when its command is asked for
COMMANDS = {
    "laws": ("catalogue", "constants", "law"),
    "mechanisms": ("dwell", "follower", "lever", "loader"),
    "synthesis": ("atlas", "front", "run", "solve", "study", "verify"),
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


for _folder, _names in COMMANDS.items():
    for _name in _names:
        app.command(f"optlaws.cli.{_folder}.{_name}:{_name}", name=_name)


class NotProven(OptlawsError):  # noqa: N818
    """A file claims something that is false or not proven; the message says what.

    Examples
    --------
    >>> issubclass(NotProven, OptlawsError)
    True
    """


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
