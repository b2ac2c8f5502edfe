"""The vibration that a law leaves, in a band of frequencies or of a mode in a box, as a constant of the law.

For each root w it is a share of the integral of exp(w (1 - k)) b(k), affine in the law. The share of a mode in an
output stays as it is: so it is when the machine runs at another speed, and it is what is meant by a frequency or a
damping that is not known well. Over a box of frequencies and damping ratios the magnitude, which is analytic in w, is
greatest on the edges. Each place of an edge is a second-order cone.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from hashlib import sha256
from math import asin, ceil, inf, nan
from typing import Any, ClassVar, Literal, TypeAlias, get_args

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw, Peak
from optlaws.mechanisms.machine.models import mode as _mode
from optlaws.mechanisms.machine.models import participation
from optlaws.mechanisms.machine.polydyne import check_order
from optlaws.mechanisms.machine.spectrum import Spectrum, WeightPart, parts_of, spectrum_of, weight_of
from optlaws.mechanisms.machine.state_space import StateSpace, check_rest, machine_of, text_of, title_of
from optlaws.mechanisms.machine.transforms import (
    Transform,
    greatest_modulus,
    phasor_share,
    roots,
    terms_of_exponential,
    velocity_transform_of,
    velocity_transforms,
)
from optlaws.numbers import Array, Complex, not_negative, numbers, positive, power_of_two
from optlaws.numerics import chebyshev
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.piece_series import PieceSeries
from optlaws.synthesis.problem.constants import MAKERS, Functional
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.tolerances import NEGLIGIBLE_TERM

#: what of a vibration is counted
Vibrating: TypeAlias = Literal["acceleration", "displacement"]

_WIDEST = 1000.0
#: terms beside those of an exponential, for the weight and the powers of the frequency
_SPARE = 12
#: the same where the damping changes along an edge
_EDGE_SPARE = 40
_MOST_POLYDYNE = 4
_MOST_DAMPING = 0.95
_ACCELERATION = 6.0  # of a smooth law
#: a spectrum of more points is too long for messages and for the names of rows
_NAMED_POINTS = 65
#: frequencies that are computed together
_TOGETHER = 8192
#: edges that are looked at without asking first which can have the greatest
_FEW = 4
#: digits that tell long spectra from each other
_DIGITS = 16
_BOUND_ROUNDING = 1e-12  # of a bound of a magnitude: what rounding may take from it


@dataclass(frozen=True, repr=False)
class Residual(Functional):
    """Greatest magnitude of a vibration after the motion, over the edges of what its frequency and damping may be."""

    normalised = True
    #: what an edge is called in certificates
    _part: ClassVar[str]

    def value(self, law: MotionLaw) -> float:
        return self.peak(law).value

    def peak(self, law: MotionLaw) -> Peak:
        """The greatest over all edges; its `k` is the frequency at which it is, in radians in the rise's duration."""
        transform, best = velocity_transform_of(law), Peak(-inf, nan)

        def along(edge: int, u: Array) -> Complex:
            return np.asarray(self.amplitudes(transform, np.array([edge]), u)[0])

        many = len(self.counts) > _FEW
        bounds = self._bounds(transform) if many else np.full(len(self.counts), inf)
        for i in np.argsort(-bounds, kind="stable").tolist():
            # an edge whose bound is below what another one attains has no greater value
            if bounds[i] < best.value:
                break
            value, place = greatest_modulus(partial(along, i), _places(self.counts[i]))
            best = max(best, Peak(value, self.frequency(0.5 * (1.0 + place), i)), key=lambda peak: peak.value)
        return best

    @property
    @abstractmethod
    def counts(self) -> Sequence[int]:
        """Chebyshev nodes that resolve the amplitude on each edge; one where the edge is a single root."""

    @abstractmethod
    def amplitudes(self, transform: Transform, edges: NDArray[np.intp], u: Array) -> Complex:
        """What is left at places from -1 to 1 of edges, shape (edges, places), and a column for each law."""

    @abstractmethod
    def frequency(self, place: float, part: int = 0) -> float:
        """The frequency that a certificate's contact of an edge refers to by a number k from 0 to 1."""

    @abstractmethod
    def check(self, space: LawSpace) -> None:
        """Refuse laws that do not begin and end as they must."""

    def unit(self, space: LawSpace, edge: int, bound: float, *, sought: bool) -> float:  # noqa: ARG002 - of a mode
        """The unit of the rows of an edge: the bound, or the scale if there is no bound."""
        return bound or self.scale

    def _unit_of_slack(self, unit: float) -> float:  # noqa: ARG002 - of a mode
        return self.scale

    def _bounds(self, transform: Transform) -> Array:
        """What the magnitude is at most on each edge: the sum of the terms of its square."""
        bounds = np.empty(len(self.counts))
        for some, series in self._series(transform):
            places = chebyshev.nodes(2 * series.shape[1])
            values = series[:, :, 0] @ chebyshev.basis_values(places, series.shape[1]).T
            squares = chebyshev.from_values(np.ascontiguousarray((values.real**2 + values.imag**2).T))
            bounds[some] = np.sqrt(np.abs(squares).sum(axis=0)) * (1.0 + _BOUND_ROUNDING)
        return bounds

    def _series(self, transform: Transform) -> Iterator[tuple[NDArray[np.intp], Complex]]:
        """Chebyshev series of the amplitudes on edges, those alike together: their numbers, and the series.

        The series' shape is (edges, terms, columns).
        """
        counts = np.array(self.counts)
        for count in np.unique(counts).tolist():
            alike = np.flatnonzero(counts == count)
            for some in np.array_split(alike, ceil(len(alike) * count / _TOGETHER)):
                values = self.amplitudes(transform, some, _places(count)).reshape(len(some), count, -1)
                flat = np.ascontiguousarray(values.transpose(1, 0, 2)).reshape(count, -1)
                series: Complex = chebyshev.from_values(flat)
                yield some, series.reshape(count, len(some), -1).transpose(1, 0, 2)

    @property
    def part_names(self) -> tuple[str, ...]:
        return (self.name, *(f"{self._short_name}, {self._part} {i}" for i in range(2, len(self.counts) + 1)))

    @property
    def _short_name(self) -> str:
        return self.name

    def where(self, k: float, part: int = 0) -> str:
        return f"frequency = {self.frequency(k, part):.5g}"

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConeFamily, ...]:
        """A cone for each place of each edge; a bound is scaled to 1, so that amplitudes are measured by it."""
        self.check(space)
        families = []
        for i, (name, columns) in enumerate(zip(self.part_names, self.columns(space), strict=True)):
            unit = self.unit(space, i, bound, sought=bool(slack.any()))
            counted = np.flatnonzero(np.abs(columns).max(axis=1) > NEGLIGIBLE_TERM * np.abs(columns).max())
            # an output may not see the mode at all
            terms = columns[: counted[-1] + 1 if len(counted) else 1]
            table = PieceSeries.whole(terms / unit).widened(len(slack))
            domain = (-1.0, 1.0) if self.counts[i] > 1 else (1.0, 1.0)
            room = slack / self._unit_of_slack(unit)
            families.append(ConeFamily(name, room, bound / unit, domain=domain, table=table))
        return tuple(families)

    def columns(self, space: LawSpace) -> list[Complex]:
        """Chebyshev series of each edge: of the amplitudes of the free functions, then of the base law."""

        def computed() -> Array:
            series: dict[int, Complex] = {}
            for some, columns in self._series(lambda w: velocity_transforms(space, w, float(np.abs(w).max()))):
                series |= zip(some.tolist(), columns, strict=True)
            return np.concatenate([series[i] for i in range(len(series))]).view(np.float64)

        together = space.cached(("residual", self.name), computed).view(np.complex128)
        return np.split(together, np.cumsum(self.counts[:-1]))


def _places(count: int) -> Array:
    return chebyshev.nodes(count) if count > 1 else np.ones(1)


@dataclass(frozen=True, repr=False)
class BandResidual(Residual):
    """Greatest residual over the interval `low` to `high` of frequencies; constructed by `residual_vibration`.

    `design` is None if the law is the cam's own, `spectrum` where all frequencies weigh 1; of the `displacement` it is
    an amplitude in strokes.
    """

    low: float
    high: float
    damping: float = 0.0
    design: float | None = None
    design_damping: float = 0.0
    spectrum: Spectrum | None = None
    displacement: bool = False

    _part = "part"

    @kept_property
    def scale(self) -> float:
        """As of the law's acceleration or what that displaces, times the greatest weight; a power of 2."""
        size = max(weight for _, weight in self.spectrum) if self.spectrum else 1.0
        return power_of_two(size * min(1.0, _ACCELERATION / self.low**2) if self.displacement else size)

    @kept_property
    def parts(self) -> tuple[WeightPart, ...]:
        """The intervals of frequencies on which the weight is linear; a single interval without a weight."""
        return parts_of(self.spectrum) if self.spectrum else (WeightPart(self.low, self.high, 1.0, 1.0),)

    @kept_property
    def counts(self) -> Sequence[int]:
        lengths = (part.high - part.low for part in self.parts)
        return [terms_of_exponential(0.5 * length) + _SPARE if length else 1 for length in lengths]

    def amplitudes(self, transform: Transform, edges: NDArray[np.intp], u: Array) -> Complex:
        share = 0.5 * (1.0 + u)
        low, high, first, last = np.array([self.parts[i] for i in edges]).T[:, :, None]
        frequencies = ((1.0 - share) * low + share * high).ravel()
        weights = ((1.0 - share) * first + share * last).ravel()
        _, w, damped = roots(frequencies, self.damping)
        size = 1.0 if self.displacement else frequencies**2
        scale = phasor_share(w, damped, size)
        if self.design is not None:
            # the share that a polydyne cam leaves of the residual of its mass law cut directly on a cam
            apart = self.design_damping * self.design - self.damping * frequencies
            scale = scale * (1.0 - (frequencies / self.design) ** 2 + 2.0 * apart * w / self.design**2)
        left = (weights * (scale * transform(w).T)).T
        return np.asarray(left.reshape(len(edges), len(u), *left.shape[1:]))

    def frequency(self, place: float, part: int = 0) -> float:
        return (1.0 - place) * self.parts[part].low + place * self.parts[part].high

    @property
    def _long(self) -> bool:
        """Whether the name has a long spectrum in it."""
        return self.spectrum is not None and len(self.spectrum) > _NAMED_POINTS

    @property
    def _short_name(self) -> str:
        return f"residual(spectrum={sha256(self.name.encode()).hexdigest()[:_DIGITS]})" if self._long else self.name

    @property
    def title(self) -> str:
        if self.spectrum is None or not self._long:
            return self.name
        return f"residual weighed by a spectrum of {len(self.spectrum)} points, nu from {self.low:g} to {self.high:g}"

    def check(self, space: LawSpace) -> None:
        if self.design is not None:
            check_order(self.name, space, _MOST_POLYDYNE)
        elif space.start_velocity != 0.0 or space.velocity_change != 0.0 or space.boundary.order < 2:
            raise InputError(f"{self.name} needs laws from rest to rest, of order 2 at least")


def residual_vibration(
    *,
    frequency: float | tuple[float, float] | None = None,
    damping: float = 0.0,
    design: float | None = None,
    design_damping: float | None = None,
    spectrum: Any = None,
    duration: Any = None,
    of: Vibrating = "acceleration",
) -> BandResidual:
    """The greatest residual of an elastic follower over a whole interval of frequencies.

    Of the displacement it is the amplitude of the free vibration at k = 1, its envelope where damped, in strokes; of
    the acceleration nu² times it, in units of a'', as `Response.residual_acceleration`.

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
    of
        What of the vibration: its acceleration or its displacement.

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
    >>> sway = residual_vibration(frequency=18, of="displacement")
    >>> sway, round(18**2 * sway.value(savin("III", 7.2)), 6)
    (residual(frequency=18.0, of=displacement), 7.204401)
    """
    check_names([of], get_args(Vibrating), "residual of")
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
    parts += [f"of={of}"] if of == "displacement" else []
    designed: dict[str, Any] = {"design": design_frequency, "design_damping": design_ratio} if design_frequency else {}
    band: dict[str, Any] = {
        "low": low,
        "high": high,
        "damping": ratio,
        "spectrum": weights,
        "displacement": of == "displacement",
    }
    return BandResidual(f"residual({', '.join(parts)})", nan, convex=True, **band, **designed)


@dataclass(frozen=True)
class BoxEdge:
    """Roots i nu exp(i angle) with sin(angle) the damping ratio, between two of one frequency or of one angle."""

    first: tuple[float, float]
    last: tuple[float, float]

    @property
    def single(self) -> bool:
        return self.first == self.last

    def roots(self, u: Array) -> Complex:
        """The roots at places from -1 to 1."""
        share = 0.5 * (1.0 + u)
        frequency, angle = (a + share * (b - a) for a, b in zip(self.first, self.last, strict=True))
        return np.asarray(1j * frequency * np.exp(1j * angle))

    @property
    def count(self) -> int:
        """Chebyshev nodes that resolve functions of exponential type 1 in the root."""
        if self.single:
            return 1
        ends = self.roots(np.array([-1.0, 1.0]))
        length = float(abs(ends[1] - ends[0]))
        straight = self.first[1] == self.last[1]
        return terms_of_exponential(0.5 * length) if straight else ceil(0.75 * length) + _EDGE_SPARE


@dataclass(frozen=True, repr=False)
class ModeResidual(Residual):
    """Greatest amplitude of a mode in an output after the motion, over a box; constructed by `Machine.residual`.

    The mode's frequency may be off by the share `spread`, either way; `dampings` are the least and the greatest ratio,
    or None for the mode's own.
    """

    machine: StateSpace = field(compare=False)
    output: str = field(compare=False)
    mode: int
    spread: float
    dampings: tuple[float, float] | None

    _part = "edge"

    @kept_property
    def scale(self) -> float:
        """The size of the mode's vibration after a law whose acceleration jumps; a power of 2."""
        least = min(min(edge.first[0], edge.last[0]) for edge in self.edges)
        return power_of_two(self.share * min(1.0, _ACCELERATION / least**2))

    @property
    def title(self) -> str:
        words = [f"within {100.0 * self.spread:g} %"] if self.spread else []
        words += [] if self.dampings is None else ["damping {:g} to {:g}".format(*self.dampings)]
        return title_of(self.machine, f"residual of mode {self.mode} in", self.output, *words)

    @kept_property
    def share(self) -> float:
        """The mode's amplitude in the output over the magnitude of the integral of exp(root (1 - k)) b(k)."""
        return abs(participation(self.machine, _mode(self.machine, self.mode), self.output))

    @kept_property
    def edges(self) -> tuple[BoxEdge, ...]:
        """The edges of the box; one where it is thin."""
        vibration = _mode(self.machine, self.mode)
        low, high = ((1.0 + sign * self.spread) * vibration.frequency for sign in (-1.0, 1.0))
        least, most = (asin(damping) for damping in self.dampings or (vibration.damping, vibration.damping))
        corners = [(low, least), (high, least), (high, most), (low, most)]
        sides = [BoxEdge(*sorted((a, b))) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
        counted = list(dict.fromkeys(side for side in sides if not side.single)) or [BoxEdge(corners[0], corners[0])]
        return tuple(counted)

    @property
    def counts(self) -> Sequence[int]:
        return [edge.count for edge in self.edges]

    def amplitudes(self, transform: Transform, edges: NDArray[np.intp], u: Array) -> Complex:
        return np.stack([self.share * transform(self.edges[i].roots(u)) for i in edges])

    def frequency(self, place: float, part: int = 0) -> float:
        return float(abs(self.edges[part].roots(np.array([2.0 * place - 1.0]))[0]))

    def check(self, space: LawSpace) -> None:
        check_rest(self.name, space)

    def unit(self, space: LawSpace, edge: int, bound: float, *, sought: bool) -> float:
        """The unit of the rows of an edge: the bound, or the base law's residual if there is no bound."""
        return bound or (float(np.abs(self.columns(space)[edge][:, -1]).max()) if sought else 0.0) or 1.0

    def _unit_of_slack(self, unit: float) -> float:
        return unit


def mode_residual(
    *,
    of: str | StateSpace,
    mode: float = 1,
    spread: float = 0.0,
    damping: tuple[float, float] | float | None = None,
    output: str | None = None,
) -> ModeResidual:
    """The greatest amplitude that a mode is left with in an output, over a box, as `Machine.residual` has it.

    `of` is the machine, or its text with the output.
    """
    machine = machine_of(of)
    name = machine.outputs[machine.place(output)]
    vibration = _mode(machine, mode)
    if vibration.frequency > 10.0 * _WIDEST or vibration.damping > _MOST_DAMPING:
        raise InputError(f"mode {vibration.number} hardly vibrates: use the peak of {name!r} in the dwell instead")
    share = not_negative(spread, "spread")
    pair = damping if isinstance(damping, list | tuple) else (damping, damping)
    dampings = None if damping is None else numbers(pair, "damping")
    if dampings is not None and (len(dampings) != 2 or not 0.0 <= dampings[0] <= dampings[1] <= _MOST_DAMPING):
        raise InputError(
            f"damping must be a ratio, or the least and the greatest of them, from 0 to {_MOST_DAMPING:g}, "
            f"got {shortened(damping)}"
        )
    if share >= 1.0:
        raise InputError(f"spread is a share of the frequency, below 1, such as 0.1, got {share:g}")
    words = [f"of={text_of(machine, name)!s}", f"mode={vibration.number}"]
    words += [f"spread={share!r}"] if share else []
    words += [f"damping=({dampings[0]!r}, {dampings[1]!r})"] if dampings else []
    text = f"mode_residual({', '.join(words)})"
    box: dict[str, Any] = {
        "mode": vibration.number,
        "spread": share,
        "dampings": dampings and (dampings[0], dampings[1]),
    }
    constant = ModeResidual(text, nan, convex=True, machine=machine, output=name, **box)
    constant.share  # noqa: B018 - a defective mode is refused at once
    return constant


MAKERS.setdefault("residual", residual_vibration)
MAKERS.setdefault("mode_residual", mode_residual)
