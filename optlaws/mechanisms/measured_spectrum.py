"""Measured spectra: amplitudes over frequency that weigh what vibration may be left, from files and arrays."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from heapq import heappop, heappush
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws.catalogue.reading import points_of
from optlaws.motion.quantities import TURN, positive_quantity
from optlaws.numbers import Array, Quantity, numbers, whole

#: points of a weight: each interval between two is a constraint of its own
MOST_POINTS = 20_000
_PAIR = re.compile(r"\s*([^\s:,]+)\s*:\s*([^\s:,]+)\s*")


class WeightPart(NamedTuple):
    """An interval of frequencies over which a weight is linear: both ends, and the weights there.

    Examples
    --------
    >>> WeightPart(10.0, 20.0, 1.0, 2.0).at(15.0)
    1.5
    """

    low: float
    high: float
    first: float
    last: float

    def at(self, frequency: Any) -> Any:
        """The weight at frequencies in the interval."""
        if self.low == self.high:
            return self.first + 0.0 * frequency
        return self.first + (frequency - self.low) * ((self.last - self.first) / (self.high - self.low))


Spectrum = tuple[tuple[float, float], ...]


def spectrum_of(given: Any, frequency: tuple[float, float] | None = None) -> Spectrum:
    """A weight as pairs of a frequency nu and an amplitude, linear between them, over an interval where one is given.

    Parameters
    ----------
    given
        Pairs, a table of them, or text such as "{18: 0.5, 20: 1, 22: 0.5}".
    frequency
        The interval, within the pairs; all of them unless given.

    Raises
    ------
    InputError
        If frequencies do not increase or are not above 0, an amplitude is below 0 or all are 0, or there are too many.

    Examples
    --------
    >>> spectrum_of("{18: 0.5, 20: 1, 22: 0.5}", (19.0, 22.0))
    ((19.0, 0.75), (20.0, 1.0), (22.0, 0.5))
    """
    nu, sizes = _columns(given)
    if len(nu) < 2 or (np.diff(nu) <= 0.0).any() or nu[0] <= 0.0:
        raise InputError(
            f"a spectrum has two frequencies at least, above 0 and increasing, got {shortened(nu.tolist())}"
        )
    if (sizes < 0.0).any() or not sizes.any():
        raise InputError(f"amplitudes of a spectrum are at least 0, and one is above, got {shortened(sizes.tolist())}")
    if len(nu) > MOST_POINTS:
        raise InputError(
            f"a spectrum has {MOST_POINTS} points at most, got {len(nu)}: `read_spectrum` with points=1000 covers them "
            "by fewer"
        )
    if frequency is None:
        return tuple(zip(nu.tolist(), sizes.tolist(), strict=True))
    low, high = frequency
    if low < nu[0] or high > nu[-1]:
        raise InputError(
            f"the spectrum is known from {nu[0]:g} to {nu[-1]:g}, and the frequencies are {low:g} to {high:g}"
        )
    inside = [low, *(x for x in nu.tolist() if low < x < high), *([high] if high > low else [])]
    return tuple(zip(inside, np.interp(inside, nu, sizes).tolist(), strict=True))


def weight_of(given: Any, duration: Any = None) -> Spectrum:
    """A weight from pairs, text or a file, whose frequencies are in Hz where the duration of the motion is given.

    >>> [(round(nu, 3), size) for nu, size in weight_of("{30: 0.2, 32: 1}", 0.1)]
    [(18.85, 0.2), (20.106, 1.0)]
    """
    time = f"{duration!r} s" if isinstance(duration, int | float) and not isinstance(duration, bool) else duration
    file = given.strip().removeprefix("{").removesuffix("}").strip() if isinstance(given, str) else given
    if isinstance(file, Path) or (isinstance(file, str) and not _PAIR.fullmatch(file.split(",")[0])):
        return read_spectrum(file, duration=time)
    return spectrum_of([(_in_motion(time) * nu, size) for nu, size in spectrum_of(given)])


def _in_motion(duration: Quantity | None) -> float:
    """Radians in the motion that a frequency of 1 is."""
    return 1.0 if duration is None else TURN * positive_quantity(duration, "time", "duration")


def parts_of(spectrum: Spectrum) -> tuple[WeightPart, ...]:
    """The intervals in which a weight is not identically 0.

    >>> len(parts_of(((1.0, 0.0), (2.0, 0.0), (3.0, 1.0))))
    1
    """
    if len(spectrum) == 1:
        ((nu, size),) = spectrum
        return (WeightPart(nu, nu, size, size),)
    pairs = pairwise(spectrum)
    return tuple(WeightPart(a[0], b[0], a[1], b[1]) for a, b in pairs if a[1] or b[1])


def above(frequency: Any, amplitude: Any, points: int) -> Spectrum:
    """A spectrum of fewer points that is nowhere below the original, and as little above it as these points allow.

    The points stand where the original bends most; a linear program finds the least amplitudes there.

    Parameters
    ----------
    frequency, amplitude
        Shapes (n,), the frequencies increasing.
    points
        How many.

    Raises
    ------
    InputError
        If the shapes differ or frequencies do not increase.

    Examples
    --------
    >>> above([1, 2, 3, 4, 5], [0, 0, 1, 0, 0], 3)
    ((1.0, 0.0), (3.0, 1.0), (5.0, 0.0))
    """
    count = whole(points, "points", least=2, most=MOST_POINTS)
    nu, sizes = _columns(list(zip(np.ravel(frequency).tolist(), np.ravel(amplitude).tolist(), strict=True)))
    if len(nu) < 2 or (np.diff(nu) <= 0.0).any():
        raise InputError(f"a spectrum has two frequencies at least, increasing, got {shortened(nu.tolist())}")
    if len(nu) <= count:
        return tuple(zip(nu.tolist(), sizes.tolist(), strict=True))
    places = _bends(nu, sizes, count)
    return tuple(zip(nu[places].tolist(), _least_above(nu, sizes, places).tolist(), strict=True))


def _bends(frequencies: Array, sizes: Array, count: int) -> Array:
    """The indices of so many points, the ends among them: each where the original is furthest from the lines."""

    def furthest(first: int, last: int) -> tuple[float, int, int, int]:
        inner = slice(first + 1, last)
        line = np.interp(frequencies[inner], frequencies[[first, last]], sizes[[first, last]])
        off = np.abs(sizes[inner] - line)
        at = int(np.argmax(off)) if last - first > 1 else 0
        return (-float(off[at]) if last - first > 1 else 0.0), first, first + 1 + at, last

    chosen, spans = {0, len(frequencies) - 1}, [furthest(0, len(frequencies) - 1)]
    while len(chosen) < count and spans[0][0] < 0.0:
        _, first, middle, last = heappop(spans)
        chosen.add(middle)
        for part in ((first, middle), (middle, last)):
            heappush(spans, furthest(*part))
    return np.array(sorted(chosen))


def _least_above(frequencies: Array, sizes: Array, places: Array) -> Array:
    """The amplitudes of least sum at some of the points whose lines are nowhere below the original."""
    from scipy.optimize import linprog
    from scipy.sparse import csr_array

    beside = np.clip(np.searchsorted(places, np.arange(len(frequencies)), side="right") - 1, 0, len(places) - 2)
    share = (frequencies - frequencies[places[beside]]) / (
        frequencies[places[beside + 1]] - frequencies[places[beside]]
    )
    rows = np.arange(len(frequencies))
    parts = np.concatenate([1.0 - share, share]), (np.tile(rows, 2), np.concatenate([beside, beside + 1]))
    rows_of_lines: Any = -csr_array(parts)
    top = float(sizes.max())
    if top == 0.0:
        return np.zeros(len(places))
    solved = linprog(np.ones(len(places)), A_ub=rows_of_lines, b_ub=-sizes / top, bounds=(0.0, None))
    values = np.full(len(places), top) if solved.x is None else top * solved.x
    # what the program leaves open for its tolerance
    short = float((sizes - ((1.0 - share) * values[beside] + share * values[beside + 1])).max())
    return np.asarray(values + max(short, 0.0))


def read_spectrum(
    file: str | Path,
    *,
    duration: Quantity | None = None,
    points: int | None = None,
    columns: Sequence[int | str] | None = None,
) -> tuple[tuple[float, float], ...]:
    r"""A measured spectrum from a file: frequencies nu and amplitudes, as weight of `residual_vibration`.

    Parameters
    ----------
    file
        Columns of frequency and amplitude, as `read_law` takes columns; the amplitude is at least 0.
    duration
        Of the motion, such as "0.1 s", where frequencies are in Hz: nu is 2 pi times frequency and duration. Without it
        they are nu, in radians in the motion.
    points
        All of the file's unless given: else a file with more is replaced by a spectrum of so many that is nowhere below
        it.
    columns
        Which are meant, by headings or numbers from 1, of a file with more than two.

    Returns
    -------
    Pairs of a frequency and an amplitude; between them it is linear.

    Raises
    ------
    InputError
        If the file cannot be read, frequencies do not increase, or an amplitude is below 0.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     _ = (Path(folder) / "shaker.csv").write_text("Hz,amplitude\n30,0.2\n32,1.0\n35,0.3\n")
    ...     spectrum = read_spectrum(Path(folder) / "shaker.csv", duration="0.1 s")
    >>> [(round(nu, 3), amplitude) for nu, amplitude in spectrum]
    [(18.85, 0.2), (20.106, 1.0), (21.991, 0.3)]
    """
    table = points_of(Path(file), columns)
    try:
        nu = _in_motion(duration) * np.array(table.places)
        if points is None:
            return spectrum_of(zip(nu.tolist(), table.heights, strict=True))
        return spectrum_of(above(nu, np.array(table.heights), points))
    except InputError as error:
        raise InputError(f"{file}: {error}") from None


def _columns(given: Any) -> tuple[Any, Any]:
    pairs = _pairs_of_text(given) if isinstance(given, str) else given
    try:
        listed = [tuple(pair) for pair in (pairs.items() if isinstance(pairs, Mapping) else pairs)]
    except TypeError:
        listed = []
    if not listed or any(len(pair) != 2 for pair in listed):
        raise InputError(f"a spectrum is pairs of a frequency and an amplitude, got {shortened(given)}")
    nu = numbers([pair[0] for pair in listed], "frequency")
    return np.array(nu), np.array(numbers([pair[1] for pair in listed], "amplitude"))


def _pairs_of_text(text: str) -> list[tuple[float, float]]:
    inner = text.strip().removeprefix("{").removesuffix("}").strip()
    pairs = []
    for part in inner.split(","):
        match = _PAIR.fullmatch(part)
        try:
            pairs.append((float(match[1]), float(match[2])))  # type: ignore[index] # none is a TypeError
        except (TypeError, ValueError):
            raise InputError(f"a spectrum as text is {{18: 0.5, 20: 1}}, got {shortened(text)}") from None
    return pairs
