"""Lower bounds of an RMS: the norm is at least what any direction shows of it, and that is linear.

With the row d . M x >= low for a unit vector d every law has |M x| >= low, and the program stays convex. From the best
law of it d is turned to where M x now points, which leaves that law in and can only make the objective less, until it
stays: a law whose neighbours are no better.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

import numpy as np

from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import LinearFamily, NormFamily, Program
from optlaws.synthesis.method.exchange import solve

_DIRECTION_SETTLED = 1e-10  # of an objective: a change of directions that gains less is the last
_FLAT_DIRECTION = 1e-9  # of the longest: directions that are shorter say nothing

_DIRECTIONS = 12
_BEGUN = 8
_FOLLOWED = 2
_TURNS = 20
_ROUNDS = 4


def along_directions(
    program: Program, family: NormFamily, plain: ActiveSet, low: float
) -> list[tuple[Program, ActiveSet]]:
    """Optima with the norm at `low` or above along a direction, the best first, with the programs that impose it there.

    Parameters
    ----------
    program, plain
        The program without the lower bound, and its optimum.
    family
        The norm's row.
    low
        Its lower bound.
    """
    tried = (_along(program, family, plain, direction, low) for direction in _directions(family, plain))
    begun = list(islice((way for way in tried if way is not None), _BEGUN))
    begun.sort(key=lambda way: way[0].objective_at(way[1].x))
    ways = [_turned(program, family, way, low) for way in begun[:_FOLLOWED]]
    return sorted(ways, key=lambda way: way[0].objective_at(way[1].x))


def _directions(family: NormFamily, plain: ActiveSet) -> Iterator[Array]:
    """Directions of the norm without the bound, and directions in which the coordinates increase it most."""
    image = _image(family, plain.x)
    if np.linalg.norm(image) > _FLAT_DIRECTION:
        yield image / np.linalg.norm(image)
    axes, sizes, _ = np.linalg.svd(family.matrix[:, :-1], full_matrices=False)
    for axis in axes.T[: min(_DIRECTIONS, int((sizes > _FLAT_DIRECTION * sizes[0]).sum()))]:
        yield axis
        yield -axis


def _turned(
    program: Program, family: NormFamily, way: tuple[Program, ActiveSet], low: float
) -> tuple[Program, ActiveSet]:
    for _ in range(_TURNS):
        before = way[0].objective_at(way[1].x)
        image = _image(family, way[1].x)
        better = _along(program, family, way[1], image / np.linalg.norm(image), low)
        if better is None or better[0].objective_at(better[1].x) > before:
            break
        way = better
        if before - way[0].objective_at(way[1].x) < _DIRECTION_SETTLED * abs(before):
            break
    return way


def _along(
    program: Program, family: NormFamily, near: ActiveSet, direction: Array, low: float
) -> tuple[Program, ActiveSet] | None:
    *shown, constant = (direction @ family.matrix).tolist()
    row = LinearFamily.of_row(family.name, -np.array(shown), constant - low)
    with_row = replace(program, families=(*program.families, row))
    state = solve(with_row, start=near.x if program.curved else None, rounds=_ROUNDS).optimum
    return None if state is None else (with_row, state)


def _image(family: NormFamily, x: Array) -> Array:
    return np.asarray(family.matrix @ np.append(x, 1.0))
