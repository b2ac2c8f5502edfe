"""What a synthesis returns."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING, dataclass, field, fields
from enum import StrEnum
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.exporting import exported
from optlaws.kept import kept_property
from optlaws.laws import Constants, MotionLaw
from optlaws.numbers import bounded
from optlaws.plotting import plotted
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.proof.peaks.certificate import PeakCertificate
from optlaws.synthesis.proof.power.certificate import PowerCertificate
from optlaws.synthesis.spaces.bases import PolynomialBasis, Powers
from optlaws.synthesis.spaces.splines import PiecewiseBasis

# an objective that is zero but for rounding, such as the jounce of a cubic, is judged absolutely
NOTHING = 1e-6


class Status(StrEnum):
    """How far a solution can be trusted; `advice` says what to do about it.

    Examples
    --------
    >>> Status.OPTIMAL.advice
    'The lower bound meets the objective: no law of this problem is better.'
    """

    OPTIMAL = "optimal"
    LOCAL = "local"
    INACCURATE = "inaccurate"

    @property
    def advice(self) -> str:
        """What the status means for the user."""
        return {
            Status.OPTIMAL: "The lower bound meets the objective: no law of this problem is better.",
            Status.LOCAL: "No better law was found from any start; the gap says how much better one could be.",
            Status.INACCURATE: "The law is sound but the bound does not meet it; change the degree a little.",
        }[self]


@dataclass(frozen=True)
class Solution:
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
        Contacts and multipliers; `certificate.bound` is a lower bound, by numpy alone.
    power_certificate
        Where D is in the problem and the bound was asked to be tight: the proof that closes the gap.
    peak_certificate
        Where a peak is bounded from below and the bound was asked to be tight: the proof that no place is better.
    lower_bound
        The best proven lower bound of the objective over all laws of the problem: a certificate's or the limit.
    limit
        What no law of any degree can beat; None where it is not known.
    status, iterations, seconds
        How it went: iterations of the solver on points (0 where a neighbour was continued) and the wall time.
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

    problem: Problem
    law: MotionLaw
    z_series: tuple[float, ...]
    objective: float
    certificate: Certificate
    lower_bound: float
    limit: float | None
    status: Status
    iterations: int
    seconds: float = field(compare=False)
    starts: tuple[float, ...] = ()
    power_certificate: PowerCertificate | None = field(default=None, repr=False)
    peak_certificate: PeakCertificate | None = field(default=None, repr=False)
    active_set: ActiveSet = field(repr=False, kw_only=True, compare=False)

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:  # noqa: ANN401 - called for what is not there yet
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
        return (
            Powers(basis.degree).coefficients(np.array(self.z_series)) if isinstance(basis, PolynomialBasis) else None
        )

    @property
    def gap(self) -> float:
        """(objective - lower bound) / objective; the difference itself where the objective is 0 but for rounding."""
        return (self.objective - self.lower_bound) / (self.objective if self.objective > NOTHING else 1.0)

    @property
    def versions(self) -> dict[str, str]:
        """Versions of the libraries that took part."""
        return dict(_versions())

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:  # noqa: ANN401 - matplotlib's
        """Draw the law as `MotionLaw.plot` does, with the bounds and windows of its problem and what no law can beat.

        Raises
        ------
        InputError
            If there are neither one nor four axes.

        Examples
        --------
        >>> import optlaws
        >>> artists = optlaws.synthesize(optlaws.Problem(B=1.859, order=4)).plot()
        >>> [artist.get_label() for artist in artists if "no law" in artist.get_label()][0]
        'no law has a smaller C: 4.02314'
        """
        return plotted("solution", self, ax, **style)

    def export(
        self,
        to: str,
        *,
        stroke: Any = None,  # noqa: ANN401 - a quantity
        time: Any = None,  # noqa: ANN401
        master: Any = None,  # noqa: ANN401
        start: Any = None,  # noqa: ANN401
        points: int | str | None = None,
        counts: int | None = None,
        digits: int | None = None,
        decimal: str | None = None,
        interpolation: str | None = None,
        task: str | None = None,
        name: str | None = None,
    ) -> Any:  # noqa: ANN401 - made a layer above
        """The law in the format of a controller, whose file and report say what is proven of it.

        Parameters
        ----------
        to
            The format: `optlaws export --list` names them.
        stroke, time, master, start
            As of `MotionLaw.export`: "35 mm", "0.1 s", "120 deg".
        points, counts, digits, decimal, interpolation, task, name
            As there.

        Raises
        ------
        InputError
            If there is no such format, it takes no such option, or it cannot hold the motion.

        Examples
        --------
        >>> from optlaws import Pieces, Problem, synthesize
        >>> solution = synthesize(Problem(B=1.859, order=4, basis=Pieces(8, degree=7, continuity=3)))
        >>> made = solution.export("codesys-cambuilder", stroke="35 mm", time="0.1 s", master="120 deg", name="Press")
        >>> [line.strip() for line in made.text.splitlines() if "none below" in line]
        ['law: least C = 4.59646..., none below 4.59646... in its space; status optimal']
        """
        said = {"stroke": stroke, "time": time, "master": master, "start": start}
        asked = {"points": points, "counts": counts, "digits": digits, "decimal": decimal}
        return exported("solution", self, to, said, **asked, interpolation=interpolation, task=task, name=name)

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict: the command line's `--json`, with the problem and the certificate beside it."""
        placed = {} if self.peak_certificate is None else {"peak_certificate": self.peak_certificate.to_dict()}
        return placed | {
            "status": self.status.value,
            "objective": self.objective,
            "lower_bound": bounded(self.lower_bound),
            "gap": bounded(self.gap),
            "limit": self.limit,
            "constants": self.constants.to_dict(),
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
        from optlaws.laws.html import drawings, table_of_constants
        from optlaws.shown.showing import facts, page

        known = {
            "status": self.status.value,
            str(self.problem.minimise): self.objective,
            "lower bound": self.lower_bound,
            "gap": f"{self.gap:.1e}",
            "limit": self.limit,
            "problem": self.problem.titled(repr(self.problem)),
        }
        return page("Solution", facts(known), table_of_constants(self.constants), drawings(self.law))

    def __repr__(self) -> str:
        limit = "" if self.limit is None else f"limit={self.limit:.9g}, "
        problem = self.problem.titled(repr(self.problem))
        return (
            f"Solution(status={self.status.value!r}, objective={self.objective:.9g}, "
            f"lower_bound={self.lower_bound:.9g}, gap={self.gap:.1e}, {limit}problem={problem})"
        )


def partly_known(known: dict[str, Any], later: Mapping[str, Callable[[Solution], Any]]) -> Solution:
    """A solution of which some attributes are computed when they are first asked for; equal to one that has all.

    Examples
    --------
    >>> import optlaws
    >>> whole = optlaws.synthesize(optlaws.Problem(B=1.859, order=4))
    >>> known = {entry.name: getattr(whole, entry.name) for entry in fields(whole) if entry.name != "law"}
    >>> partly_known(known, {"law": lambda whole_one: whole.law}) == whole
    True
    """
    made = object.__new__(Solution)
    made.__dict__.update(_DEFAULTS | known, _later=later)
    return made


_DEFAULTS = {entry.name: entry.default for entry in fields(Solution) if entry.default is not MISSING}


@cache
def _versions() -> tuple[tuple[str, str], ...]:
    # it takes as long to import as all of optlaws that a law needs
    from importlib.metadata import version

    return tuple((name, version(name)) for name in ("optlaws", "casadi", "numpy"))
