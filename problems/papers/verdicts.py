"""Verdicts: each item computed, and what is to be said of it, whatever is declared."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from decimal import ROUND_UP, Decimal
from functools import cache
from importlib import import_module
from math import inf, isnan
from pathlib import Path

from optlaws import InputError, results

from . import computing
from .equations import difference
from .items import Item, Verdict

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
    words: str

    @property
    def holds(self) -> bool:
        """Whether the verdict is the declared one."""
        return self.verdict is self.item.verdict

    def results(self) -> dict[str, object]:
        """Plain data: id, kind, printed, computed, verdict and reason, and what belongs to them."""
        item = self.item
        optional = {name: getattr(item, name) for name in ("as_read", "means", "lost", "source") if getattr(item, name)}
        return {
            "id": item.id,
            "paper": self.paper,
            "kind": item.kind,
            "printed": item.printed,
            "computed": self.computed,
            "verdict": str(self.verdict),
            "declared": str(item.verdict),
            "reason": item.reason,
            "said": self.words,
            "confidence": item.confidence,
            **optional,
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
    verdict, computed, bound, words = _JUDGES[item.kind](item, problems)
    return Judged(paper, item, verdict, computed, bound, words)


_Said = tuple[Verdict, float | None, float | None, str]


def _number(item: Item, problems: Path) -> _Said:
    value = computing.number(item, problems)
    verdict, words = _of_number(item, value)
    return verdict, value.exact, None, words


def _of_number(item: Item, value: computing.Number) -> tuple[Verdict, str]:
    plain, words = compared(item.printed, value)
    if item.verdict is Verdict.MISPRINT:
        mended = not _right(item.printed, item, value) and _right(item.means, item, value)
        return (Verdict.MISPRINT, f"as {item.means} it is right") if mended else (plain, words)
    if item.verdict is Verdict.MISREAD:
        mended = _right(item.printed, item, value) and not _right(item.as_read, item, value)
        return (Verdict.MISREAD, f"read as {item.as_read}") if mended else (plain, words)
    if plain is item.verdict is Verdict.PERCENT and item.within != percent(item.printed, value.exact):
        return Verdict.CONTRADICTED, f"{words}, not {item.within:g} %"
    return plain, words


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
    size = results.number(text, "printed")
    if size == 0.0 or isnan(value.exact):
        same = results.same_digits(text, value.exact)
        return (Verdict.REPRODUCED, "") if same else (Verdict.CONTRADICTED, f"it is {value.exact:.6g}")
    judged = results.compared("", "", text, value.exact, on_grid=value.on_grid, misprint=None)
    if judged.verdict == results.REPRODUCED:
        return Verdict.REPRODUCED, ""
    if judged.verdict == results.ON_GRID:
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
    words = f"off by {off:.1e}; as {right} by {left:.1e}"
    if left <= _SAME and off >= _DIFFERS:
        return verdict, off, None, words
    return (Verdict.AGREES if off <= _SAME else Verdict.CONTRADICTED), off, None, words


def greatest(text: str, points: Sequence[Mapping[str, float]], where: str) -> float:
    """The greatest relative difference of an equation's sides over points."""
    return max(difference(text, point, where) for point in points)


def _claim(item: Item, problems: Path) -> _Said:
    claim = computing.claim(item, problems)
    verdict = Verdict.CONFIRMED if claim.holds else Verdict.CONTRADICTED
    words = f"{claim.value:.6g} {claim.sense} {claim.bound:.6g}{'' if claim.holds else ' does not hold'}"
    return verdict, claim.value, claim.bound, words


def _figure(item: Item, problems: Path) -> _Said:
    job = problems / item.job
    if not job.is_file():
        raise InputError(f"{item.id}: {item.job} is no problem")
    picture = problems.parent / "results" / job.stem / item.file
    drawn = picture.read_text("utf-8") if picture.is_file() else _drawn(job).get(item.file)
    if drawn is None:
        raise InputError(f"{item.id}: {item.job} draws no {item.file}")
    # a picture's text is drawn as paths, with the words in a comment before each
    missing = [curve for curve in item.curves if f"<!-- {curve} -->" not in drawn]
    if missing:
        return Verdict.CONTRADICTED, None, None, f"{item.file} has no {missing[0]!r}"
    return Verdict.AGREES, None, None, f"results/{job.stem}/{item.file}"


@cache
def _drawn(job: Path) -> Mapping[str, str]:
    """The pictures that a script draws, for where the results do not lie beside the problems."""
    if not Path(__file__).parents[1].joinpath(f"{job.stem}.py").is_file():
        return {}
    drawn = results.Results(job)
    import_module(f"..{job.stem}", __package__).run(drawn)
    return drawn.pictures()


_JUDGES: Mapping[str, Callable[[Item, Path], _Said]] = {
    "number": _number,
    "cell": _number,
    "formula": _formula,
    "claim": _claim,
    "procedure": _claim,
    "figure": _figure,
}
