"""The optimisation of a cycle: laws as convex problems, free durations, and bounds of the whole."""
