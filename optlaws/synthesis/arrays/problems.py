"""A problem whose numbers are arrays: a problem for each element of their common shape."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from math import prod
from typing import Any, TypedDict, Unpack

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import keywords_of, shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.numbers import MOST_VELOCITY, Array
from optlaws.synthesis.problem.problem import Problem

#: what `Problem` takes for an entry, or arrays of it
Entry = Any
#: of an entry that `Problem` fills in
NOT_GIVEN = ...


class ProblemArrayEntries(TypedDict, total=False):
    """The entries of a problem, each a value or arrays of it."""

    B: Entry
    order: Entry
    basis: Entry
    minimise: Entry
    monotone: Entry
    symmetric: Entry
    C: Entry
    D: Entry
    J: Entry
    boundary: Entry
    windows: Entry
    bounds: Entry
    inflexion: Entry


class ProblemArray:
    """Problems that differ in their entries' numbers: any entry of `Problem` may be an array, or hold some.

    Arrays are those of numpy, lists, ranges, and whatever numpy makes arrays of, such as a Series of pandas. They are
    broadcast against each other as numpy does, and each place of their common shape is one problem. What is no array
    is the same for all of them: a pair (low, high) is a tuple, for a list of two numbers is an array; a list of
    windows alone is a value. Values other than numbers come in arrays of `map_arrays`. The array is immutable;
    nothing is checked before a problem is read, so that a wrong number spoils its own place alone.

    Parameters
    ----------
    B, C, D, J, minimise, order, bounds, inflexion, basis, monotone, symmetric, boundary, windows
        As `Problem` takes them, dimensionless: `B=np.linspace(1.5, 2.5, 1000)`, `J=(None, jerks)` for upper bounds,
        `bounds={"rms_c": (None, sizes)}`, `minimise=map_arrays("{:.17g}*C/4 + J/32".format, weights)`. What is not
        given is as `Problem` has it.

    Raises
    ------
    InputError
        If the arrays do not fit together, or a list has rows of several lengths.

    Examples
    --------
    >>> problems = ProblemArray(B=[1.6, 1.7, 1.8], order=4)
    >>> problems.shape, problems[1]
    ((3,), Problem(B=1.7, order=4, basis=Chebyshev(degree=9), minimise='C'))
    >>> ProblemArray(B=np.array([1.6, 1.7]), J=(None, np.array([[60.0], [70.0], [80.0]])), order=4).shape
    (3, 2)
    """

    @keywords_of(ProblemArrayEntries, **dict.fromkeys(ProblemArrayEntries.__annotations__, NOT_GIVEN))
    def __init__(self, **entries: Unpack[ProblemArrayEntries]) -> None:
        self._entries = {
            name: _frozen(value if name == "windows" else _with_arrays(value, name))
            for name, value in entries.items()
            if value is not NOT_GIVEN
        }
        arrays = {name: list(_arrays(value)) for name, value in self._entries.items()}
        try:
            shape = np.broadcast_shapes(
                *(array.shape for arrays_of_name in arrays.values() for array in arrays_of_name)
            )
        except ValueError:
            shapes = ", ".join(
                f"{name} {array.shape}" for name, arrays_of_name in arrays.items() for array in arrays_of_name
            )
            raise InputError(
                f"the arrays of a ProblemArray must be of one shape when broadcast, got {shapes}"
            ) from None
        self._shape: tuple[int, ...] = tuple(shape)

    @classmethod
    def of(cls, problems: Sequence[Problem | None], shape: tuple[int, ...] | None = None) -> ProblemArray:
        """Existing problems as an array of a given shape; None where they have no common form.

        Examples
        --------
        >>> ProblemArray.of([Problem(B=1.6, order=4), Problem(B=1.7, order=4)]).shape
        (2,)
        """
        array = cls()
        array._shape = (len(problems),) if shape is None else shape
        array._given = tuple(problems)
        return array

    _given: tuple[Problem | None, ...] | None = None

    @property
    def shape(self) -> tuple[int, ...]:
        """The common shape of the entries' arrays; () for scalars."""
        return self._shape

    @property
    def size(self) -> int:
        """The number of problems in the array."""
        return prod(self._shape)

    @property
    def entries(self) -> dict[str, Any]:
        """The given entries, with arrays unchanged."""
        return dict(self._entries)

    @kept_property
    def varied(self) -> dict[str, tuple[NDArray[Any], ...]]:
        """The entries that hold arrays, with these, each of the common shape."""
        arrays_by_name = {name: tuple(_arrays(value)) for name, value in self._entries.items()}
        return {
            name: tuple(np.broadcast_to(array, self._shape) for array in arrays)
            for name, arrays in arrays_by_name.items()
            if arrays
        }

    def __len__(self) -> int:
        if not self._shape:
            raise TypeError("a ProblemArray without arrays has no length")
        return self._shape[0]

    def __iter__(self) -> Iterator[Any]:
        return (self[i] for i in range(len(self)))

    def __getitem__(self, index: Any) -> Any:
        """A problem by its indices; an array of problems where the index selects several.

        Raises
        ------
        InputError
            If the entries at that place make no problem.
        IndexError
            If there is no such place.
        """
        places = np.arange(self.size).reshape(self._shape)[index]
        return self.problem(int(places)) if np.ndim(places) == 0 else self.taken(places)

    def problem(self, place: int) -> Problem:
        """The problem at a place, counted in the order of the flattened array.

        Raises
        ------
        InputError
            If the entries at that place make no problem.
        """
        if self._given is not None:
            given = self._given[place]
            if given is None:
                raise InputError(f"what was at place {place} is no problem")
            return given
        if self.velocities is not None and not np.isnan(self.velocities[place]) and self._first is not None:
            return self._first.at_velocity(float(self.velocities[place]))
        at = np.unravel_index(place, self._shape)

        def there(array: NDArray[Any]) -> Any:
            return _plain(np.broadcast_to(array, self._shape)[at])

        return Problem(**{name: _mapped(value, there) for name, value in self._entries.items()})

    @kept_property
    def _first(self) -> Problem | None:
        """A problem from which the others differ in B alone; None if the other entries are arrays too."""
        try:
            return Problem(**{**self._entries, "B": 2.0})
        except InputError:
            return None

    def taken(self, places: NDArray[np.intp]) -> ProblemArray:
        """The problems at some places of the flattened array, in their shape."""
        if self._given is not None:
            return ProblemArray.of([self._given[i] for i in places.ravel()], places.shape)
        flat = places.ravel()
        entries = {
            name: _mapped(
                value, lambda array: np.broadcast_to(array, self._shape).reshape(-1)[flat].reshape(places.shape)
            )
            for name, value in self._entries.items()
        }
        array = ProblemArray(**entries)
        array._shape = places.shape
        return array

    @kept_property
    def one_objective(self) -> bool:
        """Whether all problems have the same objective."""
        if self._given is None:
            return "minimise" not in self.varied
        return len({repr(problem.objective) for problem in self._given if isinstance(problem, Problem)}) <= 1

    @kept_property
    def velocities(self) -> Array | None:
        """The B of each problem, flattened, where numbers for B are all that varies; NaN where it can be no B."""
        if self._given is not None or self.varied.keys() != {"B"} or not isinstance(self._entries["B"], np.ndarray):
            return None
        given = self._entries["B"]
        if given.dtype.kind not in "fiu":
            return None
        values = np.broadcast_to(given, self._shape).reshape(-1).astype(np.float64)
        return np.where((values > 1.0) & (values <= MOST_VELOCITY), values, np.nan)

    def __repr__(self) -> str:
        parts = [
            f"{name}={shortened(_mapped(value, lambda array: f'array of shape {array.shape}'))}"
            for name, value in self._entries.items()
        ]
        if self._given is not None:
            parts = [f"{len(self._given)} problems"]
        return f"ProblemArray({', '.join(parts)})"


def map_arrays(function: Callable[..., Any], *arrays: Any) -> NDArray[Any]:
    """The values of a function at each place of some arrays, broadcast against each other: an array of any objects.

    Examples
    --------
    >>> from optlaws import at_most
    >>> map_arrays(at_most, np.array([60.0, 70.0])).tolist()
    [at_most(60.0), at_most(70.0)]
    >>> map_arrays("{:g}*C/4 + J/32".format, np.array([0.5, 1.0])).tolist()
    ['0.5*C/4 + J/32', '1*C/4 + J/32']
    """
    try:
        given = np.broadcast_arrays(*(np.asarray(array) for array in arrays))
    except ValueError:
        raise InputError(
            f"the arrays must be of one shape when broadcast, got {[np.shape(array) for array in arrays]}"
        ) from None
    results = np.empty(given[0].shape if given else (), dtype=object)
    for at in np.ndindex(results.shape):
        results[at] = function(*(_plain(array[at]) for array in given))
    results.setflags(write=False)
    return results


def _with_arrays(value: Any, name: str) -> Any:
    """The value with arrays in place of array-like parts; a pair stays a pair."""
    if isinstance(value, Mapping):
        return {key: _with_arrays(entry, f"{name}[{key!r}]") for key, entry in value.items()}
    if isinstance(value, tuple) and len(value) == 2:
        return tuple(_with_arrays(entry, name) for entry in value)
    if isinstance(value, np.ndarray | np.generic | str):
        return value
    if isinstance(value, list | tuple | range) or hasattr(value, "__array__"):
        try:
            array = np.asarray(value)
        except ValueError:
            raise InputError(f"{name} has rows of several lengths, which are no array: {shortened(value)}") from None
        return array.astype(object) if array.dtype.kind in "US" else array
    if isinstance(value, Iterable):
        raise InputError(f"{name} takes many values as a list or an array, got {shortened(value)}")
    return value


def _arrays(value: Any) -> Iterator[NDArray[Any]]:
    if isinstance(value, np.ndarray):
        yield value
    elif isinstance(value, Mapping):
        for entry in value.values():
            yield from _arrays(entry)
    elif isinstance(value, list | tuple):
        for entry in value:
            yield from _arrays(entry)


def _mapped(value: Any, change: Callable[[NDArray[Any]], Any]) -> Any:
    """The value with each array in it changed."""
    if isinstance(value, np.ndarray):
        return change(value)
    if isinstance(value, Mapping) and any(True for _ in _arrays(value)):
        return {name: _mapped(entry, change) for name, entry in value.items()}
    if isinstance(value, list | tuple) and any(True for _ in _arrays(value)):
        return tuple(_mapped(entry, change) for entry in value)
    return value


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _frozen(value: Any) -> Any:
    """The value with copies of its arrays that nobody can write to."""

    def copied(array: NDArray[Any]) -> NDArray[Any]:
        copy = array.copy()
        copy.setflags(write=False)
        return copy

    return _mapped(value, copied)
