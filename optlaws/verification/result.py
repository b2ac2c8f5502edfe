"""What a file states, compared claim by claim with what is proven.

Files are plain data, read strictly: no repeated keys, every number finite, and no size that would run for days.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from math import inf, isfinite
from numbers import Real
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

from optlaws.echo import shortened, unknown_key
from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.files.reading import is_number, of_known_format
from optlaws.numbers import bounded
from optlaws.numerics.exact import rounded_down
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.data import as_json
from optlaws.tolerances import STATED_BOUND, STORED_VALUE

Kind = TypeVar("Kind")

#: greatest entries that are sizes, and how many numbers a law may have
_SIZES = {"order": 100, "degree": 300, "continuity": 300, "breaks": 1000}
#: greatest magnitude of a number: none of a motion law comes near, and its powers are still numbers
_GREATEST = 1e100


def read(source: Mapping[str, Any] | Path | str) -> Mapping[str, Any]:
    """A JSON object, or data that could be one.

    >>> read({"order": 4, "B": float("inf")})
    Traceback (most recent call last):
    optlaws.errors.InputError: B must be a finite number, got inf
    """
    data = source if isinstance(source, Mapping) else _loaded(Path(source))
    try:
        _check(data, "")
        plain: dict[str, Any] = as_json(data)
    except InputError:
        raise
    except RecursionError:
        raise InputError("this is nested too deeply to be a solution") from None
    except (TypeError, ValueError) as error:
        raise InputError(f"this is no plain data: {error}") from None
    return plain


def _loaded(file: Path) -> Mapping[str, Any]:
    data = reading.parsed(reading.text(file), str(file))
    if not isinstance(data, dict):
        raise InputError(f"{file}: not a JSON object but {type(data).__name__}")
    return data


def _check(data: object, path: str) -> None:
    if isinstance(data, Mapping):
        for key, value in data.items():
            _check_size(key, value, path)
            _check(value, f"{path}.{key}" if path else str(key))
        if "format" in data:
            of_known_format(data, path or "the file")
    elif isinstance(data, list | tuple):
        for i, value in enumerate(data):
            # most of a file are numbers
            if type(value) is not float or not abs(value) <= _GREATEST:
                _check(value, f"{path}[{i}]")
    elif isinstance(data, Real):
        _check_number(data, path)


def _check_number(value: Real, path: str) -> None:
    try:
        finite = isfinite(value)
    except OverflowError:
        raise InputError(f"{path} is beyond the numbers of double precision") from None
    if not finite:
        raise InputError(f"{path} must be a finite number, got {value!r}")
    if abs(float(value)) > _GREATEST:
        raise InputError(f"{path}: {value!r} is beyond what exact verification takes, {_GREATEST:g}")


def _check_size(key: str, value: object, path: str) -> None:
    most = _SIZES.get(key)
    size = len(value) if isinstance(value, list | tuple) else value
    if most is not None and isinstance(size, int) and size > most:
        raise InputError(f"{f'{path}.' if path else ''}{key}: {size} is more than exact verification takes, {most}")


def built(make: Callable[[Any], Kind], data: object, name: str) -> Kind:
    """The value that `make` builds from data of any kind."""
    try:
        return make(data)
    except InputError as error:
        raise InputError(f"{name}: {error}") from None
    except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError) as error:
        raise InputError(f"{name}: {type(error).__name__}: {error}") from None


def number(data: Mapping[str, Any], name: str) -> float:
    """An entry that must be a number."""
    value = data.get(name)
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InputError(f"{name} must be a finite number, got {value!r}")
    return float(value)


@dataclass(frozen=True)
class Claim:
    """A statement of a file, or an implied one, whether it is proven, and its numbers.

    Attributes
    ----------
    checked
        Whether it was checked with every rounding enclosed; if not, nothing of it is proven or refuted.
    recomputed
        Whether, not being checked so, it was computed again in doubles and agrees within the tolerance of stored
        numbers.

    Examples
    --------
    >>> print(Claim("end conditions", True, "greatest deviation 1e-16"))
    proven      end conditions: greatest deviation 1e-16
    """

    name: str
    proven: bool
    detail: str
    checked: bool = True
    recomputed: bool = False

    def __str__(self) -> str:
        unproven = "not proven" if self.checked else "recomputed" if self.recomputed else "not checked"
        word = "proven" if self.proven else unproven
        name = self.name if len(self.name) <= _LONGEST_NAME else f"{self.name[: _LONGEST_NAME - 4]} ..."
        return f"{word:<12}{name}: {self.detail}"


def recomputed(name: str, detail: str, wrong: str = "") -> Claim:
    """The claim of what doubles alone compute again; what is `wrong` with it, where they contradict it.

    >>> print(recomputed("the period", "0.6 s"))
    recomputed  the period: 0.6 s
    """
    return Claim(name, proven=False, detail=wrong or detail, checked=bool(wrong), recomputed=not wrong)


Data: TypeAlias = Mapping[str, Any]
#: the claims of a statement, by its name
Rule: TypeAlias = Callable[[Any, str], Iterable[Claim]]
#: what is proven of an object, by its keys; None of what says nothing of laws, or is proven with the rest
Proven: TypeAlias = "Rule | Mapping[str, Proven] | None"

#: of the greatest number of a row: what rounding leaves of one that is 0, and of the difference of two
_NOTHING, _BESIDE = 1e-13, 1e-16
#: letters of a claim's name that are shown: formulas of mechanisms may have thousands
_LONGEST_NAME = 160
_STATED_CONSTANT = 1e-11  # of a constant: what one that was computed in doubles may be off


@dataclass(frozen=True, kw_only=True)
class Verification:
    """The proven statements on a solution, or on a certificate alone, each rounded to the safe side.

    Attributes
    ----------
    problem
        Of which problem it speaks; None for a law alone.
    bound
        No law of the problem has a smaller objective: by the certificate, or beside a law also by the limit of C or D.
        None where nothing is proven.
    infeasible
        Whether it is proven that the problem has no law.
    objective, constants
        Floats below and above the law's objective, B, C, D, J and rms_c; None and empty without a law.
    gap
        (objective - bound) / objective, at most; the difference itself where the objective is 0 but for rounding, or
        negative. Below 0 by rounding where the law breaks a constraint by rounding.
    excesses
        By how much the law breaks each condition at most; 0 or less where it keeps it.
    charge
        What the bound lost to moments that had to be charged; mostly 0.
    claims
        Everything that was checked, and is proven or not.
    recomputed
        What was computed again in doubles, and agrees.
    unchecked
        What could not be checked.

    Examples
    --------
    >>> from optlaws import smoothstep, Certificate, Contact
    >>> from optlaws.verification import verify
    >>> problem = Problem(order=2)
    >>> verify(Certificate.of_leaf(problem, [Contact("C", 1.0, 0.0, 1.0)]).to_dict()).bound
    0.0
    """

    problem: Problem | None = None
    bound: float | None = None
    infeasible: bool = False
    objective: tuple[float, float] | None = None
    gap: float | None = None
    constants: dict[str, tuple[float, float]] = field(default_factory=dict)
    excesses: dict[str, float] = field(default_factory=dict)
    charge: float = 0.0
    claims: tuple[Claim, ...] = ()
    recomputed: tuple[Claim, ...] = ()
    unchecked: tuple[Claim, ...] = ()

    @property
    def proven(self) -> bool:
        """Whether every claim of the file is proven."""
        return all(claim.proven for claim in self.claims)

    def results(self) -> dict[str, Any]:
        """Plain JSON-able dict; None for infinite numbers."""
        return {
            "proven": self.proven,
            "bound": self.bound,
            "infeasible": self.infeasible,
            "objective": None if self.objective is None else _pair(self.objective),
            "gap": self.gap,
            "constants": {name: _pair(pair) for name, pair in self.constants.items()},
            "excesses": {name: bounded(by) for name, by in self.excesses.items()},
            "charge": self.charge,
            "claims": [{name: getattr(claim, name) for name in ("name", "proven", "detail")} for claim in self.claims],
            **{
                name: [{"name": claim.name, "detail": claim.detail} for claim in getattr(self, name)]
                for name in ("recomputed", "unchecked")
            },
            "problem": None if self.problem is None else self.problem.to_dict(),
        }

    def __str__(self) -> str:
        lines = [] if self.problem is None else [f"{self.problem!r}"]
        if self.infeasible:
            lines.append("no law of the problem exists")
        if self.objective is not None:
            lines.append(f"objective    in [{self.objective[0]!r}, {self.objective[1]!r}]")
        if self.bound is not None:
            lines.append(f"lower bound  {self.bound!r}")
        if self.gap is not None:
            lines.append(f"gap          at most {self.gap:.2e}")
        lines += [f"{name:<12} in [{low!r}, {high!r}]" for name, (low, high) in self.constants.items()]
        return "\n".join([*lines, *map(str, every_claim(self))])


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


def differences(stated: Any, known: Any, name: str, size: float = 0.0) -> Iterator[Claim]:
    """The claims of data that are not those that are known; null states nothing, and every key must be known.

    Numbers differ beyond rounding: their own, and that of the greatest number beside them, `size`.
    """
    if stated is None:
        return
    if isinstance(stated, Mapping) and isinstance(known, Mapping):
        size = greatest(known.values())
        for key, value in stated.items():
            if key not in known:
                raise InputError(f"{name}: {unknown_key(key, known, 'entry')}; leave out what is not checked")
            yield from differences(value, known[key], f"{name}.{key}" if name else key, size)
    elif isinstance(stated, list) and isinstance(known, list | tuple) and len(stated) == len(known):
        size = greatest(known)
        for i, (value, each) in enumerate(zip(stated, known, strict=True)):
            yield from differences(value, each, f"{name}[{i}]", size)
    elif not _agree(stated, known, size):
        yield Claim(name, proven=False, detail=f"{shortened(stated)} stated, {shortened(known)} computed again")


def greatest(values: Iterable[Any]) -> float:
    """The greatest magnitude of the numbers among values, 0 of none."""
    return max((abs(value) for value in values if is_number(value)), default=0.0)


def _agree(stated: Any, known: Any, size: float) -> bool:
    if is_number(stated) and is_number(known):
        greater = max(abs(stated), abs(known))
        return bool(greater <= _NOTHING * size or abs(stated - known) <= STORED_VALUE * greater + _BESIDE * size)
    return bool(stated == known) and type(stated) is type(known)


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


def every_claim(verification: Verification, place: str = "") -> list[Claim]:
    """All claims, whether checked or not; of a part their names begin with its place."""
    every = (*verification.claims, *verification.recomputed, *verification.unchecked)
    return [replace(claim, name=place + claim.name) for claim in every]


def with_claims(known: Verification, claims: Iterable[Claim]) -> Verification:
    """A verification with claims in place of its own: checked, recomputed in doubles, or neither."""
    every = tuple(claims)
    checked = tuple(claim for claim in every if claim.checked)
    again = tuple(claim for claim in every if claim.recomputed)
    left = tuple(claim for claim in every if not claim.checked and not claim.recomputed)
    return replace(known, claims=checked, recomputed=again, unchecked=left)


def _pair(pair: tuple[float, float]) -> list[float | None]:
    return [bounded(value) for value in pair]
