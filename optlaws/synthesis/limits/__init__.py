"""Limits for laws from rest to rest of any degree, in closed form, and the laws that attain them."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(__name__, __file__)
