"""Mechanisms that balance others: inertial loaders, mechanisms for links that dwell, levers with torsion bars."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(__name__, __file__)
