"""The entry to advice: the law to choose for a move or a cycle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import inf
from typing import Any

from optlaws.cycles.advising.advice import Advice
from optlaws.cycles.advising.advised_cycle import AdvisedCycle
from optlaws.cycles.advising.candidates import Candidates
from optlaws.cycles.advising.recommendation import recommended
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.moves.vibration_limits import read_follower
from optlaws.cycles.specification.programme import axis_of
from optlaws.cycles.specification.segments import Move, Return
from optlaws.echo import shortened
from optlaws.errors import InputError, located
from optlaws.laws.catalogue.reading import read_law
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.motion.piece import unit_of
from optlaws.motion.quantities import positive_quantity, quantity, table
from optlaws.numbers import whole
from optlaws.synthesis.least_time.follower_residual import RESIDUAL
from optlaws.synthesis.problem.problem import Problem

#: the laws that most designers choose between, the usual one first
STANDARD = ("modified sine", "modified trapezoid", "cycloidal", "3-4-5 polynomial", "4-5-6-7 polynomial")
_MOST_LAWS, _MOST_POINTS = 40, 100
#: of a single move's laws
_DEGREE = 21
_ACCELERATIONS = {"length": "acceleration", "angle": "angular acceleration"}
_FOLLOWER = '{"frequency": ("27 Hz", "33 Hz"), "damping": 0.05}'


def advise(
    motion: Move | Cycle,
    *,
    minimise: str | None = None,
    limits: Mapping[str, Any] | None = None,
    follower: Mapping[str, Any] | None = None,
    drive: Mapping[str, Any] | Mechanism | Drive | None = None,
    laws: Sequence[str] = STANDARD,
    degree: int | None = None,
    points: int = 7,
) -> Advice:
    """Advice on the law of a motion: standard and optimal laws side by side, their costs, and a recommendation.

    Of the laws that keep every limit, and take no more than the usual law of what has no limit (peak velocity,
    acceleration, jerk, residual vibration, peak and RMS torque), those within 1 % of the least objective are equally
    good, and of these the one of least residual vibration, where there is a follower, or least jerk is recommended.
    Every number is recomputed from the laws; every optimal law has its proof.

    Parameters
    ----------
    motion
        A single move from rest to rest in machine units, `Rise("35 mm", "0.1 s")`, or a `Cycle`, all of whose moves
        have the laws in turn. Of `Rise("1 m", "1 s")` all numbers are those of laws without units.
    minimise
        What is to be least, as of a `Cycle`: "acceleration", "jerk", "rms torque", "residual acceleration"; what the
        cycle says unless given, of a single move the acceleration.
    limits
        By name, such as velocity "616 mm/s", as of a `Cycle` and more than its own; with a follower of the "residual
        acceleration" too. A move may have its own.
    follower
        What the motion leaves vibrating: `{"frequency": ("27 Hz", "33 Hz"), "damping": 0.05}`, its natural frequency or
        the least and the greatest, and its damping ratio.
    drive
        As of a `Cycle`: a mass, a `Mechanism` or a `Drive`, whose torque, power and energy are listed too.
    laws
        Names of the catalogue, members such as "III(7.2)", or files; the first is the usual one. Others are compared
        with it, unless the motion has a law already.
    degree
        Degree of the optimal laws' Z; that of the cycle unless given, of a single move 21.
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
    candidates = standard_candidates(
        motion, minimise=minimise, limits=limits, follower=follower, drive=drive, laws=laws, degree=degree
    )
    candidates.add_optimal()
    return advice_from(candidates, count)


def standard_candidates(
    motion: Move | Cycle,
    *,
    minimise: str | None = None,
    limits: Mapping[str, Any] | None = None,
    follower: Mapping[str, Any] | None = None,
    drive: Mapping[str, Any] | Mechanism | Drive | None = None,
    laws: Sequence[str] = STANDARD,
    degree: int | None = None,
) -> Candidates:
    """The standard laws of a motion with their demands, to which optimal ones can be added, as `advise` takes them."""
    known = _cycle(motion, minimise, limits, follower, drive, degree)
    names = list(dict.fromkeys(_checked(laws)))
    if known.usual is not None:
        names = list(dict.fromkeys([known.usual, *names]))
    candidates = Candidates(known)
    candidates.add_standard(names)
    return candidates


def advice_from(candidates: Candidates, points: int) -> Advice:
    """The advice that standard and optimal laws give, with so many points of the front; 0 for none."""
    front = candidates.front(points) if points > 1 else ()
    return Advice(
        candidates.minimise,
        candidates.second,
        candidates.motion.measures,
        tuple(candidates.laws.values()),
        front,
        recommended(candidates, front),
        tuple(candidates.most()),
        candidates.errors,
    )


def _checked(laws: Any) -> list[str]:
    if isinstance(laws, str) or not isinstance(laws, Sequence) or not all(isinstance(law, str) for law in laws):
        raise InputError(f"laws must be names such as ['modified sine', 'cycloidal'], got {shortened(laws)}")
    if len(laws) > _MOST_LAWS:
        raise InputError(f"laws: at most {_MOST_LAWS} are compared, got {len(laws)}")
    with located("laws"):
        for law in laws:
            read_law(law)  # a name that is no law's is a mistake, no law that does not fit
    return list(laws)


def _cycle(
    motion: Any,
    minimise: str | None,
    limits: Mapping[str, Any] | None,
    follower: Mapping[str, Any] | None,
    drive: Any,
    degree: int | None,
) -> AdvisedCycle:
    entries = dict(table(limits or {}, "limits", '{"velocity": "616 mm/s"}'))
    residual = entries.pop(RESIDUAL, None)
    least = "acceleration" if minimise == RESIDUAL else minimise
    changes: dict[str, Any] = {"minimise": least, "drive": drive, "degree": degree}
    given = {name: value for name, value in changes.items() if value is not None}
    if isinstance(motion, Cycle):
        cycle = replace(motion, **given, limits={**motion.limits, **entries})
    elif isinstance(motion, Move):
        cycle = _of_move(motion, given, entries)
    else:
        # what this names could be given in the version before
        instead = ": Rise('1 m', '1 s', limits=...) says the same with units" if isinstance(motion, Problem) else ""
        raise InputError(
            f"advice is of a move such as Rise('35 mm', '0.1 s') or of a Cycle, got {shortened(motion)}{instead}"
        )
    if follower is None and (residual is not None or minimise == RESIDUAL):
        raise InputError(f"{RESIDUAL} is that of a follower: give follower={_FOLLOWER}")
    vibrating = None if follower is None else read_follower(follower)
    dimension, most = _ACCELERATIONS[cycle.axis], inf
    if residual is not None:
        most = positive_quantity(residual, dimension, f"limits: {RESIDUAL}")
    return AdvisedCycle(cycle, minimise or cycle.minimise, vibrating, most)


def _of_move(move: Move, given: Mapping[str, Any], limits: Mapping[str, Any]) -> Cycle:
    """A single move as a cycle that continues from its end."""
    axis = axis_of([move])
    if move.duration is None or isinstance(move.duration, list | tuple):
        raise InputError("a single move has one duration, such as '0.1 s'")
    seconds = positive_quantity(move.duration, "time", "duration of a single move")
    far = quantity(move.to if move.by is None else move.by, axis, "by")
    advance = f"{-far if isinstance(move, Return) else far!r} {unit_of(axis)}"
    entries = {"degree": _DEGREE, **given, "limits": limits}
    return Cycle([move], period=f"{seconds!r} s", advance=advance, **entries)
