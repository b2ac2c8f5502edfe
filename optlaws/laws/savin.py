"""Savin's families of laws: members by alpha or by a peak constant, peaks in closed form (docs/papers/savin.md).

With p = k (1 - k), y = 1 + alpha (M - p) and q = 1/4 - p the laws are c = H p^u sqrt(q) y and
b = H/2 p^(u+1) F with F = (1 + alpha M)/(u+1) - alpha p/(u+2).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from math import comb, factorial, sqrt
from typing import Literal

from numpy.polynomial import Polynomial

from optlaws.echo import shortened, unknown_key
from optlaws.errors import InputError
from optlaws.laws.polynomial import PolynomialLaw
from optlaws.numbers import MOST_EXPONENT, finite, fractions, whole
from optlaws.numerics.panels import Panels
from optlaws.numerics.peaks import Peak
from optlaws.numerics.roots import bisect

_p, _q = Polynomial([0.0, 1.0]), Polynomial([0.25, -1.0])
_TERMS = 5  # of a quartic: the cubics are of less


def acceleration_peak(u: int, H: int, M: float, alpha: Fraction) -> Peak:
    """Peak of c: the stationary points solve a quadratic in z = (1/2 - k)².

    Examples
    --------
    >>> acceleration_peak(0, 12, 0.1, Fraction(0))
    Peak(value=6.0, k=0.0)
    """
    slope = float(alpha)
    middle = float(1 + alpha * (Fraction(u + 1, 2 * (2 * u + 5)) - Fraction(1, 4)))  # y at k = 1/2
    quadratic = (-0.25 * middle, (2 * u + 1) * middle - 0.75 * slope, (2 * u + 3) * slope)
    start = 6.0 * (1.0 + slope * M) if u == 0 else 0.0
    best = Peak(start, 0.0)
    for z in _positive_roots(*quadratic):
        if z < 0.25:
            value = H * (0.25 - z) ** u * sqrt(z) * (middle + slope * z)
            if value > best.value:
                best = Peak(value, 0.5 - sqrt(z))
    return best


def _positive_roots(constant: float, linear: float, square: float) -> list[float]:
    """Positive roots of a quadratic with real roots, without cancellation where it is nearly linear."""
    half = -0.5 * (
        linear + (1.0 if linear >= 0.0 else -1.0) * sqrt(max(linear * linear - 4.0 * constant * square, 0.0))
    )
    roots = [constant / half if half else 0.0, half / square if square else 0.0]
    return [z for z in roots if z > 0.0]


def power_peak(u: int, H: int, M: Fraction, alpha: Fraction) -> Peak:
    """Peak of d: the stationary points solve a cubic in p.

    Examples
    --------
    >>> power_peak(0, 12, Fraction(1, 10), Fraction(0))
    Peak(value=3.464102, k=0.211325)
    """
    first = float(1 + alpha * M)
    slope = float(alpha)
    y, F = Polynomial([first, -slope]), Polynomial([first / (u + 1), -slope / (u + 2)])
    cubic = -_p * y * F + (4 * u + 2) * _q * y * F - 2.0 * slope * _p * _q * F - 2.0 * slope / (u + 2) * _p * _q * y

    def d(p: float) -> float:
        q = max(0.25 - p, 0.0)
        return 0.5 * H * H * sqrt(q) * p ** (2 * u + 1) * float(y(p)) * float(F(p))

    return max(
        (Peak(d(p), 0.5 - sqrt(max(0.25 - p, 0.0))) for p in _roots(cubic, 0.0, 0.25)), key=lambda peak: peak.value
    )


def least_power(u: int, M: Fraction) -> float:
    """The alpha of least D: d is stationary in p and in alpha at the root of a cubic between M and M'.

    Stationary in alpha gives alpha as a function of p; then -1/(2q) + (2u+3)/p + 1/(M'-p) - 1/(p-M) = 0 with
    M' = M (u+2)/(u+1).

    Examples
    --------
    >>> round(least_power(0, Fraction(1, 10)), 9)
    2.286235382
    """
    low, high = float(M), float(M * Fraction(u + 2, u + 1))
    above, below = Polynomial([high, -1.0]), Polynomial([-low, 1.0])
    cubic = -0.5 * _p * above * below + (2 * u + 3) * _q * above * below + _p * _q * below - _p * _q * above
    # the cubic is negative at M and positive at M'; among the candidates are real parts of its complex roots
    root = min(_roots(cubic, low, high), key=lambda place: abs(float(cubic(place))))
    rest = low / (u + 1) - root / (u + 2)
    return -((low - root) / (u + 1) + rest) / (2.0 * (low - root) * rest)


def _roots(polynomial: Polynomial, low: float, high: float) -> list[float]:
    """Every place in [low, high] among which is each root."""
    return [float(place) for place in Panels((low, high), _TERMS).roots(polynomial, polynomial.deriv())]


ROUNDING = Fraction(1, 2**51)  # an end of a range such as 44/3 is no float, but means itself


FAMILIES = {"I": 0, "II": 1, "III": 2, "IV": 3}


@dataclass(frozen=True)
class SavinFamily:
    """The family over the base law c = H (k(1-k))^u (1/2-k); its constants are closed forms of alpha.

    The paper's families I to IV have u = 0 to 3; every further u gives a family as well.

    Parameters
    ----------
    u
        Exponent of the base law, an integer of at least 0. Derivatives of a of orders 1 to u + 1 vanish at the ends.

    Raises
    ------
    InputError
        If `u` is not an integer of at least 0.

    Examples
    --------
    >>> family = SavinFamily.of("III")
    >>> family.u, family.H, family.M, family.range
    (2, 840, Fraction(1, 6), (Fraction(-6, 1), Fraction(12, 1)))
    >>> family.B(7.2), family.C(7.2)
    (Peak(value=1.859375, k=0.5), Peak(value=6.760957, k=0.200661))
    >>> family.law(-6.0) == family.next.law(0.0)
    True
    """

    u: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "u", whole(self.u, "u", most=MOST_EXPONENT))

    @classmethod
    def of(cls, family: str | int) -> SavinFamily:
        """The family of a name I to IV, or of an exponent u.

        Raises
        ------
        InputError
            If it is neither.
        """
        if isinstance(family, str):
            if family not in FAMILIES:
                raise InputError(f"{unknown_key(family, FAMILIES, 'family')}, or an integer u of at least 0")
            return cls(FAMILIES[family])
        return cls(whole(family, "family (I, II, III, IV or the exponent u of the base law)"))

    def __str__(self) -> str:
        names = {u: name for name, u in FAMILIES.items()}
        return f"family {names[self.u]}" if self.u in names else f"the family of u = {self.u}"

    @property
    def H(self) -> int:
        """Factor of the base law, 2 (2u+3)! / (u! (u+1)!)."""
        return 2 * factorial(2 * self.u + 3) // (factorial(self.u) * factorial(self.u + 1))

    @property
    def M(self) -> Fraction:
        """Mean of k (1 - k) that keeps the stroke at 1, (u+1) / (2 (2u+5)); all c of a family meet where k(1-k) = M."""
        return Fraction(self.u + 1, 2 * (2 * self.u + 5))

    @property
    def range(self) -> tuple[Fraction, Fraction]:
        """Least and greatest alpha, -1/M and 1/(1/4 - M), between which y >= 0."""
        return -1 / self.M, 1 / (Fraction(1, 4) - self.M)

    @property
    def next(self) -> SavinFamily:
        """The family whose base law is this one's member of least alpha."""
        return SavinFamily(self.u + 1)

    @property
    def order(self) -> int:
        """Number l of conditions at each end that every member meets, u + 2."""
        return self.u + 2

    def check(self, alpha: float) -> Fraction:
        """The exact value of an alpha that lies in the range.

        Raises
        ------
        InputError
            If it does not, or is not a finite real number.
        """
        (exact,) = fractions([alpha], "alpha")
        for end in self.range:
            if abs(exact - end) <= ROUNDING * abs(end):
                return end
        if self.range[0] < exact < self.range[1]:
            return exact
        low, high = map(float, self.range)
        raise InputError(f"alpha of {self} must be between {low:.9g} and {high:.9g} (y >= 0), got {shortened(alpha)}")

    def law(self, alpha: float) -> PolynomialLaw:
        """The member `alpha`, of degree 2u + 5, by exact arithmetic.

        Raises
        ------
        InputError
            If `alpha` is outside the range.
        """
        exact = self.check(alpha)
        multiplier = [1 + exact * self.M, -exact, exact]
        acceleration = [Fraction(0)] * (2 * self.u + 4)
        for i in range(self.u + 1):
            for m, factor in enumerate(multiplier):
                part = self.H * (-1) ** i * comb(self.u, i) * factor
                acceleration[self.u + i + m] += part / 2
                acceleration[self.u + i + m + 1] -= part
        displacement = [Fraction(0), Fraction(0)]
        displacement += [value / ((n + 1) * (n + 2)) for n, value in enumerate(acceleration)]
        return PolynomialLaw.from_powers(displacement)

    def start(self, alpha: float) -> tuple[int, float]:
        """Order and value of the first derivative of a that is not zero at k = 0 (eq. 1.11 for family I).

        Raises
        ------
        InputError
            If `alpha` is outside the range.
        """
        first = 1 + self.check(alpha) * self.M
        if first == 0:
            return self.next.start(0.0)
        return self.order, float(Fraction(self.H * factorial(self.u), 2) * first)

    def B(self, alpha: float) -> Peak:
        """Peak velocity, linear in alpha and always at k = 1/2.

        Raises
        ------
        InputError
            If `alpha` is outside the range.
        """
        u, exact = self.u, self.check(alpha)
        slope = (1 + exact * self.M) / (u + 1) - exact / (4 * (u + 2))
        return Peak(float(Fraction(self.H, 2 * 4 ** (u + 1)) * slope), 0.5)

    def C(self, alpha: float) -> Peak:
        """Peak acceleration, at a root of a quadratic in (1/2 - k)², or at the start (u = 0).

        Raises
        ------
        InputError
            If `alpha` is outside the range.
        """
        return acceleration_peak(self.u, self.H, float(self.M), self.check(alpha))

    def D(self, alpha: float) -> Peak:
        """Peak power, at a root of a cubic in k (1 - k).

        Raises
        ------
        InputError
            If `alpha` is outside the range.
        """
        return power_peak(self.u, self.H, self.M, self.check(alpha))

    @property
    def least_C(self) -> tuple[float, Peak]:
        """The alpha of least C, u/M - 1/(2 (1/4 - M)), and that C with its place, where k (1 - k) = M."""
        spare = Fraction(1, 4) - self.M
        alpha = float(self.u / self.M - 1 / (2 * spare))
        k = 0.5 - float(spare) ** 0.5
        return alpha, Peak(self.H * float(spare) ** 0.5 * float(self.M) ** self.u, k)

    @property
    def least_D(self) -> tuple[float, Peak]:
        """The alpha of least D and that D with its place: from the root of a cubic, or the greatest alpha (u > 3)."""
        alpha, end = least_power(self.u, self.M), float(self.range[1])
        best = min(alpha, end)
        return best, self.D(best)

    def alphas(self, *, B: float | None = None, C: float | None = None, D: float | None = None) -> tuple[float, ...]:
        """Every alpha whose member has the given peak, ascending: a single one for B, up to two for C and D.

        C and D fall with alpha to their least value and rise again, so that the first of two members is the one on
        the side of the next family's base law.

        Parameters
        ----------
        B, C, D
            The peak; exactly one.

        Raises
        ------
        InputError
            If not exactly one is given, or no member has it; the message states the reachable range.

        Examples
        --------
        >>> SavinFamily(2).alphas(C=7.0)
        (2.489092, 10.244387)
        """
        return _alphas(self, B=B, C=C, D=D)


def _alphas(
    family: SavinFamily, *, B: float | None = None, C: float | None = None, D: float | None = None
) -> tuple[float, ...]:
    given = [(name, value) for name, value in (("B", B), ("C", C), ("D", D)) if value is not None]
    if len(given) != 1:
        raise InputError(f"give exactly one of B, C and D, got {' and '.join(name for name, _ in given) or 'none'}")
    ((name, value),) = given
    value = finite(value, name)
    if name == "B":
        return (_alpha_of_velocity(family, value),)
    peak, (best, least) = (family.C, family.least_C) if name == "C" else (family.D, family.least_D)

    def height(alpha: float) -> float:
        return peak(alpha).value

    low, high = map(float, family.range)
    _check_reachable(family, name, value, least.value, max(height(low), height(high)))
    if value == least.value:
        return (best,)
    return tuple(_root(lambda alpha: height(alpha) - value, best, end) for end in (low, high) if height(end) >= value)


def _alpha_of_velocity(family: SavinFamily, B: float) -> float:
    low, high = family.range
    most, least = (Fraction(family.B(float(alpha)).value) for alpha in (low, high))
    _check_reachable(family, "B", B, float(least), float(most))
    alpha = float(low + (high - low) * (most - Fraction(B)) / (most - least))
    return min(max(alpha, float(low)), float(high))


def _check_reachable(family: SavinFamily, name: str, value: float, least: float, most: float) -> None:
    if not least <= value <= most:
        raise InputError(f"{name} of {family} reaches from {least:.9g} to {most:.9g}, got {shortened(value)}")


def _root(excess: Callable[[float], float], inner: float, outer: float) -> float:
    """The place between, to the last digit: excess is below zero at the inner end and not below at the outer one."""
    return outer if excess(outer) == 0.0 else bisect(lambda place: excess(place) < 0.0, inner, outer)[1]


def savin(
    family: str | int,
    alpha: float | None = None,
    *,
    B: float | None = None,
    C: float | None = None,
    D: float | None = None,
    branch: Literal["lower", "upper"] | None = None,
) -> PolynomialLaw:
    """A member of Savin's families I to IV (eq. 1.10, 1.14, 1.15, 1.16) or of those beyond, dimensionless.

    Its acceleration is c = H (k(1-k))^u (1/2-k) y with y = 1 + alpha (k² - k + M), M such that the stroke is 1;
    alpha = 0 gives the base law.

    Parameters
    ----------
    family
        "I", "II", "III", "IV", or the exponent u of the base law, any integer of at least 0; family I is u = 0.
    alpha
        Parameter of the member; or else exactly one of the next three.
    B, C, D
        The peak that the member shall have. B has one member, C and D may have two.
    branch
        "lower" or "upper", which of two members: alpha below or above that of the least C, or D.

    Raises
    ------
    InputError
        If the family is unknown, alpha is outside the range in which y >= 0, no member has the peak, or two have it
        and `branch` does not say which.

    Examples
    --------
    >>> savin("III", 0.0) == savin("II", -7.0)
    True
    >>> savin("III", alpha=7.2)
    PolynomialLaw(degree=9, B=1.85938, C=6.76096, D=7.16667, J=54.3787)
    >>> savin("I", B=1.45)
    PolynomialLaw(degree=5, B=1.45, C=6.8, D=3.29666, J=21.6)
    """
    known = SavinFamily.of(family)
    given = [name for name, value in (("alpha", alpha), ("B", B), ("C", C), ("D", D)) if value is not None]
    if len(given) != 1:
        raise InputError(f"a member is given by one of alpha, B, C and D, got {' and '.join(given) or 'none'}")
    if alpha is not None:
        if branch is not None:
            raise InputError("branch selects one of two members with the same C or D; alpha alone identifies a member")
        return known.law(alpha)
    if branch not in (None, "lower", "upper"):
        raise InputError(f"branch must be 'lower' or 'upper', got {shortened(branch)}")
    members = known.alphas(B=B, C=C, D=D)
    if len(members) == 1:
        return known.law(members[0])
    if branch is None:
        both = " and ".join(f"{member:.9g}" for member in members)
        raise InputError(
            f"{known} has two members of this {given[0]}, alpha = {both}; say branch='lower' or branch='upper'"
        )
    return known.law(members[0 if branch == "lower" else 1])


def alpha_range(family: str | int) -> tuple[float, float]:
    """Least and greatest alpha of a family, -1/M and 1/(1/4 - M), between which y >= 0.

    Parameters
    ----------
    family
        "I", "II", "III", "IV" or the exponent u of its base law.

    Raises
    ------
    InputError
        If the family is unknown.

    Examples
    --------
    >>> alpha_range("III")
    (-6.0, 12.0)
    """
    low, high = SavinFamily.of(family).range
    return float(low), float(high)
