"""What an elastic follower does
=============================

The mass deviates from the motion of its cam, and goes on vibrating in the dwell.
"""

import numpy as np
from matplotlib import pyplot as plt

from optlaws import Follower, catalogue

law = catalogue["modified sine"].law
response = Follower(frequency=20, damping=0.02).response(law)
k = np.linspace(0.0, 1.6, 1601)
plt.plot(k[k <= 1], law.c(k[k <= 1]), "--", label="cam")
plt.plot(k, response.c(k), label="mass, frequency 20")
plt.xlabel("k (dimensionless time; the dwell begins at 1)")
plt.ylabel("acceleration (dimensionless)")
plt.legend()
