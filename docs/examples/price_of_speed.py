"""The price of speed
==================

Least RMS acceleration and least jerk over the time of a move. No law lies below the shaded bands, at any time.
"""

import matplotlib.pyplot as plt

from optlaws import Problem, fastest, time_front

limits = {"velocity": "1 m/s", "acceleration": ("-8 m/s^2", "12 m/s^2"), "jerk": "300 m/s^3"}
move = fastest(Problem(order=3), stroke="100 mm", limits=limits)
_, panels = plt.subplots(2, 1, sharex=True, figsize=(6.4, 5.6), layout="constrained")
for axes, name in zip(panels, ("rms acceleration", "jerk"), strict=True):
    time_front(move, name, longest="0.34 s", points=12).plot(axes)
    axes.legend()
panels[0].set_xlabel("")
