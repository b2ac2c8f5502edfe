"""Lower bounds of peaks, which hold at a single place: the search for the best place.

The optimum without the lower bound is continued: one extremum of the constant is imposed as an equation, first at the
value that it has and then, step by step, at the bound. Where no extremum leads there, the peak is required at one place
after the other, which is a program like any other, and then let go to where it is best. Each way leads to a candidate.

Where the constant is itself what is minimised, every law that has it is an optimum, and no contact shows the way: there
some law between one with a constant too small and one with it too great has it as required.

Lower bounds of an RMS: the norm is at least what any direction shows of it, and that is linear.

With the row d . M x >= low for a unit vector d every law has |M x| >= low, and the program stays convex. From the best
law of it d is turned to where M x now points, which leaves that law in and can only make the objective less, until it
stays: a law whose neighbours are no better.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import islice
from math import inf

import numpy as np
from numpy.polynomial.chebyshev import chebpts2
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.numbers import Array
from optlaws.numerics.roots import bisect
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, NormFamily, Program
from optlaws.synthesis.families.names import at_least
from optlaws.synthesis.method.exchange import solve
from optlaws.synthesis.method.newton import polished
from optlaws.synthesis.problem.constants import B, Functional, RootMeanSquare
from optlaws.synthesis.problem.expression import leaves
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, model_of, reaches, shortfalls

_LEAST_STEP = 1e-3  # of a way: a shorter step of a search for a bound is not taken

_FIRST_STEP = 0.25
_WORTHY = 0.2
_FOLLOWED = 4
_ROOM = 1e3


def active_lower_bounds(model: Model, optimum: ActiveSet) -> list[ActiveSet]:
    """Candidates in which every constant is at or above its lower bound, from the optimum without these bounds.

    Raises
    ------
    InputError
        If a constant with a lower bound consists of several families of rows.
    """
    problem = model.problem
    short = shortfalls(problem, model.law(optimum.x))
    if not short:
        return [optimum]
    constant, low = next(iter(short.items()))
    # where nothing else is minimised, every law with the constant at its lower bound is best, and no contact shows one
    alone = all(leaf == constant for _, leaf in leaves(problem.objective))
    ways = [] if alone else _raised(model, optimum, constant, low)
    ways.sort(key=lambda way: way[0].program.objective_at(way[1].x))
    led = [
        state
        for way in ways[:_FOLLOWED]
        if reaches(way[0].law(way[1].x), constant, low)
        for state in active_lower_bounds(*way)
    ]
    return led or list(islice(between(model, optimum, constant, low), 1 if alone else None))


def active_lower_bounds_at(
    model: Model, optimum: ActiveSet, constant: Functional, low: float, k: float
) -> list[ActiveSet]:
    """Candidates with the peak fixed at k, then released to the best place nearby."""
    family, low = family_of(model, constant, low)
    ways = _at_fixed_places(model.program, family, optimum, (constant.name, low), family.u(np.array([k])))
    return [
        candidate
        for program, state in ways
        for candidate in active_lower_bounds(replace(model, program=program), state)
    ]


def _raised(model: Model, plain: ActiveSet, constant: Functional, low: float) -> list[tuple[Model, ActiveSet]]:
    """Optima in which the constant is `low` at one place, with the programs that require it there."""
    family, low = family_of(model, constant, low)
    raised = replace(family, as_equation=True)
    extrema, signs, height = family.extremes(plain.x)
    led = []
    for j in np.flatnonzero(height > _WORTHY * height.max()):
        free = _inside(family, float(extrema[j]))
        start = plain.joined(len(model.program.families), float(extrema[j]), float(signs[j]), free=free)
        led.append(_continued(model.program, raised, start, (float(height[j]), low)))
    ways = [_rested(model.program, family, optimum, low) for optimum in led if optimum is not None]
    if not ways and isinstance(family, NormFamily):
        ways = along_directions(model.program, family, plain, low)
    elif not ways:
        ways = _at_fixed_places(model.program, family, plain, (constant.name, low), places(model.problem, family))
    return [(replace(model, program=program), state) for program, state in ways]


def _continued(
    program: Program, raised: ConstraintFamily, state: ActiveSet, heights: tuple[float, float]
) -> ActiveSet | None:
    height, low = heights
    done, step = 0.0, _FIRST_STEP
    while done < 1.0:
        target = min(done + step, 1.0)
        bound = height + target * (low - height)
        moved = polished(_with(program, replace(raised, bound=bound)), state, lambda _: False)
        if moved is None:
            step /= 2.0
            if step < _LEAST_STEP:
                return None
            continue
        state, done = moved, target
        step *= 1.5
    return state


def _at_fixed_places(
    program: Program, family: ConstraintFamily, plain: ActiveSet, lower_bound: tuple[str, float], where: Array
) -> list[tuple[Program, ActiveSet]]:
    """Optima of the programs with the peak at a fixed place, then released from there."""
    name, low = lower_bound
    # held at the bound from both sides, c would have no slope at the place: the upper side waits until it may move
    loose = [replace(other, bound=other.bound + _ROOM) if other.name == name else other for other in program.families]
    ways, stuck = [], []
    for u in where.tolist():
        for s in family.signs:
            row = _row(family, u, s, low)
            at_u = _with(replace(program, families=tuple(loose)), row)
            state = solve(at_u, start=plain.x if at_u.curved else None).optimum
            way = None if state is None else _let_go(program, family, state, low)
            if way is not None:
                ways.append(way)
            elif state is not None:
                stuck.append((at_u.objective_at(state.x), row))
    # a curved program without a path: every law with the peak may be on the boundary of the other constraints
    return ways if program.curved and ways else ways + _stayed(program, ways, stuck)


def _stayed(
    program: Program, ways: list[tuple[Program, ActiveSet]], stuck: list[tuple[float, ConstraintFamily]]
) -> list[tuple[Program, ActiveSet]]:
    """Optima of a linear program with the peak at a fixed place, while they may be better than the paths."""
    best = min((program.objective_at(state.x) for _, state in ways), default=inf)
    stayed = []
    for worth, row in sorted(stuck, key=lambda placed: placed[0]):
        if worth >= best:
            break
        there = _with(program, row)
        state = solve(there).optimum
        if state is not None:
            stayed.append((there, state))
            best = min(best, there.objective_at(state.x))
    return stayed


def _let_go(
    program: Program, family: ConstraintFamily, state: ActiveSet, low: float
) -> tuple[Program, ActiveSet] | None:
    """The solution with the peak at the best place nearby; None if Newton's method fails or no place is free."""
    last = state.family == len(program.families)
    if last.sum() != 1:
        return None
    start = _turned(state, last, free=_inside(family, float(state.u[last][0])))
    moved = polished(_with(program, replace(family, as_equation=True, bound=low)), start, lambda _: False)
    return None if moved is None else _rested(program, family, moved, low)


def _rested(program: Program, family: ConstraintFamily, state: ActiveSet, low: float) -> tuple[Program, ActiveSet]:
    """A state with a moving peak, as a state of the program that fixes the peak at the same place."""
    last = state.family == len(program.families)
    row = _row(family, float(state.u[last][0]), float(state.s[last][0]), low)
    return _with(program, row), _turned(state, last, free=False)


def _turned(state: ActiveSet, last: NDArray[np.bool_], *, free: bool) -> ActiveSet:
    """The active set with the contact of the last family reversed: s f = low becomes -s f <= -low."""
    return replace(
        state,
        s=np.where(last, -state.s, state.s),
        multipliers=np.where(last, -state.multipliers, state.multipliers),
        free=np.where(last, free, state.free),
    )


def _row(family: ConstraintFamily, u: float, s: float, low: float) -> ConstraintFamily:
    """The row s f(u) >= low."""
    return replace(family, signs=(-s,), bound=-low, domain=(u, u))


def _with(program: Program, family: ConstraintFamily) -> Program:
    return replace(program, families=(*program.families, family))


def _inside(family: ConstraintFamily, u: float) -> bool:
    return bool(family.movable(np.array([u]))[0])


_PLACES = 5
_HALVINGS = 60
_SMOOTH = {"C": "rms_c", "C_plus": "rms_c", "C_minus": "rms_c", "J": "rms_j", "D": "rms_c", "B": "rms_c"}


def family_of(model: Model, constant: Functional, low: float) -> tuple[ConstraintFamily, float]:
    """The rows of a constant with a lower bound, scaled to values near 1, and the bound in the same scale.

    Raises
    ------
    InputError
        If there are several families of them.
    """
    families = constant.families(model.space, np.zeros(model.program.size), low)
    if len(families) != 1:
        raise InputError(f"{constant.title} is of {len(families)} families of rows: it cannot be bounded from below")
    family = families[0] if constant.normalised else families[0].scaled_down(constant.scale)
    return replace(family, name=at_least(constant.name), bound=0.0), family.bound


def places(problem: Problem, family: ConstraintFamily) -> Array:
    """Some places of a family's domain, ends included; half the domain where mirrored laws are equally good."""
    low, high = family.domain
    if problem.mirrored:
        low = (low + high) / 2.0
    count = _PLACES if problem.symmetric or problem.mirrored else 2 * _PLACES - 1
    return np.asarray((low + high) / 2.0 + (high - low) / 2.0 * chebpts2(count)[::-1])


def between(model: Model, plain: ActiveSet, constant: Functional, low: float) -> Iterator[ActiveSet]:
    """Laws between the optimum without the lower bound and smooth laws beyond it that have the constant at `low`."""
    other = model_of(_without(model.problem, constant))
    family, least = family_of(other, constant, low)
    terms = model.space.terms

    def value(coordinates: Array) -> float:
        return constant.value(model.space.law(coordinates))

    laws: Iterator[ActiveSet]
    if isinstance(family, NormFamily):
        begin = solve(other.program).optimum
        laws = (
            iter(()) if begin is None else (state for _, state in along_directions(other.program, family, begin, least))
        )
    else:
        laws = _at_places(model.problem, other, family, least)
    for beyond in laws:
        if reaches(model.space.law(beyond.x[:terms]), constant, low):
            x = plain.x.copy()
            x[:terms] = _met(value, low, x[:terms], beyond.x[:terms])
            yield replace(plain, x=x)


def _at_places(problem: Problem, other: Model, family: ConstraintFamily, low: float) -> Iterator[ActiveSet]:
    """Smooth laws with the peak at one place after the other."""
    for u in places(problem, family).tolist():
        for s in family.signs:
            row = replace(family, signs=(-s,), bound=-low, domain=(u, u))
            beyond = solve(_with(other.program, row)).optimum
            if beyond is not None:
                yield beyond


def _without(problem: Problem, constant: Functional) -> Problem:
    """The problem without the bound of the constant, with an objective that keeps laws smooth."""
    bounds = {bounded: limits for bounded, limits in problem.bounded if bounded != constant}
    # a norm is held up by linear rows: what is minimised beside it had better be linear too
    minimise = "C" if isinstance(constant, RootMeanSquare) else _SMOOTH.get(constant.name, "rms_c")
    smooth = replace(problem, minimise=minimise, C=None, D=None, J=None, bounds=bounds)
    # where B is held up at a place, |b| <= B would hold it there from both sides
    return replace(smooth, B=None) if constant == B else smooth


def _met(value: Callable[[Array], float], low: float, short: Array, beyond: Array) -> Array:
    """The first law with the required value on the path from an insufficient to a sufficient law, by bisection."""
    _, share = bisect(lambda share: value(short + share * (beyond - short)) < low, 0.0, 1.0, _HALVINGS)
    return short + share * (beyond - short)


_DIRECTION_SETTLED = 1e-10  # of an objective: a change of directions that gains less is the last
_FLAT_DIRECTION = 1e-9  # of the longest: directions that are shorter say nothing

_DIRECTIONS = 12
_BEGUN = 8
_DIRECTIONS_FOLLOWED = 2
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
    ways = [_turned_direction(program, family, way, low) for way in begun[:_DIRECTIONS_FOLLOWED]]
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


def _turned_direction(
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
