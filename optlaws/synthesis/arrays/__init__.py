"""Parametric continuation: many problems that differ in numbers alone are solved and certified together, as arrays."""
