"""Internals of `optlaws.exports` that tests look at by themselves."""

from optlaws.exports.error_bounds import DOUBLE, SINGLE, as_stored, error_bounds, summation_bounds
from optlaws.exports.export import Export, export_motion, task_sampling, travel_of_run
from optlaws.exports.format import FORMATS
from optlaws.exports.formats.controllers import profile_rows
from optlaws.exports.formats.source_code import function_block, header
from optlaws.exports.front_export import FrontExport, MoveStatus, RunTimeMove
from optlaws.exports.point_tables import NumberFormat, akima_powers, point_table
from optlaws.exports.polynomial_pieces import fitted
from optlaws.exports.text import IEC_KEYWORDS, Labels, c_name, filled, iec_name, plain_column, real, template
