"""Fronts: laws of which none is better in every constant, and how they are computed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from math import inf, log2, sqrt
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.entries.declared import ValueOf
from optlaws.errors import InfeasibleProblem, InputError, Interrupted, OptlawsError, SolverFailure, located, needed
from optlaws.files.reading import JsonText, entries_of
from optlaws.kept import kept_property
from optlaws.laws import PolynomialLaw
from optlaws.numbers import MOST_VALUES, Array, finite, listed, real, whole
from optlaws.shown.report import Report, ReportTable, panel_drawing
from optlaws.shown.steps import Steps
from optlaws.shown.summary import Row
from optlaws.synthesis.families.piece_series import of_polynomials
from optlaws.synthesis.method.exchange import solve
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.problem.fields import CONSTANTS
from optlaws.synthesis.problem.named_constants import apart, is_named, named, title_of
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.problem.ranges import Range
from optlaws.synthesis.program.writer import extreme_velocity
from optlaws.synthesis.proof.data import as_json, problem_of, stated
from optlaws.synthesis.solution import Solution
from optlaws.synthesis.solve import TIGHT, Bound, check_bound, continued, synthesize
from optlaws.synthesis.solve_many import SolvedLine
from optlaws.synthesis.status import Status
from optlaws.tolerances import AGREEMENT

_NEARLY_NOTHING = 1e-4  # of a value where it pays: a constant that can be less can be 0, to which no logarithm goes
_NO_EXCHANGE = 1e-6  # of the first constant of a front: a stretch of it within which nothing is exchanged

_OF_POINTS = ("lower bound", "gap", "best possible", "status")
#: of fronts of B, C, D and J
HEADINGS = (*CONSTANTS, *_OF_POINTS)

_SHOWN = 12
#: from so many laws on constants are computed for all at once
_TOGETHER = 16
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
    >>> from optlaws import Problem
    >>> from optlaws import pareto_front
    >>> front = pareto_front(Problem(order=4), over=("B", "C"), points=5, between=(1.5, 1.8))
    >>> front
    Front(over=('B', 'C'), 5 points, B 1.5 to 1.8, C 5.70496 to 4.69579)
    >>> front.values.shape, max(solution.gap for solution in front) < 1e-8
    ((5, 2), True)
    """

    _json_name = "a front"

    over: tuple[str, ...]
    points: tuple[Solution, ...]
    errors: Mapping[float, OptlawsError] = field(default_factory=dict, repr=False, compare=False)

    @property
    def failed(self) -> tuple[float, ...]:
        """Values of the first constant at which the search failed, ascending."""
        return tuple(sorted(self.errors))

    @kept_property
    def values(self) -> Array:
        """The constants of each point: a row for each point, a column for each constant of `over`."""
        return values_of(self.points, self.over)

    @property
    def headings(self) -> tuple[str, ...]:
        """Headings of `rows`: B, C, D and J, the other constants exchanged, and the quality of each point."""
        return (*map(title_of, self._columns), *_OF_POINTS)

    @property
    def _columns(self) -> tuple[str, ...]:
        return (*CONSTANTS, *(name for name in self.over if name not in CONSTANTS))

    @property
    def rows(self) -> list[list[float | str | None]]:
        """Values of the columns that `headings` name, with a row for each point."""
        return self.rows_of(self._columns)

    def rows_of(self, columns: Sequence[str]) -> list[list[float | str | None]]:
        """Constants of each point, with its lower bound, its gap, what is best possible and its status."""
        constants = ([value_of(point, name) for name in columns] for point in self.points)
        return [
            [*values, point.lower_bound, point.gap, point.best_possible, point.status.value]
            for values, point in zip(constants, self.points, strict=True)
        ]

    def report(self) -> Report:
        """How far the front is proven, the table of its points and, of two constants, its curve with both bounds.

        Examples
        --------
        >>> from optlaws import Problem
        >>> from optlaws import pareto_front
        >>> report = pareto_front(Problem(order=4), over=("B", "C"), points=3, between=(1.5, 1.8)).report()
        >>> report.facts[2].note, [curve.name for curve in report.panels[0].series]
        ('proven at every point', ['front', 'lower bound', 'best possible'])
        """
        from optlaws.synthesis.report import front_report

        rows = self.rows
        facts = [Row(title_of(name), (v.min(), v.max())) for name, v in zip(self.over, self.values.T, strict=True)]
        proven = all(point.status is Status.OPTIMAL for point in self)
        quality = "proven at every point" if proven else "local optima, not proven least"
        facts.append(Row("greatest gap", max(point.gap for point in self), note=quality))
        if self.failed:
            facts.append(Row(f"no law at {title_of(self.over[0])}", ", ".join(f"{value:.6g}" for value in self.failed)))
        x, y = self.values[:, 0], self.values[:, -1]
        bounds = (np.array([row[i] for row in rows], dtype=float) for i in (-4, -2))
        curves = [("front", x, y), *zip(("lower bound", "best possible"), (x, x), bounds, strict=True)]
        table = ReportTable(self.headings, rows)
        return front_report(self.over, facts, table, curves if len(self.over) == 2 else [], self.to_dict)

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:
        """Draw the points into matplotlib's axes, new ones by default; returns the artists."""
        from optlaws.plots.front import draw_front

        return draw_front(self, ax, **style)

    def to_pandas(self) -> Any:
        """The rows as a data frame, a line for each point; needs the extra `optlaws[studies]`.

        Examples
        --------
        >>> from optlaws import Problem
        >>> from optlaws import pareto_front
        >>> front = pareto_front(Problem(order=4), over=("B", "C"), points=3, between=(1.5, 1.8))
        >>> front.to_pandas()[["B", "C", "status"]].round(4).to_dict("list")
        {'B': [1.5, ..., 1.8], 'C': [5.705, ..., 4.6958], 'status': ['optimal', 'optimal', 'optimal']}
        """
        pd = needed("pandas", "to_pandas")
        return pd.DataFrame(self.rows, columns=list(self.headings))

    def to_xarray(self) -> Any:
        """The rows as a dataset along the points, with the coordinates of the exchanged constants; needs xarray.

        Examples
        --------
        >>> from optlaws import Problem
        >>> from optlaws import pareto_front
        >>> front = pareto_front(Problem(order=4), over=("B", "C"), points=3, between=(1.5, 1.8))
        >>> front.to_xarray().C.sel(B=1.8, method="nearest").round(4).item()
        4.6958
        """
        xr = needed("xarray", "to_xarray")
        first, *others = map(title_of, self.over)
        columns = dict(zip(self.headings, zip(*self.rows, strict=True), strict=True))
        data = {name: (first, list(values)) for name, values in columns.items() if name != first}
        exchanged = {name: data.pop(name) for name in others[:-1]}
        return xr.Dataset(data, {first: list(columns[first]), **exchanged})

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict with every solution whole: `optlaws verify` checks it, `from_dict` reads it again."""
        from optlaws.synthesis.stored_rows import plain_error

        return {
            "over": list(self.over),
            "values": self.values.tolist(),
            "points": [point.to_dict() for point in self.points],
            "failed": list(self.failed),
            "errors": [plain_error(self.errors[value]) for value in self.failed],
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """Read the output of `to_dict`; constants are computed from the laws and checked against the values.

        Raises
        ------
        InputError
            If an entry is missing or wrong, or one states what does not follow from problems, laws and proofs.
        """
        from optlaws.synthesis.stored_rows import StatedError, equal_data, read_error

        entries = entries_of(data, ("over", "values", "points", "failed"), cls._json_name)
        over, values, points, failed = (listed(entries[name], name, MOST_VALUES) for name in entries)
        errors: dict[float, OptlawsError] = {finite(value, "failed"): SolverFailure("") for value in failed}
        for i, (value, row) in enumerate(zip(errors, listed(data.get("errors", ()), "errors"), strict=False)):
            error = stated(row, StatedError, f"errors[{i}]")
            with located(f"errors[{i}]"):
                errors[value] = read_error(error, partial(problem_of, error.problem or {}))
        read = [ValueOf(Solution).read(row, f"points[{i}]") for i, row in enumerate(points)]
        front = cls(tuple(map(named_or_refused, over)), tuple(read), errors)
        if not read or not equal_data(front.values.tolist(), as_json(values)):
            raise InputError("the values of a front are other than the constants of its laws")
        return front

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
        from optlaws.shown.showing import page, table

        report = self.report()
        rows = report.tables[0].rows[:: 1 + len(self) // _SHOWN]
        return page(repr(self), table(self.headings, rows), *map(panel_drawing, report.panels))


def named_or_refused(name: object) -> str:
    """The name of a constant as it prints itself; refused if it has none.

    Raises
    ------
    InputError
        If it is none.

    Examples
    --------
    >>> named_or_refused("rms( c )")
    'rms(c)'
    """
    if not isinstance(name, str):
        raise InputError(f"a constant has a name, got {shortened(name)}")
    return repr(named(name))


def undominated(solutions: Sequence[Solution], over: Sequence[str], values: Array | None = None) -> list[Solution]:
    """Points that no other dominates, by ascending constants.

    Values of the constants, a row for each solution, are computed from the laws unless they are known.

    Examples
    --------
    >>> from optlaws import Problem, sweep
    >>> solutions = list(sweep(Problem(B=B, order=4) for B in (1.6, 1.8, 2.2)))
    >>> [solution.problem.B for solution in undominated(solutions, ("B", "C"))]
    [1.6, 1.8]
    """
    points = values_of(solutions, over) if values is None else values
    order = np.lexsort(points.T[::-1])
    order = order[~_beaten(points[order])]
    rows, chosen = points[order].tolist(), [0]
    for i in range(1, len(order)):
        if not _known_already(rows, chosen, i):
            chosen.append(i)
    return [solutions[order[i]] for i in chosen]


def _beaten(values: Array) -> NDArray[np.bool_]:
    """A mask of points that another one dominates."""
    beaten = np.zeros(len(values), dtype=np.bool_)
    for begin in range(0, len(values), _BLOCK):
        some = values[begin : begin + _BLOCK]
        no_worse, better = np.ones((len(some), len(values)), np.bool_), np.zeros((len(some), len(values)), np.bool_)
        for some_values, others in zip(some.T, values.T, strict=True):
            no_worse &= others <= (some_values * (1.0 + AGREEMENT))[:, None]
            better |= others < (some_values * (1.0 - AGREEMENT))[:, None]
        beaten[begin : begin + _BLOCK] = (no_worse & better).any(axis=1)
    return beaten


def _known_already(rows: Sequence[Sequence[float]], chosen: Sequence[int], place: int) -> bool:
    """Whether a row is among the stored ones; the rows ascend in their first entry."""
    row = rows[place]
    for other in map(rows.__getitem__, reversed(chosen)):
        if abs(other[0] / row[0] - 1.0) > AGREEMENT:
            return False
        if all(abs(value / here - 1.0) <= AGREEMENT for value, here in zip(other, row, strict=True)):
            return True
    return False


def value_of(solution: Solution, name: str) -> float:
    """A constant of a solution's law."""
    return named(name).value(solution.law)


def values_of(solutions: Sequence[Solution], names: Sequence[str]) -> Array:
    """Constants of the laws of many solutions: a row for each solution, a column for each constant."""
    return np.column_stack([_column(solutions, name) for name in names])


def _column(solutions: Sequence[Solution], name: str) -> Array:
    if all(repr(solution.problem.objective) == name for solution in solutions):
        return np.array([solution.objective for solution in solutions])
    laws = [solution.law for solution in solutions]
    polynomials = [law for law in laws if isinstance(law, PolynomialLaw)]
    if len(laws) >= _TOGETHER and name in IN_ARRAYS and len(polynomials) == len(laws):
        return of_polynomials(polynomials, name)
    return np.array([value_of(solution, name) for solution in solutions])


# how far above its least value a constant is held while the next one is minimised: as near as the solver can go
_ABOVE = (1e-5, 1e-7, 1e-9)
_BENT = 2.0
#: from this number on, points of convex problems are added in groups, in gaps half as important as the first
_MANY, _SHARE, _EVEN = 16, 0.5, 4
#: where laws are worse than others, so many times as many are looked for at most
_AGAIN = 2


def pareto_front(
    problem: Problem,
    over: Sequence[str | Functional] = ("B", "C"),
    *,
    points: int = 50,
    between: tuple[float, float] | None = None,
    bound: Bound = "quick",
) -> Front:
    """Laws that exchange two or three constants for one another, from the least of the first to the least of the last.

    With over=("B", "C") each law has the least C at its B; with over=("C", "D") the least D among laws of at most
    its C. Points lie evenly along the curve in logarithms of the constants, closer where it bends. Where the problem
    is convex every point is the optimum of its problem; with D no worse than a single `synthesize` of it. Points ascend
    in the first constant; none is better than another in all of them.

    Parameters
    ----------
    problem
        The rest of the problem; its `minimise` does not count.
    over
        Two or three constants, by their names or themselves: B, C, D, J, or any that can be minimised and bounded,
        such as "peak(c + 0.2*b)", "residual(frequency=20)" or `machine.peak("torque")`.
    points
        How many laws; fewer where nothing is exchanged, a search fails, or with three constants.
    between
        Least and greatest value of the first constant; where it pays unless given. Beyond the value that the law of
        least last constant has, both constants get worse, so no points lie there.
    bound
        As of `synthesize`: "tight" proves the points of fronts with D, too, fifty of them in some seconds.

    Raises
    ------
    InputError
        If the constants are unknown, repeated or already given by the problem, or nothing is left between the values.
    InfeasibleProblem, SolverFailure
        If an end of the front has no law, or a search fails. Why there is none between is in `errors` of the front.

    Examples
    --------
    >>> front = pareto_front(Problem(B=1.641, order=4), over=("C", "D"), points=3)
    >>> [[round(value, 4) for value in row] for row in front.values.tolist()]
    [[5.0807, 5.3968], [6.0243, 3.905], [7.1432, 3.4583]]
    """
    names = _checked(problem, over, between)
    count = whole(points, "points", least=2)
    check_bound(bound)
    if len(names) == 2:
        return _Curve(problem, names, between, bound).grow(count)
    return _surface(problem, names, count, between, bound)


def where_it_pays(problem: Problem, over: tuple[str, str]) -> tuple[float, float]:
    """The range of the first constant: from about the least value that has a law to the value at the best law."""
    points = _Curve(problem, _checked(problem, over, None), None).points
    return points[0][0], points[-1][0]


class _Curve:
    """The growing front of two constants: solutions by the prescribed value of the first."""

    def __init__(
        self,
        problem: Problem,
        over: tuple[str, ...],
        between: tuple[float, float] | None,
        bound: Bound = "quick",
    ) -> None:
        self.problem, self.over, self.bound = replace(problem, minimise=over[1]), over, bound
        self.errors: dict[float, OptlawsError] = {}
        #: first values of the stretches in which no law was found
        self._dead: set[float] = set()
        #: constants of laws that were computed in groups, by the prescribed value of the first
        self._values: dict[float, Sequence[float]] = {}
        low, high = between if between is not None else (0.0, inf)
        best = self._best(_with(self.problem, over[0], Range(1.0 if over[0] == "B" else 0.0, inf)))
        pays = value_of(best, over[0])
        if low >= pays * (1.0 - AGREEMENT):
            raise InputError(
                f"{over[1]} is least at {over[0]} = {pays:.7g}: there is no exchange above it, got {shortened(between)}"
            )
        self.points = [self._first(low, pays), self._last(best, pays, high)]

    def grow(self, count: int) -> Front:
        """Add points to the most important gaps, until the number of nondominated points is reached."""
        if count >= _MANY and self._problem(self.points[0][0]).convex:
            self._grow_together(count)
        try:
            return self._grown(count)
        except KeyboardInterrupt:
            text = f"the front was stopped after {len(self.points)} of {count} points"
            raise Interrupted(text, self._front()) from None

    def _grown(self, count: int) -> Front:
        with Steps(f"least {self.over[1]} over {self.over[0]}", count) as steps:
            sought = count
            while True:
                while len(self.points) < sought and self._halve():
                    steps.reach(min(len(self.points), count))
                front = self._front()
                if len(front) >= count or len(self.points) < sought or sought >= _AGAIN * count:
                    return front
                # of local optima some are worse than others: as many more are sought
                sought += count - len(front)

    def _front(self) -> Front:
        """The nondominated ones of the points so far."""
        solutions = [solution for _, solution in self.points]
        return Front(self.over, tuple(undominated(solutions, self.over, self._known())), self.errors)

    def _halve(self) -> bool:
        """Add a point to the most important gap; False without such a gap."""
        widths = _widths(_pairs(self.points))
        widths[[value in self._dead for value, _ in self.points[:-1]]] = 0.0
        i = int(np.argmax(widths))
        if widths[i] < AGREEMENT:
            return False
        (low, left), (high, right) = self.points[i : i + 2]
        value = sqrt(low * high)
        solution = self._solved(value, left, right)
        if isinstance(solution, Solution):
            self.points.insert(i + 1, (value, solution))
        else:
            self.errors[value] = solution
            self._dead.add(low)
        return True

    def _best(self, problem: Problem) -> Solution:
        return synthesize(problem, bound=self.bound)

    def _known(self) -> Array:
        """The constants of the points, a row for each."""
        others = [(value, solution) for value, solution in self.points if value not in self._values]
        rows = values_of([solution for _, solution in others], self.over).tolist()
        known = self._values | dict(zip([value for value, _ in others], rows, strict=True))
        return np.array([known[value] for value, _ in self.points])

    def _grow_together(self, count: int) -> None:
        """Add points to all gaps at least half as important as the first; their laws are computed together."""
        (low, _), (high, _) = self.points
        # the middles of the first stretches, and of their halves, and so on
        begun = 2 ** round(log2(count / _EVEN))
        values = [low * (high / low) ** (i / begun) for i in range(1, begun)]
        line = SolvedLine(self.problem, self.over[0], self._problem, low, high)
        while values:
            known = self._computed(line, np.array(values))
            there = [(value, known[value]) for value in values if value in known]
            self.points = sorted([*self.points, *there], key=lambda point: point[0])
            if len(there) < len(values):
                # the others are looked at one by one
                return
            values = _wanting(_pairs(self.points), count)

    def _computed(self, line: SolvedLine, values: Array) -> dict[float, Solution]:
        """Proven solutions at values of the first constant, whose constants are remembered."""
        results = line.at(values)
        proven = np.flatnonzero(results.status == Status.OPTIMAL)
        there = values[proven].tolist()
        if set(self.over) <= set(IN_ARRAYS):
            columns = [getattr(results, name)[proven].tolist() for name in self.over]
            self._values |= zip(there, zip(*columns, strict=True), strict=True)
        laws = zip(there, map(results.result, proven.tolist()), strict=True)
        return {value: law for value, law in laws if isinstance(law, Solution)}

    def _problem(self, value: float) -> Problem:
        return _at_most(self.problem, self.over[0], value)

    def _first(self, low: float, pays: float) -> tuple[float, Solution]:
        """The first end of the front: the least value of the first constant, or `low` if that is possible."""
        if low > (1.0 if self.over[0] == "B" else 0.0):
            with suppress(InfeasibleProblem):
                return low, self._best(self._problem(low))
        least = least_value(self.problem, self.over[0])
        if least < _NEARLY_NOTHING * pays:
            return _NEARLY_NOTHING * pays, self._best(self._problem(_NEARLY_NOTHING * pays))
        value = least * (1.0 + _ABOVE[0])
        solution = self._best(self._problem(value))
        if self.bound == TIGHT and not solution.problem.convex:
            # nearer, boxes that bound all laws are so thin that rounding fills them
            return value, solution
        for above in _ABOVE[1:]:
            # so near to its least value the constant leaves the solver no room: the contacts are continued instead
            problem = self._problem(least * (1.0 + above))
            nearer = continued(problem, solution) if problem.convex else self._tried(problem, solution)
            if not isinstance(nearer, Solution) or nearer.status is Status.INACCURATE:
                break
            value, solution = least * (1.0 + above), nearer
        return value, solution

    def _last(self, best: Solution, pays: float, high: float) -> tuple[float, Solution]:
        """The last end of the front: the least value of the last constant, or `high`."""
        value = min(pays if self.over[0] == "B" else pays * (1.0 + AGREEMENT), high)
        try:
            return value, self._best(self._problem(value))
        except (InfeasibleProblem, SolverFailure):
            if value == high:
                raise
            return pays, best

    def _solved(self, value: float, left: Solution, right: Solution) -> Solution | OptlawsError:
        problem = self._problem(value)
        if problem.convex or self.bound == TIGHT:
            # what is proven of all laws needs no other start
            near = self._tried(problem, left)
            if isinstance(near, Solution) and near.status is Status.OPTIMAL:
                return near
        if problem.convex:
            return self._tried(problem, None)
        # a branch of local optima may cease to be the best, so it is only continued where the starts lead to worse
        best = self._tried(problem, None)
        if not isinstance(best, Solution) or best.objective > left.objective or best.objective < right.objective:
            tries = [best, self._tried(problem, left), self._tried(problem, right)]
            laws = [solution for solution in tries if isinstance(solution, Solution)]
            return min(laws, key=lambda solution: solution.objective, default=best)
        return best

    def _tried(self, problem: Problem, start: Solution | None) -> Solution | OptlawsError:
        try:
            return synthesize(problem, start=start, bound=self.bound)
        except (InfeasibleProblem, SolverFailure) as error:
            # its frames would keep what was tried
            return error.with_traceback(None)


def _pairs(points: Sequence[tuple[float, Solution]]) -> list[tuple[float, float]]:
    """The values of both constants of points, as far as they are prescribed and minimised."""
    return [(value, solution.objective) for value, solution in points]


def _wanting(points: Sequence[tuple[float, float]], count: int) -> list[float]:
    """The middles of the most important gaps between points, as many as are left of a number of points."""
    widths = _widths(points)
    wanting = np.flatnonzero(widths >= max(_SHARE * widths.max(), AGREEMENT))
    places = wanting[np.argsort(-widths[wanting])][: count - len(points)]
    return [sqrt(points[i][0] * points[i + 1][0]) for i in sorted(places.tolist())]


def _widths(points: Sequence[tuple[float, float]]) -> Array:
    """The importance of each gap: its length in normalised logarithms, more where the front bends."""
    logs = np.log(points)
    span = np.abs(logs[-1] - logs[0])
    if span[0] < _NO_EXCHANGE:
        return np.zeros(len(points) - 1)
    steps = np.diff(logs, axis=0) / np.where(span > 0.0, span, 1.0)
    turns = np.abs(np.diff(np.arctan2(steps[:, 1], steps[:, 0])))
    ends = np.pad(turns, 1, mode="edge") if len(turns) else np.zeros(2)
    return np.asarray(np.hypot(*steps.T) * (1.0 + _BENT * (ends[:-1] + ends[1:])))


def _surface(
    problem: Problem, over: tuple[str, ...], points: int, between: tuple[float, float] | None, bound: Bound
) -> Front:
    """Curves of the second and the third constant at values of the first, as many as each curve has points."""
    across = max(2, round(sqrt(points)))
    spines = [_Curve(problem, (over[0], name), between, bound) for name in over[1:]]
    spine = max(spines, key=lambda curve: curve.points[-1][0]).grow(across)
    errors = dict(spine.errors)
    solutions: list[Solution] = []
    for i, value in enumerate(spine.values[:, 0].tolist()):
        share = (points - len(solutions)) // (len(spine) - i)
        part = _at_most(problem, over[0], value)
        try:
            solutions += _Curve(part, over[1:], None, bound).grow(max(2, share)).points
        except (InfeasibleProblem, SolverFailure) as error:
            errors[value] = error.with_traceback(None)
    return Front(over, tuple(undominated(solutions, over)), errors)


def _at_most(problem: Problem, name: str, value: float) -> Problem:
    return _with(problem, name, value if name == "B" else Range(0.0, value))


def _with(problem: Problem, name: str, limits: float | Range) -> Problem:
    changed: dict[str, Any] = {name: limits} if name in CONSTANTS else {"bounds": {**problem.bounds, name: limits}}
    return replace(problem, **changed)


def least_value(problem: Problem, name: str) -> float:
    """The least value of a constant, of B where it is given as a number; SolverFailure where the search fails."""
    if name != "B":
        return synthesize(replace(problem, minimise=name)).objective
    extreme = extreme_velocity(problem, greatest=False)
    optimum = solve(extreme.program).optimum
    if optimum is None:
        raise SolverFailure("the least B of these conditions was not found: give between", problem=problem)
    return float(optimum.x[extreme.places["B"]])


def _checked(problem: object, over: Sequence[str | Functional], between: tuple[float, float] | None) -> tuple[str, ...]:
    if not isinstance(problem, Problem):
        raise InputError(f"pareto_front takes a Problem, got {type(problem).__name__}")
    several = over if not isinstance(over, str) else apart(over)
    names: tuple[Any, ...] = tuple(repr(name) if isinstance(name, Functional) else name for name in several)
    if len(names) not in (2, 3) or len(set(names)) != len(names):
        raise InputError(f"over must name two or three constants, each once, such as ('B', 'C'); got {shortened(over)}")
    for name in names:
        if name not in CONSTANTS and not (isinstance(name, str) and is_named(named(name))):
            raise InputError(f"over names constants, such as 'B' or 'peak(c + 0.2*b)', got {shortened(name)}")
        if problem.range(name) is not None:
            given = getattr(problem, name, problem.range(name))
            raise InputError(f"{name} is exchanged: leave it out of the problem, got {given!r}")
    if between is not None:
        ends = [real(value) or 0.0 for value in between]
        if len(ends) != 2 or not 0.0 < ends[0] < ends[1] < inf:
            raise InputError(f"between must be two numbers above 0 in ascending order, got {shortened(between)}")
    return names
