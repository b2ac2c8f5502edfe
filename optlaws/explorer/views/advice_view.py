"""Advice as the page shows it: laws for the motion as it stands side by side, the front, and how each is taken."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

import msgspec

from optlaws import Advice, AdvisedLaw
from optlaws.cycles.advising.advice import (
    advice_from,
    front_panels,
    limits_in_words,
    more_than_usual,
    proof_in_words,
    standard_candidates,
)
from optlaws.cycles.advising.candidates import Candidates, LawMeasure
from optlaws.cycles.specification.segments import OPTIMAL, Move
from optlaws.explorer.views import cycle_view
from optlaws.explorer.views.cycle_view import MOST_POINTS, CycleRequest
from optlaws.explorer.views.law_view import refusing
from optlaws.explorer.views.panel_data import beside_each_other, over_time, panel_data
from optlaws.numbers import bounded
from optlaws.sentences import quantity_name


@refusing()
def standard(request: CycleRequest) -> dict[str, Any]:
    """The standard laws side by side, which take no search; or the reason why there is none."""
    candidates = _standard(_question(request))
    return _side_by_side(candidates, [candidates.usual], ())


@refusing()
def answer(request: CycleRequest) -> dict[str, Any]:
    """The laws side by side with the recommended one, or the reason why there is none."""
    advice = advice_of(request)
    chosen = advice.recommendation
    unchanged = chosen.usual is chosen.law
    return {
        **_side_by_side(_all(_question(request)), [None if unchanged else chosen.usual, chosen.law], advice.front),
        "sentences": list(chosen.sentences),
        "rule": chosen.rule,
        "chosen": chosen.law.name,
        "remarks": list(advice.remarks),
    }


def advice_of(request: CycleRequest) -> Advice:
    """The advice with so many points of the front."""
    return advice_from(_copy(_all(_question(request))), request.points)


def _question(request: CycleRequest) -> bytes:
    """What the laws depend on: not the points of the front."""
    return msgspec.json.encode(msgspec.structs.replace(request, points=MOST_POINTS))


@lru_cache(maxsize=16)
def _standard(question: bytes) -> Candidates:
    request = msgspec.json.decode(question, type=CycleRequest)
    cycle = cycle_view.stored(*cycle_view.read(request))
    return standard_candidates(cycle.specification, minimise=request.minimise or None, follower=request.follower)


@lru_cache(maxsize=16)
def _all(question: bytes) -> Candidates:
    candidates = _copy(_standard(question))
    candidates.add_optimal()
    return candidates


def _copy(candidates: Candidates) -> Candidates:
    return replace(candidates, laws=dict(candidates.laws), errors=dict(candidates.errors))


def _side_by_side(
    candidates: Candidates, drawn_laws: Sequence[AdvisedLaw | None], front: Sequence[AdvisedLaw]
) -> dict[str, Any]:
    measures = {measure.name: measure for measure in candidates.measures}
    x, y = measures[candidates.second], measures[candidates.minimise]
    usual, guarded = candidates.usual, tuple(candidates.most())
    curves = [panel_data(panel) for panel in front_panels(front, x, y, guarded, usual)]
    return {
        "measures": [_shown(measure) for measure in measures.values()],
        "rows": [
            {
                "name": law.name,
                "kind": law.kind,
                "values": [bounded(law.values[name]) for name in measures],
                "limits": limits_in_words(law),
                "proof": proof_in_words(law),
                "more": [quantity_name(name) for name in more_than_usual(law, usual, guarded, x.name)],
                "take": _entries(candidates, law),
            }
            for law in candidates.laws.values()
        ],
        "picture": {"x": _shown(x), "y": _shown(y), "front": [panel["series"] for panel in curves]},
        "curves": _curves([law for law in drawn_laws if law is not None]),
    }


def _shown(measure: LawMeasure) -> dict[str, str]:
    return {"name": quantity_name(measure.name), "unit": measure.unit}


def _entries(advised: Candidates, law: AdvisedLaw) -> dict[str, Any] | None:
    """The entries of the cycle with a law: by its name, by what is least within limits, or as it stands.

    Laws that were sought for a follower are given as they stand: a cycle's entries know none.
    """
    motion, proof = law.motion, law.proof
    if law.kind == "given":
        return None
    # laws that are compared are sought, or changed by the user
    before = zip(advised.cycle.segments, motion.segments, strict=True)
    compared = [isinstance(now, Move) and (now.law == OPTIMAL or now != then) for then, now in before]
    if proof is None:
        return {"laws": [law.name if sought else None for sought in compared]}
    if advised.follower is None and proof.minimise == motion.minimise:
        laws = [OPTIMAL if sought else None for sought in compared]
        entries = {name: getattr(motion.specification, name) for name in ("minimise", "degree")}
        return {"laws": laws, **entries, "limits": dict(motion.limits)}
    known = {piece.start: json.dumps(piece.law.to_dict()) for piece in motion.pieces}
    taken = [
        known.get(peaks.start, "") if sought else None for sought, peaks in zip(compared, motion.peaks, strict=True)
    ]
    return None if "" in taken else {"laws": taken}


def _curves(laws: Sequence[AdvisedLaw]) -> dict[str, Any]:
    """Velocity, acceleration and jerk of the usual law and of the recommended one, over the time."""
    if not laws:
        return {"panels": []}
    motions = [(i, law.report().panels[1:4]) for i, law in enumerate(laws)]
    panels = []
    for panel in beside_each_other(motions[0][1], motions):
        series = tuple(curve._replace(name=law.name) for curve, law in zip(panel.series, laws, strict=True))
        panels.append(panel_data(replace(panel, series=series, limits=(), peaks=(), ends=(0.0, 0.0))))
    return over_time(panels, laws[0].motion.duration)
