"""The recommended law, by a stated rule, with its gain and its cost in two factual sentences."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import isfinite

from optlaws.cycles.advising.advised_law import AdvisedLaw
from optlaws.cycles.advising.candidates import Candidates, exceeded
from optlaws.errors import InfeasibleProblem
from optlaws.sentences import Amount, joined, sentence
from optlaws.synthesis.status import Status
from optlaws.tolerances import AGREEMENT, EQUALLY_GOOD

_TELLING = 1e-3  # of a value: a difference or a rest of a limit that is worth a word


@dataclass(frozen=True)
class Recommendation:
    """The law to take, and why.

    Attributes
    ----------
    law
        The law.
    usual
        The standard law that it is compared with, which may exceed a limit if all do; None where none fits.
    rule
        By which it is chosen.
    gain
        The share of what is minimised that it takes less than the usual one; None where there is none.
    changes
        By measure, how many times as much as the usual law it takes.
    sentences
        What it gains; what is proven and what it costs.

    Examples
    --------
    >>> import optlaws
    >>> chosen = optlaws.advise(optlaws.Rise("1 m", "1 s"), points=0).recommendation
    >>> chosen.law.name, round(chosen.gain, 4), round(chosen.changes["jerk"], 4)
    ('nearly least acceleration, least jerk', 0.0934, 0.9622)
    >>> chosen.rule
    'of the laws that take no more velocity or jerk than modified sine, those within 1 % of the least acceleration ...'
    """

    law: AdvisedLaw
    usual: AdvisedLaw | None
    rule: str
    gain: float | None
    changes: dict[str, float]
    sentences: tuple[str, str]

    def __str__(self) -> str:
        return joined(" ", self.sentences)


def recommended(candidates: Candidates, front: Sequence[AdvisedLaw] = ()) -> Recommendation:
    """The recommended law among the known ones.

    Of the laws that keep every limit, and take no more than the usual one of what has no limit, those within 1 % of the
    least are equally good; of these the one that takes least of the second measure.
    """
    minimise, second, usual = candidates.minimise, candidates.second, candidates.usual
    most = candidates.most()
    no_worse = {**most, minimise: usual.values[minimise]} if usual is not None and usual.keeps_limits else most
    fit = [law for law in candidates.laws.values() if law.keeps_limits and not exceeded(law, no_worse)]
    if not fit:  # rounding alone
        fit = [candidates.laws[f"least {minimise}"]]
    least = min(law.values[minimise] for law in fit)
    good = [law for law in fit if law.values[minimise] <= least * (1.0 + EQUALLY_GOOD + AGREEMENT)]
    law = min(good, key=lambda each: each.values[second])
    words = _Words(candidates, law, tuple(most), front)
    changes = {} if usual is None else {
        name: value / usual.values[name] for name, value in law.values.items() if usual.values[name] > 0.0
    }  # fmt: skip
    gain = None if usual is None else 1.0 - changes.get(minimise, 1.0)
    return Recommendation(
        law, usual, words.rule, gain, changes, (words.gain, sentence("{}; {}.", words.proof, words.costs))
    )


@dataclass(frozen=True)
class _Words:
    """The sentences about a law, from facts."""

    candidates: Candidates
    law: AdvisedLaw
    most: tuple[str, ...]
    front: Sequence[AdvisedLaw]

    @property
    def rule(self) -> str:
        """The rule by which the law is chosen."""
        minimise, second, usual = self.candidates.minimise, self.candidates.second, self.candidates.usual
        no_worse = f"take no more {_listed(self.most, 'or')} than {usual.name}" if usual and self.most else ""
        limited = any(law.limits for law in self.candidates.laws.values())
        which = " and ".join(part for part in ("keep every limit" if limited else "", no_worse) if part)
        of_which = f"of the laws that {which}, " if which else ""
        good = f"those within 1 % of the least {minimise} are equally good"
        return f"{of_which}{good}; of these the one of least {second}"

    @property
    def gain(self) -> str:
        """The law to take, and its gain."""
        minimise, usual, law = self.candidates.minimise, self.candidates.usual, self.law
        value = self._with_unit(minimise, law.values[minimise])
        limits = ", and it keeps every limit" if law.limits else ""
        full = [taken for taken in law.limits if taken.text and taken.share >= 1.0 - _TELLING]
        if full:
            taken_to_full = _listed([sentence("{} {}", taken.name, taken.text) for taken in full])
            limits = sentence("{} ({} to the full)", limits, taken_to_full)
        name = f'"{law.name}"' if law.kind == "optimal" else law.name
        start = sentence("Take {}: its {} is {}", name, minimise, value)
        if usual is None:
            return sentence("{}{}.", start, limits)
        if not usual.keeps_limits:
            standard = [each for each in self.candidates.laws.values() if each.kind != "optimal"]
            text = "{}{}; none of the {} standard laws does: {}."
            return sentence(text, start, limits, len(standard), _why_not(usual))
        if law is usual:
            text = "{}{}, and no law that takes no more of anything is better{}."
            return sentence(text, start, limits, self._beyond)
        share = 1.0 - law.values[minimise] / usual.values[minimise]
        return sentence("{}, {} % less than that of {}{}.", start, f"{100.0 * share:.3g}", usual.name, limits)

    @property
    def _beyond(self) -> str:
        """The gain and the cost of the least law, where nothing else is guarded."""
        minimise, second, law = self.candidates.minimise, self.second, self.law
        best = self.candidates.laws[f"least {minimise}"]
        gain, times = 1.0 - best.values[minimise] / law.values[minimise], best.values[second] / law.values[second]
        return f"; {_percent(gain)} less takes {times:.3g} times the {second}" if gain > EQUALLY_GOOD else ""

    @property
    def second(self) -> str:
        """The measure that decides between laws that are equally good."""
        return self.candidates.second

    @property
    def proof(self) -> str:
        """The distance of its value from the proven bound."""
        known, minimise, usual = self.candidates.proven, self.candidates.minimise, self.candidates.usual
        if known is None or known.proof is None or not known.proof.lower_bound or known.proof.lower_bound <= 0.0:
            return f"How much less {minimise} another law could have is not proven"
        infeasible = isinstance(self.candidates.errors.get(self._bettered), InfeasibleProblem)
        if usual is not None and infeasible and self.candidates.guarding:
            space = known.proof.space
            return f"That none of the {space} takes no more {_listed(self.most, 'or')} than {usual.name} is proven"
        bound, value = known.proof.lower_bound, self.law.values[minimise]
        as_much = f" with no more {_listed(self.most, 'or')} than {usual.name}" if usual and self.most else ""
        above = value / bound - 1.0
        near = f" ({_percent(above / (1.0 + above))} less)" if above > _TELLING * EQUALLY_GOOD else ""
        least = sentence("{}{}", self._with_unit(minimise, bound), near)
        proven = sentence("None of the {}{} has less than {}", known.proof.space, as_much, least)
        if known.proof.status is not Status.OPTIMAL:
            proven = sentence("That none has less than {}, is proven", least)
        if known.proof.limit:
            limit = self._with_unit(minimise, known.proof.limit)
            proven = sentence("{}, and none of any degree less than {}", proven, limit)
        return proven

    @property
    def _bettered(self) -> str:
        """The name of the law that would better the usual one."""
        usual = self.candidates.usual
        return "" if usual is None else f"least {self.candidates.minimise}, no worse than {usual.name}"

    @property
    def costs(self) -> str:
        """The measures of which it takes more and less than the usual law."""
        usual = self.candidates.usual
        if usual is None or usual is self.law or not self.candidates.guarding:
            value = self._with_unit(self.second, self.law.values[self.second])
            return sentence("its {} is {}{}", self.second, value, self._exchange)
        changes = [*self._changes("more", 1.0), *self._changes("less", -1.0)]
        if not changes:
            return f"nothing else differs by 1 % from {usual.name}"
        return f"compared with {usual.name}, the law to take needs {_listed(changes)}"

    @property
    def _exchange(self) -> str:
        """The cost of half of the second measure, by the front."""
        minimise, half = self.candidates.minimise, 0.5 * self.law.values[self.second]
        fewer = [law for law in self.front if law.values[self.second] <= half and law.keeps_limits]
        if not fewer or self.candidates.usual is self.law:
            return ""
        law = min(fewer, key=lambda each: each.values[minimise])
        more = law.values[minimise] / self.law.values[minimise] - 1.0
        share = law.values[self.second] / self.law.values[self.second]
        return f", and {_percent(share)} of it takes {_percent(more)} more {minimise}"

    def _changes(self, word: str, sign: float) -> Iterator[str]:
        assert self.candidates.usual is not None  # noqa: S101 - as it is asked of one
        for name, other in self.candidates.usual.values.items():
            value = self.law.values[name]
            if name == self.candidates.minimise or not other > 0.0 or not isfinite(value) or not isfinite(other):
                continue
            change = value / other - 1.0
            if sign * change >= EQUALLY_GOOD:
                yield f"{_percent(abs(change))} {word} {name}"

    def _with_unit(self, name: str, value: float) -> str:
        unit = next((measure.unit for measure in self.candidates.motion.measures if measure.name == name), "")
        return Amount(value, unit, 5) if isfinite(value) else "without bound"


def _why_not(law: AdvisedLaw) -> str:
    taken = max(law.broken, key=lambda each: each.share)
    if not taken.text:
        return f"{law.name} is outside of the {taken.name}"
    return sentence("{} has {} more {} than {}", law.name, _percent(taken.share - 1.0), taken.name, taken.text)


def _percent(share: float) -> str:
    """A share in per cent, to two digits or whole.

    >>> _percent(0.0987), _percent(1.234)
    ('9.9 %', '123 %')
    """
    return f"{100.0 * share:{'.0f' if share >= 1.0 else '.2g'}} %"


def _listed(names: Sequence[str], word: str = "and") -> str:
    """Names in a sentence."""
    *first, last = names
    return sentence("{} {} {}", joined(", ", first), word, last) if first else last
