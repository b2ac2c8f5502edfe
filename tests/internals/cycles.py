"""Internals of `optlaws.cycles` that tests look at by themselves."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from optlaws.cycles.advising.candidates import Candidates
from optlaws.cycles.answers import Answers, answer
from optlaws.cycles.axes.enclosed import SimplePolygon
from optlaws.cycles.old_tables.better_laws import nothing_to_better
from optlaws.cycles.old_tables.peak_intervals import least_peak
from optlaws.cycles.old_tables.reading import points_in
from optlaws.cycles.old_tables.report import OldTableReport
from optlaws.cycles.old_tables.stated_functions import stretches_of_pieces
from optlaws.cycles.old_tables.stretches import law_of_move, position
from optlaws.cycles.optimisation import optimal
from optlaws.cycles.optimisation.objectives import OBJECTIVES
from optlaws.cycles.optimisation.shared_limits import best_of
from optlaws.cycles.report import CycleReport, overload_rows
from optlaws.cycles.specification.limits import LIMITS_OF_CYCLE, LIMITS_OF_MOVE
from optlaws.cycles.specification.load import ElasticFollower
from optlaws.cycles.usual_law import usual_cycle
from optlaws.files import reading
from optlaws.laws.catalogue.catalogue import USUAL
from optlaws.laws.catalogue.tables.columns import LARGEST_TABLE
from optlaws.laws.catalogue.tables.curve_pieces import TablePoints, hermite
from optlaws.synthesis.least_time.timed_move import RATES as OBJECTIVES_OF_MOVES


def read_points(file: Path, *columns: Any, **options: Any) -> TablePoints:
    """The points of a file, as `optlaws.read_cycle_table` reads them, and places of the functions between them."""
    points = points_in(reading.text(file, LARGEST_TABLE, legacy=True), file, *columns, **options)
    if not points.pieces:
        return points
    u = np.linspace(0.0, 1.0, 31)
    places = np.concatenate([piece.start + piece.length * u for piece in points.pieces])
    heights = np.concatenate([piece.at(u) for piece in points.pieces])
    return replace(points, places=places, heights=heights)
