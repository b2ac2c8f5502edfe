from .closed_forms import (
    acceleration_limit as acceleration_limit,
    acceleration_limit_at_jerk as acceleration_limit_at_jerk,
    jerk_limit as jerk_limit,
    limit as limit,
    limit_law as limit_law,
    power_limit as power_limit,
    rms_limit as rms_limit,
)
from .drive_limits import DriveLimit as DriveLimit, drive_limit as drive_limit
