"""Motion laws: their definitions, their values and their peaks. Imports no optimiser."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(__name__, __file__)
