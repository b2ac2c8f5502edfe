"""Laws in the phase plane of a drive
==================================

Velocities of a slider-crank over its position: with a higher degree the least peak torque approaches the proven limit.
"""

import numpy as np
from matplotlib import pyplot as plt

from optlaws import Chebyshev, Problem, drive_limit, peak, slider_crank, synthesize

press = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
torque = press.dimensionless("0 deg", "180 deg", "0.3 s").torque
k = np.linspace(0.0, 1.0, 801)
plt.plot(k, drive_limit(torque).velocity(k), "k:", zorder=3, label="best possible")
for degree, color in ((9, "#74add1"), (13, "#2166ac"), (19, "#08306b")):
    problem = Problem(order=3, basis=Chebyshev(degree), minimise=peak(torque), symmetric=False, monotone=True)
    best = synthesize(problem)
    label = f"degree {degree}: peak torque {best.gap:.1%} above the limit"
    plt.plot(best.law.a(k), best.law.b(k), color=color, label=label)
plt.ylim(0.9, 1.45)
plt.xlabel("position a (dimensionless)")
plt.ylabel("velocity b (dimensionless)")
plt.legend(loc="lower center")
