"""The vibration that a law leaves: in closed form, linear in it, and its greatest over frequencies as a constant."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from hashlib import sha256
from math import ceil, inf, nan
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.mechanisms.cam_constants import check_order
from optlaws.mechanisms.measured_spectrum import Spectrum, WeightPart, parts_of, spectrum_of, weight_of
from optlaws.mechanisms.transforms import legendre_from_chebyshev, moments, velocity_transform, velocity_transform_of
from optlaws.numbers import Array, Complex, circular_frequency, not_negative, numbers, positive, power_of_two, whole
from optlaws.numerics.chebyshev import basis_values, from_values, nodes
from optlaws.numerics.peaks import Peak
from optlaws.synthesis.families.cone import ConeFamily, stationary_places
from optlaws.synthesis.functionals.curved_rows import columns_of
from optlaws.synthesis.problem.constants import MAKERS, Functional
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.tolerances import NEGLIGIBLE_TERM

_WIDEST = 1000.0
#: terms beside those of an exponential, for the weight and the powers of the frequency
_SPARE = 12
#: points of Gauss's rule beside those that the degree and the frequency need
_GAUSS_SPARE = 40
_MOST_POLYDYNE = 4
#: a spectrum of more points is too long for messages and for the names of rows
_NAMED_POINTS = 65
#: frequencies that are computed together
_TOGETHER = 8192
#: digits that tell long spectra from each other
_DIGITS = 16
_BOUND_ROUNDING = 1e-12  # of a bound of a magnitude: what rounding may take from it

#: integrals of exp(w (1 - k)) b(k) for roots w, of one law or a column for each
Transform = Callable[[Complex], Complex]


def residual_phasor(law: MotionLaw, frequency: Any, damping: float = 0.0) -> Complex:
    """Complex amplitude Z of the free vibration after a law, the mass at rest at first; linear in the law.

    For k >= 1 the mass moves by a_m = a(1) + Re(Z exp(w (k - 1))), w = -n + i lambda, lambda = nu sqrt(1 - zeta²). |Z|
    is the residual displacement and nu² |Z| the residual acceleration. With wbar the conjugate of w,
    Z = -i wbar/lambda times the integral of exp(w (1 - k)) b(k), in closed form for polynomials and sines.

    Parameters
    ----------
    law
        Motion of the cam.
    frequency
        Frequencies nu, above 0; a number or shape (m,).
    damping
        Ratio zeta, below 1.

    Returns
    -------
    Complex array, shape (m,).

    Raises
    ------
    InputError
        If a number is out of range.

    Examples
    --------
    >>> from optlaws import savin
    >>> 18**2 * abs(residual_phasor(savin("III", 7.2), 18)).round(12)
    array([7.204401])
    """
    _, w, damped = roots(frequency, damping)
    return -1j * w.conj() / damped * velocity_transform(law, w)


def residual_functional(count: int, frequency: Any, damping: float = 0.0) -> tuple[Complex, Complex]:
    """The rows that turn a polynomial law's coefficients into the complex amplitude of its free vibration.

    With ``rows, start = residual_functional(len(law.acceleration), frequency, damping)`` the residual acceleration is
    ``abs(rows @ law.acceleration + start * law.b0)``: nu² times `residual_phasor`, affine in whatever the law is
    affine in, so that a bound on it is a second-order cone for each frequency.

    Parameters
    ----------
    count
        Number of Chebyshev coefficients of c.
    frequency
        Frequencies nu, above 0; a number or shape (m,).
    damping
        Ratio zeta, below 1.

    Returns
    -------
    Complex arrays of shape (m, count) and (m,).

    Raises
    ------
    InputError
        If a number is out of range.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> law = smoothstep(4)
    >>> rows, start = residual_functional(len(law.acceleration), [20.0], 0.05)
    >>> abs(rows @ law.acceleration + start * law.b0).round(6)
    array([1.650151])
    """
    frequencies, w, damped = roots(frequency, damping)
    terms = whole(count, "count", least=1)
    scale = (-1j * frequencies**2 * w.conj() / (damped * w))[:, None]
    n = np.arange(terms)
    mean = np.where(n % 2 == 0, 1.0 / (1.0 - n * n + (n % 2)), 0.0)
    rows = moments(0.5 * w, terms) @ legendre_from_chebyshev(terms) - mean
    return scale * rows, scale[:, 0] * np.expm1(w)


def roots(frequency: Any, damping: float) -> tuple[Array, Complex, Array]:
    """Frequencies nu, roots w = -n + i lambda and lambda of followers below critical damping."""
    frequencies = np.array(numbers(np.atleast_1d(np.asarray(frequency)).tolist(), "frequency"))
    ratio = not_negative(damping, "damping")
    if not (frequencies > 0.0).all():
        raise InputError(f"frequency must be above 0, got {float(frequencies.min())!r}")
    if frequencies.size:
        circular_frequency(frequencies.max())
    if ratio >= 1.0:
        raise InputError(
            f"damping must be below 1, got {shortened(damping)}: from the critical damping on nothing vibrates; "
            "Follower.response shows how the mass comes to rest"
        )
    damped = frequencies * np.sqrt((1.0 - ratio) * (1.0 + ratio))
    return frequencies, -ratio * frequencies + 1j * damped, damped


@dataclass(frozen=True, repr=False)
class Residual(Functional):
    """Greatest residual acceleration over an interval of frequencies; constructed by `residual_vibration`.

    Attributes
    ----------
    low, high
        The interval of frequencies nu.
    damping
        Ratio zeta.
    design
        Frequency for which the cam is designed if the law is the mass's; None if the law is the cam's own.
    design_damping
        The ratio for which it is designed.
    spectrum
        Pairs of a frequency and a weight, linear between them; None where all frequencies weigh 1.
    """

    low: float
    high: float
    damping: float = 0.0
    design: float | None = None
    design_damping: float = 0.0
    spectrum: Spectrum | None = None

    #: in units of a bound where there is one, else of its scale
    normalised = True

    @kept_property
    def scale(self) -> float:
        """As of the law's acceleration, times the greatest weight; a power of 2."""
        return power_of_two(max(size for _, size in self.spectrum)) if self.spectrum else 1.0

    def value(self, law: MotionLaw) -> float:
        """The greatest over the whole interval."""
        return self.peak(law).value

    def peak(self, law: MotionLaw) -> Peak:
        """The greatest over the whole interval; its `k` is the frequency at which it is."""
        transform, parts = velocity_transform_of(law), self.parts
        bounds = self._bounds(transform, parts) if len(parts) > 1 else np.array([inf])
        best = Peak(-inf, nan)
        for i in np.argsort(-bounds, kind="stable"):
            # an interval whose bound is below what another one attains has no greater value
            if bounds[i] < best.value:
                break
            best = max(best, self._peak_of(transform, parts[i]), key=lambda peak: peak.value)
        return best

    def _peak_of(self, transform: Transform, part: WeightPart) -> Peak:
        def weighed(u: Array) -> Complex:
            frequencies = _frequencies(part, u)
            return np.asarray(part.at(frequencies) * self._amplitudes(transform, frequencies))

        value, place = greatest_modulus(weighed, _nodes(part))
        return Peak(value, float(_frequencies(part, np.array([place]))[0]))

    def _bounds(self, transform: Transform, parts: Sequence[WeightPart]) -> Array:
        """What the magnitude is at most on each interval: the sum of the terms of its square."""
        bounds = np.empty(len(parts))
        for some, series in self._series_of(transform, parts):
            places = nodes(2 * series.shape[1])
            values = series[:, :, 0] @ basis_values(places, series.shape[1]).T
            squares = from_values(np.ascontiguousarray((values.real**2 + values.imag**2).T))
            bounds[some] = np.sqrt(np.abs(squares).sum(axis=0)) * (1.0 + _BOUND_ROUNDING)
        return bounds

    def _series_of(
        self, transform: Transform, parts: Sequence[WeightPart]
    ) -> Iterator[tuple[NDArray[np.intp], Complex]]:
        """Chebyshev series of the weighed amplitudes on intervals, those alike together: their numbers, and the series.

        The series' shape is (intervals, terms, columns).
        """
        counts = np.array([len(_nodes(part)) for part in parts])
        for count in np.unique(counts):
            alike = np.flatnonzero(counts == count)
            for some in np.array_split(alike, ceil(len(alike) * count / _TOGETHER)):
                low, high, first, last = np.array([parts[i] for i in some]).T[:, :, None]
                share = 0.5 * (1.0 + _nodes(parts[some[0]]))
                frequencies = ((1.0 - share) * low + share * high).ravel()
                weights = ((1.0 - share) * first + share * last).ravel()
                amplitudes = self._amplitudes(transform, frequencies).reshape(len(frequencies), -1)
                values = (weights[:, None] * amplitudes).reshape(len(some), count, -1)
                flat: Complex = np.ascontiguousarray(values.transpose(1, 0, 2)).reshape(count, -1)
                series: Complex = from_values(flat)
                yield some, series.reshape(count, len(some), -1).transpose(1, 0, 2)

    @property
    def parts(self) -> tuple[WeightPart, ...]:
        """The intervals of frequencies on which the weight is linear; a single interval without a weight."""
        if self.spectrum is None:
            return (WeightPart(self.low, self.high, 1.0, 1.0),)
        return parts_of(self.spectrum)

    @property
    def part_names(self) -> tuple[str, ...]:
        """Names of the parts in certificates."""
        short = self.name
        if self.spectrum is not None and len(self.spectrum) > _NAMED_POINTS:
            short = f"residual(spectrum={sha256(self.name.encode()).hexdigest()[:_DIGITS]})"
        return (self.name, *(f"{short}, part {i + 1}" for i in range(1, len(self.parts))))

    @property
    def title(self) -> str:
        """A few words for it where the name has a long spectrum in it."""
        if self.spectrum is None or len(self.spectrum) <= _NAMED_POINTS:
            return self.name
        return f"residual weighed by a spectrum of {len(self.spectrum)} points, nu from {self.low:g} to {self.high:g}"

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConeFamily, ...]:
        """A cone for each frequency; a bound is scaled to 1, so that residuals are measured by it."""
        if self.design is not None:
            check_order(self.name, space, _MOST_POLYDYNE)
        elif space.start_velocity != 0.0 or space.velocity_change != 0.0 or space.boundary.order < 2:
            raise InputError(f"{self.name} needs laws from rest to rest, of order 2 at least")
        unit = bound or self.scale
        return tuple(
            ConeFamily(
                name,
                slack / self.scale,
                bound / unit,
                domain=domain_of(_nodes(part)),
                series=widened(columns, len(slack)) / unit,
            )
            for name, part, columns in zip(self.part_names, self.parts, self._columns(space), strict=True)
        )

    def where(self, k: float, part: int = 0) -> str:
        """The frequency of a place in a part."""
        return f"frequency = {self.frequency(k, part):.5g}"

    def frequency(self, place: float, part: int = 0) -> float:
        """The frequency that a certificate's contact of a part refers to by a number k from 0 to 1."""
        return float(_frequencies(self.parts[part], np.array([2.0 * place - 1.0]))[0])

    def _amplitudes(self, transform: Transform, frequencies: Array) -> Complex:
        """nu² times the complex amplitudes, a row for each frequency."""
        _, w, damped = roots(frequencies, self.damping)
        scale = -1j * frequencies**2 * w.conj() / damped * self._detuning(frequencies)
        return np.asarray((scale * transform(w).T).T)

    def _detuning(self, frequencies: Array) -> Complex:
        """The share that a polydyne cam leaves of the residual of its mass law cut directly on a cam."""
        if self.design is None:
            return np.ones(len(frequencies), dtype=np.complex128)
        _, w, _ = roots(frequencies, self.damping)
        n = self.damping * frequencies
        n0 = self.design_damping * self.design
        ratio = frequencies / self.design
        return np.asarray(1.0 - ratio**2 + 2.0 * (n0 - n) * w / self.design**2)

    def _columns(self, space: LawSpace) -> list[Complex]:
        """Chebyshev series of each part: of the amplitudes of the free functions, then of the base law."""
        parts = self.parts
        counts = [len(_nodes(part)) for part in parts]
        together = cached_columns(space, ("residual", self.name), lambda: self._computed(space, parts))
        return np.split(together, np.cumsum(counts[:-1]))

    def _computed(self, space: LawSpace, parts: Sequence[WeightPart]) -> Complex:
        series: dict[int, Complex] = {}
        for some, columns in self._series_of(lambda w: velocity_transforms(space, w, float(np.abs(w).max())), parts):
            series |= zip(some.tolist(), columns, strict=True)
        return np.concatenate([series[i] for i in range(len(parts))])


def _frequencies(part: WeightPart, u: Array) -> Array:
    inner: Array = 0.5 * ((1.0 - u) * part.low + (1.0 + u) * part.high)
    return inner


def _nodes(part: WeightPart) -> Array:
    """Chebyshev nodes, enough for functions of exponential type 1 in nu; a single place where there is no more."""
    length = part.high - part.low
    return nodes(terms_of_exponential(0.5 * length) + _SPARE) if length else np.ones(1)


def residual_vibration(
    *,
    frequency: float | tuple[float, float] | None = None,
    damping: float = 0.0,
    design: float | None = None,
    design_damping: float | None = None,
    spectrum: Any = None,
    duration: Any = None,
) -> Residual:
    """The greatest residual acceleration of an elastic follower over a whole interval of frequencies.

    In units of a'': nu² times the amplitude of the free vibration at k = 1, its envelope where damped, as
    `Response.residual_acceleration`.

    Parameters
    ----------
    frequency
        The interval (low, high) of frequencies nu, or one of them; all of a spectrum unless given.
    damping
        Ratio zeta of the follower, below 1.
    design
        If given, the law is the mass's and the cam follows from it at this frequency; otherwise it is the cam's own.
    design_damping
        The ratio for which that cam is designed; `damping` unless given.
    spectrum
        Pairs of a frequency nu and an amplitude, linear between them, by which the residual at each frequency is
        multiplied: of `read_spectrum`, arrays, text "{18: 0.5, 20: 1, 22: 0.5}", or a file as `read_spectrum` takes it.
    duration
        Of the motion, where the frequencies of a spectrum are in Hz: "0.1 s", or seconds.

    Raises
    ------
    InputError
        If a number is out of range.

    Examples
    --------
    >>> from optlaws import savin
    >>> weighed = residual_vibration(spectrum=[(16, 0.1), (18, 1.0), (20, 0.1)])
    >>> weighed, round(weighed.value(savin("III", 7.2)), 6)
    (residual(spectrum='{16.0:0.1, 18.0:1.0, 20.0:0.1}'), 7.296848)
    >>> vibration = residual_vibration(frequency=18)
    >>> round(vibration.value(savin("III", 7.2)), 6)
    7.204401
    >>> wide = residual_vibration(frequency=(18, 22), design=20)
    >>> wide, wide.peak(savin("III", 7.2))
    (residual(frequency=(18.0, 22.0), design=20.0), Peak(value=1.368836, k=18.0))
    """
    if frequency is None and spectrum is None:
        raise InputError("residual needs a frequency, an interval of them, or a spectrum")
    if spectrum is None and duration is not None:
        raise InputError("a duration is of a spectrum in Hz: give the spectrum too")
    weights = None if spectrum is None else weight_of(spectrum, duration)
    if weights is not None and frequency is None:
        frequency = (weights[0][0], weights[-1][0])
    pair = tuple(frequency) if isinstance(frequency, list | tuple) else (frequency, frequency)
    if len(pair) != 2:
        raise InputError(f"frequency must be a frequency or two, (low, high), got {shortened(frequency)}")
    low, high = (positive(number, "frequency") for number in pair)
    if low > high or high - low > _WIDEST:
        raise InputError(
            f"frequency must be an interval (low, high) no longer than {_WIDEST:g}, got {shortened(frequency)}"
        )
    ratio = not_negative(damping, "damping")
    roots(low, ratio)
    if design is None and design_damping is not None:
        raise InputError("design_damping belongs to a design frequency: give design too")
    design_frequency = None if design is None else positive(design, "design")
    design_ratio = ratio if design_damping is None else not_negative(design_damping, "design_damping")
    parts = [f"frequency={low!r}" if low == high else f"frequency=({low!r}, {high!r})"]
    if weights is not None:
        weights = spectrum_of(weights, (low, high))
        pairs = ", ".join(f"{nu!r}:{size!r}" for nu, size in weights)
        parts = [f"spectrum='{{{pairs}}}'"] if low < high else [*parts, f"spectrum='{{{pairs}}}'"]
    parts += [f"damping={ratio!r}"] if ratio else []
    parts += [f"design={design_frequency!r}"] if design_frequency else []
    parts += [f"design_damping={design_ratio!r}"] if design_frequency and design_ratio != ratio else []
    name = f"residual({', '.join(parts)})"
    return Residual(
        name,
        nan,
        convex=True,
        low=low,
        high=high,
        damping=ratio,
        design=design_frequency,
        design_damping=design_ratio if design_frequency else 0.0,
        spectrum=weights,
    )


@lru_cache(maxsize=256)
def terms_of_exponential(half: float) -> int:
    """The number of coefficients of exp(w t) that count, w over a line of twice that length, 0 <= t <= 1.

    Where |exp(w t)| is at most 1 on the line the coefficient n is at most 2 (half / 2)^n / n!.

    >>> terms_of_exponential(0.01), terms_of_exponential(10.0)
    (7, 38)
    """
    n, size = 0, 2.0
    while size > NEGLIGIBLE_TERM or n < half:
        n += 1
        size *= 0.5 * half / n
    return n + 1


def greatest_modulus(amplitude: Callable[[Array], Complex], nodes: Array) -> tuple[float, float]:
    """The greatest magnitude of an analytic amplitude from -1 to 1, by nodes that resolve it, and its place.

    >>> greatest_modulus(lambda u: 1.0 + 1j * u * u, np.ones(1))
    (1.414214, 1.0)
    """
    places = nodes
    if len(nodes) > 1:
        places = np.concatenate([[-1.0, 1.0], stationary_places(from_values(amplitude(nodes)))])
    sizes = np.abs(amplitude(places))
    best = int(np.argmax(sizes))
    return float(sizes[best]), float(places[best])


def domain_of(nodes: Array) -> tuple[float, float]:
    """The places that nodes stand for: all from -1 to 1, or the single one."""
    return (-1.0, 1.0) if len(nodes) > 1 else (1.0, 1.0)


def widened(columns: Complex, count: int) -> Complex:
    """Columns of the free functions and of the base law, with columns of 0 for further variables between them."""
    wide = np.zeros((len(columns), count + 1), dtype=np.complex128)
    wide[:, : columns.shape[1] - 1], wide[:, -1] = columns[:, :-1], columns[:, -1]
    return wide


def cached_columns(space: LawSpace, key: tuple[object, ...], computed: Callable[[], Complex]) -> Complex:
    """Complex columns, cached by a space as pairs of real columns."""
    return space.cached(key, lambda: computed().view(np.float64)).view(np.complex128)


def velocity_transforms(space: LawSpace, w: Complex, highest: float) -> Complex:
    """Integrals of exp(w (1 - k)) b(k), a row for each root w, for the free functions and the base law of a space.

    Roots have real parts of at most 0 and magnitudes of at most `highest`.
    """
    k, weights = _gauss_rule(space, highest)
    # by parts: beside b what a fast vibration leaves would be lost in rounding
    moved = np.exp(w[:, None] * (1.0 - k)) @ (weights[:, None] * columns_of(space, 2, k))
    begun, ended = columns_of(space, 1, np.array([0.0, 1.0]))
    return np.asarray((moved + np.exp(w)[:, None] * begun - ended) / w[:, None])


def _gauss_rule(space: LawSpace, highest: float) -> tuple[Array, Array]:
    """Gauss points on every piece of the law, enough for a vibration of the highest frequency, and weights."""
    breaks = np.array(getattr(space, "breaks", (0.0, 1.0)))
    degree = len(space.derivative(1, "b", np.zeros(space.terms)).series)
    x, weights = legendre.leggauss(degree + ceil(0.5 * highest) + _GAUSS_SPARE)
    lengths = np.diff(breaks)
    k = breaks[:-1, None] + lengths[:, None] * (1.0 + x) / 2.0
    return k.ravel(), (lengths[:, None] * weights / 2.0).ravel()


MAKERS.setdefault("residual", residual_vibration)
