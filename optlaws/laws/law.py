"""Motion laws: immutable values with a displacement a and its derivatives on [0, 1].

With them their constants, their export to controllers, and where they go forwards, backwards, or rest: that is decided
by their extremes, not by the sign of a rounded velocity.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING, Any, Literal, Self, TypedDict, Unpack

import numpy as np

from optlaws.echo import keywords_of, shortened
from optlaws.errors import InputError
from optlaws.files.reading import JsonText, entries_of
from optlaws.kept import kept_property
from optlaws.laws.curve import Curve, Sides
from optlaws.laws.storage import StoredLaw
from optlaws.numbers import Array, NumberOrQuantity, Quantity, bounded, derivative, finite, times
from optlaws.numerics.peaks import Peak as Peak  # noqa: PLC0414 - a name of optlaws.laws
from optlaws.tolerances import JUMP, VALUE_ROUNDING

if TYPE_CHECKING:
    from optlaws.shown.report import Report
    from optlaws.shown.summary import Summary


@dataclass(frozen=True, slots=True)
class Constants(JsonText):
    """The constants of a law, dimensionless.

    Attributes
    ----------
    B, C, D, J
        Peaks of |b|, |c|, |d|, |j| over the whole interval.
    rms_c
        Root mean square of c.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> smoothstep(2).constants.C
    Peak(value=6.0, k=0.0)
    """

    _json_name = "constants"

    B: Peak
    C: Peak
    D: Peak
    J: Peak
    rms_c: float

    def to_dict(self, *, rms: bool = True) -> dict[str, dict[str, float | None] | float | None]:
        """B, C, D, J as {"value": ..., "k": ...}; rms_c too unless `rms` is False; None where a value has no bound.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> smoothstep(2).constants.to_dict()["B"]
        {'value': 1.5, 'k': 0.5}
        """
        table: dict[str, dict[str, float | None] | float | None] = {
            "B": self.B.to_dict(),
            "C": self.C.to_dict(),
            "D": self.D.to_dict(),
            "J": self.J.to_dict(),
        }
        if rms:
            table["rms_c"] = bounded(self.rms_c)
        return table

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """The constants that `to_dict` described, all five of them.

        Raises
        ------
        InputError
            If an entry is missing or no number.
        """
        entries = entries_of(data, ("B", "C", "D", "J", "rms_c"), cls._json_name)
        rms_c = entries.pop("rms_c")
        peaks = {name: Peak.from_dict(peak) for name, peak in entries.items()}
        return cls(**peaks, rms_c=inf if rms_c is None else finite(rms_c, "rms_c"))

    def summary(self) -> Summary:
        """The peaks with their places, and the root mean square of c, as rows.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> [row.name for row in smoothstep(2).constants.summary() if row.place == 0.0]
        ['C', 'J']
        """
        from optlaws.shown.summary import Row, Summary

        peaks = [Row(name, peak.value, place=peak.k) for name in "BCDJ" for peak in [getattr(self, name)]]
        return Summary([*peaks, Row("RMS of c", self.rms_c)], at="k")

    def _repr_html_(self) -> str:
        return self.summary()._repr_html_()


#: of which each format takes some
Interpolation = Literal["linear", "cubic", "spline", "akima", "c1", "quintic", "septic"]


class AxesExportOptions(TypedDict, total=False):
    """The options of exports to controllers; each format has some of them, as `optlaws export --list` shows.

    Parameters
    ----------
    points
        How many points, or "best", as it is unless given: the fewest whose run is as good as that of any number.
        Formats of polynomials take a number, or as few pieces as will do unless given.
    counts
        Steps of the slave's encoder over the stroke, to which positions are rounded.
    digits, decimal
        Digits behind the decimal sign, and the sign, "." or ",", of tables as text.
    interpolation
        The interpolation of the controller, where the format can state it.
    task
        Time of the drive's task, such as "1 ms": the report then says what it samples once in each.
    """

    points: int | Literal["best"] | None
    counts: int | None
    digits: int | None
    decimal: Literal[".", ","] | None
    interpolation: Interpolation | None
    task: NumberOrQuantity | None


class ExportOptions(AxesExportOptions, total=False):
    """The options of an export of one motion: `name` of the variable, the table or the joint, "Cam" unless given."""

    name: str | None


class LawExport:
    """The export of a law, or of a value with a law and its proof."""

    @keywords_of(ExportOptions)
    def export(
        self,
        to: str,
        *,
        stroke: Quantity | None = None,
        duration: Quantity | None = None,
        master: Quantity | None = None,
        start: Quantity | None = None,
        **options: Unpack[ExportOptions],
    ) -> Any:
        """The law in the format of a controller, with the executed motion and the proof of the law.

        Parameters
        ----------
        to
            The format: `optlaws export --list` names them.
        stroke
            How far the slave moves, "35 mm" or "-20 deg": positions are in its unit.
        duration, master
            How long it takes, "0.1 s", and how far the master goes meanwhile, "120 deg"; one of them or both. Without
            a master it is time in seconds.
        start
            Position at the start; 0 unless given.
        points, counts, digits, decimal, interpolation, task, name
            As `ExportOptions` has them: how many points, of which numbers, for which task of the drive.

        Returns
        -------
        An `Export`: its `text`, its `report`, its `run`; `write(file)` writes it.

        Raises
        ------
        InputError
            If there is no such format, it takes no such option, or it cannot hold the motion.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> table = smoothstep(4).export("csv", stroke="40 mm", master="120 deg", counts=65536, points=361)
        >>> round(table.report.ratio(2), 1), round(table.report.bound / table.report.law.peak(2), 1)
        (1.9, 1.6)
        >>> import optlaws
        >>> basis = optlaws.Pieces(8, degree=7, continuity=3)
        >>> solution = optlaws.synthesize(optlaws.Problem(B=1.859, order=4, basis=basis))
        >>> program = solution.export("codesys-cambuilder", stroke="35 mm", duration="0.1 s", master="120 deg")
        >>> [line.strip() for line in program.text.splitlines() if "lower bound" in line]
        ['law: least C = 4.59646..., lower bound 4.59646... in its space; status optimal']
        """
        from optlaws.exports.export import export_law

        (law, proof), (usual_stroke, usual_duration) = self._exported(), self._in_machine
        placement = {
            "stroke": usual_stroke if stroke is None else stroke,
            "duration": usual_duration if duration is None else duration,
            "master": master,
            "start": start,
        }
        return export_law(law, to, placement, proof, **options)

    #: the stroke and the duration unless others are given
    _in_machine: tuple[Quantity | None, Quantity | None] = (None, None)

    def _exported(self) -> tuple[Any, tuple[str, ...]]:
        """The law and its proof, as text for files."""
        return self, ()


_JUMP_OF_LOWER = 1e-13  # the same as a share of a lower derivative: uniform motion has c = 0 but for it

Jumps = tuple[tuple[float, float], ...]

HIGHEST = 9

_NINE = np.linspace(0.0, 1.0, 9)


class MotionLaw(Curve, LawExport, StoredLaw):
    """Displacement a(k) of k in [0, 1] with its derivatives; dimensionless (eq. 1).

    Velocity b = a', acceleration c = a'', jerk j = a''', kinetic power d = b c. With stroke h and duration T
    the motion is h a and its derivatives are (h/T) b, (h/T²) c, (h/T³) j. Laws are immutable, hashable, and
    equal where type and contents are equal.

    At a break a derivative takes its right-hand value, at k = 1 the left-hand one; peaks and extrema look at both
    sides of every break. Where a derivative jumps inside (0, 1), those of higher order are impulses: J is inf at
    the first k where c jumps, C (and D) where b jumps, and `jumps` gives the size. What happens at k = 0 and k = 1
    is not counted: rest before and after the motion is no part of it.

    A new representation is one subclass, a frozen dataclass declared with its kind, for example
    ``class SplineLaw(MotionLaw, kind="spline")``, that supplies the abstract methods and, if it has breaks, `_breaks`
    and `_before_breaks`; storage, peaks, jumps and drawings follow.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> law = smoothstep(3)
    >>> law(0.5), law.b(0.5), law([0.0, 1.0], nu=2).tolist()
    (0.5, 1.875, [0.0, 0.0])
    """

    def extrema(self, nu: int, within: tuple[float, float] | None = (0.0, 1.0)) -> tuple[Peak, Peak]:
        return super().extrema(nu, within)

    def boundary_values(self, count: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """The first `count` of a, b, c, c', ... at k = 0, and the same at k = 1.

        Raises
        ------
        InputError
            If `count` is not an integer of at least 0.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> smoothstep(2).boundary_values(3)
        ((0.0, 0.0, 6.0), (1.0, 0.0, -6.0))
        """
        ends = np.array([0.0, 1.0])
        pairs = [self._derivative(ends, nu).tolist() for nu in range(derivative(count, "count"))]
        return tuple(pair[0] for pair in pairs), tuple(pair[1] for pair in pairs)

    def jumps(self, nu: int) -> Jumps:
        """Breaks k inside (0, 1) where the derivative of order nu jumps, each with right-hand less left-hand value.

        Differences below 1e-9 of the derivative's size, or 1e-13 of that of a lower one, are taken for rounding.

        Raises
        ------
        InputError
            If `nu` is not an integer of at least 0.

        Examples
        --------
        >>> from optlaws.laws.segments import PolynomialSegment
        >>> from optlaws import PiecewiseLaw
        >>> PiecewiseLaw([0, 0.5, 1], [PolynomialSegment([], b0=b) for b in (0.5, 1.5)]).jumps(1)
        ((0.5, 1.0),)
        """
        nu = derivative(nu)
        if nu not in self._known_jumps:
            self._known_jumps[nu] = self._jumps(nu)
        return self._known_jumps[nu]

    @property
    def continuity(self) -> int:
        """The highest nu, up to 9, such that all derivatives up to order nu are finite and continuous on [0, 1].

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> from optlaws import scca
        >>> smoothstep(2).continuity, scca(0.25, 0.5, 0.25).continuity
        (9, 3)
        """
        for nu in range(1, HIGHEST + 1):
            if self.jumps(nu) or not self._is_finite(nu):
                return nu - 1
        return HIGHEST

    @kept_property
    def constants(self) -> Constants:
        """B, C, D, J with their places, and the RMS of c; computed at the first use.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> smoothstep(2).constants.J
        Peak(value=12.0, k=0.0)
        """
        return Constants(B=self.peak(1), C=self.peak(2), D=self.power_peak(), J=self.peak(3), rms_c=self.rms(2))

    def pieces(
        self,
        stroke: Quantity | None = None,
        duration: Quantity | None = None,
        *,
        master: Quantity | None = None,
        start: Quantity | None = None,
        tolerance: float = 1e-9,
    ) -> Any:
        """Times and polynomial coefficients in machine units, as a `PiecewiseMotion`: `breaks`, `coefficients`.

        Exact, each coefficient rounded once, where the law consists of polynomials; else within `tolerance`, a share of
        the stroke, over the whole interval. `stroke`, `duration`, `master` and `start` are those of `export`.

        Raises
        ------
        InputError
            If a quantity is wrong, or the law's derivatives grow without limit.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> pieces = smoothstep(2).pieces("0.5 m", "2 s")
        >>> pieces.breaks, pieces.coefficients
        ((0.0, 2.0), ((0.0, 0.0, 0.375, -0.125),))
        """
        from optlaws.exports.polynomial_pieces import pieces_of_law

        return pieces_of_law(self, tolerance, stroke=stroke, duration=duration, master=master, start=start)

    def report(self) -> Report:
        """The constants, and the curves of a, b, c, d and j through their extremes, as values that outputs render.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> [(panel.name, panel.ends) for panel in smoothstep(2).report().panels][1:3]
        [('velocity b', (0.0, 1.5)), ('acceleration c', (-6.0, 6.0))]
        """
        from optlaws.laws.report import LawReport

        return LawReport(self)

    def __repr__(self) -> str:
        constants = self.constants
        shown = f"B={constants.B.value:g}, C={constants.C.value:g}, D={constants.D.value:g}, J={constants.J.value:g}"
        return f"{type(self).__name__}({self._summary()}, {shown})"

    def _repr_html_(self) -> str:
        from optlaws.shown.report import report_page

        return report_page(f"{type(self).__name__}, {self._summary()}", self.report())

    def _times(self, k: Any) -> Array:
        return times(k)

    @kept_property
    def _known_jumps(self) -> dict[int, Jumps]:
        return {}

    def _jumps(self, nu: int) -> Jumps:
        inner = self.breaks[1:-1]
        left, right = self._before_breaks(nu), self._derivative(np.array(inner), nu)
        if np.array_equal(left, right):
            return ()
        rounding = JUMP * self._size(nu)
        jumps = tuple(
            (k, after - before)
            for k, before, after in zip(inner, left.tolist(), right.tolist(), strict=True)
            if before != after and not abs(after - before) <= rounding
        )
        unseen = max((_JUMP_OF_LOWER * self._size(lower) for lower in range(1, nu)), default=0.0) if jumps else 0.0
        return tuple((k, height) for k, height in jumps if not abs(height) <= unseen)

    def _size(self, nu: int) -> float:
        """The greatest finite magnitude of a derivative at nine places of every piece."""
        breaks = np.array(self.breaks)
        k = np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * _NINE[:-1]).ravel(), 1.0)
        known = np.abs(np.append(self._derivative(k, nu), self._before_breaks(nu)))
        return float(known[np.isfinite(known)].max(initial=0.0))

    def _is_finite(self, nu: int) -> bool:
        """Whether the derivative of order nu is bounded; no kind of law grows without limit but at its breaks."""
        sides = np.append(self._derivative(np.array(self.breaks), nu), self._before_breaks(nu))
        return bool(np.isfinite(sides).all())

    def _impulses(self, nu: int) -> Sides:
        if len(self.breaks) == 2:
            return super()._impulses(nu)
        jumps = [(place, height * inf) for place, height in self.jumps(nu - 1)] if nu > 1 else []
        # the derivative of an impulse has both signs
        jumps += [(place, side) for lower in range(1, nu - 1) for place, _ in self.jumps(lower) for side in (inf, -inf)]
        places, heights = np.array(jumps).reshape(-1, 2).T
        return places, heights

    def _whole_power(self) -> Sides:
        k, values = self._power_sides()
        jumps = [place for place, _ in self.jumps(1)]
        return (np.append(k, jumps), np.append(values, np.full(len(jumps), inf))) if jumps else (k, values)

    @abstractmethod
    def _summary(self) -> str:
        """The text of the repr without the constants."""


def motion_law(value: Any, name: str = "law") -> MotionLaw:
    """The value, if it is a motion law; of an entry of the catalogue or a solution, its law.

    Raises
    ------
    InputError
        If it is not one.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> motion_law(smoothstep(3)) == smoothstep(3)
    True
    """
    if isinstance(value, MotionLaw):
        return value
    law = getattr(value, "law", None)
    if not isinstance(law, MotionLaw):
        raise InputError(
            f"{name} must be a motion law, a MotionLaw such as smoothstep(4) or savin('III', 7.2), "
            f"got {shortened(value)}"
        )
    return law


_HALVES = 60


@dataclass(frozen=True, eq=False)
class Direction:
    """The direction of a law: 1 forwards, -1 backwards, 0 at rest, constant between ascending edges from 0 to 1.

    Examples
    --------
    >>> from optlaws import catalogue, smoothstep
    >>> law = catalogue["4-5-6-7 polynomial"].law
    >>> k = np.array([1.0749790817499163e-08])
    >>> law.b(k).tolist(), direction_of(law)(k).tolist()
    ([-1.1102230246251565e-16], [1.0])
    >>> direction_of(smoothstep(2)).edges
    array([0., 1.])
    """

    edges: Array
    signs: Array

    def __call__(self, k: Array) -> Array:
        """The direction at places, at an edge just after it, at the end just before it."""
        return np.asarray(self.signs[np.searchsorted(self.edges[1:-1], k, side="right")])

    @property
    def turns(self) -> Array:
        """The places inside where the direction changes."""
        return self.edges[1:-1]


@lru_cache(maxsize=256)
def direction_of(law: MotionLaw) -> Direction:
    """The direction of a law.

    Between neighbouring extremes the velocity is monotone, so that the direction follows from its values there; one
    that is rounding beside the greatest velocity has none of its own. A law rests where its velocity is no more than
    that between two breaks.
    """
    k, b = law._sides(1)  # noqa: SLF001 - one package
    order = np.argsort(k, kind="stable")
    k, b = k[order], b[order]
    size = float(np.max(np.abs(b), where=np.isfinite(b), initial=0.0))
    signs = np.where(np.abs(b) <= VALUE_ROUNDING * size, 0.0, np.sign(b))
    edges, ways = [0.0], list[float]()
    for start, stop in pairwise(law.breaks):
        inner = (k > start) & (k < stop)
        first, last = np.flatnonzero(k == start)[-1], np.flatnonzero(k == stop)[0]
        which = np.concatenate([[first], np.flatnonzero(inner), [last]])
        for place, sign in _ways(law, k[which], signs[which]):
            edges.append(place)
            ways.append(sign)
    return _joined(np.array(edges), np.array(ways))


def _ways(law: MotionLaw, k: Array, signs: Array) -> list[tuple[float, float]]:
    """The directions between two breaks, each with the place where it ends."""
    known = np.flatnonzero(signs)
    if not len(known):
        return [(float(k[-1]), 0.0)]
    turns = [(_zero(law, k[i : j + 1], signs[i]), float(signs[i])) for i, j in pairwise(known) if signs[i] != signs[j]]
    return [*turns, (float(k[-1]), float(signs[known[-1]]))]


def _zero(law: MotionLaw, k: Array, sign: float) -> float:
    """The place between the first and the last where the velocity leaves a sign; halfway where it rests meanwhile."""
    if len(k) > 2:
        return float(0.5 * (k[1] + k[-2]))
    low, high = float(k[0]), float(k[1])
    for _ in range(_HALVES):
        middle = 0.5 * (low + high)
        if law.b(middle) * sign > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def _joined(edges: Array, ways: Array) -> Direction:
    """The directions with those that are alike and neighbours as one."""
    changed = np.flatnonzero(np.diff(ways)) + 1
    edges = np.concatenate([edges[:1], edges[changed], edges[-1:]])
    signs = np.concatenate([ways[:1], ways[changed]])
    edges.flags.writeable = signs.flags.writeable = False
    return Direction(edges, signs)
