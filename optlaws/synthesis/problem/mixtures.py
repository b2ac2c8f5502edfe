"""Mixed objectives: whether their parts are of one size."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from math import isnan

from optlaws.errors import NotNormalised
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.expression import Expression, leaves

_SPREAD = 8.0
_KEPT = 1024
_warned: set[tuple[str, int]] = set()
_silent: ContextVar[bool] = ContextVar("mixtures are meant", default=False)


@contextmanager
def meant() -> Iterator[None]:
    """Have no mixture warned of, in this thread alone: filters of warnings are the process's.

    Examples
    --------
    >>> from optlaws.synthesis.problem.constants import C, J
    >>> with meant():
    ...     warn_of_mixture(C + 3 * J, 4)
    """
    before = _silent.set(True)
    try:
        yield
    finally:
        _silent.reset(before)


def warn_of_mixture(objective: Expression, order: int) -> None:
    """Warn, once for each objective, if a part of a mixture outweighs another many times over.

    Parts are compared at the constants' least values for laws of the order: C counts 4, D 2.25, J 32 from order 3 on.
    An objective such as C + 3*J is hardly a mixture; 0.5*C/4 + 0.5*J/32 is.

    Examples
    --------
    >>> from optlaws.synthesis.problem.constants import C, D
    >>> warn_of_mixture(0.6 * C / 4 + 0.4 * D / 2.25, 4)
    """
    text = repr(objective)
    if _silent.get() or (text, order) in _warned:
        return
    shares = {leaf: weight * leaf.least(order) for weight, leaf in leaves(objective) if isinstance(leaf, Functional)}
    known = [share for share in shares.values() if not isnan(share)]
    if len(known) > 1 and max(known) > _SPREAD * min(known):
        if len(_warned) >= _KEPT:
            _warned.clear()
        _warned.add((text, order))
        parts = ", ".join(f"{leaf!r} {share:.3g}" for leaf, share in shares.items() if not isnan(share))
        message = f"the objective {text} is not normalised: at the constants' least values its parts are {parts}"
        warnings.warn(f"{message}; divide each constant by such a value", NotNormalised, stacklevel=3)
