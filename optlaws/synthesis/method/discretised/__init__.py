"""A program on finitely many points, and its solvers."""
