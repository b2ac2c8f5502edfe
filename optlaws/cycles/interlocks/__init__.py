"""Axes of one clock that must not meet: what is asked of their positions, and what is proven of it."""
