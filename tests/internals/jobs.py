"""Internals of `optlaws.jobs` that tests look at by themselves."""

from optlaws.jobs import cycle as cycle_job
from optlaws.jobs import cycle_sweeps, job, solutions
from optlaws.jobs.cam import read as read_of_cam
from optlaws.jobs.cam import stored as stored_cam
from optlaws.jobs.cam_entries import CamProblemFile
from optlaws.jobs.cycle_entries import read as read_of_cycle_entries
from optlaws.jobs.cycle_entries import read_given
from optlaws.jobs.cycle_sweeps import sweeps_of
from optlaws.jobs.job import JOBS, do
from optlaws.jobs.job_entries import ProblemFile
from optlaws.jobs.machine_laws import MachineLawsProblemFile, MachineTable, solution_of_sought
from optlaws.jobs.starters.starter import STARTERS
from optlaws.jobs.starters.starter_numbers import TYPES, numbers_of
