"""Lower bounds that stand by themselves: trees of contacts and multipliers.

Every law of the problem, with its own constants as variables, obeys the rows of the program. Added up with multipliers
m >= 0 (any sign for equations) to the objective they give an affine function of the coordinates of the law, and its
value is a lower bound of the objective wherever it is constant. A convex problem needs one such sum, a leaf. Others are
split into regions, of which leaves show that no law below a claim is in them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf, isfinite
from typing import TYPE_CHECKING, Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import JsonText
from optlaws.kept import kept_property
from optlaws.numbers import bounded
from optlaws.numerics.exact import rounded_down
from optlaws.synthesis.problem.constants import present_name
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.program.writer import Model, least_violation, model_of, relaxed
from optlaws.synthesis.proof.duality import Line, lines_of, sum_of_rows
from optlaws.synthesis.proof.nodes import Contact, Leaf, Node, closes

if TYPE_CHECKING:
    from optlaws.synthesis.proof.peak_rows import PeakRows
    from optlaws.synthesis.proof.power.box import BoxRows


OBJECTIVE, RELAXED, VIOLATION = "objective", "relaxed", "violation"


@dataclass(frozen=True)
class Certificate(JsonText):
    """A tree of leaves, splits and tightenings that proves a lower bound of an objective, or that there is no law.

    Attributes
    ----------
    problem
        The problem, of which it bounds every law, symmetric or not unless symmetry is required.
    claim
        What no law's objective is below; None for what the only leaf proves, infinite where there is no law at all.
    tree
        Each node before those below it, the part below a split before the part above: a node is applied to the region
        that was cut off last, and the claim is proven where no region is left.
    tangent
        Of a problem that is not convex: where the convex program that its laws obey too replaces D by its tangent.
    points
        The k at which regions bound the velocity; beside these velocities they bound the program's own variables.
    peak
        The constant that is bounded from below, if regions are places at which laws may have its peak.

    Examples
    --------
    >>> import optlaws
    >>> solution = optlaws.synthesize(optlaws.Problem(B=1.859, order=4, basis=optlaws.Chebyshev(9)))
    >>> bool(solution.certificate.bound <= solution.constants.C.value)
    True
    >>> power = optlaws.synthesize(optlaws.Problem(B=1.641, order=4, minimise="D"), bound="tight")
    >>> power.power_certificate.bound == power.lower_bound, len(power.power_certificate.tree) > 1
    (True, True)
    """

    _json_name = "a certificate"

    problem: Problem
    claim: float | None
    tree: tuple[Node, ...]
    tangent: float | None = None
    points: tuple[float, ...] | None = None
    peak: str = ""

    def __post_init__(self) -> None:
        # rows have the square of the tangent
        if self.tangent is not None and not isfinite(self.tangent * self.tangent):
            raise InputError("the tangent of a certificate must be finite, and its square too")
        if self.claim is not None and not self.claim > 0.0:
            raise InputError(f"the claim of a certificate must be above 0, got {shortened(self.claim)}")
        if not all(0.0 <= k <= 1.0 for k in self.points or ()):
            raise InputError(f"the points of a certificate must be in [0, 1], got {shortened(self.points)}")
        one_leaf = len(self.tree) == 1 and type(self.tree[0]) is Leaf
        divided = (self.points is not None) + bool(self.peak)
        if divided > 1 or (divided == 0) != (self.claim in {None, inf}) or not (divided or one_leaf):
            raise InputError("a certificate is one leaf, or has a finite claim with points or a peak for its tree")

    @classmethod
    def of_leaf(
        cls,
        problem: Problem,
        contacts: Sequence[Contact] = (),
        equations: Sequence[float] = (),
        program: str = OBJECTIVE,
        tangent: float = 0.0,
    ) -> Certificate:
        """The certificate of one sum of rows: of the problem's own program, its relaxed one, or of their violation.

        Raises
        ------
        InputError
            If there is no such program, or a number is not finite.

        Examples
        --------
        >>> Certificate.of_leaf(Problem(order=2), (Contact("C", 1.0, 0.0, 1.0),)).program
        'objective'
        """
        if program not in {OBJECTIVE, RELAXED, VIOLATION} or not isfinite(tangent):
            raise InputError(
                "the program of a certificate must be objective, relaxed or violation, and its tangent finite, got "
                f"{shortened(program)} and {shortened(tangent)}"
            )
        leaf = Leaf(tuple(contacts), tuple(equations))
        return cls(problem, inf if program == VIOLATION else None, (leaf,), tangent if program == RELAXED else None)

    @property
    def program(self) -> str:
        """The program whose rows a leaf adds up: "objective", "relaxed" or "violation"."""
        return VIOLATION if self.claim == inf else OBJECTIVE if self.tangent is None else RELAXED

    @property
    def leaf(self) -> Leaf:
        """The last sum of rows: the only one where nothing is split."""
        last = self.tree[-1] if self.tree else None
        return last if isinstance(last, Leaf) else Leaf()

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """The contacts of all leaves and tightenings, in the order of the tree."""
        return tuple(contact for node in self.tree if isinstance(node, Leaf) for contact in node.contacts)

    @property
    def equations(self) -> tuple[float, ...]:
        """The equations' multipliers of the leaf."""
        return self.leaf.equations

    def with_leaf(
        self, *, contacts: Sequence[Contact] | None = None, equations: Sequence[float] | None = None
    ) -> Certificate:
        """The certificate with other contacts or equations in its last leaf.

        Examples
        --------
        >>> proof = Certificate.of_leaf(Problem(order=2), (Contact("C", 1.0, 0.0, 1.0),))
        >>> proof.with_leaf(contacts=()).contacts
        ()
        """
        leaf = self.leaf
        changed = replace(
            leaf,
            contacts=leaf.contacts if contacts is None else tuple(contacts),
            equations=leaf.equations if equations is None else tuple(equations),
        )
        return replace(self, tree=(*self.tree[:-1], changed))

    @kept_property
    def estimate(self) -> float:
        """A bound of one leaf in doubles, less what their rounding may hide: quick, and mostly as good as `bound`."""
        with np.errstate(over="ignore", invalid="ignore"):
            model, lines = weighted_rows(self)
            value = float(model.unit * sum_of_rows(model, lines))
        return value if isfinite(value) else -inf

    @kept_property
    def bound(self) -> float:
        """The proven lower bound of the objective, with every rounding enclosed; minus infinity where none is proven.

        In doubles, as `estimate`, where a constant is a user's own that exact arithmetic does not know.
        """
        if self.claim is None:
            return self._leaf_bound()
        return self.claim if self.proven and self.claim < inf else -inf

    def _leaf_bound(self) -> float:
        from optlaws.verification import exact_bound

        try:
            exact = exact_bound(self)
        except InputError:
            return self.estimate
        return -inf if exact is None else rounded_down(exact)

    @kept_property
    def proven(self) -> bool:
        """Whether the tree proves its claim: whether it leaves no region of the laws below it."""
        if self.claim is None:
            return self.bound > -inf
        if self.claim == inf:
            return self._leaf_bound() > 0.0
        rows: Any = self._regions()
        return rows is not None and closes(self.tree, rows.roots(), rows.after)

    @property
    def proves_infeasible(self) -> bool:
        """Whether the contacts contradict each other (Farkas): every law breaks one by more than 0."""
        return self.claim == inf and self.proven

    def _regions(self) -> BoxRows | PeakRows | None:
        """The rows of regions; None where nothing of the problem can be bounded so."""
        claim = self.claim or 0.0
        if self.points is not None:
            from optlaws.synthesis.proof.power.rows import rows_of

            rows = rows_of(self.problem, claim, self.points)
            return rows if rows is not None and rows.regular else None
        from optlaws.synthesis.proof.peak_rows import PeakRows, peak_of

        peak = peak_of(self.problem, self.peak)
        return None if peak is None else PeakRows(self.problem, peak, claim)

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict with the recomputed bound (None without one): docs/reference/proof-format.md."""
        from optlaws.synthesis.proof import data as stored

        entries: dict[str, Any]
        if self.points is not None:
            entries = {"claim": self.claim, "points": list(self.points), "steps": stored.steps(self.tree)}
        elif self.peak:
            from optlaws.synthesis.proof.peak_rows import roots_of

            cells = stored.cells(self.tree, roots_of(self.problem, self.peak))
            entries = {"constant": self.peak, "claim": self.claim, "cells": cells}
        else:
            entries = {"program": self.program, "tangent": self.tangent or 0.0, **stored.sum_of(self.leaf)}
        return {"problem": self.problem.to_dict(), **entries, "bound": bounded(self.bound)}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Certificate:
        """Read what `to_dict` wrote; the bound is recomputed, not read.

        Raises
        ------
        InputError
            If an entry is missing or wrong.
        """
        from optlaws.synthesis.proof import data as stored

        entries = stored.stated_certificate(data)
        problem = stored.problem_of(entries.problem)
        if isinstance(entries, stored.StatedLeaf):
            contacts = stored.contacts_of(entries.contacts)
            return cls.of_leaf(problem, contacts, entries.equations, entries.program, entries.tangent)
        if isinstance(entries, stored.StatedBoxes):
            return cls(problem, entries.claim, tuple(map(stored.node_of, entries.steps)), points=entries.points)
        from optlaws.synthesis.proof.peak_rows import roots_of

        peak = present_name(entries.constant)
        return cls(problem, entries.claim, stored.tree_of_cells(entries.cells, roots_of(problem, peak)), peak=peak)


def weighted_rows(certificate: Certificate) -> tuple[Model, list[Line]]:
    """The program of a certificate of one leaf, and its rows as `lines_of` gives them."""
    model = model_of_leaf(certificate)
    return model, lines_of(model.program, certificate.leaf)


def model_of_leaf(certificate: Certificate) -> Model:
    """The program whose rows a certificate of one leaf adds up."""
    if certificate.tangent is not None:
        return relaxed(certificate.problem, certificate.tangent)
    return least_violation(certificate.problem) if certificate.program == VIOLATION else model_of(certificate.problem)
