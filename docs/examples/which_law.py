"""Which law to take
=================

A rise of 35 mm in 0.1 s shakes what vibrates at 27 to 33 Hz: acceleration of laws over the vibration that they leave.
Of laws that have no more velocity and jerk than modified sine, none is below the grey line.
"""

from optlaws import Rise, advise

follower = {"frequency": ("27 Hz", "33 Hz"), "damping": 0.05}
advice = advise(Rise("35 mm", "0.1 s"), follower=follower, points=9)
advice.plot()
