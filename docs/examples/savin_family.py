"""A family of laws
================

Savin's family III: the more acceleration is near the ends, the lower is the peak velocity.
"""

import numpy as np
from matplotlib import pyplot as plt

from optlaws import savin

k = np.linspace(0.0, 1.0, 401)
for alpha in (-6, 0, 6, 12):
    plt.plot(k, savin("III", alpha).c(k), label=f"alpha = {alpha}")
plt.xlabel("k (dimensionless time)")
plt.ylabel("acceleration c (dimensionless)")
plt.legend()
