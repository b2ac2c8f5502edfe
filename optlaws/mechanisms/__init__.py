"""Laws in machines: elastic followers, their response spectra and cams; linear machines."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(__name__, __file__, removed={"deg": "take optlaws.deg"})
