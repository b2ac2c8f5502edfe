"""Arithmetic that encloses every rounding: laws, rows and bounds, exact or in balls."""
