"""A law that leaves no vibration
==============================

The residual vibration of modified sine, and of a law whose residual is below 0.1 at frequencies from 18 to 22.
"""

import numpy as np
from matplotlib import pyplot as plt

from optlaws import Chebyshev, Problem, at_most, catalogue, residual_vibration, response_spectrum, synthesize

frequencies = np.linspace(8, 40, 2000)
robust = synthesize(
    Problem(order=3, basis=Chebyshev(15), bounds={residual_vibration(frequency=(18, 22)): at_most(0.1)})
).law
for law, name in ((catalogue["modified sine"].law, "modified sine"), (robust, "least C, residual at most 0.1")):
    plt.semilogy(frequencies, response_spectrum(law, frequencies).residual_acceleration, label=name)
plt.ylim(1e-2, None)
plt.xlabel("frequency, radians of the free vibration in the rise")
plt.ylabel("residual acceleration (dimensionless)")
plt.legend()
