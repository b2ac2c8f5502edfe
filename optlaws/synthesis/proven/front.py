"""A front as a function: at every value of a number a law, its objective, and a bound that is proven to be near."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import isnan
from typing import Any, TypeVar, overload

import msgspec
import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import JsonText, entries_of
from optlaws.kept import kept_property
from optlaws.laws import Constants, MotionLaw
from optlaws.laws.curve import Many
from optlaws.laws.making.transform import law_between
from optlaws.numbers import Array, bounded, finite, real
from optlaws.shown.report import Report, ReportTable
from optlaws.shown.summary import Row
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import evaluate
from optlaws.synthesis.proof.certificate import OBJECTIVE, Certificate
from optlaws.synthesis.proof.data import StatedContact, brief_sum_of, contacts_of, problem_of, stated
from optlaws.synthesis.proof.nodes import Contact
from optlaws.synthesis.proven.swept_parameter import AT_MOST, SweptParameter, bounds_beside, gap_bounds
from optlaws.synthesis.status import measure
from optlaws.tolerances import OPERATIONS_ROUNDING

T = TypeVar("T")

_SHOWN = 12  # rows of a table

#: what a controller exchanges while it runs
RUN_TIME = (f"{AT_MOST}B", "C")


class LazySequence(Sequence[T]):
    """Items that are computed at their first use and cached; equal to others with equal items."""

    def __init__(self, count: int, make: Callable[[int], T]) -> None:
        self._count, self._make = count, make
        self._made: dict[int, T] = {}

    def __len__(self) -> int:
        return self._count

    @overload
    def __getitem__(self, place: int) -> T: ...
    @overload
    def __getitem__(self, place: slice) -> tuple[T, ...]: ...
    def __getitem__(self, place: int | slice) -> T | tuple[T, ...]:
        if isinstance(place, slice):
            return tuple(self[i] for i in range(*place.indices(self._count)))
        i = range(self._count)[place]
        if i not in self._made:
            self._made[i] = self._make(i)
        return self._made[i]

    def __eq__(self, other: object) -> bool:
        return tuple(self) == tuple(other) if isinstance(other, Sequence) else NotImplemented

    def __hash__(self) -> int:
        return hash(tuple(self))

    def __reduce__(self) -> tuple[type[tuple[T, ...]], tuple[tuple[T, ...]]]:
        return tuple, (tuple(self),)


@dataclass(frozen=True)
class FrontPoint(JsonText):
    """A law of a proven front, with the proof of its gap to the best law.

    Attributes
    ----------
    value
        Of the number that runs.
    problem, law
        The problem at this value, and a law of it.
    objective
        Recomputed from the law.
    certificate
        Proves `lower_bound`.

    Examples
    --------
    >>> from optlaws import proven_front
    >>> point = proven_front(Problem(order=4), between=(1.6, 1.7), gap=1e-3)(1.65)
    >>> point.problem.B, point.lower_bound <= point.objective == point.constants.C.value
    (1.65, True)
    """

    _json_name = "a point of a front"

    value: float
    problem: Problem
    law: MotionLaw
    objective: float
    certificate: Certificate

    @property
    def lower_bound(self) -> float:
        """No law of the problem has a smaller objective: the certificate's bound."""
        return self.certificate.bound

    @property
    def gap(self) -> float:
        """(objective - lower bound) / objective, as of a `Solution`."""
        return (self.objective - self.lower_bound) / measure(self.objective, self.problem.objective.scale)

    @property
    def constants(self) -> Constants:
        """B, C, D, J of the law, each with its k, and the RMS of c."""
        return self.law.constants

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict, which `optlaws verify` accepts like the dict of a `Solution`."""
        return {
            "value": self.value,
            "problem": self.problem.to_dict(),
            "objective": self.objective,
            "lower_bound": bounded(self.lower_bound),
            "gap": bounded(self.gap),
            "constants": self.constants.to_dict(rms=False),
            "law": self.law.to_dict(),
            "certificate": self.certificate.to_dict(),
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> FrontPoint:
        """The point that `to_dict` described; objective and bound are computed, not read.

        Raises
        ------
        InputError
            If an entry is missing or wrong.
        """
        names = ("value", "problem", "law", "certificate")
        value, plain, stored, proof = entries_of(data, names, cls._json_name).values()
        problem, law, certificate = problem_of(plain), MotionLaw.from_dict(stored), Certificate.from_dict(proof)
        if certificate.problem != problem or certificate.program != OBJECTIVE:
            raise InputError("the certificate of a point of a front is not of its problem")
        return cls(finite(value, "value"), problem, law, evaluate(problem, law).objective, certificate)


class StatedPoint(msgspec.Struct, forbid_unknown_fields=True):
    """The stored form of a certified law of a proven front."""

    at: float
    law: dict[str, Any]
    contacts: list[StatedContact]
    equations: tuple[float, ...]


class StatedFront(msgspec.Struct, forbid_unknown_fields=True):
    """The data that `ProvenFront.to_dict` writes."""

    runs: str
    problem: dict[str, Any]
    gap: float
    points: list[StatedPoint]
    about: str = ""


@dataclass(frozen=True)
class ProvenFront(JsonText):
    """Certified laws along a number, and by convexity a law and a lower bound at every value between.

    Calling it with a value gives a `FrontPoint`: the weighted mean of the two laws beside the value, which keeps every
    constraint, and the better of their two certificates, each of which bounds the objective at every value. Along a
    weight of the objective it is the better of the two laws, and the weighted mean of the certificates.

    Parameters
    ----------
    number
        The problem, and what runs.
    values
        The values of the certified laws, ascending.
    laws, certificates
        The laws, and their certificates.

    Raises
    ------
    InputError
        If there are fewer than two laws, values do not ascend, or a certificate is of another problem.

    Examples
    --------
    >>> from optlaws import proven_front
    >>> front = proven_front(Problem(order=4), "B", between=(1.5, 1.52), gap=1e-9)
    >>> len(front), front.gap < 1e-12
    (17, True)
    >>> point = front(1.5123)
    >>> round(point.objective, 5), point.gap <= front.gap
    (5.65, True)
    """

    _json_name = "a proven front"

    number: SweptParameter
    values: tuple[float, ...]
    laws: Sequence[MotionLaw] = field(repr=False)
    certificates: Sequence[Certificate] = field(repr=False)

    def __post_init__(self) -> None:
        steps = np.diff(self.values)
        if len(self.values) < 2 or not (steps > 0.0).all():
            raise InputError("a proven front needs at least two certified laws, at ascending values")
        if not len(self.values) == len(self.laws) == len(self.certificates):
            raise InputError("a proven front needs a law and a certificate for each value")
        computed_here = isinstance(self.certificates, LazySequence)
        for value, certificate in () if computed_here else zip(self.values, self.certificates, strict=True):
            if certificate.program != OBJECTIVE or certificate.problem != self.number.at(value):
                raise InputError(f"the certificate at {self.number.name} = {value!r} is not of the problem there")

    @classmethod
    def of_known(
        cls,
        number: SweptParameter,
        values: Array,
        laws: LazySequence[MotionLaw],
        certificates: LazySequence[Certificate],
        sides: Array,
    ) -> ProvenFront:
        """A front whose laws are computed when needed, with the known values of each."""
        front = cls(number, tuple(values.tolist()), laws, certificates)
        front.__dict__["sides"] = sides
        return front

    @property
    def problem(self) -> Problem:
        """The problem apart from the number that varies."""
        return self.number.problem

    @property
    def over(self) -> tuple[str, str]:
        """The names of the swept number and of the objective."""
        return self.number.name, repr(self.problem.objective)

    @property
    def between(self) -> tuple[float, float]:
        """The least and the greatest value."""
        return self.values[0], self.values[-1]

    @kept_property
    def sides(self) -> Array:
        """Upper and lower values of the least objective at each certified law, with the slope there."""
        each = zip(self.values, self.laws, self.certificates, strict=True)
        return np.array([bounds_beside(self.number, self.between, *known) for known in each])

    @kept_property
    def gaps(self) -> Array:
        """The greatest gap of any value between each two laws with its rounding, relative as of a `Solution`."""
        scale = self.problem.objective.scale
        bounds = gap_bounds(np.array(self.values), self.sides, scale, concave=self.number.concave)
        return bounds + OPERATIONS_ROUNDING

    @property
    def gap(self) -> float:
        """The greatest gap at any value, proven."""
        return float(self.gaps.max())

    @property
    def curve(self) -> tuple[Array, Array]:
        """Corners of the upper bound and its values there; it is piecewise linear."""
        t, (top, _, slopes) = np.array(self.values), self.sides.T
        if not self.number.concave:
            return t, top
        turn = np.diff(slopes)
        with np.errstate(divide="ignore", invalid="ignore"):
            cross = (top[:-1] - top[1:] + slopes[1:] * t[1:] - slopes[:-1] * t[:-1]) / turn
        inside = cross[(turn != 0.0) & (cross > t[:-1]) & (cross < t[1:])]
        places = np.sort(np.concatenate([t, inside]))
        return places, self.upper(places)

    def upper(self, values: float | Many) -> Array:
        """Upper bounds of the least objective at values of the number, in the shape of the values."""
        return self._bounds(values)[1]

    def lower(self, values: float | Many) -> Array:
        """Lower bounds of the least objective at values of the number, in the shape of the values."""
        return self._bounds(values)[0]

    def _bounds(self, values: float | Many) -> tuple[Array, Array]:
        places = np.asarray(values, dtype=np.float64)
        low, high = self.between
        wrong = places[~((places >= low) & (places <= high))]
        if wrong.size:
            raise self._outside(float(wrong.flat[0]))
        t = np.array(self.values)
        i = np.clip(np.searchsorted(t, places, side="right") - 1, 0, len(t) - 2)
        away = (places - t[i], places - t[i + 1])
        share = away[0] / (t[i + 1] - t[i])
        tops, lows, slopes = self.sides.T
        if self.number.concave:
            upper = np.minimum(*(tops[j] + slopes[j] * distance for j, distance in zip((i, i + 1), away, strict=True)))
            return (1.0 - share) * lows[i] + share * lows[i + 1], upper
        lower = np.maximum(*(lows[j] + slopes[j] * distance for j, distance in zip((i, i + 1), away, strict=True)))
        return lower, (1.0 - share) * tops[i] + share * tops[i + 1]

    def __call__(self, value: float) -> FrontPoint:
        """The law at a value, with its objective and its proof.

        Raises
        ------
        InputError
            If the value is beyond the ends; nothing is known there.
        """
        number = real(value)
        low, high = self.between
        if number is None or not low <= number <= high:
            raise self._outside(value)
        i = min(max(int(np.searchsorted(self.values, number, side="right")) - 1, 0), len(self.values) - 2)
        share = (number - self.values[i]) / (self.values[i + 1] - self.values[i])
        problem = self.number.at(number)
        return (
            self._averaged(i, share, number, problem) if self.number.concave else self._mixed(i, share, number, problem)
        )

    def _mixed(self, i: int, share: float, value: float, problem: Problem) -> FrontPoint:
        law = self.laws[i + 1] if share == 1.0 else law_between(self.laws[i], self.laws[i + 1], share)
        proofs = [replace(certificate, problem=problem) for certificate in self.certificates[i : i + 2]]
        return FrontPoint(
            value,
            problem,
            law,
            evaluate(problem, law).objective,
            max(proofs, key=lambda certificate: certificate.estimate),
        )

    def _averaged(self, i: int, share: float, value: float, problem: Problem) -> FrontPoint:
        sums = [evaluate(problem, law).objective for law in self.laws[i : i + 2]]
        best = int(np.argmin(sums))
        contacts: list[Contact] = []
        equations = np.zeros(len(self.certificates[i].equations))
        for certificate, factor in zip(self.certificates[i : i + 2], (1.0 - share, share), strict=True):
            contacts += [replace(c, multiplier=c.multiplier * factor) for c in certificate.contacts if factor > 0.0]
            equations += factor * np.array(certificate.equations)
        proof = Certificate.of_leaf(problem, contacts, equations.tolist())
        return FrontPoint(value, problem, self.laws[i + best], sums[best], proof)

    def _outside(self, value: object) -> InputError:
        low, high = self.between
        shown = "NaN" if isinstance(value, float) and isnan(value) else shortened(value)
        return InputError(f"the front is proven for {self.number.name} from {low!r} to {high!r}, not at {shown}")

    def __iter__(self) -> Iterator[FrontPoint]:
        """The certified laws, each with its own certificate."""
        for value, law, proof in zip(self.values, self.laws, self.certificates, strict=True):
            yield FrontPoint(value, proof.problem, law, evaluate(proof.problem, law).objective, proof)

    def __len__(self) -> int:
        return len(self.values)

    def __repr__(self) -> str:
        low, high = self.between
        name, objective = self.over
        return (
            f"ProvenFront({name} {low:.6g} to {high:.6g}, {objective}, gap at most {self.gap:.1e}, "
            f"{len(self)} certified laws)"
        )

    def report(self, points: int = _SHOWN) -> Report:
        """The proven gap, a table of so many even values with their bounds, and the curve with its lower bound.

        Examples
        --------
        >>> from optlaws import proven_front
        >>> proven_front(Problem(order=4), "B", between=(1.5, 1.52), gap=1e-9).report(3).tables[0].rows[1][0]
        1.51
        """
        from optlaws.synthesis.report import front_report

        low, high = self.between
        some = [self(low + (high - low) * i / (points - 1)) for i in range(points - 1)] + [self(high)]
        rows = [[point.value, point.objective, point.lower_bound, point.gap] for point in some]
        at, upper = self.curve
        facts = [Row(self.over[0], self.between), Row(self.over[1], (upper.min(), upper.max()))]
        facts += [Row("greatest gap", self.gap, note="proven at every value"), Row("certified laws", len(self))]
        curves = [("front", at, upper), ("lower bound", at, self.lower(at))]
        return front_report(
            self.over, facts, ReportTable((*self.over, "lower bound", "gap"), rows), curves, self.to_dict
        )

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:
        """Draw the continuous front into matplotlib's axes, new ones by default; returns the artists."""
        from optlaws.plots.front import draw_front

        return draw_front(self, ax, **style)

    def export(self, to: str, gap: float = 1e-3, *, name: str = "Front", points: int | None = None) -> Any:
        """The front as functions of a controller, which chooses a law for stroke, time and limits while it runs.

        The front is one of "at_most.B" and C: between neighbouring laws of the table the weighted mean keeps every
        constraint, and is within the gap of all laws within the velocity, wherever they reach it.

        Parameters
        ----------
        to
            "c99" or "iec-st".
        gap
            The greatest gap of C at any B, relative to it; the front must be proven to it or better.
        name
            Before every name of a header, or of the function block.
        points
            The greatest number of laws in the table.

        Returns
        -------
        A `FrontExport`: its `text`, its `table`, the moves that it plans; `write(file)` writes it.

        Raises
        ------
        InputError
            If it is no front of "at_most.B" and C from rest to rest, the gap is not reached, or the format has no
            functions.

        Examples
        --------
        >>> from optlaws import proven_front
        >>> front = proven_front(Problem(order=4), ("at_most.B", "C"), gap=1e-4)
        >>> export = front.export("iec-st", name="FB_Lift")
        >>> export.points, export.size, export.gap <= 1e-3
        (32, 3072, True)
        """
        from optlaws.exports.front_export import export_front, function_format
        from optlaws.synthesis.proven.refine import ChordSelection, proven_ends

        function_format(to)
        if self.over != RUN_TIME:
            raise InputError(
                f"a front at run time exchanges {RUN_TIME[0]} and C, got {self.over[0]} and {self.over[1]}: make it "
                f"with proven_front(problem, {RUN_TIME!r})"
            )
        chords = ChordSelection(np.array(self.values), self.sides, self.problem.objective.scale)
        places, reached = chords.fewest(gap, points)
        values, laws = [self.values[i] for i in places], [self.laws[i] for i in places]
        proof = (reached, proven_ends(self.problem, laws[0], laws[-1], reached))
        return export_front(to, name, values, laws, proof, about=f"problem: {self.problem!r}")

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict, which `optlaws verify` proves; numbers that follow from the laws are left out."""
        return {
            "runs": self.number.name,
            "problem": self.problem.to_dict(),
            "gap": self.gap,
            "points": [
                {"at": value, "law": law.to_dict(), **brief_sum_of(proof.leaf)}
                for value, law, proof in zip(self.values, self.laws, self.certificates, strict=True)
            ],
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> ProvenFront:
        """Read what `to_dict` wrote; the gap is recomputed, not read.

        Raises
        ------
        InputError
            If an entry is missing or wrong.
        """
        entries = stated(data, StatedFront, "proven front")
        number = SweptParameter(problem_of(entries.problem), entries.runs)
        proofs = (
            Certificate.of_leaf(number.at(point.at), contacts_of(point.contacts), point.equations)
            for point in entries.points
        )
        laws = tuple(MotionLaw.from_dict(point.law) for point in entries.points)
        front = cls(number, tuple(point.at for point in entries.points), laws, tuple(proofs))
        with np.errstate(over="ignore", invalid="ignore"):
            nothing = np.flatnonzero(~np.isfinite(front.sides).all(axis=1))
        if len(nothing):
            raise InputError(
                f"the law or the certificate at {number.name} = {front.values[nothing[0]]!r} proves nothing"
            )
        return front
