"""The commands of `optlaws`, and their single exit: an exit code, and one clear text for an error."""

from __future__ import annotations

import os
import re
import sys
import warnings
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from inspect import cleandoc
from pathlib import Path
from typing import Any

from cyclopts import App, CycloptsError, Parameter, UnusedCliTokensError

from optlaws.echo import cut
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError

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
    signature, text, *_ = re.split(rf"^ *def {name}\(", file.read_text("utf-8"), maxsplit=1, flags=re.MULTILINE)[
        1
    ].split('"""', 2)
    return signature, text


app = application()


class NotProven(OptlawsError):  # noqa: N818
    """A file claims something that is false or not proven; the message names the claim."""


class PartlyChecked(OptlawsError):  # noqa: N818
    """Nothing of a file is false, and some of it was only computed again in doubles; the message names that."""


def exit_code(arguments: Sequence[str]) -> int:
    """Run the command and return its exit code; an error is one clear text on stderr."""
    given = [argument for argument in arguments if argument != FORCE]
    try:
        with warnings.catch_warnings(), _forced(arguments):
            warnings.showwarning = _warn
            listing = not given or given[0] in _HELP
            commands = application(described=True) if listing else app
            if not listing and given[0] in RETIRED:
                raise InputError(f"there is no command {given[0]} any more: {RETIRED[given[0]]}")  # noqa: TRY301
            with nullcontext() if listing else _files_of(given):
                commands(given, exit_on_error=False, print_error=False, result_action="return_none")
    except (CycloptsError, InputError) as error:
        text, code = cut(_plain(error)), BAD_INPUT
    except InfeasibleProblem as error:
        text, code = f"infeasible: {error}", INFEASIBLE
    except (NotProven, PartlyChecked) as error:
        text, code = str(error), PARTLY_CHECKED if isinstance(error, PartlyChecked) else NOT_PROVEN
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


def _plain(error: CycloptsError | InputError) -> str:
    """The text of an error, in words of the user's."""
    if isinstance(error, UnusedCliTokensError) and error.unused_tokens:
        return f"nothing takes {' '.join(error.unused_tokens)}: --help lists what the command takes"
    return str(error)


def _forced(arguments: Sequence[str]) -> AbstractContextManager[None]:
    """What every command writes goes over files with other contents where `--force` is among its arguments."""
    if FORCE not in arguments:
        return nullcontext()
    from optlaws.files.writing import forced

    return forced()


def _files_of(arguments: Sequence[str]) -> AbstractContextManager[None]:
    """All files of a command or, on an error, none; but those of a study, which resumes, and what is not all proven."""
    if arguments[:1] == ["study"]:
        return nullcontext()
    from optlaws.files.writing import all_or_none

    return all_or_none(but=(NotProven,))


def _warn(message: Warning | str, *_: Any, **__: Any) -> None:
    print(f"optlaws: {message}", file=sys.stderr)
