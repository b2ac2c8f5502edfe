"""The structures of a path, one after the other: where each holds, and states from which every law of it is near.

A structure is walked along from a law that has it, as far as laws of it are proven optimal; there a single event
changes it, and the law just beyond shows the next one.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import isnan, prod

import numpy as np
from numpy.typing import NDArray

from optlaws.numbers import Array
from optlaws.synthesis.arrays.certification import certification_of
from optlaws.synthesis.arrays.newton_steps import States, Structure, clipped, converged, structure_of
from optlaws.synthesis.arrays.programs import Path
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.method.contacts import polished
from optlaws.synthesis.method.exchange import solve
from optlaws.tolerances import AT_END, VALUE_ROUNDING

_ASTRAY = 1e-3  # so near to an event no more than this can be broken: where more is, Newton's method went astray
_EVENT_WIDTH = 5e-8  # of the path: an event is known to lie in no wider a stretch
_LOST_EVENT_WIDTH = 1e-5  # of the path: the same where Newton's method ends, and nothing tells where the event is
_BETWEEN_SEGMENTS = 9e-8  # of the path: a longer stretch between two segments is walked from its other end too
_SAME_STATE = 1e-5  # of a segment: states nearer to each other are one of those that others are interpolated between

#: of the path: the first stride
_FIRST = 0.02
_STRIDES = np.array([0.25, 0.5, 1.0, 2.0, 4.0, 8.0])
_CLOSER = np.array([1e-1, 1e-2, 1e-4, 1e-6])
#: laws beyond an event that tell where it is
_KNOWN = 3
_ROUNDS = 24
_NEAR = 4
#: states that are nearer to each other than this share of the way to where one is guessed are as one
_APART = 0.2
_MOST = 400
#: contacts that are nearer to each other may be two of one
_SAME = 0.02
_BEYOND = (4e-8, 1e-6, 1e-4, 1e-3)


@dataclass(eq=False)
class StructureSegment:
    """A stretch of the path on which the laws have one structure, with states of some of them by ascending t.

    `pieces` are stretches of it, by their ends: t and states of nodes, where the polynomial through these is near to
    all states between, or None, where it is not.
    """

    structure: Structure
    t: Array
    rows: Array
    pieces: dict[tuple[float, float], tuple[Array, Array] | None] = field(default_factory=dict, repr=False)

    @property
    def begin(self) -> float:
        """The least t at which a law is known."""
        return float(self.t[0])

    @property
    def end(self) -> float:
        """The greatest t at which a law is known."""
        return float(self.t[-1])

    def guessed(self, t: Array) -> States:
        """States at other t, by the polynomial through some that are known near to each."""
        return self.states(np.array([self._weights(number) for number in t.tolist()]) @ self.rows)

    def states(self, rows: Array) -> States:
        """States from rows that were interpolated, in which places that may not move are exactly where they are."""
        states = States.unpacked(rows, self.structure)
        known = States.unpacked(self.rows[:1], self.structure)
        return replace(states, u=np.where(self.structure.free, states.u, known.u))

    def _weights(self, t: float) -> Array:
        """Weights of known states at t: the nearest one, and others that are not too near to each other."""
        known = self.t.tolist()
        order = np.argsort(np.abs(self.t - t)).tolist()
        least = _APART * abs(known[order[0]] - t)
        chosen = [order[0]]
        for i in order[1:]:
            if len(chosen) == _NEAR:
                break
            if all(abs(known[i] - known[j]) > least for j in chosen):
                chosen.append(i)
        weights = np.zeros(len(known))
        for i in chosen:
            weights[i] = prod((t - known[j]) / (known[i] - known[j]) for j in chosen if j != i)
        return weights

    def interpolated(self, t: Array) -> States:
        """States between those that are known, by the polynomial through the nearest on both sides."""
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
        return self.states(np.einsum("tn,tnk->tk", weights, self.rows[chosen]))

    def joined(self, t: Array, rows: Array) -> None:
        """A continuation with further states."""
        every, unique = np.unique(np.concatenate([self.t, t]), return_index=True)
        self.t, self.rows = every, np.concatenate([self.rows, rows])[unique]


def segment_at(path: Path, t: float, near: ActiveSet | None, *, anew: bool = True) -> StructureSegment | None:
    """The structure at one t, as a segment of one law; None where none is proven optimal.

    Where the contacts of a nearby law do not lead to it, it is sought `anew`.
    """
    program = path.program(t)
    optimum = solve(program, near).optimum if anew or near is None else polished(program, near, None)
    return None if optimum is None else ParametricContinuation(path, t, t).begun(t, optimum)


@dataclass(eq=False)
class ParametricContinuation:
    """A path of solutions along a parameter, as the segments that are known so far."""

    #: path, least, greatest: along what, and between which t
    path: Path
    least: float
    greatest: float
    segments: list[StructureSegment] = field(default_factory=list)  #: in the order in which they were found

    @property
    def reach(self) -> float:
        """The length of the continued range."""
        return self.greatest - self.least

    def whole(self, starts: Array) -> list[StructureSegment]:
        """All segments from one end to the other, by ascending t, as far as they are known."""
        for t in starts.tolist():
            first = segment_at(self.path, t, None)
            if first is not None:
                self._onward(first, self.greatest)
                self._onward(first, self.least)
                break
        self.segments.sort(key=lambda segment: segment.begin)
        return self.segments

    def begun(self, t: float, optimum: ActiveSet) -> StructureSegment | None:
        """A segment that begins with one law; None where that is not proven optimal."""
        merged = optimum.merged(_SAME)
        for candidate in (optimum,) if merged is optimum else (optimum, merged):
            structure, order = structure_of(self.path.model, candidate)
            state = (
                candidate.x,
                _on_ends(structure, candidate.u[order]),
                candidate.multipliers[order],
                candidate.equality_multipliers,
            )
            rows, sound, _ = self._solved(structure, np.array([t]), States(*(part[None] for part in state)))
            if sound[0]:
                return StructureSegment(structure, np.array([t]), rows)
        return None

    def _onward(self, first: StructureSegment, goal: float) -> None:
        """Continuation from a segment to one end of the path."""
        segment, way = first, np.sign(goal - first.begin)
        if first not in self.segments:
            self.segments.append(first)
        while way != 0.0 and len(self.segments) < _MOST:
            beyond = self._stretched(segment, goal)
            if beyond is None:
                return
            following = self._after(segment, beyond, goal)
            if following is None:
                return
            edge = segment.end if way > 0.0 else segment.begin
            if abs(following.begin - edge) > _BETWEEN_SEGMENTS * self.reach:
                self._stretched(following, edge)
            segment = following
            self.segments.append(segment)

    def _after(self, segment: StructureSegment, beyond: float, goal: float) -> StructureSegment | None:
        """The segment on the other side of an event; None where the search there fails."""
        way = np.sign(goal - beyond) or 1.0
        edge = segment.end if way > 0.0 else segment.begin
        near = self._active_set(segment, edge)
        for share in (0.0, *_BEYOND):
            t = beyond + way * share * self.reach
            if (goal - t) * way < 0.0:
                return None
            optimum = polished(self.path.program(t), near, None)
            begun = None if optimum is None else self.begun(t, optimum)
            if begun is not None and (begun.structure.signature != segment.structure.signature or share == _BEYOND[-1]):
                return begun
        return segment_at(self.path, t, near)

    @staticmethod
    def _active_set(segment: StructureSegment, t: float) -> ActiveSet:
        structure = segment.structure
        state = States.unpacked(segment.rows[segment.t == t], structure)
        return ActiveSet(
            state.x[0],
            structure.family,
            state.u[0],
            structure.sign,
            structure.free,
            state.weights[0],
            state.equations[0],
        )

    def _stretched(self, segment: StructureSegment, goal: float) -> float | None:
        """Continuation of a segment toward an end of the path as far as it holds; a t just beyond, or None."""
        good, way = (segment.end, 1.0) if goal >= segment.end else (segment.begin, -1.0)
        # laws of an affine structure are known at any distance
        bad, stride = goal, self.reach if segment.structure.affine and self.path.one_cost else _FIRST * self.reach
        broken: list[tuple[float, float]] = []
        near = _EVENT_WIDTH * self.reach
        for _ in range(_ROUNDS):
            t = _probes(good, bad, way * stride, broken)
            rows, sound, worst = self._solved(segment.structure, t, segment.guessed(t))
            count = len(t) if sound.all() else int(np.argmin(sound))
            if count:
                segment.joined(t[:count], rows[:count])
                stride = max(2.0 * abs(float(t[count - 1]) - good), stride / 4.0)
                good = float(t[count - 1])
            else:
                stride = abs(float(t[0]) - good) / 4.0
            if good == goal:
                return None
            known = [
                (at, off) for at, off in zip(t[count:].tolist(), worst[count:].tolist(), strict=True) if not isnan(off)
            ]
            if known:
                broken = sorted([*broken, *known], key=lambda pair: abs(pair[0] - good))[:_KNOWN]
                bad = broken[0][0]
            near = (_EVENT_WIDTH if broken else _LOST_EVENT_WIDTH) * self.reach
            if min(abs(bad - good), stride) <= near:
                if not broken or broken[0][1] <= _ASTRAY or not self._met(segment, bad):
                    break
                good, bad, broken = bad, goal, []
                stride = _FIRST * self.reach
                if good == goal:
                    return None
        return bad if abs(bad - good) <= near else good + way * near

    def _met(self, segment: StructureSegment, t: float) -> bool:
        """Whether a law of the segment exists at a nearby t; it is then stored."""
        rows, sound, _ = self._solved(segment.structure, np.array([t]), segment.guessed(np.array([t])))
        if sound[0]:
            segment.joined(np.array([t]), rows)
        return bool(sound[0])

    def _solved(self, structure: Structure, t: Array, guess: States) -> tuple[Array, NDArray[np.bool_], Array]:
        """States at some t, which of them are proven optimal, and what is most broken where Newton's method ends."""
        numbers = self.path.numbers(t)
        states, done = converged(structure, numbers, guess)
        rows = states.packed
        sound, worst = np.zeros(len(t), dtype=np.bool_), np.full(len(t), np.nan)
        if done.any():
            clipped_states = clipped(structure, states.taken(done))
            verdicts = certification_of(self.path, structure, numbers.taken(done), clipped_states)
            inside = np.abs(clipped_states.u - states.u[done]).max(axis=1, initial=0.0)
            sound[done] = verdicts.sound & (inside <= VALUE_ROUNDING)
            worst[done] = np.maximum(verdicts.broken, inside)
        return rows, sound, worst


def _on_ends(structure: Structure, u: Array) -> Array:
    """The places with those that may not move on the ends of their domains, off which rounding may have put them."""
    ends = structure.domains
    nearest = np.where(np.abs(u - ends[:, 0]) < np.abs(u - ends[:, 1]), ends[:, 0], ends[:, 1])
    return np.where(~structure.free & (np.abs(u - nearest) < AT_END), nearest, u)


def _probes(good: float, bad: float, stride: float, broken: list[tuple[float, float]]) -> Array:
    """Next parameters beyond a valid law: around the first violation, or some steps further on."""
    probes = good + stride * _STRIDES
    if len(broken) > 1:
        near, event = broken[0][0], _event(broken)
        if event is not None:
            probes = np.concatenate([probes[:2], event + (near - event) * _CLOSER, event + (good - event) * _CLOSER])
    elif len(broken) == 1:
        probes = np.concatenate([probes, bad + (good - bad) * _CLOSER])
    low, high = min(good, bad), max(good, bad)
    inner = probes[(low < probes) & (probes < high)]
    if not broken:
        # nothing is known to be broken short of the end
        inner = np.append(inner, bad) if abs(probes[-1] - good) >= abs(bad - good) else inner
    elif not len(inner):
        inner = np.array([(good + bad) / 2.0])
    probes = np.unique(inner)
    return probes if bad > good else probes[::-1]


def _event(broken: list[tuple[float, float]]) -> float | None:
    """The parameter at which a violation begins, by the polynomial through it; None if it does not grow."""
    t, off = zip(*broken, strict=True)
    count = len(off)
    while count > 1 and not all(more > less > 0.0 for less, more in pairwise(off[:count])):
        count -= 1
    if count == 1:
        return None
    shares = [prod(off[j] / (off[j] - off[i]) for j in range(count) if j != i) for i in range(count)]
    return float(np.dot(t[:count], shares))


def gaps(segments: list[StructureSegment]) -> list[tuple[float, float]]:
    """Stretches between segments in which no law is known."""
    return [(segment.end, other.begin) for segment, other in pairwise(segments) if other.begin > segment.end]
