"""Libraries that only an extra of optlaws brings: what is said where one is missing."""

from __future__ import annotations

from importlib.util import find_spec

from optlaws.errors import InputError


class NotInstalled(InputError, ImportError):  # noqa: N818 - as SolverFailure
    """A library is missing that an extra of optlaws brings.

    Examples
    --------
    >>> raise NotInstalled("to_pandas needs pandas: pip install optlaws[studies]")
    Traceback (most recent call last):
    optlaws.extras.NotInstalled: to_pandas needs pandas: pip install optlaws[studies]
    """


def needed(module: str, what: str, extra: str = "studies") -> None:
    """See that a library is installed."""
    if find_spec(module) is None:
        raise NotInstalled(f"{what} needs {module}: pip install 'optlaws[{extra}]'")
