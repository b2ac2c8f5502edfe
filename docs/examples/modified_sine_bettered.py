"""Better than modified sine
=========================

The least peak acceleration under the peak velocity and the peak jerk of modified sine.
"""

from optlaws import Chebyshev, Comparison, Problem, at_most, catalogue, synthesize

sine = catalogue["modified sine"].law
B, J = sine.constants.B.value, sine.constants.J.value
best = synthesize(Problem(B=B, J=at_most(J), order=3, basis=Chebyshev(41))).law
Comparison({"modified sine": sine, "least C under its B and J": best}).plot()
