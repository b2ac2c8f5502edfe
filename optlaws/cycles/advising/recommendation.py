"""The recommended law, by a stated rule, with its gain and its cost in two factual sentences."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import isfinite

from optlaws.cycles.advising.candidates import AdvisedLaw, Candidates, exceeded, least
from optlaws.errors import InfeasibleProblem
from optlaws.sentences import Amount, Sentence, joined, listed, quantity_name, sentence
from optlaws.synthesis.status import Status
from optlaws.tolerances import AGREEMENT, EQUALLY_GOOD

_TELLING = 1e-3  # of a value: a difference or a rest of a limit that is worth a word


@dataclass(frozen=True)
class Recommendation:
    """The recommended law, and why.

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
    'of the laws that have no more velocity or jerk than modified sine, those within 1 % of the least acceleration ...'
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

    Of the laws that satisfy all limits, and have no more than the usual one of what has no limit, those within 1 % of
    the least are equally good; of these the one that has least of the second measure.
    """
    minimise, second, usual = candidates.minimise, candidates.second, candidates.usual
    most = candidates.most()
    no_worse = {**most, minimise: usual.values[minimise]} if usual is not None and usual.keeps_limits else most
    fit = [law for law in candidates.laws.values() if law.keeps_limits and not exceeded(law, no_worse)]
    if not fit:  # rounding alone
        fit = [candidates.laws[least(minimise)]]
    lowest = min(law.values[minimise] for law in fit)
    good = [law for law in fit if law.values[minimise] <= lowest * (1.0 + EQUALLY_GOOD + AGREEMENT)]
    law = min(good, key=lambda each: each.values[second])
    words = _Words(candidates, law, tuple(most), front)
    changes = {} if usual is None else {
        name: value / usual.values[name] for name, value in law.values.items() if usual.values[name] > 0.0
    }  # fmt: skip
    gain = None if usual is None else 1.0 - changes.get(minimise, 1.0)
    sentences = words.gain, sentence("{}; {}{}.", words.proof, words.costs, words.degrees)
    return Recommendation(law, usual, words.rule, gain, changes, sentences)


@dataclass(frozen=True)
class _Words:
    """The sentences about a law, from facts."""

    candidates: Candidates
    law: AdvisedLaw
    most: tuple[str, ...]
    front: Sequence[AdvisedLaw]

    @property
    def no_more(self) -> str:
        """What the usual law guards, as in "no more jerk than modified sine"; nothing where it guards nothing."""
        usual = self.candidates.usual
        most = listed([quantity_name(name) for name in self.most], "or") if self.most else ""
        return f"no more {most} than {usual.name}" if usual is not None and most else ""

    @property
    def rule(self) -> str:
        limited = any(law.limits for law in self.candidates.laws.values())
        parts = ("satisfy all limits" if limited else "", f"have {self.no_more}" if self.no_more else "")
        which = " and ".join(part for part in parts if part)
        of_which = f"of the laws that {which}, " if which else ""
        good = f"those within 1 % of the {least(self.candidates.minimise)} are equally good"
        return f"{of_which}{good}; of these the one of {least(self.candidates.second)}"

    @property
    def gain(self) -> Sentence:
        minimise, usual, law = self.candidates.minimise, self.candidates.usual, self.law
        full = [
            sentence("{} {}", quantity_name(taken.name), taken.text)
            for taken in law.limits
            if taken.text and taken.share >= 1.0 - _TELLING
        ]
        to_full = sentence(" ({} reached)", listed(full)) if full else ""
        limits = sentence("{}{}", ", and it satisfies all limits" if law.limits else "", to_full)
        name = f'"{law.name}"' if law.kind == "optimal" else law.name
        start = sentence("Take {}: its {} is {}", name, quantity_name(minimise), self._with_unit(minimise, law))
        if usual is None:
            return sentence("{}{}.", start, limits)
        if not usual.keeps_limits:
            standard = [each for each in self.candidates.laws.values() if each.kind != "optimal"]
            text = "{}{}; none of the {} standard laws does: {}."
            return sentence(text, start, limits, len(standard), _why_not(usual))
        if law is usual:
            text = "{}{}, and no law with no more of the other quantities is better{}."
            return sentence(text, start, limits, self._beyond)
        share = 1.0 - law.values[minimise] / usual.values[minimise]
        return sentence("{}, {} % less than that of {}{}.", start, f"{100.0 * share:.3g}", usual.name, limits)

    @property
    def _beyond(self) -> str:
        """The gain and the cost of the least law, where nothing else is guarded."""
        minimise, second = self.candidates.minimise, self.candidates.second
        best, values = self.candidates.laws[least(minimise)].values, self.law.values
        gain, times = 1.0 - best[minimise] / values[minimise], best[second] / values[second]
        return f"; {_percent(gain)} less takes {times:.3g} times the {second}" if gain > EQUALLY_GOOD else ""

    @property
    def proof(self) -> Sentence | str:
        """The distance of its value from the proven bound."""
        candidates, minimise, usual = self.candidates, self.candidates.minimise, self.candidates.usual
        proof = None if candidates.proven is None else candidates.proven.proof
        bound = None if proof is None else proof.lower_bound
        if proof is None or not bound or bound <= 0.0:
            return f"No lower bound of the {quantity_name(minimise)} is known"
        bettered = "" if usual is None else f"{least(minimise)}, no worse than {usual.name}"
        if candidates.guarding and isinstance(candidates.errors.get(bettered), InfeasibleProblem):
            return f"Proven: none of the {proof.space} has {self.no_more}"
        above = self.law.values[minimise] / bound - 1.0
        near = f" ({_percent(above / (1.0 + above))} less)" if above > _TELLING * EQUALLY_GOOD else ""
        lowest = sentence("{}{}", self._with_unit(minimise, bound), near)
        word = "Proven" if proof.certified else "Computed in doubles"
        if proof.status is Status.OPTIMAL:
            with_no_more = f" with {self.no_more}" if self.no_more else ""
            proven = sentence("{}: {}{} have at least {}", word, proof.space, with_no_more, lowest)
        else:
            proven = sentence("{}: {} have at least {}", word, proof.space or "all laws", lowest)
        if proof.best_possible:
            best = self._with_unit(minimise, proof.best_possible)
            proven = sentence("{}, those of any degree at least {}", proven, best)
        return proven

    @property
    def costs(self) -> Sentence | str:
        """The measures of which it takes more and less than the usual law."""
        usual, second = self.candidates.usual, self.candidates.second
        if usual is None or usual is self.law or not self.candidates.guarding:
            return sentence("its {} is {}{}", second, self._with_unit(second, self.law), self._exchange)
        changes = [*self._changes(usual, "more", 1.0), *self._changes(usual, "less", -1.0)]
        if not changes:
            return f"nothing else differs by 1 % from {usual.name}"
        return f"compared with {usual.name}, the recommended law has {listed(changes)}"

    @property
    def degrees(self) -> str:
        """That the law is of another degree than those of the cycle that was given; blank where it is not."""
        given, searched = self.candidates.given_degree, self.candidates.cycle.degree
        if given is None or given == searched or self.law.kind != "optimal":
            return ""
        return (
            f"; the laws of this advice have a Z of degree {searched}, those of the cycle as it is given {given}: with "
            f"degree = {searched} it can have this one"
        )

    @property
    def _exchange(self) -> str:
        """The cost of half of the second measure, by the front."""
        minimise, second, taken = self.candidates.minimise, self.candidates.second, self.law.values
        fewer = [law.values for law in self.front if law.values[second] <= 0.5 * taken[second] and law.keeps_limits]
        if not fewer or self.candidates.usual is self.law:
            return ""
        lowest = min(fewer, key=lambda values: values[minimise])
        more, share = lowest[minimise] / taken[minimise] - 1.0, lowest[second] / taken[second]
        return f", and {_percent(share)} of it takes {_percent(more)} more {quantity_name(minimise)}"

    def _changes(self, usual: AdvisedLaw, word: str, sign: float) -> Iterator[str]:
        for name, other in usual.values.items():
            value = self.law.values[name]
            if name == self.candidates.minimise or not other > 0.0 or not isfinite(value) or not isfinite(other):
                continue
            change = value / other - 1.0
            if sign * change >= EQUALLY_GOOD:
                yield f"{_percent(abs(change))} {word} {quantity_name(name)}"

    def _with_unit(self, name: str, of: AdvisedLaw | float) -> str:
        value = of.values[name] if isinstance(of, AdvisedLaw) else of
        return Amount(value, dict(self.candidates.measures)[name], 5) if isfinite(value) else "without bound"


def _why_not(law: AdvisedLaw) -> str:
    taken = max(law.broken, key=lambda each: each.share)
    name = quantity_name(taken.name)
    if not taken.text:
        return f"{law.name} is outside of the {name}"
    return sentence("{} has {} more {} than {}", law.name, _percent(taken.share - 1.0), name, taken.text)


def _percent(share: float) -> str:
    """A share in per cent, to two digits or whole.

    >>> _percent(0.0987), _percent(1.234)
    ('9.9 %', '123 %')
    """
    return f"{100.0 * share:{'.0f' if share >= 1.0 else '.2g'}} %"
