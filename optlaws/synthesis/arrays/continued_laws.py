"""The laws of a path at many t: from the states that the walk left, each proven optimal by itself.

Where a structure's places and multipliers do not depend on t its laws are affine in t, and two that are verified
verify all between: constraints are convex, and what multipliers prove is affine. Elsewhere a state is interpolated
between Chebyshev nodes and one step of Newton's method makes it exact.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.numerics.chebyshev import nodes as chebyshev_nodes
from optlaws.synthesis.arrays.certification import Certification, certification_of
from optlaws.synthesis.arrays.continuation import ParametricContinuation, StructureSegment, segment_at
from optlaws.synthesis.arrays.dual_bounds import lower_bounds
from optlaws.synthesis.arrays.newton_steps import States, Structure, clipped, converged, packed, step
from optlaws.synthesis.arrays.programs import NO_CONTACT, Numbers, Path, SolvedBatch
from optlaws.synthesis.method.stored_structures import StoredStructure, guess_of, is_usual, key_of, stored_structures
from optlaws.tolerances import AGREEMENT

_INTERPOLATION_TAIL = 1e-7  # of the size of what is interpolated: one step of Newton's method makes the square of it
_CERTIFIED_GAP = 1e-10  # of an objective: laws of an array whose bound leaves no more are proven
_ROUGH_STEP = 1e-7  # of a law: a step of more than this share is followed by another
_BEYOND_SEGMENT = 2e-3  # of the path: how far beyond a segment its laws are tried, where no segment is known

_NODES = 16
_DEEPEST = 12
#: no more laws than these are worth nodes of their own
_FEW = 20
#: laws at a time, and bytes of their matrices
_CHUNKS = (128, 1024)
_AT_HAND = 2**21
#: so many laws are quicker from stored structures than by a walk
_WITH_STORED = 4096
#: fewer laws than these are worth no walk
WALKED = 48
_STORED_NODES = 4
#: contacts beyond the number of variables that a law may have
_SPARE = 4
_STARTS = np.array([0.5, 0.25, 0.75, 0.0, 1.0])


def laws_along(path: Path, t: Array, segments: Callable[[], list[StructureSegment]] | None = None) -> SolvedBatch:
    """The optima at ascending t, as far as the continuation proves them; on given segments where it is walked.

    >>> from optlaws.synthesis.arrays.programs import between
    >>> from optlaws import Problem
    >>> path = between(Problem(B=1.6, order=4), Problem(B=1.7, order=4))
    >>> laws_along(path, np.array([0.0, 0.2])).objective.round(6).tolist()
    [5.262224, 5.173677]
    """
    stored = _stored_along(path, t) if len(t) <= _WITH_STORED else None
    laws = None if stored is None else _laws_of_stored_structures(path, t, stored)
    if laws is not None and laws.solved.all():
        return laws
    if laws is not None or (len(t) < WALKED and segments is None):
        return _laws_of_neighbours(path, t, laws)
    return laws_on(path, segments_of(path, float(t[0]), float(t[-1])) if segments is None else segments(), t)


def with_stored_structures(path: Path, t: Array, laws: SolvedBatch) -> NDArray[np.bool_]:
    """A mask of laws with the contacts that are stored for them, from which no search led to a better law."""
    alike = np.zeros(len(t), dtype=np.bool_)
    known = _stored_along(path, t)
    if known is None:
        return alike
    velocities = known.begin + t * (known.end - known.begin)
    for stored in known.structures:
        rows = np.flatnonzero((velocities >= stored.begin) & (velocities <= stored.end) & laws.solved)
        count = stored.count
        alone = (laws.family[rows, count:] == NO_CONTACT).all(axis=1)
        pairs = ((laws.family, stored.family), (laws.sign, stored.sign), (laws.free, stored.free))
        equal = [(values[rows, :count] == entry).all(axis=1) for values, entry in pairs if values.shape[1] >= count]
        alike[rows] |= alone & np.logical_and.reduce(equal) if len(equal) == len(pairs) else False
    return alike


@dataclass(frozen=True, eq=False)
class _StoredAlong:
    """The structures that are stored for problems of a path, which differ in B, and the nearest one at each t."""

    path: Path
    begin: float  #: the B at t = 0
    end: float  #: the B at t = 1
    structures: tuple[StoredStructure, ...]
    nearest: NDArray[np.intp]

    def guess(self, i: int, t: Array) -> tuple[Structure, States]:
        """One of the structures, and states of it at ascending t."""
        path, stored = self.path, self.structures[i]
        nodes = t if len(t) <= _STORED_NODES else (t[0] + t[-1] + (t[-1] - t[0]) * chebyshev_nodes(_STORED_NODES)) / 2.0
        structure = Structure(path.model, stored.family, stored.sign, stored.free)
        velocities = self.begin + nodes * (self.end - self.begin)
        known = zip(nodes.tolist(), velocities.tolist(), strict=True)
        rows = [packed(guess_of(path.program(at), stored, B)) for at, B in known]
        guess = States.unpacked(_barycentric(nodes, t) @ np.array(rows), structure)
        still = rows[0][path.model.program.size :][: stored.count]
        return structure, replace(guess, u=np.where(stored.free, guess.u, still))


def _stored_along(path: Path, t: Array) -> _StoredAlong | None:
    """The structures that are stored for problems of a path; None where none are."""
    first, last = path.problems
    if not isinstance(first.B, float) or not isinstance(last.B, float):
        return None
    if first.shape != last.shape or not is_usual(path.model):
        return None
    structures = stored_structures(key_of(path.model) or "")
    away = np.array([stored.away(first.B + t * (last.B - first.B)) for stored in structures])
    return _StoredAlong(path, first.B, last.B, structures, np.argmin(away, axis=0))


def _laws_of_stored_structures(path: Path, t: Array, known: _StoredAlong) -> SolvedBatch:
    """The optima at ascending t, as far as structures that are stored lead to them."""
    program, structures = path.model.program, known.structures
    laws = SolvedBatch.none(len(t), program.size, max(stored.count for stored in structures), len(program.right))
    for beside in (0, -1, 1):
        left = ~laws.solved
        for i in np.unique(known.nearest[left] + beside).tolist():
            if 0 <= i < len(structures):
                places = np.flatnonzero(left & (known.nearest + beside == i))
                structure, guess = known.guess(i, t[places])
                _enter(laws, path, structure, places, (t[places], guess))
    return laws


def _laws_of_neighbours(path: Path, t: Array, known: SolvedBatch | None = None) -> SolvedBatch:
    """The optima at ascending t, each structure tried at all that are left, and the next computed beside them.

    Of few laws this is quicker than a walk, which finds where structures change. Some may be known.
    """
    program = path.model.program
    most = program.size + _SPARE
    laws = SolvedBatch.none(len(t), program.size, most, len(program.right)) if known is None else known.wider(most)
    untried = np.ones(len(t), dtype=np.bool_)
    while (place := _next_place(laws.solved, untried)) is not None:
        untried[place] = False
        solved = np.flatnonzero(laws.solved)
        near = laws.active_set(int(solved[np.argmin(np.abs(solved - place))])) if len(solved) else None
        # beyond the laws of stored structures there may be none, and to find that takes long
        between = known is None or not len(solved) or bool(solved[0] < place < solved[-1])
        segment = segment_at(path, float(t[place]), near, anew=between)
        if segment is not None and segment.structure.count <= laws.u.shape[1]:
            left = np.flatnonzero(~laws.solved)
            _enter(laws, path, segment.structure, left, (t[left], segment.interpolated(t[left])))
    return _in_own_bounds(laws, path, t)


def _next_place(solved: NDArray[np.bool_], untried: NDArray[np.bool_]) -> int | None:
    """An unsolved place beside a solved one, or of some where nothing is solved; None where none is left."""
    open_ = ~solved & untried
    if not solved.any():
        starts = np.round(_STARTS * (len(solved) - 1)).astype(np.intp)
        return next((place for place in starts.tolist() if open_[place]), None)
    beside = np.zeros(len(solved), dtype=np.bool_)
    beside[1:] |= solved[:-1]
    beside[:-1] |= solved[1:]
    return next(iter(np.flatnonzero(open_ & beside).tolist()), None)


def segments_of(path: Path, least: float, greatest: float) -> list[StructureSegment]:
    """The structures between two t, by ascending t, as far as they are known."""
    return ParametricContinuation(path, least, greatest).whole(least + _STARTS * (greatest - least))


def laws_on(path: Path, segments: list[StructureSegment], t: Array) -> SolvedBatch:
    """The optima at ascending t on segments that are known."""
    most = max((segment.structure.count for segment in segments), default=0)
    program = path.model.program
    laws = SolvedBatch.none(len(t), program.size, most, len(program.right))
    for segment in segments:
        places = np.flatnonzero((t >= segment.begin) & (t <= segment.end))
        if len(places):
            _fill(laws, path, segment, places, t[places])
    beside = _BEYOND_SEGMENT * (segments[-1].end - segments[0].begin) if segments else 0.0
    for segment in segments:
        # what lies between two segments is tried with both
        places = np.flatnonzero((t >= segment.begin - beside) & (t <= segment.end + beside) & ~laws.solved)
        if len(places):
            _enter(laws, path, segment.structure, places, (t[places], segment.interpolated(t[places])))
    return _in_own_bounds(laws, path, t)


def _in_own_bounds(laws: SolvedBatch, path: Path, t: Array) -> SolvedBatch:
    """The same laws with the multipliers of their own programs, in which bounds are units."""
    bounds = path.numbers(t).bounds
    for i in path.measured:
        laws.multiplier[:] = np.where(laws.family == i, laws.multiplier * bounds[:, i, None], laws.multiplier)
    return laws


def _fill(laws: SolvedBatch, path: Path, segment: StructureSegment, places: NDArray[np.intp], t: Array) -> None:
    if segment.structure.affine and path.one_cost and segment.begin < segment.end:
        _affine(laws, path, segment, places, t)
        return
    for some, guess in _guesses(path, segment, t, (segment.begin, segment.end)):
        _enter(laws, path, segment.structure, places[some], (t[some], guess))


def _enter(
    target: SolvedBatch, path: Path, structure: Structure, places: NDArray[np.intp], near: tuple[Array, States]
) -> None:
    """Add laws at some t, with nearby states, as far as they are proven."""
    (t, guess), size = near, _chunk(structure)
    for i in range(0, len(t), size):
        some = slice(i, i + size)
        laws = _LawsOfStructure(target, path, structure, places[some], path.numbers(t[some]))
        laws.solve(guess.taken(some))


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
    places: NDArray[np.intp]
    numbers: Numbers

    def solve(self, guess: States) -> None:
        """Enter the laws that one step of Newton's method from a guess leads to, or several, as far as proven."""
        states, sizes = step(self.structure, self.numbers, guess)
        rough = np.flatnonzero(np.isfinite(sizes) & (sizes > _ROUGH_STEP))
        if len(rough):
            better, sizes[rough] = step(self.structure, self.numbers.taken(rough), states.taken(rough))
            rows = states.packed
            rows[rough] = better.packed
            states = States.unpacked(rows, self.structure)
        left = self.entered(states, np.flatnonzero(np.isfinite(sizes)), lambda certification: certification.sharp)
        if len(left):
            rest = replace(self, places=self.places[left], numbers=self.numbers.taken(left))
            states, done = converged(self.structure, rest.numbers, guess.taken(left))
            rest.entered(states, np.flatnonzero(done), lambda certification: certification.sound)

    def entered(
        self, states: States, known: NDArray[np.intp], proven: Callable[[Certification], NDArray[np.bool_]]
    ) -> NDArray[np.intp]:
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


def _guesses(
    path: Path, segment: StructureSegment, t: Array, ends: tuple[float, float], depth: int = 0
) -> Iterator[tuple[NDArray[np.intp], States]]:
    """States interpolated at parameters t, on pieces of the segment as short as they need to be."""
    begin, end = ends
    within = np.flatnonzero((t <= end) & ((t > begin) | (begin == segment.begin)))
    if not len(within):
        return
    piece = segment.pieces.get(ends)
    if piece is None and ends not in segment.pieces:
        if len(within) <= _FEW or begin >= end or depth == _DEEPEST:
            yield within, segment.interpolated(t[within])
            return
        piece = segment.pieces[ends] = _piece(path, segment, ends)
    if piece is not None:
        nodes, rows = piece
        yield within, segment.states(_barycentric(nodes, t[within]) @ rows)
        return
    middle = (begin + end) / 2.0
    yield from _guesses(path, segment, t, (begin, middle), depth + 1)
    yield from _guesses(path, segment, t, (middle, end), depth + 1)


def _piece(path: Path, segment: StructureSegment, ends: tuple[float, float]) -> tuple[Array, Array] | None:
    """Nodes and their states, if the polynomial through these is near to all states between; else they are joined."""
    middle, half = sum(ends) / 2.0, (ends[1] - ends[0]) / 2.0
    nodes = middle + half * np.cos(np.arange(_NODES) * np.pi / (_NODES - 1))[::-1]
    nodes[0], nodes[-1] = ends
    states, done = converged(segment.structure, path.numbers(nodes), segment.interpolated(nodes))
    rows = states.packed
    if done.all() and _settled(rows):
        return nodes, rows
    segment.joined(nodes[done], rows[done])
    return None


def _settled(rows: Array) -> bool:
    """Whether the polynomial through values at Chebyshev nodes has hardly any share of the highest degrees."""
    angle = np.arange(_NODES) * np.pi / (_NODES - 1)
    weights = np.ones(_NODES)
    weights[[0, -1]] = 0.5
    highest = np.cos(np.outer(np.arange(_NODES - 4, _NODES), angle)) * weights @ rows * (2.0 / (_NODES - 1))
    return bool((np.abs(highest) <= _INTERPOLATION_TAIL * np.maximum(1.0, np.abs(rows).max(axis=0))).all())


def _affine(laws: SolvedBatch, path: Path, segment: StructureSegment, places: NDArray[np.intp], t: Array) -> None:
    """Enter laws between the ends of a segment along which they are affine."""
    structure = segment.structure
    ends = States.unpacked(segment.rows[[0, -1]], structure)
    numbers = path.numbers(np.array([segment.begin, segment.end]))
    excess = float(certification_of(path, structure, numbers, ends).excess.max())
    share = ((t - segment.begin) / (segment.end - segment.begin))[:, None]
    first = ends.taken(slice(0, 1))
    x = ends.x[0] + share * (ends.x[1] - ends.x[0])
    value = structure.jets(first.x, first.u)[0]
    value[:, :, :-1] -= structure.slack
    numbers = path.numbers(t)
    bound = lower_bounds(path, structure, numbers, first, value)
    objective = path.model.unit * (x @ numbers.cost[0])
    sound = np.abs(objective - bound) <= _CERTIFIED_GAP * np.maximum(np.abs(objective), AGREEMENT * path.model.unit)
    end_parts = (np.broadcast_to(part, (len(t), part.shape[1])) for part in (first.u, first.weights, first.equations))
    states = States(x, *end_parts).taken(sound)
    _put(laws, structure, places[sound], states, (objective[sound], bound[sound], np.full(int(sound.sum()), excess)))


def _put(
    laws: SolvedBatch,
    structure: Structure,
    places: NDArray[np.intp],
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


def _barycentric(nodes: Array, t: Array) -> Array:
    """The matrix from values at nodes to values at t of the polynomial through them."""
    if len(nodes) == 1:
        return np.ones((len(t), 1))
    span = (nodes[-1] - nodes[0]) / 4.0
    apart = (nodes[:, None] - nodes) / span
    np.fill_diagonal(apart, 1.0)
    weights = 1.0 / apart.prod(axis=1)
    away = (t[:, None] - nodes) / span
    hit = away == 0.0
    shares = weights / np.where(hit, 1.0, away)
    shares = np.where(hit.any(axis=1)[:, None], hit, shares)
    return np.asarray(shares / shares.sum(axis=1)[:, None])
