"""Checks of the entries of a problem; each error names the entry and its allowed values."""

from __future__ import annotations

from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.numbers import MOST_ORDER, MOST_VELOCITY, real, whole
from optlaws.synthesis.problem.expression import Expression, Term, leaves
from optlaws.synthesis.problem.named_constants import expression, is_named
from optlaws.synthesis.problem.ranges import Range, as_range, beyond
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.spaces.bases import Basis
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions

NO_ORDER = (
    "the problem lacks order, the number of conditions at each end: give order=4, say, or the end conditions themselves"
)


def constant(value: Any, name: str) -> float | Range | None:
    """A constant's entry as a number, a range or None."""
    if name == "B" and value is not None and not isinstance(value, Range | tuple | list) and not _velocity(value):
        raise InputError(f"B must be a finite number above 1 (the mean velocity is 1), got {shortened(value)}")
    limits = as_range(value, name)
    if limits is None:
        return None
    if name == "B" and limits.high <= 1.0:
        raise InputError(beyond(name, "1 (the mean velocity is 1)", limits))
    if limits.high <= 0.0:
        raise InputError(beyond(name, "0", limits))
    return limits.high if limits.fixed else limits


def constant_of_bounds(value: Any, limits: Range, name: str) -> float | Range | None:
    """The bound that `bounds` give of a constant with an entry of its own, if that entry is free."""
    plain = limits.high if limits.fixed else limits
    if value is not None:
        raise InputError(f"{name} is given twice: as {value!r} and in bounds as {plain!r}")
    return constant(plain, name)


def listed(values: Any, name: str) -> tuple[Any, ...]:
    """The entries of a list."""
    if not isinstance(values, list | tuple):
        raise InputError(f"{name} must be a list, got {shortened(values)}")
    return tuple(values)


def windows(given: Any) -> tuple[Window, ...]:
    """A single window or several, as a tuple."""
    several = tuple(given) if isinstance(given, list | tuple) else (given,)
    for window in several:
        if not isinstance(window, Window):
            raise InputError(f"windows must be Window values such as via('a', 0.3, at=0.4), got {shortened(window)}")
    return several


def inflexion(k: Any) -> float | None:
    """The k of the inflexion."""
    if k is None:
        return None
    number = real(k)
    if number is None or not 0.0 < number < 1.0:
        raise InputError(f"inflexion must be a k between 0 and 1, got {shortened(k)}")
    return number


def _velocity(value: Any) -> bool:
    number = real(value)
    return number is not None and 1.0 < number <= MOST_VELOCITY


def boundary(given: Any) -> BoundaryConditions | None:
    """End conditions, or None for rest to rest."""
    if given is not None and not isinstance(given, BoundaryConditions):
        raise InputError(f"boundary must be BoundaryConditions(start, end), got {shortened(given)}")
    return given


class NotGiven(int):
    """The order that nobody gave: another value than a 0 that somebody did.

    >>> NotGiven() == 0, type(NotGiven()) is int
    (True, False)
    """


class AsItFits(int):
    """The default of `symmetric`: symmetric laws wherever they may be best; equal to True."""

    def __repr__(self) -> str:
        return repr(bool(self))


AS_IT_FITS: Any = AsItFits(1)


def is_open(given: object) -> bool:
    """Whether the user leaves the symmetry of the laws open."""
    return isinstance(given, AsItFits)


def symmetric(given: Any) -> Any:
    """True, False, or the value for an open symmetry."""
    return given if is_open(given) else switch(given, "symmetric")


def order(given: Any) -> int:
    """The order l, where it is given."""
    return given if isinstance(given, NotGiven) else whole(given, "order", least=1, most=MOST_ORDER)


def order_with(given: int, ends: BoundaryConditions | None) -> int:
    """The given order l, or the order of the boundary conditions."""
    missing = isinstance(given, NotGiven)
    if ends is None:
        if missing:
            raise InputError(NO_ORDER)
        return given
    if not missing and given != ends.order:
        raise InputError(f"order {given} does not fit {ends.order} boundary conditions at each end")
    return ends.order


def chosen_basis(given: Any) -> Basis:
    """The entry `basis`, a basis of Z."""
    if not isinstance(given, Basis):
        raise InputError(f"basis must be a Basis such as Powers(9) or Chebyshev(9), got {shortened(given)}")
    return given


def switch(given: Any, name: str) -> bool:
    """An entry that is True or False."""
    if not isinstance(given, bool):
        raise InputError(f"{name} must be True or False, got {shortened(given)}")
    return given


def objective(minimise: Any) -> str | Expression:
    """The objective as text if every constant of it has a name, else as an expression."""
    if isinstance(minimise, str):
        terms = expression(minimise)
    elif isinstance(minimise, Term | Expression):
        terms = minimise.expression()
    else:
        raise InputError(f"minimise must be a constant such as 'C', a sum or an expression, got {shortened(minimise)}")
    if terms.vanishes:
        raise InputError(f"an objective needs a weight above 0, got {terms!r}")
    return repr(terms) if all(is_named(leaf) for _, leaf in leaves(terms)) else terms
