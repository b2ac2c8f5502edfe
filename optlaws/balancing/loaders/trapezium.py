"""The trapezium that stands for an executive law when its loader is worked out by hand (eq. 4 to 25)."""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, isfinite, sqrt

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.making.trapezoids import trapezoid
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.tolerances import VALUE_ROUNDING


def closed_form_Y(e13: float, gamma_w: float) -> float:
    """Energy parameter of the trapezium with these e13 and gamma_w in closed form (eq. 25), with the paper's series.

    It is evaluated outside the domain of trapezia too, where it is a number without a law behind it.

    Raises
    ------
    InputError
        If a quantity under a root is negative.

    Examples
    --------
    >>> round(closed_form_Y(0.6, 0.25), 6)
    0.922295
    """
    m, n = _lengths(e13, gamma_w)
    A, B, rest = 6.0 * e13 * gamma_w, 1.0 / e13, 0.5 - m - n
    ratio = A * B
    try:
        ramp = B * (m - 0.9 * m**3 / ratio**2 - 1.125 * m**5 / ratio**4 - 3.5 * m**7 / ratio**6)
        plateau = _circle(m + 2.0 * n, A, B) - _circle(m, A, B)
        fall = 0.0
        if rest > VALUE_ROUNDING:
            fall = sqrt(8.0 * A * B**3 * rest / 27.0)
            fall -= sqrt((2.0 * ratio * rest - 3.0 * rest**2) ** 3 / 27.0) / (A * rest)
    except ValueError:
        raise InputError(f"eq. 25 has no value at e13 = {e13:g}, gamma_w = {gamma_w:g}; {_range(gamma_w)}") from None
    return 0.5 / (ramp + plateau + fall)


@dataclass(frozen=True)
class TrapeziumSubstitute:
    """Trapezium with a ramp of length m, a plateau of n and a fall to k = 1/2, given by e13 and gamma_w (eq. 4 to 25).

    Parameters
    ----------
    e13
        Distance between the centroids of the two areas of the acceleration, 1/B.
    gamma_w
        Share of the half diagram that the acceleration fills, B/C.

    Raises
    ------
    InputError
        If no trapezium has them: gamma_w is outside [1/4, 1/2], or the ramp or the fall would be negative.

    Examples
    --------
    >>> substitute = TrapeziumSubstitute(e13=0.6, gamma_w=0.30)
    >>> round(substitute.m, 6), substitute.n, round(substitute.Y, 6)
    (0.071429, 0.1, 0.91971)
    >>> substitute.law
    PiecewiseLaw(segments=6, B=1.66667, C=5.55556, D=4.81598, J=77.7778)
    """

    e13: float
    gamma_w: float

    def __post_init__(self) -> None:
        if not (isfinite(self.e13) and isfinite(self.gamma_w) and 0.25 <= self.gamma_w <= 0.5):
            raise InputError(f"gamma_w of a trapezium must be from 0.25 to 0.5, got {shortened(self.gamma_w)}")
        least, most = _bounds(self.gamma_w)
        if not least - VALUE_ROUNDING <= self.e13 <= most + VALUE_ROUNDING:
            raise InputError(
                f"no trapezium has e13 = {self.e13:g} with gamma_w = {self.gamma_w:g}; {_range(self.gamma_w)}"
            )

    @classmethod
    def of(cls, law: MotionLaw) -> TrapeziumSubstitute:
        """The substitute of a law: of the same B and C.

        Raises
        ------
        InputError
            If no trapezium has them.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> round(TrapeziumSubstitute.of(smoothstep(3)).Y, 6)
        0.760045
        """
        B, C = law.peak(1).value, law.peak(2).value
        return cls(1.0 / B, B / C)

    @property
    def m(self) -> float:
        """The length of the ramp, a share of the motion."""
        return max(_lengths(self.e13, self.gamma_w)[0], 0.0)

    @property
    def n(self) -> float:
        """The length of the plateau, a share of the motion."""
        return _lengths(self.e13, self.gamma_w)[1]

    @property
    def A(self) -> float:
        """The paper's abbreviation 6 e13 gamma_w (eq. 7)."""
        return 6.0 * self.e13 * self.gamma_w

    @property
    def Y(self) -> float:
        """Energy parameter in closed form (eq. 25), good to 1e-7."""
        return closed_form_Y(self.e13, self.gamma_w)

    @kept_property
    def law(self) -> PiecewiseLaw:
        """The trapezium as a law, for its exact loader."""
        return trapezoid(self.m, self.n)


def _lengths(e13: float, gamma_w: float) -> tuple[float, float]:
    g = gamma_w
    return (8.0 * g - 8.0 * g * g - 0.5 - 6.0 * e13 * g) / (8.0 * g - 1.0), 2.0 * g - 0.5


def _bounds(gamma_w: float) -> tuple[float, float]:
    g = gamma_w
    return (8.0 * g * g - 2.0 * g + 0.5) / (6.0 * g), (8.0 * g - 8.0 * g * g - 0.5) / (6.0 * g)


def _range(gamma_w: float) -> str:
    least, most = _bounds(gamma_w)
    return f"e13 may be from {least:.6g} to {most:.6g} there"


def _circle(width: float, A: float, B: float) -> float:
    """Half of the area under sqrt(B² - x²) from 0 to x = 3 width / A, in units of k."""
    x = 3.0 * width / A
    inside = B * B - x * x
    inside = 0.0 if abs(inside) < VALUE_ROUNDING * B * B else inside
    return 0.25 * width * sqrt(inside) + A * B * B / 12.0 * asin(
        min(x / B, 1.0) if x < B * (1.0 + VALUE_ROUNDING) else 2.0
    )
