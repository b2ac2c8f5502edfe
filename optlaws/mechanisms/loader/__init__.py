"""Inertial loaders: their laws, their limits, and executive laws made for their sake."""

from optlaws.mechanisms.loader.limits import loader_acceleration_limit, loader_velocity_limit

__all__ = ["loader_acceleration_limit", "loader_velocity_limit"]
