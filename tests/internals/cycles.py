"""Internals of `optlaws.cycles` that tests look at by themselves."""

from optlaws.cycles.axes.regions import SimplePolygon
from optlaws.cycles.old_tables.better_moves import law_of_move, nothing_to_better
from optlaws.cycles.old_tables.reading import read_points
from optlaws.cycles.optimisation.objectives import OBJECTIVES
from optlaws.cycles.optimisation.search_spaces import halved
from optlaws.cycles.optimisation.shared_limits import _SharedLimit as SharedLimit
from optlaws.cycles.report import CycleReport
from optlaws.cycles.specification.drive import read_drive
from optlaws.cycles.specification.limit_entries import LIMITS_OF_CYCLE, LIMITS_OF_MOVE
from optlaws.cycles.specification.load import ElasticFollower
from optlaws.mechanisms.drives.effort import size_of
from optlaws.motion.quantity_kinds import Kind
from optlaws.synthesis.least_time.move_objective import RATES as OBJECTIVES_OF_MOVES
