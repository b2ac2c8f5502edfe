"""Specification of laws: constants, their ranges and mixtures, windows, and the problem."""
