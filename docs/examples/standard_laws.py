"""Accelerations of standard laws
==============================

Four laws of the catalogue, by the names that manuals and controllers use.
"""

import numpy as np
from matplotlib import pyplot as plt

from optlaws import catalogue

k = np.linspace(0.0, 1.0, 801)
for name in ("cycloidal", "modified sine", "modified trapezoid", "3-4-5 polynomial"):
    plt.plot(k, catalogue[name].law.c(k), label=name)
plt.xlabel("k (dimensionless time)")
plt.ylabel("acceleration c (dimensionless)")
plt.legend()
