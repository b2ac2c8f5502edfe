"""Motions as source code that evaluates them: Structured Text and C99, with proven bounds of the rounding errors."""
