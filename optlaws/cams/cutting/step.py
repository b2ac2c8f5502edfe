"""STEP files: an outline as one B-spline curve, written by an OpenCascade binding if there is one."""

from __future__ import annotations

from optlaws.cams.cutting.options import Cutting
from optlaws.cams.cutting.outline import Outline
from optlaws.errors import InputError


def as_step(outline: Outline, asked: Cutting) -> str:
    """One B_SPLINE_CURVE_WITH_KNOTS in millimetres."""
    raise InputError("STEP files are written by OpenCascade: pip install 'optlaws[step]'")
