"""Lower bounds that stand by themselves: contacts and multipliers, checked by weak duality with numpy alone.

Every law of the problem, with its own constants as variables, obeys the rows of the program. Added up with multipliers
m >= 0 (any sign for equations) to the objective they give an affine function of the coordinates of the law, and its
value is a lower bound of the objective wherever it is constant. The multipliers are such that it hardly varies; what
rounding leaves of its dependence is charged against the bound, for which the law's coordinates are bounded through
their Legendre moments: a law that contradicts the claim has a small objective, so small constants.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from math import inf, isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.numbers import bounded
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.curved import OfFormula
from optlaws.synthesis.families.energy import EnergyFamily
from optlaws.synthesis.families.family import LinearFamily, NormFamily, Program
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, least_violation, model_of, relaxed
from optlaws.synthesis.proof.data import StatedCertificate, StatedContact, problem_of, stated
from optlaws.synthesis.proof.duality import sum_of_rows
from optlaws.synthesis.proof.farkas import surplus

Array = NDArray[np.float64]

OBJECTIVE, RELAXED, VIOLATION = "objective", "relaxed", "violation"
#: how far from a contact its neighbours are, and how much of its multiplier each takes
_NEAR, _SHARE = 2.0**-12, 2.0**-14


@dataclass(frozen=True)
class Contact:
    """A constraint at one k: which family of rows, with which sign, and its multiplier (dimensionless).

    `direction` belongs to an RMS and to a complex amplitude: the unit vector by which its size is bounded from below;
    to the peak velocity of a loader: the coordinates of the law whose tangent bounds it.

    Examples
    --------
    >>> Contact("C", 1.0, 0.25, 0.5).multiplier
    0.5
    """

    constraint: str
    sign: float
    k: float
    multiplier: float
    direction: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        finite = all(map(isfinite, (self.multiplier, *self.direction)))
        if not 0.0 <= self.k <= 1.0 or not finite or abs(self.sign) != 1.0:
            raise InputError(
                f"a contact needs k in [0, 1], a sign 1 or -1, a finite multiplier and direction, got {shortened(self)}"
            )


def contact_of(entries: StatedContact) -> Contact:
    """The contact that was stated.

    Raises
    ------
    InputError
        If its k, sign, multiplier or direction is none.
    """
    return Contact(entries.constraint, entries.sign, entries.k, entries.multiplier, entries.direction)


@dataclass(frozen=True)
class Certificate:
    """Contacts and multipliers that prove a lower bound of a problem's objective, or that it has no law.

    Attributes
    ----------
    problem
        Of which problem it speaks: of every law of it, symmetric or not if that is not asked.
    contacts, equations
        Multipliers of the rows that bind, and of the program's equations.
    program
        "objective", or "relaxed" for a problem that is not convex: the bound is then that of a convex program
        that every law of the problem obeys too; or "violation" for a proof that no law exists.
    tangent
        Where the relaxed program replaces D by its tangent.

    Examples
    --------
    >>> import optlaws
    >>> solution = optlaws.synthesize(optlaws.Problem(B=1.859, order=4, basis=optlaws.Chebyshev(9)))
    >>> bool(solution.certificate.bound <= solution.constants.C.value)
    True
    """

    problem: Problem
    contacts: tuple[Contact, ...]
    equations: tuple[float, ...]
    program: str = OBJECTIVE
    tangent: float = 0.0

    def __post_init__(self) -> None:
        if self.program not in {OBJECTIVE, RELAXED, VIOLATION}:
            raise InputError(
                f"program of a certificate must be objective, relaxed or violation, got {shortened(self.program)}"
            )
        # rows have the square of the tangent
        if not all(map(isfinite, (*self.equations, self.tangent * self.tangent))):
            raise InputError("the equations' multipliers and the tangent of a certificate must be finite numbers")

    @kept_property
    def bound(self) -> float:
        """The proven lower bound of the objective, recomputed from the contacts by numpy; -inf for a mere violation."""
        return excess(self) if self.program != VIOLATION else -inf

    @kept_property
    def proves_infeasible(self) -> bool:
        """Whether the contacts contradict each other (Farkas): every law breaks one by more than 0."""
        return self.program == VIOLATION and excess(self) > 0.0

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict with the recomputed bound (None where there is none)."""
        return {
            "problem": self.problem.to_dict(),
            "program": self.program,
            "tangent": self.tangent,
            "contacts": [asdict(contact) for contact in self.contacts],
            "equations": list(self.equations),
            "bound": bounded(self.bound),
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Certificate:
        """Read what `to_dict` wrote; the bound is recomputed, not read.

        Raises
        ------
        InputError
            If an entry is missing or wrong.
        """
        entries = stated(data, StatedCertificate, "certificate")
        contacts = tuple(map(contact_of, entries.contacts))
        return cls(problem_of(entries.problem), contacts, entries.equations, entries.program, entries.tangent)


def excess(certificate: Certificate) -> float:
    """Least value over all laws of the problem of the objective plus the contacts' residuals; a lower bound.

    Negative multipliers count as zero, and so do contacts that the problem does not ask for. Multipliers so large that
    their sum is beyond double precision prove nothing: the bound is then minus infinity.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        value = _excess(certificate)
    return value if isfinite(value) else -inf


def _excess(certificate: Certificate) -> float:
    model, lines = weighted_rows(certificate)
    plain = float(model.unit * sum_of_rows(model, lines))
    if certificate.program != VIOLATION or plain > 0.0:
        return plain
    return max(plain, _surplus(certificate, model.program))


def weighted_rows(certificate: Certificate) -> tuple[Model, list[tuple[float, Array, float]]]:
    """The program of a certificate, and its rows as `lines_of` gives them."""
    model = _model(certificate)
    return model, lines_of(model.program, certificate.contacts, certificate.equations)


def lines_of(
    program: Program, contacts: Sequence[Contact], equations: Sequence[float]
) -> list[tuple[float, Array, float]]:
    """Contacts and the program's equations as weights, rows and right sides; negative multipliers of contacts are 0."""
    lines = [(max(contact.multiplier, 0.0), *row_of(program, contact)) for contact in contacts]
    own = program.multipliers_of_equations(equations).tolist()
    return [*lines, *zip(own, program.equalities, program.right.tolist(), strict=False)]


def _surplus(certificate: Certificate, program: Program) -> float:
    """The same for a contradiction, with the multipliers corrected where nothing bounds the law."""
    rows, right, multipliers = [], [], []
    for contact in certificate.contacts:
        for k, share in _neighbourhood(contact):
            row, most = row_of(program, replace(contact, k=k))
            if contact.multiplier > 0.0 and row.any():
                rows.append(row)
                right.append(most)
                multipliers.append(share * contact.multiplier)
    count = len(rows)
    equations = list(certificate.equations)[: len(program.right)]
    together = np.vstack([np.empty((0, program.size)), *rows, program.equalities[: len(equations)]])
    # every row has t to spare, and a law keeps to it with t = 0
    free = program.objective == 0.0
    return surplus(
        together[:, free],
        np.array([*right, *program.right[: len(equations)]]),
        np.array([*multipliers, *program.multipliers_of_equations(equations)]),
        count,
    )


def _neighbourhood(contact: Contact) -> list[tuple[float, float]]:
    """A contact's place, and two beside it that take a little of its multiplier: where it is need not be exact."""
    k = contact.k
    if contact.direction or not _NEAR < k < 1.0 - _NEAR:
        return [(k, 1.0)]
    return [(k, 1.0 - 2.0 * _SHARE), (k - _NEAR, _SHARE), (k + _NEAR, _SHARE)]


def _model(certificate: Certificate) -> Model:
    if certificate.program == RELAXED:
        return relaxed(certificate.problem, certificate.tangent)
    if certificate.program == VIOLATION:
        return least_violation(certificate.problem)
    return model_of(certificate.problem)


def _at_most_one(direction: Sequence[float]) -> Array:
    """A direction whose length is at most 1, which bounds a norm too where it is shorter; one that overflows is 0."""
    given = np.array(direction)
    with np.errstate(over="ignore"):
        return np.asarray(given / max(float(np.linalg.norm(given)), 1.0))


def row_of(program: Program, contact: Contact) -> tuple[Array, float]:
    """The row of a contact and its right side: row . x <= right for every law of the problem.

    It is the problem's own row, in the program's variables and in units of its objective.
    """
    for family in program.families:
        if family.name != contact.constraint or contact.sign not in family.signs:
            continue
        share = family.unit / program.unit
        u = np.clip(family.u(np.array([contact.k])), *family.domain)
        if isinstance(family, LinearFamily):
            rows, right = family.rows(u, np.array([contact.sign]))
            return rows[0] * share, float(right[0]) * share
        if isinstance(family, NormFamily) and len(contact.direction) == len(family.matrix):
            row = _at_most_one(contact.direction) @ family.matrix
            return share * (row[:-1] - family.slack), share * (family.bound - float(row[-1]))
        if isinstance(family, ConeFamily) and len(contact.direction) == 2:
            row = family.tangent(float(u[0]), _at_most_one(contact.direction))
            return share * (row[:-1] - family.slack), share * (family.bound - float(row[-1]))
        if isinstance(family, OfFormula):
            tangent = family.tangent_row(float(u[0]), contact.sign, contact.direction)
            if tangent is not None:
                return share * (tangent[:-1] - family.slack), share * (family.bound - float(tangent[-1]))
        if isinstance(family, EnergyFamily) and family.convex and len(contact.direction) <= program.size:
            row = family.minorant(_on_equations(program, np.array(contact.direction)))
            return share * (row[:-1] - family.slack), share * (family.bound - float(row[-1]))
    return np.zeros(program.size), 0.0


def _on_equations(program: Program, coordinates: Array) -> Array:
    """Variables with these coordinates, or the nearest that keep the program's equations."""
    x = np.zeros(program.size)
    x[: len(coordinates)] = coordinates
    for _ in range(2):
        off = program.right - program.equalities @ x
        x += np.linalg.lstsq(program.equalities, off, rcond=None)[0]
    return x
