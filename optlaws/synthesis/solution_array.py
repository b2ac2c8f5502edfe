"""The result of a synthesis of many problems: arrays, from which an index gives a solution."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from math import inf
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from optlaws.errors import OptlawsError, needed
from optlaws.files.reading import JsonText
from optlaws.kept import former_name, kept_property
from optlaws.laws import MotionLaw
from optlaws.numbers import Array
from optlaws.shown.summary import Row, Summary
from optlaws.synthesis.arrays.problems import ProblemArray
from optlaws.synthesis.arrays.programs import NO_CONTACT, SolvedBatch
from optlaws.synthesis.families.piece_series import by_pieces, constant_of_series
from optlaws.synthesis.limits.of_problem import known_limit
from optlaws.synthesis.problem.fields import CONSTANTS
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model
from optlaws.synthesis.proof.certificate import OBJECTIVE, Certificate
from optlaws.synthesis.proof.make import certificate, certify
from optlaws.synthesis.solution import Solution, partly_known
from optlaws.synthesis.spaces.bases import PiecewiseBasis, PolynomialBasis
from optlaws.synthesis.spaces.of_basis import PolynomialSpace
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.synthesis.status import Status, measure, status_of
from optlaws.synthesis.stored_rows import plain_error
from optlaws.tolerances import OPTIMALITY_GAP

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


NUMBERS = ("objective", "lower_bound", "gap", "B", "C", "D", "J", "rms_c")


@dataclass(frozen=True, eq=False)
class SolvedPart:
    """Problems of one kind that were solved together: their indices, their common program, and their optima."""

    places: NDArray[np.intp]
    model: Model
    optima: SolvedBatch

    @property
    def coordinates(self) -> Array:
        return self.optima.x[:, : self.model.space.terms]

    @property
    def statuses(self) -> NDArray[np.object_]:
        """Optimal, but where the problem is not convex and the bound does not meet the objective."""
        optimal = np.full(len(self.places), Status.OPTIMAL, dtype=object)
        if self.model.problem.convex:
            return optimal
        size = measure(self.optima.objective, self.model.problem.objective.scale)
        off = np.abs(self.optima.objective - self.optima.bound) > OPTIMALITY_GAP * size
        optimal[off] = Status.LOCAL
        return optimal

    @property
    def z_series(self) -> Array:
        """Chebyshev coefficients of Z in 2k - 1, law by law."""
        space = self.model.space
        base = space.z_series(np.zeros(space.terms))
        columns = np.array([space.z_series(unit) for unit in np.eye(space.terms)]).reshape(space.terms, -1)
        return np.asarray(self.coordinates @ (columns - base) + base)

    @property
    def z(self) -> Array:
        """Coefficients of Z in the problems' basis, law by law."""
        basis = self.model.problem.basis
        if not isinstance(basis, PolynomialBasis | PiecewiseBasis):
            return np.empty((len(self.places), 0))
        return np.array([basis.coefficients(series) for series in self.z_series])

    def constant(self, name: str, *, one_objective: bool) -> Array:
        """A constant of each law; `one_objective` states that all problems have the first one's objective."""
        if one_objective and repr(self.model.problem.objective) == name:
            return self.optima.objective
        space = self.model.space
        if not isinstance(space, PolynomialSpace):
            return np.array([constant_of(space.law(coordinate), name) for coordinate in self.coordinates])
        laws = [space.series(nu) for nu in (1, 2, 3)]

        def of(coordinates: Array) -> Array:
            b, c, j = (coordinates @ series[:, :-1].T + series[:, -1] for series in laws)
            return constant_of_series(name, b, c, j)

        return by_pieces(of, self.coordinates)

    @property
    def contacts(self) -> dict[str, NDArray[Any]]:
        """Contacts of the laws as columns."""
        laws, families = self.optima, self.model.program.families
        names = np.array([*(family.name for family in families), ""], dtype=object)
        none = laws.family == NO_CONTACT
        k = np.full(laws.u.shape, np.nan)
        for i, family in enumerate(families):
            here = laws.family == i
            k[here] = np.clip(family.k(laws.u[here]), 0.0, 1.0)
        # of the problem's own rows, as certificates have them
        units = np.array([*(self.model.unit / family.unit for family in families), 1.0])
        return {
            "constraint": names[laws.family],
            "k": k,
            "sign": np.where(none, np.nan, laws.sign),
            "multiplier": np.where(none, np.nan, laws.multiplier * units[laws.family]),
        }

    def solution(self, row: int, problem: Problem, seconds: float) -> Solution:
        """The solution of a row; attributes that the array does not store are computed at first use."""
        model, bound, objective = self.model, float(self.optima.bound[row]), float(self.optima.objective[row])
        scale = problem.objective.scale

        def proof(solution: Solution) -> Certificate:
            program = replace(model, problem=problem)
            if problem.convex:
                return certificate(program, solution.active_set, OBJECTIVE)
            return certify(program, solution.active_set, objective, solution.best_possible)

        known = {
            "problem": problem,
            "objective": objective,
            "iterations": 0,
            "seconds": seconds,
            "starts": () if problem.convex else (objective,),
        }
        later: dict[str, Callable[[Solution], Any]] = {
            "active_set": lambda _: self.optima.active_set(row),
            "law": lambda solution: model.law(solution.active_set.x),
            "z_series": lambda solution: tuple(model.space.z_series(model.coordinates(solution.active_set.x)).tolist()),
            "certificate": proof,
            "best_possible": lambda solution: known_limit(solution.problem),
            "lower_bound": lambda solution: max(
                bound, -inf if solution.best_possible is None else solution.best_possible
            ),
            "status": lambda solution: status_of(objective, solution.lower_bound, scale, proven=problem.convex),
        }
        return partly_known(known, later)


def constant_of(law: MotionLaw, name: str) -> float:
    """A constant of one law by its name."""
    value = getattr(law.constants, name)
    return float(value.value if name in CONSTANTS else value)


def stored_laws(space: LawSpace, coordinates: Array) -> list[dict[str, Any]]:
    """The data of `law.to_dict()` for each law; coordinates have a row for each law."""
    if not isinstance(space, PolynomialSpace) or not len(coordinates):
        return [space.law(row).to_dict() for row in coordinates]
    first = space.law(coordinates[0]).to_dict()
    accelerations, starts = space.laws(coordinates)
    return [
        {**first, "acceleration": _trimmed(row), "b0": start}
        for row, start in zip(accelerations.tolist(), starts.tolist(), strict=True)
    ]


def _trimmed(row: list[float]) -> list[float]:
    while row and row[-1] == 0.0:
        row.pop()
    return row


def _constant(name: str, description: str) -> kept_property[Array]:
    """A constant of each law, as a cached property."""

    def values(laws: SolutionArray) -> Array:
        alone = laws.problems.one_objective
        return laws._gathered(  # noqa: SLF001 - a method, written once for several names
            lambda part: part.constant(name, one_objective=alone), lambda solution: constant_of(solution.law, name)
        )

    values.__doc__ = description
    return kept_property(values)


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
        Optima of problems that were solved together, in the terms of their programs.
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

    _json_name = "an array of solutions"

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
        """The number of problems in the array."""
        return self.problems.size

    def __len__(self) -> int:
        return len(self.problems)

    def __iter__(self) -> Iterator[Any]:
        return (self[i] for i in range(len(self)))

    def __getitem__(self, index: Any) -> Any:
        """The solution at a place, or the solutions of several as an array.

        Raises
        ------
        InfeasibleProblem, SolverFailure, InputError
            If the problem at that place has no law, its search failed, or it is no problem.
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
        part, row = map(int, self._places[:, place])
        return self.parts[part].solution(row, self.problems.problem(place), self.seconds / max(self.size, 1))

    @kept_property
    def objective(self) -> Array:
        """The objective of each law, recomputed from it."""
        return self._gathered(lambda part: part.optima.objective, lambda solution: solution.objective)

    @kept_property
    def lower_bound(self) -> Array:
        """Proven lower bounds of the objective, one for each problem."""
        return self._gathered(lambda part: part.optima.bound, lambda solution: solution.lower_bound)

    @kept_property
    def gap(self) -> Array:
        """(objective - lower bound) / objective; relative to its scale where the objective is 0 up to rounding."""
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

    limit = former_name("limit", "best_possible")

    @kept_property
    def best_possible(self) -> Array:
        """What no law of the problem's order and bounds is below, of any degree; NaN if not known."""
        limits = np.full(self.size, np.nan)
        for place in np.flatnonzero(~np.isnan(self.objective.reshape(-1))).tolist():
            known = known_limit(self.problems.problem(place))
            limits[place] = np.nan if known is None else known
        return _frozen(limits.reshape(self.shape))

    def stored_laws(self) -> list[dict[str, Any] | None]:
        """Each law's `to_dict`, in the order of the flattened array; None without a law."""
        laws: dict[int, dict[str, Any]] = {place: solution.law.to_dict() for place, solution in self._alone.items()}
        for part in self.parts:
            laws |= zip(part.places.tolist(), stored_laws(part.model.space, part.coordinates), strict=True)
        return [laws.get(place) for place in range(self.size)]

    @kept_property
    def z_series(self) -> Array:
        """Chebyshev coefficients of Z in 2k - 1, along the last axis; NaN beyond the end of shorter series."""
        return self._rows(lambda part: part.z_series, lambda solution: np.array(solution.z_series))

    @kept_property
    def z(self) -> Array:
        """Coefficients of Z in each problem's basis, along the last axis; NaN beyond the end of shorter series."""
        return self._rows(lambda part: part.z, lambda solution: np.array(solution.z or ()))

    @property
    def coefficients(self) -> Array:
        """Coefficients of Z in each problem's basis, along the last axis: `z`."""
        return self.z

    B = _constant("B", "Peak velocity of each law.")
    C = _constant("C", "Peak acceleration of each law.")
    D = _constant("D", "Peak power of each law.")
    J = _constant("J", "Peak jerk of each law.")
    rms_c = _constant("rms_c", "Root mean square of the acceleration of each law.")

    @kept_property
    def contacts(self) -> dict[str, NDArray[Any]]:
        """Contacts of the certificates along the last axis: "constraint", "sign", "k", "multiplier".

        Laws with fewer contacts than others have "" and NaN beyond their end.
        """
        rows = [(part.places, part.contacts) for part in self.parts]
        rows += [(np.array([place]), _contacts(solution)) for place, solution in self._alone.items()]
        most = max((columns["k"].shape[1] for _, columns in rows), default=0)
        names = rows[0][1] if rows else {}
        return {name: _frozen(self._filled([(i, columns[name]) for i, columns in rows], most)) for name in names}

    def _filled(self, rows: list[tuple[NDArray[np.intp], NDArray[Any]]], most: int) -> NDArray[Any]:
        texts = any(values.dtype == object for _, values in rows)
        filled = np.full((self.size, most), "" if texts else np.nan, dtype=object if texts else np.float64)
        for places, values in rows:
            filled[places, : values.shape[1]] = values
        return filled.reshape(*self.shape, most)

    def to_pandas(self) -> pd.DataFrame:
        """A table with a row for each problem: what varies, the numbers and the status; needs pandas."""
        pd = needed("pandas", "to_pandas")
        varied = {name: arrays[0] for name, arrays in self.problems.varied.items() if len(arrays) == 1}
        columns = {**{_heading(name): values for name, values in varied.items()}, **self._columns}
        return pd.DataFrame({name: values.reshape(-1) for name, values in columns.items()})

    def to_xarray(self) -> xr.Dataset:
        """A dataset over the axes of the problems: numbers, statuses, coefficients and contacts; needs xarray.

        An axis along which one entry of numbers varies has its name and its values, such as "B asked"; others are
        "axis 0", "axis 1", ....
        """
        library = needed("xarray", "to_xarray")
        dims, coords = _axes(self.problems)
        variables: dict[str, Any] = {name: (dims, values) for name, values in self._columns.items()}
        variables["z_series"] = ([*dims, "coefficient"], self.z_series)
        variables |= {f"contact {name}": ([*dims, "contact"], values) for name, values in self.contacts.items()}
        dataset: xr.Dataset = library.Dataset(variables, coords)
        return dataset

    @property
    def _columns(self) -> dict[str, NDArray[Any]]:
        return {**{name: getattr(self, name) for name in NUMBERS}, "status": self.status.astype(str)}

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict: each solution or error in the order of the flattened array, and the problems' entries.

        `optlaws verify` checks each solution, and `from_dict` reads it again.
        """
        from optlaws.synthesis.stored_solutions import plain_entries

        results = map(self.result, range(self.size))
        return {
            "shape": list(self.shape),
            "seconds": self.seconds,
            "solutions": [
                result.to_dict() if isinstance(result, Solution) else plain_error(result) for result in results
            ],
            "problems": plain_entries(self.problems.entries) if self.problems.entries else None,
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> SolutionArray:
        """Read the output of `to_dict`, from JSON or as plain data.

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
        from optlaws.synthesis.stored_solutions import read_solutions

        problems, results, seconds = read_solutions(data)
        return cls(problems, (), results, seconds)

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
        statuses = ", ".join(f"{count} {name}" for name, count in zip(names.tolist(), counts.tolist(), strict=True))
        return f"SolutionArray(shape={self.shape}, {statuses}, problems={self.problems!r})"

    @kept_property
    def _alone(self) -> dict[int, Solution]:
        """The solutions of problems that were solved alone, by their places."""
        return {place: result for place, result in self.others.items() if isinstance(result, Solution)}

    @kept_property
    def _places(self) -> NDArray[np.intp]:
        """The part and the row in it of each problem; -1 of those that were solved alone."""
        numbers = np.full((2, self.size), -1, dtype=np.intp)
        for i, part in enumerate(self.parts):
            numbers[:, part.places] = np.full(len(part.places), i), np.arange(len(part.places))
        return numbers

    def _gathered(self, of_part: Callable[[SolvedPart], Array], of_solution: Callable[[Solution], float]) -> Array:
        values = np.full(self.size, np.nan)
        for part in self.parts:
            values[part.places] = of_part(part)
        for place, solution in self._alone.items():
            values[place] = of_solution(solution)
        return _frozen(values.reshape(self.shape))

    def _rows(self, of_part: Callable[[SolvedPart], Array], of_solution: Callable[[Solution], Array]) -> Array:
        rows = [(part.places, of_part(part)) for part in self.parts]
        rows += [(np.array([place]), of_solution(solution)[None]) for place, solution in self._alone.items()]
        return _frozen(self._filled(rows, max((values.shape[1] for _, values in rows), default=0)))

    def _taken(self, places: NDArray[np.intp]) -> SolutionArray:
        flat, parts = places.ravel(), []
        of_part, rows = self._places[:, flat]
        for i, part in enumerate(self.parts):
            here = np.flatnonzero(of_part == i)
            if len(here):
                parts.append(SolvedPart(here, part.model, part.optima.taken(rows[here]).frozen()))
        others = {i: self.others[place] for i, place in enumerate(flat.tolist()) if place in self.others}
        share = self.seconds * len(flat) / max(self.size, 1)
        return SolutionArray(self.problems.taken(places), tuple(parts), others, share)


def _contacts(solution: Solution) -> dict[str, NDArray[Any]]:
    """The contacts of a certificate, as a row for many certificates."""
    contacts = solution.certificate.contacts
    columns = {"constraint": np.array([[contact.constraint for contact in contacts]], dtype=object)}
    return columns | {
        name: np.array([[getattr(contact, name) for contact in contacts]]) for name in ("sign", "k", "multiplier")
    }


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
            dims[strides[0]] = _heading(name)
            coords[_heading(name)] = np.moveaxis(arrays[0], strides[0], 0).reshape(problems.shape[strides[0]], -1)[:, 0]
    return dims, coords


def _heading(name: str) -> str:
    """The heading of a column of an entry's values beside the numbers of the laws."""
    return f"{name} asked" if name in NUMBERS else name
