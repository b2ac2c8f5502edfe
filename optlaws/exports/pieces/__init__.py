"""Motions as few polynomials: those of their laws, exactly, or near ones, and how near."""
