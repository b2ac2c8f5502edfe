"""Lower bounds that stand by themselves: contacts and multipliers, checked by weak duality with numpy alone.

Every law of the problem, with its own constants as variables, obeys the rows of the program. Added up with multipliers
m >= 0 (any sign for equations) to the objective they give an affine function of the coordinates of the law, and its
value is a lower bound of the objective wherever it is constant. The multipliers are such that it hardly varies; what
rounding leaves of its dependence is charged against the bound, for which the law's coordinates are bounded through
their Legendre moments: a law that contradicts the claim has a small objective, so small constants.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from math import fsum, inf, isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.numbers import bounded
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.family import LinearFamily, NormFamily, Program
from optlaws.synthesis.families.names import VariableName
from optlaws.synthesis.problem.constants import Peak, Power
from optlaws.synthesis.problem.expression import Expression, Maximum, Term, leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, least_violation, maxima, model_of, relaxed, relaxed_power
from optlaws.synthesis.proof.data import StatedCertificate, StatedContact, problem_of, stated
from optlaws.synthesis.proof.farkas import surplus
from optlaws.synthesis.spaces.space import LawSpace

Array = NDArray[np.float64]

OBJECTIVE, RELAXED, VIOLATION = "objective", "relaxed", "violation"
#: how far from a contact its neighbours are, and how much of its multiplier each takes
_NEAR, _SHARE = 2.0**-12, 2.0**-14
_ACCELERATION = 2
_FACING = {"C_plus": "C_minus", "C_minus": "C_plus"}
#: roundings in a row before it is weighted, and of the sum
_UNIT = 9 * 2.0**-53
_SPLIT = 2.0**27 + 1.0


@dataclass(frozen=True)
class Contact:
    """A constraint at one k: which family of rows, with which sign, and its multiplier (dimensionless).

    `direction` belongs to an RMS and to a complex amplitude: the unit vector by which its size is bounded from below.

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


def contact_of(found: StatedContact) -> Contact:
    """The contact that was stated.

    Raises
    ------
    InputError
        If its k, sign, multiplier or direction is none.
    """
    return Contact(found.constraint, found.sign, found.k, found.multiplier, found.direction)


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
        if not all(map(isfinite, (*self.equations, self.tangent))):
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
        found = stated(data, StatedCertificate, "certificate")
        contacts = tuple(contact_of(one) for one in found.contacts)
        return cls(problem_of(found.problem), contacts, found.equations, found.program, found.tangent)


def excess(certificate: Certificate) -> float:
    """Least value over all laws of the problem of the objective plus the contacts' residuals; a lower bound.

    Negative multipliers count as zero, and so do contacts that the problem does not ask for. Multipliers so large that
    their sum is beyond double precision prove nothing: the bound is then minus infinity.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        value = _excess(certificate)
    return value if isfinite(value) else -inf


def _excess(certificate: Certificate) -> float:
    found = _model(certificate)
    program = found.program
    lines = [(max(one.multiplier, 0.0), *row_of(program, one)) for one in certificate.contacts]
    equations = zip(certificate.equations, program.equalities, program.right.tolist(), strict=False)
    plain = float(found.unit * sum_of_rows(found, certificate, [*lines, *equations]))
    if certificate.program != VIOLATION or plain > 0.0:
        return plain
    return max(plain, _surplus(certificate, program))


def sum_of_rows(
    found: Model, certificate: Certificate, lines: list[tuple[float, Array, float]], claim: float | None = None
) -> float:
    """What the program's objective cannot be below by weighted rows, in laws of an objective up to the claim.

    Without a claim it is what the sum itself says.
    """
    total = _summed(found, [one for one in lines if one[0] != 0.0])
    return total.value - _charge(found, certificate, total, found.unit * total.value if claim is None else claim)


def moments_below(found: Model, certificate: Certificate, claim: float) -> list[tuple[Array, Array]]:
    """Bounds of the moments of a derivative in laws below the claim, but for the base law, for each derivative known.

    Beside each the matrix from a functional's values on the free functions to weights of these moments.
    """
    greatest = _greatest(certificate, found, claim)
    return [
        (mean + _base_moments(found.space, nu), _extension(found.space, nu))
        for nu, mean in _means(certificate, found.space, greatest)
    ]


@dataclass(frozen=True, eq=False)
class _Sum:
    """The sum of weighted rows: its slope, exact in the variables beyond the coordinates, and what rounding hides.

    `value` is rounded down, the slope by each coordinate is off by its `blur` at most.
    """

    slope: Array
    value: float
    blur: Array


def _summed(found: Model, lines: list[tuple[float, Array, float]]) -> _Sum:
    weights = np.array([one[0] for one in lines])
    rows = np.array([[*row, -right] for _, row, right in lines]).reshape(-1, found.program.size + 1)
    total = _weighted(weights, rows, np.append(found.program.objective, 0.0))
    hidden = _UNIT * (np.abs(weights) @ np.abs(rows))
    slope = total[:-1]
    variables = list(found.places.values())
    # the entries of the variables are exact, and so is a sum that is zero
    slope[variables] = np.where(slope[variables] == 0.0, 0.0, np.nextafter(slope[variables], -inf))
    return _Sum(slope, float(total[-1] - hidden[-1]), hidden[: found.space.terms])


def _weighted(weights: Array, rows: Array, start: Array) -> Array:
    """Start + weights . rows, rounded once: the great multipliers of laws at the edge of what exists cancel."""
    products = weights[:, None] * rows
    high, low = _halves(weights[:, None])
    upper, lower = _halves(rows)
    rest = low * lower - (((products - high * upper) - low * upper) - high * lower)
    columns = np.vstack([start[None, :], products, rest])
    # fsum refuses what overflows
    return np.array([fsum(one) for one in columns.T.tolist()]) if np.isfinite(columns).all() else start * np.nan


def _halves(values: Array) -> tuple[Array, Array]:
    """Each value as a sum of two whose products are exact (Dekker 1971)."""
    scaled = _SPLIT * values
    high = scaled - (scaled - values)
    return high, values - high


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
        np.array([*multipliers, *equations]),
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


def row_of(program: Program, contact: Contact) -> tuple[Array, float]:
    """The row of a contact and its right side: row . x <= right for every law of the problem."""
    for family in program.families:
        if family.name != contact.constraint or contact.sign not in family.signs:
            continue
        u = np.clip(family.u(np.array([contact.k])), *family.domain)
        if isinstance(family, LinearFamily):
            rows, right = family.rows(u, np.array([contact.sign]))
            return rows[0], float(right[0])
        if isinstance(family, NormFamily) and len(contact.direction) == len(family.matrix):
            direction = np.array(contact.direction)
            # a shorter direction bounds the norm too
            row = (direction / max(float(np.linalg.norm(direction)), 1.0)) @ family.matrix
            return row[:-1] - family.slack, family.bound - float(row[-1])
        if isinstance(family, ConeFamily) and len(contact.direction) == 2:
            direction = np.array(contact.direction)
            row = family.tangent(float(u[0]), direction / max(float(np.linalg.norm(direction)), 1.0))
            return row[:-1] - family.slack, family.bound - float(row[-1])
    return np.zeros(program.size), 0.0


def _charge(found: Model, certificate: Certificate, total: _Sum, claim: float) -> float:
    """Most that rounding in the slope can be worth, over all laws that contradict the claim."""
    terms, slope = found.space.terms, total.slope
    greatest = _greatest(certificate, found, max(claim, 0.0))
    least = least_values(certificate.problem, found.space)
    beyond = 0.0
    for name, place in found.places.items():
        # a positive slope can only help where the constant is at least 0
        if slope[place] < 0.0:
            beyond += -slope[place] * greatest.get(name, inf)
        elif slope[place] > 0.0:
            # of the two one-sided peaks one is at least the other's opposite
            facing = greatest.get(_FACING.get(name, ""), inf)
            beyond += slope[place] * max(min(-least.get(name, 0.0), facing), 0.0)
    return beyond + min(
        (
            float(
                _reach(_extension(found.space, nu), slope[:terms], total.blur) @ (mean + _base_moments(found.space, nu))
            )
            for nu, mean in _means(certificate, found.space, greatest)
        ),
        default=0.0 if not slope[:terms].any() and not total.blur.any() else inf,
    )


def _reach(extension: Array, slope: Array, blur: Array) -> Array:
    """The greatest magnitudes of the slope's weights of moments, wherever it is within its blur."""
    return np.asarray(np.abs(extension @ slope) + np.abs(extension) @ blur)


def _greatest(certificate: Certificate, found: Model, claim: float) -> dict[str, float]:
    """Greatest values of the program's variables in a law that contradicts the claim."""
    bounds: dict[str, float] = {}
    if certificate.program == VIOLATION:
        bounds[VariableName.VIOLATION] = 0.0
    else:
        spread(certificate.problem.objective, claim, bounds, least_values(certificate.problem, found.space))
    problem = certificate.problem
    for name in ("B", *(one.name for one, _ in problem.bounded)):
        asked = problem.range(name)
        if asked is not None:
            bounds[name] = min(bounds.get(name, inf), asked.high)
    power = relaxed_power(problem)
    if power is not None and power.name in bounds:
        bounds[VariableName.POWER_ROOT] = bounds[power.name] ** 0.5
    if "B" in found.places and not isfinite(bounds["B"]):
        # b is nowhere further from its mean, the stroke, than the integral of |c|
        curved = min(bounds.get(name, inf) for name in ("C", "rms_c"))
        bounds["B"] = abs(found.space.stroke) + min(curved, *_from_one_sign(problem, found.space, bounds))
    return bounds


def _from_one_sign(problem: Problem, space: LawSpace, greatest: dict[str, float]) -> tuple[float, float]:
    """Bounds of the integral of |c| from the peaks of one sign: what is above 0 less what is below is b(1) - b(0)."""
    if problem.conditions.order == 1:
        return (max(greatest.get("C_plus", inf), greatest.get("C_minus", inf)),) * 2
    drop = abs(space.velocity_change)
    return 2.0 * greatest.get("C_plus", inf) + drop, 2.0 * greatest.get("C_minus", inf) + drop


def spread(expression: Expression, claim: float, bounds: dict[str, float], least: Mapping[str, float]) -> None:
    """Note in `bounds` what the constants of an expression are at most, where its value is below the claim."""
    for weight, term in expression.terms:
        name = repr(term)
        others = sum(one * least[repr(other)] for one, other in expression.terms if other is not term)
        most = (claim - others) / weight
        bounds[name] = min(bounds.get(name, inf), most)
        if isinstance(term, Maximum):
            for part in term.parts:
                spread(part, most, bounds, least)


def least_values(problem: Problem, space: LawSpace) -> dict[str, float]:
    """What the constants and maxima of the objective are at least: 0, but for peaks of one sign.

    The mean of c is the change of the velocity, which c exceeds somewhere, and is below somewhere; where the order
    leaves it free, what is positive at a change of either sign is at least 0.
    """
    terms = [*(leaf for _, leaf in leaves(problem.objective)), *maxima(problem.objective)]
    if problem.symmetric or problem.order > 1:
        change = 0.0 if problem.symmetric else space.velocity_change
        return {repr(term): _at_least(term, change) for term in terms}
    lows = {repr(term): min(_at_least(term, 1.0), _at_least(term, -1.0)) for term in terms}
    return {name: 0.0 if low >= 0.0 else -inf for name, low in lows.items()}


def _at_least(term: Term, change: float) -> float:
    """What a term is at least where the velocity changes by `change`."""
    if isinstance(term, Maximum):
        return max(sum(weight * _at_least(one, change) for weight, one in part.terms) for part in term.parts)
    if not isinstance(term, Peak) or len(term.signs) != 1:
        return 0.0
    return term.signs[0] * change if term.nu == _ACCELERATION else -inf


def _means(certificate: Certificate, space: LawSpace, greatest: dict[str, float]) -> list[tuple[int, float]]:
    """Orders of derivatives whose mean magnitude is bounded, with the bound."""
    means = [(2, greatest.get("C", inf)), (2, greatest.get("rms_c", inf)), (3, greatest.get("J", inf))]
    means += [(2, mean) for mean in _from_one_sign(certificate.problem, space, greatest)]
    means += [(3, greatest.get("rms_j", inf)), (4, greatest.get("jounce", inf))]
    stroke = abs(space.stroke)
    if "D" in greatest and certificate.problem.order > 1 and space.start_velocity == 0.0:
        # b² <= 2 D k from rest
        means += [(1, greatest["D"] ** 0.5)]
    means += [(1, 2.0 * greatest.get("B", inf) + stroke)]
    if certificate.problem.monotone:
        means += [(1, stroke)]
    for one in certificate.problem.constants:
        size = greatest.get(one.name, inf)
        means += [(nu, factor * (size**0.5 if isinstance(one, Power) else size)) for nu, factor in one.curbs()]
    least: dict[int, float] = {}
    for nu, mean in means:
        if isfinite(mean):
            least[nu] = min(least.get(nu, inf), mean)
    return list(least.items())


def _base_moments(space: LawSpace, nu: int) -> Array:
    """Magnitudes of the base law's moments: coordinates say by how much the moments of a law differ from them."""

    def computed() -> Array:
        rule = space.quadrature(nu)
        return np.asarray(np.abs(rule.moments.T @ (rule.weights * rule.values[:, -1])), dtype=np.float64)

    return space.cached(("moments", nu), computed)


def _extension(space: LawSpace, nu: int) -> Array:
    """Matrix from a functional's values on the free functions to weights of moments of the derivative of order nu.

    A moment is the integral of the derivative times a function that is nowhere above 1 in magnitude, so at most its
    mean magnitude; for polynomials these are Legendre's.
    """

    def computed() -> Array:
        rule = space.quadrature(nu)
        moments = rule.moments.T @ (rule.weights[:, None] * rule.values[:, :-1])
        return np.asarray(np.linalg.pinv(moments.T), dtype=np.float64)

    return space.cached(("extension", nu), computed)
