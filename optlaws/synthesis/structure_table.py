"""The structures that come with optlaws, computed: `python -m optlaws.synthesis.arrays.structure_table` writes them.

It takes some minutes. Nothing depends on them but time.
"""

from __future__ import annotations

from optlaws.numerics.chebyshev import from_values, nodes
from optlaws.synthesis.arrays.continuation import StructureSegment
from optlaws.synthesis.arrays.continued_laws import segments_of
from optlaws.synthesis.arrays.newton_steps import structure_of
from optlaws.synthesis.arrays.programs import between
from optlaws.synthesis.method.exchange import solve
from optlaws.synthesis.method.stored_structures import STORED, StoredStructure, key_of, written
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import model_of
from optlaws.synthesis.spaces.bases import Chebyshev
from optlaws.tolerances import SHORT_STRETCH

#: the kinds of problems: orders, degrees by what is minimised, and the range of B
_ORDERS = range(2, 7)
_DEGREES = {"C": (*range(3, 42, 2), 51, 61), "J": range(3, 22, 2)}
_LEAST, _GREATEST = 1.1, 3.0
#: coefficients of a place along B, where it moves
_TERMS = 4


def structures_along_velocity(problem: Problem) -> list[StoredStructure]:
    """The structures of the best laws of a problem between the least and the greatest B that are stored.

    Examples
    --------
    >>> [len(structure.sign) for structure in structures_along_velocity(Problem(order=4, basis=Chebyshev(3)))]
    [2, 2, 1, 2, 1]
    """
    path = between(problem.at_velocity(_LEAST), problem.at_velocity(_GREATEST))
    segments = [] if path is None else segments_of(path, 0.0, 1.0)
    return [_stored(segment) for segment in segments if segment.end - segment.begin > SHORT_STRETCH]


def _stored(segment: StructureSegment) -> StoredStructure:
    structure, reach = segment.structure, _GREATEST - _LEAST
    middle, half = (segment.begin + segment.end) / 2.0, (segment.end - segment.begin) / 2.0
    # of an affine structure the places stay
    count = 1 if structure.affine else _TERMS
    places = from_values(segment.interpolated(middle + half * nodes(count)).u)
    ends = (_LEAST + reach * segment.begin, _LEAST + reach * segment.end)
    return StoredStructure(*ends, structure.family, structure.sign, structure.free, places)


def structure_without_velocity(problem: Problem) -> list[StoredStructure]:
    """The structure of a problem's best law without a prescribed B; None where it is unclear or flat.

    Examples
    --------
    >>> [len(structure.sign) for structure in structure_without_velocity(Problem(order=4, basis=Chebyshev(3)))]
    [2]
    """
    model = model_of(problem)
    optimum = solve(model.program).optimum
    if optimum is None:
        return []
    structure, order = structure_of(model, optimum)
    inside = (structure.domains != optimum.u[order, None]).all(axis=1)
    if (inside & ~structure.free).any():
        return []
    return [StoredStructure(0.0, 0.0, structure.family, structure.sign, structure.free, optimum.u[order][None])]


def usual_structures() -> dict[str, list[StoredStructure]]:
    """All stored structures, by their keys."""
    structures: dict[str, list[StoredStructure]] = {}
    for minimise, degrees in _DEGREES.items():
        for order in _ORDERS:
            for degree in degrees:
                for monotone in (False, True):
                    problem = Problem(order=order, basis=Chebyshev(degree), minimise=minimise, monotone=monotone)
                    for known, member in (
                        (structures_along_velocity(problem), problem.at_velocity(2.0)),
                        (structure_without_velocity(problem), problem),
                    ):
                        key = key_of(model_of(member))
                        if key is not None and known:
                            structures[key] = known
    return structures


if __name__ == "__main__":
    STORED.write_bytes(written(usual_structures()))
