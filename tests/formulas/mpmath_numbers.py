"""The arithmetic of mpmath's numbers, at the precision at work, that values of formulas are held against."""

import mpmath  # type: ignore[import-untyped] # ships no types

from tests.internals.formulas import SMOOTH_FUNCTIONS, Arithmetic

MPMATH = Arithmetic(
    mpmath.mpf,
    {
        **{name: getattr(mpmath, name) for name in SMOOTH_FUNCTIONS},
        "abs": abs,
        "max": max,
        "min": min,
        "norm": mpmath.hypot,
    },
    lambda base, exponent: base**exponent,
)
