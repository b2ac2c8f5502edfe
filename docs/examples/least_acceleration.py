"""The law of least acceleration
=============================

At a given peak velocity, with the bounds of its problem and the best possible of its order.
"""

from optlaws import Chebyshev, Problem, synthesize

solution = synthesize(Problem(B=1.8, order=4, basis=Chebyshev(15)))
solution.plot()
