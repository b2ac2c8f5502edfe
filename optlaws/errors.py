"""The errors that optlaws raises, a small tree, so that a single `except` can catch all; and optional libraries."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from copy import copy
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from optlaws.echo import cut
from optlaws.sentences import sentence


class OptlawsError(Exception):
    """Base of every error raised on purpose by optlaws.

    Examples
    --------
    >>> issubclass(InputError, OptlawsError)
    True
    """


class Interrupted(KeyboardInterrupt):
    """Ctrl-C in work whose results so far are its `partial` result.

    Attributes
    ----------
    partial
        A result of the kind that the work would have given, of what was computed by then.

    Examples
    --------
    >>> Interrupted("stopped after 1 of 3 laws", ["modified sine"]).partial
    ['modified sine']
    """

    def __init__(self, text: str, partial: Any) -> None:
        super().__init__(text)
        self.partial = partial


class InputError(OptlawsError, ValueError):
    """An input is wrong; the message names the input, its value and its allowed values.

    Examples
    --------
    >>> raise InputError("order must be an integer of at least 1, got 0")
    Traceback (most recent call last):
    optlaws.errors.InputError: order must be an integer of at least 1, got 0
    """

    def __init__(self, message: str = "") -> None:
        super().__init__(cut(message))


class CallError(InputError, TypeError):
    """An argument that a constructor does not know, or one that it lacks: a mistake of the call, as Python's own.

    Examples
    --------
    >>> import optlaws
    >>> optlaws.Problem(order=3, degree=13)
    Traceback (most recent call last):
    optlaws.errors.CallError: unknown entry of a problem 'degree': give basis=Chebyshev(13)
    """


@contextmanager
def located(where: str) -> Iterator[None]:
    """Errors name the file, the axis or the entry that they came from, once; a problem and its proof stay with them.

    Examples
    --------
    >>> with located("axis slide"):
    ...     raise InputError("order must be at least 1, got 0")
    Traceback (most recent call last):
    optlaws.errors.InputError: axis slide: order must be at least 1, got 0
    >>> with located("axis slide"), located("axis slide"):
    ...     raise InputError("order must be at least 1, got 0")
    Traceback (most recent call last):
    optlaws.errors.InputError: axis slide: order must be at least 1, got 0
    >>> try:
    ...     with located("axis slide"):
    ...         raise InfeasibleProblem("no law has B < 1", problem={"B": 0.5}, proof="the mean velocity is 1")
    ... except InfeasibleProblem as error:
    ...     print(error.args[0], error.problem, error.proof, sep="; ")
    axis slide: no law has B < 1; {'B': 0.5}; the mean velocity is 1
    """
    try:
        yield
    except OptlawsError as error:
        if str(error.args[0]).startswith(f"{where}: "):
            raise  # what is within is located there already
        placed = copy(error)  # the error itself may be stored, and raised again elsewhere
        placed.args = (cut(sentence("{}: {}", where, error.args[0])), *error.args[1:])
        raise placed from None


class NotNormalised(UserWarning):
    """A mixed objective whose parts differ much in size, so that a single part decides.

    Examples
    --------
    >>> issubclass(NotNormalised, UserWarning)
    True
    """


class NoisyTable(UserWarning):
    """A measured table whose points are noisy, so that its law keeps within a tolerance of them.

    Examples
    --------
    >>> issubclass(NoisyTable, UserWarning)
    True
    """


class InfeasibleProblem(OptlawsError):  # noqa: N818 - a public name of 1.0
    """No law meets the conditions of the problem.

    Parameters
    ----------
    message
        What cannot be met, and which condition to relax.
    problem
        The whole problem; its repr is printed after the message so that it can be run again.
    tried
        What was tried, in words.
    proof
        Whatever shows that no law exists, for example a certificate.

    Examples
    --------
    >>> print(InfeasibleProblem("no law has B < 1", problem={"B": 0.5}))
    no law has B < 1
    problem: {'B': 0.5}
    """

    def __init__(
        self, message: str, *, problem: object | None = None, tried: str = "", proof: object | None = None
    ) -> None:
        super().__init__(_readable(message, problem))
        self.problem = problem
        self.tried = _readable(tried, problem)
        self.proof = proof

    def __str__(self) -> str:
        return _report(self.args[0], self.tried, self.problem)


class SolverFailure(OptlawsError, RuntimeError):  # noqa: N818 - a public name of 1.0
    """The solver found no solution that passes its checks, although the problem may have one.

    Parameters
    ----------
    message
        What went wrong, and what to change.
    problem
        The whole problem; its repr is printed after the message so that it can be run again.
    tried
        What was tried, in words.

    Examples
    --------
    >>> print(SolverFailure("no convergence", problem={"B": 2.0}, tried="3 starts"))
    no convergence
    tried: 3 starts
    problem: {'B': 2.0}
    """

    def __init__(self, message: str, *, problem: object | None = None, tried: str = "") -> None:
        super().__init__(_readable(message, problem))
        self.problem = problem
        self.tried = _readable(tried, problem)

    def __str__(self) -> str:
        return _report(self.args[0], self.tried, self.problem)


def _readable(message: str, problem: object | None) -> str:
    """A message in which constants of the problem that have long texts are called by their titles."""
    titled = getattr(problem, "titled", None)
    text = str(titled(message)) if callable(titled) else message
    return message if text == message else text  # a sentence stays one


def _report(message: str, tried: str, problem: object | None) -> str:
    lines = [message]
    if tried:
        lines.append(f"tried: {tried}")
    if problem is not None:
        lines.append(f"problem: {getattr(problem, 'as_code', None) or repr(problem)}")
    return "\n".join(lines)


class NotInstalled(InputError, ImportError):  # noqa: N818 - as SolverFailure
    """A library is missing that an extra of optlaws brings, or that was left out of an installation.

    Examples
    --------
    >>> raise not_installed("to_pandas needs pandas", "'optlaws[studies]'")
    Traceback (most recent call last):
    optlaws.errors.NotInstalled: to_pandas needs pandas: pip install 'optlaws[studies]' (or uv pip install ...)
    """


def not_installed(what: str, requirement: str) -> NotInstalled:
    """The error of a missing library, with the line that installs it by pip, or by uv without pip."""
    return NotInstalled(f"{what}: pip install {requirement} (or uv pip install ...)")


def needed(module: str, what: str, extra: str = "studies") -> Any:
    """An optional library, imported if it is installed; a module within it comes with it."""
    library = module.partition(".")[0]
    if find_spec(library) is None:
        raise not_installed(f"{what} needs {library}", f"'optlaws[{extra}]'")
    return import_module(module)
