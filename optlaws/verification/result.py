"""Results of verifications, claim by claim."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any

from optlaws.numbers import bounded
from optlaws.synthesis.problem.problem import Problem


@dataclass(frozen=True)
class Claim:
    """A statement of a file, or an implied one, whether it is proven, and its numbers.

    Attributes
    ----------
    checked
        Whether it was checked with every rounding enclosed; if not, it was computed again in doubles and agrees, so
        that nothing of it is proven or refuted.

    Examples
    --------
    >>> print(Claim("end conditions", True, "off by at most 1e-16"))
    proven      end conditions: off by at most 1e-16
    """

    name: str
    proven: bool
    detail: str
    checked: bool = True

    def __str__(self) -> str:
        word = "proven" if self.proven else "not proven" if self.checked else "not checked"
        return f"{word:<12}{self.name}: {self.detail}"


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
    unchecked
        What was only computed again in doubles, and agrees.

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
            "unchecked": [{"name": claim.name, "detail": claim.detail} for claim in self.unchecked],
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
        return "\n".join([*lines, *map(str, (*self.claims, *self.unchecked))])


def every_claim(verification: Verification, place: str = "") -> list[Claim]:
    """All claims, whether checked or not; of a part their names begin with its place."""
    return [replace(claim, name=place + claim.name) for claim in (*verification.claims, *verification.unchecked)]


def with_claims(known: Verification, claims: Iterable[Claim]) -> Verification:
    """A verification with claims, those that are checked and those that are not, in place of its own."""
    every = tuple(claims)
    checked, unchecked = (tuple(claim for claim in every if claim.checked is kind) for kind in (True, False))
    return replace(known, claims=checked, unchecked=unchecked)


def _pair(pair: tuple[float, float]) -> list[float | None]:
    return [bounded(value) for value in pair]
