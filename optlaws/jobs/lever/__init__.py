"""Jobs about the torsion lever."""
