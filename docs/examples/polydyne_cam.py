"""A cam designed for its elastic follower
=======================================

At the design frequency the mass moves by the law without residual vibration; with a frequency 10 % off it vibrates.
"""

import numpy as np
from matplotlib import pyplot as plt

from optlaws import Follower, polydyne, savin

cam = polydyne(savin("III", 7.2), frequency=20)
k = np.linspace(0.0, 1.5, 1501)
for frequency in (18, 20, 22):
    plt.plot(k, Follower(frequency=frequency).response(cam).c(k), label=f"mass, frequency {frequency}")
plt.xlabel("k (dimensionless time; the dwell begins at 1)")
plt.ylabel("acceleration (dimensionless)")
plt.legend()
