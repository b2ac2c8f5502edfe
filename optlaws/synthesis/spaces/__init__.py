"""The laws of a problem as a linear space: end conditions, bases, coordinates, rows; polynomials, pieces, splines."""
