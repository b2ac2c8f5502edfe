"""The torque of a slider-crank
============================

Two standard laws, the law of least RMS torque, and the limit of the RMS torque for all laws that never turn back.
"""

import numpy as np
from matplotlib import pyplot as plt

from optlaws import Problem, catalogue, drive_limit, rms, slider_crank, synthesize

press = slider_crank("0.1 m", "0.4 m", bodies={"crank": "0.02 kg m^2", "slider": "5 kg"})
moved = press.dimensionless("0 deg", "180 deg", "0.3 s")
best = synthesize(Problem(order=3, minimise=rms(moved.torque), symmetric=False, monotone=True)).law
laws = {"quintic": catalogue["345"].law, "modified sine": catalogue["modified sine"].law, "degree 9": best}
k = np.linspace(0.0, 1.0, 801)
for name, law in laws.items():
    a, b, c = np.pi * law.a(k), np.pi / 0.3 * law.b(k), np.pi / 0.3**2 * law.c(k)
    plt.plot(np.degrees(a), press.torque(a, b, c), label=f"{name}: {rms(moved.torque).value(law) * moved.unit:.3f} N m")
limit = drive_limit(moved.torque, "rms torque").value * moved.unit
plt.plot([], [], " ", label=f"best possible: {limit:.3f} N m")
plt.xticks(range(0, 181, 30))
plt.xlabel("angle of the crank (deg)")
plt.ylabel("torque at the crank (N m)")
plt.legend(title="RMS torque")
