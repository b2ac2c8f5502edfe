"""Certificates from an optimum's multipliers, with the best bound that can be proven."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.curved import FormulaFamily
from optlaws.synthesis.families.energy import EnergyFamily
from optlaws.synthesis.families.family import LinearFamily, NormFamily
from optlaws.synthesis.families.names import RowName, VariableName
from optlaws.synthesis.functionals.sizes import nonnegative_weights
from optlaws.synthesis.method.discretised.on_points import first_points
from optlaws.synthesis.method.exchange import solve
from optlaws.synthesis.method.newton import newton
from optlaws.synthesis.program.writer import Model, relaxed, relaxed_power
from optlaws.synthesis.proof.certificate import OBJECTIVE, RELAXED, VIOLATION, Certificate, weighted_rows
from optlaws.synthesis.proof.duality import Sublevel, row_of, sum_of_lines
from optlaws.synthesis.proof.nodes import Contact
from optlaws.tolerances import EMPTY_ROW, OPTIMALITY_GAP, STATED_BOUND

_LIGHT_SHARES = (1e-13, 1e-12, 1e-11, 1e-10)  # of all multipliers: what each contact has that is there for rounding
_LEFT_SHARES = (1e-12, 1e-11, 1e-10, 1e-9)  # of a constant's weight: what a proof leaves of it to pay for rounding
_FOUR_WAYS = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))
_DIRECTIONS_RANK = 1e-10  # of the greatest singular value of pulls: less is rounding
_APEX = 1e-11  # of the sum of magnitudes: a norm that is less is 0 but for rounding
_PROOF_WEIGHTLESS = 1e-14  # of the greatest multiplier of a proof: what is less is left out
_PROOF_ENOUGH = 5e-9  # of an objective: a bound that leaves no more needs no other proof

_TANGENTS = 4
_PLACES = 256
_NEAR = 0.9
_SETTLINGS = 3


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
    for _ in range(_TANGENTS):
        loose = relaxed(problem, tangent)
        outcome = solve(loose.program, warm)
        warm = outcome.optimum
        if warm is None:
            break
        proof = certificate(loose, warm, RELAXED, tangent)
        if best is None or proof.estimate > best.estimate:
            best = proof
        if limit is not None and best.estimate < _NEAR * limit:
            break
        moved = float(warm.x[loose.places[VariableName.POWER_ROOT]])
        if abs(moved - tangent) < 1e-6 * tangent:
            break
        tangent = moved
    return best if best is not None else Certificate.of_leaf(problem, program=RELAXED, tangent=tangent)


def _of_convex(model: Model, optimum: ActiveSet, objective: float) -> Certificate:
    proof = certificate(model, optimum, OBJECTIVE)
    if proof.estimate < objective - STATED_BOUND * abs(objective):
        # a flat optimum may leave more of its multipliers' sum than the bound that is stated may be off
        proof = _settled(model, optimum, proof)
    enough = objective - _PROOF_ENOUGH * max(abs(objective), _PROOF_ENOUGH * model.problem.objective.scale)
    if (proof.estimate >= enough and not _of_one_side(model)) or proof.bound >= enough:
        return proof
    # constants that are nowhere below 0 bound their sum without a contact
    balanced, proof = proof, max(proof, Certificate.of_leaf(model.problem), key=lambda known: known.bound)
    for repairable in spread(model, balanced) if objective - proof.bound > OPTIMALITY_GAP * abs(objective) else ():
        proof = max(proof, repairable, key=lambda known: known.bound)
        if proof.bound >= enough:
            return proof
    return max((proof, *_leaving(model, optimum)), key=lambda known: known.bound) if proof.bound == -np.inf else proof


def _of_one_side(model: Model) -> bool:
    """Whether what is minimised is a peak of one side, which bounds laws in doubles alone, if at all."""
    sided = (each for each in model.program.families if isinstance(each, LinearFamily) and len(each.signs) == 1)
    return any(float(each.slack @ model.program.objective) > 0.0 for each in sided)


def _settled(model: Model, optimum: ActiveSet, proof: Certificate) -> Certificate:
    """The certificate with multipliers, directions and places of tangents changed by as little as balances it."""
    for _ in range(_SETTLINGS):
        better = _shifted(model, optimum, proof)
        # the exact bound may repair what the sum still depends on: of multipliers as they are written doubles say more
        if better is None or better.estimate < proof.estimate:
            return proof
        if better.estimate == proof.estimate and better.bound <= proof.bound:
            return proof
        proof = better
    return proof


def _shifted(model: Model, optimum: ActiveSet, proof: Certificate) -> Certificate | None:
    """A single step of the correction; None where nothing can be changed."""
    program, contacts = model.program, proof.contacts
    equations = program.multipliers_of_equations(proof.equations)
    rows = [row_of(program, contact)[0] for contact in contacts]
    pulls = [max(contact.multiplier, 0.0) * row[None] for contact, row in zip(contacts, rows, strict=True)]
    slope = sum_of_lines(model, weighted_rows(proof)[1]).slope[0]
    shifts = [_shifts(model, optimum, contact) for contact in contacts]
    changes = [contact.multiplier * shift for contact, shift in zip(contacts, shifts, strict=True)]
    length = np.maximum(np.linalg.norm(program.equalities, axis=1), EMPTY_ROW)
    matrix = np.vstack([*pulls, program.equalities / length[:, None], *changes])
    if not len(contacts):
        return None
    change = np.linalg.lstsq(matrix.T, -slope, rcond=_DIRECTIONS_RANK)[0]
    count = len(contacts)
    share, pull, rest = np.split(change, [count, count + len(equations)])
    parts = np.split(rest, np.cumsum([len(part) for part in changes])[:-1])
    if (share <= -1.0).any():
        return None
    moved = [
        _touching(model, replace(contact, multiplier=contact.multiplier * (1.0 + grown)), part)
        for contact, grown, part in zip(contacts, share.tolist(), parts, strict=True)
    ]
    stated = program.stated_multipliers(equations + pull / length).tolist()
    return proof.with_leaf(contacts=moved, equations=stated)


def _shifts(model: Model, optimum: ActiveSet, contact: Contact) -> Array:
    """Derivatives of a contact's row by the parameters of its tangent, shape (parameters, variables)."""
    program = model.program
    wide = np.zeros((0, program.size))
    image = _image(model, contact)
    if image is None:
        family = _formula_of(model, contact)
        if family is None:
            return wide
        u = np.clip(family.u(np.array([contact.k])), *family.domain)
        image = family.hessian(optimum.x, u, np.array([contact.sign]))
        return wide if image is None else np.asarray(image * (family.unit / model.unit))
    return np.hstack([image, np.zeros((len(image), program.size - image.shape[1]))])


def _formula_of(model: Model, contact: Contact) -> FormulaFamily | None:
    """The family of a formula that a contact is of, if it weighs."""
    for family in model.program.families:
        if family.name == contact.constraint and contact.multiplier > 0.0 and isinstance(family, FormulaFamily):
            return family
    return None


def _touching(model: Model, contact: Contact, change: Array) -> Contact:
    """The contact with its tangent elsewhere: in another direction, or at another law."""
    if not len(change):
        return contact
    family = _formula_of(model, contact)
    if family is None:
        return _with_direction(contact, np.array(contact.direction) + change)
    u = float(np.clip(family.u(np.array([contact.k])), *family.domain)[0])
    nothing = np.zeros_like(change)
    moved = np.subtract(family.touching(change, u), family.touching(nothing, u))
    return replace(contact, direction=tuple((np.array(contact.direction) + moved).tolist()))


def spread(model: Model, proof: Certificate) -> Iterator[Certificate]:
    """The certificate with light contacts everywhere, of one weight after another, so that rows determine the law.

    An optimum that is not the only law balances its contacts at their exact places alone, and no multipliers do at
    rounded ones. With light contacts some do, whatever rounding leaves; what these add up to, the others balance.
    """
    program, contacts = model.program, [contact for contact in proof.contacts if contact.multiplier > 0.0]
    light = list(_light(model))
    if not light or not contacts:
        return
    rows, heavy = (np.array([row_of(program, contact)[0] for contact in part]) for part in (light, contacts))
    sizes, lengths = np.linalg.norm(heavy, axis=1), np.maximum(np.linalg.norm(rows, axis=1), EMPTY_ROW)
    rows /= lengths[:, None]
    fixed = np.vstack([heavy, program.equalities])
    weights = nonnegative_weights(np.vstack([rows, fixed, -fixed]), -rows.sum(axis=0))
    more, added, taken = np.split(weights, np.cumsum([len(rows), len(fixed)]))
    (change, turn), multipliers = np.split(added - taken, [len(heavy)]), np.array([c.multiplier for c in contacts])
    for share in _LIGHT_SHARES:
        weight = share * float(multipliers @ sizes)
        stated = program.multipliers_of_equations(proof.equations) + weight * turn
        every = [*(multipliers + weight * change).tolist(), *(weight * (1.0 + more) / lengths).tolist()]
        yield proof.with_leaf(
            contacts=[replace(c, multiplier=m) for c, m in zip([*contacts, *light], every, strict=True)],
            equations=program.stated_multipliers(stated).tolist(),
        )


def _light(model: Model) -> Iterator[Contact]:
    """Contacts at the first points of affine rows, and of cones in four directions, which add up to nothing."""
    for family, points in zip(model.program.families, first_points(model.program), strict=True):
        # how far a law may be within all constraints is no constraint of the problem
        if isinstance(family, LinearFamily | ConeFamily) and family.name != RowName.TO_SPARE:
            directions = _FOUR_WAYS if isinstance(family, ConeFamily) else ((),)
            for k, sign in zip(family.k(points.u).tolist(), points.s.tolist(), strict=True):
                yield from (Contact(family.name, sign, min(max(k, 0.0), 1.0), 1.0, way) for way in directions)


def _leaving(model: Model, optimum: ActiveSet) -> Iterator[Certificate]:
    """Certificates of optima that leave a little of a constant's weight, with which rounding is paid."""
    program, sublevel = model.program, Sublevel.of(model)
    least = sublevel.least_values()
    pulled = np.zeros(program.size)
    for i, multiplier in zip(optimum.family, optimum.multipliers, strict=True):
        pulled += multiplier * program.families[i].slack
    for name, place in model.places.items():
        if pulled[place] > 0.0 and least.get(name, -np.inf) >= 0.0 and sublevel.means({name: 1.0}):
            for share in _LEFT_SHARES:
                cost = program.objective.copy()
                cost[place] -= share * pulled[place]
                state = newton(replace(program, objective=cost), optimum)
                if state is not None and (state.multipliers >= 0.0).all():
                    yield certificate(model, state, OBJECTIVE)


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
        direction: tuple[float, ...] = ()
        if isinstance(family, NormFamily):
            direction = _direction(family, np.append(optimum.x, 1.0))
        for j, k in zip(places, family.k(optimum.u[places]), strict=True):
            if isinstance(family, ConeFamily):
                direction = family.direction(optimum.x, float(optimum.u[j]))
            if isinstance(family, FormulaFamily):
                direction = family.touching(optimum.x, float(optimum.u[j]))
            if isinstance(family, EnergyFamily):
                direction = tuple(model.coordinates(optimum.x).tolist())
            multiplier = float(optimum.multipliers[j]) * (model.unit / family.unit)
            place = float(min(max(k, 0.0), 1.0))
            contacts.append(Contact(family.name, float(optimum.s[j]), place, multiplier, direction))
    equations = model.program.stated_multipliers(optimum.equality_multipliers).tolist()
    return Certificate.of_leaf(model.problem, contacts, equations, program, tangent)


def _direction(family: NormFamily, x: Array) -> tuple[float, ...]:
    """The unit vector along a norm's image; 0 where rounding alone is left of that, and every direction is as good."""
    image = family.matrix @ x
    length = float(np.linalg.norm(image))
    known = length > _APEX * float(np.linalg.norm(np.abs(family.matrix) @ np.abs(x)))
    return tuple((image / length if known else np.zeros_like(image)).tolist())


def violation_certificate(model: Model, optimum: ActiveSet) -> Certificate:
    """The certificate that no law exists, without multipliers that are mere rounding."""
    sizes = (optimum.multipliers, optimum.equality_multipliers)
    least = _PROOF_WEIGHTLESS * max((float(np.abs(size).max(initial=0.0)) for size in sizes), default=0.0)
    equations = np.where(np.abs(sizes[1]) < least, 0.0, sizes[1])
    plain = replace(optimum.only(np.abs(sizes[0]) >= least), equality_multipliers=equations)
    return certificate(model, plain, VIOLATION)


def _image(model: Model, contact: Contact) -> Array | None:
    """The matrix from a contact's direction to the coordinates; None if it has no direction."""
    terms = model.space.terms
    for family in model.program.families:
        if family.name == contact.constraint and contact.multiplier > 0.0:
            share = family.unit / model.unit
            if isinstance(family, NormFamily):
                return family.matrix[:, :terms] * share
            if isinstance(family, ConeFamily):
                columns = family.columns(np.clip(family.u(np.array([contact.k])), *family.domain))[0, 0, :terms] * share
                return np.vstack([columns.real, columns.imag])
    return None


def _with_direction(contact: Contact, direction: Array) -> Contact:
    """A contact whose direction is scaled to length 1, with a greater multiplier."""
    length = max(float(np.linalg.norm(direction)), 1.0)
    return replace(contact, multiplier=contact.multiplier * length, direction=tuple((direction / length).tolist()))
