"""A cam that turns under its follower: an SVG that moves by itself in any browser."""

from __future__ import annotations

import numpy as np

from optlaws.cams.cutting.spline import spline
from optlaws.cams.cutting.text_formats import beziers
from optlaws.cams.disc import DiscCam
from optlaws.files.writing import MARK
from optlaws.numbers import Array
from optlaws.plots.style import BLUES, GREY, WARM

_MILLI = 1e3
_FRAMES = 241
_NEAR = 1e-5
_FACE = 0.6  # half the length of a face, in least radii
_MARGIN = 6.0


def animated(cam: DiscCam, seconds: float = 4.0) -> str:
    """The picture of one turn in so many seconds, over and over, in millimetres; y points up."""
    outline = beziers(spline(cam.profile, _NEAR)) * [_MILLI, -_MILLI]
    path = (
        f"M {_pair(outline[0, 0])} " + " ".join(f"C {_pair(a)} {_pair(b)} {_pair(c)}" for _, a, b, c in outline) + " Z"
    )
    every = f'dur="{seconds:g}s" repeatCount="indefinite"'
    turn = -360.0 * cam.contact.turning
    kind, values = _moved(cam)
    half = _MILLI * (_reach(cam) + 0.5 * cam.contact.roller) + _MARGIN
    box = f"{-half:.3f} {-half:.3f} {2 * half:.3f} {2 * half:.3f}"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="480" height="480" viewBox="{box}">\n'
        f"<desc>a cam that turns under its follower; {MARK}</desc>\n"
        f'<g fill="none" stroke-width="{half / 180:.3f}">\n'
        f'<path fill="#dfe9f3" stroke="{BLUES[3]}" d="{path} M 0 0 H {half / 8:.3f}">\n'
        f'<animateTransform attributeName="transform" type="rotate" from="0" to="{turn:g}" {every}/></path>\n'
        f'<g stroke="{WARM}">{_follower(cam)}\n'
        f'<animateTransform attributeName="transform" type="{kind}" values="{values}" {every}/></g>\n'
        f'<circle r="{half / 60:.3f}" stroke="{GREY}"/>\n</g>\n</svg>\n'
    )


def _reach(cam: DiscCam) -> float:
    """How far from the centre anything is."""
    angles = np.linspace(*cam.displacement.interval, _FRAMES)
    far = float(np.linalg.norm(cam.pitch_curve(angles), axis=1).max()) + 2.0 * cam.contact.roller
    return max(far, cam.contact.pivot or 0.0)


def _moved(cam: DiscCam) -> tuple[str, str]:
    """How the follower moves from where it is at first: along its way, or about its pivot, clockwise as it rises."""
    angles = np.linspace(*cam.displacement.interval, _FRAMES)
    off = np.asarray(cam.displacement(angles)) - float(cam.displacement(float(angles[0])))
    if cam.contact.pivot is not None:
        pivot = f"{_MILLI * cam.contact.pivot:.3f} 0"
        return "rotate", ";".join(f"{np.degrees(angle):.4f} {pivot}" for angle in off)
    return "translate", ";".join(f"0 {-_MILLI * length:.4f}" for length in off)


def _follower(cam: DiscCam) -> str:
    """The follower as it is at first."""
    contact, first = cam.contact, np.array(cam.displacement.interval[0])
    s = cam.displacement.jet(first, 2)
    x, y = (_MILLI * float(coordinate.terms[0]) for coordinate in contact.point(s))
    if not contact.roller:
        normal = contact.normal(s)
        along = (
            np.array([1.0, 0.0]) if normal is None else np.array([float(n.terms[0]) for n in (normal[1], normal[0])])
        )
        way = _FACE * _MILLI * _reach(cam) * along * [1.0, -1.0]
        return f'<path d="M {x - way[0]:.3f} {-(y - way[1]):.3f} L {x + way[0]:.3f} {-(y + way[1]):.3f}"/>'
    end = f"{x:.3f} {-2.0 * y:.3f}" if contact.pivot is None else f"{_MILLI * contact.pivot:.3f} 0"
    return (
        f'<circle cx="{x:.3f}" cy="{-y:.3f}" r="{_MILLI * contact.roller:.3f}" fill="white"/>'
        f'<path d="M {x:.3f} {-y:.3f} L {end}"/>'
    )


def _pair(point: Array) -> str:
    return f"{point[0]:.3f},{point[1]:.3f}"
