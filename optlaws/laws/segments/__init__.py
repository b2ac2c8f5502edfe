"""Segments of piecewise laws: each kind is one class with exact closed forms."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(__name__, __file__)
