"""Waves that the residuals of a fitted motion show, as grinding leaves them, and what they add to its peaks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from optlaws.cycles.old_tables.peak_intervals import PeakInterval
from optlaws.cycles.old_tables.stretches import Stretch
from optlaws.numbers import Array

#: rows of each wave, at least; and waves in a turn: what is longer is the motion itself
_ROWS_OF_WAVE, _FEWEST_WAVES = 6, 6
#: of a wave with the power that noise of all frequencies has in the mean: the chance to be noise is exp(-power)
_POWER = 20.0


def waves_of(places: Array, residuals: Array, noise: float) -> tuple[tuple[float, float], ...]:
    """The amplitudes and the wave numbers, by the place in radians, of waves in residuals that noise does not explain.

    Examples
    --------
    >>> x = np.linspace(0.0, 360.0, 721)
    >>> residuals = np.random.default_rng(1).normal(0.0, 5e-3, 721) + 3e-3 * np.sin(30.0 * np.radians(x))
    >>> [(round(size, 4), round(float(np.degrees(number)), 1)) for size, number in waves_of(x, residuals, 5e-3)]
    [(0.003, 30.0)]
    >>> few = slice(0, None, 17)  # 43 rows show one number of waves
    >>> [round(float(np.degrees(number)), 1) for _, number in waves_of(x[few], np.sin(6.0 * np.radians(x[few])), 5e-3)]
    [6.0]
    """
    from scipy.signal import lombscargle

    turn, count = float(np.ptp(places)), len(places)
    numbers = 2.0 * np.pi / turn * np.arange(_FEWEST_WAVES, count // _ROWS_OF_WAVE)
    if noise <= 0.0 or not len(numbers):
        return ()
    powers = np.atleast_1d(lombscargle(places, residuals, numbers)) / noise**2  # it has no axis for one number
    far = np.flatnonzero(powers > _POWER)
    return tuple((float(2.0 * noise * np.sqrt(powers[i] / count)), float(numbers[i])) for i in far)


def with_waves(parts: Sequence[Stretch], waves: Sequence[tuple[float, float]]) -> Iterator[Stretch]:
    """Stretches whose velocities, accelerations and jerks may be more by those of waves."""
    for part in parts:
        more = (sum(size * number**nu for size, number in waves) for nu in (1, 2, 3))
        peaks = tuple(PeakInterval(peak.low, peak.high + each) for peak, each in zip(part.peaks, more, strict=False))
        yield replace(part, peaks=peaks)
