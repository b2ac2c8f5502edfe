"""Least times as the page shows them: the proven least, the law of any longer time, which limit binds at each time."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from itertools import groupby
from math import inf
from pathlib import Path
from typing import Annotated, Any

import msgspec
import numpy as np

from optlaws import Cycle, Drive, FastestCycle, FastestMove, MotionLaw, Problem, Solution, Status, fastest
from optlaws.cycles.moves.fastest_move import AXES
from optlaws.cycles.moves.report import MoveReport
from optlaws.cycles.report import CycleReport
from optlaws.cycles.summary import drive_rows, objective_unit, peak_rows
from optlaws.errors import InputError, OptlawsError
from optlaws.explorer.views import cycle_view
from optlaws.explorer.views.law_view import TITLES, digits, gap_text, refusal
from optlaws.explorer.views.panel_data import panel_data
from optlaws.explorer.views.requests import MOST_DEGREE, MOST_ORDER, Question, without_files
from optlaws.jobs.cycle_entries import AxisEntries, CycleProblemFile
from optlaws.jobs.moves.move_entries import FastestProblemFile, MoveEntries, arguments_of, front_of
from optlaws.mechanisms.drives.sheet import share_used
from optlaws.motion.display_units import MILLI, RPM
from optlaws.motion.piece import factor, unit_of
from optlaws.motion.quantities import QUANTITIES, si_number
from optlaws.numbers import Array, Quantity, bounded, whole
from optlaws.sentences import Amount, sentence
from optlaws.shown.curve_points import refined
from optlaws.shown.report import Panel, PanelLimit, Series
from optlaws.studies.problem_entries import problem
from optlaws.synthesis.least_time.follower_residual import RESIDUAL
from optlaws.synthesis.least_time.motor_torque import CURVE_LIMIT
from optlaws.synthesis.least_time.move_objective import AT_MOTOR, OBJECTIVES
from optlaws.tolerances import AGREEMENT, LEAST_TIME_GAP

_WHERE = Path("the study")
_STEPS = 241
_POINTS = 11
_CYCLE_POINTS = 6
_LONGEST = 2.0
_SLOWER = 1.0001
_PROVEN, _LOCAL = "proven at every point", "local, with its bound"
#: a limit is taken to the full from this share of it
_FULL = 0.999

Seconds = Annotated[float, msgspec.Meta(gt=0.0, le=1e5)]


class FastestRequest(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Moves or cycles, as in their problem file, the one on display, and its time; the least time by default."""

    study: dict[str, Any]
    move: Annotated[int, msgspec.Meta(ge=0, le=7)] = 0
    time: Seconds | None = None


def answer(request: FastestRequest) -> dict[str, Any]:
    """The motion in its time with its limits, or the reason why there is none."""
    try:
        if request.study.get("job") == "cycle":
            return _view_of_cycle(request)
        return _view_of_move(_read(request), request.time)
    except OptlawsError as error:
        return {"refused": refusal(error)}


# --- single moves ---


@dataclass(frozen=True)
class _Sought:
    """A move that is shown: its entries, the space of its laws, and its least time."""

    move: MoveEntries
    given: dict[str, Any]
    least: FastestMove

    @property
    def minimise(self) -> str | None:
        """The objective in longer times."""
        return None if self.move.front is None else self.move.front.minimise[0]

    @property
    def drive(self) -> Drive | None:
        """The motor, where there is one."""
        drive: Drive | None = self.given.get("drive")
        return drive


def fastest_of(request: FastestRequest) -> FastestMove:
    """The least time of the move that is shown, with its proof."""
    return _read(request).least


def proof_of(request: FastestRequest) -> dict[str, Any]:
    """The stored proof of a least time, and of the laws in the displayed time."""
    if request.study.get("job") == "cycle":
        spec, axis = _axis(request)
        quickest = _fastest_cycle(spec, axis)
        solutions = _cycle_in_time(spec, axis, quickest, request.time).solutions
        return quickest.claims() | {"solutions": [solution.to_dict() for solution in solutions]}
    sought = _read(request)
    solution = _in_time(sought, request.time).solution
    return sought.least.to_dict() | ({} if solution is None else {"in_this_time": solution.to_dict()})


def _read(request: FastestRequest) -> _Sought:
    spec = FastestProblemFile.read(request.study, _WHERE)
    move = spec.move[min(request.move, len(spec.move) - 1)]
    if (move.drive or {}).get("motors") is not None:
        raise InputError("motors: the page reads no catalogue: give the motor as a table, or start with the file")
    without_files(request.study.get("problem"))
    space = spec.problem or {}
    if space.get("bounds"):
        raise InputError("problem: it gives no limits of its own: limits are those of the move")
    return _sought(move, json.dumps(space))


@lru_cache(maxsize=64)
def _sought(move: MoveEntries, entries: str) -> _Sought:
    space: Problem = problem("problem", {"order": 3}, json.loads(entries))
    whole(space.order, "order", least=1, most=MOST_ORDER)
    degree = space.basis.to_dict().get("degree")
    if isinstance(degree, int):
        whole(degree, "degree", most=MOST_DEGREE)
    given = arguments_of(move, _WHERE)
    return _Sought(move, given, fastest(space, stroke=_stroke(move), **given))


def _stroke(move: MoveEntries) -> Quantity:
    return move.stroke[0] if isinstance(move.stroke, tuple) else move.stroke


@dataclass(frozen=True)
class _InTime:
    """The law of a time: the fastest law, or the law of the least objective, with its proof."""

    law: MotionLaw
    duration: float
    value: float | None = None
    lower_bound: float | None = None
    solution: Solution | None = None
    unit: str = ""


def _in_time(sought: _Sought, time: float | None) -> _InTime:
    least = sought.least.duration * (1.0 + LEAST_TIME_GAP)
    if sought.minimise is None or time is None or time <= least * (1.0 + LEAST_TIME_GAP):
        return _InTime(sought.least.law, sought.least.duration)
    line = front_of(sought.least, sought.move, sought.minimise, sought.given, (f"{time!r} s", 2))
    point = line[1]
    return _InTime(point.law, point.duration, point.value, bounded(point.lower_bound), line.solutions[1], line.unit)


def _view_of_move(sought: _Sought, time: float | None) -> dict[str, Any]:
    least, shown = sought.least, _in_time(sought, time)
    curves, limits = _Curves(sought, shown), least.least.move.limits_in(shown.duration)
    used = {limit.name: limit.constant.value(shown.law) / limit.bound for limit in limits}
    panels = [*MoveReport(least, shown.law, shown.duration).panels, *curves.torque_panel()]
    times = np.unique(np.concatenate([panel.series[0].at for panel in panels]))
    shares = curves.shares(times)
    return {
        "across": "time, ms",
        "symbol": "t, ms",
        "range": [0.0, MILLI * shown.duration],
        "panels": [_coloured(panel, curves.shares) for panel in panels],
        "segments": _stretches(times, shares),
        "names": list(shares),
        "shares": _greatest_shares({name: used[name] for name in shares}),
        "rows": list(_rows(sought, shown)),
        "time": shown.duration,
        "least": _least(least.duration, least.none_below, least.limit),
        "objectives": _objectives(sought),
        "minimise": sought.minimise,
        "trust": _trust_of_move(sought, shown),
        "note": "" if isinstance(sought.move.stroke, str) else f"the first of {len(sought.move.stroke)} strokes",
    }


def _least(duration: float, below: float | None, limit: float | None) -> dict[str, Any]:
    return {
        "time": duration,
        "text": digits(MILLI * duration),
        "below": None if below is None else digits(MILLI * below),
        "limit": limit,
        "limit_text": None if limit is None else digits(MILLI * limit),
    }


def _objectives(sought: _Sought) -> list[str]:
    """The possible objectives in longer times."""
    names = [name for name in OBJECTIVES if name not in AT_MOTOR and name != RESIDUAL]
    names += list(AT_MOTOR) if sought.drive is not None else []
    return names + ([RESIDUAL] if sought.move.follower is not None else [])


class _Curves:
    """A law in machine units over k, and its use of each limit there."""

    def __init__(self, sought: _Sought, shown: _InTime) -> None:
        self._sought, self._move, self._law = sought, sought.least.least.move, shown.law
        self._time = shown.duration

    def values(self, times: Array, nu: int) -> Array:
        """The derivative of order nu in SI units."""
        return factor(self._move.stroke, self._time, nu) * np.asarray(self._law(times / self._time, nu))

    def torque_panel(self) -> Iterator[Panel]:
        """The torque at the motor with its peak and its limit, where there is a motor."""
        drive, torque = self._sought.drive, self._move.torque
        if drive is None:
            return
        sheet = drive.sheet(self._law, self._sought.given["start"], _stroke(self._sought.move), f"{self._time!r} s")
        marks = self._time * np.array([sheet.peak_torque_at, sheet.curve_use_at])
        times = np.unique(self._time * np.array([*np.linspace(0.0, 1.0, _STEPS), *self._law.breaks]))
        times, (values,) = refined(times, [self.torque(times)], [self.torque], marks)
        most = None if torque is None else torque.peak
        limits = () if most is None else (PanelLimit(0.0, self._time, -most, most),)
        peaks = tuple(zip(marks[:1].tolist(), self.torque(marks[:1]).tolist(), strict=True))
        yield Panel("torque", "N m", (Series(times, values),), limits, peaks)

    def torque(self, times: Array) -> Array:
        """The torque at the motor."""
        position = float(si_number(self._sought.given["start"], ("angle",), "start"))
        x, v, w = (self.values(times, nu) for nu in range(3))
        assert self._sought.drive is not None  # noqa: S101 - asked of moves with one
        return np.asarray(self._sought.drive.torque(position + x, v, w))

    def shares(self, times: Array) -> dict[str, Array]:
        """The share of each limit that is taken at each time, 0 to 1."""
        taken = {}
        for limit in self._move.rates:
            rates = self.values(times, limit.nu) / (limit.rate * self._move.stroke)
            one_sided = limit.nu == 2 and not self._move.limits.symmetric
            sign = -1.0 if limit.name == "deceleration" else 1.0
            taken[limit.name] = np.maximum(sign * rates, 0.0) if one_sided else np.abs(rates)
        torque, drive = self._move.torque, self._sought.drive
        if drive is not None and torque is not None:
            size = np.abs(self.torque(times))
            if torque.peak is not None:
                taken["torque"] = size / torque.peak
            if torque.curve:
                taken[CURVE_LIMIT] = share_used(size, drive.motor.peak_at(drive.ratio * self.values(times, 1)))
        return taken


def _nearest(shares: dict[str, Array], count: int) -> Array:
    """The number of the limit of which most is taken, at each place."""
    return np.argmax(np.array(list(shares.values())), axis=0) if shares else np.zeros(count, dtype=int)


def _runs(numbers: Array) -> Iterator[tuple[int, int, int]]:
    """Stretches of one number: it, the first place, and the place at which the next begins."""
    start = 0
    for number, places in groupby(numbers.tolist()):
        stop = start + len(list(places))
        yield number, start, stop
        start = stop


def _coloured(panel: Panel, shares: Callable[[Array], dict[str, Array]]) -> dict[str, Any]:
    """The curve of a panel, and a series of it for each limit, which is drawn where most is taken of that one."""
    (whole,) = panel.series
    times, taken = whole.at, shares(whole.at)
    parts: dict[int, list[tuple[Array, Array]]] = {i: [] for i in range(len(taken))}
    for i, start, stop in _runs(_nearest(taken, len(times))) if taken else ():
        # on to the first place of the next, so that the curve is whole
        at, values = times[start : stop + 1], whole.values[start : stop + 1]
        parts[i].append((np.append(at, at[-1]), np.append(values, np.nan)))
    limited = [
        Series(
            np.concatenate([at for at, _ in runs]), np.concatenate([values for _, values in runs]), f"bind-{i}", name
        )
        for (i, runs), name in zip(parts.items(), taken, strict=True)
        if runs
    ]
    return panel_data(replace(panel, series=(whole, *limited)))


def _stretches(times: Array, shares: dict[str, Array]) -> list[dict[str, Any]]:
    """The limiting quantity at each time: stretches with the limit of greatest use, and whether it is reached."""
    names, number = list(shares), _nearest(shares, len(times))
    stretches = []
    for i, start, stop in _runs(number) if names else ():
        most = float(shares[names[i]][start:stop].max())
        ends = [round(MILLI * float(times[at]), 4) for at in (start, min(stop, len(times) - 1))]
        stretches.append({"name": names[i] if most else "rest", "at": ends, "law": i, "full": most >= _FULL})
    return stretches


def _greatest_shares(used: Mapping[str, float]) -> list[dict[str, Any]]:
    return [{"name": name, "text": digits(100.0 * share, 4), "full": share >= _FULL} for name, share in used.items()]


def _rows(sought: _Sought, shown: _InTime) -> Iterator[dict[str, Any]]:
    """The law's use of each limit, and the motor's capacity."""
    least, move = sought.least, sought.least.least.move
    axis = AXES[least.unit]
    orders = {limit.name: limit.nu for limit in move.rates}
    left = None if move.residual is None else move.residual.most
    most: dict[str, tuple[float | None, str]] = {RESIDUAL: (left, unit_of(axis, 2))}
    if move.torque is not None:
        most |= {"torque": (move.torque.peak, "N m"), "rms torque": (move.torque.rms, "N m")}
    for limit in move.limits_in(shown.duration):
        share = limit.constant.value(shown.law) / limit.bound
        if limit.name in orders:
            nu = orders[limit.name]
            peak = limit.constant.value(shown.law) * factor(least.stroke, shown.duration, nu)
            yield _row(limit.name, peak, unit_of(axis, nu), share)
        else:
            value, unit = most.get(limit.name, (None, ""))
            yield _row(limit.name, share if value is None else share * value, unit if value is not None else "", share)
    if sought.drive is not None:
        sheet = sought.drive.sheet(shown.law, sought.given["start"], _stroke(sought.move), f"{shown.duration!r} s")
        limited = {limit.name for limit in move.limits_in(shown.duration)}
        torques = {"torque": sheet.peak_torque, "rms torque": sheet.rms_torque}
        yield from (_row(name, value, "N m", None) for name, value in torques.items() if name not in limited)
        yield _row("speed of the motor", sheet.peak_speed * RPM, "rpm", None)


def _row(name: str, value: float, unit: str, share: float | None) -> dict[str, Any]:
    use = None if share is None else digits(100.0 * share, 4)
    full = share is not None and share >= _FULL
    return {"name": name, "unit": unit, "value": bounded(value), "use": use, "full": full}


def _trust_of_move(sought: _Sought, shown: _InTime) -> dict[str, Any]:
    least = sought.least
    facts = [
        f"least time {digits(MILLI * least.duration)} ms",
        f"proven: no law of this space in {digits(MILLI * least.none_below)} ms or less",
    ]
    if least.limit is not None:
        facts.append(f"no law of any degree in less than {digits(MILLI * least.limit)} ms")
    if shown.solution is None:
        status, gap = least.status, gap_text(least.gap)
        advice = "No law of this order and degree is faster within the limits."
        advice = advice if status is Status.OPTIMAL else status.advice
        facts += least.notes
    else:
        status, gap = shown.solution.status, gap_text(shown.solution.gap)
        value = Amount(shown.value or 0.0, shown.unit, 7)
        facts.insert(0, sentence("least {} in this time {}", sought.minimise, value))
        if shown.lower_bound is not None:
            facts.insert(1, sentence("none below {}", Amount(shown.lower_bound, shown.unit, 7)))
        advice = status.advice
    verdict = {"status": status.value, "word": TITLES[status], "advice": advice, "gap": gap, "facts": facts}
    return verdict | {"proof": True}


def front(request: FastestRequest) -> dict[str, Any]:
    """The least objective over the time, from the proven least time on, with its lower bound in the law space."""
    if request.study.get("job") == "cycle":
        return _front_of_cycle(request)
    sought = _read(request)
    if sought.minimise is None:
        return {"points": [], "words": "choose what is to be least in longer times"}
    extent = None if sought.move.front is None else sought.move.front.longest
    line = front_of(sought.least, sought.move, sought.minimise, sought.given, (extent, _POINTS))
    proven = line.status is Status.OPTIMAL
    return {
        "points": [[point.duration, point.value, bounded(point.lower_bound)] for point in line],
        "name": line.minimise,
        "unit": line.unit,
        "proven": proven,
        "words": f"least {line.minimise} in each time: {_PROVEN if proven else _LOCAL}",
    }


# --- whole cycles ---


def _axis(request: FastestRequest) -> tuple[CycleProblemFile, AxisEntries]:
    spec, axis = cycle_view.read(cycle_view.CycleRequest(study=request.study, axis=request.move))
    return spec, axis


@lru_cache(maxsize=32)
def _fastest_cycle(spec: CycleProblemFile, axis: AxisEntries) -> FastestCycle:
    return cycle_view.stored(spec, axis).fastest()


def _cycle_in_time(spec: CycleProblemFile, axis: AxisEntries, quickest: FastestCycle, time: float | None) -> Cycle:
    """The cycle at its greatest speed, or in a longer period, where the laws of its objective are looked for again."""
    if time is None or time <= quickest.period * (1.0 + AGREEMENT):
        cycle: Cycle = quickest.cycle
        return cycle
    return cycle_view.stored(replace(spec, speed=None, period=f"{time!r} s"), axis)


def _view_of_cycle(request: FastestRequest) -> dict[str, Any]:
    spec, axis = _axis(request)
    quickest = _fastest_cycle(spec, axis)
    shown = _cycle_in_time(spec, axis, quickest, request.time)
    edges, report = shown.limits_of_segments, CycleReport(shown)
    panels = [report.panel(nu) for nu in range(4)]
    times = np.unique(np.concatenate([panel.series[0].at for panel in panels]))
    shares = _shares_of_cycle(shown, times)
    return {
        "across": "time, ms",
        "symbol": "t, ms",
        "range": [0.0, MILLI * shown.duration],
        "panels": [_coloured(panel, partial(_shares_of_cycle, shown)) for panel in panels],
        "segments": _stretches(times, shares),
        "names": list(shares),
        "shares": _greatest_shares(_greatest_of_cycle(shown, edges)),
        "rows": [_row(row.name, row.value, row.unit, None) for row in (*peak_rows(shown), *drive_rows(shown))],
        "time": shown.duration,
        "least": _least(quickest.period, quickest.lower_bound, None),
        "objectives": [],
        "minimise": shown.minimise,
        "trust": _trust_of_cycle(quickest, shown),
        "note": "",
    }


def _shares_of_cycle(shown: Cycle, times: Array) -> dict[str, Array]:
    """The share of the limits of each segment that is taken at each time."""
    taken: dict[str, Array] = {}
    for nu in (1, 2, 3):
        share, values = np.zeros(len(times)), np.asarray(shown(times, nu))
        for peak, limits in zip(shown.peaks, shown.limits_of_segments, strict=True):
            low, high = limits.get(nu, (-inf, inf))
            inside = (times >= peak.start) & (times <= peak.start + peak.duration)
            share = np.where(inside, np.maximum(share, np.maximum(values / high, values / low)), share)
        if share.any():
            taken[QUANTITIES[nu]] = share
    return taken


def _greatest_of_cycle(shown: Cycle, edges: Sequence[dict[int, tuple[float, float]]]) -> dict[str, float]:
    """The greatest share of the limits of each derivative over all segments that have one."""
    used: dict[str, float] = {}
    for nu in (1, 2, 3):
        shares = [
            max(value / limits[nu][1], value / limits[nu][0])
            for peak, limits in zip(shown.peaks, edges, strict=True)
            if nu in limits
            for value, _ in peak.extremes[nu]
        ]
        if any(shares):
            used[QUANTITIES[nu]] = max(shares)
    return used


def _trust_of_cycle(quickest: FastestCycle, shown: Cycle) -> dict[str, Any]:
    facts: list[str] = [
        sentence("greatest speed {}", Amount(quickest.rpm, "rpm", 7)),
        f"least period {digits(MILLI * quickest.period)} ms",
    ]
    if quickest.lower_bound is not None:
        facts.append(f"proven: none in {digits(MILLI * quickest.lower_bound)} ms")
    facts += [sentence("binds: {}", text) for text in quickest.binding]
    if shown is not quickest.cycle:
        known = cycle_view.trust(shown)
        if known is not None:
            return known | {"facts": [*known["facts"], *facts]}
    status = quickest.status
    advice = "No law of this order and degree lets the cycle run faster." if status is Status.OPTIMAL else status.advice
    verdict = {"status": status.value, "word": TITLES[status], "advice": advice, "gap": "", "facts": facts}
    return verdict | {"proof": bool(quickest.proofs)}


def _front_of_cycle(request: FastestRequest) -> dict[str, Any]:
    spec, axis = _axis(request)
    quickest = _fastest_cycle(spec, axis)
    points: list[list[float | None]] = []
    proven = True
    for time in np.geomspace(quickest.period * _SLOWER, _LONGEST * quickest.period, _CYCLE_POINTS).tolist():
        try:
            cycle = _cycle_in_time(spec, axis, quickest, time)
            points.append([time, cycle.objective, None if cycle.lower_bound is None else bounded(cycle.lower_bound)])
            proven = proven and cycle.status is Status.OPTIMAL
        except OptlawsError:
            points.append([time, None, None])
    cycle = quickest.specification
    return {
        "points": points,
        "name": cycle.minimise,
        "unit": objective_unit(cycle),
        "proven": proven,
        "words": f"least {cycle.minimise} in each period: {_PROVEN if proven else _LOCAL}",
    }


def example() -> dict[str, Any]:
    """The moves that the page shows where none were given: a rotary table with its motor, and a gripper."""
    return {
        "job": "fastest",
        "title": "A gripper and a rotary table",
        "problem": {"order": 3, "basis": "chebyshev", "degree": 11},
        "move": [
            {
                "name": "gripper",
                "stroke": "300 mm",
                "limits": {"velocity": "1.5 m/s", "acceleration": ["-12 m/s^2", "15 m/s^2"], "jerk": "600 m/s^3"},
                "follower": {"frequency": ["13 Hz", "15 Hz"], "damping": 0.02},
                "front": {"minimise": [RESIDUAL, "jerk"], "longest": "0.41 s", "points": 9},
            },
            {
                "name": "table",
                "stroke": "45 deg",
                "start": "0 deg",
                "mechanism": {
                    "kind": "table", "inertia": "0.8 kg m^2", "load": "20 N m", "viscous": "0.5 N m s/rad",
                },
                "drive": {
                    "motor": {"inertia": "3e-4 kg m^2", "peak_torque": "4 N m", "greatest_speed": "900 rpm"},
                    "ratio": 20,
                },
                "front": {"minimise": ["rms torque", "torque"], "longest": "0.45 s", "points": 11},
            },
        ],
    }  # fmt: skip


QUESTIONS: dict[str, Question] = {"fastest": (FastestRequest, answer), "fastest-front": (FastestRequest, front)}
