"""The factors of a study's product: what varies together, and its values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, log
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from optlaws import numbers
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.numbers import real
from optlaws.studies.points.study_file import Sample, Span, Steps, StudyFile
from optlaws.synthesis.problem.fields import ENTRIES, Kind

#: kinds of entries that a range can run through; also numbers that fill a place in text
_NUMBERS = (Kind.CONSTANT, Kind.NUMBER, Kind.WHOLE)
_TYPES: dict[Kind, type] = {Kind.TEXT: str, Kind.BASIS: str, Kind.SWITCH: bool}

Columns = tuple[Sequence[Any], ...]


@dataclass(frozen=True)
class Axis:
    """Entries that vary together, each with its sequence of values."""

    names: tuple[str, ...]
    columns: Columns
    label: str

    def __len__(self) -> int:
        return len(self.columns[0])

    def values(self, name: str) -> Sequence[Any]:
        """The values of an entry; none where it does not vary here."""
        return self.columns[self.names.index(name)] if name in self.names else ()

    def inputs(self, place: int) -> dict[str, Any]:
        """The values at one place."""
        return {name: column[place] for name, column in zip(self.names, self.columns, strict=True)}


def kind_of(name: str) -> Kind:
    """What the values of whatever varies are: of an entry, of "bounds.NAME", or of a place in text.

    Examples
    --------
    >>> kind_of("degree").name, kind_of("bounds.rms_c").name, kind_of("w").name
    ('WHOLE', 'CONSTANT', 'NUMBER')
    """
    if name in ENTRIES:
        return ENTRIES[name].kind
    return Kind.CONSTANT if name.startswith("bounds.") else Kind.NUMBER


class Numbers(Sequence[float]):
    """The values of a range, made when they are asked for."""

    def __init__(self, name: str, steps: Steps) -> None:
        check_span(name, steps)
        self._name, self._steps, self._whole = name, steps, kind_of(name) is Kind.WHOLE
        if self._whole:
            numbers.whole(steps.steps, f"{name}: steps", most=numbers.MOST_DEGREE)
            for i in range(len(self)):
                whole(name, self._at(i))

    def __len__(self) -> int:
        return self._steps.steps

    @overload
    def __getitem__(self, place: int) -> float: ...
    @overload
    def __getitem__(self, place: slice) -> list[float]: ...
    def __getitem__(self, place: int | slice) -> float | list[float]:
        if isinstance(place, slice):
            return [self[i] for i in range(*place.indices(len(self)))]
        if not -len(self) <= place < len(self):
            raise IndexError(place)
        value = self._at(place % len(self))
        return whole(self._name, value) if self._whole else value

    def _at(self, place: int) -> float:
        return scaled(self._steps, place / max(1, len(self) - 1))


def scaled(span: Steps | Span, share: float) -> float:
    """The value at a share, 0 to 1, of a span; its ends exactly, and few digits where few are meant.

    Examples
    --------
    >>> scaled(Span(low=1.5, high=1.8, scale="linear"), 1 / 3), scaled(Span(low=1, high=100, scale="log"), 0.5)
    (1.6, 10.0)
    """
    if share in {0.0, 1.0}:
        return float(span.high if share else span.low)
    if span.scale == "log":
        value = exp((1.0 - share) * log(span.low) + share * log(span.high))
    else:
        value = (1.0 - share) * span.low + share * span.high
    return float(f"{value:.14g}")


def check_span(name: str, span: Steps | Span) -> None:
    """Refuse spans without values: infinite ends, logs of what is not above 0, entries that are no numbers."""
    if kind_of(name) not in _NUMBERS:
        raise InputError(f"{name} is no number: give a list of its values, not a range")
    if not (np.isfinite(span.low) and np.isfinite(span.high)):
        raise InputError(f"{name}: from and to must be finite, got {span.low!r} and {span.high!r}")
    if span.scale == "log" and min(span.low, span.high) <= 0.0:
        raise InputError(f"{name}: a log scale needs from and to above 0, got {span.low!r} and {span.high!r}")


def whole(name: str, value: Any) -> int:  # noqa: ANN401 - it is checked here
    """The value as an integer."""
    number = real(value)
    if number is None or not number.is_integer():
        raise InputError(f"{name} must be a whole number at every point, got {shortened(value)}")
    return int(number)


def axes(study: StudyFile) -> list[Axis]:
    """The factors in the order of the file, that of B last: neighbours along it start each other."""
    found_axes = [Axis((name,), (_column(name, values),), name) for name, values in study.vary.items()]
    for i, table in enumerate(study.together, 1):
        lengths = {len(values) for values in table.values()}
        if len(lengths) != 1:
            raise InputError(f"together: lists of one table must be of one length, got {sorted(lengths)}")
        columns = tuple(_column(name, values) for name, values in table.items())
        found_axes.append(Axis(tuple(table), columns, f"together {i}"))
    found_axes += [
        Axis(tuple(sampling.over), sampled(sampling), f"sample {i}") for i, sampling in enumerate(study.sample, 1)
    ]
    return sorted(found_axes, key=lambda axis: axis.names == ("B",))


def _column(name: str, values: list[Any] | Steps) -> Sequence[Any]:
    if isinstance(values, Steps):
        return Numbers(name, values)
    kind = kind_of(name)
    if kind is Kind.WHOLE:
        return [whole(name, value) for value in values]
    for value in values:
        if kind in _TYPES and not isinstance(value, _TYPES[kind]):
            raise InputError(f"{name} must be {kind.value}, got {shortened(value)}")
    return [float(value) if kind in _NUMBERS and real(value) is not None else value for value in values]


def sampled(sample: Sample) -> Columns:
    """The columns of a sample, in the order of its spans; the seed and SciPy's version fix them.

    Raises
    ------
    InputError
        If a Sobol sample is not of a power of 2 points, without which it is not balanced.
    """
    from scipy.stats import qmc

    for name, span in sample.over.items():
        check_span(name, span)
    count, size, random = sample.points, len(sample.over), np.random.default_rng(sample.seed)
    shares: NDArray[np.float64]
    if sample.kind == "sobol":
        if count & (count - 1):
            below = 1 << (count.bit_length() - 1)
            raise InputError(f"a Sobol sample needs a power of 2 points, such as {below} or {2 * below}, got {count}")
        shares = qmc.Sobol(size, seed=random).random(count)
    else:
        shares = qmc.LatinHypercube(size, seed=random).random(count)
    return tuple(_Spread(name, span, shares[:, i].copy()) for i, (name, span) in enumerate(sample.over.items()))


class _Spread(Sequence[float]):
    def __init__(self, name: str, span: Span, shares: NDArray[np.float64]) -> None:
        self._whole, self._span, self._shares = kind_of(name) is Kind.WHOLE, span, shares

    def __len__(self) -> int:
        return len(self._shares)

    @overload
    def __getitem__(self, place: int) -> float: ...
    @overload
    def __getitem__(self, place: slice) -> list[float]: ...
    def __getitem__(self, place: int | slice) -> float | list[float]:
        if isinstance(place, slice):
            return [self[i] for i in range(*place.indices(len(self)))]
        share = float(self._shares[place])
        if self._whole:
            # each whole number of the span has the same share
            return int(self._span.low) + int(share * (int(self._span.high) - int(self._span.low) + 1))
        return scaled(self._span, share)
