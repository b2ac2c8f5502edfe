"""Proof that no law has an objective below a claim although a peak is bounded from below; no solver in it.

Where a peak is held up its place is not known, and the problem is not convex. But for each place k the greatest value
that laws below the claim can have there is a convex problem, and contacts bound it. At a peak inside the interval the
slope is 0, so the value beside it is less by the curvature at most, which the claim bounds too: a cell around k can
have no peak if the bound at k and that remainder do not reach what is asked. The cells cover the interval.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from fractions import Fraction
from math import inf, isfinite
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import Contact, contact_of
from optlaws.synthesis.proof.data import StatedCell, StatedPeakCertificate, problem_of, stated
from optlaws.synthesis.proof.peaks.rows import PeakRows, peak_of

#: of what is asked: more than the rounding of the sums can be
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Cell:
    """Places around k, as far as `reach`, at which no law below the claim has the peak; k alone for a reach of 0.

    Examples
    --------
    >>> Cell(0.25, 0.125, 1.0, (Contact("C", 1.0, 0.1, 0.5),), ()).reach
    0.125
    """

    k: float
    reach: float
    sign: float
    contacts: tuple[Contact, ...]
    equations: tuple[float, ...]

    def __post_init__(self) -> None:
        finite = all(map(isfinite, (self.k, self.reach, *self.equations)))
        if not finite or not 0.0 <= self.k <= 1.0 or not 0.0 <= self.reach <= 1.0 or abs(self.sign) != 1.0:
            raise InputError(
                f"a cell needs k and its reach in [0, 1], a sign and finite multipliers, got {shortened(self)}"
            )


@dataclass(frozen=True)
class PeakCertificate:
    """Cells that prove a lower bound of an objective where a peak is bounded from below.

    Attributes
    ----------
    problem
        Of which problem it speaks.
    constant
        The name of the peak that is bounded from below.
    claim
        What no law's objective is below.
    cells
        They cover the interval for each sign, and its ends.

    Examples
    --------
    >>> import optlaws
    >>> problem = optlaws.Problem(B=optlaws.at_least(2.2), order=3, minimise="rms_c")
    >>> solution = optlaws.synthesize(problem, bound="tight")
    >>> solution.status.value, solution.peak_certificate.bound == solution.lower_bound
    ('optimal', True)
    """

    problem: Problem
    constant: str
    claim: float
    cells: tuple[Cell, ...]

    def __post_init__(self) -> None:
        if not isfinite(self.claim) or self.claim <= 0.0:
            raise InputError(f"a peak certificate needs a finite claim above 0, got {shortened(self.claim)}")

    @kept_property
    def bound(self) -> float:
        """The claim if the cells prove it, recomputed by numpy; else minus infinity."""
        return self.claim if self.proven else -inf

    @kept_property
    def proven(self) -> bool:
        """Whether the cells cover every place and none can have the peak."""
        peak = peak_of(self.problem, self.constant)
        if peak is None:
            return False
        rows = PeakRows(self.problem, peak, self.claim)
        return all(_covered(rows, self.cells, sign) for sign in rows.signs) and all(
            excluded(rows, cell) for cell in self.cells
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict with the recomputed bound (None where nothing is proven)."""
        return {
            "problem": self.problem.to_dict(),
            "constant": self.constant,
            "claim": self.claim,
            "cells": [asdict(cell) for cell in self.cells],
            "bound": self.bound if isfinite(self.bound) else None,
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> PeakCertificate:
        """Read what `to_dict` wrote; the bound is recomputed, not read.

        Raises
        ------
        InputError
            If an entry is missing or wrong.
        """
        entries = stated(data, StatedPeakCertificate, "peak certificate")
        return cls(problem_of(entries.problem), entries.constant, entries.claim, tuple(map(_read, entries.cells)))


def excluded(rows: PeakRows, cell: Cell) -> bool:
    """Whether no law below the claim has the peak in the cell."""
    most = rows.upper(cell.k, cell.sign, cell.contacts, cell.equations) + rows.remainder(cell.k, cell.reach)
    return most < rows.low * (1.0 - _ROUNDING)


def _covered(rows: PeakRows, cells: tuple[Cell, ...], sign: float) -> bool:
    """Whether the cells of a sign leave no place of the interval out; at its ends the slope need not be 0."""
    wide = [cell for cell in cells if cell.sign == sign and cell.reach > 0.0]
    ascending = sorted(wide, key=lambda cell: Fraction(cell.k) - Fraction(cell.reach))
    alone = {cell.k for cell in cells if cell.sign == sign and cell.reach == 0.0}
    if not alone >= set(rows.ends):
        return False
    reached = Fraction(0)
    for cell in ascending:
        if Fraction(cell.k) - Fraction(cell.reach) > reached:
            return False
        reached = max(reached, Fraction(cell.k) + Fraction(cell.reach))
    return reached >= Fraction(rows.stop)


def _read(entries: StatedCell) -> Cell:
    return Cell(entries.k, entries.reach, entries.sign, tuple(map(contact_of, entries.contacts)), entries.equations)
