"""Proof that a peak bounded from below can have its bound nowhere in a better law."""
