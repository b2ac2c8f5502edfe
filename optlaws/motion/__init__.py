"""A motion in machine units, below cycles: quantities, laws in their places, exact motions, piecewise polynomials."""
