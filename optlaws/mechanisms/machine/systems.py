"""Machines from what other packages call systems: scipy.signal and python-control."""

from __future__ import annotations

from typing import Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError

Matrices = tuple[Any, Any, Any, Any]


def matrices(system: Any) -> Matrices:  # noqa: ANN401 - of any package
    """A, B, C and D of a system, continuous in time: state space, transfer function, or zeros, poles and gain.

    Raises
    ------
    InputError
        If it is none, or it is discrete in time.

    Examples
    --------
    >>> from scipy.signal import TransferFunction
    >>> A, B, C, D = matrices(TransferFunction([400.0], [1.0, 2.0, 400.0]))
    >>> A.tolist()
    [[-2.0, -400.0], [1.0, 0.0]]
    """
    step = getattr(system, "dt", None)
    if step is not None and step != 0:
        raise InputError(f"a system must be continuous in time, got one with steps of {shortened(step)}")
    try:
        found = _state_space(system)
        A, B, C, D = (getattr(found, name) for name in "ABCD")
    except (AttributeError, TypeError, ValueError, NotImplementedError) as error:
        raise InputError(
            "a system must be one of scipy.signal (StateSpace, TransferFunction, ZerosPolesGain) or of python-control "
            f"(ss, tf), proper and with one input for each of the law's, got {shortened(system)}: {error}"
        ) from None
    if not np.size(A):
        raise InputError("the system has no state: a mere gain is no machine")
    return A, B, C, D


def _state_space(system: Any) -> Any:  # noqa: ANN401
    if type(system).__module__.partition(".")[0] == "control":
        import control

        return control.ss(system)
    if not all(hasattr(system, name) for name in "ABCD"):
        return system.to_ss()
    return system
