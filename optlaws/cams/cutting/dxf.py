"""DXF files: an outline as a SPLINE, as an LWPOLYLINE or as ARCs, in millimetres, written by ezdxf."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from logging import ERROR, getLogger
from math import atan2, degrees
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.cams.cutting.arcs_and_chords import arcs, polygon
from optlaws.cams.cutting.file_options import Cutting
from optlaws.cams.cutting.outline import Outline
from optlaws.cams.cutting.spline import spline
from optlaws.errors import InputError
from optlaws.files.writing import MARK
from optlaws.locks import process_lock

if TYPE_CHECKING:
    from ezdxf.layouts.layout import Modelspace


LAYER, CENTRE = "PROFILE", "CENTRE"
_MILLIMETRES = 4
_OLD = "R12"  # knows no units
_lock = process_lock()


def as_spline(outline: Outline, options: Cutting) -> str:
    """One clamped SPLINE of degree 3 or 5 whose parameter is the cam's angle in radians."""
    fitted = spline(outline, options.metres, options.degree)

    def draw(space: Modelspace) -> None:
        from ezdxf.math import BSpline

        points = [(1e3 * x, 1e3 * y, 0.0) for x, y in fitted.controls.tolist()]
        curve = BSpline(points, order=fitted.degree + 1, knots=fitted.knots.tolist())
        space.add_spline(dxfattribs={"layer": LAYER}).apply_construction_tool(curve)

    return _document("R2000", options, draw)


def as_polyline(outline: Outline, options: Cutting) -> str:
    """One closed LWPOLYLINE with its corners on the curve."""
    corners = np.round(1e3 * polygon(outline, options.metres).corners, options.decimals)

    def draw(space: Modelspace) -> None:
        space.add_lwpolyline(corners.tolist(), format="xy", close=True, dxfattribs={"layer": LAYER})

    return _document("R2000", options, draw)


def as_arcs(outline: Outline, options: Cutting) -> str:
    """ARCs that touch each other, and LINEs where it is straight, in a file of release 12, which all cutters read."""
    chain = arcs(outline, options.metres)
    rows = zip(1e3 * chain.points, 1e3 * chain.ends, 1e3 * chain.centres, 1e3 * chain.radii, chain.bulges, strict=True)

    def draw(space: Modelspace) -> None:
        for start, stop, centre, radius, bulge in rows:
            attributes = {"layer": LAYER}
            if bulge == 0.0:
                space.add_line(start.tolist(), stop.tolist(), dxfattribs=attributes)
                continue
            first, last = (degrees(atan2(*(point - centre)[::-1])) for point in (start, stop))
            # an ARC always runs counterclockwise
            first, last = (first, last) if bulge > 0.0 else (last, first)
            space.add_arc(centre.tolist(), float(radius), first, last, dxfattribs=attributes)

    return _document(_OLD, options, draw)


def _document(release: str, options: Cutting, draw: Callable[[Modelspace], None]) -> str:
    """The text of a file with a drawing and the cam's centre, the same whenever it is written."""
    ezdxf = _ezdxf()
    stream = io.StringIO()
    with _without_date(ezdxf):
        document = ezdxf.new(release, units=0 if release == _OLD else _MILLIMETRES)
        for name in (LAYER, CENTRE):
            document.layers.add(name)
        draw(document.modelspace())
        document.modelspace().add_point((0.0, 0.0), dxfattribs={"layer": CENTRE})
        document.write(stream)
    return f"999\n{options.line}; {MARK}\n{stream.getvalue()}"


def _ezdxf() -> Any:  # noqa: ANN401 - a module
    try:
        import ezdxf
    except ImportError:
        raise InputError("DXF files are written by ezdxf: pip install 'optlaws[cad]'") from None
    return ezdxf


@contextmanager
def _without_date(ezdxf: Any) -> Iterator[None]:  # noqa: ANN401 - a module
    with _lock:
        # it warns of the units of release 12 even where there are none
        logger = getLogger("ezdxf")
        previous, level = ezdxf.options.write_fixed_meta_data_for_testing, logger.level
        ezdxf.options.write_fixed_meta_data_for_testing = True
        logger.setLevel(ERROR)
        try:
            yield
        finally:
            ezdxf.options.write_fixed_meta_data_for_testing = previous
            logger.setLevel(level)
