"""Functions of one variable: Chebyshev series, sums of powers, their roots and peaks. Knows no law."""
