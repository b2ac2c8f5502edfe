"""The points of a study by their index, in an order in which neighbours differ little; none is kept."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from math import ceil, prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.numbers import MOST_POINTS, whole
from optlaws.studies.points.axes import Axis, axes
from optlaws.studies.points.study_file import StudyFile, entries
from optlaws.synthesis import FUNCTIONALS, Problem
from optlaws.synthesis.arrays.lines import least_count
from optlaws.synthesis.arrays.powers import least_power

# a cold start costs some warm ones; proofs of tight bounds cost more than any start
_CHUNK, _TIGHT_CHUNK, _CHUNKS = 64, 4, 16
#: of problems that are solved as arrays, where what many share costs most
_TOGETHER = 4096


@dataclass(frozen=True)
class Points:
    """The product of a study's axes.

    A point's index counts through the product, the last axis fastest. Points are solved in another order, in which
    every axis runs forth and back, so that each point differs from the one before it in one place of one axis.

    Examples
    --------
    >>> from optlaws.studies.points.study_file import read_study
    >>> points = Points.of(read_study({"problem": {}, "vary": {"B": [1.5, 1.6, 1.7], "order": [3, 4]}}))
    >>> len(points), points.inputs(4), [points.index(position) for position in range(6)]
    (6, {'order': 4, 'B': 1.6}, [0, 1, 2, 5, 4, 3])
    """

    study: StudyFile
    axes: tuple[Axis, ...]
    given: int | None = None

    @classmethod
    def of(cls, study: StudyFile, chunk: int | None = None) -> Points:
        """The points of a study, in chunks of a given size; InputError where they are more than a thousand million."""
        points = cls(study, tuple(axes(study)), chunk)
        whole(prod(points.shape), "the number of points", most=MOST_POINTS)
        return points

    def __len__(self) -> int:
        return prod(self.shape)

    @kept_property
    def shape(self) -> tuple[int, ...]:
        """The lengths of the axes."""
        return tuple(len(axis) for axis in self.axes)

    @kept_property
    def chunk(self) -> int:
        """How many points are solved in turn, or together; it depends on the study alone, so that results do."""
        if self.given is not None:
            return self.given
        most = _TIGHT_CHUNK if self.study.bound == "tight" else _TOGETHER if self._together else _CHUNK
        if self.study.chunk:
            return self.study.chunk
        wanted = min(most, ceil(len(self) / _CHUNKS))
        # neighbours along the last axis are on one line, which had better be whole
        line = self.shape[-1]
        return min(ceil(wanted / line) * line, most) if most == _TOGETHER and line <= wanted else wanted

    @property
    def _together(self) -> bool:
        """Whether every point is of a problem of which many are solved as arrays."""
        if not all(map(_only_numbers, self.study.names())):
            return False
        base, first = self.study.problem.given(), self.inputs(0)
        objectives = [value for axis in self.axes for value in axis.values("minimise")] or [base.get("minimise", "C")]
        try:
            asked = (Problem.from_dict(entries(base, {**first, "minimise": objective})) for objective in objectives)
            return all(
                problem.convex or (least_power(problem) and self.shape[-1] >= least_count(problem)) for problem in asked
            )
        except InputError:
            return False

    @property
    def chunks(self) -> int:
        """How many chunks there are."""
        return ceil(len(self) / self.chunk)

    def of_chunk(self, number: int) -> list[int]:
        """The indices of a chunk's points, in the order in which they are solved."""
        return list(self.chunk_inputs(number))

    def chunk_inputs(self, number: int) -> dict[int, dict[str, Any]]:
        """What varies at the points of a chunk, by their indices, in the order in which they are solved."""
        begin = number * self.chunk
        positions = np.arange(begin, min(begin + self.chunk, len(self)))
        digits = self._snake(positions)
        indices: list[int] = np.ravel_multi_index(tuple(digits), self.shape).tolist()
        columns: dict[str, list[Any]] = {}
        for axis, own in zip(self.axes, digits, strict=True):
            places, where = np.unique(own, return_inverse=True)
            for name, column in zip(axis.names, axis.columns, strict=True):
                values = [column[place] for place in places.tolist()]
                columns[name] = [values[i] for i in where.tolist()]
        rows = (dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True))
        return dict(zip(indices, rows, strict=True))

    def _snake(self, positions: NDArray[np.int64]) -> list[NDArray[np.int64]]:
        """The places on each axis of the points that are solved at these positions."""
        digits_by_axis, before = [], np.zeros_like(positions)
        for digits, length in zip(np.unravel_index(positions, self.shape), self.shape, strict=True):
            # an axis runs backwards where those before it have made an odd number of steps
            digits_by_axis.append(np.where(before % 2, length - 1 - digits, digits))
            before = before * length + digits
        return digits_by_axis

    def chunk_of(self, index: int) -> int:
        """The chunk in which a point is solved."""
        return int(self.chunks_of(np.array([index]))[0])

    def chunks_of(self, indices: NDArray[np.int64]) -> NDArray[np.int64]:
        """The chunks in which points are solved."""
        positions = np.zeros_like(indices)
        for digits, length in zip(np.unravel_index(indices, self.shape), self.shape, strict=True):
            positions = positions * length + np.where(positions % 2, length - 1 - digits, digits)
        return positions // self.chunk

    def index(self, position: int) -> int:
        """The index of the point that is solved at this position."""
        return int(np.ravel_multi_index(tuple(self._snake(np.array([position]))), self.shape)[0])

    def inputs(self, index: int) -> dict[str, Any]:
        """What varies, at one point."""
        digits = self._digits(index)
        return {
            name: value
            for axis, digit in zip(self.axes, digits, strict=True)
            for name, value in axis.inputs(digit).items()
        }

    def _digits(self, number: int) -> list[int]:
        digits = []
        for length in reversed(self.shape):
            number, digit = divmod(number, length)
            digits.append(digit)
        return digits[::-1]


def _only_numbers(name: str) -> bool:
    """Whether different values of what varies leave a convex problem convex."""
    if name == "D":
        return False
    constant = FUNCTIONALS.get(name.removeprefix("bounds."))
    return constant is None or constant.convex


def key(asked: Mapping[str, Any]) -> str:
    """What identifies a point whatever its study: a hash of the entries of its problem.

    Examples
    --------
    >>> key({"order": 4, "B": 1.8}) == key({"B": 1.8, "order": 4})
    True
    """
    return _hash(json.dumps(asked, sort_keys=True))


def keys_along(asked: Mapping[str, Any], name: str, values: Iterable[float]) -> Iterator[str]:
    """The keys of points that differ in one number.

    Examples
    --------
    >>> list(keys_along({"order": 4, "B": 1.8}, "B", [1.6])) == [key({"order": 4, "B": 1.6})]
    True
    """
    place = "\0"
    head, tail = json.dumps({**asked, name: place}, sort_keys=True).split(json.dumps(place))
    return (_hash(f"{head}{json.dumps(value)}{tail}") for value in values)


def _hash(text: str) -> str:
    return hashlib.blake2b(text.encode(), digest_size=8).hexdigest()
