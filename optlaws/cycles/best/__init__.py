"""What is best of a cycle: its laws as convex problems, its free durations, and what is proven of the whole."""
