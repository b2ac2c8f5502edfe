"""What a synthesis of many problems returns: one value of arrays, that becomes an ordinary solution where asked."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import OptlawsError
from optlaws.extras import needed
from optlaws.files.reading import JsonText
from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.shown.summary import Row, Summary
from optlaws.synthesis.arrays.problems import ProblemArray
from optlaws.synthesis.limits.of_problem import known_limit
from optlaws.synthesis.problem.plain_entries import plain_entries
from optlaws.synthesis.solution import Solution, Status, measure
from optlaws.synthesis.solved_parts import SolvedPart, constant_of, stored_laws
from optlaws.synthesis.stored_solutions import check_status, plain_error, plain_state, read_solutions

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


NUMBERS = ("objective", "lower_bound", "gap", "B", "C", "D", "J", "rms_c")


@dataclass(frozen=True, eq=False, repr=False)
class SolutionArray(JsonText):
    """Optimal laws of many problems with their proofs, as arrays of the problems' shape; NaN where there is no law.

    An index gives an ordinary `Solution`, whose certificate is checked by itself, or raises the error of its problem;
    a slice gives a smaller array. Numbers are recomputed from the laws over the whole interval; immutable.

    Attributes
    ----------
    problems
        What was solved.
    parts
        Optima that were found together, in the terms of their programs.
    others
        Solutions of problems that were solved alone, and errors of those without a law, by their places in the
        flattened array.
    seconds
        The wall time of all.

    Examples
    --------
    >>> import numpy as np
    >>> from optlaws import ProblemArray, synthesize_array
    >>> laws = synthesize_array(ProblemArray(B=np.array([1.6, 1.62]), order=4))
    >>> laws.objective.round(6).tolist(), (laws.status == "optimal").tolist()
    ([5.262224, 5.173677], [True, True])
    >>> round(laws[1].objective, 6), laws[1].certificate.bound <= laws[1].objective
    (5.173677, True)
    """

    _json_name: ClassVar[str] = "an array of solutions"

    problems: ProblemArray
    parts: tuple[SolvedPart, ...]
    others: Mapping[int, Solution | OptlawsError] = field(repr=False)
    seconds: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "others", MappingProxyType(dict(self.others)))

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the problems."""
        return self.problems.shape

    @property
    def size(self) -> int:
        """The number of problems."""
        return self.problems.size

    def __len__(self) -> int:
        return len(self.problems)

    def __iter__(self) -> Iterator[Any]:
        return (self[i] for i in range(len(self)))

    def __getitem__(self, index: Any) -> Any:  # noqa: ANN401 - what numpy takes
        """The solution at a place, or the solutions of several as an array.

        Raises
        ------
        InfeasibleProblem, SolverFailure, InputError
            If the problem at that place has no law, none was found, or it is no problem.
        IndexError
            If there is no such place.
        """
        places = np.arange(self.size).reshape(self.shape)[index]
        if np.ndim(places):
            return self._taken(places)
        result = self.result(int(places))
        if isinstance(result, OptlawsError):
            raise result
        return result

    def result(self, place: int) -> Solution | OptlawsError:
        """The solution at a place of the flattened array, or the error that `synthesize` raises for its problem."""
        if place in self.others:
            return self.others[place]
        part, row = int(self._part_of[place]), int(self._row_of[place])
        return self.parts[part].solution(row, self.problems.problem(place), self.seconds / max(self.size, 1))

    @kept_property
    def objective(self) -> Array:
        """The objective of each law, recomputed from it."""
        return self._gathered(lambda part: part.found.objective, lambda solution: solution.objective)

    @kept_property
    def lower_bound(self) -> Array:
        """What is proven that no law of each problem is below."""
        return self._gathered(lambda part: part.found.bound, lambda solution: solution.lower_bound)

    @kept_property
    def gap(self) -> Array:
        """(objective - lower bound) / objective; as a share of its scale where the objective is 0 but for rounding."""
        scale = self._gathered(
            lambda part: np.full(len(part.places), part.model.problem.objective.scale),
            lambda solution: solution.problem.objective.scale,
        )
        return _frozen((self.objective - self.lower_bound) / measure(self.objective, scale))

    @kept_property
    def status(self) -> NDArray[np.object_]:
        """The `Status` of each solution; infeasible, failed or invalid where there is no law."""
        statuses = np.full(self.size, Status.OPTIMAL, dtype=object)
        for part in self.parts:
            statuses[part.places] = part.statuses
        for place, result in self.others.items():
            statuses[place] = result.status if isinstance(result, Solution) else Status.of(result)
        return _frozen(statuses.reshape(self.shape))

    @kept_property
    def errors(self) -> Mapping[int, OptlawsError]:
        """Why there is no law, by places in the flattened array."""
        return MappingProxyType({i: result for i, result in self.others.items() if isinstance(result, OptlawsError)})

    @kept_property
    def limit(self) -> Array:
        """What no law of the problem's order and bounds can beat, of any degree; NaN where it is not known."""
        limits = np.full(self.size, np.nan)
        for place in np.flatnonzero(~np.isnan(self.objective.reshape(-1))).tolist():
            known = known_limit(self.problems.problem(place))
            limits[place] = np.nan if known is None else known
        return _frozen(limits.reshape(self.shape))

    def stored_laws(self) -> list[dict[str, Any] | None]:
        """Each law as its `to_dict` gives it, in the order of the flattened array; None where there is none."""
        laws: list[dict[str, Any] | None] = [None] * self.size
        for part in self.parts:
            for place, law in zip(part.places.tolist(), stored_laws(part.model.space, part.coordinates), strict=True):
                laws[place] = law
        for place, result in self.others.items():
            laws[place] = result.law.to_dict() if isinstance(result, Solution) else None
        return laws

    @kept_property
    def z_series(self) -> Array:
        """Chebyshev coefficients of Z in 2k - 1, along the last axis; NaN beyond the end of shorter ones."""
        return self._rows(lambda part: part.z_series, lambda solution: np.array(solution.z_series))

    @kept_property
    def z(self) -> Array:
        """Coefficients of Z in each problem's basis, along the last axis; NaN beyond the end of shorter ones."""
        return self._rows(lambda part: part.z, lambda solution: np.array(solution.z or ()))

    @property
    def coefficients(self) -> Array:
        """Coefficients of Z in each problem's basis, along the last axis: `z`."""
        return self.z

    @kept_property
    def B(self) -> Array:
        """Peak velocity of each law."""
        return self._constant("B")

    @kept_property
    def C(self) -> Array:
        """Peak acceleration of each law."""
        return self._constant("C")

    @kept_property
    def D(self) -> Array:
        """Peak power of each law."""
        return self._constant("D")

    @kept_property
    def J(self) -> Array:
        """Peak jerk of each law."""
        return self._constant("J")

    @kept_property
    def rms_c(self) -> Array:
        """Root mean square of the acceleration of each law."""
        return self._constant("rms_c")

    @kept_property
    def contacts(self) -> dict[str, NDArray[Any]]:
        """Where rows bind in the certificates, contacts along the last axis: "constraint", "sign", "k", "multiplier".

        Laws with fewer contacts than others have "" and NaN beyond their end.
        """
        columns: dict[str, list[tuple[NDArray[np.intp], NDArray[Any]]]] = {}
        for places, rows in [*((part.places, part.contacts) for part in self.parts), *self._contacts_alone()]:
            for name, values in rows.items():
                columns.setdefault(name, []).append((places, values))
        most = max((values.shape[1] for _, values in columns.get("k", [])), default=0)
        return {name: _frozen(self._filled(rows, most)) for name, rows in columns.items()}

    def _contacts_alone(self) -> Iterator[tuple[NDArray[np.intp], dict[str, NDArray[Any]]]]:
        for place, result in self.others.items():
            if isinstance(result, Solution):
                rows = result.certificate.contacts
                columns = {"constraint": np.array([[row.constraint for row in rows]], dtype=object)}
                for name in ("sign", "k", "multiplier"):
                    columns[name] = np.array([[getattr(row, name) for row in rows]])
                yield np.array([place]), columns

    def _filled(self, rows: list[tuple[NDArray[np.intp], NDArray[Any]]], most: int) -> NDArray[Any]:
        texts = any(values.dtype == object for _, values in rows)
        filled = np.full((self.size, most), "" if texts else np.nan, dtype=object if texts else np.float64)
        for places, values in rows:
            filled[places, : values.shape[1]] = values
        return filled.reshape(*self.shape, most)

    def to_pandas(self) -> pd.DataFrame:
        """A table with a row for each problem: what varies, the numbers and the status; needs pandas."""
        needed("pandas", "to_pandas")
        import pandas as pd

        varied = {name: arrays[0] for name, arrays in self.problems.varied.items() if len(arrays) == 1}
        columns = {**{_asked(name): values for name, values in varied.items()}, **self._columns}
        return pd.DataFrame({name: values.reshape(-1) for name, values in columns.items()})

    def to_xarray(self) -> xr.Dataset:
        """A dataset over the axes of the problems: numbers, statuses, coefficients and contacts; needs xarray.

        An axis along which one entry of numbers varies has its name and its values, such as "B asked"; others are
        "axis 0", "axis 1", ....
        """
        needed("xarray", "to_xarray")
        import xarray as xr

        dims, coords = _axes(self.problems)
        variables: dict[str, Any] = {name: (dims, values) for name, values in self._columns.items()}
        variables["z_series"] = ([*dims, "coefficient"], self.z_series)
        variables |= {f"contact {name}": ([*dims, "contact"], values) for name, values in self.contacts.items()}
        return xr.Dataset(variables, coords)

    @property
    def _columns(self) -> dict[str, NDArray[Any]]:
        return {**{name: getattr(self, name) for name in NUMBERS}, "status": self.status.astype(str)}

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict: each solution or error in the order of the flattened array, and the arrays themselves.

        `optlaws verify` checks each solution, and `from_dict` reads it again.
        """
        results = [self.result(place) for place in range(self.size)]
        alone = {
            str(place): plain_state(result) for place, result in self.others.items() if isinstance(result, Solution)
        }
        return {
            "shape": list(self.shape),
            "seconds": self.seconds,
            "solutions": [
                result.claims() if isinstance(result, Solution) else plain_error(result) for result in results
            ],
            "problems": plain_entries(self.problems.entries) if self.problems.entries else None,
            "parts": [
                {
                    "places": part.places.tolist(),
                    "problem": part.model.problem.to_dict(),
                    "found": part.found.to_dict(),
                }
                for part in self.parts
            ],
            "alone": alone,
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> SolutionArray:
        """Read what `to_dict` wrote, from JSON or as it is.

        Raises
        ------
        InputError
            If an entry is missing or wrong, or one states what does not follow from problems, laws and proofs.

        Examples
        --------
        >>> import numpy as np
        >>> from optlaws import ProblemArray, synthesize_array
        >>> laws = synthesize_array(ProblemArray(B=np.array([1.6, 1.62]), order=4))
        >>> SolutionArray.from_dict(laws.to_dict())[1] == laws[1]
        True
        """
        stored = read_solutions(data)
        parts = tuple(SolvedPart(places, model, laws) for places, model, laws in stored.parts)
        made = cls(stored.problems, parts, stored.others, stored.seconds)
        for place, status in enumerate(stored.statuses):
            check_status(status, made.result(place), f"solutions[{place}]")
        return made

    def summary(self) -> Summary:
        """How many laws of each status there are, and between what objectives and gaps lie, as rows.

        Examples
        --------
        >>> from optlaws import ProblemArray, synthesize_array
        >>> laws = synthesize_array(ProblemArray(B=[1.05, 1.7, 1.8], order=4))
        >>> [(row.name, row.text(5)) for row in laws.summary()][:4]
        [('problems', '3'), ('infeasible', '1'), ('optimal', '2'), ('objective', '...')]
        """
        names, counts = np.unique(self.status.astype(str), return_counts=True)
        rows = [Row("problems", self.size, note=f"shape {self.shape}"), *map(Row, names.tolist(), counts.tolist())]
        for name, values in (("objective", self.objective), ("gap", self.gap)):
            known = values[np.isfinite(values)]
            if known.size:
                rows.append(Row(name, (float(known.min()), float(known.max()))))
        return Summary(rows)

    def _repr_html_(self) -> str:
        from optlaws.shown.showing import drawing, page

        values = self.objective
        line = values.ndim == 1 and len(values) > 1
        drawings = [drawing("objective", list(range(len(values))), values.tolist())] if line else []
        return page("SolutionArray", self.summary()._repr_html_(), *drawings)

    def __repr__(self) -> str:
        names, counts = np.unique(self.status.astype(str), return_counts=True)
        told = ", ".join(f"{count} {name}" for name, count in zip(names.tolist(), counts.tolist(), strict=True))
        return f"SolutionArray(shape={self.shape}, {told}, problems={self.problems!r})"

    @kept_property
    def _part_of(self) -> NDArray[np.intp]:
        return self._placed(lambda i, part: np.full(len(part.places), i))

    @kept_property
    def _row_of(self) -> NDArray[np.intp]:
        return self._placed(lambda _, part: np.arange(len(part.places)))

    def _placed(self, values: Callable[[int, SolvedPart], NDArray[np.intp]]) -> NDArray[np.intp]:
        numbers = np.full(self.size, -1, dtype=np.intp)
        for i, part in enumerate(self.parts):
            numbers[part.places] = values(i, part)
        return numbers

    def _gathered(self, of_part: Callable[[SolvedPart], Array], of_solution: Callable[[Solution], float]) -> Array:
        values = np.full(self.size, np.nan)
        for part in self.parts:
            values[part.places] = of_part(part)
        for place, result in self.others.items():
            if isinstance(result, Solution):
                values[place] = of_solution(result)
        return _frozen(values.reshape(self.shape))

    def _rows(self, of_part: Callable[[SolvedPart], Array], of_solution: Callable[[Solution], Array]) -> Array:
        rows = [(part.places, of_part(part)) for part in self.parts]
        rows += [
            (np.array([i]), of_solution(result)[None])
            for i, result in self.others.items()
            if isinstance(result, Solution)
        ]
        return _frozen(self._filled(rows, max((values.shape[1] for _, values in rows), default=0)))

    def _constant(self, name: str) -> Array:
        alone = self.problems.one_objective
        return self._gathered(
            lambda part: part.constant(name, one_objective=alone), lambda solution: constant_of(solution.law, name)
        )

    def _taken(self, places: NDArray[np.intp]) -> SolutionArray:
        flat = places.ravel()
        parts = []
        for i, part in enumerate(self.parts):
            mine = np.flatnonzero(self._part_of[flat] == i)
            if len(mine):
                parts.append(SolvedPart(mine, part.model, part.found.taken(self._row_of[flat[mine]]).frozen()))
        others = {i: self.others[place] for i, place in enumerate(flat.tolist()) if place in self.others}
        share = self.seconds * len(flat) / max(self.size, 1)
        return SolutionArray(self.problems.taken(places), tuple(parts), others, share)


def _frozen(values: NDArray[Any]) -> NDArray[Any]:
    values.setflags(write=False)
    return values


def _axes(problems: ProblemArray) -> tuple[list[str], dict[str, Any]]:
    """Names of the problems' axes, and the values along those that have one entry of numbers alone."""
    dims = [f"axis {i}" for i in range(len(problems.shape))]
    coords = {}
    for name, arrays in problems.varied.items():
        strides = [i for i, step in enumerate(arrays[0].strides) if step and problems.shape[i] > 1]
        alone = len(arrays) == 1 and len(strides) == 1 and arrays[0].dtype.kind in "fiu"
        if alone and dims[strides[0]].startswith("axis "):
            dims[strides[0]] = _asked(name)
            coords[_asked(name)] = np.moveaxis(arrays[0], strides[0], 0).reshape(problems.shape[strides[0]], -1)[:, 0]
    return dims, coords


def _asked(name: str) -> str:
    """What a column of an entry's values is called beside the numbers of the laws."""
    return f"{name} asked" if name in NUMBERS else name
