"""The result of a synthesis: an optimal law with its proof."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING, dataclass, field, fields, replace
from functools import cache
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from optlaws.files.reading import JsonText
from optlaws.kept import former_name, kept_property
from optlaws.laws import Constants, MotionLaw
from optlaws.laws.law import LawExport
from optlaws.numbers import bounded
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.spaces.bases import PiecewiseBasis, PolynomialBasis, Powers
from optlaws.synthesis.status import Status, gap_text, measure

if TYPE_CHECKING:
    from optlaws.shown.report import Report
    from optlaws.shown.summary import Summary
    from optlaws.synthesis.limits.drive_limits import DriveLimit

_MAY_TURN_BACK = (
    "there is no proof here for laws that may turn back: with monotone=True, for laws that never turn back, the best "
    "possible of all degrees is known"
)


@dataclass(frozen=True)
class Solution(LawExport, JsonText):
    """An optimal law with its proof. Every number is recomputed from the law on the whole interval.

    Solutions are equal where problem, law, proof and numbers are, however long they took.

    Attributes
    ----------
    problem
        What was solved.
    law
        The motion law.
    z_series
        Chebyshev coefficients of Z in 2k - 1, whatever the problem's basis; on each piece where Z is piecewise.
    objective
        The objective, recomputed from `law`.
    certificate
        Contacts and multipliers; `certificate.bound` is a lower bound, with every rounding enclosed.
    power_certificate
        Where D is in the problem and a tight bound was requested: the proof that closes the gap.
    peak_certificate
        Where a peak is bounded from below and a tight bound was requested: the proof that no place is better.
    drive_limit
        Of a drive's torque or energy that is not convex: its lower bound for all laws that never turn back.
    lower_bound
        The best proven lower bound of the objective over all laws of the problem, with its order, basis, bounds and
        windows: a certificate's or `best_possible`.
    best_possible
        A lower bound for laws of the problem's order and within its bounds, of any degree: a closed form. None
        where none is known, as for ends other than rest.
    status, iterations, seconds
        How it went: iterations of the solver on points (0 where a neighbour's contacts led to the law) and the wall
        time.
    starts
        Where the problem is not convex: the objectives that the starts led to, ascending.
    active_set
        Contacts and multipliers in the solver's own terms, from which a neighbouring problem is continued.
    versions
        Versions of optlaws and of the libraries that took part.

    Examples
    --------
    >>> import optlaws
    >>> solution = optlaws.synthesize(optlaws.Problem(B=1.859, order=4, basis=optlaws.Powers(3)))
    >>> solution.status.value, round(solution.objective, 6), solution.gap < 1e-8
    ('optimal', 5.917851, True)
    """

    _json_name = "a solution"

    problem: Problem
    law: MotionLaw
    z_series: tuple[float, ...]
    objective: float
    certificate: Certificate
    lower_bound: float
    best_possible: float | None
    status: Status
    iterations: int = field(compare=False)
    seconds: float = field(compare=False)
    starts: tuple[float, ...] = ()
    power_certificate: Certificate | None = field(default=None, repr=False)
    peak_certificate: Certificate | None = field(default=None, repr=False)
    drive_limit: DriveLimit | None = field(default=None, repr=False)
    active_set: ActiveSet = field(repr=False, kw_only=True, compare=False)
    limit = former_name("limit", "best_possible")

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            later = self.__dict__.get("_later", {})
            if name not in later:
                raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self)
            value = later[name](self)
            self.__dict__[name] = value
            return value

    def __getstate__(self) -> dict[str, Any]:
        for name in self.__dict__.get("_later", ()):
            getattr(self, name)
        return {name: value for name, value in self.__dict__.items() if name != "_later"}

    @property
    def constants(self) -> Constants:
        """B, C, D, J of the law, each with its k, and the RMS of c."""
        return self.law.constants

    @kept_property
    def z(self) -> tuple[float, ...] | None:
        """Coefficients of Z in the problem's basis; None for a law of pieces, which has no Z."""
        basis = self.problem.basis
        if isinstance(basis, PolynomialBasis | PiecewiseBasis):
            return basis.coefficients(np.array(self.z_series))
        return None

    @kept_property
    def z_powers(self) -> tuple[float, ...] | None:
        """Coefficients of Z in ascending powers of k, whatever the problem's basis; None for a law of pieces."""
        basis = self.problem.basis
        powers = Powers(basis.degree) if isinstance(basis, PolynomialBasis) else None
        return None if powers is None else powers.coefficients(np.array(self.z_series))

    @property
    def gap(self) -> float:
        """(objective - lower bound) / objective; relative to its scale where the objective is 0 up to rounding."""
        return (self.objective - self.lower_bound) / measure(self.objective, self.problem.objective.scale)

    @property
    def notes(self) -> tuple[str, ...]:
        """Remarks on the problem that was solved.

        Examples
        --------
        >>> import optlaws
        >>> optlaws.synthesize(optlaws.Problem(order=3, minimise="rms(c + 4*a)")).notes
        ('laws need not be symmetric: rms(c + 4*a) differs between a law and its mirror image',)
        """
        problem = self.problem
        local = self.status is Status.LOCAL and not problem.monotone
        notes = (_MAY_TURN_BACK,) if local and _has_drive_limit(replace(problem, monotone=True)) else ()
        if problem.symmetric or problem.boundary is not None or not problem.uneven:
            return notes
        names = problem.titled(" and ".join(map(repr, problem.uneven)))
        verb = "differs" if len(problem.uneven) == 1 else "differ"
        return (*notes, f"laws need not be symmetric: {names} {verb} between a law and its mirror image")

    def summary(self) -> Summary:
        """Rows with the status, the proven bounds and the constants of the law.

        Examples
        --------
        >>> import optlaws
        >>> rows = optlaws.synthesize(optlaws.Problem(B=1.859, order=4)).summary()
        >>> [row.name for row in rows][:4], rows[3].text(5)
        (['status', 'C', 'lower bound', 'best possible'], '4.0231')
        >>> rows[3].note
        'no law of order 4 with this B is below it, whatever its degree'
        """
        from optlaws.shown.summary import Row, Summary
        from optlaws.synthesis.limits.of_problem import limited_laws

        problem, starts = self.problem, self.starts
        rows = [
            Row("status", self.status.value, note=self.status.advice),
            Row(problem.titled(str(problem.minimise)), self.objective),
            Row("lower bound", "none above 0 is known")
            if self._is_without_bound
            else Row("lower bound", self.lower_bound, note=gap_text(self.gap)),
        ]
        if self.best_possible is not None:
            laws = f"no {limited_laws(problem)} is below it, whatever its degree"
            rows.append(Row("best possible", self.best_possible, note=laws))
        if self.drive_limit is not None:
            laws = "no law that never turns back is below it, whatever its order and degree"
            if self.drive_limit.plane.within_jerk:
                laws = "no law from order 3 on within this jerk that never turns back is below it, whatever its degree"
            rows.append(Row("best possible", self.drive_limit.value, note=laws))
            if self.drive_limit.value > 0.0:
                cost = self.objective / self.drive_limit.value - 1.0
                rows.append(Row("cost of order and degree", 100.0 * cost, "%", note="at most"))
        if starts:
            rows.append(Row("starts", f"{len(starts)}", note=f"from {starts[0]:.10g} to {starts[-1]:.10g}"))
        if self.z is not None:
            rows.append(Row("Z(k)", " ".join(f"{number:.9g}" for number in self.z), note=problem.basis.name))
        rows.append(Row("solved", problem.titled(repr(problem))))
        rows.append(Row("", f"{self.iterations} iterations, {1e3 * self.seconds:.0f} ms"))
        return Summary([*rows, *self.constants.summary(), *(Row("note", note) for note in self.notes)], at="k")

    def report(self) -> Report:
        """The summary, and the curves of the law with the limits of the problem, as values that outputs render.

        Examples
        --------
        >>> import optlaws
        >>> velocity = optlaws.synthesize(optlaws.Problem(B=1.859, order=4)).report().panels[1]
        >>> velocity.limits[0].name, velocity.peak
        ('B = 1.859', 1.859)
        """
        from optlaws.synthesis.report import SolutionReport

        return SolutionReport(self.law, self)

    @property
    def _is_without_bound(self) -> bool:
        """Whether nothing is proven but that the objective, which is above 0, is not below it."""
        return self.gap == 1.0

    @property
    def versions(self) -> dict[str, str]:
        """Versions of the libraries that took part."""
        return versions()

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:
        """Draw the law as `MotionLaw.plot` does, with the bounds and windows of its problem and `best_possible`.

        Raises
        ------
        InputError
            If there are neither one nor four axes.

        Examples
        --------
        >>> import optlaws
        >>> artists = optlaws.synthesize(optlaws.Problem(B=1.859, order=4)).plot()
        >>> [artist.get_label() for artist in artists if "no law" in artist.get_label()][0]
        'no law of order 4 with this B has a smaller C: 4.02314'
        """
        from optlaws.plots.law import draw_solution

        return draw_solution(self, ax, **style)

    def _exported(self) -> tuple[MotionLaw, tuple[str, ...]]:
        least = f"least {self.problem.minimise} = {self.objective:.9g}"
        bound = (
            "no bound above 0 is known"
            if self._is_without_bound
            else f"lower bound {self.lower_bound:.9g} in its space"
        )
        return self.law, (f"law: {least}, {bound}; status {self.status.value}",)

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict: the command line's `--json`, with the problem and the certificate beside it.

        `optlaws verify` checks it, and `from_dict` reads it again.
        """
        from optlaws.synthesis.stored_rows import plain_state

        return self.claims() | {"state": plain_state(self.z_series, self.active_set)}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """Read the output of `to_dict`; numbers are checked against the law, bounds against the proofs.

        Raises
        ------
        InputError
            If an entry is missing or wrong, or one states what does not follow from problem, law and proofs.

        Examples
        --------
        >>> import optlaws
        >>> solution = optlaws.synthesize(optlaws.Problem(B=1.859, order=4))
        >>> optlaws.Solution.from_json(solution.to_json()) == solution
        True
        """
        from optlaws.synthesis.stored_rows import read_row

        return cls(**read_row(data))

    def claims(self) -> dict[str, Any]:
        """The data of `to_dict` without `state`: the verifiable part, and the course of the search."""
        beside = {"peak_certificate": self.peak_certificate, "drive_limit": self.drive_limit}
        placed = {name: proof.to_dict() for name, proof in beside.items() if proof is not None}
        return placed | {
            "status": self.status.value,
            "objective": self.objective,
            "lower_bound": bounded(self.lower_bound),
            "gap": bounded(self.gap),
            "best_possible": self.best_possible,
            "constants": self.constants.to_dict(rms=False),
            "z": None if self.z is None else list(self.z_powers or self.z),
            "law": self.law.to_dict(),
            "iterations": self.iterations,
            "seconds": self.seconds,
            "problem": self.problem.to_dict(),
            "certificate": self.certificate.to_dict(),
            "power_certificate": None if self.power_certificate is None else self.power_certificate.to_dict(),
            "starts": list(self.starts),
            "versions": self.versions,
        }

    def _repr_html_(self) -> str:
        from optlaws.shown.report import report_page

        return report_page("Solution", self.report())

    def __repr__(self) -> str:
        best = "" if self.best_possible is None else f"best_possible={self.best_possible:.9g}, "
        problem = self.problem.titled(repr(self.problem))
        return (
            f"Solution(status={self.status.value!r}, objective={self.objective:.9g}, "
            f"lower_bound={self.lower_bound:.9g}, gap={self.gap:.1e}, {best}problem={problem})"
        )


def partly_known(known: dict[str, Any], later: Mapping[str, Callable[[Solution], Any]]) -> Solution:
    """A solution whose attributes are partly computed at first use; equal to a complete one."""
    solution = object.__new__(Solution)
    solution.__dict__.update(_DEFAULTS | known, _later=later)
    return solution


def _has_drive_limit(problem: Problem) -> bool:
    from optlaws.synthesis.limits.plane_of_problem import plane_of

    return plane_of(problem) is not None


_DEFAULTS = {entry.name: entry.default for entry in fields(Solution) if entry.default is not MISSING}


def versions() -> dict[str, str]:
    """Versions of optlaws and of the libraries of which another release may find other laws, or the same otherwise."""
    return dict(_versions())


@cache
def _versions() -> tuple[tuple[str, str], ...]:
    # it takes as long to import as all of optlaws that a law needs
    from importlib.metadata import version

    return tuple((name, version(name)) for name in ("optlaws", "casadi", "clarabel", "numpy", "scipy"))
