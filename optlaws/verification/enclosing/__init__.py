"""Numbers, pieces of laws and formulas with every rounding enclosed: what exact rows, laws and bounds are made of."""
