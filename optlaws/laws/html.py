"""Small drawings of a, b, c and j of laws and motions of a mass, for notebooks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from optlaws.shown import showing

if TYPE_CHECKING:
    from optlaws.laws.curve import Curve

_SAMPLES = 121


def drawings(curve: Curve) -> str:
    """Small drawings of a, b, c and j over the whole interval; what grows without limit is cut at the highest sample.

    >>> from optlaws import smoothstep
    >>> drawings(smoothstep(3)).count("<svg")
    4
    """
    k = np.linspace(*curve.interval, _SAMPLES)
    places = k.tolist()
    return "".join(
        showing.drawing(name, places, np.asarray(curve(k, nu), dtype=float).tolist()) for nu, name in enumerate("abcj")
    )
