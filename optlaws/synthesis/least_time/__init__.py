"""The least time of a move: its limits, the search with its proof, and the infimum over laws of any degree."""
