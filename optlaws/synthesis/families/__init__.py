"""Constraints that hold at every k, and their semi-infinite programs."""
