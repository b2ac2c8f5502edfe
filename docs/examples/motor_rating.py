"""A table by the rating of its motor
==================================

A table with twelve stations: the least acceleration, and the least acceleration within 30 N m RMS.
"""

from optlaws import Cycle, Dwell, Rise

segments = [Rise("30 deg", "250 ms", name="index"), Dwell("550 ms")]
drive = {"inertia": "1.8 kg m^2", "viscous": "0.4 N m s/rad", "dry": "3 N m"}
both = [
    Cycle(segments, period="0.8 s", advance="30 deg", drive=drive, limits=limits)
    for limits in ({}, {"rms torque": "30 N m"})
]
axes = both[0].plot(color="0.7", label=f"{both[0].effort.rms_force:.1f} N m RMS")[0].figure.axes
both[1].plot(axes, label=f"{both[1].effort.rms_force:.1f} N m RMS")
axes[1].legend(loc="upper right")
