"""Certificates from an optimum's multipliers, with the best bound that can be proven.

At a law in which a formula with kinks vanishes along a stretch, or an RMS or an amplitude vanishes, or nearly does, the
slope jumps: one tangent leaves a slope that rounding, or a kink, hides. Tangents on all sides of the law, weighted by a
linear program, have the slope that the optimum requires, exactly.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import nextafter

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.curved import FormulaFamily
from optlaws.synthesis.families.energy import EnergyFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, NormFamily, Points
from optlaws.synthesis.families.names import RowName, VariableName, velocity_at_peak
from optlaws.synthesis.method.discretised.grids import first_points, with_extrema
from optlaws.synthesis.method.exchange import solve
from optlaws.synthesis.method.newton import newton
from optlaws.synthesis.problem.constants import D
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, relaxed, relaxed_power
from optlaws.synthesis.proof.certificate import OBJECTIVE, RELAXED, VIOLATION, Certificate, weighted_rows
from optlaws.synthesis.proof.duality import row_of, summed, tangent_row
from optlaws.synthesis.proof.nodes import Contact
from optlaws.synthesis.proof.sublevel_bounds import Sublevel, means_by
from optlaws.synthesis.spaces.bases import PolynomialBasis
from optlaws.tolerances import OPTIMALITY_GAP

_CUTS_ENOUGH = 2e-9  # of an objective: what cuts may leave
_LEFT_SHARES = (1e-12, 1e-11, 1e-10, 1e-9)  # of a constant's weight: what a proof leaves of it to pay for rounding
_APEX = 1e-11  # of the sum of magnitudes: a norm that is less is 0 but for rounding
_PROOF_WEIGHTLESS = 1e-14  # of the greatest multiplier of a proof: what is less is left out
_PROOF_ENOUGH = 5e-9  # of an objective: a bound that leaves no more needs no other proof

_TANGENTS = 4
_PLACES = 256
_NEAR = 0.9
_MORE = 2.0  # times as much as rounding lets go


def certify(model: Model, optimum: ActiveSet, objective: float, limit: float | None) -> Certificate:
    """The certificate of an optimum; of the relaxed program, solved here, where the problem is not convex.

    The tangent begins at the root that the best law itself needs and is moved to where the relaxed optimum requires
    it, as long as that may pay: not below the limit.
    """
    problem = model.problem
    if problem.convex:
        return _of_convex(model, optimum, objective)
    if relaxed_power(problem) is None:
        loose = relaxed(problem, 0.0)
        state = solve(loose.program).optimum
        return Certificate.of_leaf(problem, program=RELAXED) if state is None else certificate(loose, state, RELAXED)
    tangent = _needed_root(model, optimum) or float(np.sqrt(objective))
    best: Certificate | None = None
    warm: ActiveSet | None = None
    plain = _by_the_peak(problem)
    if plain is not None and limit is not None and problem.objective.terms[0][0] * tangent**2 < limit:
        # the best law obeys the relaxed program with that square for D: its bound cannot reach the limit
        return plain
    for _ in range(_TANGENTS):
        loose = relaxed(problem, tangent)
        outcome = solve(loose.program, warm)
        warm = outcome.optimum
        if warm is None:
            break
        proof = certificate(loose, warm, RELAXED, tangent)
        if best is None or proof.bound > best.bound:
            best = proof
        if limit is not None and best.bound < _NEAR * limit:
            break
        moved = float(warm.x[loose.places[VariableName.POWER_ROOT]])
        if abs(moved - tangent) < 1e-6 * tangent:
            break
        tangent = moved
    return best if best is not None else Certificate.of_leaf(problem, program=RELAXED, tangent=tangent)


def _of_convex(model: Model, optimum: ActiveSet, objective: float) -> Certificate:
    if abs(objective) <= OPTIMALITY_GAP * model.problem.objective.scale:
        # constants that are nowhere below 0 say so without a sum, of which rounding would be all that is left
        plain = Certificate.of_leaf(model.problem)
        if abs(plain.bound) <= OPTIMALITY_GAP * model.problem.objective.scale:
            return plain
    proof = certificate(model, optimum, OBJECTIVE)
    if objective - proof.bound <= _PROOF_ENOUGH * max(abs(objective), _PROOF_ENOUGH):
        return proof
    # constants that are nowhere below 0 bound their sum without a contact
    proof = max(proof, Certificate.of_leaf(model.problem), key=lambda known: known.bound)
    if proof.bound == -np.inf:
        proof = max((proof, *_leaving(model, optimum)), key=lambda known: known.bound)
    if all(isinstance(family, LinearFamily) for family in model.program.families):
        return proof
    several = _Tangents(model, optimum).certificate(objective)
    return several if several is not None and several.bound > proof.bound else proof


def _leaving(model: Model, optimum: ActiveSet) -> Iterator[Certificate]:
    """Certificates of optima that leave a little of a constant's weight, with which rounding is paid."""
    program = model.program
    least = Sublevel.of(model).least_values()
    pulled = np.zeros(program.size)
    for i, multiplier in zip(optimum.family, optimum.multipliers, strict=True):
        pulled += multiplier * program.families[i].slack
    for name, place in model.places.items():
        if pulled[place] > 0.0 and least.get(name, -np.inf) >= 0.0 and means_by(model, name):
            for share in _LEFT_SHARES:
                cost = program.objective.copy()
                cost[place] -= share * pulled[place]
                state = newton(replace(program, objective=cost), optimum)
                if state is not None and (state.multipliers >= 0.0).all():
                    yield certificate(model, state, OBJECTIVE)


def _by_the_peak(problem: Problem) -> Certificate | None:
    """D >= B², without a solver: B = b(1/2) <= r, and D >= r² >= 2 t r - t² with t = B."""
    (weight, term), *others = problem.objective.terms
    plain = problem.symmetric and problem.boundary is None and isinstance(problem.basis, PolynomialBasis)
    if others or term != D or not plain or problem.order == 1 or not isinstance(problem.B, float):
        return None
    loose = relaxed(problem, problem.B)
    pull = 2.0 * weight * problem.B
    contacts = (Contact(RowName.TANGENT, 1.0, 0.0, weight), Contact(RowName.FROM_START, 1.0, 0.5, pull))
    equations = [0.0] * len(loose.program.right)
    equations[loose.equation_names.index(velocity_at_peak(0.5))] = -pull
    return Certificate.of_leaf(problem, contacts, equations, RELAXED, problem.B)


def _needed_root(model: Model, optimum: ActiveSet) -> float:
    """The least r with |b| <= r sqrt(2k) and r sqrt(2(1-k)) everywhere, nearly."""
    k = np.arange(1, _PLACES) / _PLACES
    if model.space.symmetric:
        # the rest is its mirror image, and not every space has it
        k = k[k <= 0.5]
    family = model.space.derivative(1, RowName.VELOCITY, np.zeros(model.program.size))
    velocity = family.value(optimum.x, family.u(k))
    return float((np.abs(velocity) / np.sqrt(2.0 * np.minimum(k, 1.0 - k))).max())


def certificate(model: Model, optimum: ActiveSet, program: str, tangent: float = 0.0) -> Certificate:
    """Contacts and multipliers of an optimum in terms of k."""
    contacts = []
    for i, family in enumerate(model.program.families):
        places = np.flatnonzero(optimum.family == i)
        for j in places.tolist():
            multiplier = float(optimum.multipliers[j]) * (model.unit / family.unit)
            contact = _touching(model, family, optimum.x, float(optimum.u[j]))
            contacts.append(replace(contact, sign=float(optimum.s[j]), multiplier=multiplier))
    equations = model.program.stated_multipliers(optimum.equality_multipliers).tolist()
    return _with_falling_peaks(model, Certificate.of_leaf(model.problem, contacts, equations, program, tangent))


def _touching(model: Model, family: ConstraintFamily, x: Array, u: float) -> Contact:
    """A contact whose tangent, where the family is curved, touches it at a law."""
    direction: tuple[float, ...] = ()
    if isinstance(family, NormFamily):
        direction = _direction(family, np.append(x, 1.0))
    elif isinstance(family, ConeFamily):
        direction = family.direction(x, u)
    elif isinstance(family, FormulaFamily):
        direction = family.touching(x, u)
    elif isinstance(family, EnergyFamily):
        direction = tuple(model.coordinates(x).tolist())
    k = float(min(max(family.k(np.array([u]))[0], 0.0), 1.0))
    return Contact(family.name, 1.0, k, 1.0, direction)


def _direction(family: NormFamily, x: Array) -> tuple[float, ...]:
    """The unit vector along a norm's image; 0 where rounding alone is left of that, and every direction is as good."""
    image = family.matrix @ x
    length = float(np.linalg.norm(image))
    known = length > _APEX * float(np.linalg.norm(np.abs(family.matrix) @ np.abs(x)))
    return tuple((image / length if known else np.zeros_like(image)).tolist())


def _with_falling_peaks(model: Model, proof: Certificate) -> Certificate:
    """The certificate with multipliers that hold what may fall for ever: a peak of one side, which rounding lets go.

    Beside such a peak other constants may be as great as they like, and are not pulled by more than they cost.
    """
    least = Sublevel.of(model).least_values()
    falling = [name for name in model.places if least.get(name) == -np.inf]
    if not falling or proof.program == VIOLATION:
        return proof
    slope = summed(model, weighted_rows(proof)[1]).slope
    contacts = list(proof.contacts)
    rows = [row_of(model.program, contact)[0] for contact in contacts]
    for name, place in model.places.items():
        # its rows may be several, with names of their own
        rows_of_name = [i for i, contact in enumerate(contacts) if contact.multiplier > 0.0 and rows[i][place] < 0.0]
        if rows_of_name and (slope[place] > 0.0 if name in falling else slope[place] < 0.0):
            most = max(rows_of_name, key=lambda i: contacts[i].multiplier)
            pull = -float(rows[most][place])
            greater = contacts[most].multiplier + _MORE * float(slope[place]) / pull
            contacts[most] = replace(contacts[most], multiplier=nextafter(greater, np.copysign(np.inf, slope[place])))
    bounding = proof.with_leaf(contacts=contacts)
    if max(bounding.bound, proof.bound) == -np.inf:
        bounding = _balanced_exactly(model, proof, [model.places[name] for name in falling])
    return bounding if bounding.bound > proof.bound else proof


def _balanced_exactly(model: Model, proof: Certificate, places: list[int]) -> Certificate:
    """The certificate with multipliers that hold variables to the last bit, as far as there are such."""
    rows = [row_of(model.program, contact)[0] for contact in proof.contacts]
    for place in places:
        paying = [i for i, contact in enumerate(proof.contacts) if contact.multiplier > 0.0 and rows[i][place] < 0.0]
        if summed(model, weighted_rows(proof)[1]).slope[place] != 0.0:
            proof = _exactly(model, proof, place, paying) or proof
    return proof


def _exactly(model: Model, proof: Certificate, place: int, paying: list[int]) -> Certificate | None:
    """The certificate with one contact's multipliers adjusted to balance a variable to the last bit.

    The lightest is tried first, whose last bit is finest; None where none does.
    """
    for i in sorted(paying, key=lambda i: proof.contacts[i].multiplier):
        contacts = list(proof.contacts)
        # the sum itself, which is stated a bit below what it is
        slope = nextafter(float(summed(model, weighted_rows(proof)[1]).slope[place]), np.inf)
        pull = -float(row_of(model.program, contacts[i])[0][place])
        contacts[i] = replace(contacts[i], multiplier=contacts[i].multiplier + slope / pull)
        balanced = proof.with_leaf(contacts=contacts)
        if contacts[i].multiplier > 0.0 and summed(model, weighted_rows(balanced)[1]).slope[place] == 0.0:
            return balanced
    return None


def violation_certificate(model: Model, optimum: ActiveSet) -> Certificate:
    """The certificate that no law exists, without multipliers that are mere rounding."""
    sizes = (optimum.multipliers, optimum.equality_multipliers)
    least = _PROOF_WEIGHTLESS * max((float(np.abs(size).max(initial=0.0)) for size in sizes), default=0.0)
    sizeable = [np.where(np.abs(size) < least, 0.0, size) for size in sizes]
    plain = replace(optimum, multipliers=sizeable[0], equality_multipliers=sizeable[1])
    return certificate(model, plain, VIOLATION)


def lower_bound(proof: Certificate, limit: float | None) -> float:
    """The better of the certificate's bound and the limit."""
    return max(proof.bound, -np.inf if limit is None else limit) + 0.0


_ROUNDS = 24
#: how far beside the law tangents touch at first, in times the greatest variable, and shares of the way to a vertex
_BESIDE = (1e-2, 1e-5, 1e-8)
_SHARES = (1.0, 0.3, 1e-2, 1e-4, 1e-7)
#: how far a vertex may be from the law, in the same
_AROUND = 10.0
_MOST_TANGENTS = 600


class _Tangents:
    def __init__(self, model: Model, optimum: ActiveSet) -> None:
        self.model, self.x = model, optimum.x
        program = model.program
        several = with_extrema(program, first_points(program), optimum.x)
        self.straight: list[LinearFamily] = []
        self.points: list[Points] = []
        #: curved families, each with the points at which tangents touch it
        self.curved: list[tuple[ConstraintFamily, Points]] = []
        for i, (family, points) in enumerate(zip(program.families, several, strict=True)):
            here = Points(optimum.u[optimum.family == i], optimum.s[optimum.family == i])
            if isinstance(family, LinearFamily):
                self.straight.append(family)
                self.points.append(points.joined(here))
            else:
                # what has no contact may be bound once the others are balanced
                inner = here if len(here.u) else Points(np.array(family.domain[1:]), np.ones(1))
                self.curved.append((family, inner))
        self.size = max(1.0, float(np.abs(optimum.x).max()))
        self.rows: list[tuple[LinearFamily, Contact]] = []

    def _touch(self, x: Array) -> None:
        for family, points in self.curved:
            for u, s in zip(points.u.tolist(), points.s.tolist(), strict=True):
                contact = replace(_touching(self.model, family, x, u), sign=s)
                row = tangent_row(self.model.program, family, contact, np.array([u]))
                if row is not None and np.isfinite(row).all():
                    straight = LinearFamily(
                        family.name, family.slack, family.bound, (1.0,), (1.0, 1.0), unit=family.unit, series=row[None]
                    )
                    self.rows.append((straight, contact))

    def certificate(self, objective: float) -> Certificate | None:
        """The best certificate of vertices, each of which shows where the next tangents touch; None where none is."""
        from optlaws.synthesis.method.discretised.linear import LinearTable, vertex_on_points

        self._touch(self.x)
        for way in np.eye(self.model.space.terms, self.model.program.size):
            for reach in _BESIDE:
                for sign in (1.0, -1.0):
                    self._touch(self.x + sign * reach * self.size * way)
        best: Certificate | None = None
        for _ in range(_ROUNDS):
            families, points = self._families()
            program = replace(self.model.program, families=families)
            vertex = vertex_on_points(program, points)
            if vertex is None:
                return best
            *weights, equations = LinearTable(program, points).sharp(vertex, points).multipliers
            proof = _with_falling_peaks(self.model, self._stated(weights, equations))
            best = proof if best is None or proof.bound > best.bound else best
            if (
                best.bound >= objective - _CUTS_ENOUGH * max(abs(objective), _CUTS_ENOUGH)
                or len(self.rows) > _MOST_TANGENTS
            ):
                return best
            for share in _SHARES:
                self._touch(self.x + share * (vertex.x - self.x))
            straight = replace(self.model.program, families=tuple(self.straight))
            self.points = with_extrema(straight, self.points, vertex.x)
        return best

    def _families(self) -> tuple[tuple[ConstraintFamily, ...], list[Points]]:
        """The straight families, a row for each tangent, and a box that is none of the certificate's."""
        size, bound = self.model.program.size, _AROUND * self.size
        families = [*self.straight, *(straight for straight, _ in self.rows)]
        for way in np.eye(size):
            for sign in (1.0, -1.0):
                row = np.append(sign * way, -sign * float(way @ self.x))[None]
                families.append(LinearFamily("box", np.zeros(size), bound, (1.0,), (1.0, 1.0), series=row))
        once = Points(np.ones(1), np.ones(1))
        return tuple(families), [*self.points, *[once] * (len(families) - len(self.straight))]

    def _stated(self, weights: list[Array], equations: Array) -> Certificate:
        of_families: list[list[tuple[LinearFamily, Contact]]] = []
        for family, points in zip(self.straight, self.points, strict=True):
            places = zip(points.u.tolist(), points.s.tolist(), strict=True)
            touched = (replace(_touching(self.model, family, self.x, u), sign=s) for u, s in places)
            of_families.append([(family, contact) for contact in touched])
        lengths = {family.name for family, _ in self.curved if isinstance(family, NormFamily | ConeFamily)}
        contacts: dict[object, Contact] = {}
        for rows, several in zip([*of_families, *([row] for row in self.rows)], weights, strict=False):
            for (family, contact), weight in zip(rows, several.tolist(), strict=True):
                if weight > 0.0:
                    weighed = replace(contact, multiplier=weight * (self.model.unit / family.unit))
                    # tangents of a length are linear in the direction: opposite ones cancel
                    key = (contact.constraint, contact.k) if contact.constraint in lengths else len(contacts)
                    contacts[key] = _together(contacts[key], weighed) if key in contacts else weighed
        stated = self.model.program.stated_multipliers(np.asarray(equations))
        return Certificate.of_leaf(self.model.problem, tuple(contacts.values()), stated.tolist())


def _together(first: Contact, other: Contact) -> Contact:
    """One contact in the place of two with different directions."""
    whole = first.multiplier + other.multiplier
    pull = first.multiplier * np.array(first.direction) + other.multiplier * np.array(other.direction)
    return replace(first, multiplier=whole, direction=tuple((pull / whole).tolist()))
