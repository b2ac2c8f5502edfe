"""Jobs about balancing mechanisms for dwells."""
