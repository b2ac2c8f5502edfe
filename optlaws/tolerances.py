"""Tolerances of the whole package by their meaning, each with its reason; shares are of the greatest value nearby.

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
POSITION_ROUNDING = 2.0**-50  # of a stroke: positions whose differences make a higher derivative
OPERATIONS_ROUNDING = 2.0**-48  # a few operations one after the other
SMALLEST_CELL = 2.0**-48  # of a place: cells are cut no further
TABLE_ROUNDING = 2.0**-46  # of a column of a table: less is printed as 0
DIFFERENCE_ROUNDING = 2.0**-42  # of two functions: their difference is known to no more
FORMULA_ROUNDING = 2.0**-40  # of what the value and the slopes of a formula amount to

# --- numbers next to nothing, which only keep divisions, roots and logarithms finite ----------------------------------
TINY = 1e-300  # stands for 0 where it is divided by, and rounds enclosures of 0 outward
SMALLEST_SIZE = 1e-200  # a function that is smaller everywhere is 0
SLOWEST_FREQUENCY = 1e-150  # of a sine: below it the sides of a swing overflow
SMALLEST_ANGLE = 1e-100  # a pressure angle below it is none
SMALLEST_RATIO = 1e-30  # of two ends of a power: below it a power may overflow
NORM_OFFSET = 1e-24  # keeps the slope of a norm finite where it vanishes
SMALLEST_SPEED = 1e-9  # of a place on an outline, so that shares of it can be taken

# --- what is rounding in results ------------------------------------------------------------------------------------
VALUE_ROUNDING = 1e-12  # a value below this share of the greatest is 0
JUMP = 1e-9  # share of a derivative's greatest value below which it neither jumps at a break nor leaves rest at an end
JUMP_OF_LOWER = 1e-13  # the same as a share of a lower derivative: uniform motion has c = 0 but for it
FLAT_OUTPUT_JUMP = 1e-7  # the same of the derivatives from which a machine's input is computed
AGREEMENT = 1e-9  # share within which two computed numbers are one
NEAR_LIMIT = 0.25  # of the limit of a drive: of a law that is so near it no other starts are tried
CLOSURE = 1e-9  # of a stroke or a turn: what is to close may be open by so much
FEASIBILITY = 1e-10  # of a limit, by which a law may miss it
CAM_FEASIBILITY = 1e-7  # of a limit of a cam, by which the rounding of its law may break it
THROUGH_POINTS = 1e-7  # of the stroke, by which a law misses its points
END_ROUNDING = 1e-14  # of a time: the end of a motion is a sum of lengths
SAME_TIME = 1e-12  # of a duration: times nearer to each other are one
INSIDE_PIECE = 1e-13  # of a piece: so far inside of an end derivatives are those of the piece
BEFORE_BREAK = 1e-9  # of a piece: so far before a break an outline has not yet the derivatives of what follows
SHORTEST_STRETCH = 1e-12  # a shorter dwell or stretch is none: its ends would be one number
RADIUS_ROUNDING = 1e-12  # m: by so much arcs of a circle are off by themselves
ANGLE_LIMIT = 1e-9  # rad: an angle so far beyond its limit is still within
PROGRAM_ROUNDING = 1e-10  # of the forces: by so much the best spring for some angles may miss what these need
SPRING_SETTLED = 1e-9  # of a greatest force: that of the best spring for some angles is met everywhere to so much
SPRING_LIFT = 1e-9  # of the stroke: below so much no stiffness adds a force
PROGRAM_SLACK = 1e-7  # of the forces: to so much a spring keeps to what is needed everywhere
SHOWN_DIGITS = 1e-8  # numbers of two files that are equal to so much say the same: tables show eight digits
FILE_NOISE = 1e-9  # numbers of two files that differ by less say the same: a gap of 1e-10 is as good as one of 1e-9
PEAK_PLACE = 1e-6  # of k: the place of a smooth peak is known to the root of rounding alone
DRAWN_GAP = 1e-4  # of an objective: a gap that no picture shows
BESIDE_POINT = 1e-6  # of the time between two points of a front: so near to one what is drawn is what holds between
SHOWN_RESIDUAL = 1e-4  # of the greatest residual: what a logarithmic picture still shows
RESIDUAL_ROUNDING = 1e-12  # of the vibration of a step: a residual that is less is rounding
LOOKS_EQUAL = 1e-4  # of the highest peak: others so near look as high in a picture, and the first of them is marked
WHOLE_NUMBER = 1e-6  # a number of a controller so near to a whole one is meant to be whole
EXACT_DIGITS = 1e-8  # of the stroke: a table whose last digit is less is taken as exact
DECADIC_STEP = 1e-4  # the last digit that an ISG cam table has

CYCLE_ROUNDING = 1e-11  # of a peak of a cycle: less is shown as 0
FORCE_ROUNDING = 1e-7  # of the greatest force, or of a turn: less is shown as 0
NO_MARK = 1e-9  # of the greater extreme of a curve: one that is less is rounding, and no mark stands at it
GAP_ROUNDING = 1e-12  # of an objective: a gap below it is rounding
EQUALLY_GOOD = 0.01  # of an objective: laws so little above the least are equally good to a designer
FRONT_END = 0.01  # of what is exchanged: a front goes no further, as some of it can vanish
TELLING = 1e-3  # of a value: a difference or a rest of a limit that is worth a word
BOUND_SLACK = 1e-6  # of a least value: at a bound so much above it the solver has room

# --- extremes and roots ---------------------------------------------------------------------------------------------
TIE = 1e-10  # of the greatest magnitude: extremes nearer to each other are as high, and the first of them counts
NEAR_TIE = 1e-7  # of the greatest magnitude: an extreme that is sampled to so little may be as high
EQUAL_EXTREMES = 1e-9  # of the greatest magnitude: extremes that are polished are equal, and the first of them counts
TOP_WIDTH = 1e-4  # of an interval: a smooth top is flat to TIE over about so much
EXTREME_WIDTH = 1e-3  # of the whole: ties nearer to each other are one extreme
CELL_END = 2.0**-10  # of a cell that is sloped: what stays of it at an edge
TOUCHING = 1e-12  # of a function's size: where it turns or jumps so near to a value, it has it
POLISHING_REACH = 1e-3  # of an interval: Newton's steps towards a root go no further
NO_SLOPE = 1e-200  # by less a value is not divided, for it might overflow
POLISHED = 1e-12  # a step of Newton's method that is the last
EXTREME_POLISHED = 1e-11  # of the whole: a place of an extreme that moves by less is settled
SAME_EXPONENT = 1e-9  # exponents nearer to each other were the same number before they were rounded
BESIDE_TABLE = 1e-9  # of a stroke: positions so near a table's end are as good as in it, and places one
NEAR_NOTHING = 0.5  # of the least value looked at beside it: a turning point that comes nearer to 0 is looked at itself
QUOTIENT_BLUR = 1e-8  # of the greatest value: quotients of small numbers are rounded more than others
DIFFERENCE_SHARE = 1e-10  # of the greatest difference: to so much it is resolved

# --- how near enclosures come, as shares of the greatest magnitude --------------------------------------------------
CAM_EXTREMES = 1e-10  # pressure angles and radii of curvature
SPRING_EXTREMES = 1e-12  # contact forces that a spring is sized by
FORCE_EXTREMES = 1e-8  # contact forces and torques
TORQUE_EXTREMES = 1e-8  # torques of a lever's cam
BALANCING_EXTREMES = 1e-7  # torques of a machine that is balanced
MANUFACTURED_PEAKS = 1e-6  # peaks of a motion as it is manufactured
DEVIATIONS = 1e-3  # deviations from an outline
NO_CROSSING = 1e-3  # the support of a profile, whose sign is all that counts

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
BOUND_ROUNDING = 2.0**-30  # of a bound of roundings: more than its own sum of positive numbers is rounded by
LIMIT_ROUNDING = 2.0**-44  # of a limit: what roots and products of a few numbers are rounded by, EXP and LN too
RUN_TIME_RANGE = 2.0**-100  # of quantities at run time, in any unit: from it to its reciprocal no product overflows
PIECES_OF_MOTION = 1e-9  # of the greatest value: what polynomial pieces of a motion are off
POLYNOMIAL_ROUNDING = 1e-9  # of a derivative: where polynomials of a controller meet

# --- machines -------------------------------------------------------------------------------------------------------
RESONANCE = 1e-9  # singular value of what a cycle leaves: below it there is no steady motion
VIBRATING = 1e-6  # of a root's size: with a smaller imaginary part, it is a decay that rounding has split in two
SAME_ROOT = 1e-6  # of a root's size: what is no further away is the same vibration
DEFECTIVE = 1e-6  # of a root's size: by how much vectors of a mode may miss it
UNSTABLE = 1e-7  # of the fastest root: what its rounding may be
SETTLED = 1e-9  # of a load: what a static state may miss it by
FEEDTHROUGH = 1e-9  # of what a coefficient is computed from: less is rounding

# --- cams and cycles ------------------------------------------------------------------------------------------------
OUTLINE_SHARE = 1e-3  # no part of an outline is left without places, however straight it is
DRAWN_DEVIATION = 2e-3  # of a curve's range: a line between two of its places is the curve to the eye
OUTLINE_DRAWN = 1e-5  # m: by so much the outline of an animated cam may be off
LIFTED = 1e-3  # of the stroke: so far up more stiffness is more force
SIZE_BRACKET = 1e-8  # of a radius: width of the bracket of a least size
OFFSET_SETTLED = 1e-12  # of a pressure angle: at the places that an offset is sought by it is the greatest to so much
SIZE_MET = 1e-7  # of a radius: a size that is proven to so much is the least one
SIZE_MARGIN = 1e-10  # of a radius: by how much more than needed it grows at last
SIZE_NUDGE = 1e-9  # of a radius: a step to where a limit is proven to be kept
SMALLEST_BASE = 1e-6  # of the greatest length of a mechanism: the smallest prime circle that is looked at
MANUFACTURED_JUMP = 1e-6  # of a derivative's greatest value: a smaller jump of a motion as manufactured is none
CAM_GAIN = 1e-4  # of an objective: a round that gains less is the last
PLANE_GAIN = 2e-4  # of a bound: planes that say no more than this are left out
PLANE_SLACK = 1e-9  # of a bound: by so much a formula lies within its planes
CYCLE_OPTIMALITY = 1e-7  # share within which an objective meets the bound of the whole cycle
FASTER = 1e-6  # of a least time: in so much less no law is proven to keep the limits
LEAST_SCALE_MET = 1e-9  # of a least time: Newton's method goes no further
LEAST_SHARE = 1e-3  # of a limit: what is so easily met says little of where it is not
BINDING_LIMIT = 1e-7  # of a time: limits that need so nearly as much bind as well
DURATION_STEP = 1e-4  # of a duration, for the slope of a mean square whose shape changes with it
SHORTEST_MOVE = 1e-6  # of a period: no shorter move is tried
LEAST_PEAK_SLACK = 1e-6  # of a least peak, given to problems that are not convex
LIMIT_USED = 1e-6  # of a motor's limit: so much of it is left, as peaks are looked for at places alone
PEAK_BRACKET = 1e-11  # of a peak: where a limit is met

# --- old tables -----------------------------------------------------------------------------------------------------
NOISE_ROOM = 4.0  # of the standard deviation of a table's noise: points that are farther from a law speak against it
STANDARD_LAW_ROOM = 1e-7  # of the stroke of a table with all digits: by how much a standard law may be off its points
TABLE_JUMP = 1e-6  # of the positions: by how much pieces of a file may be apart where they meet, as REAL32 leaves them
TABLE_MASTER = 1e-9  # of the master's length: places of a table that are nearer are one
TABLE_RATE = (
    0.25  # velocities of a table that are so near the slopes of its positions are by the master, not the second
)
TABLE_SLOPE = 0.5  # of the greatest velocity of a table: one that is farther from the slope of the positions is wrong
WHOLE_TURN = 1e-6  # of a turn: a master without a unit whose length is so near 360, 1 or 2 pi is one turn
WITHIN_TOLERANCE = 1e-6  # of a tolerance: a new law that is beyond it by no more is within it, but for rounding
MODERNISED_JERK = 1.2  # of an old law's greatest jerk: what a law of less acceleration in its place may have

# --- laws and exports -----------------------------------------------------------------------------------------------
MULTIPLIER_MET = 1e-10  # of a wanted constant: it is met
MULTIPLIER_CLOSE = 1e-14  # of a wanted constant: no further step is taken
MULTIPLIER_STEP = 1e-5  # of a coefficient, for slopes by differences
ACCELERATION_HIGHER = 1e-3  # of the peak: how far a run's may be above the motion's
AS_GOOD = 1e-3  # ranks of tables nearer to each other are as good
RUN_OFF = 1e-4  # of the stroke: a run may be so far from the law for the sake of its peak
SOURCE_CODE_OFF = 1e-6  # of the acceleration's peak: how far polynomials of source code may be off

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

# --- synthesis: programs, proofs and fronts --------------------------------------------------------------------------
INTERPOLATION_TAIL = 1e-7  # of the size of what is interpolated: one step of Newton's method makes the square of it
CERTIFIED_GAP = 1e-10  # of an objective: laws of an array whose bound leaves no more are proven
ROUGH_STEP = 1e-7  # of a law: a step of more than this share is followed by another
BEYOND_SEGMENT = 2e-3  # of the path: how far beyond the ends of a segment its laws are tried, where no segment is known
ROW_ROUNDING = 4.0 * ROUNDOFF  # of the sum of the sizes of a row's parts: what rounding may hide of the row
ANGLE_SETTLED = 1e-8  # of an angle: a peak is off by the square of it
FORMULA_RESOLVED = 1e-13  # of the greatest value: what the last coefficients of a formula along a law leave
CELL_MARGIN = 1e-12  # of a right side, or 1: a residual nearer to 0 is left to tangents
TANGENT_FALL = 1e-13  # of the greatest term: by more a tangent at the lowest place may not fall
SQUARED_SUMS = 2.0**-20  # of the roundings in a row: what sums of many are off by beyond them
CERTIFIED_EXCESS = 1e-11  # of a right side, or 1: by so much a row of a certified law may be broken
FIRST_CERTIFIED_GAP = 9e-11  # of an objective: a bound that leaves more is reckoned more sharply
GREAT_MULTIPLIERS = 1e-9  # of an objective: what rounding may leave of it where multipliers are great
CERTIFIED_PULL = 1e-12  # of the greatest multiplier: by so much one may be below 0, for which the bound counts it as 0
SMALL_OBJECTIVE = 1e-6  # of an objective's scale: one that is less is measured by that
WIDE_GAP = 1e-7  # of an objective: gaps below it are worth a sharper bound
VELOCITY_CHANGE = 16.0 * ROUNDOFF  # of accelerations: what their mean may miss of the change of the velocity
OFF_LINE = 1e-12  # of the size of a program's numbers: by so much they may be off a line
TANGENT_SETTLED = 1e-11  # of a bound: what its certificate may lose, whose tangent is settled to a millionth
UNITS_ROUNDING = 1e-14  # of the greatest number of a family: by so much two may differ that are one in different units
ASTRAY = 1e-3  # so near to an event no more than this can be broken: where more is, Newton's method went astray
EVENT_WIDTH = 5e-8  # of the path: an event is known to lie in no wider a stretch
LOST_EVENT_WIDTH = 1e-5  # of the path: the same where Newton's method ends, and nothing tells where the event is
BETWEEN_SEGMENTS = 9e-8  # of the path: a longer stretch between two segments is walked from its other end too
SAME_STATE = 1e-5  # of a segment: states nearer to each other are one of those that others are interpolated between
AT_END = 1e-8  # of u: a stationary point that rounding has moved off an end is that end
CONE_NODES = 1e-6  # of the greatest coefficient of a cone's series: those above it say how many nodes are looked at
LEAST_ENERGY = 1e-12  # of a square: keeps the slopes of roots finite
ENERGY_ROUNDING = 1e-13  # of a peak: by so much an energy's row is moved inward
RULES_AGREE = 1e-13  # of a sum: what two rules of integration in a row may differ by
END_OF_U = 1e-9  # of u: a place so near to the end is the end
NO_NORM = 1e-12  # at standstill and in uniform motion a norm has no slope
BESIDE_BREAK = 2.0**-50  # of k: far enough from a break to tell its side
INTEGRAL_SETTLED = 1e-14  # of an integral: what twice as many places may change of the whole, where no cut is needed
PIECE_SETTLED = 1e-6  # of an integral: what twice as many places may change of the last pieces
INVERSE_AGREES = 1e-6  # what an inverse times its matrix may differ from the identity by
POSITIVE_WEIGHTS = 1e-4  # of a weight: what is no more is not clearly positive
SIZE_RANK = 1e-12  # of the greatest singular value of rows that determine a law: less is rounding
POSITIVE_LEVEL = 1e-7  # weights of levels that balance are at least so great
BALANCED = 1e-9  # by so much weighted slopes may fail to balance
REACH_SETTLED = 1e-6  # of an integral: a step of Newton's method that lowers it by less is the last
FLAT_INTEGRAL = 1e-13  # of the greatest curvature: an integral that bends less in a direction is flat in it
POSITIVE_SHARES = 1e-3  # how near the weights of tangents that balance are to each other at least
STANDSTILL = 1e-6  # a motion back so slow that its times, of the square of this, would be lost in rounding
DIRECTION_SETTLED = 1e-10  # of an objective: a change of directions that gains less is the last
FLAT_DIRECTION = 1e-9  # of the longest: directions that are shorter say nothing
DEPENDENT_ROWS = 1e-11  # rows of length 1 that are nearer to depending on each other are taken to do so
EQUATION_OFF = 1e-9  # of a right side, or 1: by so much an equation may be missed
NO_MULTIPLIER = 1e-12  # a multiplier that is less is none
LEAST_STEP = 1e-3  # of a way: a shorter step of a search for a bound is not taken
LEAST_INTERIOR = 1e-11  # the most by which the law with most room may break a bound
EQUATIONS_RANK = 1e-12  # of a law: by so much it may miss equations that are met
NEWTON_CONVERGED = 1e-13  # of a law: a step of Newton's method that is the last
SHORT_STRETCH = 1e-4  # of a path: structures that hold for less of it are not stored
NEWTON_NEAR = 1e-7  # of a law: after a step that changes less a state is rounded
NEWTON_SAME = 1e-5  # of a law: nearer than this a state and what it is led to after rounding are one optimum
NEWTON_STALLED = 1e-10  # of a law: steps below it that shrink no more are rounding
NEWTON_FULFILLED = 1e-9  # of a right side: by so much the equations of Newton's method may be missed
NEWTON_STILL = 1e-6  # of a law: a step that is longer wanders
CONIC_SOLVER = 1e-12  # what a solver of cones is told to leave of gap and feasibility
FLAT_GAP = 1e-9  # of an objective: what a linear program's vertex may be off its dual
VERTEX_FEASIBILITY = 1e-11  # of a vertex: by so much its own equations may be missed
VERTEX_BALANCED = 1e-12  # of the greatest multiplier: by so much a vertex may fail to balance
KINK_RADIUS = 0.003  # of hyperbolas in place of kinks, in units of the problem
SMOOTH_NORM = 1e-12  # keeps a norm's slope finite where it vanishes; Newton's method goes without it
STEP_SETTLED = 1e-11  # of the greatest variable: a quadratic step that is less ends the search
STEP_OF_SMOOTH = 1e-2  # the same where formulas without kinks stand for those with
STEP_SHOWS_CONTACTS = 1e-4  # the same: after one that is less Newton's method may find the exact contacts
STEP_PAYS = 1e-4  # of what a quadratic step promises: the share that it must hold
STEP_FEASIBILITY = 1e-9  # what a row may be exceeded by in a quadratic step
STEP_GAIN = 1e-13  # of the objective: a quadratic step that promises less is rounding
QUADRATIC_SOLVER = 1e-13  # what a solver of quadratic steps is told to leave of gap and feasibility
EXCESS = 1e-10  # of a right side, or 1: a residual beyond this is an excess, and its extremum a contact that is missing
SAME_HEIGHT = 1e-9  # what an extremum's residual may be below that of a point on its hill: rounding of a series
EMPTY_ROW = 1e-13  # of a row: one that is shorter says nothing, as b >= 0 at rest, and is not divided by its length
VANISHED = 1e-13  # amplitudes that are minimised vanish if their sum is less
NEARLY_APEX = 1e-5  # of what the base law leaves: an amplitude that is less may vanish
APEX_DIRECTION = 1e-9  # of a multiplier: by so much the parts of an amplitude that vanishes may pull more than it does
SMALL_COST = 3e-2  # an objective that is less is hidden from an interior-point method by its own tolerance
SAME_PLACE = 1e-6  # of u: contacts nearer than this are one, as IPOPT's tolerance may show two where there is one
PULLING = 1e-10  # of the greatest multiplier: one that is more negative pulls, and its contact is dropped
WEIGHTLESS = 1e-7  # of the greatest multiplier, of IPOPT: what is less may be its barrier's, not a contact's
WEIGHTLESS_AT_VERTEX = 1e-13  # of the greatest multiplier, at a vertex, which has no barrier: what is less is rounding
VERTEX_NEAR = 1e-3  # the excess under which a vertex may show the optimum's contacts
VERTEX_FINE = 1e-6  # the excess under which the next vertex is sought from this one: the solver's tolerance then counts
NEARLY_NOTHING = 1e-4  # of a value where it pays: a constant that can be less can be 0, to which no logarithm goes
NO_EXCHANGE = 1e-6  # of the first constant of a front: a stretch of it within which nothing is exchanged
LEAST_WEIGHT = 1e-3  # weights of an objective that are less are part of its scale
ROWS_AGREE = 1e-5  # of a value: what rows and values computed in different ways may be apart
BOUND_FEASIBILITY = 1e-9  # of a bound: by so much a law may break a constraint and still meet it
BOUND_SHORT = 1e-9  # of a lower bound: a constant that is short by more is too small
REST_VELOCITY = 1e-15  # a velocity at an end that is less is rest
SUBLEVEL_RANK = 1e-15  # of the greatest singular value: less is rounding
NEIGHBOUR_DISTANCE = 2.0**-12  # of u: how far from a contact its neighbours are
NEIGHBOUR_SHARE = 2.0**-14  # of a contact's multiplier: how much of it each neighbour takes
CUTS_ENOUGH = 2e-9  # of an objective: what cuts may leave
LEAST_SQUARES = 1e-3  # of the unit of a sum of squares: the least by whose root the size of laws is bounded
PAYING_SCALE = 2.0**-40  # of the scale of a constant: in such shares is counted what a sum leaves of it alone
LEFT_SHARES = (1e-12, 1e-11, 1e-10, 1e-9)  # of a constant's weight: what a proof leaves of it to pay for rounding
DIRECTIONS_BALANCED = 1e-13  # a slope that is less is balanced
DIRECTIONS_RANK = 1e-10  # of the greatest singular value of pulls: less is rounding
WEIGHTED_ROUNDING = 9 * ROUNDOFF  # roundings in a row before it is weighted, and of the sum
FARKAS_ROUNDING = 1e-14  # of weighted lengths of rows: more than the rounding of their sum
FARKAS_FIRM = 1e-10  # of the greatest singular value: rows with less leave directions open
INFEASIBLE_WEIGHTLESS = 1e-9  # a weight of a proof of infeasibility that is less is none
APEX = 1e-11  # of the sum of magnitudes: a norm that is less is 0 but for rounding
PROOF_WEIGHTLESS = 1e-14  # of the greatest multiplier of a proof: what is less is left out
PROOF_ENOUGH = 5e-9  # of an objective: a bound that leaves no more needs no other proof
LEAST_REACH = 1e-9  # of u: cells of a peak's place are cut no further
HARDLY = 1e-9  # of a peak's bound: room that is less is hardly any
BENEATH_ROUNDING = 2.0**-44  # of what values and slopes amount to: more than they are rounded by
RULE_ROUNDING = 2.0**-36  # of what sums amount to: more than a rule is off by for what is no polynomial
INTEGRAL_BLUR = 1e-12  # of sums and ends of integrals: more than they are rounded by
GRID_NEAR = 1e-3  # of a right side: rows nearer to binding join the grid
GRID_EMPTY = 1e-9  # of the greatest entry: a row that is shorter says nothing
GRID_LIGHT = 1e-13  # of the greatest multiplier: what is less is rounding
FLAT_SECANT = 1e-12  # of a range: one that is narrower has the secant of a point
SECANT_SERIES = 1e-3  # of a parameter: below it a series is nearer than the quotient
AWAY_FROM_REST = 1e-6  # of B: a velocity nearer to zero bounds no acceleration worth mentioning
ROW_BROKEN = 1e-11  # of a row: what is broken by less is kept
PIVOT_LEAST = 1e-8  # of a row: what a row of the basis must have of one that it leaves to
TIE_BROKEN = 1e-9  # of a goal: what is added so that multipliers differ
NARROW_RANGE = 1e-3  # added to widths by which rows are weighted
GIVEN_VARIABLE = 1e-9  # a variable whose range is narrower is given
ENERGY_OUTWARD = 1e-12  # of an energy's bounds: more than they are rounded by
MIDDLE = 1e-6  # of t squared: nearer to the middle B - b has no digits left
PRODUCT_ROUNDING = 2.0**-50  # of a product: what rounding of it and of its factors can be
NARROWEST = 1e-12  # of a front's range: laws nearer to each other than this are one
PROVEN_GAP = 1e-10  # of the objective: laws of a front whose own gap is greater are looked at alone
LEAST_TIME_GAP = 1e-6  # of a least time: shorter ones by this are proven to be too short
LIMIT_REACHED = 1e-6  # of a limit of a move: where no more of it is left, the law reaches it
LEAST_TIME_MET = 1e-10  # of a least time: a time so near to one that is too short is the least
OPTIMALITY_GAP = 1e-8  # what a bound may leave of the objective and still be said to meet it
FIRST_MOVE = 4e-3  # how far the place of a peak is moved at first
UNDIVIDED_ROUNDING = 1e-13  # an excess that passes unlooked at; a contact at the middle may hide a larger one
BEYOND_PROOF = 1e-12  # an objective that is better than what is proven by more belongs to a law that breaks a bound
NO_OBJECTIVE = 1e-6  # of an objective's scale: one that is zero but for rounding is measured by that
MIRROR = 1e-12  # of k: breaks whose mirror images are nearer are symmetric
CONVERSION_AGREES = 1e-8  # how near conversions between bases come, where even powers lose no digits
FLAT_SLOPE = 1e-9  # of a series: a slope that is less is flat
EVEN_PART = 1e-9  # of the greatest singular value: less is no even part
STORED_VALUE = 1e-9  # of a value or a bound: what another machine may round otherwise
STORED_COEFFICIENT = 1e-11  # of a law's coefficient: what another machine may round otherwise
CONTROL_POINT_BLUR = 128.0 * ROUNDOFF  # of the greatest control point: values are means of these
LEAST_SUM = 1e-24  # under a root in IPOPT's expressions: its slope stays finite
DEEP_LAW_EXCESS = 1e-3  # by how much a law far below all of the field may miss a bound
NEARLY_BINDING = 1e-2  # of a right side, or 1: extrema within this of binding join the points that are held
LOST = 1e7  # coordinates beyond this are no law of the field: the solver has lost its way

# --- verification, in exact arithmetic and balls ---------------------------------------------------------------------
COEFFICIENT_ROUNDING = 2.0**-44  # of what a derivative is made of: what rounding of the coefficients can do to it
BREAK_ROUNDING = 2.0**-50  # of k: by so much rounding moves a break to its mirror image
CORRECTED_MULTIPLIER = 1e-6  # of the greatest multiplier: the greatest correction that rounding explains
ROUNDED_MULTIPLIER = 1e-7  # of the greatest multiplier: a correction that nothing but rounding need explain
NEGATIVE_MULTIPLIER = 1e-9  # of the greatest multiplier: one so little below 0 is none
STATED_BOUND = 1e-9  # of a bound: by so much one that was computed in doubles may be above the proven one
STATED_CONSTANT = 1e-11  # of a constant: what one that was computed in doubles may be off
STATED_PLACE = 1e-7  # of a constant: what its value may be less at a place that was computed in doubles
STATED_GAP = 1e-12  # by how much a gap that was computed in doubles may be below the proven one
SAME_FREQUENCY = 1e-9  # of a root's size: vibrations that differ by no more have no numbers of their own
TAYLOR_REST = 2.0**-80  # of a function: what a Taylor polynomial may leave of it
OUTPUT_REST = 2.0**-150  # of what an output is made of: what a Taylor polynomial may leave of it
GREATEST_ENCLOSED = 2.0**-70  # of a greatest value: how narrow its ball must be
GREATEST_NEGLIGIBLE = 2.0**-110  # of what a function is made of: a greatest value that is less is enclosed well enough
BOUND_ENCLOSED = 2.0**-80  # of the objective's scale: in a wider ball a bound gains from more bits

# --- limits in the phase plane --------------------------------------------------------------------------------------
PHASE_ACTIVE = 1e-4  # of a bound: places of a conic program so near to it have it active
SMALLEST_ELEMENT = 1e-7  # of the move: elements of a potential are not cut further
HOLDING_ENCLOSED = 1e-9  # of the torque that holds a load nearest to 0: how narrow its enclosure is
PHASE_TIGHT = 1e-7  # of a bound: by so much narrower is what the motion of a limit keeps to, so that it keeps the bound
BOUND_KEPT = 1e-6  # of a bound: a motion integrated at nodes that is beyond it by so little keeps it
INTEGRATION = 1e-6  # of a time or a value: what integrating a motion at nodes may be off
PHASE_WEIGHT = 1e-9  # of what is minimised: the price of the time where the torque at rest alone bounds it
EVEN_FALL = 1e-3  # of a potential by which a torque has one price everywhere: its fall, so that no velocity pays
PHASE_PACE = 1e-5  # of what is minimised: the least price of the time
PHASE_TIE = 1e-7  # of a bound or of two torques: nearer values are equal, and the potential says at what price
AFFINE_SLACK = 1e-12  # of a price: keeps affine shares within 0 and 1 and magnitudes below their lines after rounding
STATIONARY_SLACK = 1e-10  # of a velocity: beyond the flat place of a function without a bound it only rises
PHASE_GAP = 1e-5  # of a limit in the phase plane: a potential that leaves no more needs no more fall
MOST_PHASE_GAP = 1e-2  # of a limit in the phase plane: what leaves less is not mended by more fall
WINDOW_EDGE = 1e-9  # of the stroke: so far within a window the places of a conic program begin that are bounded
SMALL_PHASE_GAP = 1e-6  # of a limit: more is looked for on finer elements
WEAK_CELL = 5e-7  # of what a cell adds to a bound: a cell that may lose more is divided
SHORT_CELL = 1e-3  # of the move: of shorter cells what is lost is measured by this length
INNER_SHARE = 1e-3  # shares of two equal torques that are so far from 0 and 1 follow from the potential

# --- interlocks of axes ----------------------------------------------------------------------------------------------
PASS_WIDTH = 1e-13  # of a cycle: times of a pass that are nearer to each other are one
INTERLOCK = 1e-9  # of a stroke: positions that are nearer touch, and what touches is clear
CLEARANCE_SHARE = 1e-9  # of the greatest clearance: how near its bound comes to the least one
SQUARED_CLEARANCE = 1e-12  # the same of the square of a distance
BROKEN_INSTANT = 1e-11  # of a period: by so much an instant may come too early, as programs are solved
OVERLAP_GAP = 1e-9  # of the objective: by so much a least period is longer than the one of its program
LP_FEASIBILITY = 1e-10  # of a period: by so much the solver of programs of instants may break a row
BROKEN_PLACE = 3e-10  # of a period: the same between the places that programs know
INSTANT_MARGIN = 1e-9  # of a period: instants are chosen so much apart from where they touch, which pays for the others
PLACE_WIDTH = 1e-9  # of a segment: how near a place comes to where instants are broken most
TIGHT = 1e-7  # of a period: what leaves no more binds
SECTION_WIDTH = 1e-12  # of a polygon: sides that are narrower are upright
CLOSE_FIT = 1e-14  # of a fit of a law to points: what its last step changes of the sum of squares and of its ends
ROUGH_FIT = 1e-4  # the same where laws are only ranked by how near they come
