"""Search for the proof that no law is better although a peak is bounded from below: cells are cut until all hold."""

from __future__ import annotations

from dataclasses import dataclass

from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.method.exchange import solve
from optlaws.synthesis.problem.constants import Peak
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import OBJECTIVE
from optlaws.synthesis.proof.make import certificate
from optlaws.synthesis.proof.peaks.certificate import Cell, PeakCertificate, excluded
from optlaws.synthesis.proof.peaks.rows import PeakRows

_PROGRAMS = 1500
_LEAST_REACH = 1e-9
_HOPELESS, _NEARLY, _HARDLY = 1.5, 4.0, 1e-9


@dataclass(frozen=True, eq=False)
class Search:
    """How a search ended: with a certificate, or at a place where better laws seem to have the peak, or in vain."""

    certificate: PeakCertificate | None = None
    better_at: float | None = None


@dataclass(frozen=True, eq=False)
class _Part:
    """Places from one to another, with the optimum at the middle of the part they were cut from, and its margin."""

    begin: float
    end: float
    warm: ActiveSet | None = None
    margin: float | None = None

    def halves(self, warm: ActiveSet | None, margin: float | None) -> list[_Part]:
        middle = (self.begin + self.end) / 2.0
        return [_Part(middle, self.end, warm, margin), _Part(self.begin, middle, warm, margin)]


def search(problem: Problem, peak: Peak, claim: float) -> Search:
    """Cut the places into cells that cannot have the peak in laws below the claim."""
    rows = PeakRows(problem, peak, claim)
    cells: list[Cell] = []
    left = _PROGRAMS
    for sign in rows.signs:
        parts = [_Part(0.0, rows.stop), *(_Part(end, end) for end in rows.ends)]
        while parts:
            part = parts.pop()
            k, reach = (part.begin + part.end) / 2.0, (part.end - part.begin) / 2.0
            if _too_wide(rows, part, k, reach):
                parts += part.halves(part.warm, part.margin)
                continue
            left -= 1
            cell, optimum, most = _cell(rows, part, k, sign)
            if excluded(rows, cell):
                cells.append(cell)
            elif optimum is not None and most > rows.low:
                return Search(better_at=k)
            elif left <= 0 or reach < _LEAST_REACH:
                return Search()
            else:
                parts += part.halves(optimum, None if optimum is None else rows.low - most)
    proof = PeakCertificate(problem, peak.name, claim, tuple(cells))
    return Search(certificate=proof if proof.proven else None)


def _too_wide(rows: PeakRows, part: _Part, k: float, reach: float) -> bool:
    """Whether it is not worth a program to see that the part is to be cut."""
    remainder = rows.remainder(k, reach)
    room = None if part.margin is None else max(part.margin, _HARDLY * rows.low)
    return reach > _LEAST_REACH and (
        remainder > _HOPELESS * rows.low or (room is not None and remainder > _NEARLY * room)
    )


def _cell(rows: PeakRows, part: _Part, k: float, sign: float) -> tuple[Cell, ActiveSet | None, float]:
    """The cell, with the optimum of its middle and the value there."""
    reach = (part.end - part.begin) / 2.0
    model, base = rows.at(k, sign)
    without = Cell(k, reach, sign, (), ())
    if excluded(rows, without):
        return without, None, base
    optimum = solve(model.program, part.warm).optimum
    if optimum is None:
        return without, None, base
    proof = certificate(model, optimum, OBJECTIVE)
    return Cell(k, reach, sign, proof.contacts, proof.equations), optimum, base - model.program.worth(optimum.x)
