"""Functions of one variable, numbers and programs of cones: series, roots, enclosures. Knows no law."""
