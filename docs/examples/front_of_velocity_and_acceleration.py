"""What less peak velocity costs
=============================

A front that is proven at every value, with standard laws beside it.
"""

from optlaws import Chebyshev, Problem, catalogue, proven_front

line, *_ = proven_front(Problem(order=3, basis=Chebyshev(9)), between=(1.35, 1.84), gap=1e-4).plot()
for name in ("modified sine", "modified trapezoid", "cycloidal", "simple harmonic"):
    constants = catalogue[name].constants
    line.axes.plot(constants.B.value, constants.C.value, "o", label=name)
line.axes.legend()
