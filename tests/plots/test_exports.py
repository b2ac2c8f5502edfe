"""What is drawn of exports: the motion as it was designed, as the controller runs it, and the difference."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from optlaws import smoothstep


def test_the_designed_motion_is_seen_where_the_run_lies_on_it() -> None:
    export = smoothstep(3).export("codesys-xyva", stroke="35 mm", master="120 deg", duration="0.1 s", points=33)
    panels = list(Figure().subplots(4, 1))
    export.plot(panels)
    for panel in panels:
        designed, run = panel.lines
        assert (designed.get_label(), run.get_label()) == ("as designed", "as executed")
        assert designed.get_linewidth() > 2.0 * run.get_linewidth()
        assert designed.get_zorder() <= run.get_zorder()


def test_beside_the_motions_is_what_the_run_differs_by() -> None:
    export = smoothstep(3).export("codesys-xy", stroke="35 mm", master="120 deg", duration="0.1 s", points=33)
    artists = export.plot()
    figure = artists[0].get_figure()
    motions, differences = figure.axes[::2], figure.axes[1::2]
    for nu, (motion, difference) in enumerate(zip(motions, differences, strict=True)):
        designed, run = (np.asarray(line.get_ydata()) for line in motion.lines)
        (off,) = (np.asarray(line.get_ydata()) for line in difference.lines)
        assert off == pytest.approx(run - designed, abs=1e-12 * np.abs(designed).max())
        assert f"at most {np.abs(off).max():.3g} mm{'/s' * (nu > 0)}" in difference.get_title()
    assert differences[0].get_title().endswith("% of the peak")
