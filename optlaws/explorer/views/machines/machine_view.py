"""Machines as the page shows them: a mechanism and its motor, torque over the cycle, over speed and over the ratio."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import lru_cache
from math import isfinite
from typing import Annotated, Any, cast

import msgspec
import numpy as np

from optlaws import Cycle, Drive, Mechanism, MotionLaw, Motor, Move, Status
from optlaws.cycles.report import CycleReport, samples_of_drive
from optlaws.cycles.specification.process import is_process
from optlaws.cycles.specification.programme import is_optimal
from optlaws.cycles.summary import drive_rows, force_unit
from optlaws.entries.declared import entries_of
from optlaws.errors import InputError, OptlawsError
from optlaws.explorer.views import cycle_view
from optlaws.explorer.views.cycle_view import CycleRequest
from optlaws.explorer.views.law_view import digits, refusal
from optlaws.explorer.views.machines.linkage_picture import over_input, picture
from optlaws.explorer.views.panel_data import drawn, panel_data
from optlaws.explorer.views.requests import MOST_LAWS, Question
from optlaws.jobs.cycle_entries import AxisEntries, CycleProblemFile, cycle_of
from optlaws.mechanisms.linkages.mechanism_kinds import MechanismKind
from optlaws.motion.derivative_panel import samples
from optlaws.motion.display_units import MILLI, RPM, UNITS
from optlaws.numbers import bounded
from optlaws.shown.summary import Row
from optlaws.tolerances import CYCLE_ROUNDING

_EACH = 60
_RATIOS = 7
#: a curve of a motor is drawn up to so many times the speed that is used
_FAR = 1.6

Ratio = Annotated[float, msgspec.Meta(gt=0.0, le=1e6)]


class DrivenRequest(CycleRequest, kw_only=True, forbid_unknown_fields=True):
    """A machine, and for each of its laws those of optimised moves that are evaluated, without any optimisation."""

    laws: (
        Annotated[
            list[Annotated[list[dict[str, Any]], msgspec.Meta(max_length=100)]], msgspec.Meta(max_length=MOST_LAWS)
        ]
        | None
    ) = None


class RatiosRequest(CycleRequest, kw_only=True, forbid_unknown_fields=True):
    """A machine, and the ratios of its gear between which torque is drawn."""

    low: Ratio
    high: Ratio


def answer(request: DrivenRequest) -> dict[str, Any]:
    """The machine with the laws of its file, or the reason why there is none."""
    try:
        spec, axis = _read(request)
        beside, given = _beside(spec, axis), request.laws
        if given is not None and len(given) != len(beside):
            raise InputError(f"laws: {len(beside)} axes have this machine, and laws of {len(given)} are given")
        laws = [_law(spec, other, given[i] if given else []) for i, other in enumerate(beside)]
        place = _place(spec, axis)
        shown, before = laws[place], [bool(moves) for moves in given or [[]] * len(laws)]
        known = {
            "laws": [_described(law) for law in laws],
            "active": place,
            "limiting": [] if axis.limits.get("motor") else sorted(cycle_view.LIMITING),
            "optima": None if given else _optima(beside, laws),
        }
        if isinstance(shown, OptlawsError):
            return known | {"refused": refusal(shown)}
        names = [other.name for other, earlier in zip(beside, before, strict=True) if earlier and other is not axis]
        view = _view(shown, axis, [law for law in laws if isinstance(law, Cycle)], laws)
        return known | view | {"trust": _trust(shown, names, earlier=before[place])}
    except OptlawsError as error:
        return {"refused": refusal(error)}


def _optima(beside: Sequence[AxisEntries], laws: Sequence[Cycle | OptlawsError]) -> list[list[dict[str, Any]]] | None:
    """The laws of optimised moves, with which another machine can be evaluated; None where it cannot."""
    optima = []
    for axis, law in zip(beside, laws, strict=True):
        if isinstance(law, OptlawsError) or axis.load is not None or len(_moves_of(law)) != len(law.solutions):
            return None
        optima.append([solution.law.to_dict() for solution in law.solutions])
    return optima if any(optima) else None


def _moves_of(law: Cycle) -> list[int]:
    """The places of the moves whose law is optimised, if each has a law of its own."""
    return [i for i, segment in enumerate(law.segments) if isinstance(segment, Move) and is_optimal(segment)]


def _trust(shown: Cycle, others: Sequence[str], *, earlier: bool) -> dict[str, Any] | None:
    """How far the law can be trusted; an earlier law is neither optimal nor proven, as those of `others`."""
    trust = cycle_view.trust(shown)
    if earlier:
        broken = [] if trust is None else [trust["advice"]]
        trust = _plainly("law of the previous value", "The optimum follows.", broken)
    if others:
        trust = trust or _plainly("given", "A law as it stands: nothing was optimised.", [])
        trust["facts"] += [f"{name}: law of the previous value, the optimum follows" for name in others]
    return trust


def _plainly(word: str, advice: str, facts: list[str]) -> dict[str, Any]:
    return {"status": "given", "word": word, "advice": advice, "gap": "", "facts": facts}


def _read(request: CycleRequest) -> tuple[CycleProblemFile, AxisEntries]:
    spec, axis = cycle_view.read(request)
    if axis.mechanism is None:
        raise InputError(f"{axis.name} has no mechanism: choose a kind of mechanism, or see it in the view Cycle")
    return spec, axis


def _beside(spec: CycleProblemFile, axis: AxisEntries) -> list[AxisEntries]:
    """The axes of the same machine, which differ in their laws."""
    same = [other for other in spec.axis if (other.mechanism, other.drive) == (axis.mechanism, axis.drive)]
    first = [other for other in same if other is not axis][: MOST_LAWS - 1]
    return [other for other in same if other is axis or any(other is chosen for chosen in first)]


def _place(spec: CycleProblemFile, axis: AxisEntries) -> int:
    return next(i for i, other in enumerate(_beside(spec, axis)) if other is axis)


def _law(spec: CycleProblemFile, axis: AxisEntries, given: Sequence[dict[str, Any]] = ()) -> Cycle | OptlawsError:
    """The cycle of an axis, by optimal laws or by those that are given for its optimised moves."""
    cycle_view.check_axis(axis)
    try:
        cycle = _evaluated(spec, axis, given) if given else cycle_view.stored(spec, axis)
        _ = cycle.effort  # what cannot be driven is told here
    except OptlawsError as error:
        return error
    return cycle


def _evaluated(spec: CycleProblemFile, axis: AxisEntries, given: Sequence[dict[str, Any]]) -> Cycle:
    cycle = cycle_of(axis, spec.speed, spec.period)
    segments, moves = list(cycle.segments), _moves_of(cycle)
    if len(given) != len(moves):
        raise InputError(f"laws: {axis.name} has {len(moves)} optimised moves, and {len(given)} laws are given")
    for i, law in zip(moves, given, strict=True):
        segments[i] = replace(cast("Move", segments[i]), law=_stored(msgspec.json.encode(law)))
    return replace(cycle, segments=segments).unchecked()


@lru_cache(maxsize=64)
def _stored(law: bytes) -> MotionLaw:
    return MotionLaw.from_dict(msgspec.json.decode(law))


def _described(law: Cycle | OptlawsError) -> dict[str, Any]:
    return {"refused": refusal(law)} if isinstance(law, OptlawsError) else {}


def _view(
    shown: Cycle, axis: AxisEntries, cycles: Sequence[Cycle], laws: Sequence[Cycle | OptlawsError]
) -> dict[str, Any]:
    drive = shown.drive
    mechanism = drive.mechanism if isinstance(drive, Drive) else drive
    assert isinstance(mechanism, Mechanism)  # noqa: S101 - as the axis has one
    colours = [i for i, law in enumerate(laws) if isinstance(law, Cycle)]
    return {
        "across": f"time, ms; torque and power at the {'motor' if isinstance(drive, Drive) else 'input'}",
        "symbol": "t, ms",
        "range": [0.0, MILLI * max(cycle.duration for cycle in cycles)],
        "panels": list(_panels(shown, list(zip(colours, cycles, strict=True)))),
        "segments": [
            {"name": peak.name, "at": [MILLI * peak.start, MILLI * (peak.start + peak.duration)]}
            for peak in shown.peaks
        ],
        "drawing": picture(shown, mechanism, axis.mechanism or {}) | {"duration": MILLI * shown.duration},
        "over_input": over_input(shown, mechanism),
        "over_speed": _over_speed(shown, list(zip(colours, cycles, strict=True))),
        "rows": _rows(laws),
    }


Coloured = Sequence[tuple[int, Cycle]]


def _panels(shown: Cycle, cycles: Coloured) -> Iterator[dict[str, Any]]:
    """Torque and power over the time, the speed of the motor or of the input, and the position of the input."""
    name, unit = "velocity of the input", UNITS[shown.axis][1]
    if isinstance(shown.drive, Drive):
        name, unit = "speed of the motor", ("rpm", _speed_of_drive(shown))
    reports = [(law, CycleReport(cycle)) for law, cycle in cycles]
    for i, panel in enumerate(CycleReport(shown).driven):
        yield panel_data(panel.with_curves([(law, report.driven[i]) for law, report in reports]))
    for named, nu, size in ((name, 1, unit), ("position of the input", 0, UNITS[shown.axis][0])):
        curves = [(law, report.panel(nu, size)) for law, report in reports]
        yield panel_data(replace(curves[0][1].with_curves(curves), name=named, limits=(), peaks=()))


def _rows(laws: Sequence[Cycle | OptlawsError]) -> list[dict[str, Any]]:
    """The load of each law on the drive, in the words of the library's summary."""
    known: dict[str, list[Row | None]] = {}
    for i, law in enumerate(laws):
        for row in drive_rows(law) if isinstance(law, Cycle) else ():
            known.setdefault(row.name, [None] * len(laws))[i] = row
    return [
        {
            "name": name,
            "unit": next(row.unit for row in rows if row is not None),
            "values": [None if row is None else bounded(row.value) for row in rows],
            "over": [row is not None and row.note == "too weak" for row in rows],
        }
        for name, rows in known.items()
    ]


def _over_speed(shown: Cycle, cycles: Coloured) -> dict[str, Any] | None:
    """Torque over speed at the motor, in rpm and N m, with the motor's curves; None without a motor."""
    if not isinstance(shown.drive, Drive):
        return None
    courses: list[dict[str, Any]] = []
    for law, cycle in cycles:
        _, speeds = samples(cycle.pieces, 1, 4 * _EACH)
        _, torques = samples_of_drive(cycle, cycle.force, 4 * _EACH)
        courses.append({"law": law, "speeds": drawn(_speed_of_drive(cycle) * speeds, 3), "torques": drawn(torques, 5)})
    fastest = max(_speed_of_drive(cycle) * max(peak.peak(1) for peak in cycle.peaks) for _, cycle in cycles)
    torque = max(cycle.effort.peak_force for _, cycle in cycles)
    greatest = {"torque": torque, "speed": fastest}
    return {"courses": courses, "greatest": greatest, "motor": _motor(shown.drive.motor, fastest)}


def _speed_of_drive(cycle: Cycle) -> float:
    """The motor's speed in rpm by the velocity of the input."""
    return RPM * cycle.drive.ratio if isinstance(cycle.drive, Drive) else 1.0


def _motor(motor: Motor, fastest: float) -> dict[str, Any]:
    """The curves of peak and continuous torque up to a speed, and the numbers that limit them."""
    most = min(RPM * motor.greatest_speed, _FAR * fastest)
    places = np.unique([*np.linspace(0.0, most, 41), *(RPM * speed for speed, _ in motor.curve if RPM * speed <= most)])
    known = {"peak": motor.peak_at(places / RPM), "continuous": motor.continuous_at(places / RPM)}
    curves = {
        name: [
            [round(speed, 3), round(torque, 6)] for speed, torque in zip(places.tolist(), values.tolist(), strict=True)
        ]
        for name, values in known.items()
        if np.isfinite(values).all()
    }
    return {
        "curves": curves,
        "peak_torque": bounded(motor.peak_torque),
        "rated_torque": bounded(motor.rated_torque),
        "greatest_speed": None if not isfinite(motor.greatest_speed) else RPM * motor.greatest_speed,
        "corners": [[round(RPM * speed, 6), torque] for speed, torque in motor.curve],
    }


def ratios(request: RatiosRequest) -> dict[str, Any]:
    """Root mean square and peak of the torque at the motor over the ratio of the gear; None where there is no law."""
    spec, axis = _read(request)
    if not isinstance(axis.drive, dict) or "motor" not in axis.drive or not request.low < request.high:
        return {"ratios": [], "laws": [], "bound": [], "words": "no gear: give the machine a motor"}
    places = np.geomspace(request.low, request.high, _RATIOS).tolist()
    laws = [[_at_ratio(spec, other, ratio) for ratio in places] for other in _beside(spec, axis)]
    shown = laws[_place(spec, axis)]
    cycles = [cycle for cycle in shown if cycle is not None]
    searched = [cycle for cycle in cycles if cycle.solutions and cycle.minimise in _BOUNDED]
    return {
        "ratios": places,
        "laws": [{"rms": _of(law, "rms_force"), "peak": _of(law, "peak_force")} for law in laws],
        "fits": [None if cycle is None else cycle.sheet.fits for cycle in shown],
        "bound": [None if cycle not in searched else _bound(cycle) for cycle in shown],
        "of": _BOUNDED.get(cycles[0].minimise) if cycles else None,
        "words": _words(searched),
    }


#: objectives whose bound is drawn, and whose curve it is below
_BOUNDED = {"rms torque": "rms", "torque": "peak"}


def _words(searched: Sequence[Cycle]) -> str:
    """The proven bounds of the laws over the ratio."""
    if not searched:
        return "torque at the motor over the ratio of the gear, of laws as they are given"
    least = f"least {searched[0].minimise} at each ratio"
    if all(cycle.status is Status.OPTIMAL for cycle in searched):
        return f"{least}: proven"
    return f"{least}: none is below the dashed line, of laws that never turn back"


def _bound(cycle: Cycle | None) -> float | None:
    return None if cycle is None or not cycle.lower_bound else bounded(cycle.lower_bound)


def _at_ratio(spec: CycleProblemFile, axis: AxisEntries, ratio: float) -> Cycle | None:
    law = _law(spec, replace(axis, drive={**(axis.drive or {}), "ratio": ratio}))
    return law if isinstance(law, Cycle) else None


def _of(law: Sequence[Cycle | None], attribute: str) -> list[float | None]:
    return [None if cycle is None else bounded(getattr(cycle.effort, attribute)) for cycle in law]


def limits(request: CycleRequest) -> dict[str, Any]:
    """The infimum of each move over laws that never turn back, beside this law's value; it takes longer."""
    spec, axis = _read(request)
    shown = _law(spec, axis)
    # a process acts on the whole cycle: no move of it has a limit of its own
    if isinstance(shown, OptlawsError) or is_process(shown.load):
        return {"moves": [], "unit": ""}
    return {"moves": list(_moves(shown)), "unit": force_unit(shown)}


def _moves(shown: Cycle) -> Iterator[dict[str, Any]]:
    """The moves from rest to rest, each with its peak and root mean square and with those that no law beats."""
    assert isinstance(shown.drive, Mechanism | Drive)  # noqa: S101 - as the axis has a mechanism
    for peak, effort, stretch in zip(shown.peaks, shown.efforts, shown.programme.stretches, strict=True):
        ends = [abs(extreme) for extreme in _end_velocities(shown, peak.start, peak.duration)]
        if not stretch.displacement or max(ends) > CYCLE_ROUNDING * shown.peak(1):
            continue
        move = float(shown(peak.start)), stretch.displacement, peak.duration
        least = {name: _limit(shown.drive, name, move) for name in ("peak torque", "rms torque")}
        yield {
            "name": peak.name,
            "at": [MILLI * peak.start, MILLI * (peak.start + peak.duration)],
            "peak": _beside_limit(effort.peak_force, least["peak torque"]),
            "rms": _beside_limit(effort.rms_force, least["rms torque"]),
        }


def _end_velocities(shown: Cycle, start: float, duration: float) -> list[float]:
    piece = next(piece for piece in reversed(shown.pieces) if piece.start <= start)
    first, last = piece.values(np.array([start, start + duration]), 1).tolist()
    return [first, last]


def _limit(drive: Mechanism | Drive, name: Any, move: tuple[float, float, float]) -> float | None:
    """The infimum of a move; None where it is unknown, or the motor is too weak for any law."""
    try:
        least = drive.limit(name, *move).value
    except OptlawsError:
        return None
    return least if least > 0.0 else None


def _beside_limit(value: float, least: float | None) -> dict[str, Any]:
    return {"text": digits(value, 6), "least": least, "least_text": None if least is None else digits(least, 6)}


#: how the input of a new mechanism moves: a turn and a rest, or for ever
_A_TURN = [{"kind": "rise", "by": "360 deg", "duration": "0.5 s"}, {"kind": "dwell"}]
_STEADILY = [{"kind": "constant velocity", "velocity": "720 deg/s"}]


def kinds() -> dict[str, dict[str, Any]]:
    """Kinds of mechanisms: the entries of an example and its motion, and the fields of its form.

    Examples
    --------
    >>> sorted(kinds()["table"]), kinds()["rack"]["mechanism"]
    (['axis', 'fields', 'mechanism'], {'radius': '20 mm', 'mass': '12 kg'})
    """
    return {
        name: {
            "mechanism": {each.name: each.example for each in entries_of(kind).values() if each.needed},
            "fields": kind.form()["entries"],
            "axis": {"advance": "360 deg", "segment": _STEADILY if kind.turns_steadily else _A_TURN},
            **({"period": "0.5 s"} if kind.turns_steadily else {}),
        }
        for name, kind in MechanismKind.kinds().items()
    }


def example() -> dict[str, Any]:
    """The machine that the page shows where none was given: a press, driven by two laws."""
    force = [["0 deg", "0 N"], ["280 deg", "0 N"], ["310 deg", "-600 N"], ["340 deg", "-600 N"], ["360 deg", "0 N"]]
    press = {"kind": "slider crank", **kinds()["slider crank"]["mechanism"], "loads": {"over": "input", "force": force}}
    motor = {
        "inertia": "1.5e-3 kg m^2", "rated_torque": "8 N m",
        "curve": [["0 rpm", "24 N m"], ["2000 rpm", "24 N m"], ["3000 rpm", "15 N m"]],
    }  # fmt: skip
    drive = {"motor": motor, "ratio": 10.0}
    turn, feed = {"name": "press", **_A_TURN[0]}, _A_TURN[1]
    motion = {"mechanism": press, "drive": drive, "advance": "360 deg", "segment": [turn, feed]}
    known = {**motion, "segment": [{**turn, "law": "modified sine"}, feed]}
    return {
        "job": "cycle",
        "title": "A slider-crank press by a motor and a gear",
        "period": "0.7 s",
        "axis": [
            {"name": "least RMS torque", "minimise": "rms torque", **motion},
            {"name": "modified sine", **known},
        ],
    }


QUESTIONS: dict[str, Question] = {
    "machine": (DrivenRequest, answer),
    "machine-limits": (CycleRequest, limits),
    "machine-ratios": (RatiosRequest, ratios),
}
