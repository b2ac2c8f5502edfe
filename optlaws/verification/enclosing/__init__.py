"""Numbers, pieces of laws and formulas with every rounding enclosed, for exact rows, laws and bounds."""
