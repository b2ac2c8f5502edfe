"""What each further end condition costs
=====================================

61 laws of each order l with Z of degree 9. More end conditions raise C at low B and lower it at high B.
"""

import numpy as np
from matplotlib import pyplot as plt

from optlaws import Chebyshev, ProblemArray, synthesize_array

B = np.linspace(1.4, 2.4, 61)
for order in (2, 3, 4, 5):
    plt.plot(B, synthesize_array(ProblemArray(B=B, order=order, basis=Chebyshev(9))).C, label=f"l = {order}")
plt.xlabel("peak velocity B (dimensionless)")
plt.ylabel("least peak acceleration C (dimensionless)")
plt.legend()
