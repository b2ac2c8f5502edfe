"""Problem -> semi-infinite program, and what a law is worth to a problem."""
