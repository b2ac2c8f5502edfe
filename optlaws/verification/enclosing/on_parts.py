"""Formulas on parts of the interval of k, between the places at which what depends on k alone has kinks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from fractions import Fraction

from optlaws.formulas.affine import affine
from optlaws.formulas.arithmetic import Arithmetic, evaluate
from optlaws.formulas.of_motion import MotionFormula
from optlaws.formulas.slopes import added, multiplied, opposite
from optlaws.formulas.tree import Call, Exponentiation, Formula, Number, Table, number, product, rebuilt
from optlaws.verification.enclosing.ball_formulas import exact_pieces

_KINKED = frozenset({"abs", "max", "min"})


def _whole_power(base: Fraction, exponent: Fraction) -> Fraction:
    if exponent.denominator != 1:
        raise ArithmeticError
    return Fraction(base**exponent.numerator)


_RATIONALS = Arithmetic(number=Fraction, functions={}, power=_whole_power)


def kinks(motion: MotionFormula) -> list[Fraction]:
    """The k of possible kinks of a function of k alone; exact for straight lines, else nearly.

    >>> from optlaws.formulas.of_motion import of_text
    >>> kinks(of_text("table(1 - k, 0:1, 0.25:2, 1:0)*c + abs(k - 0.5)*b"))
    [Fraction(1, 2), Fraction(3, 4)]
    """
    exact, inexact = [], []
    for part in motion.formula.walk():
        for difference in _vanishing(part) if part.names() <= {"k"} else ():
            root = _root(difference)
            if root is None:
                inexact += list(map(Fraction, MotionFormula(Call("abs", (difference,))).kinks))
            else:
                exact.append(root)
    return sorted({k for k in (*exact, *inexact) if 0 < k < 1})


def _vanishing(part: Formula) -> Iterator[Formula]:
    """Functions that vanish where a part has a kink."""
    if isinstance(part, Table):
        yield from (added([part.of, opposite(number(place))]) for place in part.places)
    elif isinstance(part, Call) and part.function in _KINKED:
        first, *others = part.arguments
        yield from [added([first, opposite(term)]) for term in others] or [first]


def _line(formula: Formula) -> tuple[Fraction, Fraction] | None:
    """Slope and value at 0 of a formula that is affine in k; None where it is not, or not rational."""
    straight = affine(formula, ("k",))
    if straight is None:
        return None
    try:
        slope = evaluate(dict(straight.factors).get("k", Number(0.0)), {}, _RATIONALS)
        return slope, evaluate(straight.rest, {}, _RATIONALS)
    except (ArithmeticError, KeyError, TypeError):
        return None


def _root(formula: Formula) -> Fraction | None:
    line = _line(formula)
    return None if line is None or not line[0] else -line[1] / line[0]


def on_part(formula: Formula, low: Fraction, high: Fraction) -> Formula:
    """The formula between two k, without kinks of what is affine in k if none is between them.

    >>> from optlaws.formulas.reading import read
    >>> on_part(read("abs(k - 0.5)*c + max(k, 0.25, b)"), Fraction(1, 2), Fraction(1))
    (k - 0.5)*c + max(k, 0.25, b)
    """
    parts = [on_part(part, low, high) for part in formula.parts]
    changed = rebuilt(formula, parts) if parts else formula
    if not changed.names() <= {"k"}:
        return changed
    if isinstance(changed, Table):
        return _piece(changed, low, high)
    if isinstance(changed, Call) and changed.function == "abs":
        [of] = changed.arguments
        sign = _sign(of, low, high)
        return changed if sign is None else multiplied([number(sign), of])
    if isinstance(changed, Call) and changed.function in _KINKED:
        return _greatest(changed, low, high)
    return changed


def _sign(formula: Formula, low: Fraction, high: Fraction) -> float | None:
    """The sign of a formula that is affine in k; None where it is not, or where the sign changes."""
    line = _line(formula)
    ends = [] if line is None else [line[0] * k + line[1] for k in (low, high)]
    if not ends:
        return None
    if min(ends) >= 0:
        return 1.0
    return -1.0 if max(ends) <= 0 else None


def _greatest(call: Call, low: Fraction, high: Fraction) -> Formula:
    """The argument of a maximum or minimum that is one throughout."""
    forth = 1.0 if call.function == "max" else -1.0
    for argument in call.arguments:
        signs: Iterable[float | None] = (
            _sign(added([argument, opposite(other)]), low, high) for other in call.arguments
        )
        # equal ones differ by 0, of which the sign is 1
        if all(other is argument or sign == forth for other, sign in zip(call.arguments, signs, strict=True)):
            return argument
    return call


def _piece(table: Table, low: Fraction, high: Fraction) -> Formula:
    """The piece of a table that its argument is on throughout."""
    line = _line(table.of)
    if line is None:
        return table
    first, last = sorted(line[0] * k + line[1] for k in (low, high))
    for i, row in enumerate(exact_pieces(replace(table, order=0))):
        start, stop = Fraction(table.places[i]), Fraction(table.places[i + 1])
        if not ((i == 0 or start <= first) and (i + 2 == len(table.places) or last <= stop)):
            continue
        if not table.smooth:
            return replace(table, places=table.places[i : i + 2], values=table.values[i : i + 2])
        off = added([table.of, opposite(number(table.places[i]))])
        return _differentiated([float(Fraction(int(value.p), int(value.q))) for value in row], off, table.order)
    return table


def _differentiated(row: list[float], off: Formula, nu: int) -> Formula:
    """The derivative of a sum of powers; its coefficients are floats, and so are these times their small factors."""
    terms = []
    for power, value in enumerate(row):
        factors = [Number(float(i)) for i in range(power - nu + 1, power + 1)]
        if power >= nu:
            lower = [Exponentiation(off, Number(float(power - nu)))] if power > nu else []
            # a product that is not worked out: its floats are rounded nowhere
            terms.append(product([*factors, number(value), *lower]))
    return added(terms)
