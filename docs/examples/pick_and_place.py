"""Pick and place
==============

Two axes with one clock. The gripper moves across while it is up, and down to pick and to place.
"""

from optlaws import Axes, Dwell, Return, Rise

forth, back = Rise("300 mm", "0.3 s", name="across"), Return("300 mm", "0.3 s", name="back")
up, down = Rise("40 mm", "0.1 s", name="up"), Return("40 mm", "0.1 s", name="down")
x = [Dwell("0.2 s"), forth, Dwell("0.3 s"), back, Dwell()]
z = [Dwell("0.1 s", name="grip"), up, Dwell("0.3 s"), down, Dwell("0.1 s", name="release"), up, Dwell("0.3 s"), down]
Axes({"x": x, "z": z}, period="1.2 s").plot()
