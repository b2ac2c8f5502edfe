"""Machines as the page shows them: a mechanism and its motor, torque over the cycle, over speed and over the ratio."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from math import degrees
from typing import Any, cast

import msgspec
import numpy as np

from optlaws import Cycle, Drive, Mechanism, MotionLaw, Motor, Move, Status
from optlaws.cams.at_shaft import CamAtShaft
from optlaws.cycles.report import CycleReport
from optlaws.cycles.specification.programme import is_optimal
from optlaws.cycles.summary import drive_rows
from optlaws.entries.declared import entries_of
from optlaws.errors import InputError, OptlawsError
from optlaws.explorer.views import cycle_view
from optlaws.explorer.views.cam_view import drawing
from optlaws.explorer.views.cycle_view import CycleRequest, packaged_study
from optlaws.explorer.views.law_view import refusal, refusing
from optlaws.explorer.views.panel_data import beside_each_other, drawn, over_time, panel_data
from optlaws.explorer.views.requests import MOST_LAWS, Question
from optlaws.formulas.tree import Formula
from optlaws.jobs.cycle_entries import AxisEntries, CycleProblemFile, cycle_of
from optlaws.mechanisms.linkages.mechanism_kinds import MechanismKind
from optlaws.motion.display_units import MILLI, RPM
from optlaws.motion.quantities import si_number
from optlaws.numbers import Array, bounded
from optlaws.plots.machine import placed
from optlaws.shown.summary import Row

_EACH = 240
_RATIOS = 7
_GIVEN = {"status": "given", "word": "given", "advice": "A law as it stands: nothing was optimised.", "gap": ""}
#: a curve of a motor is drawn up to so many times the speed that is used
_FAR = 1.6
_FRAMES = 181
_SAMPLES = 241
_DECIMALS = 3
#: what a mechanism in proportion is drawn from: the entry of its size
_ROUND = {"rack": "radius", "belt": "radius", "screw": "lead"}
#: units of the input, of its inertia and of its load, and how many of the first make one of SI
_INPUTS = {"angle": ("deg", degrees(1.0), "kg m²", "N m"), "length": ("mm", MILLI, "kg", "N")}


@refusing()
def answer(request: CycleRequest) -> dict[str, Any]:
    """The machine with the laws of its file, or the reason why there is none."""
    spec, axis = _read(request)
    beside, given = _beside(spec, axis), request.laws
    if given is not None and len(given) != len(beside):
        raise InputError(f"laws: {len(beside)} axes have this machine, and laws of {len(given)} are given")
    laws = [_law(spec, other, given[i] if given else []) for i, other in enumerate(beside)]
    place = _place(spec, axis)
    shown, earlier = laws[place], [bool(moves) for moves in given or [[]] * len(laws)]
    known = {
        "laws": [{"refused": refusal(law)} if isinstance(law, OptlawsError) else {} for law in laws],
        "active": place,
        "limiting": [] if axis.limits.get("motor") else sorted(cycle_view.LIMITING),
        "optima": None if given else _optima(beside, laws),
    }
    if isinstance(shown, OptlawsError):
        return known | {"refused": refusal(shown)}
    names = [other.name for other, before in zip(beside, earlier, strict=True) if before and other is not axis]
    cycles = [(i, law) for i, law in enumerate(laws) if isinstance(law, Cycle)]
    mechanism = shown.drive.mechanism if isinstance(shown.drive, Drive) else shown.drive
    assert isinstance(mechanism, Mechanism)  # noqa: S101 - as the axis has one
    report = CycleReport(shown)
    inputs = {i: CycleReport(law).of_input for i, law in cycles}
    panels = beside_each_other(inputs[place], list(inputs.items()))
    used = inputs[place][-1].ends
    of = f"; torque and power at the {'motor' if isinstance(shown.drive, Drive) else 'input'}"
    return {
        **known,
        **over_time([panel_data(panel) for panel in panels], max(law.duration for _, law in cycles), of),
        "segments": [{"name": name, "at": [MILLI * start, MILLI * stop]} for name, start, stop in report.segments],
        "drawing": {
            **_picture(shown, mechanism, axis.mechanism or {}),
            "ends": used,
            "duration": MILLI * shown.duration,
        },
        "over_input": _over_input(mechanism, used),
        "over_speed": _over_speed(shown, cycles),
        "rows": _rows(laws),
        "trust": _trust(shown, names, earlier=earlier[place]),
    }


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
        trust = _GIVEN | {"word": "law of the previous value", "advice": "The optimum follows.", "facts": broken}
    if others:
        trust = trust or _GIVEN | {"facts": []}
        trust["facts"] += [f"{name}: law of the previous value, the optimum follows" for name in others]
    return trust


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


def _over_speed(shown: Cycle, cycles: Sequence[tuple[int, Cycle]]) -> dict[str, Any] | None:
    """Torque over speed at the motor, in rpm and N m, with the motor's curves; None without a motor."""
    if not isinstance(shown.drive, Drive):
        return None
    courses: list[dict[str, Any]] = []
    for law, cycle in cycles:
        speeds, torques = CycleReport(cycle).over_speed(_EACH)
        courses.append({"law": law, "speeds": drawn(RPM * speeds, 3), "torques": drawn(torques, 5)})
    fastest = max(cycle.sheet.peak_speed for _, cycle in cycles)
    greatest = {"torque": max(cycle.effort.peak_force for _, cycle in cycles), "speed": RPM * fastest}
    return {"courses": courses, "greatest": greatest, "motor": _motor(shown.drive.motor, fastest)}


def _motor(motor: Motor, fastest: float) -> dict[str, Any]:
    """The curves of peak and continuous torque beyond a speed, and the numbers that limit them."""
    speeds, limits = motor.limits_up_to(_FAR * fastest, 41)
    at = np.round(RPM * speeds, 3).tolist()
    return {
        "curves": {
            name.partition(" ")[0]: [list(point) for point in zip(at, values.tolist(), strict=True)]
            for name, values in limits.items()
        },
        "peak_torque": bounded(motor.peak_torque),
        "rated_torque": bounded(motor.rated_torque),
        "greatest_speed": bounded(RPM * motor.greatest_speed),
        "corners": [[round(RPM * speed, 6), torque] for speed, torque in motor.curve],
    }


def ratios(request: CycleRequest) -> dict[str, Any]:
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
    shown = _law(*_read(request))
    efforts = [] if isinstance(shown, OptlawsError) else CycleReport(shown).least_efforts()
    return {
        "moves": [
            {"name": name, "at": [MILLI * start, MILLI * stop], "peak": peak, "rms": rms}
            for (name, start, stop), peak, rms in efforts
        ]
    }


# --- the mechanism to scale ---


def _picture(cycle: Cycle, mechanism: Mechanism, entries: Mapping[str, Any]) -> dict[str, Any]:
    """The mechanism at equal steps of time over a cycle, in mm and deg: links, a cam, or a drum with a slide."""
    times = np.linspace(0.0, cycle.duration, _FRAMES)
    x = np.asarray(cycle(times))
    _, factor, _, _ = _INPUTS[mechanism.axis]
    shown: dict[str, Any] = {
        "name": mechanism.name,
        "input": drawn(factor * x, 4),
        "axis": mechanism.axis,
    }
    if mechanism.linkage.chains:
        return shown | {"kind": "links"} | _links(mechanism, x)
    if mechanism.name == "cam":
        return shown | {"kind": "cam", "dimensions": []} | drawing(CamAtShaft.from_dict(entries).cam)
    if mechanism.name in _ROUND:
        size = float(si_number(entries[_ROUND[mechanism.name]], ("length",), "size"))
        slide = drawn(MILLI * np.asarray(mechanism.driven_position("slide", x)), 4)
        return shown | {"kind": mechanism.name, "size": MILLI * size, "slide": slide}
    return shown | {"kind": "table"}


def _links(mechanism: Mechanism, x: Array) -> dict[str, Any]:
    """The joints of each chain at positions of the input, and their paths over the range of the mechanism."""
    over = np.linspace(*mechanism.over, _SAMPLES) if mechanism.has_end else np.linspace(x.min(), x.max(), _SAMPLES)
    chains = [[_placed(point, x) for point in chain] for chain in mechanism.linkage.chains]
    moving = {point: _placed(point, over) for chain in mechanism.linkage.chains for point in chain if _is_moving(point)}
    fixed = [len(chain) == 1 and not _is_moving(chain[0]) for chain in mechanism.linkage.chains]
    return {"chains": chains, "fixed": fixed, "paths": list(moving.values())}


def _is_moving(point: tuple[Formula, Formula]) -> bool:
    return bool(point[0].names() | point[1].names())


def _placed(point: tuple[Formula, Formula], x: Array) -> list[list[float | None]]:
    return [drawn(place, _DECIMALS) for place in placed(point, x).T]


def _over_input(mechanism: Mechanism, used: tuple[float, float]) -> dict[str, Any]:
    """Panels of inertia and load over the input, with the part of it that is used, in deg or mm."""
    unit, factor, inertia, load = _INPUTS[mechanism.axis]
    low, high = mechanism.over if mechanism.has_end else (end / factor for end in used)
    x = np.linspace(low, high, _SAMPLES)
    curves = (("inertia J", inertia, mechanism.inertia(x)), ("load T", load, mechanism.load(x)))
    at = drawn(factor * x, 4)
    return {
        "across": f"input of the {mechanism.name}, {unit}; lines: what the cycle uses",
        "range": [factor * low, factor * high],
        "panels": [
            {"name": name, "unit": size, "series": [{"at": at, "values": drawn(np.asarray(values), 9)}]}
            for name, size, values in curves
        ],
        "segments": [{"name": "", "at": list(used)}, {"name": "", "at": [used[1]] * 2}],
    }


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
    study = packaged_study("cycle_crank_press")
    curve = [["0 rpm", "24 N m"], ["2000 rpm", "24 N m"], ["3000 rpm", "15 N m"]]
    drive = {"motor": {"inertia": "1.5e-3 kg m^2", "rated_torque": "8 N m", "curve": curve}, "ratio": 10.0}
    axes = [{**axis, "drive": drive} for axis in study["axis"]]
    return study | {"title": "A slider-crank press by a motor and a gear", "axis": axes}


QUESTIONS: dict[str, Question] = {
    "machine": (CycleRequest, answer),
    "machine-limits": (CycleRequest, limits),
    "machine-ratios": (CycleRequest, ratios),
}
