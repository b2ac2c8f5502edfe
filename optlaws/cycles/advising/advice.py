"""The answer to "which law?": laws side by side, the front between two measures, and the recommended law."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from optlaws.cycles.advising.advised_law import AdvisedLaw, LawMeasure
from optlaws.cycles.advising.recommendation import Recommendation
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError
from optlaws.extras import needed
from optlaws.numbers import bounded, chop
from optlaws.shown.report import Panel, PlainReport, Report, ReportTable, Series
from optlaws.shown.summary import Row, Summary
from optlaws.suggest import unknown_key
from optlaws.tolerances import VALUE_ROUNDING

#: of why there is no law: formulas of machines are longer than anybody reads
_LONGEST = 200


@dataclass(frozen=True, repr=False)
class Advice:
    """Laws for one motion side by side, computed by `advise`: a row for each law, the front, and the recommendation.

    Attributes
    ----------
    minimise
        What is to be least.
    second
        What decides between laws that are equally good; the front is between the two.
    measures
        What laws are compared by, with the units.
    laws
        Standard laws first, then optimal ones, each with its proof.
    front
        Laws that exchange one for the other, each with its proof; empty where it was left out.
    recommendation
        The law to take, by which rule, and what it gains and costs in two sentences.
    guarded
        Of what the law to take, and those of the front, take no more than the usual one: it has no limit of its own.
    errors
        Why there is no law of a name.

    Examples
    --------
    >>> import optlaws
    >>> advice = optlaws.advise(optlaws.Rise("35 mm", "0.1 s"), points=0)
    >>> print(advice.recommendation)
    Take ...
    """

    minimise: str
    second: str
    measures: tuple[LawMeasure, ...]
    laws: tuple[AdvisedLaw, ...]
    front: tuple[AdvisedLaw, ...]
    recommendation: Recommendation
    guarded: tuple[str, ...] = ()
    errors: Mapping[str, OptlawsError] = field(default_factory=dict)

    def __getitem__(self, name: str) -> AdvisedLaw:
        for law in self.laws:
            if law.name == name:
                return law
        raise InputError(unknown_key(name, [law.name for law in self.laws], "law of this advice"))

    def __iter__(self) -> Iterator[AdvisedLaw]:
        return iter(self.laws)

    def __len__(self) -> int:
        return len(self.laws)

    @property
    def headings(self) -> tuple[str, ...]:
        """The headings of the rows."""
        return ("law", *(measure.heading for measure in self.measures), "limits", "proof")

    @property
    def rows(self) -> list[list[float | str]]:
        """A row for each law, with a cell for each heading; what is rounding beside the other laws is 0."""
        sizes = {name: max(abs(law.values[name]) for law in self.laws) for name, _ in self.measures}
        return [
            [
                law.name,
                *(chop(law.values[name], size, VALUE_ROUNDING) for name, size in sizes.items()),
                limits_in_words(law),
                proof_in_words(law),
            ]
            for law in self.laws
        ]

    @property
    def remarks(self) -> tuple[str, ...]:
        """Why there is no law of a name, in a line each."""
        why = {
            name: "no law within the limits does that" if isinstance(error, InfeasibleProblem) else str(error)
            for name, error in self.errors.items()
        }
        return tuple(f"{name}: {text.splitlines()[0][:_LONGEST]}" for name, text in why.items())

    def summary(self) -> Summary:
        """The recommended law, its demands, the proven bounds, and the reason for the recommendation.

        Examples
        --------
        >>> import optlaws
        >>> summary = optlaws.advise(optlaws.Rise("1 m", "1 s"), points=0).summary()
        >>> [row.name for row in summary][:3]
        ['take', 'velocity', 'acceleration']
        """
        chosen = self.recommendation
        rows = [Row("take", chosen.law.name)]
        for measure in self.measures:
            change = chosen.changes.get(measure.name)
            against = "" if chosen.usual is None or chosen.usual is chosen.law else f" of {chosen.usual.name}"
            note = f"{100.0 * change:.4g} %{against}" if change is not None and against else ""
            rows.append(Row(measure.name, chosen.law.values[measure.name], measure.unit, note=note))
        rows += [
            Row(f"limit of {taken.name}", f"{100.0 * taken.share:.4g} %", note=f"of {taken.text}")
            for taken in chosen.law.limits
        ]
        rows += [Row("why", sentence) for sentence in chosen.sentences]
        return Summary([*rows, Row("rule", chosen.rule)])

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:
        """Draw the minimised measure over the second: the front, all laws, the recommended one; returns the artists.

        `ax` are axes of matplotlib, new ones unless given; `style` is what `Axes.plot` takes, for the front.
        """
        from optlaws.plots.front import draw_advice

        return draw_advice(self, ax, **style)

    def to_pandas(self) -> Any:
        """The rows as a data frame with the laws' names as index; needs the extra `optlaws[studies]`."""
        pd = needed("pandas", "to_pandas")
        return pd.DataFrame(self.rows, columns=list(self.headings)).set_index("law")

    def report(self) -> Report:
        """The recommended law, the table of all laws, and the front with what no law is below.

        Examples
        --------
        >>> import optlaws
        >>> report = optlaws.advise(optlaws.Rise("1 m", "1 s"), points=0).report()
        >>> report.tables[0].headings[0], report.data["recommendation"]["usual"]
        ('law', 'modified sine')
        """
        y, x = (next(each for each in self.measures if each.name == name) for name in (self.minimise, self.second))
        panels = front_panels(self.front, x, y, self.guarded, self.recommendation.usual)
        return PlainReport(self.summary(), [ReportTable(self.headings, self.rows)], panels, self._data)

    def _data(self) -> dict[str, Any]:
        """The advice as plain data in SI units, with whole solutions, to be written and not read again."""
        chosen = self.recommendation
        return {
            "minimise": self.minimise,
            "second": self.second,
            "guarded": list(self.guarded),
            "measures": [{"name": measure.name, "unit": measure.unit} for measure in self.measures],
            "laws": [law.data for law in self.laws],
            "front": [law.data for law in self.front],
            "recommendation": {
                "law": chosen.law.name,
                "usual": None if chosen.usual is None else chosen.usual.name,
                "rule": chosen.rule,
                "gain": None if chosen.gain is None else bounded(chosen.gain),
                "changes": {name: bounded(value) for name, value in chosen.changes.items()},
                "sentences": list(chosen.sentences),
            },
            "errors": {name: str(error) for name, error in self.errors.items()},
        }

    def proofs(self) -> dict[str, Any]:
        """The solutions of all optimal laws by their names, and of the front in order: `optlaws verify` checks them.

        Examples
        --------
        >>> import optlaws
        >>> list(optlaws.advise(optlaws.Rise("1 m", "1 s"), points=0).proofs()["laws"])[0]
        'least acceleration'
        """

        def of(law: AdvisedLaw) -> list[dict[str, Any]]:
            return [each.to_dict() for each in law.solutions]

        laws = {law.name: of(law) for law in self.laws if law.solutions}
        return {"laws": laws, "front": [of(law) for law in self.front[1:] if law.solutions]}

    def __repr__(self) -> str:
        chosen = self.recommendation
        return f"Advice({len(self.laws)} laws, minimise={self.minimise!r}, take={chosen.law.name!r})"

    def __str__(self) -> str:
        return str(self.recommendation)

    def _repr_html_(self) -> str:
        from optlaws.shown.showing import facts, page, table

        chosen = self.recommendation
        return page("Advice", facts({"take": str(chosen), "rule": chosen.rule}), table(self.headings, self.rows))


def front_panels(
    front: Sequence[AdvisedLaw], x: LawMeasure, y: LawMeasure, guarded: Iterable[str], usual: AdvisedLaw | None
) -> list[Panel]:
    """The laws of a front over the second measure, what is reached between two, and what no law is below."""
    if not front:
        return []
    bounds = [0.0 if law.proof is None else max(law.proof.lower_bound or 0.0, 0.0) for law in front]
    rows = sorted((law.values[x.name], law.values[y.name], bound) for law, bound in zip(front, bounds, strict=True))
    at, values, least = np.array(rows).T
    # a law is one at every greater value too, and a bound one at every smaller one
    ends = np.repeat(at, 2)[1:-1]
    others = [name for name in guarded if name != x.name]
    no_more = f", with no more {', '.join(others)} than {usual.name}" if usual is not None and others else ""
    below = Series(ends, np.repeat(least[1:], 2), "limit", f"none below{no_more}")
    curves = Series(at, values, 0, "front"), Series(ends, np.repeat(values[:-1], 2), 0, "reached"), below
    return [Panel(y.name, y.unit, curves, across=x.heading)]


def limits_in_words(law: AdvisedLaw) -> str:
    """Whether a law keeps the limits, or which it breaks and by how much.

    Examples
    --------
    >>> import optlaws
    >>> rise = optlaws.Rise("35 mm", "0.1 s", limits={"velocity": "600 mm/s"})
    >>> limits_in_words(optlaws.advise(rise, points=0)["modified sine"])
    'velocity 2.6 % beyond'
    """
    if not law.limits:
        return ""
    broken = (f"{taken.name} {100.0 * (taken.share - 1.0):.2g} % beyond" for taken in law.broken)
    return ", ".join(broken) or "kept"


def proof_in_words(law: AdvisedLaw) -> str:
    """The status of an optimal law, with its gap where that is not proven to be none; nothing of another law."""
    if law.proof is None:
        return ""
    bound = law.proof.lower_bound
    if law.proof.status == "optimal" or not bound or bound <= 0.0:
        return str(law.proof.status.value)
    return f"{law.proof.status.value}, gap {1.0 - bound / law.values[law.proof.minimise]:.1e}"
