"""Strategies of the cutting-plane loop: Newton's method on contacts, vertices, interior points, quadratic programs."""
