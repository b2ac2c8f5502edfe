"""Internals of `optlaws.numerics` that tests look at by themselves."""

from optlaws.numerics import bernstein, chebyshev
from optlaws.numerics.bernstein import greatest_difference
from optlaws.numerics.branch_and_bound import extremes as extremes_of_branch_and_bound
from optlaws.numerics.branch_and_bound import integral as integral_of_integral
from optlaws.numerics.chebyshev import nodes
from optlaws.numerics.cones import conic_optimum
from optlaws.numerics.exact import chebyshev_from_powers, powers_from_chebyshev
from optlaws.numerics.interval import Interval, bearing, between, dot, exact
from optlaws.numerics.panels import Panels, of_waves, resolved
from optlaws.numerics.peaks import extremes as extremes_of_peaks
from optlaws.numerics.peaks import highest, peak, polished
from optlaws.numerics.roots import bisect, bracketed_root, bracketed_roots, sign_changes
from optlaws.numerics.splines import Ends, hermite_powers, linear_powers, spline_powers
from optlaws.numerics.taylor import Jet, Pair, variable
