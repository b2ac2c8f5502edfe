"""Internals of `optlaws.explorer` that tests look at by themselves."""

from optlaws.explorer import downloads
from optlaws.explorer.answering import EXAMPLES, QUESTIONS, answered
from optlaws.explorer.application import MOST_BYTES, page
from optlaws.explorer.downloads import FileRequest
from optlaws.explorer.server import ADDRESS, opened, server
from optlaws.explorer.start import OpenRequest, start
from optlaws.explorer.start import opened as opened_file
from optlaws.explorer.views import (
    axes_view,
    cam_view,
    cycle_view,
    fastest_view,
    front_view,
    law_view,
    machine_view,
    old_cam_view,
)
from optlaws.explorer.views.cycle_view import CycleRequest, example
from optlaws.explorer.views.opened_results import OPENED
from optlaws.explorer.views.panel_data import fact_sentences, panel_data, table_data
from optlaws.explorer.views.requests import LawRequest, LawsRequest, given_law, law_of, problem_of, solved
from optlaws.explorer.workers import Workers
