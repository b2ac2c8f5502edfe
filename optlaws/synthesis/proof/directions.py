"""Directions of RMS and of amplitudes in a certificate, turned so that the multipliers balance.

A law near the optimum has these directions only nearly, and what that leaves of the balance is charged against the
bound. But any unit vector bounds a magnitude from below: those that balance best are a linear problem.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.family import NormFamily
from optlaws.synthesis.program.writer import Model
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.proof.duality import row_of
from optlaws.synthesis.proof.nodes import Contact

Array = NDArray[np.float64]

_BALANCED = 1e-13
_RANK = 1e-10


def turned(model: Model, proof: Certificate) -> Certificate:
    """The certificate with the least change of its directions that balances it; the better of both.

    Parameters
    ----------
    found
        The program that the certificate speaks of.
    proof
        A certificate, whose multipliers nearly balance.
    """
    if not any(contact.direction for contact in proof.contacts):
        return proof
    images = [_image(model, contact) for contact in proof.contacts]
    slope = _slope(model, proof)
    if all(image is None for image in images) or np.abs(slope).max(initial=0.0) <= _BALANCED:
        return proof
    pulls = [c.multiplier * image for c, image in zip(proof.contacts, images, strict=True) if image is not None]
    change = np.linalg.lstsq(np.vstack(pulls).T, -slope, rcond=_RANK)[0]
    parts = iter(np.split(change, np.cumsum([len(pull) for pull in pulls])[:-1]))
    contacts = tuple(
        contact if image is None else _with_direction(contact, np.array(contact.direction) + next(parts))
        for contact, image in zip(proof.contacts, images, strict=True)
    )
    better = proof.with_leaf(contacts=contacts)
    return better if better.bound > proof.bound else proof


def _image(model: Model, contact: Contact) -> Array | None:
    """What each component of a contact's direction stands for, in the coordinates; None where it has no direction."""
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


def _slope(model: Model, proof: Certificate) -> Array:
    """What is left of the objective's slope and the contacts' in the coordinates."""
    slope = model.program.objective.copy()
    for contact in proof.contacts:
        slope += max(contact.multiplier, 0.0) * row_of(model.program, contact)[0]
    slope += model.program.equalities.T @ model.program.multipliers_of_equations(proof.equations)
    return np.asarray(slope[: model.space.terms])


def _with_direction(contact: Contact, direction: Array) -> Contact:
    """A direction beyond length 1 is made one, and its multiplier greater."""
    length = max(float(np.linalg.norm(direction)), 1.0)
    return replace(contact, multiplier=contact.multiplier * length, direction=tuple((direction / length).tolist()))
