"""The synthesis of optimal laws: problems, their solution by Clarabel or IPOPT, lower bounds and limits."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(__name__, __file__)
