"""A mass between torsion bars
===========================

The law of the swinging mass cannot be chosen: it follows from the bars and the linkage.
"""

from optlaws import TorsionLever, deg

TorsionLever(beta=0.75, lam=1, rho=0.15, nu=0.15, swing=deg(60)).law().plot()
