"""A disc cam
==========

The profile and the path of the roller's centre, for a cycle and a prime radius.
"""

import numpy as np
from matplotlib import pyplot as plt

from optlaws import Cycle, Dwell, Return, Rise
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.rollers import TranslatingRoller

cycle = Cycle([Rise("35 mm", "120 deg"), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()], speed="200 rpm")
cam = DiscCam(cycle, prime_radius="60 mm", follower=TranslatingRoller("12 mm"))
angles = np.linspace(0.0, 2 * np.pi, 721)
for curve, style, name in ((cam.profile, "-", "profile"), (cam.pitch_curve, "--", "roller's centre")):
    plt.plot(*(1e3 * curve(angles)).T, style, label=name)
plt.axis("equal")
plt.xlabel("x (mm)")
plt.ylabel("y (mm)")
plt.legend()
