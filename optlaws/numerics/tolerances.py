"""Tolerances of the whole package by what they mean, each with its reason; shares are of the greatest value around.

Numbers of one meaning and one size are one constant. Where two meanings have the same size they stay two, so that one
can be changed without the other.
"""

from __future__ import annotations

# --- rounding of double precision -----------------------------------------------------------------------------------
ROUNDOFF = 2.0**-53  # a single operation, relative
WAVE_ROUNDING = 8.0 * ROUNDOFF  # sines, cosines and angles as numpy has them
NEGLIGIBLE_TERM = 2.0**-54  # terms of a series that change no sum of the others
EPSILON = 2.0**-52  # leading coefficients and steps below it are rounding of the others
SERIES_ROUNDING = 2.0**-50  # what a resolved Chebyshev series leaves in its last tenth
OPERATIONS_ROUNDING = 2.0**-48  # a few operations one after the other
SMALLEST_CELL = 2.0**-48  # of a place: cells are cut no further
DIFFERENCE_ROUNDING = 2.0**-42  # of two functions: their difference is known to no more

# --- numbers next to nothing, which only keep divisions, roots and logarithms finite ----------------------------------
TINY = 1e-300  # stands for 0 where it is divided by, and rounds enclosures of 0 outward
SMALLEST_SIZE = 1e-200  # a function that is smaller everywhere is 0
NORM_OFFSET = 1e-24  # keeps the slope of a norm finite where it vanishes

# --- what is rounding in results ------------------------------------------------------------------------------------
VALUE_ROUNDING = 1e-12  # a value below this share of the greatest is 0
JUMP = 1e-9  # share of a derivative's greatest value below which it neither jumps at a break nor leaves rest at an end
FLAT_OUTPUT_JUMP = 1e-7  # the same of the derivatives from which a machine's input is computed
AGREEMENT = 1e-9  # share within which two computed numbers are one
CLOSURE = 1e-9  # of a stroke or a turn: what is to close may be open by so much
END_ROUNDING = 1e-14  # of a time: the end of a motion is a sum of lengths
SAME_TIME = 1e-12  # of a duration: times nearer to each other are one
SHORTEST_STRETCH = 1e-12  # a shorter dwell or stretch is none: its ends would be one number
ANGLE_LIMIT = 1e-9  # rad: an angle so far beyond its limit is still within

# --- extremes and roots ---------------------------------------------------------------------------------------------
TIE = 1e-10  # of the greatest magnitude: extremes nearer to each other are as high, and the first of them counts
NEAR_TIE = 1e-7  # of the greatest magnitude: an extreme that is sampled to so little may be as high
EQUAL_EXTREMES = 1e-9  # of the greatest magnitude: extremes that are polished are equal, and the first of them counts
TOP_WIDTH = 1e-4  # of an interval: a smooth top is flat to TIE over about so much
EXTREME_WIDTH = 1e-3  # of the whole: ties nearer to each other are one extreme
CELL_END = 2.0**-10  # of a cell that is sloped: what stays of it at an edge
TOUCHING = 1e-12  # of a function's size: where it turns or jumps so near to a value, it has it
POLISHING_REACH = 1e-3  # of an interval: Newton's steps towards a root go no further
POLISHED = 1e-12  # a step of Newton's method that is the last
EXTREME_POLISHED = 1e-11  # of the whole: a place of an extreme that moves by less is settled
SAME_EXPONENT = 1e-9  # exponents nearer to each other were the same number before they were rounded
QUOTIENT_BLUR = 1e-8  # of the greatest value: quotients of small numbers are rounded more than others
DIFFERENCE_SHARE = 1e-10  # of the greatest difference: to so much it is resolved

# --- how near enclosures come, as shares of the greatest magnitude --------------------------------------------------
CAM_EXTREMES = 1e-10  # pressure angles and radii of curvature
TORQUE_EXTREMES = 1e-8  # torques of a lever's cam
BALANCING_EXTREMES = 1e-7  # torques of a machine that is balanced

# --- resolution of functions by series ------------------------------------------------------------------------------
PANEL_ROUNDING = 2e-15  # of the scale of a root: what its series leaves on a panel
LEAST_ROOT = 1e-9  # of its scale: a root that is smaller is known no worse
SHORTEST_PANEL = 1e-6  # panels of a root are cut no further
VELOCITY_RESOLVED = 1e-14  # of the velocity: what a series may miss anywhere
VELOCITY_ABSORBED = 1e-15  # the same times half the length on which it is missed
MOTION_RESOLVED = 1e-9  # of the whole motion: what a series misses where roots are looked for; Newton does the rest
STRETCH_RESOLVED = 1e-14  # of a stretch: the same where squares are integrated
LOAD_RESOLVED = 1e-10  # of the load on a follower: what a series may miss
BEYOND_CUBIC = 1e-6  # of the load: twice integrated it is what lies beyond a quintic

# --- machines -------------------------------------------------------------------------------------------------------
RESONANCE = 1e-9  # singular value of what a cycle leaves: below it there is no steady motion
VIBRATING = 1e-6  # of a root's size: with a smaller imaginary part, it is a decay that rounding has split in two
SAME_ROOT = 1e-6  # of a root's size: what is no further away is the same vibration
DEFECTIVE = 1e-6  # of a root's size: by how much vectors of a mode may miss it
UNSTABLE = 1e-7  # of the fastest root: what its rounding may be
SETTLED = 1e-9  # of a load: what a static state may miss it by
FEEDTHROUGH = 1e-9  # of what a coefficient is computed from: less is rounding

# --- balancing ------------------------------------------------------------------------------------------------------
SWING_SETTLED = 1e-14  # of a swing: a step of Newton's method that is the last
SWING_RESOLVED = 1e-15  # of a swing: what its last amplitudes leave
SWING_INTEGRATED = 1e-9  # of a swing: amplitudes that are integrated at first
LINKAGE_MET = 1e-9  # a linkage whose equations miss by less is a solution
SAME_LINKAGE = 1e-6  # linkages nearer to each other are one
REAL_ROOT = 1e-7  # of a swing: roots with a smaller imaginary part are real
ANGLE_SHARP = 1e-13  # rad: to so much the place of a loader's peak is found
LOADER_TERM = 1e-13  # of C squared: a smaller product of velocity and jerk is rounding
CONVERGENCE_RADIUS = 1e-3  # of a length: a smaller radius of convergence is of no use
TOP_REACHED = 1e-10  # of B: velocities so near count as B
TOP_STEP = 1e-6  # of a law: the first step along its top
TOP_POINT = 1e-4  # a narrower top is a point: b - B is of the fourth order in it
LOOKS_EQUAL = 1e-4  # of the highest peak in a picture: others that are so near look as high
