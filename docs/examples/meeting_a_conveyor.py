"""Meeting a conveyor
==================

From rest to half the mean velocity. End conditions may have any values, which are part of the law.
"""

from optlaws import BoundaryConditions, Chebyshev, Problem, synthesize

meeting = BoundaryConditions(start=(0, 0, 0), end=(1, 0.5, 0))
synthesize(Problem(boundary=meeting, symmetric=False, basis=Chebyshev(9))).law.plot()
