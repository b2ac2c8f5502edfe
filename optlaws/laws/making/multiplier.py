"""The multiplier method (eq. 1.6): new laws from the acceleration of a law and an even positive function."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws.law import MotionLaw
from optlaws.laws.making.transform import as_polynomial
from optlaws.laws.polynomial import PolynomialLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import Segment
from optlaws.numbers import Array, finite, fractions
from optlaws.numerics import chebyshev, exact
from optlaws.tolerances import JUMP, VALUE_ROUNDING

_MULTIPLIER_MET = 1e-10  # of a wanted constant: it is met
_MULTIPLIER_CLOSE = 1e-14  # of a wanted constant: no further step is taken
_MULTIPLIER_STEP = 1e-5  # of a coefficient, for slopes by differences

Multiplier = Sequence[Any] | NDArray[Any] | Callable[[float], float]

_ROUNDS, _HALVINGS = 30, 12


def multiplied_law(law: MotionLaw, y: Multiplier) -> MotionLaw:
    """The law with the acceleration s c y (eq. 1.6), where s keeps the stroke unchanged (eq. 1.7).

    y is even about k = 1/2 and nowhere negative, so that the area of c wanders to the ends of the interval where y
    has its minimum in the middle, and to the middle where it has its maximum there. The velocity at the ends stays.

    Parameters
    ----------
    law
        A law whose c is odd about k = 1/2, or at least one for which c y changes the velocity by nothing in all.
    y
        Ascending powers of k, for which a polynomial law has exact powers and polynomial pieces stay polynomials; or
        a smooth function of one k in [0, 1], which is interpolated to machine accuracy.

    Returns
    -------
    A polynomial law for a polynomial one, else a piecewise law. Pieces of powers of time keep their closed form,
    sines become polynomials to machine accuracy.

    Raises
    ------
    InputError
        If y is not even about 1/2, is negative somewhere, is zero everywhere or is not smooth; if c y would change the
        velocity or would give no stroke.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> from optlaws import savin
    >>> multiplied_law(smoothstep(4), [2, -6, 6]) == savin("III", alpha=6.0)
    True
    >>> import math
    >>> multiplied_law(smoothstep(3), lambda k: math.exp((k - 0.5) ** 2))
    PolynomialLaw(degree=..., B=1.8..., C=..., D=..., J=...)
    """
    even = _even(y)
    _check_nowhere_negative(even)
    return _product(law, even)


def multiplier_for(
    law: MotionLaw,
    *,
    B: float | None = None,
    C: float | None = None,
    D: float | None = None,
    J: float | None = None,
    c0: float | None = None,
) -> tuple[float, ...]:
    """The multiplier y of (1.6) with m coefficients that gives a law m - 1 prescribed constants, and its own stroke.

    y is a sum of m even powers of 2k - 1, and comes from a search; `multiplied_law(law, y)` is the law that has them.

    Parameters
    ----------
    law
        As for `multiplied_law`.
    B, C, D, J
        Required peaks of the law.
    c0
        Its acceleration at the start.

    Returns
    -------
    Ascending powers of k, 2m - 1 of them (dimensionless).

    Raises
    ------
    InputError
        If no constant is given or one is no number, if the search has no y with so many coefficients for them,
        or if the y that does is negative somewhere.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> y = multiplier_for(smoothstep(4), B=1.9, C=6.5)
    >>> multiplied_law(smoothstep(4), y)
    PolynomialLaw(degree=11, B=1.9, C=6.5, D=7.14..., J=53.2...)
    """
    targets = _targets({"B": B, "C": C, "D": D, "J": J, "c0": c0})
    powers = _scaled_powers(law, len(targets) + 1)
    values = np.array(list(targets.values()))
    start = _values(law, targets)
    size = np.maximum(np.abs(start), np.abs(values))

    def missing(weights: Array) -> Array:
        product = _values(_product(law, _combined(powers, weights)), targets)
        return np.asarray((product - values) / np.where(size > 0.0, size, 1.0))

    coefficients = _searched(missing, len(targets))
    even = _combined(powers, coefficients)
    if _most(missing(coefficients)) > _MULTIPLIER_MET:
        nearest = _in_words(targets, _values(_product(law, even), targets))
        raise InputError(
            f"no y of {len(powers)} even powers was found that gives {_in_words(targets, values)}; "
            f"the nearest gives {nearest}, and y = 1 {_in_words(targets, start)}"
        )
    _check_nowhere_negative(even)
    return exact.rounded(exact.exact_powers(even))


def _product(law: MotionLaw, even: Sequence[Fraction]) -> MotionLaw:
    if isinstance(law, PiecewiseLaw):
        return _of_pieces(law, np.array(exact.rounded(even)))
    return _of_polynomial(law if isinstance(law, PolynomialLaw) else as_polynomial(law), even)


def _targets(constants: Mapping[str, float | None]) -> dict[str, float]:
    targets = {name: finite(value, name) for name, value in constants.items() if value is not None}
    if not targets:
        raise InputError(f"a multiplier is found for one or more of {', '.join(constants)}, such as B=1.9")
    return targets


def _values(law: MotionLaw, targets: Iterable[str]) -> Array:
    return np.array([law.c(0.0) if name == "c0" else getattr(law.constants, name).value for name in targets])


def _scaled_powers(law: MotionLaw, count: int) -> list[list[Fraction]]:
    """Chebyshev series of even powers of 2k - 1, each scaled so that c times it gives the stroke."""
    powers: list[list[Fraction]] = []
    for n in range(count):
        power = fractions(np.polynomial.chebyshev.poly2cheb([*(2 * n * [0.0]), 1.0]), "y")
        product = _product(law, power)
        k = law.peak(2).k if n == 0 else product.peak(2).k
        scale = Fraction(product.c(k)) / Fraction(law.c(k) * (2.0 * k - 1.0) ** (2 * n))
        powers.append([scale * value for value in power])
    return powers


def _combined(powers: Sequence[Sequence[Fraction]], weights: Array) -> list[Fraction]:
    """A sum of scaled powers whose weights add up to 1, so that the first weight follows from the others."""
    first = 1 - sum(map(Fraction, weights), start=Fraction(0))
    total = [Fraction(0)] * len(powers[-1])
    for weight, power in zip((first, *map(Fraction, weights)), powers, strict=True):
        for i, value in enumerate(power):
            total[i] += weight * value
    return total


def _searched(missing: Callable[[Array], Array], count: int) -> Array:
    """The weights of least error, searched from y = 1, from a y smaller in the middle and from a larger one."""
    answers = []
    for first in (0.0, 0.5, -0.5):
        start = np.zeros(count)
        start[0] = first
        answers.append(_newton(missing, start))
        if _most(missing(answers[-1])) <= _MULTIPLIER_MET:
            break
    return min(answers, key=lambda weights: _most(missing(weights)))


def _newton(missing: Callable[[Array], Array], weights: Array) -> Array:
    """Newton's method by differences, each step halved until less is missing; peaks that change places bend its way."""
    misses = missing(weights)
    for _ in range(_ROUNDS):
        if _most(misses) <= _MULTIPLIER_CLOSE:
            break
        moves = _MULTIPLIER_STEP * np.eye(len(weights))
        slopes = np.column_stack([(missing(weights + move) - missing(weights - move)) / 2.0 for move in moves])
        step = np.linalg.lstsq(slopes / _MULTIPLIER_STEP, misses, rcond=None)[0]
        shares = (0.5**n for n in range(_HALVINGS))
        better = next((s for s in shares if np.linalg.norm(missing(weights - s * step)) < np.linalg.norm(misses)), None)
        if better is None:
            break
        weights = weights - better * step
        misses = missing(weights)
    return weights


def _most(misses: Array) -> float:
    return float(np.abs(misses).max())


def _in_words(names: Iterable[str], values: Iterable[float]) -> str:
    return ", ".join(f"{name} = {value:.6g}" for name, value in zip(names, values, strict=True))


def _even(y: Multiplier) -> list[Fraction]:
    """The Chebyshev series of y in 2k - 1, without the odd part that rounding left."""
    if callable(y):
        series = chebyshev.interpolated(lambda x: np.array([float(y(k)) for k in 0.5 * (x + 1.0)]), "y")
        given = fractions(series, "y")
    else:
        given = exact.exact_chebyshev(fractions(y, "y"))
    size = max(map(abs, given), default=Fraction(0))
    if size == 0:
        raise InputError("y must not be zero everywhere")
    odd = sum(map(abs, given[1::2]), start=Fraction(0))
    if odd > VALUE_ROUNDING * size:
        raise InputError(
            f"y must be even about k = 1/2, but y(k) and y(1 - k) differ by up to {2.0 * float(odd):.3g}; "
            "write it in powers of k (1 - k)"
        )
    return [Fraction(0) if n % 2 else value for n, value in enumerate(given)]


def _check_nowhere_negative(even: Sequence[Fraction]) -> None:
    low, _ = PolynomialLaw.from_chebyshev(even).extrema(0)
    if low.value < -VALUE_ROUNDING * float(max(map(abs, even))):
        raise InputError(f"y must be at least 0 everywhere, but is {low.value:.6g} at k = {low.k:.6g}")


def _of_polynomial(law: PolynomialLaw, y: Sequence[Fraction]) -> PolynomialLaw:
    powers = law.exact_powers()
    c = [n * (n - 1) * value for n, value in enumerate(powers)][2:] or [Fraction(0)]
    product = exact.times(c, exact.exact_powers(y))
    swing = [value / ((n + 1) * (n + 2)) for n, value in enumerate(product)]
    change = sum((value / (n + 1) for n, value in enumerate(product)), start=Fraction(0))
    _check_still(float(change), law)
    a0, b0 = Fraction(law.a0), Fraction(law.b0)
    scale = _scale(sum(powers, start=Fraction(0)) - a0 - b0, sum(swing, start=Fraction(0)))
    return PolynomialLaw.from_powers([a0, b0, *(scale * value for value in swing)])


def _of_pieces(law: PiecewiseLaw, y: Array) -> PiecewiseLaw:
    pairs = list(pairwise(law.breaks))
    segments: list[Segment] = []
    velocity = 0.0
    for segment, (start, end) in zip(law.segments, pairs, strict=True):
        length = end - start
        product = segment.times(length, _restricted(y, start, end))
        joined = product.scaled(length, 1.0, velocity - product.velocity(length))
        # a rest at infinite acceleration that rounding missed is a rest
        segments.append(joined.at_rest(length, VALUE_ROUNDING))
        velocity = segments[-1].velocity(length, last=True)
    _check_still(velocity, law)
    swing = PiecewiseLaw(law.breaks, segments)
    b0 = law.b(0.0)
    scale = float(_scale(Fraction(law.a(1.0) - law.a0 - b0), Fraction(swing.a(1.0))))
    changed = [part.scaled(end - start, scale, b0) for part, (start, end) in zip(segments, pairs, strict=True)]
    return PiecewiseLaw(law.breaks, changed, law.a0)


def _restricted(y: Array, start: float, end: float) -> Array:
    """The series on a part of the interval: of the same degree, so that as many points fix it."""
    x = chebyshev.nodes(len(y))
    return chebyshev.from_values(chebyshev.value(y, start + end - 1.0 + (end - start) * x))


def _check_still(change: float, law: MotionLaw) -> None:
    if abs(change) > JUMP * law.peak(2).value:
        raise InputError(
            f"c y would change the velocity by {change:.6g} in all; the method needs a law whose acceleration is odd "
            f"about k = 1/2, got {shortened(law)}"
        )


def _scale(needed: Fraction, given: Fraction) -> Fraction:
    if given == 0:
        raise InputError("c y gives no stroke: the law must have an acceleration, and y must not vanish where it has")
    return needed / given
