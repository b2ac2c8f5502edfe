"""Balancing cam mechanisms for motions with dwells, of types I, II and III."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(
    __name__,
    {
        "optlaws.mechanisms.dwell.choice": "least_dwell",
    },
)
