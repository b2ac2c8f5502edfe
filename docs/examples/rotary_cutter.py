"""A rotary cross cutter
=====================

The knife moves with the strip while it cuts, and with the least acceleration until the next cut.
"""

from optlaws import ConstantVelocity, Cycle, Free

cut = ConstantVelocity("600 deg/s", "60 ms", name="cut")
Cycle(
    [cut, Free(to="360 deg", name="next length")], period="0.8 s", advance="360 deg", minimise="rms acceleration"
).plot()
