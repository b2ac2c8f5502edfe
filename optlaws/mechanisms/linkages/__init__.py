"""Mechanisms of one degree of freedom between a drive and its load: inertia and load over the input, in SI units."""
