"""Tolerances that several modules share, each with its reason; shares are of the greatest value nearby.

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

# --- numbers next to nothing, which only keep divisions, roots and logarithms finite ----------------------------------
TINY = 1e-300  # stands for 0 where it is divided by, and rounds enclosures of 0 outward
SMALLEST_SIZE = 1e-200  # a function that is smaller everywhere is 0

# --- what is rounding in results ------------------------------------------------------------------------------------
VALUE_ROUNDING = 1e-12  # a value below this share of the greatest is 0
JUMP = 1e-9  # share of a derivative's greatest value below which it neither jumps at a break nor leaves rest at an end
AGREEMENT = 1e-9  # share within which two computed numbers are one
CLOSURE = 1e-9  # of a stroke or a turn: what is to close may be open by so much
FEASIBILITY = 1e-10  # of a limit, by which a law may miss it
CAM_FEASIBILITY = 1e-7  # of a limit of a cam, by which the rounding of its law may break it
SAME_TIME = 1e-12  # of a duration: times nearer to each other are one
INSIDE_PIECE = 1e-13  # of a piece: so far inside of an end derivatives are those of the piece
BEFORE_BREAK = 1e-9  # of a piece: so far before a break an outline has not yet the derivatives of what follows
SHORTEST_STRETCH = 1e-12  # a shorter dwell or stretch is none: its ends would be one number
RADIUS_ROUNDING = 1e-12  # m: by so much arcs of a circle are off by themselves
SHOWN_DIGITS = 1e-8  # numbers of two files that are equal to so much say the same: tables show eight digits

CYCLE_ROUNDING = 1e-11  # of a peak of a cycle: less is shown as 0
FORCE_ROUNDING = 1e-7  # of the greatest force, or of a turn: less is shown as 0
NO_MARK = 1e-9  # of the greater extreme of a curve: one that is less is rounding, and no mark stands at it
EQUALLY_GOOD = 0.01  # of an objective: laws so little above the least are equally good to a designer
BOUND_SLACK = 1e-6  # of a least value: at a bound so much above it the solver has room
BARRIER = 1e-7  # of the greatest multiplier: what is less may be a barrier's, not a contact's

# --- extremes and roots ---------------------------------------------------------------------------------------------
TIE = 1e-10  # of the greatest magnitude: extremes nearer to each other are as high, and the first of them counts
EQUAL_EXTREMES = 1e-9  # of the greatest magnitude: extremes that are polished are equal, and the first of them counts
TOUCHING = 1e-12  # of a function's size: where it turns or jumps so near to a value, it has it
POLISHING_REACH = 1e-3  # of an interval: Newton's steps towards a root go no further
SAME_EXPONENT = 1e-9  # exponents nearer to each other were the same number before they were rounded

# --- how near enclosures come, as shares of the greatest magnitude --------------------------------------------------
FORCE_EXTREMES = 1e-8  # contact forces and torques
DEVIATIONS = 1e-3  # deviations from an outline

# --- resolution of functions by series ------------------------------------------------------------------------------
LIMIT_ROUNDING = 2.0**-44  # of a limit: what roots and products of a few numbers are rounded by, EXP and LN too
RUN_TIME_RANGE = 2.0**-100  # of quantities at run time, in any unit: from it to its reciprocal no product overflows

# --- machines -------------------------------------------------------------------------------------------------------
RESONANCE = 1e-9  # singular value of what a cycle leaves: below it there is no steady motion
VIBRATING = 1e-6  # of a root's size: with a smaller imaginary part, it is a decay that rounding has split in two
SAME_ROOT = 1e-6  # of a root's size: what is no further away is the same vibration

# --- cams and cycles ------------------------------------------------------------------------------------------------
SIZE_BRACKET = 1e-8  # of a radius: width of the bracket of a least size
CYCLE_OPTIMALITY = 1e-7  # share within which an objective meets the bound of the whole cycle
FASTER = 1e-6  # of a least time: in so much less no law is proven to keep the limits
LEAST_SCALE_MET = 1e-9  # of a least time: Newton's method goes no further
LEAST_SHARE = 1e-3  # of a limit: what is so easily met says little of where it is not
BINDING_LIMIT = 1e-7  # of a time: limits that need so nearly as much bind as well
DURATION_STEP = 1e-4  # of a duration, for the slope of a mean square whose shape changes with it

# --- synthesis: programs, proofs and fronts --------------------------------------------------------------------------
ROW_ROUNDING = 4.0 * ROUNDOFF  # of the sum of the sizes of a row's parts: what rounding may hide of the row
AT_END = 1e-8  # of u: a stationary point that rounding has moved off an end is that end
LEAST_ENERGY = 1e-12  # of a square: keeps the slopes of roots finite
ENERGY_ROUNDING = 1e-13  # of a peak: by so much an energy's row is moved inward
RULES_AGREE = 1e-13  # of a sum: what two rules of integration in a row may differ by
BESIDE_BREAK = 2.0**-50  # of k: far enough from a break to tell its side
SIZE_RANK = 1e-12  # of the greatest singular value of rows that determine a law: less is rounding
DEPENDENT_ROWS = 1e-11  # rows of length 1 that are nearer to depending on each other are taken to do so
STEP_SETTLED = 1e-11  # of the greatest variable: a quadratic step that is less ends the search
EXCESS = 1e-10  # of a right side, or 1: a residual beyond this is an excess, and its extremum a contact that is missing
EMPTY_ROW = 1e-13  # of a row: one that is shorter says nothing, as b >= 0 at rest, and is not divided by its length
SAME_PLACE = 1e-6  # of u: contacts nearer than this are one, as IPOPT's tolerance may show two where there is one
BOUND_FEASIBILITY = 1e-9  # of a bound: by so much a law may break a constraint and still meet it
BENEATH_ROUNDING = 2.0**-44  # of what values and slopes amount to: more than they are rounded by
AWAY_FROM_REST = 1e-6  # of B: a velocity nearer to zero bounds no acceleration worth mentioning
LEAST_TIME_GAP = 1e-6  # of a least time: shorter ones by this are proven to be too short
LEAST_TIME_MET = 1e-10  # of a least time: a time so near to one that is too short is the least
OPTIMALITY_GAP = 1e-8  # what a bound may leave of the objective and still be said to meet it
NO_OBJECTIVE = 1e-6  # of an objective's scale: one that is zero but for rounding is measured by that
MIRROR = 1e-12  # of k: breaks whose mirror images are nearer are symmetric
STORED_VALUE = 1e-9  # of a value or a bound: what another machine may round otherwise

# --- verification, in exact arithmetic and balls ---------------------------------------------------------------------
COEFFICIENT_ROUNDING = 2.0**-44  # of what a derivative is made of: what rounding of the coefficients can do to it
STATED_BOUND = 1e-9  # of a bound: by so much one that was computed in doubles may be above the proven one
SAME_FREQUENCY = 1e-9  # of a root's size: vibrations that differ by no more have no numbers of their own
TAYLOR_REST = 2.0**-80  # of a function: what a Taylor polynomial may leave of it

# --- limits in the phase plane --------------------------------------------------------------------------------------
INTEGRATION = 1e-9  # of a time or a value: what integrating a motion in cells may be off
PHASE_GAP = 1e-5  # of a limit in the phase plane: a potential that leaves no more needs no more fall
WINDOW_EDGE = 1e-9  # of the stroke: so far within a window the places of a conic program begin that are bounded

# --- interlocks of axes ----------------------------------------------------------------------------------------------
PASS_WIDTH = 1e-13  # of a cycle: times of a pass that are nearer to each other are one
INTERLOCK = 1e-9  # of a stroke: positions that are nearer touch, and what touches is clear
CLEARANCE_SHARE = 1e-9  # of the greatest clearance: how near its bound comes to the least one
