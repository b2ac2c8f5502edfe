"""Motion laws: immutable values with a displacement a and its derivatives on [0, 1]."""

from __future__ import annotations

from abc import abstractmethod
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws.constants import Constants
from optlaws.laws.curve import Curve, Sides
from optlaws.laws.exporting import LawExport
from optlaws.laws.storage import StoredLaw
from optlaws.numbers import Array, Quantity, derivative, times
from optlaws.numerics.peaks import Peak as Peak  # noqa: PLC0414 - a name of optlaws.laws
from optlaws.tolerances import JUMP

_JUMP_OF_LOWER = 1e-13  # the same as a share of a lower derivative: uniform motion has c = 0 but for it

if TYPE_CHECKING:
    from optlaws.shown.report import Report

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
