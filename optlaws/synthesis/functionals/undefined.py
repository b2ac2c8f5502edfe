"""Places where formulas have no value: in all laws, by the end conditions, or in some laws."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.formulas.of_motion import MotionFormula, divisor
from optlaws.formulas.reading import FormulaError, read
from optlaws.formulas.slopes import constant
from optlaws.formulas.tree import ORDERS, SMOOTH_FUNCTIONS, Call, Exponentiation, Formula, Reciprocal
from optlaws.numbers import Array
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions

#: values of b or c, among them 0, 1/2 and 1
_FROM_ZERO = frozenset(name for name, function in SMOOTH_FUNCTIONS.items() if function.from_zero)
_PASSED = 2049
#: motions at random, of which sizes, and how often one of the names is 0
_MOTIONS, _STILL = 4096, 0.2
_SIZES = {"a": 1.0, "b": 2.0, "c": 8.0, "j": 60.0}


def check_ends(motion: MotionFormula, conditions: BoundaryConditions) -> None:
    """Refuse a formula that has no value at the end conditions: at rest 1/b divides by 0."""
    for k, end in ((0.0, conditions.start), (1.0, conditions.end)):
        known = {name: end[nu] for name, nu in ORDERS.items() if nu < len(end)}
        every = motion.formula.different if motion.start <= k <= motion.stop else ()
        parts = [part for part in every if part.names() <= {*known, "k"} and part.names() & ORDERS.keys()]
        wrong = [part for part in parts if not np.isfinite(MotionFormula(part).values({**known, "k": k}))]
        if wrong:
            values = " and ".join(f"{name} = {known[name]:g}" for name in sorted(wrong[0].names() & ORDERS.keys()))
            text = str(motion.formula)
            places = (same.place for same in read(text).different if same == wrong[-1])
            raise FormulaError(
                f"{motion.formula} has no finite value at k = {k:g}, where {values} in every law: ask for a part "
                "of the interval, such as start=0.05, stop=0.95",
                text,
                next(places, 0),
            )


def check_passed(motion: MotionFormula, conditions: BoundaryConditions, *, smooth: bool) -> None:
    """Refuse a formula without a value wherever every law comes by: 1/(b - 1), where laws rise by 1 from rest to rest.

    They pass all a from 0 to 1, all b from 0 to their mean 1, and all c from -1 to 1 where c does not jump.
    """
    at_rest = conditions.start[:2] == (0, 0) and conditions.end[:2] == (1, 0)
    passed = {"a": (0.0, 1.0), "b": (0.0, 1.0)} | ({"c": (-1.0, 1.0)} if smooth else {})
    for part in motion.formula.different if at_rest and (motion.start, motion.stop) == (0.0, 1.0) else ():
        (name,) = part.names() if len(part.names()) == 1 else ("",)
        if name not in passed:
            continue
        values = np.linspace(*passed[name], _PASSED)
        nowhere = _nowhere(part, {name: values})
        if nowhere.any():
            raise InputError(
                f"{motion.formula} has no finite value where {name} = {values[nowhere][0]:.4g}, which every law "
                "passes: ask for a part of the interval, such as start=0.05, stop=0.2"
            )


def pitfalls(motion: MotionFormula) -> Iterator[str]:
    """Parts of a formula that some motions bring where they have no value or no slope, in words."""
    for part in motion.formula.different:
        if not part.names() & ORDERS.keys():
            continue
        if isinstance(part, Reciprocal):
            low, high = _between(part.of, motion)
            if low <= 0.0 <= high:
                yield f"{part} has no value where {part.of} = 0"
            continue
        inner = None
        if isinstance(part, Exponentiation) and not float(constant(part.exponent) or 0.5).is_integer():
            inner = part.base
        elif isinstance(part, Call) and part.function in _FROM_ZERO:
            inner = part.arguments[0]
        if inner is not None and _between(inner, motion)[0] <= 0.0:
            yield f"{part} has no slope or no value where {inner} <= 0"


def _between(formula: Formula, motion: MotionFormula) -> tuple[float, float]:
    """The least and the greatest of a formula's values in some motions, most of them gentle, some without any."""
    numbers = np.random.default_rng(0)
    names = {name: size * numbers.normal(size=_MOTIONS) for name, size in _SIZES.items()}
    for values in names.values():
        values[numbers.random(_MOTIONS) < _STILL] = 0.0
    k = motion.start + (motion.stop - motion.start) * numbers.random(_MOTIONS)
    values = np.broadcast_to(MotionFormula(formula).values({**names, "k": k}), (_MOTIONS,))
    known = values[np.isfinite(values)]
    return (float(known.min()), float(known.max())) if len(known) else (np.inf, -np.inf)


def _nowhere(part: Formula, names: Mapping[str, Array]) -> NDArray[np.bool_]:
    """Ascending values at which a part has no value, or none before the next one."""
    nowhere = ~np.isfinite(MotionFormula(part).values(names))
    beneath = divisor(part)
    if beneath is not None:
        below = MotionFormula(beneath).values(names)
        nowhere |= np.append(below[:-1] * below[1:] < 0.0, [False])
    return nowhere
