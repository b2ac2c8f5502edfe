"""The cam-lever mechanism with torsion bars: its linkage, its bars, its motion, its design."""
