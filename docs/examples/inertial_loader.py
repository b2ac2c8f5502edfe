"""An inertial loader
==================

A second mass gives off the energy that the first one takes up: the sum of their energies is constant.
"""

import numpy as np
from matplotlib import pyplot as plt

from optlaws import catalogue, inertial_loader

balanced = inertial_loader(catalogue["cycloidal"].law)
k = np.linspace(0.0, 1.0, 801)
plt.plot(k, balanced.executive.b(k), label="executive link")
plt.plot(k, balanced.law.b(k), "--", label="loader")
plt.xlabel("k (dimensionless time)")
plt.ylabel("velocity b (dimensionless)")
plt.legend()
