"""The points of a study by their index, in an order of small differences between neighbours; none is stored."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import ceil, exp, log, prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws import numbers
from optlaws.echo import shortened
from optlaws.entries.value_types import Number, Switch, Text, ValueType, Whole
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.studies.specification import Sample, SampleSpan, SteppedRange, StudyFile, constant_of, entries
from optlaws.synthesis import FUNCTIONALS, Problem
from optlaws.synthesis.arrays.lines import least_count, least_power
from optlaws.synthesis.problem.fields import ConstantBounds
from optlaws.synthesis.problem.problem import ENTRIES

#: types of entries that a range can run through; also numbers that fill a place in text
_NUMBERS = (ConstantBounds, Number, Whole)
# a cold start costs some warm ones; proofs of tight bounds cost more than any start
_CHUNK, _TIGHT_CHUNK, _CHUNKS = 64, 4, 16
#: of problems that are solved as arrays, where what many share costs most
_TOGETHER = 4096


@dataclass(frozen=True)
class StudyAxis:
    """A factor of the product: entries that vary together, each with its sequence of values."""

    label: str
    columns: Mapping[str, Sequence[Any]]

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))


def axes(study: StudyFile) -> list[StudyAxis]:
    """The factors in the order of the file, B last: neighbours along B start each other."""
    factors = [StudyAxis(name, {name: _column(name, values)}) for name, values in study.vary.items()]
    for i, table in enumerate(study.together, 1):
        lengths = {len(values) for values in table.values()}
        if len(lengths) != 1:
            raise InputError(f"together: lists of one table must be of one length, got {sorted(lengths)}")
        factors.append(StudyAxis(f"together {i}", {name: _column(name, values) for name, values in table.items()}))
    factors += [StudyAxis(f"sample {i}", _sampled(sample)) for i, sample in enumerate(study.sample, 1)]
    return sorted(factors, key=lambda axis: list(axis.columns) == ["B"])


def type_of(name: str) -> ValueType:
    """The type of a varying quantity's values: of an entry, of a bound ("at_most.NAME"), or of a placeholder in text.

    Examples
    --------
    >>> type_of("degree").words, type_of("at_most.rms_c").words, type_of("w").words
    ('a whole number from 0 to 200', 'a number, a pair [low, high] or "free"', 'a number')
    """
    if name in ENTRIES:
        return ENTRIES[name].type
    return Number() if constant_of(name) is None else ConstantBounds()


class _Lazy(Sequence[Any]):
    """Values computed when they are read, by their place."""

    def __init__(self, count: int, value: Callable[[int], float]) -> None:
        self._places, self._value = range(count), value

    def __len__(self) -> int:
        return len(self._places)

    def __getitem__(self, place: Any) -> Any:
        places = self._places[place]
        return [self._value(i) for i in places] if isinstance(place, slice) else self._value(places)


def _column(name: str, values: Sequence[Any] | SteppedRange) -> Sequence[Any]:
    """The values of an entry, checked and of its type."""
    type_ = type_of(name)
    if isinstance(values, SteppedRange):
        return _stepped(name, values)
    if isinstance(type_, Whole):
        return [_whole(name, value) for value in values]
    if isinstance(type_, Text | Switch):
        return [type_.read(value, name) for value in values]
    known = isinstance(type_, _NUMBERS)
    return [float(value) if known and numbers.real(value) is not None else value for value in values]


def _stepped(name: str, span: SteppedRange) -> _Lazy:
    """The values of a range."""
    _check_span(name, span)
    last = max(1, span.steps - 1)
    if not isinstance(type_of(name), Whole):
        return _Lazy(span.steps, lambda place: scaled(span, place / last))
    numbers.whole(span.steps, f"{name}: steps", most=numbers.MOST_DEGREE)
    values = _Lazy(span.steps, lambda place: _whole(name, scaled(span, place / last)))
    list(values)  # each must be one
    return values


def _sampled(sample: Sample) -> dict[str, _Lazy]:
    """The columns of a sample, in the order of its spans; the seed and SciPy's version fix them."""
    from scipy.stats import qmc

    for name, span in sample.over.items():
        _check_span(name, span)
    count, size, random = sample.points, len(sample.over), np.random.default_rng(sample.seed)
    if sample.kind == "sobol":
        if count & (count - 1):
            # it would not be balanced
            below = 1 << (count.bit_length() - 1)
            raise InputError(f"a Sobol sample needs a power of 2 points, such as {below} or {2 * below}, got {count}")
        shares = qmc.Sobol(size, seed=random).random(count)
    else:
        shares = qmc.LatinHypercube(size, seed=random).random(count)
    return {name: _spread(name, span, shares[:, i].copy()) for i, (name, span) in enumerate(sample.over.items())}


def _spread(name: str, span: SampleSpan, shares: NDArray[np.float64]) -> _Lazy:
    """Values at shares of a span; each whole number of the span has the same share."""
    if not isinstance(type_of(name), Whole):
        return _Lazy(len(shares), lambda place: scaled(span, float(shares[place])))
    low, high = int(span.low), int(span.high)
    return _Lazy(len(shares), lambda place: low + int(float(shares[place]) * (high - low + 1)))


def scaled(span: SteppedRange | SampleSpan, share: float) -> float:
    """The value at a share, 0 to 1, of a span; its ends exactly, and few digits where few are meant.

    Examples
    --------
    >>> (
    ...     scaled(SampleSpan(low=1.5, high=1.8, scale="linear"), 1 / 3),
    ...     scaled(SampleSpan(low=1, high=100, scale="log"), 0.5),
    ... )
    (1.6, 10.0)
    """
    if share in {0.0, 1.0}:
        return float(span.high if share else span.low)
    if span.scale == "log":
        value = exp((1.0 - share) * log(span.low) + share * log(span.high))
    else:
        value = (1.0 - share) * span.low + share * span.high
    return float(f"{value:.14g}")


def _check_span(name: str, span: SteppedRange | SampleSpan) -> None:
    """Refuse spans without values: logs of what is not above 0, entries that are no numbers."""
    if not isinstance(type_of(name), _NUMBERS):
        raise InputError(f"{name} is no number: give a list of its values, not a range")
    if span.scale == "log" and min(span.low, span.high) <= 0.0:
        raise InputError(f"{name}: a log scale needs from and to above 0, got {span.low!r} and {span.high!r}")


def _whole(name: str, value: Any) -> int:
    number = numbers.real(value)
    if number is None or not number.is_integer():
        raise InputError(f"{name} must be a whole number at every point, got {shortened(value)}")
    return int(number)


@dataclass(frozen=True)
class StudyPoints:
    """The product of a study's axes.

    A point's index counts through the product, the last axis fastest. Points are solved in another order, in which
    every axis runs forwards and backwards, so that each point differs from the one before it in one place of one axis.

    Examples
    --------
    >>> from optlaws.studies.specification import read_study
    >>> points = StudyPoints.of(read_study({"problem": {}, "vary": {"B": [1.5, 1.6, 1.7], "order": [3, 4]}}), 6)
    >>> len(points), points.inputs(4), list(points.of_chunk(0))
    (6, {'order': 4, 'B': 1.6}, [0, 1, 2, 5, 4, 3])
    """

    study: StudyFile
    axes: tuple[StudyAxis, ...]
    given: int | None = None

    @classmethod
    def of(cls, study: StudyFile, chunk: int | None = None) -> StudyPoints:
        """The points of a study, in chunks of a given size; InputError where they are more than a thousand million."""
        points = cls(study, tuple(axes(study)), chunk)
        numbers.whole(prod(points.shape), "the number of points", most=numbers.MOST_POINTS)
        return points

    def __len__(self) -> int:
        return prod(self.shape)

    @kept_property
    def shape(self) -> tuple[int, ...]:
        """The lengths of the axes."""
        return tuple(len(axis) for axis in self.axes)

    @kept_property
    def columns(self) -> dict[str, Sequence[Any]]:
        """The values along its axis of each entry that varies."""
        return {name: values for axis in self.axes for name, values in axis.columns.items()}

    @kept_property
    def chunk(self) -> int:
        """The number of points in a chunk; it depends on the study alone, so that results do too."""
        size = self.given or self.study.chunk
        if size is not None:
            return size
        most = _TIGHT_CHUNK if self.study.bound == "tight" else _TOGETHER if self._together else _CHUNK
        size = min(most, ceil(len(self) / _CHUNKS))
        # neighbours along the last axis are on one line, which had better be whole
        line = self.shape[-1]
        return min(ceil(size / line) * line, most) if most == _TOGETHER and line <= size else size

    @property
    def _together(self) -> bool:
        """Whether every point is of a problem of which many are solved as arrays."""
        if not all(map(_only_numbers, self.columns)):
            return False
        base, first = self.study.problem, self.inputs(0)
        objectives = self.columns.get("minimise") or [base.get("minimise", "C")]
        try:
            problems = (Problem.from_dict(entries(base, {**first, "minimise": objective})) for objective in objectives)
            return all(
                problem.convex or (least_power(problem) and self.shape[-1] >= least_count(problem))
                for problem in problems
            )
        except InputError:
            return False

    @property
    def chunks(self) -> int:
        return ceil(len(self) / self.chunk)

    def of_chunk(self, number: int) -> dict[int, dict[str, Any]]:
        """Varying quantities at the points of a chunk, by index, in the order of solution."""
        begin = number * self.chunk
        digits = self._snake(np.arange(begin, min(begin + self.chunk, len(self))))
        indices: list[int] = np.ravel_multi_index(tuple(digits), self.shape).tolist()
        columns: dict[str, list[Any]] = {}
        for axis, places in zip(self.axes, digits, strict=True):
            distinct, where = np.unique(places, return_inverse=True)
            for name, column in axis.columns.items():
                values = [column[place] for place in distinct.tolist()]
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

    def inputs(self, index: int) -> dict[str, Any]:
        """Values of the varying quantities at one point."""
        inputs: dict[str, Any] = {}
        for axis in reversed(self.axes):
            index, place = divmod(index, len(axis))
            inputs = {name: column[place] for name, column in axis.columns.items()} | inputs
        return inputs


def _only_numbers(name: str) -> bool:
    """Whether different values of what varies leave a convex problem convex."""
    constant = FUNCTIONALS.get(constant_of(name) or name)
    return name != "D" and (constant is None or constant.convex)


def key(problem: Mapping[str, Any]) -> str:
    """The key of a point, independent of its study: a hash of the entries of its problem."""
    return _hash(json.dumps(problem, sort_keys=True))


def keys_along(problem: Mapping[str, Any], name: str, values: Iterable[float]) -> Iterator[str]:
    """The keys of points that differ in one number.

    Examples
    --------
    >>> list(keys_along({"order": 4, "B": 1.8}, "B", [1.6])) == [key({"order": 4, "B": 1.6})]
    True
    """
    place = "\0"
    head, tail = json.dumps({**problem, name: place}, sort_keys=True).split(json.dumps(place))
    return (_hash(f"{head}{json.dumps(value)}{tail}") for value in values)


def _hash(text: str) -> str:
    return hashlib.blake2b(text.encode(), digest_size=8).hexdigest()
