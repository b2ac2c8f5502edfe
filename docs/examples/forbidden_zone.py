"""A forbidden zone
================

The law is not above 0.2 before k = 0.4 and not below 0.75 after 0.6, because something else moves past.
"""

from optlaws import Chebyshev, Problem, Window, synthesize

windows = (Window("a", high=0.2, start=0.0, stop=0.4), Window("a", low=0.75, start=0.6, stop=1.0))
synthesize(Problem(order=3, basis=Chebyshev(15), symmetric=False, windows=windows)).plot()
