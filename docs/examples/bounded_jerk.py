"""Less jerk, more acceleration
============================

Laws of least C under three bounds of J.
"""

from dataclasses import replace

from optlaws import Chebyshev, Comparison, Problem, at_most, synthesize

problem = Problem(B=1.8, order=3, basis=Chebyshev(21))
laws = {f"J at most {J}": synthesize(replace(problem, J=at_most(J))).law for J in (60, 100, 400)}
Comparison(laws).plot()
