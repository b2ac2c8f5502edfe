"""Internals of `optlaws.verification` that tests look at by themselves."""

from optlaws.verification.claims import verified
from optlaws.verification.enclosing.balls import BALLS, ball, enclosed, lower, series_of, upper
from optlaws.verification.enclosing.space import exact_space
from optlaws.verification.enclosing.taylor_models import between, integrals, real_roots
from optlaws.verification.exact.bound import Along, exact_limit, least_time_of_any_law, prove
from optlaws.verification.exact.law import ExactLaw
from optlaws.verification.exact.rows import ExactRows
from optlaws.verification.file_entries import FileEntry, entries
from optlaws.verification.machines.output_motion import cycle, followed, of_pieces, response
from optlaws.verification.machines.residuals import ExactModeResidual
from optlaws.verification.machines.transfer import Transfer, floor
from optlaws.verification.result import built, differences, near, number, read
