"""Values and windows of a, b, c or j at given k or over an interval: via points, forbidden zones, inflexions."""

from __future__ import annotations

import re
from math import inf, isfinite
from typing import Any

from optlaws.echo import shortened, unknown_key
from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Number, Text
from optlaws.errors import InputError
from optlaws.formulas.of_motion import MotionFormula, of_text
from optlaws.formulas.reading import FormulaError
from optlaws.kept import kept_property

QUANTITIES = {"a": 0, "b": 1, "c": 2, "j": 3}

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_TEXT = re.compile(
    rf"\s*(?:(?P<low>{_NUMBER})\s*<=)?\s*(?P<quantity>[^<>=@]*[^<>=@\s])\s*(?:(?P<sign><=|>=|=)\s*(?P<value>{_NUMBER}))?"
    rf"\s*(?:@\s*(?P<start>{_NUMBER})\s*(?:\.\.\s*(?P<stop>{_NUMBER})\s*)?)?"
)
_LONGEST = 200


@declared
class Window(Declared, title="a window"):
    """A quantity of the law stays between two values at one k or over an interval (dimensionless).

    Raises
    ------
    InputError
        If the quantity is no formula, has kinks that are not those of a maximum, or a value though it is not affine in
        the law, or the numbers are out of order or out of range.

    Examples
    --------
    >>> Window("a", 0.4, 0.6, 0.45, 0.55).nu
    0
    >>> via("a", 0.3, at=0.4)
    via('a', 0.3, at=0.4)
    """

    writes_defaults = True

    quantity: str = entry(Text(), '"a", "b", "c" or "j", or a formula of these and k such as "c + 0.2*b".', example="a")
    low: float = entry(Number(absent=-inf), "The least value, if there is one.", default=-inf, example=0.4)
    high: float = entry(
        Number(absent=inf), "The greatest value, if there is one; equal to `low` for a given value.", default=inf
    )
    start: float = entry(Number(), "Where it begins, k in [0, 1].", default=0.0)
    stop: float = entry(Number(), "Where it ends; at `start` for one k.", default=1.0)

    def _check(self) -> None:
        if (
            self.low > self.high
            or self.low == inf
            or self.high == -inf
            or not (isfinite(self.low) or isfinite(self.high))
        ):
            raise InputError(
                f"a window needs low <= high and one of them finite, got {shortened(self.low)} and {self.high!r}"
            )
        if not 0.0 <= self.start <= self.stop <= 1.0:
            raise InputError(f"a window needs 0 <= start <= stop <= 1, got {shortened(self.start)} and {self.stop!r}")
        if self.quantity not in tuple(QUANTITIES):
            self._read_formula()

    def _read_formula(self) -> None:
        """Keep the quantity as its formula prints itself."""
        quantity: object = self.quantity
        if not isinstance(quantity, str) or quantity.isidentifier():
            raise InputError(unknown_key(self.quantity, QUANTITIES, "quantity"))
        motion = of_text(self.quantity, self.start, self.stop)
        if not motion.orders:
            raise FormulaError("the formula has none of a, b, c, d, j: no law changes it", self.quantity, 0)
        if self.value and motion.affine is None:
            raise FormulaError(
                f"a value needs a formula that is affine in the law: {motion.verdict.why}", self.quantity, 0
            )
        signs = [sign for sign, bound in ((1.0, self.high), (-1.0, self.low)) if isfinite(bound)]
        if any(motion.branches(sign) is None for sign in signs):
            raise FormulaError("the kinks of the formula are not those of a maximum", self.quantity, 0)
        object.__setattr__(self, "quantity", str(motion.formula))

    def __repr__(self) -> str:
        if self.value:
            return f"via({self.quantity!r}, {self.low!r}, at={self.start!r})"
        ends = {"low": (self.low, -inf), "high": (self.high, inf), "start": (self.start, 0.0), "stop": (self.stop, 1.0)}
        shown = [f"{name}={value!r}" for name, (value, default) in ends.items() if value != default]
        return f"Window({', '.join([repr(self.quantity), *shown])})"

    @kept_property
    def motion(self) -> MotionFormula | None:
        """The formula over its part of the interval; None for a, b, c and j alone."""
        return None if self.quantity in QUANTITIES else of_text(self.quantity, self.start, self.stop)

    @property
    def convex(self) -> bool:
        """Whether the laws that keep it are a convex set."""
        if self.motion is None:
            return True
        kind = self.motion.curvature
        return (kind.convex or not isfinite(self.high)) and (kind.concave or not isfinite(self.low))

    @property
    def scale(self) -> float:
        """The size of the quantity in smooth laws, a power of 2, and 1 for a, b, c and j alone."""
        return 1.0 if self.motion is None else self.motion.scale

    @property
    def nu(self) -> int:
        """The order of the window's derivative."""
        return QUANTITIES[self.quantity]

    @property
    def point(self) -> bool:
        """Whether the window is a single k."""
        return self.start == self.stop

    @property
    def value(self) -> bool:
        """Whether the window prescribes a value at a single k."""
        return self.point and self.low == self.high

    def mirrored(self) -> Window:
        """The window mirrored for symmetric laws: a(k) + a(1-k) = 1, b and j even, c odd about 1/2."""
        low, high = self.low, self.high
        if self.nu == 0:
            low, high = 1.0 - high, 1.0 - low
        elif self.nu == 2:
            low, high = -high, -low
        return Window(self.quantity, low, high, 1.0 - self.stop, 1.0 - self.start)

    def first_half(self) -> tuple[Window, ...]:
        """The windows on k <= 1/2 that require the same of a symmetric law."""
        if self.stop <= 0.5:
            return (self,)
        if self.start >= 0.5:
            return (self.mirrored(),)
        left = Window(self.quantity, self.low, self.high, self.start, 0.5)
        right = Window(self.quantity, self.low, self.high, 0.5, self.stop)
        return left, right.mirrored()

    @classmethod
    def _from_earlier(cls, data: dict[str, Any]) -> dict[str, Any]:
        for key, pair in (("at", ("start", "stop")), ("value", ("low", "high"))):
            if key in data:
                data |= dict.fromkeys(pair, data.pop(key))
        return data


def via(quantity: str, value: float, *, at: float) -> Window:
    """A value at one k: a via point, or with `via("c", 0, at=0.4)` an inflexion.

    Raises
    ------
    InputError
        If the quantity is unknown, the value not finite or k out of [0, 1].

    Examples
    --------
    >>> via("c", 0, at=0.4).value
    True
    """
    return Window(quantity, value, value, at, at)


def read_window(text: str) -> Window:
    """A window from text: a condition on a, b, c or j, then its range; the whole motion by default.

    >>> read_window("b <= 1.2 @ 0.2..0.3"), read_window("a = 0.3 @ 0.4")
    (Window('b', high=1.2, start=0.2, stop=0.3), via('a', 0.3, at=0.4))
    >>> read_window("-20 <= j <= 20 @ 0").point
    True
    """
    parts = _TEXT.fullmatch(text) if len(text) <= _LONGEST else None
    if parts is None or not (parts["low"] or parts["sign"]) or (parts["low"] and parts["sign"] in {">=", "="}):
        raise InputError(
            'a window is written as "b <= 1.2 @ 0.2..0.3", "0.4 <= a <= 0.6 @ 0.5", "c >= -4" or "a = 0.3 @ 0.4", '
            f"got {shortened(text)}"
        )
    number = {name: float(parts[name]) for name in ("low", "value", "start", "stop") if parts[name] is not None}
    start = number.get("start", 0.0)
    stop = number.get("stop", start if "start" in number else 1.0)
    low = number.get("value", -inf) if parts["sign"] in {">=", "="} else number.get("low", -inf)
    high = number.get("value", inf) if parts["sign"] in {"<=", "="} else inf
    return Window(parts["quantity"], low, high, start, stop)
