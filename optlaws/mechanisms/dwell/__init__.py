"""Balancing cam mechanisms for motions with dwells, of types I, II and III."""

from optlaws.mechanisms.dwell.choice import least_dwell

__all__ = ["least_dwell"]
