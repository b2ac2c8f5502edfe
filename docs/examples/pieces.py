"""A law of pieces
===============

Z in B-splines: polynomials on eight pieces. The peak acceleration is 10 % above the best possible of its order.
"""

from optlaws import BSplines, Problem, synthesize

synthesize(Problem(B=1.859, order=3, basis=BSplines(8, degree=3))).plot()
