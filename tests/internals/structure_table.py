"""The structures that come with optlaws, computed: `python -m tests.internals.structure_table` writes them.

It takes some minutes. Nothing depends on them but time.
"""

from __future__ import annotations

from math import frexp

import numpy as np

from optlaws.numbers import Array
from optlaws.numerics.chebyshev import from_values, nodes
from optlaws.synthesis.arrays.continuation import StructureSegment, laws_along
from optlaws.synthesis.arrays.newton_steps import structure_of
from optlaws.synthesis.arrays.programs import Path, between
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import Program
from optlaws.synthesis.method.contacts import polished
from optlaws.synthesis.method.exchange import solve
from optlaws.synthesis.method.stored_structures import (
    _BITS,
    _OF_PLACE,
    _OF_VELOCITY,
    STORED,
    StoredStructure,
    guess_of,
    key_of,
)
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, extreme_velocity, model_of
from optlaws.synthesis.search import LawSearch
from optlaws.synthesis.spaces.bases import Chebyshev
from optlaws.tolerances import AGREEMENT

_SHORT_STRETCH = 1e-4  # of a path: structures that hold for less of it are not stored

#: the kinds of problems: orders, and by what is minimised degrees and where walks along B begin, and the
#: greatest B
_ORDERS = range(2, 7)
_DEGREES = {"C": (*range(3, 42, 2), 51, 61), "J": range(3, 22, 2), "D": range(3, 22, 2)}
_LEAST, _GREATEST = {"C": (1.001, 1.1), "J": (1.001, 1.1), "D": (1.1,)}, 3.0
#: coefficients of a place along B, where it moves
_TERMS = 4
#: where on a path structures are told apart: nearer than the units of B in which they are stored
_ALONG = np.linspace(0.0, 1.0, 2**15 + 1)
#: where on a stretch laws of problems that are not convex are sought from several starts too
_SOUGHT = (0.02, 0.26, 0.5, 0.74, 0.98)


def segments_along(path: Path, t: Array) -> list[StructureSegment]:
    """The structures of the optima at ascending t, more of them than are taken from the file, in their order."""
    segments: list[StructureSegment] = []
    laws_along(path, t, segments)
    return sorted(segments, key=lambda segment: segment.begin)


def structures_along_velocity(problem: Problem) -> list[StoredStructure]:
    """The structures of the best laws of a problem between the least and the greatest B that are stored."""
    walks = (_along(problem, (least, _GREATEST)) for least in _LEAST[repr(problem.objective)])
    structures = max(walks, key=covered)
    return structures if problem.convex else [known for known in structures if _none_better(problem, known)]


def _along(problem: Problem, ends: tuple[float, float]) -> list[StoredStructure]:
    """The structures that a walk between two B finds: at high degrees it may end early."""
    path = between(problem.at_velocity(ends[0]), problem.at_velocity(ends[1]))
    segments = [] if path is None else segments_along(path, _ALONG)
    return [_stored(segment, ends) for segment in segments if segment.end - segment.begin > _SHORT_STRETCH]


def covered(structures: list[StoredStructure]) -> float:
    """The range of B that structures cover, to two decimals."""
    return round(sum(known.end - known.begin for known in structures), 2)


def _none_better(problem: Problem, structure: StoredStructure) -> bool:
    """Whether searches from several starts lead to no better laws than those of a structure."""
    for share in _SOUGHT:
        B = structure.begin + share * (structure.end - structure.begin)
        model = model_of(problem.at_velocity(B) if B else problem)
        optimum = polished(model.program, guess_of(model.program, structure, B), None)
        if optimum is None:
            return False
        objective = model.unit * model.program.objective_at(optimum.x)
        least = LawSearch(model).least(objective)
        if least is None or objective > least * (1.0 + AGREEMENT):
            return False
    return True


def _stored(segment: StructureSegment, velocities: tuple[float, float]) -> StoredStructure:
    structure, reach = segment.structure, velocities[1] - velocities[0]
    middle, half = (segment.begin + segment.end) / 2.0, (segment.end - segment.begin) / 2.0
    # of an affine structure the places stay
    count = 1 if structure.affine else _TERMS
    states = segment.interpolated(middle + half * nodes(count))
    begin, end = (velocities[0] + reach * t for t in (segment.begin, segment.end))
    variables = from_values(_variables(structure.model, states.x))
    return StoredStructure(
        begin, end, structure.family, structure.sign, structure.free, from_values(states.u), variables
    )


def _variables(model: Model, x: Array) -> Array:
    """The variables of laws as they are stored, a row for each: none of a linear program."""
    return x if model.program.curved else np.empty((len(x), 0))


def structure_of_program(model: Model) -> list[StoredStructure]:
    """The structure of the optimum of a single program, which differs from others in no B; none if unclear or flat."""
    optimum = solve(model.program).optimum
    if optimum is None:
        return []
    structure, order = structure_of(model, optimum)
    inside = (structure.domains != optimum.u[order, None]).all(axis=1)
    if (inside & ~structure.free).any() or _is_flat(model.program, optimum):
        return []
    parts = (structure.family, structure.sign, structure.free, optimum.u[order][None])
    stored = StoredStructure(0.0, 0.0, *parts, _variables(model, optimum.x[None]))
    return [stored] if not model.program.curved or _none_better(model.problem, stored) else []


def _is_flat(program: Program, optimum: ActiveSet) -> bool:
    """Whether a contact that may move has no curvature: there it may be anywhere."""
    for i in set(optimum.family.tolist()):
        free = (optimum.family == i) & optimum.free
        jet = program.families[i].jet(optimum.x, optimum.u[free], optimum.s[free])
        if (np.abs(jet.curvature) < AGREEMENT).any():
            return True
    return False


def usual_structures() -> dict[str, list[StoredStructure]]:
    """All stored structures, by their keys."""
    structures: dict[str, list[StoredStructure]] = {}
    for minimise, degrees in _DEGREES.items():
        for order in _ORDERS:
            for degree in degrees:
                for monotone in (False, True):
                    problem = Problem(order=order, basis=Chebyshev(degree), minimise=minimise, monotone=monotone)
                    whole, least = model_of(problem), extreme_velocity(problem, greatest=False)
                    along = (model_of(problem.at_velocity(2.0)), structures_along_velocity(problem))
                    for model, known in (along, *((single, structure_of_program(single)) for single in (whole, least))):
                        key = key_of(model)
                        if key is not None and known:
                            structures[key] = known
    return structures


def packed(structure: StoredStructure) -> list[int]:
    """The structure as whole numbers of 16 bits."""
    ends = [round((end - 1.0) * _OF_VELOCITY) if end else 0 for end in (structure.begin, structure.end)]
    rows = structure.family * 4 + 2 * (structure.sign > 0.0) + structure.free
    count = structure.variables.shape[1]
    exponent = frexp(float(np.abs(structure.variables).max()))[1] if count else 0
    series = np.hstack([structure.places * _OF_PLACE, structure.variables * 2.0 ** (_BITS - exponent)])
    header = [*ends, len(rows), len(series), count, exponent]
    return [*header, *rows.tolist(), *np.round(series).astype(int).ravel().tolist()]


def written(structures: dict[str, list[StoredStructure]]) -> bytes:
    """A file of structures: a line of text for each key, with how many numbers are its own, and all numbers."""
    numbers = {
        key: [number for structure in several for number in packed(structure)] for key, several in structures.items()
    }
    lines = [f"{key} {len(several)}\n" for key, several in numbers.items()]
    together = np.array([number for several in numbers.values() for number in several], dtype="<i2")
    return "".join(lines).encode() + b"\n" + together.tobytes()


if __name__ == "__main__":
    STORED.write_bytes(written(usual_structures()))
