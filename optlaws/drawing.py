"""Pictures in one style; matplotlib is imported when the first one is drawn."""

from __future__ import annotations

import io
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from optlaws.files import writing
from optlaws.files.writing import MARK
from optlaws.plotting import draws

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from optlaws.mechanisms.machine.output_curve import OutputCurve
    from optlaws.mechanisms.of_machines.parameters import MachineSpectrum
    from optlaws.mechanisms.spectrum.spectrum import ResponseSpectrum
    from optlaws.synthesis.front import Front
    from optlaws.synthesis.proven.front import ProvenFront

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
    "savefig.dpi": 160.0,
    "svg.hashsalt": "optlaws",
    "svg.fonttype": "path",
}


@contextmanager
def style() -> Iterator[None]:
    """The style of every picture of the project, for the time of a `with` block."""
    import matplotlib as mpl

    with mpl.rc_context(STYLE):
        yield


def figure(width: float = 7.2, height: float = 4.6) -> Figure:
    """An empty figure that no window system knows of; sizes in inches."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def new_figure(width: float = 7.2, height: float = 4.6) -> Figure:
    """An empty figure for a user's plot: one of pyplot's, so that it is shown, where the user has imported pyplot.

    Examples
    --------
    >>> new_figure(4.0, 3.0).get_size_inches().tolist()
    [4.0, 3.0]
    """
    pyplot = sys.modules.get("matplotlib.pyplot")
    if pyplot is None:
        return figure(width, height)
    return pyplot.figure(figsize=(width, height), layout="constrained")  # type: ignore[no-any-return] # by name alone


def new_axes() -> Axes:
    """Empty axes of the project's style in a figure of their own.

    Examples
    --------
    >>> new_axes().get_title()
    ''
    """
    with style():
        return new_figure().subplots()


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


def name_point(axes: Axes, text: str, point: tuple[float, float], at: tuple[float, float] = (6.0, 4.0)) -> Artist:
    """A small text beside a point, legible over lines; `at` is its offset in points.

    Examples
    --------
    >>> name_point(new_axes(), "l = 3", (1.875, 5.77)).get_text()
    'l = 3'
    """
    from matplotlib.patheffects import withStroke

    style: dict[str, Any] = {"color": WARM, "fontsize": 8.0, "zorder": 6, "ha": "right" if at[0] < 0.0 else "left"}
    style["path_effects"] = [withStroke(linewidth=2.5, foreground="white")]
    return axes.annotate(text, point, xytext=at, textcoords="offset points", **style)


_AXES = {"B": "peak velocity B", "C": "peak acceleration C", "D": "peak power D", "J": "peak jerk J"}


def _label(name: str) -> str:
    """What an axis says of a constant: constants of machines have units of their own."""
    from optlaws.synthesis.problem.named_constants import title_of

    title = title_of(name)
    return title if title != name else f"{_AXES.get(name, name)} (dimensionless)"


@draws("front")
def draw_front(front: Front, axes: Axes | None = None, **style: Any) -> list[Artist]:  # noqa: ANN401 - matplotlib's
    """Draw a front into axes, new ones unless given, and return the artists; a third constant gives the colour.

    Examples
    --------
    >>> from optlaws import Problem
    >>> from optlaws.synthesis.pareto import pareto_front
    >>> (line,) = draw_front(pareto_front(Problem(order=4), points=3), color=GREEN)
    >>> line.axes.get_xlabel()
    'peak velocity B (dimensionless)'
    """
    if axes is None:
        axes = new_axes()
    for axis, name in zip("xy", front.over, strict=False):
        axes.set(**{f"{axis}label": _label(name)})
    values = front.values
    if len(front.over) == 2:
        return list(axes.plot(*values.T, **style))
    style = {"s": 18.0, "c": values[:, 2], **{key: value for key, value in style.items() if key != "color"}}
    points = axes.scatter(values[:, 0], values[:, 1], **style)
    bar = axes.get_figure(root=True).colorbar(points, ax=axes)  # type: ignore[union-attr] # these axes have a figure
    bar.set_label(_label(front.over[2]))
    return [points]


@draws("proven_front")
def draw_proven_front(front: ProvenFront, axes: Axes | None = None, **style: Any) -> list[Artist]:  # noqa: ANN401
    """Draw a proven front into axes, new ones unless given, as it is at every value, and return the artists.

    Examples
    --------
    >>> from optlaws import Problem, proven_front
    >>> (line,) = draw_proven_front(proven_front(Problem(order=4), between=(1.6, 1.7), gap=1e-4), color=GREEN)
    >>> line.axes.get_ylabel()
    'peak acceleration C (dimensionless)'
    """
    if axes is None:
        axes = new_axes()
    for axis, name in zip("xy", front.over, strict=True):
        axes.set(**{f"{axis}label": _label(name)})
    return list(axes.plot(*front.curve, **style))


@draws("spectrum")
def draw_spectrum(
    spectrum: ResponseSpectrum,
    axes: Axes | None = None,
    *,
    what: Literal["residual", "peak"] = "residual",
    over: float = 1.0,
    **style: Any,  # noqa: ANN401 - matplotlib's
) -> list[Artist]:
    """Draw residual or peak acceleration over nu into axes, new ones unless given, and return the artists.

    `over` divides the acceleration, for example by C of the law meant for the mass.

    Examples
    --------
    >>> from optlaws import response_spectrum, savin
    >>> (line,) = draw_spectrum(response_spectrum(savin("III", 7.2), [18.0, 19.0, 20.0]), color=GREEN)
    >>> line.axes.get_ylabel()
    'residual acceleration'
    """
    if axes is None:
        axes = new_axes()
    values = spectrum.residual_acceleration if what == "residual" else spectrum.peak_acceleration
    axes.set(xlabel="nu, radians of the free vibration in the rise", ylabel=f"{what} acceleration")
    return list(axes.plot(spectrum.nu, values / over, **style))


@draws("output")
def draw_output(
    curve: OutputCurve,
    axes: Axes | None = None,
    *,
    count: int = 801,
    **style: Any,  # noqa: ANN401 - matplotlib's
) -> list[Artist]:
    """Draw an output of a machine over time into axes, new ones unless given.

    Examples
    --------
    >>> from optlaws import Machine, smoothstep
    >>> machine = Machine([[0, 1], [-400, 0]], [[0], [400]], [[1, 0]], outputs=["position"])
    >>> (line,) = draw_output(machine.response(smoothstep(4), dwell=0.5)["position"])
    >>> line.axes.get_xlabel(), line.axes.get_ylabel()
    ('time, durations of the rise', 'position')
    """
    if axes is None:
        axes = new_axes()
    axes.set(xlabel="time, durations of the rise", ylabel=curve.name)
    return list(axes.plot(*curve.samples(count), **{"color": DISTINCT[0], **style}))


@draws("machine_spectrum")
def draw_machine_spectrum(
    spectrum: MachineSpectrum,
    axes: Axes | None = None,
    **style: Any,  # noqa: ANN401 - matplotlib's
) -> list[Artist]:
    """Draw an output's peak and what is left in it of each mode into axes, new ones unless given.

    Examples
    --------
    >>> from optlaws import Machine, machine_spectrum, smoothstep
    >>> machine = Machine([[0, 1], [-400, 0]], [[0], [400]], [[1, 0]], outputs=["position"])
    >>> lines = draw_machine_spectrum(machine_spectrum(machine.at_speed, [0.5, 1.0], smoothstep(4)))
    >>> lines[0].axes.get_ylabel()
    'position'
    """
    if axes is None:
        axes = new_axes()
    axes.set(xlabel=spectrum.parameter, ylabel=spectrum.output)
    lines = axes.plot(spectrum.values, spectrum.peaks[spectrum.output], **{"color": GREY, "label": "peak", **style})
    for i, left in enumerate(spectrum.residuals.T):
        named = {"color": DISTINCT[i % len(DISTINCT)], "label": f"mode {i + 1} left", **style}
        lines += axes.plot(spectrum.values, left, **named)
    axes.set_ylim(bottom=0.0)
    axes.legend(frameon=False)
    return list(lines)


def save_picture(drawing: Figure, place: Path) -> list[Path]:
    """Write a figure as svg and png: `place` has no ending. Both are left as they are where they show the same.

    Fonts and renderers differ between machines, so that the svg, whose places can be compared, speaks for its twin.
    """
    vector, raster = (place.with_name(f"{place.name}.{kind}") for kind in ("svg", "png"))
    content = rendered(drawing, "svg")
    if not (writing.is_current(vector, content) and writing.is_own(raster)):
        writing.write(raster, rendered(drawing, "png"))
    writing.write(vector, content)
    return [vector, raster]


def save_pictures(drawings: Mapping[str, Figure], folder: Path) -> list[Path]:
    """Write figures by name: see `save_picture`."""
    return [path for name, drawing in drawings.items() for path in save_picture(drawing, folder / name)]


def rendered(drawing: Figure, kind: str) -> bytes:
    """The picture as svg or png, without the date: the same drawing gives the same bytes."""
    stream = io.BytesIO()
    metadata = {"svg": {"Date": None, "Creator": MARK}, "png": {"Software": MARK}}[kind]
    with style():
        drawing.savefig(stream, format=kind, metadata=metadata)
    return stream.getvalue()
