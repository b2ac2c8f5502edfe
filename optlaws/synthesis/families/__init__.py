"""Constraints that hold at every k, and the semi-infinite programs made of them."""
