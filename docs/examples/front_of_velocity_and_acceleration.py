"""What less peak velocity costs
=============================

A front that is proven at every value, with standard laws beside it.
"""

from optlaws import Chebyshev, Problem, catalogue, proven_front

(line,) = proven_front(Problem(order=3, basis=Chebyshev(9)), between=(1.35, 1.84), gap=1e-4).plot()
for name in ("modified sine", "modified trapezoid", "cycloidal", "simple harmonic"):
    one = catalogue[name].constants
    line.axes.plot(one.B.value, one.C.value, "o", label=name)
line.axes.legend()
