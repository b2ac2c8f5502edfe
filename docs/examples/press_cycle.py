"""A whole cycle
=============

Rise, dwell, return and dwell in units of the machine, with a limit of the velocity.
"""

from optlaws import Cycle, Dwell, Return, Rise

segments = [Rise("35 mm", "120 deg"), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()]
Cycle(segments, speed="200 rpm", limits={"velocity": "616 mm/s"}).plot()
