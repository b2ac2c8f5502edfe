"""Internals of `optlaws.exports` that tests look at by themselves."""

from optlaws.exports.error_bounds import DOUBLE, SINGLE, as_stored, error_bounds
from optlaws.exports.export import Export, export_motion
from optlaws.exports.format import FORMATS
from optlaws.exports.formats.c99 import c_name, header
from optlaws.exports.formats.rockwell import profile_rows
from optlaws.exports.formats.structured_text import function_block
from optlaws.exports.point_tables import NumberFormat, akima_powers, point_table
from optlaws.exports.polynomial_pieces import fitted
from optlaws.exports.program_text import filled, template
from optlaws.exports.report import task_sampling, travel_of_run
from optlaws.exports.run_time.front_export import FrontExport
from optlaws.exports.run_time.front_table import summation_bounds
from optlaws.exports.run_time.planning import MoveStatus, RunTimeMove
from optlaws.exports.text import IEC_KEYWORDS, Labels, iec_name, plain, real
