"""Objectives as sums and maxima of constants, written in Python or as text: 0.6*C/4 + 0.4*D/2.25."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from numbers import Real
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.numbers import MAGNITUDE_LIMIT, power_of_two, real

_LEAST_WEIGHT = 1e-3  # weights of an objective that are less are part of its scale

#: weights beyond are part of an objective's scale
_GREATEST_WEIGHT = 1e3


class Term:
    """A term of a sum: a constant of a law or a maximum. Numbers scale terms, and terms can be added.

    Examples
    --------
    >>> from optlaws import C, D
    >>> 0.5 * C / 4 + 0.5 * D / 2
    0.125*C + 0.25*D
    """

    @property
    def scale(self) -> float:
        """The size of the term in smooth laws, a power of 2."""
        return 1.0

    def expression(self) -> Expression:
        """The term alone, as a sum."""
        return Expression(((1.0, self),))

    def __add__(self, other: Term | Expression) -> Expression:
        return self.expression() + other

    def __mul__(self, factor: float) -> Expression:
        return self.expression() * factor

    def __rmul__(self, factor: float) -> Expression:
        return self.expression() * factor

    def __truediv__(self, divisor: float) -> Expression:
        return self.expression() / divisor


@dataclass(frozen=True, repr=False)
class Expression:
    """A sum of terms with weights above 0 (dimensionless); terms of weight 0 beside others are left out.

    Raises
    ------
    InputError
        If a weight is not a finite number of at least 0: with such a weight the sum would have no least value.

    Examples
    --------
    >>> from optlaws import C, D
    >>> (C / 4 + D / 2.25).weights()["C"]
    0.25
    >>> 0 * C / 4 + D / 2
    0.5*D
    """

    terms: tuple[tuple[float, Term], ...]

    def __post_init__(self) -> None:
        gathered: dict[Term, float] = {}
        for weight, term in _pairs(self.terms):
            if not isinstance(term, Term):
                raise InputError(f"an objective consists of constants of the law and maxima, got {shortened(term)}")
            if (number := real(weight)) is None or not 0.0 <= number <= MAGNITUDE_LIMIT:
                raise _no_weight(weight, f" for {getattr(term, 'title', '') or shortened(term)}")
            gathered[term] = gathered.get(term, 0.0) + float(weight)
        pairs = tuple((weight, term) for term, weight in gathered.items())
        # nothing but zeros is kept as it is: it may yet be added to something
        object.__setattr__(self, "terms", tuple(pair for pair in pairs if pair[0]) or pairs)

    def expression(self) -> Expression:
        """The constant itself, as an expression."""
        return self

    @property
    def vanishes(self) -> bool:
        """Whether all weights are 0, so that every law is as good as any other."""
        return not any(weight for weight, _ in self.terms)

    @property
    def scale(self) -> float:
        """The size of the sum in smooth laws, a power of 2, never 0, with which gaps are compared.

        Examples
        --------
        >>> from optlaws import C
        >>> (0.5 * C).scale, (2.0**-40 * C).scale * 2.0**40
        (1.0, 1.0)
        """
        unit = max(term.scale for _, term in self.terms)
        share = max(weight * (term.scale / unit) for weight, term in self.terms)
        return unit if _LEAST_WEIGHT < share < _GREATEST_WEIGHT else unit * power_of_two(share)

    def weights(self) -> dict[str, float]:
        """Weights by the name of the term."""
        return {repr(term): weight for weight, term in self.terms}

    def __add__(self, other: Term | Expression) -> Expression:
        if not isinstance(other, Term | Expression):
            return NotImplemented
        return Expression(self.terms + other.expression().terms)

    def __mul__(self, factor: float) -> Expression:
        if not _is_number(factor):
            return NotImplemented
        number = _factor(factor)
        return Expression(tuple((weight * number, term) for weight, term in self.terms))

    __rmul__ = __mul__

    def __truediv__(self, divisor: float) -> Expression:
        if not _is_number(divisor):
            return NotImplemented
        number = _factor(divisor)
        if number == 0.0:
            raise InputError("an objective cannot be divided by 0")
        return Expression(tuple((weight / number, term) for weight, term in self.terms))

    def __repr__(self) -> str:
        return " + ".join(repr(t) if w == 1.0 else f"{w!r}*{t!r}" for w, t in self.terms)


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _factor(value: object) -> float:
    number = real(value)
    if number is None:
        raise _no_weight(value)
    return number


def _no_weight(value: object, where: str = "") -> InputError:
    demand = "weights in an objective must be finite numbers above 0, or 0 beside others, and at most"
    return InputError(f"{demand} {MAGNITUDE_LIMIT:g}, got {shortened(value)}{where}")


def _pairs(terms: Any) -> list[tuple[float, Term]]:
    pairs = list(terms) if isinstance(terms, list | tuple) else [terms]
    if not pairs or not all(isinstance(pair, tuple) and len(pair) == 2 for pair in pairs):
        raise InputError(f"an objective needs pairs of a weight and a constant, at least one, got {shortened(terms)}")
    return pairs


@dataclass(frozen=True, repr=False)
class Maximum(Term):
    """The greatest of several sums.

    Examples
    --------
    >>> from optlaws import C, D, maximum
    >>> maximum(C / 4, D / 2)
    max(0.25*C, 0.5*D)
    """

    parts: tuple[Expression, ...]

    @property
    def scale(self) -> float:
        """The size of the greatest part, a power of 2."""
        return max(part.scale for part in self.parts)

    def __repr__(self) -> str:
        return f"max({', '.join(map(repr, self.parts))})"


def maximum(*parts: Term | Expression) -> Maximum:
    """The greatest of several terms or sums, itself a term.

    Raises
    ------
    InputError
        If there are fewer than two parts, or all weights of one are 0.

    Examples
    --------
    >>> from optlaws import C, D
    >>> len(maximum(C, D).parts)
    2
    """
    if len(parts) < 2:
        raise InputError("a maximum needs at least two parts")
    for part in parts:
        _check_part(part)
    return Maximum(tuple(part.expression() for part in parts))


def _check_part(part: object) -> None:
    if not isinstance(part, Term | Expression):
        raise InputError(f"a part of a maximum must be a constant of the law or a sum of them, got {shortened(part)}")
    if part.expression().vanishes:
        raise InputError(f"a part of a maximum needs a weight above 0, got {part!r}")


def leaves(expression: Expression) -> Iterator[tuple[float, Term]]:
    """Every term that is not a maximum, with the product of the weights that lead to it."""
    for weight, term in expression.terms:
        if isinstance(term, Maximum):
            for part in term.parts:
                yield from ((weight * inner, leaf) for inner, leaf in leaves(part))
        else:
            yield weight, term
