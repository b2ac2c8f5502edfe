"""Limits for laws from rest to rest of any degree, in closed form, and the laws that attain them."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(
    __name__,
    {
        "optlaws.synthesis.limits.closed_forms": (
            "acceleration_limit acceleration_limit_at_jerk limit jerk_limit power_limit rms_limit"
        ),
        "optlaws.synthesis.limits.drive_limits": "DriveLimit drive_limit",
        "optlaws.synthesis.limits.laws": "limit_law",
    },
)
