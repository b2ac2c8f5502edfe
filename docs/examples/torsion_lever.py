"""A mass between torsion bars
===========================

Which law a mass swings by is no longer chosen: it follows from bars and linkage.
"""

from optlaws import TorsionLever, deg

TorsionLever(beta=0.75, lam=1, rho=0.15, nu=0.15, swing=deg(60)).law().plot()
