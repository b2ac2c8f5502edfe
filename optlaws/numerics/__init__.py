"""Numbers and functions of one variable: series, roots, bisection, enclosures, tolerances. Knows no law."""
