"""Fronts that are proven at every point: laws and bounds between certified laws, by convexity."""
