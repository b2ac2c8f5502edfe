"""The laws of a path at many t: each structure is extended from one law as far as laws of it are proven optimal.

Beside a law that is known the next one is sought by itself; its structure is tried at ever more distant places in
either direction, and all places between are filled in waves, each interpolated from the one before and made exact by a
step of Newton's method. Every law is proven optimal by itself.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.synthesis.arrays.newton_steps import (
    Certification,
    States,
    Structure,
    certification_of,
    clipped,
    converged,
    step,
    structure_of,
)
from optlaws.synthesis.arrays.programs import Numbers, Path, SolvedBatch
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.method.exchange import solve

_SAME_STATE = 1e-5  # of a segment: states nearer to each other are one of those that others are interpolated between
_ROUGH_STEP = 1e-7  # of a law: a step of more than this share is followed by others

#: states between which others are interpolated
_NEAR = 4
#: places at once at which it is looked how far a structure holds
_PROBES = 8
#: of the places with one structure, every how many are solved in a wave
_WAVES = (64, 16, 4, 1)
#: laws in a wave, at least, but the last
_PER_WAVE = 8
#: places in a row beside a law that may have no structure of their own, as where one gives way to the next
_PASSED = 3
#: of a path: contacts of a law farther away seldom lead to another law as soon as none do
_ALIKE = 0.01
#: known segments whose structures laws beside them are tried with
_BESIDE = 2
#: laws at a time, and bytes of their matrices
_CHUNKS = (128, 1024)
_AT_HAND = 2**21
#: contacts beyond the number of variables that a law may have
_SPARE = 4
_STARTS = np.array([0.5, 0.25, 0.75, 0.0, 1.0])

Places = NDArray[np.intp]


@dataclass(eq=False)
class StructureSegment:
    """A stretch of the path on which the laws have one structure, with states of some of them by ascending t."""

    structure: Structure
    t: Array
    rows: Array

    @property
    def begin(self) -> float:
        """The least t at which a law is known."""
        return float(self.t[0])

    @property
    def end(self) -> float:
        """The greatest t at which a law is known."""
        return float(self.t[-1])

    def away(self, t: Array) -> Array:
        """How far t is from where laws are known; 0 between them."""
        return np.asarray(np.maximum(np.maximum(self.begin - t, t - self.end), 0.0))

    def interpolated(self, t: Array) -> States:
        """States at other t by the polynomial through the nearest on both sides; places that may not move stay."""
        distinct = np.flatnonzero(np.diff(self.t, prepend=-np.inf) > _SAME_STATE * (self.end - self.begin))
        near = min(_NEAR, len(distinct))
        begin = np.clip(np.searchsorted(self.t[distinct], t) - near // 2, 0, len(distinct) - near)
        chosen = distinct[begin[:, None] + np.arange(near)]
        places = self.t[chosen]
        apart = places[:, :, None] - places[:, None, :]
        apart[:, np.arange(near), np.arange(near)] = 1.0
        away = np.repeat((t[:, None] - places)[:, None, :], near, axis=1)
        away[:, np.arange(near), np.arange(near)] = 1.0
        weights = (away / apart).prod(axis=2)
        states = States.unpacked(np.einsum("tn,tnk->tk", weights, self.rows[chosen]), self.structure)
        known = States.unpacked(self.rows[:1], self.structure)
        return replace(states, u=np.where(self.structure.free, states.u, known.u))

    def nearest(self, t: float) -> ActiveSet:
        """The active set of the law that is known nearest to a place."""
        place = int(np.argmin(np.abs(self.t - t)))
        state, structure = States.unpacked(self.rows[place : place + 1], self.structure), self.structure
        return ActiveSet(
            x=state.x[0],
            family=structure.family,
            u=state.u[0],
            s=structure.sign,
            free=structure.free,
            multipliers=state.weights[0],
            equality_multipliers=state.equations[0],
        )

    def joined(self, t: Array, rows: Array) -> None:
        """Further states of the segment."""
        every, unique = np.unique(np.concatenate([self.t, t]), return_index=True)
        self.t, self.rows = every, np.concatenate([self.rows, rows])[unique]


def laws_along(path: Path, t: Array, segments: list[StructureSegment] | None = None) -> SolvedBatch:
    """The optima at ascending t, as far as they are proven; known segments are tried first, and others join them.

    >>> from optlaws.synthesis.arrays.programs import between
    >>> from optlaws import Problem
    >>> path = between(Problem(B=1.6, order=4), Problem(B=1.7, order=4))
    >>> laws_along(path, np.array([0.0, 0.2])).objective.round(6).tolist()
    [5.262224, 5.173677]
    """
    program, known = path.model.program, [] if segments is None else segments
    laws = SolvedBatch.none(len(t), program.size, program.size + _SPARE, len(program.right))
    _fill_near(laws, path, known, t)
    untried = np.ones(len(t), dtype=np.bool_)
    while (place := _next_place(laws.solved, untried)) is not None:
        untried[place] = False
        following = segment_at(path, float(t[place]), _nearest(known, float(t[place])))
        if following is not None and following.structure.count <= laws.u.shape[1]:
            ends = [_last_place(laws, path, following, t, place, end) for end in _open_ends(laws.solved, place)]
            _fill(laws, path, following, t, np.arange(ends[0], ends[1] + 1))
            alike = (each for each in known if each.structure.signature == following.structure.signature)
            same = next(alike, None)
            if same is None:
                known.append(following)
            else:
                same.joined(following.t, following.rows)
    return _in_own_bounds(laws, path, t)


def _fill_near(laws: SolvedBatch, path: Path, segments: list[StructureSegment], t: Array) -> None:
    """Enter the laws that are on known segments, or beside them with the structure of one of the nearest two."""
    away = np.array([segment.away(t) for segment in segments]).reshape(-1, len(t))
    for nearest in np.argsort(away, axis=0, kind="stable")[:_BESIDE]:
        for i in np.unique(nearest[~laws.solved]).tolist():
            _fill(laws, path, segments[i], t, np.flatnonzero(~laws.solved & (nearest == i)))


def _nearest(segments: list[StructureSegment], t: float) -> ActiveSet | None:
    """The active set of the law that is known nearest to a place of the path; None where none is known near it."""
    away = [float(np.abs(segment.t - t).min()) for segment in segments]
    return segments[int(np.argmin(away))].nearest(t) if min(away, default=np.inf) < _ALIKE else None


def segment_at(path: Path, t: float, near: ActiveSet | None) -> StructureSegment | None:
    """The structure at one t, as a segment of one law; None where none is proven optimal."""
    optimum, alone = solve(path.program(t), near).optimum, np.zeros(1, dtype=np.intp)
    if optimum is None:
        return None
    structure, order = structure_of(path.model, optimum)
    state = (optimum.x, optimum.u[order], optimum.multipliers[order], optimum.equality_multipliers)
    law = SolvedBatch.none(1, path.model.program.size, structure.count, len(path.model.program.right))
    of_structure = _LawsOfStructure(law, path, structure, alone, path.numbers(np.array([t])))
    of_structure.converge(States(*(part[None] for part in state)))
    return StructureSegment(structure, np.array([t]), _states(law, structure, alone).packed) if law.solved[0] else None


def _states(laws: SolvedBatch, structure: Structure, places: Places) -> States:
    """The states of laws of one structure."""
    contacts = slice(structure.count)
    return States(laws.x[places], laws.u[places, contacts], laws.multiplier[places, contacts], laws.equations[places])


def _next_place(solved: NDArray[np.bool_], untried: NDArray[np.bool_]) -> int | None:
    """An unsolved place beside a solved one, or beside few that were tried; of some where nothing is solved."""
    if not solved.any():
        starts = np.round(_STARTS * (len(solved) - 1)).astype(np.intp)
        return next((place for place in starts.tolist() if untried[place]), None)
    reached = solved.copy()
    for _ in range(_PASSED):
        beside = np.zeros(len(solved), dtype=np.bool_)
        beside[1:] |= reached[:-1]
        beside[:-1] |= reached[1:]
        open_ones = np.flatnonzero(beside & ~solved & untried)
        if len(open_ones):
            return int(open_ones[0])
        reached |= beside
    return None


def _open_ends(solved: NDArray[np.bool_], place: int) -> tuple[int, int]:
    """The first and the last of the unsolved places about one of them."""
    before, after = np.flatnonzero(solved[:place]), np.flatnonzero(solved[place:])
    return int(before[-1]) + 1 if len(before) else 0, place + int(after[0]) - 1 if len(after) else len(solved) - 1


def _last_place(laws: SolvedBatch, path: Path, segment: StructureSegment, t: Array, place: int, end: int) -> int:
    """The last place toward an end up to which laws of a segment are proven; some are entered, and join it."""
    way, good = (1 if end >= place else -1), place
    beyond = end + way
    while left := abs(beyond - good) - 1:
        places = good + way * np.unique(np.geomspace(1, left, _PROBES).round().astype(np.intp))
        some = _LawsOfStructure(laws, path, segment.structure, places, path.numbers(t[places]))
        some.converge(segment.interpolated(t[places]))
        sound = laws.solved[places]
        count = len(places) if sound.all() else int(np.argmin(sound))
        proven = places[sound]
        segment.joined(t[proven], _states(laws, segment.structure, proven).packed)
        if count:
            good = int(places[count - 1])
        if count < len(places):
            beyond = int(places[count])
    return good


def _fill(laws: SolvedBatch, path: Path, segment: StructureSegment, t: Array, places: Places) -> None:
    """Enter the laws of a segment at places between those at which some are known, in waves."""
    structure = segment.structure
    for stride in _WAVES:
        if stride > 1 and len(places) < _PER_WAVE * stride:
            continue
        some = places[::stride][~laws.solved[places[::stride]]]
        _enter(laws, path, segment, some, t[some])
        known = some[laws.solved[some]]
        segment.joined(t[known], _states(laws, structure, known).packed)


def _enter(target: SolvedBatch, path: Path, segment: StructureSegment, places: Places, t: Array) -> None:
    """Add laws of a segment at some t, interpolated between its states, as far as they are proven."""
    size = _chunk(segment.structure)
    for i in range(0, len(t), size):
        some = slice(i, i + size)
        laws = _LawsOfStructure(target, path, segment.structure, places[some], path.numbers(t[some]))
        laws.solve(segment.interpolated(t[some]))


def _chunk(structure: Structure) -> int:
    """How many laws at a time: the conditions' matrices of more would not stay where they are at hand."""
    program = structure.model.program
    system = program.size + structure.count + len(program.equalities)
    return int(np.clip(_AT_HAND // (8 * system**2), *_CHUNKS))


@dataclass(frozen=True, eq=False)
class _LawsOfStructure:
    """Laws of one structure: where they are entered, and the numbers of their programs."""

    optima: SolvedBatch
    path: Path
    structure: Structure
    places: Places
    numbers: Numbers

    def solve(self, guess: States) -> None:
        """Enter the laws that one step of Newton's method from a guess leads to, or several, as far as proven."""
        states, sizes = step(self.structure, self.numbers, guess)
        left = self.entered(states, np.flatnonzero(sizes <= _ROUGH_STEP), lambda certification: certification.sharp)
        left = left[np.isfinite(sizes[left])]
        if len(left):
            rest = replace(self, places=self.places[left], numbers=self.numbers.taken(left))
            rest.converge(states.taken(left))

    def converge(self, guess: States) -> None:
        """Enter the laws that Newton's method leads to from a guess, as far as proven."""
        states, done = converged(self.structure, self.numbers, guess)
        self.entered(states, np.flatnonzero(done), lambda certification: certification.sound)

    def entered(self, states: States, known: Places, proven: Callable[[Certification], NDArray[np.bool_]]) -> Places:
        """Store the known states that are proven optimal, and return the problems that are left."""
        left = np.ones(len(states), dtype=np.bool_)
        if len(known):
            solved = clipped(self.structure, states.taken(known))
            certification = certification_of(self.path, self.structure, self.numbers.taken(known), solved)
            sound = proven(certification)
            values = (certification.objective[sound], certification.bound[sound], certification.excess[sound])
            _put(self.optima, self.structure, self.places[known[sound]], solved.taken(sound), values)
            left[known[sound]] = False
        return np.flatnonzero(left)


def _put(
    laws: SolvedBatch,
    structure: Structure,
    places: Places,
    states: States,
    proven: tuple[Array, Array, Array],
) -> None:
    count = structure.count
    laws.x[places] = states.x
    laws.family[places, :count] = structure.family
    laws.u[places, :count] = states.u
    laws.sign[places, :count] = structure.sign
    laws.free[places, :count] = structure.free
    laws.multiplier[places, :count] = np.maximum(states.weights, 0.0)
    laws.equations[places] = states.equations
    laws.objective[places], laws.bound[places], laws.excess[places] = proven


def _in_own_bounds(laws: SolvedBatch, path: Path, t: Array) -> SolvedBatch:
    """The same laws with the multipliers of their own programs, in which bounds are units."""
    bounds = path.numbers(t).bounds
    for i in path.measured:
        laws.multiplier[:] = np.where(laws.family == i, laws.multiplier * bounds[:, i, None], laws.multiplier)
    return laws
