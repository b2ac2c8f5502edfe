"""Enclosed extremes over the whole turn: pressure angles, radii of curvature, proof of no undercut."""
