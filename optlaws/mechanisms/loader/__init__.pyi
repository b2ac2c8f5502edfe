# made by tests/contracts/faces.py from the table in __init__.py
from optlaws.mechanisms.loader.limits import loader_acceleration_limit as loader_acceleration_limit
from optlaws.mechanisms.loader.limits import loader_power_limit as loader_power_limit
from optlaws.mechanisms.loader.limits import loader_velocity_limit as loader_velocity_limit

__all__ = [
    "loader_acceleration_limit",
    "loader_power_limit",
    "loader_velocity_limit",
]
