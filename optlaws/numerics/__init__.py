"""Functions of one variable and numbers: series, roots, enclosures by intervals and Taylor jets. Knows no law."""
