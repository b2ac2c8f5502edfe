"""The least time of a move: its limits, the search with its proof, and what no law of any degree is faster than."""
