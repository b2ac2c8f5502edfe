"""The law of least power
======================

The power of a mass is d = b c. Its least peak is far below that of the law of least acceleration.
"""

import numpy as np
from matplotlib import pyplot as plt

from optlaws import Problem, synthesize

k = np.linspace(0.0, 1.0, 801)
for name in ("C", "D"):
    law = synthesize(Problem(B=1.641, order=4, minimise=name)).law
    plt.plot(k, law.d(k), label=f"least {name}: D = {law.constants.D.value:.4g}")
plt.xlabel("k (dimensionless time)")
plt.ylabel("power d = b c (dimensionless)")
plt.legend()
