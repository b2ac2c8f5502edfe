"""Response spectrum: the effect of a law on followers of every frequency, over short panels in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import Any

import numpy as np

from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.law import motion_law
from optlaws.mechanisms.forcing import Forcing, forcings
from optlaws.mechanisms.transforms import legendre_from_chebyshev, moments, residual_phasor, roots
from optlaws.numbers import Array, Complex
from optlaws.numerics import chebyshev
from optlaws.shown.report import Panel, PlainReport, Report, ReportTable, Series
from optlaws.shown.summary import Row, Summary

_LOAD_RESOLVED = 1e-10  # of the load on a follower: what a series may miss
_BEYOND_CUBIC = 1e-6  # of the load: twice integrated it is what lies beyond a quintic

RADIANS = 0.7
TERMS = 9
CHUNK = 400
FINEST = 4096
SAMPLES = np.array([0.0, 0.25, 0.5, 0.75])


def peak_accelerations(law: MotionLaw, frequencies: Array, w: Complex) -> Array:
    """Greatest |a_m''| of the rise for each frequency nu and its root w = -n + i lambda, to about 1e-6."""
    pieces = forcings(law)
    peaks = np.empty(len(frequencies))
    order = np.argsort(frequencies)
    for low in range(0, len(order), CHUNK):
        some = order[low : low + CHUNK]
        peaks[some] = _peaks(pieces, frequencies[some], w[some])
    return peaks


def _peaks(pieces: tuple[Forcing, ...], frequency: Array, w: Complex) -> Array:
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
        return peak_accelerations(self.law, self.frequency, w)

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
