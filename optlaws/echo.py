"""The display of given values in errors: shortened where they are long."""

from __future__ import annotations

from reprlib import Repr
from typing import Any

LONGEST = 2000


class _Echo(Repr):
    """Values as errors show them: bounded in length and in depth, whatever they are."""

    def __init__(self) -> None:
        super().__init__()
        self.maxlevel, self.maxstring, self.maxother, self.maxlong = 3, 80, 120, 40
        self.maxlist = self.maxtuple = self.maxdict = self.maxset = self.maxarray = 12

    def repr_int(self, x: int, level: int) -> str:
        if x.bit_length() > 400:
            return f"{'-' if x < 0 else ''}an integer of {x.bit_length()} bits"
        return super().repr_int(x, level)

    def repr_instance(self, x: object, level: int) -> str:
        try:
            if type(x).__module__ == "numpy" and hasattr(x, "tolist"):
                return self._of_numpy(x, level)
            return super().repr_instance(x, level)
        except (RecursionError, ValueError, OverflowError, MemoryError):
            return f"<{type(x).__name__}>"

    def _of_numpy(self, x: Any, level: int) -> str:
        """An array or a number of numpy as plain lists and numbers, of which no more are made than are shown."""
        some = x[(slice(0, self.maxlist + 1),) * x.ndim].tolist() if x.ndim else x.item()
        return self.repr1(some, level)


_ECHO = _Echo()


def shortened(value: object) -> str:
    """The repr of a value, shortened where it is long or deep, for the text of an error.

    Examples
    --------
    >>> shortened([1, 2.5]), shortened(10**400)
    ('[1, 2.5]', 'an integer of 1329 bits')
    >>> import numpy as np
    >>> shortened(np.array([[1.5, 2.0]])), shortened(np.float64(3.0))
    ('[[1.5, 2.0]]', '3.0')
    """
    return _ECHO.repr(value)


def cut(text: str, most: int = LONGEST) -> str:
    r"""The text as it can be stored and printed anywhere: not longer than `most`, its surrogates escaped.

    Examples
    --------
    >>> cut("0123456789", most=5), cut("a" + chr(0xD800))
    ('01...', 'a\\ud800')
    """
    short = text if len(text) <= most else f"{text[: most - 3]}..."
    plain = short.encode("utf-8", "backslashreplace").decode("utf-8")
    return text if plain == text else plain  # a sentence stays one
