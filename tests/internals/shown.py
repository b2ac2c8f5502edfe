"""Internals of `optlaws.shown` that tests look at by themselves."""

from optlaws.shown import showing, steps
from optlaws.shown.difference import Difference, Differences
from optlaws.shown.report import PlainReport, ReportTable, Section, report_page
from optlaws.shown.showing import facts, page
from optlaws.shown.summary import Row, Summary
