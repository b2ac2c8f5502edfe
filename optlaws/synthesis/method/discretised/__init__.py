"""Subproblems: a program discretised on finitely many points, and the solvers of these."""
