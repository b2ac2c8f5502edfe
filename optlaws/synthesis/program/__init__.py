"""The semi-infinite program of a problem, and the value of a law for a problem."""
