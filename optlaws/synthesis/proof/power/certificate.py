"""Proof that no law has an objective below a claim although D or a loader's peak is in it; no solver in it.

These are not convex. Boxes hold every law that could contradict the claim. Sums of rows move their sides inward until a
box is empty, or a box is cut in two. The proof stands where no box is left.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from math import inf, isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.numbers import bounded
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import Contact, contact_of
from optlaws.synthesis.proof.data import StatedPowerCertificate, StatedStep, problem_of, stated
from optlaws.synthesis.proof.power.box import Box, BoxRows
from optlaws.synthesis.proof.power.rows_of_problem import rows_of

Array = NDArray[np.float64]

#: of the sum of all magnitudes: more than the rounding errors of the sums can be
_ROUNDING = 1e-13


@dataclass(frozen=True)
class Step:
    """One move of a side of the box at work, proven by a sum of rows; or its emptiness.

    Attributes
    ----------
    variable
        Which variable's side moves; -1 says that no law is in the box.
    side
        1 raises the least value, -1 lowers the greatest.
    contacts, equations, claim
        Multipliers of the rows at contacts, of the program's equations, and of "the objective is below the claim".

    Examples
    --------
    >>> Step(0, 1, (Contact("power", 1.0, 0.25, 0.5),), (0.1,)).side
    1
    """

    variable: int
    side: int
    contacts: tuple[Contact, ...]
    equations: tuple[float, ...]
    claim: float = 0.0

    def __post_init__(self) -> None:
        if self.side not in {1, -1} or not all(map(isfinite, (*self.equations, self.claim))):
            raise InputError(f"a step needs a side 1 or -1 and finite multipliers, got {shortened(self)}")


@dataclass(frozen=True)
class Cut:
    """The box at work is cut in two at a value of a variable; the part below comes first."""

    variable: int
    at: float

    def __post_init__(self) -> None:
        if not isfinite(self.at):
            raise InputError(f"a cut needs a finite value, got {shortened(self.at)}")


@dataclass(frozen=True)
class PowerCertificate:
    """Steps and cuts that prove a lower bound of an objective with D in it, or with C or D of a loader.

    Attributes
    ----------
    problem
        Of which problem it speaks.
    claim
        What no law's objective is below.
    points
        The k at which boxes bound the velocity.
    steps
        What is done to the box at work: the first is that of all laws, and when it is empty the one cut off last
        follows.

    Examples
    --------
    >>> import optlaws
    >>> problem = optlaws.Problem(B=1.641, order=4, minimise="D")
    >>> solution = optlaws.synthesize(problem, bound="tight")
    >>> solution.status.value, solution.power_certificate.bound == solution.lower_bound
    ('optimal', True)
    """

    problem: Problem
    claim: float
    points: tuple[float, ...]
    steps: tuple[Step | Cut, ...]

    def __post_init__(self) -> None:
        if not isfinite(self.claim) or self.claim <= 0.0 or not all(0.0 <= k <= 1.0 for k in self.points):
            raise InputError(
                f"a power certificate needs a finite claim above 0 and points in [0, 1], got {shortened(self)}"
            )

    @kept_property
    def bound(self) -> float:
        """The claim if the steps prove it, recomputed by numpy; else minus infinity."""
        return self.claim if self.proven else -inf

    @kept_property
    def proven(self) -> bool:
        """Whether no box is left."""
        rows = rows_of(self.problem, self.claim, self.points)
        if rows is None or not rows.regular:
            return False
        boxes = [rows.root()]
        for step in self.steps:
            if not boxes:
                return False
            box = boxes.pop()
            if not 0 <= step.variable < rows.size and (isinstance(step, Cut) or step.variable != -1):
                return False
            if isinstance(step, Cut):
                boxes += [box.cut(step.variable, 1, step.at), box.cut(step.variable, -1, step.at)]
                continue
            moved = moved_by(rows, box, step)
            if moved is not None:
                boxes.append(moved)
        return not boxes

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict with the recomputed bound (None where nothing is proven)."""
        return {
            "problem": self.problem.to_dict(),
            "claim": self.claim,
            "points": list(self.points),
            "steps": [_written(step) for step in self.steps],
            "bound": bounded(self.bound),
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> PowerCertificate:
        """Read what `to_dict` wrote; the bound is recomputed, not read.

        Raises
        ------
        InputError
            If an entry is missing or wrong.
        """
        entries = stated(data, StatedPowerCertificate, "power certificate")
        return cls(problem_of(entries.problem), entries.claim, entries.points, tuple(map(_read, entries.steps)))


def moved_by(rows: BoxRows, box: Box, step: Step) -> Box | None:
    """The box after a step; None if it is empty.

    Rows that the problem does not ask for, and negative multipliers of rows, count as zero.
    """
    value = least_sum(rows, box, step)
    if step.variable < 0:
        return None if value > 0.0 else box
    side = step.side * value
    low, high = float(box.low[step.variable]), float(box.high[step.variable])
    if (step.side > 0 and side > high) or (step.side < 0 and side < low):
        return None
    if low < side < high:
        return box.cut(step.variable, step.side, side)
    return box


def least_sum(rows: BoxRows, box: Box, step: Step) -> float:
    """What side times the variable is at least in the box: the sum of the rows is at most 0, so it can join."""
    equations = rows.equations()[: len(step.equations)]
    joined = np.vstack([rows.of_contacts(step.contacts, box), equations, rows.objective()])
    multipliers = [max(contact.multiplier, 0.0) for contact in step.contacts]
    weights = np.array([*multipliers, *step.equations[: len(equations)], max(step.claim, 0.0)])
    own = np.zeros(rows.size + 1)
    if step.variable >= 0:
        own[step.variable] = float(step.side)
    total = own + weights @ joined
    size = np.abs(own) + np.abs(weights) @ np.abs(joined)
    greatest = np.append(np.maximum(np.abs(box.low), np.abs(box.high)), 1.0)
    return float(box.extent(total[None])[0][0]) - _ROUNDING * float(size @ greatest)


def _written(step: Step | Cut) -> dict[str, Any]:
    data = asdict(step)
    for contact in data.get("contacts", []):
        if not contact["direction"]:
            del contact["direction"]
    return data


def _read(entries: StatedStep) -> Step | Cut:
    own = (entries.side, entries.contacts, entries.equations, entries.claim)
    if entries.at is not None and own == (None, None, None, None):
        return Cut(entries.variable, entries.at)
    if entries.at is None and None not in own:
        side, contacts, equations, claim = own
        return Step(entries.variable, side or 0, tuple(map(contact_of, contacts or ())), equations or (), claim or 0.0)
    raise InputError("this is not a power certificate: a step has side, contacts, equations and claim, a cut has at")
