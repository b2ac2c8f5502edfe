"""Search for the proof that no law is better although a peak is bounded from below: places are cut until all hold."""

from __future__ import annotations

from dataclasses import dataclass

from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.method.exchange import solve
from optlaws.synthesis.problem.constants import PeakConstant
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.certificate import OBJECTIVE, Certificate
from optlaws.synthesis.proof.make import certificate
from optlaws.synthesis.proof.nodes import Leaf, Node, PlaceRange, Split
from optlaws.synthesis.proof.peak_rows import PeakRows

_LEAST_REACH = 1e-9  # of u: cells of a peak's place are cut no further
_HARDLY = 1e-9  # of a peak's bound: room that is less is hardly any

_PROGRAMS = 1500
_HOPELESS, _NEARLY = 1.5, 4.0


@dataclass(frozen=True, eq=False)
class PlaceSearch:
    """How a search ended: with a certificate, or at a place where better laws seem to have the peak, or in vain."""

    certificate: Certificate | None = None
    better_at: float | None = None


@dataclass(frozen=True, eq=False)
class _Part:
    """A range of places, with the optimum at the middle of the range it was cut from, and its margin."""

    places: PlaceRange
    warm: ActiveSet | None = None
    margin: float | None = None

    def halves(self, warm: ActiveSet | None, margin: float | None) -> list[_Part]:
        return [_Part(places, warm, margin) for places in self.places.parts(self.places.k)]


def search(problem: Problem, peak: PeakConstant, claim: float) -> PlaceSearch:
    """Split the places until no law below the claim can have the peak in any part."""
    rows = PeakRows(problem, peak, claim)
    tree: list[Node] = []
    parts = [_Part(places) for places in rows.roots()]
    left = _PROGRAMS
    while parts:
        part = parts.pop()
        places = part.places
        if _too_wide(rows, part):
            parts += part.halves(part.warm, part.margin)
            tree.append(Split(0, places.k))
            continue
        left -= 1
        leaf, optimum, most = _leaf(rows, part)
        if rows.excluded(places, leaf):
            tree.append(leaf)
        elif optimum is not None and most > rows.low:
            return PlaceSearch(better_at=places.k)
        elif left <= 0 or places.reach < _LEAST_REACH:
            return PlaceSearch()
        else:
            parts += part.halves(optimum, None if optimum is None else rows.low - most)
            tree.append(Split(0, places.k))
    proof = Certificate(problem, claim, tuple(tree), peak=peak.name)
    return PlaceSearch(certificate=proof if proof.proven else None)


def _too_wide(rows: PeakRows, part: _Part) -> bool:
    """Whether the part is so wide that it is split without solving a program."""
    remainder = rows.remainder(part.places.k, part.places.reach)
    room = None if part.margin is None else max(part.margin, _HARDLY * rows.low)
    return part.places.reach > _LEAST_REACH and (
        remainder > _HOPELESS * rows.low or (room is not None and remainder > _NEARLY * room)
    )


def _leaf(rows: PeakRows, part: _Part) -> tuple[Leaf, ActiveSet | None, float]:
    """The leaf of a part, with the optimum of its middle and the value there."""
    model, base = rows.at(part.places.k, part.places.sign)
    optimum = None if rows.excluded(part.places, Leaf()) else solve(model.program, part.warm).optimum
    if optimum is None:
        return Leaf(), None, base
    return certificate(model, optimum, OBJECTIVE).leaf, optimum, base - model.program.objective_at(optimum.x)
