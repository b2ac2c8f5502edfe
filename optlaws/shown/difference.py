"""What a law gains and what it costs: its values beside those of the usual law, as rows that every output renders."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Any, NamedTuple

from optlaws.numbers import bounded
from optlaws.sentences import Amount, Sentence, capital, joined, listed, quantity_name, sentence
from optlaws.shown.report import ReportTable, Section
from optlaws.shown.summary import PAGE_UNITS, Row

_REMEDY = ": give them a higher degree"
_DIGITS = 5
_SAME = 5e-4  # of a value: a difference below it is no whole tenth of a per cent
_FAR = 2.0  # times the usual value: what is above is remarked
#: what limits of cycles and moves bound
_LIMITED = {"velocity", "acceleration", "jerk", "snap", "force", "torque", "power", "energy", "RMS force", "RMS torque"}
#: a value that one law has and the other has not
_NONE = "none"


class Difference(NamedTuple):
    """A quantity with the usual law and with the chosen one.

    Attributes
    ----------
    name, unit
        The quantity, and the unit of both values.
    usual, chosen
        Its values with the two laws; None where there is none.

    Examples
    --------
    >>> Difference("peak acceleration", "m/s²", 21.3, 19.0).text, Difference("peak jerk", "m/s³", 0.0, 2.0).text
    ('-10.8 %', '')
    """

    name: str
    unit: str
    usual: float | None
    chosen: float | None

    @property
    def change(self) -> float | None:
        """By what share of the usual value the chosen one is greater; None where one is missing, 0 or not finite."""
        if not self.usual or self.chosen is None or not isfinite(self.usual) or not isfinite(self.chosen):
            return None
        return self.chosen / self.usual - 1.0

    @property
    def text(self) -> str:
        """The change in per cent; empty where there is none."""
        change = self.change
        if change is None:
            return ""
        return "same" if abs(change) < _SAME else f"{100.0 * change:+.1f} %"


@dataclass(frozen=True)
class Differences:
    """The values of a result beside those of the same result with the usual law.

    Attributes
    ----------
    usual
        The name of the usual law, such as "modified sine".
    values
        The quantities, each with both values; the objective first.
    objective
        The quantity that the laws were to have the least of; empty where none was minimised.
    broken
        Computes which of the limits that the laws keep the usual law breaks, each with its value and the limit.

    Examples
    --------
    >>> values = Difference("peak jerk", "m/s³", 2630.0, 3000.0), Difference("peak power", "W", 24.8, 22.2)
    >>> beside = Differences("modified sine", values, "peak power")
    >>> beside.table.rows[0]
    ['peak power', 24.8, 22.2, '-10.5 %', 'W']
    >>> beside.rows[0].note
    '-10.5 %: modified sine has 24.8 W'
    >>> Differences("modified sine", values, "peak jerk").remarks
    ('modified sine has 12.3 % less peak jerk than these laws: give them a higher degree',)
    >>> Differences("modified sine", values, "peak jerk", lambda: ["rise: velocity, 1.2 m/s of 1 m/s"]).remarks
    ('modified sine has 12.3 % less peak jerk than these laws, but breaks a limit: rise: velocity, 1.2 m/s of 1 m/s',)
    >>> Differences("modified sine", values, "peak power", lambda: ["rise: velocity, 1.2 m/s of 1 m/s"]).remarks
    ('modified sine breaks a limit that these laws satisfy: rise: velocity, 1.2 m/s of 1 m/s',)
    >>> Differences("modified sine", [Difference("jerk", "m/s³", 2630.0, 38293.0)], "energy").remarks
    ('jerk is 14.6 times that of modified sine: limit the jerk to less',)
    >>> drawn = [Difference(name, "", 1.0, 3.0) for name in ("peak jerk", "rms acceleration", "its greatest force")]
    >>> Differences("modified sine", drawn, "energy").remarks
    ('peak jerk is 3 times, RMS acceleration 3 times and its greatest force 3 times that of modified sine: limit ...',)
    >>> times = Difference("least time", "s", 0.2, 0.1), Difference("jerk", "m/s³", 2630.0, 38293.0)
    >>> Differences("modified sine", times, "least time").remarks
    ()
    """

    usual: str
    values: Sequence[Difference]
    objective: str = ""
    broken: Callable[[], Sequence[str]] = tuple

    def __post_init__(self) -> None:
        ordered = sorted(self.values, key=lambda each: each.name != self.objective)
        object.__setattr__(self, "values", ordered)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What the usual law is better in by far, or in the objective at all, each with what to do about it."""
        remarks, far, in_one_time, broken = list[str](), list[Difference](), True, self.broken()
        limits = "a limit" if len(broken) == 1 else "limits"
        named = joined("; ", map(_shortly, broken))
        for each in (value._replace(name=quantity_name(value.name)) for value in self.values):
            change = each.change or 0.0
            if each.name == quantity_name(self.objective):
                # laws of a least time are quicker: what is greater for that needs no remark
                in_one_time = each.unit != "s"
                if change >= _SAME:
                    less = f"{self.usual} has {100.0 * change / (1.0 + change):.1f} % less {each.name} than these laws"
                    why = sentence(", but breaks {}: {}", limits, named) if broken else _REMEDY
                    remarks.append(sentence("{}{}", less, why))
            elif 1.0 + change > _FAR:
                far.append(each)
        if broken and not remarks:
            remarks.append(sentence("{} breaks {} that these laws satisfy: {}", self.usual, limits, named))
        if far and in_one_time:
            times = [(each.name, f"{1.0 + (each.change or 0.0):.3g} times") for each in far]
            known = listed([" is ".join(times[0]), *map(" ".join, times[1:])])
            names = [name for each in far if (name := each.name.removeprefix("peak ")) in _LIMITED]
            of = listed([f"the {name}" for name in names or ["acceleration", "jerk"]])
            remarks.append(f"{known} that of {self.usual}: limit {of} to less")
        return tuple(remarks)

    @property
    def remark_rows(self) -> list[Row]:
        """The remarks as rows of facts."""
        return [Row("remark", remark) for remark in self.remarks]

    @property
    def rows(self) -> list[Row]:
        """A row of facts for each quantity that has both values."""
        return [
            Row(each.name, each.chosen, each.unit, note=_note(each.text, self.usual, Amount(each.usual, each.unit, 5)))
            for each in map(_in_shown_unit, self.values)
            if each.chosen is not None and each.usual is not None
        ]

    @property
    def table(self) -> ReportTable:
        """The quantities with both values and the difference in per cent."""
        shown = map(_in_shown_unit, self.values)
        rows = [[each.name, *_both(each), each.text, each.unit] for each in shown]
        return ReportTable(["what", self.usual, "this law", "difference", "unit"], rows)

    @property
    def data(self) -> dict[str, Any]:
        """For programs: the usual law, and of each quantity both values, in the units that stand beside them."""
        values = [
            {
                "name": each.name,
                "unit": each.unit,
                "usual": None if each.usual is None else bounded(each.usual),
                "chosen": None if each.chosen is None else bounded(each.chosen),
                "change": each.change,
            }
            for each in self.values
        ]
        return {"usual_law": {"name": self.usual, "values": values}}

    def section(self) -> Section:
        """The part of a page that shows them; empty without values."""
        if not self.values:
            return Section()
        heading = f"Compared with {self.usual}"
        note = joined("\n\n", (sentence("{}.", capital(remark)) for remark in self.remarks))
        return Section(heading, self.rows, self.table, self.data, note=note, digits=_DIGITS)


def _both(each: Difference) -> list[float | str | None]:
    """Both values as a table has them: where one of the laws has none, the cell says so."""
    both = each.usual, each.chosen
    return list(both) if both == (None, None) else [_NONE if value is None else value for value in both]


def _in_shown_unit(each: Difference) -> Difference:
    """A difference in the unit in which pages show its dimension."""
    unit, factor = PAGE_UNITS.get(each.unit, (each.unit, 1.0))
    usual, chosen = (None if value is None else factor * value for value in (each.usual, each.chosen))
    return each._replace(name=quantity_name(each.name), unit=unit, usual=usual, chosen=chosen)


def _shortly(text: str) -> Sentence:
    """A text with its amounts as pages write them."""
    parts = text.parts if isinstance(text, Sentence) else (text,)
    return Sentence(*(part.on_page(_DIGITS) if isinstance(part, Amount) else part for part in parts))


def _note(change: str, usual: str, value: Amount) -> str:
    return sentence("{}{} has {}", f"{change}: " if change else "", usual, value)
