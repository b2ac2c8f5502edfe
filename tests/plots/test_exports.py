"""What is drawn of exports: the motion as it was designed, and as the controller runs it."""

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
