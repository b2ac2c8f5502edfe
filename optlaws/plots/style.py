"""Pictures in one style; matplotlib is imported when the first one is drawn."""

from __future__ import annotations

import io
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from optlaws.errors import not_installed
from optlaws.files import writing
from optlaws.files.writing import MARK

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BLUES = ("#b3cde3", "#74add1", "#4292c6", "#2166ac", "#08306b")
WARM = "#d95f02"
GREEN = "#1b7f5c"
GREY = "#595959"
VIOLET = "#7b3294"
BROWN = "#a6761d"
#: colours of curves that have no order of their own, apart for those too who see no red and green
DISTINCT = (BLUES[3], WARM, GREEN, VIOLET, BROWN, GREY)

STYLE: Any = {  # matplotlib's type lists every key there is
    "font.family": "DejaVu Sans",
    "font.size": 10.0,
    "axes.titlesize": 11.0,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#e6e6e6",
    "grid.linewidth": 0.7,
    "axes.axisbelow": True,
    "lines.linewidth": 1.6,
    "legend.frameon": False,
    "legend.fontsize": 9.0,
    "figure.dpi": 100.0,
    "figure.autolayout": False,
    "figure.constrained_layout.use": False,
    "savefig.dpi": 160.0,
    "svg.hashsalt": "optlaws",
    "svg.fonttype": "path",
}


_FOR_FILES = ContextVar("whether figures are drawn for files", default=False)


@contextmanager
def figures_for_files() -> Iterator[None]:
    """Draw for files alone: pyplot neither shows the figures of this `with` block nor keeps them."""
    before = _FOR_FILES.set(True)
    try:
        yield
    finally:
        _FOR_FILES.reset(before)


@contextmanager
def plot_style() -> Iterator[None]:
    """The style of every picture of the project, for the time of a `with` block."""
    try:
        import matplotlib as mpl
    except ImportError:
        raise not_installed("drawing needs matplotlib", "matplotlib") from None
    with mpl.rc_context(STYLE):
        yield


def empty_figure(width: float = 7.2, height: float = 4.6) -> Figure:
    """An empty figure without a window; sizes in inches."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def new_figure(width: float = 7.2, height: float = 4.6) -> Figure:
    """An empty figure for a user's plot; a figure of pyplot's, to be shown, if the user has imported pyplot."""
    pyplot = sys.modules.get("matplotlib.pyplot")
    if pyplot is None or _FOR_FILES.get():
        return empty_figure(width, height)
    return pyplot.figure(figsize=(width, height), layout="constrained")  # type: ignore[no-any-return] # by name alone


def new_axes() -> Axes:
    """Empty axes of the project's style in a figure of their own."""
    with plot_style():
        return new_figure().subplots()


def one_below_the_other(axes: Any, count: int, height: float) -> list[Axes]:
    """Axes that are given, or so many new ones in a column over one abscissa; the height in inches."""
    import numpy as np

    if axes is None:
        with plot_style():
            figure = new_figure(8.6, height)
            axes = figure.subplots(count, 1, sharex=True, squeeze=False)
            figure.align_ylabels()
    return list(np.ravel(np.asarray(axes, dtype=object)))


def titled(figure: Figure, title: str) -> Figure:
    """The figure with a title above its left edge."""
    figure.suptitle(title, x=0.01, ha="left", fontsize=11.0)
    return figure


def figure_of(artists: Sequence[Artist], title: str) -> Figure:
    """The figure in which artists are, with a title."""
    with plot_style():
        return titled(cast("Figure", artists[0].get_figure()), title)


def shades(count: int) -> list[str]:
    """Blues from light to dark for curves that have an order, at most five, as far apart as there are.

    Examples
    --------
    >>> shades(2) == [BLUES[1], BLUES[4]]
    True
    """
    if count >= len(BLUES):
        return list(BLUES)
    last = len(BLUES) - 1
    return [BLUES[last - round((last - 1) * place / max(1, count - 1))] for place in range(count)][::-1]


def name_point(
    axes: Axes, text: str, point: tuple[float, float], at: tuple[float, float] = (6.0, 4.0), **given: Any
) -> Artist:
    """A small text beside a point, legible over lines; `at` is its offset in points."""
    from matplotlib.patheffects import withStroke

    style: dict[str, Any] = {"color": WARM, "fontsize": 8.0, "zorder": 6, "ha": "right" if at[0] < 0.0 else "left"}
    style["path_effects"] = [withStroke(linewidth=2.5, foreground="white")]
    return axes.annotate(text, point, xytext=at, textcoords="offset points", **style | given)


def save_picture(drawing: Figure, place: Path) -> Path:
    """Write a figure as svg to `place`, without an ending; a file with the same picture stays unchanged."""
    return writing.write(place.with_name(f"{place.name}.svg"), rendered(drawing, "svg"))


def rendered(drawing: Figure, kind: str) -> bytes:
    """The picture as svg or png, without the date: the same drawing gives the same bytes."""
    stream = io.BytesIO()
    metadata = {"svg": {"Date": None, "Creator": MARK}, "png": {"Software": MARK}}[kind]
    dpi, canvas = drawing.dpi, drawing.canvas
    try:
        # Figure.savefig draws twice, first for its layout, which drawing once does too
        with plot_style():
            drawing.set_dpi(STYLE["savefig.dpi"])
            writer: Any  # the methods have no types
            if kind == "svg":
                from matplotlib.backends.backend_svg import FigureCanvasSVG

                writer = FigureCanvasSVG(drawing)
                writer.print_svg(stream, metadata=metadata)
            else:
                from matplotlib.backends.backend_agg import FigureCanvasAgg

                writer = FigureCanvasAgg(drawing)
                writer.print_png(stream, metadata=metadata)
    finally:
        drawing.set_canvas(canvas)
        drawing.set_dpi(dpi)
    return stream.getvalue()
