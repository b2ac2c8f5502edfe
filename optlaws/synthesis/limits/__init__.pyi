# made by tests/contracts/faces.py from the table in __init__.py
from optlaws.synthesis.limits.closed_forms import acceleration_limit as acceleration_limit
from optlaws.synthesis.limits.closed_forms import acceleration_limit_at_jerk as acceleration_limit_at_jerk
from optlaws.synthesis.limits.closed_forms import jerk_limit as jerk_limit
from optlaws.synthesis.limits.closed_forms import limit as limit
from optlaws.synthesis.limits.closed_forms import power_limit as power_limit
from optlaws.synthesis.limits.closed_forms import rms_limit as rms_limit
from optlaws.synthesis.limits.drive_limits import DriveLimit as DriveLimit
from optlaws.synthesis.limits.drive_limits import drive_limit as drive_limit
from optlaws.synthesis.limits.laws import limit_law as limit_law

__all__ = [
    "DriveLimit",
    "acceleration_limit",
    "acceleration_limit_at_jerk",
    "drive_limit",
    "jerk_limit",
    "limit",
    "limit_law",
    "power_limit",
    "rms_limit",
]
