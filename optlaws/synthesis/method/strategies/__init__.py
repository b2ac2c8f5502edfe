"""Strategies of the cutting-plane loop: vertices, interior points, quadratic programs."""
