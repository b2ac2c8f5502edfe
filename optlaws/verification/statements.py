"""What an entry of a file states, compared with what is proven of it, claim by claim."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from math import inf
from typing import Any, TypeAlias

from optlaws.echo import shortened, unknown_key
from optlaws.errors import InputError
from optlaws.synthesis.limits.rounding import rounded_down
from optlaws.tolerances import STATED_BOUND
from optlaws.verification.reading import number
from optlaws.verification.result import Claim

Data: TypeAlias = Mapping[str, Any]
#: the claims of a statement, by its name
Rule: TypeAlias = Callable[[Any, str], Iterable[Claim]]
#: what is proven of an object, by its keys; None of what says nothing of laws, or is proven with the rest
Proven: TypeAlias = "Rule | Mapping[str, Proven] | None"

_STATED_CONSTANT = 1e-11  # of a constant: what one that was computed in doubles may be off


def compare(stated: Any, proven: Proven, name: str) -> Iterator[Claim]:
    """The claims of what is stated: of an object by its keys, of which each must be known; null states nothing."""
    if stated is None or proven is None:
        return
    if not isinstance(proven, Mapping):
        yield from proven(stated, name)
        return
    if not isinstance(stated, Mapping):
        raise InputError(f"{name} must be an object, got {shortened(stated)}")
    for key in stated:
        if key not in proven:
            raise InputError(f"{name}: {unknown_key(key, proven, 'entry')}; leave out what is not checked")
    for key, known in proven.items():
        yield from compare(stated.get(key), known, key)


def of_number(claim: Callable[[float], Claim]) -> Rule:
    """The rule of a statement that has to be a number."""
    return lambda stated, name: [claim(number({name: stated}, name))]


def near(name: str, stated: float, pair: tuple[float, float], scale: float = 1.0) -> Claim:
    """The claim that a stated value is the proven one up to rounding; a value near 0 is compared with its scale."""
    low, high = pair
    room = _STATED_CONSTANT * max(scale, abs(high)) if high < inf else 0.0
    # an enclosure that is wider than what may be off proves nothing of a number in it
    narrow = low == high or high - low <= room
    return Claim(name, narrow and low - room <= stated <= high + room, f"{stated!r} stated, in [{low!r}, {high!r}]")


def at_most(name: str, stated: float, proven: Fraction | None, scale: float, source: str = "") -> Claim:
    """The claim that a stated bound is proven up to rounding; a bound near 0 is compared with its scale."""
    if proven is None:
        return Claim(name, proven=False, detail=f"{stated!r} stated, nothing proven")
    holds = Fraction(stated) <= proven + Fraction(STATED_BOUND) * max(Fraction(scale), abs(proven))
    return Claim(name, holds, f"{stated!r} stated, {rounded_down(proven)!r} proven{source}")
