"""The points of a study by their index, in an order in which neighbours differ little; none is kept."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil, prod
from typing import Any

from optlaws.kept import kept_property
from optlaws.numbers import MOST_POINTS, whole
from optlaws.studies.points.axes import Axis, axes
from optlaws.studies.points.study_file import StudyFile

# a cold start costs some warm ones; proofs of tight bounds cost more than any start
_CHUNK, _TIGHT_CHUNK, _CHUNKS = 64, 4, 16


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

    @classmethod
    def of(cls, study: StudyFile) -> Points:
        """The points of a study; InputError where they are more than a thousand million."""
        points = cls(study, tuple(axes(study)))
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
        """How many points are solved in turn; it depends on the study alone, so that results do."""
        most = _TIGHT_CHUNK if self.study.bound == "tight" else _CHUNK
        return self.study.chunk or min(most, ceil(len(self) / _CHUNKS))

    @property
    def chunks(self) -> int:
        """How many chunks there are."""
        return ceil(len(self) / self.chunk)

    def of_chunk(self, number: int) -> list[int]:
        """The indices of a chunk's points, in the order in which they are solved."""
        begin = number * self.chunk
        return [self.index(position) for position in range(begin, min(begin + self.chunk, len(self)))]

    def chunk_of(self, index: int) -> int:
        """The chunk in which a point is solved."""
        position = 0
        for digit, length in zip(self._digits(index), self.shape, strict=True):
            position = position * length + (length - 1 - digit if position % 2 else digit)
        return position // self.chunk

    def index(self, position: int) -> int:
        """The index of the point that is solved at this position."""
        index, before = 0, 0
        for digit, length in zip(self._digits(position), self.shape, strict=True):
            # an axis runs backwards where those before it have made an odd number of steps
            index = index * length + (length - 1 - digit if before % 2 else digit)
            before = before * length + digit
        return index

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


def key(asked: Mapping[str, Any]) -> str:
    """What identifies a point whatever its study: a hash of the entries of its problem.

    Examples
    --------
    >>> key({"order": 4, "B": 1.8}) == key({"B": 1.8, "order": 4})
    True
    """
    return hashlib.blake2b(json.dumps(asked, sort_keys=True).encode(), digest_size=8).hexdigest()
