"""Structures of usual problems that come with optlaws: which constraints bind where, as Newton's method may begin.

They are those of symmetric laws from rest to rest with least C, J or D, along B, by order and number of coordinates.
What they lead to is verified as every law is: a structure that is wrong costs time and nothing else. Of D, whose
problems are not convex, only those are stored from which no search from several starts led to a better law.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import LinearFamily, ProductFamily, Program
from optlaws.synthesis.program.writer import Model
from optlaws.synthesis.spaces.polynomial_space import PolynomialSpace

STORED = Path(__file__).with_name("structures.bin")

#: units of B - 1 and of the coefficients of places
_OF_VELOCITY, _OF_PLACE = 2.0**13, 2.0**14
#: of the greatest coefficient of variables, whose exponent is stored beside them
_BITS = 14
#: numbers of a structure before its rows
_HEADER = 6
#: units of B: structures change as near as this to where they are stored to end
_BESIDE_CHANGE = 2.0


@dataclass(frozen=True, eq=False)
class StoredStructure:
    """The contacts of the best laws between two B.

    Attributes
    ----------
    begin, end
        The least and the greatest B; both 0 where none is required.
    family, sign, free
        The contacts' rows: the place of the family in the program, the sign, and whether a contact may move.
    places
        Where the contacts are, as Chebyshev series along B, shape (coefficients, contacts).
    variables
        The program's variables, as such series too where its rows are curved; else there are none of them.
    """

    begin: float
    end: float
    family: NDArray[np.intp]
    sign: Array
    free: NDArray[np.bool_]
    places: Array
    variables: Array

    @property
    def count(self) -> int:
        return len(self.sign)

    def at(self, B: float) -> tuple[Array, Array]:
        """The places of the contacts, and the program's variables where they are stored."""
        width = self.end - self.begin
        share = (2.0 * B - self.begin - self.end) / width if width else 0.0
        angle = np.arccos(min(max(share, -1.0), 1.0))
        places, variables = (
            np.cos(np.arange(len(series)) * angle) @ series for series in (self.places, self.variables)
        )
        return np.clip(places, -1.0, 1.0), variables

    def away(self, B: Array) -> Array:
        """The distances of some B from the structure's range of B."""
        return np.maximum(np.maximum(self.begin - B, B - self.end), 0.0)


def key_of(model: Model) -> str | None:
    """The key of a problem's stored structures; None where none of its kind are stored.

    Examples
    --------
    >>> from optlaws.synthesis.problem.problem import Problem
    >>> from optlaws.synthesis.program.writer import model_of
    >>> key_of(model_of(Problem(B=1.7, order=4)))
    '4 5 C,chord,b'
    """
    space, program = model.space, model.program
    if not isinstance(space, PolynomialSpace) or not space.symmetric or not space.at_rest:
        return None
    curved = [family for family in program.families if not isinstance(family, LinearFamily)]
    if len(program.right) > 1 or not all(isinstance(family, ProductFamily) for family in curved):
        return None
    return f"{space.order} {space.terms} {','.join(family.name for family in program.families)}"


def is_usual(model: Model) -> bool:
    """Whether structures are stored for problems that differ from this one in B only.

    >>> from optlaws.synthesis.problem.problem import Problem
    >>> from optlaws.synthesis.program.writer import model_of
    >>> is_usual(model_of(Problem(B=1.7, order=4))), is_usual(model_of(Problem(B=1.7, order=8)))
    (True, False)
    """
    key = key_of(model)
    return key is not None and isinstance(model.problem.B, float) and bool(stored_structures(key))


def stored_guess(model: Model) -> ActiveSet | None:
    """The optimum that a problem may have, by a structure that is stored for its kind; None where none is.

    Where one structure gives way to the next, two laws are as good but for rounding: there none is preferred.
    """
    key = key_of(model)
    structures = None if key is None else stored_structures(key)
    if not structures:
        return None
    if not isinstance(model.problem.B, float):
        return guess_of(model.program, structures[0], 0.0)
    B = model.problem.B
    changes = np.array([end for known in structures for end in (known.begin, known.end)][1:-1])
    if (np.abs(B - changes) * _OF_VELOCITY < _BESIDE_CHANGE).any():
        return None
    structure = min(structures, key=lambda structure: float(structure.away(np.array(B))))
    return guess_of(model.program, structure, B)


def guess_of(program: Program, structure: StoredStructure, B: float) -> ActiveSet:
    """The variables and multipliers that go with the places of a structure's contacts.

    Multipliers balance the objective. Of a linear program they show what it is, and what the rows leave open of the
    variables gives that.
    """
    u, x = structure.at(B)
    linear = not len(x)
    x = np.zeros(program.size) if linear else x
    count, size = len(u), program.size
    rows, slopes = np.empty((2, count, size))
    value, slope = np.empty((2, count))
    for i in set(structure.family.tolist()):
        contacts = structure.family == i
        jet = program.families[i].jet(x, u[contacts], structure.sign[contacts])
        rows[contacts], slopes[contacts] = jet.gradient, jet.slope_gradient
        value[contacts], slope[contacts] = jet.value, jet.slope
    balancing = np.vstack([rows, program.equalities])
    multipliers = np.asarray(np.linalg.lstsq(balancing.T, -program.objective, rcond=None)[0], dtype=np.float64)
    if linear:
        right = np.concatenate([-value, program.right])
        system = np.vstack([balancing, slopes[structure.free], program.objective])
        sides = np.concatenate([right, -slope[structure.free], [-float(multipliers @ right)]])
        x = np.linalg.lstsq(system, sides, rcond=None)[0]
    return ActiveSet(
        x=x,
        family=structure.family,
        u=u,
        s=structure.sign,
        free=structure.free,
        multipliers=multipliers[:count],
        equality_multipliers=multipliers[count:],
    )


@lru_cache(maxsize=1)
def _stored() -> dict[str, NDArray[np.int16]]:
    """The numbers of each key."""
    lines, _, content = STORED.read_bytes().partition(b"\n\n")
    numbers, stored, begin = np.frombuffer(content, dtype="<i2"), {}, 0
    for line in lines.decode().splitlines():
        key, _, count = line.rpartition(" ")
        stored[key] = numbers[begin : begin + int(count)]
        begin += int(count)
    return stored


@lru_cache(maxsize=128)
def stored_structures(key: str) -> tuple[StoredStructure, ...]:
    """Stored structures for a kind of problems; empty for unusual kinds.

    Examples
    --------
    >>> [len(structure.sign) for structure in stored_structures("4 2 C,chord,b")]
    [2, 2, 1, 2, 1]
    """
    return tuple(_read(_stored().get(key, np.empty(0, dtype=np.int16)).tolist()))


def _read(numbers: list[int]) -> Iterable[StoredStructure]:
    begin = 0
    while begin < len(numbers):
        low, high, contacts, terms, count, exponent = numbers[begin : begin + _HEADER]
        begin += _HEADER
        rows = np.array(numbers[begin : begin + contacts])
        begin += contacts
        width = contacts + count
        series = np.array(numbers[begin : begin + terms * width]).reshape(terms, width)
        begin += terms * width
        ends = [1.0 + end / _OF_VELOCITY if high else 0.0 for end in (low, high)]
        yield StoredStructure(
            begin=ends[0],
            end=ends[1],
            family=rows >> 2,
            sign=np.where(rows & 2, 1.0, -1.0),
            free=(rows & 1).astype(np.bool_),
            places=series[:, :contacts] / _OF_PLACE,
            variables=series[:, contacts:] * 2.0 ** (exponent - _BITS),
        )
