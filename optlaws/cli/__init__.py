"""The command `optlaws`: one file for each subcommand, named after it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NoReturn

__all__ = ["exit_code", "main"]

_INTERRUPTED = 130
#: how many more objects there may be before garbage is looked for
_OBJECTS = 100_000


def exit_code(arguments: Sequence[str]) -> int:
    """Run the command and return its exit code; an error is one clear text on stderr."""
    try:
        from optlaws.cli.app import exit_code as run
    except KeyboardInterrupt:  # while what a command needs is imported
        import sys

        print("optlaws: interrupted", file=sys.stderr)
        return _INTERRUPTED
    return run(arguments)


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Run the command and exit.

    0 done, 1 a claim is not proven, 2 bad input, 3 infeasible, 4 solver failure, 130 interrupted.
    """
    import gc
    import sys

    # modules and what they define stay: looking among them for garbage takes a tenth of a short command
    gc.set_threshold(_OBJECTS, 20, 100)
    sys.exit(exit_code(sys.argv[1:] if arguments is None else arguments))
