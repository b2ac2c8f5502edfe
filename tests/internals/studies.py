"""Internals of `optlaws.studies` that tests look at by themselves."""

from optlaws.studies.chunk import Task, along_B, array_along_B, blocks
from optlaws.studies.executor import Serial
from optlaws.studies.points import StudyPoints, axes, key
from optlaws.studies.problem_entries import problem
from optlaws.studies.progress import Bar, Silent, watching
from optlaws.studies.run import check, task
from optlaws.studies.specification import entries, filled, read_study
from optlaws.studies.store import Chunks, DamagedTable, StoreFailure, StudyDirectory, digest
from optlaws.studies.store import _with_digest as with_digest
from optlaws.studies.study import Study
from optlaws.studies.tables import StudyPoint, row_of
