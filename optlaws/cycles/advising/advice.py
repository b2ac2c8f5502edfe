"""Advice on the law of a move or a cycle: laws side by side, the front, and the recommended law."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import inf
from typing import Any

import numpy as np

from optlaws.cycles.advising.candidates import AdvisedLaw, Candidates, LawMeasure, exceeded
from optlaws.cycles.advising.recommendation import Recommendation, recommended
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.moves.timed_moves import read_follower
from optlaws.cycles.specification.limits import AXES
from optlaws.cycles.specification.programme import axis_of, period_of
from optlaws.cycles.specification.segments import Move, Return
from optlaws.echo import shortened, unknown_key
from optlaws.errors import InfeasibleProblem, InputError, Interrupted, OptlawsError, located, needed
from optlaws.laws.catalogue.catalogue import USUAL
from optlaws.laws.catalogue.reading import read_law
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import TURN, Exact, either, quantity, table
from optlaws.numbers import NumberOrQuantity, bounded, chop, whole
from optlaws.sentences import listed, quantity_name
from optlaws.shown.report import Panel, PlainReport, Report, ReportTable, Series
from optlaws.shown.summary import Row, Summary
from optlaws.spelling import either_spelling
from optlaws.synthesis.least_time.move_limits import RESIDUAL, RESIDUALS
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.status import gap_text
from optlaws.tolerances import VALUE_ROUNDING

#: the laws that most designers choose between, the usual one first
STANDARD = (USUAL, "modified trapezoid", "cycloidal", "3-4-5 polynomial", "4-5-6-7 polynomial")
_MOST_LAWS, _MOST_POINTS = 40, 100
#: of the Z of optimal laws at least, so that a move has one advice, by itself or in a cycle
_DEGREE = 21
_FOLLOWER = '{"frequency": ("27 Hz", "33 Hz"), "damping": 0.05}'
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
        The recommended law, by which rule, and what it gains and costs in two sentences.
    guarded
        Of what the recommended law and those of the front have no more than the usual one: it has no limit of its own.
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
            if law.name in {name, name.replace("least rms ", "least RMS ")}:
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
            name: "no law within the limits meets this aim" if isinstance(error, InfeasibleProblem) else str(error)
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
        ['recommended', 'velocity', 'acceleration']
        """
        chosen = self.recommendation
        rows = [Row("recommended", chosen.law.name)]
        for measure in self.measures:
            change = chosen.changes.get(measure.name)
            against = "" if chosen.usual is None or chosen.usual is chosen.law else f" of {chosen.usual.name}"
            note = f"{100.0 * change:.4g} %{against}" if change is not None and against else ""
            rows.append(Row(quantity_name(measure.name), chosen.law.values[measure.name], measure.unit, note=note))
        rows += [
            Row(f"limit of {quantity_name(taken.name)}", f"{100.0 * taken.share:.4g} %", note=f"of {taken.text}")
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
            "laws": [_law_data(law) for law in self.laws],
            "front": [_law_data(law) for law in self.front],
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
        return page("Advice", facts({"recommended": str(chosen), "rule": chosen.rule}), table(self.headings, self.rows))


def _law_data(law: AdvisedLaw) -> dict[str, Any]:
    """A law's part of the advice for programs, in SI units, with whole solutions."""
    proof = law.proof
    taken = [{"name": t.name, "where": t.where, "value": bounded(t.value), "limit": t.limit} for t in law.limits]
    data = {
        "name": law.name,
        "kind": law.kind,
        "values": {name: bounded(value) for name, value in law.values.items()},
        "keeps_limits": law.keeps_limits,
        "limits": taken,
    }
    if proof is None:
        return data
    solutions = [solution.to_dict() for solution in law.solutions]
    return {**data, **proof._asdict(), "status": proof.status.value, "solutions": solutions}


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
    others = [quantity_name(name) for name in guarded if name != x.name]
    no_more = f" with no more {listed(others, 'or')} than {usual.name}" if usual is not None and others else ""
    below = Series(ends, np.repeat(least[1:], 2), "limit", f"lower bound of laws{no_more}")
    curves = Series(at, values, 0, "front"), Series(ends, np.repeat(values[:-1], 2), 0, "reached"), below
    return [Panel(quantity_name(y.name), y.unit, curves, across=x.heading, per=1.0)]


def more_than_usual(law: AdvisedLaw, usual: AdvisedLaw | None, guarded: Iterable[str], *but: str) -> list[str]:
    """Of what a law takes more than the usual one, though it should not, but for some measures.

    Examples
    --------
    >>> import optlaws
    >>> advice = optlaws.advise(optlaws.Rise("35 mm", "0.1 s"), points=0)
    >>> more_than_usual(advice["modified trapezoid"], advice.recommendation.usual, advice.guarded)
    ['velocity']
    """
    return [] if usual is None else exceeded(law, {name: usual.values[name] for name in guarded if name not in but})


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
    broken = (f"{quantity_name(taken.name)} {100.0 * (taken.share - 1.0):.2g} % beyond" for taken in law.broken)
    return ", ".join(broken) or "satisfied"


def proof_in_words(law: AdvisedLaw) -> str:
    """The status of an optimal law, with its gap where that is not proven to be none; nothing of another law."""
    if law.proof is None:
        return ""
    bound = law.proof.lower_bound
    if law.proof.status == "optimal" or not bound or bound <= 0.0:
        return str(law.proof.status.value)
    return f"{law.proof.status.value}, {gap_text(1.0 - bound / law.values[law.proof.minimise])}"


@either_spelling
def advise(
    motion: Move | Cycle,
    *,
    minimise: str | None = None,
    limits: Mapping[str, Any] | None = None,
    follower: Mapping[str, Any] | None = None,
    drive: Mapping[str, Any] | Mechanism | Drive | None = None,
    speed: NumberOrQuantity | None = None,
    laws: Sequence[str] = STANDARD,
    degree: int | None = None,
    points: int = 7,
) -> Advice:
    """Advice on the law of a motion: standard and optimal laws side by side, their costs, and a recommendation.

    Of the laws that satisfy all limits, and have no more than the usual law of what has no limit (peak velocity,
    acceleration, jerk and residual vibration, the peak torque of a drive, and the RMS torque where a motor is rated by
    it), those within 1 % of the least objective are equally good, and of these the one of least residual vibration,
    where there is a follower, or least jerk is recommended. A mass alone changes nothing: its force is its
    acceleration. Every number is recomputed from the laws; every optimal law has its proof.

    Parameters
    ----------
    motion
        A single move from rest to rest in machine units, `Rise("35 mm", "0.1 s")`, with a `speed` one by angles of the
        master, `Rise("35 mm", "110 deg")`, or a `Cycle`, all of whose moves have the laws in turn. Of
        `Rise("1 m", "1 s")` all numbers are those of laws without units.
    minimise
        What is to be least, as of a `Cycle`: "acceleration", "jerk", "rms torque", "residual acceleration"; what the
        cycle says unless given, of a single move the acceleration.
    limits
        By name, such as velocity "616 mm/s", as of a `Cycle` and more than its own; with a follower of the "residual
        acceleration" or "residual displacement" too. A move may have its own.
    follower
        What the motion leaves vibrating: `{"frequency": ("27 Hz", "33 Hz"), "damping": 0.05}`, its natural frequency or
        the least and the greatest, and its damping ratio.
    drive
        As of a `Cycle`: a mass, a `Mechanism` or a `Drive`, whose torque, power and energy are listed too.
    speed
        Speed of the master, such as "180 rpm": for a single move whose duration is an angle, or for a cycle in place of
        its own.
    laws
        Names of the catalogue, members such as "III(7.2)", or files; the first is the usual one. Others are compared
        with it, unless the motion has a law already.
    degree
        Degree of the optimal laws' Z; unless given 21, or that of the cycle if it is greater.
    points
        How many laws of the front between what is minimised and what decides between equally good laws; 0 for none.

    Returns
    -------
    Advice
        A row for each law, the front, the recommendation.

    Raises
    ------
    InputError
        If an entry is wrong, or no law of the motion could be another.
    InfeasibleProblem
        If no law keeps the limits.
    SolverFailure
        If the search fails.

    Examples
    --------
    >>> from optlaws import Rise, advise
    >>> rise = Rise("35 mm", "0.1 s", limits={"velocity": "640 mm/s"})
    >>> advice = advise(rise, follower={"frequency": ("27 Hz", "33 Hz"), "damping": 0.05}, points=0)
    >>> chosen = advice.recommendation
    >>> chosen.law.kind, chosen.usual.name, chosen.gain > 0.05
    ('optimal', 'modified sine', True)
    """
    count = whole(points, "points", least=0, most=_MOST_POINTS)
    entries = {"minimise": minimise, "drive": drive, "speed": speed, "degree": degree}
    candidates = standard_candidates(motion, limits=limits, follower=follower, laws=laws, **entries)
    try:
        candidates.add_optimal()
        return advice_from(candidates, count)
    except KeyboardInterrupt:
        if candidates.proven is None:
            raise
        text = f"the advice was stopped after {len(candidates.laws)} laws and {len(candidates.exchanged)} points"
        raise Interrupted(text, _of_known(candidates, tuple(candidates.exchanged))) from None


def standard_candidates(
    motion: Any,
    *,
    limits: Mapping[str, Any] | None = None,
    follower: Mapping[str, Any] | None = None,
    laws: Sequence[str] = STANDARD,
    **entries: Any,
) -> Candidates:
    """The standard laws of a motion with their demands, to which optimal ones can be added, as `advise` takes them."""
    most = dict(table(limits or {}, "limits", '{"velocity": "616 mm/s"}'))
    minimise = entries.get("minimise")
    limited = {name: most.pop(name) for name in RESIDUALS if name in most}
    named = list(dict.fromkeys([*limited, *([minimise] if minimise in RESIDUALS else [])]))
    if len(named) > 1:
        raise InputError(f"{named[0]} and {named[1]} are of one vibration: name one of them")
    left = named[0] if named else RESIDUAL
    given = {name: value for name, value in entries.items() if value is not None}
    given |= {"minimise": "acceleration"} if minimise in RESIDUALS else {}
    if isinstance(motion, Cycle):
        given = {"degree": max(motion.degree, _DEGREE), **given} | ({"period": None} if "speed" in given else {})
        cycle = replace(motion, **given, limits={**motion.limits, **most})
    elif isinstance(motion, Move):
        cycle = _of_move(motion, given.pop("speed", None), {"degree": _DEGREE, **given, "limits": most})
    else:
        # what this names could be given in the version before
        instead = ": Rise('1 m', '1 s', limits=...) says the same with units" if isinstance(motion, Problem) else ""
        raise InputError(
            f"advice is of a move such as Rise('35 mm', '0.1 s') or of a Cycle, got {shortened(motion)}{instead}"
        )
    if follower is None and named:
        raise InputError(f"{left} is that of a follower: give follower={_FOLLOWER}")
    of = left.removeprefix("residual ")
    vibrating = None if follower is None else replace(read_follower(follower), of=of)
    dimension = cycle.axis if of == "displacement" else AXES[cycle.axis][2]
    calm = quantity(limited[left], dimension, f"limits: {left}", above=0.0) if limited else inf
    known = motion.degree if isinstance(motion, Cycle) else None
    candidates = Candidates(cycle, minimise or cycle.minimise, vibrating, calm, known)
    _check(laws)
    first = [] if candidates.own_law is None else [candidates.own_law]
    candidates.add_standard(list(dict.fromkeys([*first, *laws])))
    return candidates


def advice_from(candidates: Candidates, points: int) -> Advice:
    """The advice that standard and optimal laws give, with so many points of the front; 0 for none."""
    return _of_known(candidates, candidates.front(points) if points > 1 else ())


def _of_known(candidates: Candidates, front: tuple[AdvisedLaw, ...]) -> Advice:
    return Advice(
        candidates.minimise,
        candidates.second,
        candidates.measures,
        tuple(candidates.laws.values()),
        front,
        recommended(candidates, front),
        tuple(candidates.most()),
        candidates.errors,
    )


def _check(laws: Any) -> None:
    if isinstance(laws, str) or not isinstance(laws, Sequence) or not all(isinstance(law, str) for law in laws):
        raise InputError(f"laws must be names such as ['modified sine', 'cycloidal'], got {shortened(laws)}")
    if len(laws) > _MOST_LAWS:
        raise InputError(f"laws: at most {_MOST_LAWS} are compared, got {len(laws)}")
    with located("laws"):
        for law in laws:
            read_law(law)  # a name that is no law's is a mistake, no law that does not fit


def _of_move(move: Move, speed: NumberOrQuantity | None, entries: Mapping[str, Any]) -> Cycle:
    """A single move as a cycle that continues from its end."""
    axis = axis_of([move])
    if move.duration is None or isinstance(move.duration, list | tuple):
        raise InputError("a single move has one duration, such as '0.1 s', or '110 deg' with a speed")
    dimension = either(move.duration, ("time", "angle"), "duration of a single move")[0]
    seconds = quantity(move.duration, dimension, "duration of a single move", above=0.0)
    if dimension == "angle":
        if speed is None:
            raise InputError(
                f"the duration of a single move, {move.duration}, is an angle of the master: give its speed too, such "
                "as speed='180 rpm'"
            )
        seconds *= period_of(speed, None) / TURN
        move = replace(move, duration=Exact(seconds, "s"))
    far = quantity(move.to if move.by is None else move.by, axis, "by")
    advance = Exact(-far if isinstance(move, Return) else far, unit_of(axis))
    return Cycle([move], period=Exact(seconds, "s"), advance=advance, **entries)
