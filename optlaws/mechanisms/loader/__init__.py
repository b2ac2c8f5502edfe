"""Inertial loaders: their laws, their limits, and executive laws made for their sake."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(
    __name__,
    {
        "optlaws.mechanisms.loader.limits": "loader_acceleration_limit loader_power_limit loader_velocity_limit",
    },
)
