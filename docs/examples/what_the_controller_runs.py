"""What a controller executes
==========================

A controller interpolates between the points of a table. With few points the executed motion has a high jerk.
"""

import numpy as np
from matplotlib import pyplot as plt

from optlaws import Cycle, Dwell, Return, Rise

cycle = Cycle([Rise("35 mm", "120 deg"), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()], speed="200 rpm")
points = np.arange(13, 182, 12)
for table in ("codesys-xyva", "codesys-xy"):
    reports = [cycle.export(table, points=int(count)).report for count in points]
    plt.plot(points, [report.ratio(2) for report in reports], "o-", label=table)
plt.xlabel("points of the table")
plt.ylabel("peak acceleration, as run over as designed")
plt.legend()
