"""What no law of any degree can beat, in closed form, and the laws that attain it."""

from optlaws.synthesis.limits.closed_forms import (
    acceleration_limit,
    acceleration_limit_at_jerk,
    jerk_limit,
    limit,
    power_limit,
    rms_limit,
)
from optlaws.synthesis.limits.laws import limit_law

__all__ = [
    "acceleration_limit",
    "acceleration_limit_at_jerk",
    "jerk_limit",
    "limit",
    "limit_law",
    "power_limit",
    "rms_limit",
]
