"""Axes of one clock that must not collide: the conditions on their positions, and their proofs."""
