"""The law of least acceleration
=============================

At a given peak velocity, with the limits of its problem and the one that no law can beat.
"""

from optlaws import Chebyshev, Problem, synthesize

solution = synthesize(Problem(B=1.8, order=4, basis=Chebyshev(15)))
solution.plot()
