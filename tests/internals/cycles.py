"""Internals of `optlaws.cycles` that tests look at by themselves."""

from optlaws.cycles.interlocks.polygon import SimplePolygon
from optlaws.cycles.optimisation.objectives import FORCE, POWER
from optlaws.cycles.optimisation.search_spaces import halved
from optlaws.cycles.specification.drive import effort, read_drive, size_of
