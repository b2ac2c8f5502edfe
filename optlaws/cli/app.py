"""The commands of `optlaws`, and their single exit: an exit code, and one clear text for an error."""

from __future__ import annotations

import os
import re
import sys
import warnings
from collections.abc import Sequence
from contextlib import nullcontext
from inspect import cleandoc
from pathlib import Path
from typing import Any

from cyclopts import App, CycloptsError, MissingArgumentError, Parameter, UnusedCliTokensError

from optlaws.echo import cut
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError
from optlaws.spelling import known_spelling

PARTLY_CHECKED = 3
NOT_PROVEN, BAD_INPUT, INFEASIBLE, SOLVER_FAILURE, INTERRUPTED = 1, 2, 3, 4, 130

#: the files of the commands by their names, imported when one runs
COMMANDS = {file.stem: file for file in sorted(Path(__file__).parent.glob("*/[!_]*.py"))}
_HELP = ("--help", "-h")
#: commands of version 1.0, each with what does its work
RETIRED = {
    "atlas": "`make atlas` computes the atlas of a checkout; `optlaws solve` finds the law for an exact request",
    "cam": "`optlaws run FILE` does every job of a problem file, cams too, and writes their data to cam.json",
    "constants": '`optlaws law --order 3 --z "COEFFICIENTS"` shows them',
    "dwell": "optlaws.compare_dwell_mechanisms compares these mechanisms in Python",
    "ledger": "`make ledger` shows it in a checkout, and `optlaws run ledger` writes its table",
    "lever": "optlaws.TorsionLever and optlaws.find_torsion_levers compute them in Python",
    "loader": "optlaws.inertial_loader computes it in Python",
}
#: options that are taken in American spelling too
_SPELLED = ("minimise", "modernise")
#: of all commands, wherever it stands
FORCE = "--force"


def _version() -> str:
    from importlib.metadata import version

    return version("optlaws")


def application(*, described: bool = False) -> App:
    """The commands, each with its description for the list; the file of a command is imported when it runs."""
    commands = App(
        name="optlaws",
        help="Optimal motion laws for cam mechanisms and servo axes, with proof of their optimality.\n\n"
        "Files with other contents are left as they are; with --force, any command replaces what it is to write.",
        version=_version,
        help_format="plaintext",
        default_parameter=Parameter(negative=(), show_default=lambda usual: usual or None),
        suppress_keyboard_interrupt=False,
    )
    for name, file in COMMANDS.items():
        about = _about(name, file) if described else None
        commands.command(f"optlaws.cli.{file.parent.name}.{name}:{name}", name=name, help=about)
    return commands


def _about(name: str, file: Path) -> str:
    """The start of the docstring of a command."""
    return cleandoc(head_of(file, name)[1]).partition("\n\nParameters")[0]


def head_of(file: Path, name: str) -> tuple[str, str]:
    """Signature and docstring of a function; its file is read as text, for importing or parsing it takes far longer."""
    signature, text, *_ = re.split(rf"^ *def _?{name}\(", file.read_text("utf-8"), maxsplit=1, flags=re.MULTILINE)[
        1
    ].split('"""', 2)
    return signature, text


app = application()


class NotProven(OptlawsError):  # noqa: N818 - a public name of 1.0
    """A file claims something that is false or not proven; the message names the claim."""

    code = NOT_PROVEN


class Stopped(NotProven):
    """Work was stopped by Ctrl-C, and what there was by then is written; the message says what."""

    code = INTERRUPTED


class PartlyChecked(NotProven):
    """Nothing of a file is false, and some of it could not be checked; the message says how much."""

    code = PARTLY_CHECKED


def exit_code(arguments: Sequence[str]) -> int:
    """Run the command and return its exit code; an error is one clear text on stderr."""
    try:
        with warnings.catch_warnings():
            warnings.showwarning = _warn
            _run([_spelled(argument) for argument in arguments if argument != FORCE], force=FORCE in arguments)
    except (CycloptsError, InputError) as error:
        text, code = cut(_plain(error)), BAD_INPUT
    except InfeasibleProblem as error:
        # the problem as Python code, which the error ends with, says nothing at a command line
        text, code = "\n".join([f"infeasible: {error.args[0]}", *([error.tried] if error.tried else [])]), INFEASIBLE
    except NotProven as error:
        text, code = str(error), error.code
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


def _spelled(argument: str) -> str:
    """An argument with the name of an option as the commands have it."""
    name, equals, value = argument.partition("=")
    return f"--{known_spelling(name[2:], _SPELLED)}{equals}{value}" if name.startswith("--") else argument


def _plain(error: CycloptsError | InputError) -> str:
    """The text of an error, in words of the user's."""
    if isinstance(error, UnusedCliTokensError) and error.unused_tokens:
        return f"nothing takes {' '.join(error.unused_tokens)}: --help lists what the command takes"
    if isinstance(error, MissingArgumentError) and error.argument is not None and error.command_chain:
        command, name = f"`optlaws {' '.join(error.command_chain)}`", error.keyword or error.argument.name
        choices = error.argument.get_choices() or ()
        some = f", one of {', '.join(choices)}" if choices else ""
        needs = f"{name} of {command} needs a value" if name.startswith("--") else f"{command} needs {name}"
        return f"{needs}{some}: its --help says more"
    return str(error)


def _run(arguments: list[str], *, force: bool) -> None:
    """Run the command; it writes all files or, on an error, none: a study resumes, what is unproven or unread stays."""
    if not arguments or arguments[0] in _HELP:
        application(described=True)(arguments, result_action="return_none")
        return
    if arguments[0] in RETIRED:
        raise InputError(f"there is no command {arguments[0]} any more: {RETIRED[arguments[0]]}")
    from optlaws.files.writing import all_or_none, forced

    resumes = arguments[0] == "study"
    with (
        forced() if force else nullcontext(),
        nullcontext() if resumes else all_or_none(but=(NotProven, BrokenPipeError)),
    ):
        app(arguments, exit_on_error=False, print_error=False, result_action="return_none")


def _warn(message: Warning | str, *_: Any, **__: Any) -> None:
    print(f"optlaws: {message}", file=sys.stderr)
