"""How laws and motions of a mass show themselves in a notebook: their constants, and a, b, c and j drawn small."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.shown import showing

if TYPE_CHECKING:
    from optlaws.laws.curve import Curve

_SAMPLES = 121


def table_of_constants(constants: Any) -> str:  # noqa: ANN401 - Constants, which show themselves by it
    """The peaks with their places, and the root mean square of c.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> "<td>5.773503</td>" in table_of_constants(smoothstep(3).constants)
    True
    """
    peaks = {name: getattr(constants, name) for name in "BCDJ"}
    rows: list[list[object]] = [[name, peak.value, peak.k] for name, peak in peaks.items()]
    return showing.table(("", "peak", "k"), [*rows, ["RMS c", constants.rms_c, None]])


def drawings(curve: Curve) -> str:
    """Small drawings of a, b, c and j over the whole interval; what grows without limit is cut at the highest sample.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> drawings(smoothstep(3)).count("<svg")
    4
    """
    k = np.linspace(*curve.interval, _SAMPLES)
    places = k.tolist()
    return "".join(
        showing.drawing(name, places, np.asarray(curve(k, nu), dtype=float).tolist()) for nu, name in enumerate("abcj")
    )
