"""Verdicts: each item computed, and what is to be said of it, whatever is declared."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_UP, Decimal
from math import inf, isnan
from pathlib import Path

from optlaws.errors import InputError
from optlaws.files import reading
from optlaws.jobs.job import JOBS
from optlaws.jobs.ledger import computing
from optlaws.jobs.ledger.equation import difference
from optlaws.jobs.ledger.item import Item, Verdict
from optlaws.jobs.pages import printed

#: a printed number that is off by more than so many percent is contradicted
MOST_PERCENT = 2.0
_SAME = 1e-9
_DIFFERS = 1e-6


@dataclass(frozen=True)
class Judged:
    """An item and what was computed of it.

    `computed` is the number, the greatest relative difference of a formula's sides, or the value of a claim, which
    `bound` belongs to; `said` tells it in words.
    """

    paper: str
    item: Item
    verdict: Verdict
    computed: float | None
    bound: float | None
    said: str

    @property
    def holds(self) -> bool:
        """Whether the verdict is the declared one."""
        return self.verdict is self.item.verdict

    def to_dict(self) -> dict[str, object]:
        """Plain data: id, kind, printed, computed, verdict and reason, and what belongs to them."""
        item = self.item
        told = {name: getattr(item, name) for name in ("as_read", "means", "lost", "source") if getattr(item, name)}
        return {
            "id": item.id,
            "paper": self.paper,
            "kind": item.kind,
            "printed": item.printed,
            "computed": self.computed,
            "verdict": str(self.verdict),
            "declared": str(item.verdict),
            "reason": item.reason,
            "said": self.said,
            "confidence": item.confidence,
            **told,
        }


def judge(item: Item, paper: str, problems: Path) -> Judged:
    """Compute an item and say what is to be said of it.

    Raises
    ------
    InputError
        If it names a computation that is not there, or prints what cannot be read.
    """
    if item.verdict is Verdict.UNDECIDABLE and not item.compute:
        return Judged(paper, item, Verdict.UNDECIDABLE, None, None, item.lost)
    verdict, computed, bound, said = _JUDGES[item.kind](item, problems)
    return Judged(paper, item, verdict, computed, bound, said)


_Said = tuple[Verdict, float | None, float | None, str]


def _number(item: Item, problems: Path) -> _Said:
    value = computing.number(item, problems)
    verdict, said = _of_number(item, value)
    return verdict, value.exact, None, said


def _of_number(item: Item, value: computing.Number) -> tuple[Verdict, str]:
    plain, said = compared(item.printed, value)
    if item.verdict is Verdict.MISPRINT:
        mended = not _right(item.printed, item, value) and _right(item.means, item, value)
        return (Verdict.MISPRINT, f"as {item.means} it is right") if mended else (plain, said)
    if item.verdict is Verdict.MISREAD:
        mended = _right(item.printed, item, value) and not _right(item.as_read, item, value)
        return (Verdict.MISREAD, f"read as {item.as_read}") if mended else (plain, said)
    if plain is item.verdict is Verdict.PERCENT and item.within != percent(item.printed, value.exact):
        return Verdict.CONTRADICTED, f"{said}, not {item.within:g} %"
    return plain, said


def _right(text: str, item: Item, value: computing.Number) -> bool:
    verdict = compared(text, value)[0]
    near = verdict is Verdict.PERCENT and percent(text, value.exact) <= item.within
    return near or verdict in {Verdict.REPRODUCED, Verdict.ON_GRID}


def compared(text: str, value: computing.Number) -> tuple[Verdict, str]:
    """A printed number beside the computed one, whatever is declared.

    Examples
    --------
    >>> compared("5.91", computing.Number(5.9195846, on_grid=5.9131398))[0]
    <Verdict.ON_GRID: "on the paper's grid">
    >>> compared("10.52", computing.Number(10.351918))
    (<Verdict.PERCENT: 'to p percent'>, 'to 1.7 %')
    """
    if text == "inf":
        return (Verdict.REPRODUCED, "infinite") if value.exact == inf else (Verdict.CONTRADICTED, "it is finite")
    size = printed.number(text, "printed")
    if size == 0.0 or isnan(value.exact):
        same = printed.same_digits(text, value.exact)
        return (Verdict.REPRODUCED, "") if same else (Verdict.CONTRADICTED, f"it is {value.exact:.6g}")
    judged = printed.judge("", "", text, value.exact, on_grid=value.on_grid, misprint=None)
    if judged.verdict == printed.REPRODUCED:
        return Verdict.REPRODUCED, ""
    if judged.verdict == printed.ON_GRID:
        return Verdict.ON_GRID, judged.reason
    off = percent(text, value.exact)
    verdict = Verdict.PERCENT if off <= MOST_PERCENT else Verdict.CONTRADICTED
    return verdict, f"to {off:g} %"


def percent(text: str, exact: float) -> float:
    """How far a printed number is off, in percent, rounded up to two digits; infinite where the right one is 0.

    Examples
    --------
    >>> percent("0.053", 0.052734)
    0.51
    """
    if exact == 0.0:
        return inf
    off = Decimal(100.0 * abs(float(text) / exact - 1.0))
    return float(off.quantize(Decimal(1).scaleb(off.adjusted() - 1), ROUND_UP))


def _formula(item: Item, problems: Path) -> _Said:
    points = computing.samples(item, problems)
    if item.verdict is Verdict.UNDECIDABLE:
        left = greatest(item.means, points, item.id)
        verdict = Verdict.UNDECIDABLE if left <= _SAME else Verdict.CONTRADICTED
        return verdict, None, None, f"{item.lost}; derived: {item.means}, to {left:.1e}"
    printed_off = greatest(item.printed, points, item.id)
    if item.verdict is Verdict.MISPRINT:
        return _mended(item, points, item.printed, item.means, Verdict.MISPRINT)
    if item.verdict is Verdict.MISREAD:
        return _mended(item, points, item.as_read, item.printed, Verdict.MISREAD)
    verdict = Verdict.AGREES if printed_off <= max(_SAME, item.within / 100.0) else Verdict.CONTRADICTED
    return verdict, printed_off, None, f"both sides differ by {printed_off:.1e} at most, at {len(points)} points"


def _mended(item: Item, points: Sequence[Mapping[str, float]], wrong: str, right: str, verdict: Verdict) -> _Said:
    off, left = greatest(wrong, points, item.id), greatest(right, points, item.id)
    said = f"off by {off:.1e}; as {right} by {left:.1e}"
    if left <= _SAME and off >= _DIFFERS:
        return verdict, off, None, said
    return (Verdict.AGREES if off <= _SAME else Verdict.CONTRADICTED), off, None, said


def greatest(text: str, points: Sequence[Mapping[str, float]], where: str) -> float:
    """The greatest relative difference of an equation's sides over points."""
    return max(difference(text, point, where) for point in points)


def _claim(item: Item, problems: Path) -> _Said:
    claim = computing.claim(item, problems)
    verdict = Verdict.CONFIRMED if claim.holds else Verdict.CONTRADICTED
    said = f"{claim.value:.6g} {claim.sense} {claim.bound:.6g}{'' if claim.holds else ' does not hold'}"
    return verdict, claim.value, claim.bound, said


def _figure(item: Item, problems: Path) -> _Said:
    job = problems / item.job
    name = reading.toml(job).get("job")
    if name not in JOBS:
        raise InputError(f"{item.id}: {item.job} names no job")
    picture = problems.parent / "results" / job.stem / item.file
    drawn = reading.text(picture)
    # a picture's text is drawn as paths, with the words in a comment before each
    missing = [curve for curve in item.curves if f"<!-- {curve} -->" not in drawn]
    if missing:
        return Verdict.CONTRADICTED, None, None, f"{item.file} has no {missing[0]!r}"
    return Verdict.AGREES, None, None, f"results/{job.stem}/{item.file}"


_JUDGES: Mapping[str, Callable[[Item, Path], _Said]] = {
    "number": _number,
    "cell": _number,
    "formula": _formula,
    "claim": _claim,
    "procedure": _claim,
    "figure": _figure,
}
