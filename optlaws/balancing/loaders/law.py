"""The law of an inertial loader: velocity Y sqrt(B² - b²), opposite in sign on the two sides of the top of b."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Self

import numpy as np

from optlaws.balancing.loaders.segment import LoaderSegment
from optlaws.balancing.loaders.tops import tops
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.curve import Sides
from optlaws.laws.segments.fractional import PowerSegment
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import PolynomialSegment, Segment
from optlaws.numbers import Array


@dataclass(frozen=True, repr=False)
class LoaderLaw(MotionLaw, kind="loader"):
    """The motion of the inertial loader that balances an executive law, over the k of that law (eq. 1).

    b_l = Y sqrt(B² - b²) up to the top of b and the opposite after it, so that b_l² + Y² b² = Y² B² and the powers
    cancel, d_l = -Y² d. The loader swings from a_l(0) = 0 to its turning point and back; the other half of its
    swing of 1 belongs to the return of the executive link. It may break where the executive law does; peaks look at
    both sides of a break as those of a piecewise law do.

    Parameters
    ----------
    executive
        The executive law; symmetric or not, from rest to rest or not.

    Raises
    ------
    InputError
        If the executive velocity is zero or not finite, or has its peak at k = 0 or 1 or an even number of times.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> law = LoaderLaw(smoothstep(2))
    >>> law
    LoaderLaw(Y=1.09384, B=1.64075, C=4.64075, D=4.14472, J=26.2521)
    >>> law.a(0.5), law.b(0.5), round(law.a(1.0), 15)
    (0.5, 0.0, 0.0)
    """

    executive: MotionLaw

    def __post_init__(self) -> None:
        if not isinstance(self.executive, MotionLaw):
            raise InputError(f"the executive law must be a MotionLaw, got {shortened(self.executive)}")
        tops(self.executive)

    @kept_property
    def Y(self) -> float:
        """The energy parameter Y: 1 / integral of the signed sqrt(B² - b²), so that the loader's swing is 1."""
        middle = len(self._tops) // 2
        turn = self._tops[middle].first
        swing = 0.0
        for (start, end), segment in zip(pairwise(self._stretches[0]), self._segments(1.0), strict=True):
            travel = float(segment.derivative(np.ones(1), end - start, 0)[0])
            swing += travel if end <= turn else -travel
        return 1.0 / swing

    @kept_property
    def _tops(self) -> Any:
        return tops(self.executive)

    @kept_property
    def _stretches(self) -> tuple[list[float], list[str]]:
        """Places that bound the stretches, and for each stretch which of its ends is a top, "flat" where both are."""
        places = {0.0, 1.0, *self.executive.breaks}
        for top in self._tops:
            places |= {top.first, top.last}
            places -= {k for k in places if top.first < k < top.last}
        bounds = sorted(places)
        kinds = [self._kind(start, end) for start, end in pairwise(bounds)]
        for i in reversed([i for i, kind in enumerate(kinds) if kind == "both"]):
            bounds.insert(i + 1, 0.5 * (bounds[i] + bounds[i + 1]))
            kinds[i : i + 1] = ["start", "end"]
        return bounds, kinds

    def _kind(self, start: float, end: float) -> str:
        if any((start, end) == (top.first, top.last) for top in self._tops):
            return "flat"
        begins = any(start == top.last for top in self._tops)
        ends = any(end == top.first for top in self._tops)
        return "both" if begins and ends else "start" if begins else "end" if ends else ""

    def _segments(self, Y: float) -> list[Segment]:
        bounds, kinds = self._stretches
        segments: list[Segment] = []
        for (start, end), kind in zip(pairwise(bounds), kinds, strict=True):
            passed = sum(top.last <= start for top in self._tops)
            segments.append(self._segment(start, end, kind, Y * (-1) ** passed))
        return segments

    def _segment(self, start: float, end: float, kind: str, scale: float) -> Segment:
        if kind == "flat":
            return PolynomialSegment(())
        if isinstance(self.executive, PiecewiseLaw):
            here = int(np.searchsorted(self.executive.breaks, 0.5 * (start + end))) - 1
            if isinstance(self.executive.segments[here], PowerSegment):
                # B² - b² is as straight as b² is: constant power again
                B = self.executive.peak(1).value
                inner = np.array([start, end])
                inner[1] = end if end == 1.0 else np.nextafter(end, start)
                b0, b1 = scale * np.sqrt(np.maximum(B * B - self.executive.b(inner) ** 2, 0.0))
                return PowerSegment(0.0 if kind == "start" else b0, 0.0 if kind == "end" else b1)
        return LoaderSegment(self.executive, start, end, scale, kind)

    @kept_property
    def piecewise(self) -> PiecewiseLaw:
        """The same law as segments between its breaks."""
        return PiecewiseLaw(self._stretches[0], self._segments(self.Y))

    @property
    def _breaks(self) -> tuple[float, ...]:
        return self.piecewise.breaks

    # each hook is that of the pieces, but for d, which is -Y² times that of the executive law and finite where c is not

    def _before_breaks(self, nu: int) -> Array:
        return self.piecewise._before_breaks(nu)  # noqa: SLF001 - of the same kind

    def _derivative(self, k: Array, nu: int) -> Array:
        return np.asarray(self.piecewise(k, nu))

    def _power(self, k: Array) -> Array:
        c = self._derivative(k, 2)
        known = np.isfinite(c)
        values = self._derivative(k, 1) * np.where(known, c, 0.0)
        return values if known.all() else np.where(known, values, -(self.Y**2) * np.asarray(self.executive.d(k)))

    def _sides(self, nu: int) -> Sides:
        return self.piecewise._sides(nu)  # noqa: SLF001 - of the same kind

    def _power_sides(self) -> Sides:
        k, values = self.executive._whole_power()  # noqa: SLF001 - of the same kind
        return k, -(self.Y**2) * values

    def _mean_square(self, nu: int) -> float:
        return self.piecewise._mean_square(nu)  # noqa: SLF001 - of the same kind

    def _summary(self) -> str:
        return f"Y={self.Y:g}"

    @classmethod
    def _read(cls, fields: dict[str, Any]) -> Self:
        return cls(MotionLaw.from_dict(fields["executive"]))
