"""How a cycle shows itself in a notebook: what is known of it, its segments, and its motion drawn small."""

from __future__ import annotations

from typing import Any

import numpy as np

from optlaws.errors import OptlawsError
from optlaws.shown.showing import drawing, facts, page, table

_SAMPLES = 241
_UNITS = {"length": "m", "angle": "rad"}


def cycle_page(cycle: Any) -> str:  # noqa: ANN401 - a Cycle, which asks for this page
    """A cycle as HTML; where its laws cannot be had, the error in their place.

    Examples
    --------
    >>> from optlaws import Cycle, Return, Rise
    >>> shown = cycle_page(Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm"))
    >>> shown.count("<svg"), "acceleration, m/s²" in shown
    (4, True)
    """
    try:
        known = {"status": cycle.status.value, cycle.minimise: cycle.objective, "lower bound": cycle.lower_bound}
    except OptlawsError as error:
        return page("Cycle", facts({"turn, s": cycle.duration, "error": error}))
    unit = _UNITS[cycle.axis]
    names = [f"position, {unit}", f"velocity, {unit}/s", f"acceleration, {unit}/s²", f"jerk, {unit}/s³"]
    rows = [(peak.name, peak.duration, *(peak.peak(nu) for nu in (1, 2, 3))) for peak in cycle.peaks]
    times = np.linspace(0.0, cycle.duration, _SAMPLES)
    drawings = [drawing(name, times.tolist(), cycle(times, nu).tolist()) for nu, name in enumerate(names)]
    return page("Cycle", facts(known), table(("segment", "duration, s", *names[1:]), rows), *drawings)
