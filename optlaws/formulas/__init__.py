"""Formulas as text: read into trees, never executed; evaluated by any arithmetic, differentiated, judged by rules."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(__name__, __file__)
