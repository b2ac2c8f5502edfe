"""Libraries of optlaws' extras, or libraries that a user has removed, and the errors where they are missing."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from typing import Any

from optlaws.errors import InputError


class NotInstalled(InputError, ImportError):  # noqa: N818 - as SolverFailure
    """A library is missing that an extra of optlaws brings, or that was left out of an installation.

    Examples
    --------
    >>> raise NotInstalled("to_pandas needs pandas: pip install optlaws[studies]")
    Traceback (most recent call last):
    optlaws.extras.NotInstalled: to_pandas needs pandas: pip install optlaws[studies]
    """


def needed(module: str, what: str, extra: str = "studies") -> Any:
    """An optional library, imported if it is installed; a module within it comes with it."""
    library = module.partition(".")[0]
    if find_spec(library) is None:
        raise NotInstalled(f"{what} needs {library}: pip install 'optlaws[{extra}]'")
    return import_module(module)
