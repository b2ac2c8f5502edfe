"""Spectra over frequency: of what a law does to followers of every frequency, and measured ones that weigh it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from itertools import pairwise
from math import ceil
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.tables.columns import points_of
from optlaws.laws.law import motion_law
from optlaws.mechanisms.machine.drives import Forcing, forcings
from optlaws.mechanisms.machine.transforms import legendre_from_chebyshev, moments, residual_phasor, roots
from optlaws.motion.quantities import TURN, check_scale, quantity
from optlaws.numbers import Array, Complex, NumberOrQuantity, numbers, positive, whole
from optlaws.numerics import chebyshev
from optlaws.shown.report import Panel, PlainReport, Report, ReportTable, Series
from optlaws.shown.summary import Row, Summary

#: points of a weight: each interval between two is a constraint of its own
MOST_POINTS = 20_000
_PAIR = re.compile(r"\s*([^\s:,]+)\s*:\s*([^\s:,]+)\s*")


class WeightPart(NamedTuple):
    """An interval of frequencies over which a weight is linear: both ends, and the weights there."""

    low: float
    high: float
    first: float
    last: float


Spectrum = tuple[tuple[float, float], ...]


def spectrum_of(given: Any, frequency: tuple[float, float] | None = None) -> Spectrum:
    """A weight as pairs of a frequency nu and an amplitude, linear between them, over an interval where one is given.

    It is `given` by pairs, a table of them, or text.

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
    file = given.strip().removeprefix("{").removesuffix("}").strip() if isinstance(given, str) else given
    if isinstance(file, Path) or (isinstance(file, str) and not _PAIR.fullmatch(file.split(",")[0])):
        return read_spectrum(file, duration=duration)
    return spectrum_of([(_in_motion(duration) * nu, size) for nu, size in spectrum_of(given)])


def _in_motion(duration: NumberOrQuantity | None) -> float:
    """Radians in the motion that a frequency of 1 is."""
    if duration is None:
        return 1.0
    seconds = positive(quantity(duration, "time", "duration", bare=True), "duration")
    check_scale(seconds, "s", "duration", duration)
    return TURN * seconds


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
    duration: NumberOrQuantity | None = None,
    points: int | None = None,
    columns: Sequence[int | str] | None = None,
) -> tuple[tuple[float, float], ...]:
    r"""A measured spectrum from a file: frequencies nu and amplitudes, as weight of `residual_vibration`.

    Parameters
    ----------
    file
        Columns of frequency and amplitude, as `read_law` takes columns; the amplitude is at least 0.
    duration
        Of the motion, "0.1 s" or seconds, where frequencies are in Hz: nu is 2 pi times frequency and duration. They
        are nu, in radians in the motion, without it.
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
        nu = _in_motion(duration) * table.places
        if points is None:
            return spectrum_of(zip(nu.tolist(), table.heights.tolist(), strict=True))
        return spectrum_of(above(nu, table.heights, points))
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


_LOAD_RESOLVED = 1e-10  # of the load on a follower: what a series may miss
_BEYOND_CUBIC = 1e-6  # of the load: twice integrated it is what lies beyond a quintic

RADIANS = 0.7
TERMS = 9
CHUNK = 400
FINEST = 4096
SAMPLES = np.array([0.0, 0.25, 0.5, 0.75])


def _peaks(pieces: tuple[Forcing, ...], frequency: Array, w: Complex) -> Array:
    """Greatest |a_m''| of the rise for each frequency nu and its root w = -n + i lambda, to about 1e-6."""
    n, square, damped = -w.real, frequency * frequency, w.imag
    state = np.zeros(len(frequency), dtype=np.complex128)
    state -= pieces[0].derivative(np.zeros(1), 1)  # the mass is at rest, so that u' = -b
    best = np.zeros(len(frequency))
    for before, piece in zip((None, *pieces), pieces, strict=False):
        if before is not None:
            last = before.derivative(np.array([before.length]), 1)
            state += last - piece.derivative(np.zeros(1), 1)
        count, b_terms, c_terms, b, c = _panels(piece, float(frequency.max()))
        length = piece.length / count
        basis = moments(0.5 * length * w, TERMS) * length
        load = basis @ c_terms.T + 2.0 * n[:, None] * (basis @ b_terms.T)
        step = np.exp(w * length)
        states = np.empty((len(frequency), count + 1), dtype=np.complex128)
        states[:, 0] = state
        for i in range(count):
            state = step * state - load[:, i]
            states[:, i + 1] = state
        u0 = states.imag / damped[:, None]
        u1 = states.real - n[:, None] * u0
        twice, stiff = 2.0 * n[:, None], square[:, None]
        y2 = -twice * (b + u1) - stiff * u0
        y3 = -twice * y2 - stiff * u1
        y4 = -twice * y3 - stiff * (y2 - c)
        best = np.maximum(best, _highest(y2, length * y3, length**2 * y4))
    return best


def _panels(piece: Forcing, fastest: float) -> tuple[int, Array, Array, Array, Array]:
    """Number of equal panels, Legendre series of b and c on each (rows), b and c at their ends."""
    x = chebyshev.nodes(TERMS)
    count = max(1, ceil(fastest * piece.length / RADIANS))
    while True:
        starts = np.arange(count) / count * piece.length
        s = starts[:, None] + 0.5 * piece.length / count * (x + 1.0)
        b, c = (chebyshev.from_values(piece.derivative(s, nu).T).T for nu in (1, 2))
        size = float(np.abs(c).max())
        if np.abs(c[:, -2:]).max() <= _LOAD_RESOLVED * size and np.abs(c[:, 4:]).max() <= _BEYOND_CUBIC * size:
            break
        if count >= FINEST:
            break
        count *= 2
    ends = np.linspace(0.0, piece.length, count + 1)
    to_legendre = legendre_from_chebyshev(TERMS).T
    return count, b @ to_legendre, c @ to_legendre, piece.derivative(ends, 1), piece.derivative(ends, 2)


def _highest(y: Array, y1: Array, y2: Array) -> Array:
    """Greatest magnitude over each row of quintic Hermite interpolants through values and two derivatives."""
    a = [part[:, :-1] for part in (y, y1, y2)]
    z = [part[:, 1:] for part in (y, y1, y2)]
    rise = z[0] - a[0] - a[1] - 0.5 * a[2]
    slope, bend = z[1] - a[1] - a[2], z[2] - a[2]
    series = np.array(
        [
            a[0],
            a[1],
            0.5 * a[2],
            10.0 * rise - 4.0 * slope + 0.5 * bend,
            -15.0 * rise + 7.0 * slope - bend,
            6.0 * rise - 3.0 * slope + 0.5 * bend,
        ]
    )
    samples = np.stack([np.polynomial.polynomial.polyval(t, series, tensor=False) for t in SAMPLES], axis=2)
    rows = np.arange(len(y))
    table = np.abs(np.hstack([samples.reshape(len(y), -1), y[:, -1:]]))
    best = table.max(axis=1)
    # a parabola through three samples tells which lobe is highest, Newton on the interpolant how high
    left, middle, right = table[:, :-2], table[:, 1:-1], table[:, 2:]
    bent = left - 2.0 * middle + right
    top = middle - np.where(bent < 0.0, (right - left) ** 2 / (8.0 * np.where(bent < 0.0, bent, -1.0)), 0.0)
    place = np.argmax(np.where((middle >= left) & (middle >= right), top, 0.0), axis=1) + 1
    panel, part = np.divmod(place, len(SAMPLES))
    first, last = np.zeros_like(panel), np.full_like(panel, a[0].shape[1] - 1)
    # an interior sample on a panel's edge has its top on either side, and a lobe may begin or end with the piece
    for chosen, at in (
        (panel, SAMPLES[part]),
        (np.maximum(panel - (part == 0), 0), np.where(part == 0, 1.0, SAMPLES[part])),
        (first, np.zeros(len(y))),
        (last, np.ones(len(y))),
    ):
        chosen_series = series[:, rows, chosen]
        t = _polished(chosen_series, at)
        best = np.maximum(best, np.abs(np.polynomial.polynomial.polyval(t, chosen_series, tensor=False)))
    return np.asarray(best)


def _polished(series: Array, t: Array) -> Array:
    first = np.polynomial.polynomial.polyder(series)
    second = np.polynomial.polynomial.polyder(first)
    for _ in range(3):
        slope = np.polynomial.polynomial.polyval(t, first, tensor=False)
        bend = np.polynomial.polynomial.polyval(t, second, tensor=False)
        t = np.clip(t - np.where(bend == 0.0, 0.0, slope / np.where(bend == 0.0, 1.0, bend)), 0.0, 1.0)
    return np.asarray(t)


@dataclass(frozen=True, eq=False)
class ResponseSpectrum:
    """Free vibration and peak acceleration over the follower's frequency; computed by `response_spectrum`.

    Parameters
    ----------
    law
        Motion of the cam.
    damping
        Ratio zeta of all followers.
    frequency
        Their frequencies nu, shape (m,).
    phasor
        Complex amplitudes of their free vibrations at k = 1.

    Examples
    --------
    >>> from optlaws import savin
    >>> spectrum = response_spectrum(savin("III", 7.2), [18.0, 20.0])
    >>> spectrum.residual_acceleration.round(6), spectrum.peak_acceleration.round(4)
    (array([7.204401, 1.140114]), array([13.7651, 11.2675]))
    """

    law: MotionLaw
    damping: float
    frequency: Array
    phasor: Complex

    def __eq__(self, other: object) -> bool:
        return self._contents() == other._contents() if isinstance(other, ResponseSpectrum) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._contents())

    def _contents(self) -> tuple[MotionLaw, float, tuple[float, ...], tuple[complex, ...]]:
        return self.law, self.damping, tuple(self.frequency.tolist()), tuple(self.phasor.tolist())

    @property
    def residual_displacement(self) -> Array:
        """Amplitudes of the free vibrations at k = 1, the envelope's if damped; shape (m,)."""
        return np.abs(self.phasor)

    @property
    def residual_acceleration(self) -> Array:
        """nu² times the residual displacement, shape (m,)."""
        return self.frequency**2 * self.residual_displacement

    @kept_property
    def peak_acceleration(self) -> Array:
        """Greatest |a_m''| of the rise, shape (m,), to about 1e-6; computed at the first use."""
        _, w, _ = roots(self.frequency, self.damping)
        pieces, order, peaks = forcings(self.law), np.argsort(self.frequency), np.empty(len(w))
        for low in range(0, len(order), CHUNK):
            some = order[low : low + CHUNK]
            peaks[some] = _peaks(pieces, self.frequency[some], w[some])
        return peaks

    def report(self) -> Report:
        """Residual and peak acceleration over the frequency, as curves and as a table, in units of the law's a''.

        Examples
        --------
        >>> from optlaws import savin
        >>> [panel.name for panel in response_spectrum(savin("III", 7.2), [18.0, 20.0]).report().panels]
        ['residual acceleration', 'peak acceleration']
        """
        values = {"residual acceleration": self.residual_acceleration, "peak acceleration": self.peak_acceleration}
        across = "frequency, radians of the free vibration in the rise"
        curves = {name: (Series(self.frequency, each),) for name, each in values.items()}
        panels = [Panel(name, "in units of a″", curve, across=across, per=1.0) for name, curve in curves.items()]
        columns = {"frequency": self.frequency.tolist(), **{name: each.tolist() for name, each in values.items()}}
        facts = [Row("damping ratio", self.damping), Row("frequency", (self.frequency.min(), self.frequency.max()))]
        data = {"damping": self.damping, "law": self.law.to_dict(), **columns}
        return PlainReport(Summary(facts), [ReportTable.of_columns(columns)], panels, lambda: data)


def response_spectrum(law: MotionLaw, frequency: Any, damping: float = 0.0) -> ResponseSpectrum:
    """The response spectrum of a law, the mass at rest at first.

    Parameters
    ----------
    law
        Motion of the cam.
    frequency
        Frequencies nu, above 0; shape (m,).
    damping
        Ratio zeta, below 1, the same for all.

    Raises
    ------
    InputError
        If a number is out of range.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> import numpy as np
    >>> spectrum = response_spectrum(smoothstep(4), np.linspace(2.0, 200.0, 10_000))
    >>> float(spectrum.residual_acceleration[spectrum.frequency > 100].max())
    0.167...
    """
    frequencies, _, _ = roots(frequency, damping)
    return ResponseSpectrum(motion_law(law), float(damping), frequencies, residual_phasor(law, frequencies, damping))
