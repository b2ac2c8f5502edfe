"""Checks of what a problem is made of; each error names the entry and what it may be."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.numbers import MOST_ORDER, MOST_VELOCITY, real, whole
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.ranges import Range, as_range
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.spaces.bases import Basis
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions


def one_of(value: Any, bounds: Mapping[Any, Any], constant: Functional) -> Any:  # noqa: ANN401
    """What is asked of a constant that has an entry of its own."""
    asked = [one for key, one in bounds.items() if key in (constant, constant.name) and one is not None]
    if asked and value is not None:
        raise InputError(f"{constant.name} is given twice: as {value!r} and in bounds as {asked[0]!r}")
    return asked[0] if asked else value


def constant(value: Any, name: str) -> float | Range | None:  # noqa: ANN401 - it is checked here
    """A constant's entry as a number, a range or None."""
    if name == "B" and value is not None and not isinstance(value, Range | tuple | list) and not _velocity(value):
        raise InputError(f"B must be a finite number above 1 (the mean velocity is 1), got {shortened(value)}")
    found = as_range(value, name)
    if found is None:
        return None
    if name == "B" and found.high <= 1.0:
        raise InputError(f"B must be able to exceed 1 (the mean velocity is 1), got {shortened(value)}")
    if found.high <= 0.0:
        raise InputError(f"{name} must be able to exceed 0, got {shortened(value)}")
    return found.high if found.fixed else found


def listed(values: Any, name: str) -> tuple[Any, ...]:  # noqa: ANN401 - it is checked here
    """The entries of a list."""
    if not isinstance(values, list | tuple):
        raise InputError(f"{name} must be a list, got {shortened(values)}")
    return tuple(values)


def windows_of(windows: Any) -> tuple[Window, ...]:  # noqa: ANN401 - they are checked here
    """One window or several as a tuple."""
    found = tuple(windows) if isinstance(windows, list | tuple) else (windows,)
    for window in found:
        if not isinstance(window, Window):
            raise InputError(f"windows must be Window values such as via('a', 0.3, at=0.4), got {shortened(window)}")
    return found


def inflexion_of(k: Any, *, symmetric: bool) -> float | None:  # noqa: ANN401 - it is checked here
    """The k of the inflexion; of symmetric laws 1/2."""
    if k is None:
        return None
    number = real(k)
    if number is None or not 0.0 < number < 1.0:
        raise InputError(f"inflexion must be a k between 0 and 1, got {shortened(k)}")
    if symmetric and k != 0.5:
        raise InputError(f"a symmetric law has its inflexion at 1/2, not at {k!r}: ask symmetric=False")
    return number


def _velocity(value: Any) -> bool:  # noqa: ANN401 - it is checked here
    number = real(value)
    return number is not None and 1.0 < number <= MOST_VELOCITY


def order_of(order: Any, boundary: Any) -> int:  # noqa: ANN401 - they are checked here
    """The order l, which the boundary conditions tell too."""
    if boundary is not None and not isinstance(boundary, BoundaryConditions):
        raise InputError(f"boundary must be BoundaryConditions(start, end), got {shortened(boundary)}")
    if boundary is not None and order in {0, boundary.order}:
        return boundary.order
    found = whole(order, "order", least=1, most=MOST_ORDER)
    if boundary is not None:
        raise InputError(f"order {found} does not fit {boundary.order} boundary conditions at each end")
    return found


def check_choices(chosen: Any, **switches: Any) -> None:  # noqa: ANN401 - they are checked here
    """Refuse a basis that is none and switches that are neither True nor False."""
    if not isinstance(chosen, Basis):
        raise InputError(f"basis must be a Basis such as Powers(9) or Chebyshev(9), got {shortened(chosen)}")
    for name, value in switches.items():
        if not isinstance(value, bool):
            raise InputError(f"{name} must be True or False, got {shortened(value)}")
