"""The command `optlaws follower`: the motion of an elastic follower's mass on a cam."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import optlaws
from optlaws.cli.law_options import FollowerFrequency, named
from optlaws.cli.options import given, options, takes
from optlaws.cli.show import Answer
from optlaws.errors import InputError
from optlaws.laws.catalogue.reading import read_law
from optlaws.motion.quantities import quantity

if TYPE_CHECKING:
    from matplotlib.artist import Artist

_POINTS = 2001
_UNITS = "A follower with units"
_FOLLOWER = "optlaws.mechanisms.machine.follower:from_vibration"


@takes(
    "Draw the motion of the mass, or with --spectrum the response spectrum, into this file, PNG or SVG.",
    times=options(_FOLLOWER, "duration", "speed", "rise", group=_UNITS),
    stroke=options("optlaws.mechanisms.machine.response:in_units", "stroke", group=_UNITS),
    ratio=options(_FOLLOWER, "damping"),
)
def follower(
    law: str,
    /,
    *,
    alpha: float | None = None,
    frequency: FollowerFrequency | None = None,
    natural_frequency: str | None = None,
    natural_period: str | None = None,
    times: Mapping[str, str | None],
    stroke: Mapping[str, str | None],
    ratio: Mapping[str, float],
    design_frequency: float | None = None,
    design_damping: float | None = None,
    spectrum: tuple[float, float] | None = None,
    plot: Path | None,
) -> Answer:
    """Response of an elastic follower's mass: peaks, dynamic factor, residual vibration, and the same off design.

    Parameters
    ----------
    law
        Law meant for the mass: a name of the catalogue, a member such as III(7.2), a JSON file of a law or of
        `optlaws solve --output`, or a CSV file with a table of points.
    alpha
        Member of the family, where the law is I, II, III or IV.
    frequency
        Frequency nu of the follower: radians of its undamped free vibration in the rise.
    natural_frequency
        In place of --frequency: frequency of the undamped free vibration with its unit, such as "16.7 Hz".
    natural_period
        In place of --natural-frequency: period of the undamped free vibration with its unit, such as "60 ms".
    design_frequency
        Cut the cam so that the mass moves by the law at this frequency; without it the law itself is cut.
    design_damping
        Damping ratio for which the cam is cut; that of the follower unless given.
    spectrum
        Range of frequencies: --plot draws the response spectrum over it.
    """
    if plot is None and spectrum is not None:
        raise InputError("--spectrum LOW HIGH gives the range of frequencies for --plot FILE: name the file too")
    damping, height, times = ratio["damping"], stroke["stroke"], given(times)
    if height is not None and not times:
        raise InputError(
            "--stroke needs the time of the rise: give --natural-frequency with --speed and --rise, or --duration"
        )
    vibration = {"--natural-frequency": natural_frequency, "--natural-period": natural_period}
    mass = _follower(frequency, given(vibration), times, damping)
    reference = cam = read_law(named(law, alpha, None, "--alpha"))
    if design_frequency is None and design_damping is not None:
        raise InputError("--design-damping needs --design-frequency")
    if design_frequency is not None:
        cam = optlaws.polydyne(reference, design_frequency, damping if design_damping is None else design_damping)
    machine = {} if height is None else {"stroke": height, **times}
    drawn = mass.response(cam).plot if spectrum is None else lambda: _spectrum(cam, damping, spectrum)
    return Answer.of(mass.report(cam, reference, machine), drawn)


def _follower(
    frequency: float | None, vibration: Mapping[str, str], times: Mapping[str, str], damping: float
) -> optlaws.Follower:
    if frequency is not None:
        if vibration or times:
            others = ", ".join([*vibration, *(f"--{name}" for name in times)])
            raise InputError(f"{others}: of a machine; give no --frequency beside")
        return optlaws.Follower(frequency, damping)
    if len(vibration) != 1:
        raise InputError(
            "give either --frequency or, with units, --natural-frequency such as '16.7 Hz' or --natural-period such as "
            "'60 ms', and not both, with --duration or with --speed and --rise"
        )
    ((name, text),) = vibration.items()
    quantity(text, "frequency" if name == "--natural-frequency" else "time", name)
    return optlaws.Follower.from_vibration(text, **times, damping=damping)


def _spectrum(cam: optlaws.MotionLaw, damping: float, span: tuple[float, float]) -> list[Artist]:
    import numpy as np

    from optlaws.plots.report import draw_panels
    from optlaws.plots.style import one_below_the_other

    if not 0.0 < span[0] < span[1]:
        raise InputError(
            f"--spectrum takes a range of frequencies, two rising numbers above 0, got {span[0]:g} {span[1]:g}"
        )
    panels = optlaws.response_spectrum(cam, np.linspace(*span, _POINTS), damping).report().panels
    return draw_panels(panels, (), one_below_the_other(None, len(panels), 6.4))
