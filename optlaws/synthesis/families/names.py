"""Names of rows, equations and variables: certificates find their formulas by them, so stored proofs hold the texts."""

from __future__ import annotations

from enum import StrEnum


class _Name(StrEnum):
    """A text that shows itself as one."""

    def __repr__(self) -> str:
        return repr(str(self))


class RowName(_Name):
    """Names of rows that belong to no constant, and of rows of power certificates."""

    VELOCITY = "b"
    BELOW_PEAK = "chord"
    FORWARD = "forward"
    RATIO = "ratio"
    FROM_START = "b / sqrt(2k)"
    FROM_END = "b / sqrt(2 - 2k)"
    TANGENT = "tangent"
    TO_SPARE = "to spare"
    POWER = "power"
    POWER_FROM_LEAST = "power, from the least D"


class VariableName(_Name):
    """Names of variables other than constants of the objective."""

    POWER_ROOT = "root of D"
    VIOLATION = "t"


_WINDOW = "window "
_SIDES = {1.0: "above", -1.0: "below"}


def at_most(constant: str) -> str:
    """The upper bound of a constant that is a variable."""
    return f"{constant} at most"


def at_least(constant: str) -> str:
    """The lower bound of a constant."""
    return f"{constant} at least"


def maximum_part(number: int, maximum: str) -> str:
    """The name of the row that a maximum is at least its part of this number, counted from 1."""
    return f"part {number} of {maximum}"


def part_number(name: str) -> int | None:
    """The number of the part that a row of a maximum refers to, counted from 1; None for other rows.

    >>> part_number(maximum_part(2, "max(B, C)")), part_number("C")
    (2, None)
    """
    first, _, rest = name.partition(" ")
    number = rest.partition(" of ")[0]
    return int(number) if first == "part" and number.isdecimal() else None


def branch(number: int, name: str) -> str:
    """The name of a smooth formula, counted from 1, among several whose maximum is a constant's formula."""
    return f"branch {number} of {name}"


def envelope(number: int, name: str, sign: float) -> str:
    """The name of a convex lower bound of a formula, counted from 1, times a sign."""
    return f"beneath {number} of {name}, {_SIDES[sign]}"


def plane(number: int, name: str) -> str:
    """The name of a plane below a formula's rows in a box: at the centre (0) or at a corner."""
    return f"plane {number} of {name}"


def mirrored(name: str) -> str:
    """The name of the mirrored rows: for symmetric laws they refer to the other half."""
    return f"{name} mirrored"


def window(number: int) -> str:
    """A window by its number, counted from 1."""
    return f"{_WINDOW}{number}"


def window_side(name: str, sign: float) -> str:
    """The name of a window's rows that bound above (sign 1) or below (-1): "window 2 mirrored, below"."""
    return f"{name}, {_SIDES[sign]}"


def window_number(row: str) -> int | None:
    """The number of the window that a row belongs to; None if it belongs to none.

    Examples
    --------
    >>> window_number("window 2 mirrored, below"), window_number("chord")
    (2, None)
    """
    return int(row.split()[1].rstrip(",")) if row.startswith(_WINDOW) else None


def at(symbol: str, k: float) -> str:
    """A quantity at a place, b(1/2) or c(0.3)."""
    return f"{symbol}(1/2)" if k == 0.5 else f"{symbol}({k})"


def velocity_at_peak(k: float | None) -> str:
    """The name of the equation that B is the velocity at k; with None, B is the velocity at the free peak."""
    return "B" if k is None else f"{at('b', k)} = B"


def acceleration_at_peak(k: float) -> str:
    """The equation that c is 0 where b is greatest."""
    return f"{at('c', k)} = 0"
