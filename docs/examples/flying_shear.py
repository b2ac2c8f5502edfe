"""A flying shear
==============

The shear has the speed of the strip while it cuts, and then returns in time for the next cut.
"""

from optlaws import ConstantVelocity, Cycle, Return

Cycle([ConstantVelocity("1.5 m/s", "80 ms"), Return()], period="400 ms", degree=15).plot()
