"""What numbers of a solution are compared with: each tolerance once, and what it is a share of.

Programs are solved in units in which their numbers are near 1, so that a tolerance without a share is one of 1.
"""

from __future__ import annotations

# rows and residuals

#: of a right side, or of 1: a residual beyond this is an excess, and its extremum a contact that is missing
EXCESS = 1e-10
#: of a right side, or of 1: extrema within this of binding join the points that are held
NEARLY_BINDING = 1e-2
#: what an extremum's residual may be below that of a point on its hill: rounding in the value of a series
SAME_HEIGHT = 1e-9
#: of a row: one that is shorter says nothing, as b >= 0 does at rest, and is not divided by its length
EMPTY_ROW = 1e-13
#: amplitudes that are minimised vanish if their sum is less
VANISHED = 1e-13

# places

#: of u: contacts nearer than this are one, as IPOPT's tolerance may show two where there is one
SAME_PLACE = 1e-6

# multipliers

#: of the greatest multiplier: one that is more negative pulls, and its contact is dropped
PULLING = 1e-10
#: of the greatest multiplier, in an answer of IPOPT: what is less may be its barrier's, not a contact's
WEIGHTLESS = 1e-7
#: of the greatest multiplier, at a vertex: what is less is rounding, as a vertex has no barrier
WEIGHTLESS_AT_VERTEX = 1e-13

# variables

#: coordinates beyond this are no law of the field: the solver has lost its way
LOST = 1e7
