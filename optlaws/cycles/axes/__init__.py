"""Several axes of one clock that must not collide: cycles, conditions on their positions, and their proofs."""
