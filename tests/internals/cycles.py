"""Internals of `optlaws.cycles` that tests look at by themselves."""

from optlaws.cycles.interlocks.polygon import SimplePolygon
from optlaws.cycles.old_tables.better_moves import law_of_move, nothing_to_better
from optlaws.cycles.old_tables.reading import read_points
from optlaws.cycles.optimisation.motion_limits import FORCE, POWER
from optlaws.cycles.optimisation.search_spaces import halved
from optlaws.cycles.specification.drive import read_drive
from optlaws.cycles.specification.effort import size_of
