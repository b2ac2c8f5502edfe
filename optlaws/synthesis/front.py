"""Laws of which none is better in every constant."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import OptlawsError
from optlaws.extras import needed
from optlaws.files.reading import JsonText
from optlaws.kept import kept_property
from optlaws.laws import PolynomialLaw
from optlaws.numbers import Array
from optlaws.numerics.tolerances import AGREEMENT
from optlaws.synthesis.families.peaks import of_polynomials
from optlaws.synthesis.problem.fields import CONSTANTS
from optlaws.synthesis.problem.named_constants import named, title_of
from optlaws.synthesis.solution import Solution

_OF_POINTS = ("lower bound", "gap", "limit", "status")
#: of fronts of B, C, D and J
HEADINGS = (*CONSTANTS, *_OF_POINTS)

_SHOWN = 12
#: from so many laws on constants are computed for all at once
_MANY = 16
_BLOCK = 256
#: constants that are computed for many laws at once
IN_ARRAYS = ("B", "C", "D", "J", "rms_c")


@dataclass(frozen=True)
class Front(JsonText):
    """Laws of which none is better in every constant: each the best of its own problem.

    Attributes
    ----------
    over
        The constants exchanged; the last is minimised, the others are given.
    points
        The solutions, by ascending values of the first constant.
    errors
        Why there is no law, by values of the first constant.

    Examples
    --------
    >>> from optlaws.synthesis import Problem
    >>> from optlaws.synthesis.pareto import pareto_front
    >>> front = pareto_front(Problem(order=4), over=("B", "C"), points=5, between=(1.5, 1.8))
    >>> front
    Front(over=('B', 'C'), 5 points, B 1.5 to 1.8, C 5.70496 to 4.69579)
    >>> front.values.shape, max(solution.gap for solution in front) < 1e-8
    ((5, 2), True)
    """

    _json_name: ClassVar[str] = "a front"

    over: tuple[str, ...]
    points: tuple[Solution, ...]
    errors: Mapping[float, OptlawsError] = field(default_factory=dict, repr=False, compare=False)

    @property
    def failed(self) -> tuple[float, ...]:
        """Values of the first constant at which no law was found, ascending."""
        return tuple(sorted(self.errors))

    @kept_property
    def values(self) -> Array:
        """The constants of each point: one row a point, one column a constant of `over`."""
        return values_of(self.points, self.over)

    @property
    def headings(self) -> tuple[str, ...]:
        """What the rows have: B, C, D and J, what else is exchanged, and how good each point is."""
        return (*map(title_of, self._columns), *_OF_POINTS)

    @property
    def _columns(self) -> tuple[str, ...]:
        return (*CONSTANTS, *(name for name in self.over if name not in CONSTANTS))

    @property
    def rows(self) -> list[list[float | str | None]]:
        """What `headings` name, a row for each point."""
        return self.rows_of(self._columns)

    def rows_of(self, columns: Sequence[str]) -> list[list[float | str | None]]:
        """Constants of each point, with its lower bound, its gap, its limit and its status."""
        return [
            [
                *(value_of(point, name) for name in columns),
                point.lower_bound,
                point.gap,
                point.limit,
                point.status.value,
            ]
            for point in self.points
        ]

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:  # noqa: ANN401 - matplotlib's
        """Draw the points into matplotlib's axes, new ones unless given; a third constant as colour; the artists."""
        from optlaws.plots.front import draw_front

        return draw_front(self, ax, **style)

    def to_pandas(self) -> Any:  # noqa: ANN401 - pandas is imported here alone
        """The rows as a data frame, a line for each point; needs the extra `optlaws[studies]`.

        Examples
        --------
        >>> from optlaws.synthesis import Problem
        >>> from optlaws.synthesis.pareto import pareto_front
        >>> front = pareto_front(Problem(order=4), over=("B", "C"), points=3, between=(1.5, 1.8))
        >>> front.to_pandas()[["B", "C", "status"]].round(4).to_dict("list")
        {'B': [1.5, ..., 1.8], 'C': [5.705, ..., 4.6958], 'status': ['optimal', 'optimal', 'optimal']}
        """
        needed("pandas", "to_pandas")
        import pandas as pd

        return pd.DataFrame(self.rows, columns=list(self.headings))

    def to_xarray(self) -> Any:  # noqa: ANN401 - xarray is imported here alone
        """The rows as a dataset along the points, with the coordinates of the exchanged constants; needs xarray.

        Examples
        --------
        >>> from optlaws.synthesis import Problem
        >>> from optlaws.synthesis.pareto import pareto_front
        >>> front = pareto_front(Problem(order=4), over=("B", "C"), points=3, between=(1.5, 1.8))
        >>> front.to_xarray().C.sel(B=1.8, method="nearest").round(4).item()
        4.6958
        """
        needed("xarray", "to_xarray")
        import xarray as xr

        first, *others = map(title_of, self.over)
        columns = dict(zip(self.headings, zip(*self.rows, strict=True), strict=True))
        data = {name: (first, list(values)) for name, values in columns.items() if name != first}
        exchanged = {name: data.pop(name) for name in others[:-1]}
        return xr.Dataset(data, {first: list(columns[first]), **exchanged})

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict with every solution whole: `optlaws verify` checks it, `from_dict` reads it again."""
        from optlaws.synthesis.stored_solutions import plain_error

        return {
            "over": list(self.over),
            "values": self.values.tolist(),
            "points": [point.to_dict() for point in self.points],
            "failed": list(self.failed),
            "errors": [plain_error(self.errors[value]) for value in self.failed],
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Front:
        """Read what `to_dict` wrote; constants are computed from the laws and held against the values.

        Raises
        ------
        InputError
            If an entry is missing or wrong, or one states what does not follow from problems, laws and proofs.
        """
        from optlaws.synthesis.stored_solutions import read_front

        return read_front(data)

    def __len__(self) -> int:
        return len(self.points)

    def __iter__(self) -> Iterator[Solution]:
        return iter(self.points)

    def __getitem__(self, place: int) -> Solution:
        return self.points[place]

    def __repr__(self) -> str:
        over = tuple(map(title_of, self.over))
        ends = [f"{name} {v[0]:.6g} to {v[-1]:.6g}" for name, v in zip(over, self.values.T, strict=True)]
        return f"Front(over={over!r}, {len(self)} points, {', '.join(ends)})"

    def _repr_html_(self) -> str:
        from optlaws.shown.showing import drawing, page, table

        rows = self.rows[:: 1 + len(self) // _SHOWN]
        curve = ""
        if len(self.over) == len(("given", "minimised")):
            x, y = self.values.T
            first, last = map(title_of, self.over)
            curve = drawing(f"{last} over {first}", x.tolist(), (y - y.min()).tolist())
        return page(repr(self), table(self.headings, rows), curve)


def undominated(solutions: Sequence[Solution], over: Sequence[str], values: Array | None = None) -> list[Solution]:
    """Those than which no other is better in one constant and as good in all, by ascending constants.

    Parameters
    ----------
    solutions, over
        The solutions, and the names of the constants.
    values
        Of the constants, a row for each solution; found from the laws unless they are known.

    Examples
    --------
    >>> from optlaws.synthesis import Problem, sweep
    >>> solutions = list(sweep(Problem(B=B, order=4) for B in (1.6, 1.8, 2.2)))
    >>> [solution.problem.B for solution in undominated(solutions, ("B", "C"))]
    [1.6, 1.8]
    """
    points = values_of(solutions, over) if values is None else values
    order = np.lexsort(points.T[::-1])
    order = order[~_beaten(points[order])]
    rows, kept = points[order].tolist(), [0]
    for i in range(1, len(order)):
        if not _known_already(rows, kept, i):
            kept.append(i)
    return [solutions[order[i]] for i in kept]


def _beaten(values: Array) -> NDArray[np.bool_]:
    """Which rows another is better than in one constant, and no worse in all."""
    kept = np.zeros(len(values), dtype=np.bool_)
    for begin in range(0, len(values), _BLOCK):
        some = values[begin : begin + _BLOCK]
        no_worse, better = np.ones((len(some), len(values)), np.bool_), np.zeros((len(some), len(values)), np.bool_)
        for own, others in zip(some.T, values.T, strict=True):
            no_worse &= others <= (own * (1.0 + AGREEMENT))[:, None]
            better |= others < (own * (1.0 - AGREEMENT))[:, None]
        kept[begin : begin + _BLOCK] = (no_worse & better).any(axis=1)
    return kept


def _known_already(rows: Sequence[Sequence[float]], kept: Sequence[int], place: int) -> bool:
    """Whether a row is one of those that are kept; the rows ascend in their first entry."""
    row = rows[place]
    for other in map(rows.__getitem__, reversed(kept)):
        if abs(other[0] / row[0] - 1.0) > AGREEMENT:
            return False
        if all(abs(value / own - 1.0) <= AGREEMENT for value, own in zip(other, row, strict=True)):
            return True
    return False


def value_of(solution: Solution, name: str) -> float:
    """A constant of a solution's law.

    Examples
    --------
    >>> from optlaws.synthesis import Problem, synthesize
    >>> round(value_of(synthesize(Problem(B=1.641, order=4)), "C"), 6)
    5.080702
    """
    return named(name).value(solution.law)


def values_of(solutions: Sequence[Solution], names: Sequence[str]) -> Array:
    """Constants of the laws of many solutions: one row a solution, one column a constant.

    Examples
    --------
    >>> from optlaws.synthesis import Problem, sweep
    >>> values_of(list(sweep([Problem(B=1.6, order=4), Problem(B=1.8, order=4)])), ("B", "C")).round(4).tolist()
    [[1.6, 5.2622], [1.8, 4.6958]]
    """
    return np.column_stack([_column(solutions, name) for name in names])


def _column(solutions: Sequence[Solution], name: str) -> Array:
    if all(repr(solution.problem.objective) == name for solution in solutions):
        return np.array([solution.objective for solution in solutions])
    laws = [solution.law for solution in solutions]
    polynomials = [law for law in laws if isinstance(law, PolynomialLaw)]
    if len(laws) >= _MANY and name in IN_ARRAYS and len(polynomials) == len(laws):
        return of_polynomials(polynomials, name)
    return np.array([value_of(solution, name) for solution in solutions])
