"""Laws as drives of a machine: Chebyshev series of a, b and c at every time."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import ceil
from typing import TYPE_CHECKING

import numpy as np

from optlaws.laws import MotionLaw
from optlaws.mechanisms.forcing import Forcing, forcings
from optlaws.mechanisms.machine.dynamics import DriveStretch
from optlaws.numbers import Array
from optlaws.numerics import chebyshev

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace

_RADIANS = 10.0
_COUNT = 41


def of_law(
    law: MotionLaw, start: float = 0.0, length: float = 1.0, a0: float | None = None, stroke: float = 1.0
) -> list[DriveStretch]:
    """A law as it drives a machine, a0 + stroke (law(k) - law(0)) with k = (time - start) / length."""
    return [drive for forcing in forcings(law, start, length, a0, stroke) for drive in _drives(forcing)]


def rest(start: float, length: float, level: Array | float) -> DriveStretch:
    """A dwell at displacements, one for each column."""
    series = np.zeros((1, 3, np.size(level)))
    series[0, 0] = level
    return DriveStretch(start, length, series)


def of_space(space: LawSpace) -> list[DriveStretch]:
    """The drives of all laws of a space at once: a column for each free function, the base law's last."""
    breaks: Sequence[float] = getattr(space, "breaks", (0.0, 1.0))
    x = chebyshev.nodes(_terms(space))
    drives = []
    for low, high in pairwise(breaks):
        k = low + 0.5 * (high - low) * (x + 1.0)
        values = np.stack([_values(space, nu, k) for nu in range(3)], axis=1)
        series = chebyshev.from_values(values.reshape(len(k), -1)).reshape(values.shape)
        drives.append(DriveStretch(float(low), float(high - low), np.ascontiguousarray(series)))
    return drives


def backward(drives: Sequence[DriveStretch], start: float, length: float, level: Array) -> list[DriveStretch]:
    """The return of such drives, level - (a - a(0)), stretched to a length."""
    panels = []
    low = drives[0].ends[0][0]
    for drive in drives:
        series = -drive.series / length ** np.arange(3.0)[:, None]
        series[0, 0] += level + low
        panels.append(DriveStretch(start + length * drive.start, length * drive.length, series))
    return panels


def _terms(space: LawSpace) -> int:
    """Coefficients that every law of a space has at most, on each piece."""
    from optlaws.synthesis.spaces.piecewise_families import PieceFamily

    velocity = space.derivative(1, "b", np.zeros(space.terms))
    return 2 + (velocity.pieces.series.shape[1] if isinstance(velocity, PieceFamily) else len(velocity.series))


def _values(space: LawSpace, nu: int, k: Array) -> Array:
    """Columns of a derivative at k; of symmetric laws the second half mirrors the first."""
    family = space.derivative(nu, "", np.zeros(space.terms))
    mirrored = space.symmetric & (k > 0.5)
    columns = family.columns(1.0 - 2.0 * np.where(mirrored, 1.0 - k, k))[0]
    if nu != 1:
        columns[mirrored] *= -1.0
    if nu == 0 and mirrored.any():
        # also a single function that is not at half the stroke there goes on
        columns[mirrored] += 2.0 * family.columns(np.zeros(1))[0]
    return np.asarray(columns)


def _drives(forcing: Forcing) -> list[DriveStretch]:
    if not forcing.sines:
        # as it is: values at nodes would round all coefficients as much as the greatest, which shakes the machine
        exact = np.zeros((len(forcing.acceleration) + 2, 3, 1))
        for order, coefficients in enumerate(forcing.series):
            exact[: len(coefficients), order, 0] = coefficients
        return [DriveStretch(forcing.start, forcing.length, exact)]
    fastest = max(sine.frequency for sine in forcing.sines)
    count = max(1, ceil(fastest * forcing.length / _RADIANS))
    length = forcing.length / count
    terms = max(len(forcing.acceleration) + 2, _COUNT)
    places = 0.5 * length * (chebyshev.nodes(terms) + 1.0)
    drives = []
    for i in range(count):
        s = np.minimum(i * length + places, forcing.length)
        values = np.column_stack([forcing.derivative(s, nu) for nu in range(3)])
        series = np.asarray(chebyshev.from_values(values))[:, :, None]
        drives.append(DriveStretch(forcing.start + i * length, length, series))
    return drives
