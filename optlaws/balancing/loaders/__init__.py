"""Inertial loaders: their laws, their limits, and the executive laws that are best for a loader."""
