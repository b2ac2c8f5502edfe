"""What less peak power costs
==========================

Laws of least D at given C; D is not convex, so each is the best of several starts.
"""

from optlaws import Chebyshev, Problem, pareto_front

front = pareto_front(Problem(order=4, basis=Chebyshev(9)), over=("C", "D"), points=25)
front.plot(marker="o", markersize=3)
