"""Standard laws by their names and codes, with published constants."""
