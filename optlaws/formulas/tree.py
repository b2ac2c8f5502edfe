"""Formulas as trees: frozen values that print themselves as the text they are read from again, and their names."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np

from optlaws.kept import kept_property


@dataclass(frozen=True)
class SmoothFunction:
    """A function of one number that is smooth wherever it has a value."""

    numpy: Callable[..., Any]  #: its values on arrays; CasADi and balls have it under its name
    rising: bool = False  #: whether it rises everywhere
    curvature: Literal["convex", "concave"] | None = None  #: if it is so everywhere
    from_zero: bool = False  #: whether it has values from 0 on alone


SMOOTH_FUNCTIONS = {
    "sin": SmoothFunction(np.sin),
    "cos": SmoothFunction(np.cos),
    "tan": SmoothFunction(np.tan),
    "atan": SmoothFunction(np.arctan, rising=True),
    "tanh": SmoothFunction(np.tanh, rising=True),
    "exp": SmoothFunction(np.exp, rising=True, curvature="convex"),
    "log": SmoothFunction(np.log, rising=True, curvature="concave", from_zero=True),
    "sqrt": SmoothFunction(np.sqrt, rising=True, curvature="concave", from_zero=True),
}


#: how the values of a table are joined between its places
TableJoin: TypeAlias = Literal["table", "spline", "monotone"]
#: orders of the derivatives of the law, by name
ORDERS = {"a": 0, "b": 1, "c": 2, "j": 3}
#: these, the power d = b c and the dimensionless time k
VOCABULARY = ("a", "b", "c", "d", "j", "k")


_SUM, _PRODUCT, _SIGNED, _ATOM = range(4)


@dataclass(frozen=True, eq=False, repr=False)
class Formula:
    """A part of a formula; `place` is where its text begins, and no part of its value.

    Examples
    --------
    >>> from optlaws.formulas.reading import read
    >>> formula = read("c + 0.2*b")
    >>> formula, sorted(formula.names())
    (c + 0.2*b, ['b', 'c'])
    """

    place: int = field(default=0, compare=False, kw_only=True)

    level = _ATOM

    @property
    def parts(self) -> tuple[Formula, ...]:
        """The formulas that are its direct parts."""
        return ()

    @kept_property
    def different(self) -> tuple[Formula, ...]:
        """The formula itself and all parts within it, without duplicates, each where it stands first.

        >>> from optlaws.formulas.reading import read
        >>> read("2*b + sin(2*b)").different
        (2*b + sin(2*b), 2*b, 2, b, sin(2*b))
        """
        seen: dict[Formula, None] = {}
        waiting: list[Formula] = [self]
        while waiting:
            part = waiting.pop()
            if part not in seen:
                seen[part] = None
                waiting.extend(part.parts[::-1])
        return tuple(seen)

    def names(self) -> frozenset[str]:
        """The names that occur anywhere in it."""
        return self._names

    @kept_property
    def _names(self) -> frozenset[str]:
        return frozenset().union(*(part._names for part in self.parts))  # noqa: SLF001 - its own kind

    @property
    def kinked(self) -> bool:
        """Whether it adds kinks to the kinks of its own parts."""
        return False

    @kept_property
    def kinked_names(self) -> frozenset[str]:
        """The names that occur in parts with kinks."""
        return self.names() if self.kinked else frozenset().union(*(part.kinked_names for part in self.parts))

    def __eq__(self, other: object) -> bool:
        if self is other:
            return True
        if not isinstance(other, Formula):
            return NotImplemented
        same = type(self) is type(other) and self._hash == other._hash and self.data == other.data
        return same and self.parts == other.parts

    def __hash__(self) -> int:
        return self._hash

    def __getstate__(self) -> dict[str, Any]:
        # what is kept beside the fields is computed again: hashes of texts differ from process to process
        return {entry.name: getattr(self, entry.name) for entry in fields(self)}

    @kept_property
    def _hash(self) -> int:
        return hash((type(self).__name__, self.data, self.parts))

    @property
    def data(self) -> Any:
        """Data of a part other than its parts; two parts of one kind with equal data and parts are equal."""
        return None

    @kept_property
    def known_branches(self) -> dict[tuple[int, ...], Formula]:
        """The smooth formulas that it is somewhere, by the choices of its maxima and tables: those known so far."""
        return {}

    @kept_property
    def steps(self) -> tuple[Step, ...]:
        """All different formulas within it, parts before wholes; the formula itself is the last.

        >>> from optlaws.formulas.reading import read
        >>> [str(step.formula) for step in read("sin(2*a) + sin(2*a)^2").steps]
        ['2', 'a', '2*a', 'sin(2*a)', 'sin(2*a)^2', 'sin(2*a) + sin(2*a)^2']
        """
        return shared_steps((self,))[0]

    def within(self, level: int) -> str:
        """Its text, in brackets where it binds less than its surroundings."""
        return str(self) if self.level >= level else f"({self})"

    def __repr__(self) -> str:
        return str(self)


@dataclass(frozen=True, eq=False, repr=False)
class Number(Formula):
    """A number of at least 0."""

    value: float

    @property
    def data(self) -> float:
        return self.value

    def __str__(self) -> str:
        whole = self.value == int(self.value) and self.value < 1e15
        return str(int(self.value)) if whole else repr(self.value)


@dataclass(frozen=True, eq=False, repr=False)
class Name(Formula):
    """A name, whatever it stands for."""

    name: str

    @property
    def data(self) -> str:
        return self.name

    @kept_property
    def _names(self) -> frozenset[str]:
        return frozenset((self.name,))

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True, eq=False, repr=False)
class OfOnePart(Formula):
    """A formula with a single part."""

    of: Formula

    @property
    def parts(self) -> tuple[Formula, ...]:
        return (self.of,)


@dataclass(frozen=True, eq=False, repr=False)
class Negative(OfOnePart):
    """A part with its sign turned."""

    level = _SUM

    def __str__(self) -> str:
        return f"-{self.of.within(_PRODUCT)}"


@dataclass(frozen=True, eq=False, repr=False)
class Sum(Formula):
    """A sum of two terms at least; what is subtracted is a `Negative`."""

    terms: tuple[Formula, ...]
    level = _SUM

    @property
    def parts(self) -> tuple[Formula, ...]:
        return self.terms

    def __str__(self) -> str:
        first, *others = self.terms
        text = str(first) if isinstance(first, Negative) else first.within(_PRODUCT)
        for factor in others:
            minus = isinstance(factor, Negative)
            text += f" - {factor.of.within(_PRODUCT)}" if isinstance(factor, Negative) else " + "
            text += "" if minus else factor.within(_PRODUCT)
        return text


@dataclass(frozen=True, eq=False, repr=False)
class Reciprocal(OfOnePart):
    """The reciprocal of a part; within a product, the divisor."""

    level = _PRODUCT

    def __str__(self) -> str:
        return f"1/{self.of.within(_SIGNED)}"


@dataclass(frozen=True, eq=False, repr=False)
class Product(Formula):
    """A product of at least two factors; a divisor is a `Reciprocal` factor."""

    factors: tuple[Formula, ...]
    level = _PRODUCT

    @property
    def parts(self) -> tuple[Formula, ...]:
        return self.factors

    def __str__(self) -> str:
        first, *others = self.factors
        text = first.within(_PRODUCT)
        for factor in others:
            text += f"/{factor.of.within(_SIGNED)}" if isinstance(factor, Reciprocal) else f"*{factor.within(_SIGNED)}"
        return text


@dataclass(frozen=True, eq=False, repr=False)
class Exponentiation(Formula):
    """A base with an exponent."""

    base: Formula
    exponent: Formula
    level = _SIGNED

    @property
    def parts(self) -> tuple[Formula, ...]:
        return self.base, self.exponent

    def __str__(self) -> str:
        return f"{self.base.within(_ATOM)}^{self.exponent.within(_ATOM)}"


@dataclass(frozen=True, eq=False, repr=False)
class Call(Formula):
    """A function of one part or several."""

    function: str
    arguments: tuple[Formula, ...]

    @property
    def parts(self) -> tuple[Formula, ...]:
        return self.arguments

    @property
    def data(self) -> str:
        return self.function

    @property
    def kinked(self) -> bool:
        return self.function in {"abs", "max", "min"}

    def __str__(self) -> str:
        return f"{self.function}({', '.join(map(str, self.arguments))})"


@dataclass(frozen=True, eq=False, repr=False)
class Table(OfOnePart):
    """A function of one part, given by values at places: straight lines between them, which go on beyond them.

    A "spline" is the cubic one through them (not a knot), with continuous curvature; a "monotone" curve is of cubics
    that rise and fall as the values do and never leave the range of two neighbours. Beyond the places both go on. Of an
    order above 0 it is that derivative, with the order in its text: spline1(a, ...).
    """

    places: tuple[float, ...]
    values: tuple[float, ...]
    kind: TableJoin = "table"
    order: int = 0

    @property
    def smooth(self) -> bool:
        """Whether the slope is continuous at the places."""
        return self.kind != "table"

    @property
    def kinked(self) -> bool:
        return not self.smooth and len(self.places) != 2

    @property
    def data(self) -> tuple[Any, ...]:
        return self.places, self.values, self.kind, self.order

    def __str__(self) -> str:
        pairs = (f"{plain(x)}:{plain(y)}" for x, y in zip(self.places, self.values, strict=True))
        return f"{self.kind}{self.order or ''}({self.of}, {', '.join(pairs)})"


def table_places(formula: Formula, name: str) -> list[float]:
    """The places of all tables of a name in a formula, ascending.

    >>> from optlaws.formulas.reading import read
    >>> table_places(read("table(x, 0:1, 2:5) + 3*table(x, 1:0, 2:1)", ("x",)), "x")
    [0.0, 1.0, 2.0]
    """
    tables = (part for part in formula.different if isinstance(part, Table) and part.of == Name(name))
    return sorted({place for table in tables for place in table.places})


class Step(NamedTuple):
    """A formula as a step of a computation: the steps that it needs, and the steps that are used last by it."""

    formula: Formula
    parts: tuple[int, ...]
    done: tuple[int, ...]


def shared_steps(formulas: Sequence[Formula]) -> tuple[tuple[Step, ...], tuple[int, ...]]:
    """All different formulas within several, parts before wholes; also the positions of the several themselves.

    >>> from optlaws.formulas.reading import read
    >>> steps, places = shared_steps([read("2*a + b"), read("2*a")])
    >>> [str(step.formula) for step in steps], places
    (['2', 'a', '2*a', 'b', '2*a + b'], (4, 2))
    """
    places: dict[int, int] = {}
    known: dict[Any, int] = {}
    different: list[tuple[Formula, tuple[int, ...]]] = []

    def place(formula: Formula) -> int:
        at = places.get(id(formula))
        if at is None:
            parts = tuple(place(part) for part in formula.parts)
            at = known.setdefault((type(formula), formula.data, parts), len(different))
            if at == len(different):
                different.append((formula, parts))
            places[id(formula)] = at
        return at

    results = tuple(place(formula) for formula in formulas)
    last = {part: i for i, (_, parts) in enumerate(different) for part in parts}
    done: list[list[int]] = [[] for _ in different]
    for part, i in last.items():
        if part not in results:
            done[i].append(part)
    steps = (Step(formula, parts, tuple(over)) for (formula, parts), over in zip(different, done, strict=True))
    return tuple(steps), results


def plain(value: float) -> str:
    """A number as formulas print it.

    >>> plain(3.0), plain(-0.25)
    ('3', '-0.25')
    """
    return f"-{Number(-value)}" if value < 0.0 else str(Number(value))


def number(value: float, place: int = 0) -> Formula:
    """A number of either sign.

    >>> number(-2.0)
    -2
    """
    return Negative(Number(-value, place=place), place=place) if value < 0.0 else Number(abs(value), place=place)


def total(terms: list[Formula], place: int = 0) -> Formula:
    """The sum of terms; sums within it are taken apart.

    >>> total([Name("c"), Negative(Name("b"))])
    c - b
    """
    flat = [part for term in terms for part in (term.terms if isinstance(term, Sum) else (term,))]
    return flat[0] if len(flat) == 1 else Sum(tuple(flat), place=place)


def product(factors: list[Formula], place: int = 0) -> Formula:
    """The product of factors; products within it are taken apart.

    >>> product([Name("c"), Reciprocal(Name("b"))])
    c/b
    """
    flat = [part for factor in factors for part in (factor.factors if isinstance(factor, Product) else (factor,))]
    return flat[0] if len(flat) == 1 else Product(tuple(flat), place=place)


def substituted(formula: Formula, by: Mapping[str, Formula]) -> Formula:
    """The formula with other formulas for some of its names.

    >>> from optlaws.formulas.reading import read
    >>> substituted(read("c + k*b"), {"k": read("1 - k")})
    c + (1 - k)*b
    """
    if isinstance(formula, Name):
        return by.get(formula.name, formula)
    if not formula.names() & by.keys():
        return formula
    parts = [substituted(part, by) for part in formula.parts]
    return rebuilt(formula, parts)


def rebuilt(formula: Formula, parts: list[Formula]) -> Formula:
    """The formula with other parts.

    >>> from optlaws.formulas.reading import read
    >>> rebuilt(read("c + b"), [read("c"), read("2*b")])
    c + 2*b
    """
    if isinstance(formula, Sum):
        return total(parts, formula.place)
    if isinstance(formula, Product):
        return product(parts, formula.place)
    if isinstance(formula, OfOnePart):
        return replace(formula, of=parts[0])
    if isinstance(formula, Exponentiation):
        return replace(formula, base=parts[0], exponent=parts[1])
    return replace(formula, arguments=tuple(parts)) if isinstance(formula, Call) else formula
