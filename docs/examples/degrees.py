"""How near laws come to the limit
===============================

Laws of least acceleration with Z of higher and higher degree, and the limit for all laws from rest to rest.
"""

import numpy as np
from matplotlib import pyplot as plt

from optlaws import Chebyshev, ProblemArray, acceleration_limit, synthesize_array

B = np.linspace(1.4, 2.4, 61)
for degree in (3, 9, 21):
    plt.plot(B, synthesize_array(ProblemArray(B=B, order=4, basis=Chebyshev(degree))).C, label=f"degree {degree}")
plt.plot(B, [acceleration_limit(value) for value in B], "k:", label="best possible")
plt.xlabel("peak velocity B (dimensionless)")
plt.ylabel("least peak acceleration C (dimensionless)")
plt.legend()
