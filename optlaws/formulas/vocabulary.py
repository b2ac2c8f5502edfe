"""The names that formulas of a motion may have."""

from __future__ import annotations

#: orders of the derivatives of the law, by name
ORDERS = {"a": 0, "b": 1, "c": 2, "j": 3}
#: these, the power d = b c and the dimensionless time k
VOCABULARY = ("a", "b", "c", "d", "j", "k")
