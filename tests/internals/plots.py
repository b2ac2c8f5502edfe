"""Internals of `optlaws.plots` that tests look at by themselves."""

from optlaws.plots.cam import animated, forces_figure
from optlaws.plots.front import draw_front
from optlaws.plots.report import draw_panels
from optlaws.plots.style import DISTINCT, empty_figure, plot_style, save_picture, shades
