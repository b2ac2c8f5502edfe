"""Internals of `optlaws.verification` that tests look at by themselves."""

from optlaws.verification.claims import verified
from optlaws.verification.enclosing.ball_formulas import BALLS, series_of
from optlaws.verification.enclosing.balls import ball, enclosed, lower, upper
from optlaws.verification.enclosing.taylor_models import between, integrals, real_roots
from optlaws.verification.exact.bound import Along, prove
from optlaws.verification.exact.law import ExactLaw
from optlaws.verification.exact.least_times import least_time_of_any_law
from optlaws.verification.exact.limit import exact_limit
from optlaws.verification.exact.of_basis import exact_space
from optlaws.verification.exact.rows import ExactRows
from optlaws.verification.file_entries import FileEntry, entries
from optlaws.verification.machines.floors import floor
from optlaws.verification.machines.output_motion import cycle, followed, of_pieces, response
from optlaws.verification.machines.residuals import ExactModeResidual
from optlaws.verification.machines.transfer import Transfer
from optlaws.verification.reading import built, number, read
from optlaws.verification.result import differences, near
