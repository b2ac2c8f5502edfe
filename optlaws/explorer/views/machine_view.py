"""Machines as the page shows them: a mechanism and its motor, torque over the cycle, over speed and over the ratio."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, cast

import msgspec
import numpy as np

from optlaws import Cycle, Drive, Mechanism, Move, Plan, Status
from optlaws.cams.at_shaft import CamAtShaft
from optlaws.cycles.report import CycleReport, drive_rows
from optlaws.cycles.specification.programme import is_optimal
from optlaws.entries.declared import entries_of
from optlaws.errors import InputError, OptlawsError
from optlaws.explorer.views import cycle_view
from optlaws.explorer.views.cam_view import drawing
from optlaws.explorer.views.cycle_view import CycleRequest, packaged_study
from optlaws.explorer.views.law_view import refusal, refusing
from optlaws.explorer.views.panel_data import (
    beside_each_other,
    drawn,
    fact_sentences,
    over_time,
    panel_data,
    segments_data,
)
from optlaws.explorer.views.requests import MOST_LAWS, stored_law
from optlaws.jobs.cycle_entries import AxisEntries, CycleProblemFile, cycle_of
from optlaws.mechanisms.drives.effort import over_speed
from optlaws.mechanisms.linkages.mechanism import INPUTS, MechanismReport
from optlaws.mechanisms.linkages.mechanism_kinds import MechanismKind
from optlaws.motion.quantities import MILLI, RPM, quantity
from optlaws.numbers import Array, bounded
from optlaws.sentences import quantity_name
from optlaws.shown.summary import Row

_EACH = 240
_RATIOS = 7
_GIVEN = {"status": "given", "word": "given", "advice": "A law as it stands: nothing was optimised."}
#: a curve of a motor is drawn up to so many times the speed that is used
_FAR = 1.6
_FRAMES = 181
_COARSE = 3  # of the positions of a mechanism, so many go by from one of a path to the next
_DECIMALS = 3
_WEAK = "too weak"  # the note of a margin that a motor does not keep
#: what a mechanism in proportion is drawn from: the entry of its size
_ROUND = {"rack": "radius", "belt": "radius", "screw": "lead"}


@refusing()
def answer(request: CycleRequest) -> dict[str, Any]:
    """The machine with the laws of its file, or the reason why there is none."""
    spec, beside, place = _read(request)
    axis, given = beside[place], [[]] * len(beside) if request.laws is None else request.laws
    if len(given) != len(beside):
        raise InputError(f"laws: {len(beside)} axes have this machine, and laws of {len(given)} are given")
    laws = [_law(spec, other, moves) for other, moves in zip(beside, given, strict=True)]
    shown = laws[place]
    known = {
        "laws": [{"refused": refusal(law)} if isinstance(law, OptlawsError) else {} for law in laws],
        "active": place,
        "limiting": [] if axis.limits.get("motor") else sorted(cycle_view.LIMITING),
        "optima": None if request.laws is not None else _optima(beside, laws),
    }
    if isinstance(shown, OptlawsError):
        return known | {"refused": refusal(shown)}
    cycles = {i: law for i, law in enumerate(laws) if isinstance(law, Plan)}
    inputs = {i: CycleReport(law).of_input for i, law in cycles.items()}
    panels = beside_each_other(inputs[place], list(inputs.items()))
    of = f"; torque and power at the {'motor' if isinstance(shown.drive, Drive) else 'input'}"
    earlier = [other.name for other, moves in zip(beside, given, strict=True) if moves and other is not axis]
    return {
        **known,
        **over_time(list(map(panel_data, panels)), max(law.duration for law in cycles.values()), of),
        "segments": segments_data(CycleReport(shown).segments, panels[0]),
        **_pictures(shown, axis.mechanism or {}, inputs[place][-1].ends),
        "over_speed": _over_speed(shown, cycles),
        "rows": _rows(laws),
        "trust": _trust(shown, earlier, earlier=bool(given[place])),
    }


def _optima(beside: Sequence[AxisEntries], laws: Sequence[Plan | OptlawsError]) -> list[list[dict[str, Any]]] | None:
    """The laws of optimised moves, with which another machine can be evaluated; None where it cannot."""
    optima = []
    for axis, law in zip(beside, laws, strict=True):
        if isinstance(law, OptlawsError) or axis.load is not None or len(_moves_of(law)) != len(law.solutions):
            return None
        optima.append([solution.law.to_dict() for solution in law.solutions])
    return optima if any(optima) else None


def _moves_of(law: Cycle | Plan) -> list[int]:
    """The places of the moves whose law is optimised, if each has a law of its own."""
    return [i for i, segment in enumerate(law.segments) if isinstance(segment, Move) and is_optimal(segment)]


def _trust(shown: Plan, others: Sequence[str], *, earlier: bool) -> dict[str, Any] | None:
    """How far the law can be trusted; an earlier law is neither optimal nor proven, as those of `others`."""
    trust = cycle_view.trust(shown)
    if earlier:
        broken = [] if trust is None else [trust["advice"]]
        trust = _GIVEN | {"word": "law of the previous value", "advice": "The optimum follows.", "facts": broken}
    if others:
        trust = trust or _GIVEN | {"facts": []}
        trust["facts"] += [f"{name}: law of the previous value, the optimum follows" for name in others]
    remarks = fact_sentences(row for row in drive_rows(shown) if isinstance(row.value, str))
    if remarks:
        trust = trust or _GIVEN
        trust = trust | {"facts": [*trust.get("facts", []), *remarks]}
    return trust


def _read(request: CycleRequest) -> tuple[CycleProblemFile, list[AxisEntries], int]:
    """The study, the axes of the requested machine, which differ in their laws, and the place of the one on display."""
    spec, axis = cycle_view.read(request)
    if axis.mechanism is None:
        raise InputError(f"{axis.name} has no mechanism: choose a kind of mechanism, or see it in Motion")
    same = [other for other in spec.axis if (other.mechanism, other.drive) == (axis.mechanism, axis.drive)]
    first = [other for other in same if other is not axis][: MOST_LAWS - 1]
    beside = [other for other in same if other is axis or any(other is chosen for chosen in first)]
    return spec, beside, next(i for i, other in enumerate(beside) if other is axis)


def _law(spec: CycleProblemFile, axis: AxisEntries, given: Sequence[dict[str, Any]] = ()) -> Plan | OptlawsError:
    """The cycle of an axis, by optimal laws or by those that are given for its optimised moves."""
    try:
        cycle = _evaluated(spec, axis, given) if given else cycle_view.stored(spec, axis)
        _ = cycle.effort  # what cannot be driven is told here
    except OptlawsError as error:
        return error
    return cycle


def _evaluated(spec: CycleProblemFile, axis: AxisEntries, given: Sequence[dict[str, Any]]) -> Plan:
    cycle = cycle_of(axis, spec.speed, spec.period)
    segments, moves = list(cycle.segments), _moves_of(cycle)
    if len(given) != len(moves):
        raise InputError(f"laws: {axis.name} has {len(moves)} optimised moves, and {len(given)} laws are given")
    for i, law in zip(moves, given, strict=True):
        segments[i] = replace(cast("Move", segments[i]), law=stored_law(msgspec.json.encode(law)))
    return replace(cycle, segments=segments).unchecked()


def _rows(laws: Sequence[Plan | OptlawsError]) -> list[dict[str, Any]]:
    """The load of each law on the drive, in the words of the library's summary."""
    known: dict[str, list[Row | None]] = {}
    for i, law in enumerate(laws):
        rows = drive_rows(law) if isinstance(law, Plan) else ()
        for row in (row for row in rows if not isinstance(row.value, str)):  # remarks stand with the words of trust
            known.setdefault(row.name, [None] * len(laws))[i] = row
    return [
        {
            "name": name,
            "unit": next(row.unit for row in rows if row is not None),
            "values": [None if row is None else bounded(row.value) for row in rows],
            "note": next((row.note for row in rows if row is not None and row.note != _WEAK), ""),
            "over": [row is not None and row.note == _WEAK for row in rows],
        }
        for name, rows in known.items()
    ]


def _over_speed(shown: Plan, cycles: Mapping[int, Plan]) -> dict[str, Any] | None:
    """Torque over speed at the motor, in rpm and N m, with the motor's curves and limits; None without a motor."""
    if not isinstance(shown.drive, Drive):
        return None
    courses: list[dict[str, Any]] = []
    for law, cycle in cycles.items():
        speeds, torques = over_speed(cycle.along, _EACH)
        courses.append({"law": law, "speeds": drawn(RPM * speeds, 3), "torques": drawn(torques, 5)})
    motor, fastest = shown.drive.motor, max(cycle.sheet.peak_speed for cycle in cycles.values())
    speeds, limits = motor.limits_up_to(_FAR * fastest, 41)
    at = np.round(RPM * speeds, 3)
    return {
        "courses": courses,
        "greatest": {"torque": max(cycle.effort.peak_force for cycle in cycles.values()), "speed": RPM * fastest},
        "motor": {
            "curves": {name.partition(" ")[0]: np.stack([at, curve], 1).tolist() for name, curve in limits.items()},
            "peak_torque": bounded(motor.peak_torque),
            "rated_torque": bounded(motor.rated_torque),
            "greatest_speed": bounded(RPM * motor.greatest_speed),
            "corners": [[round(RPM * speed, 6), torque] for speed, torque in motor.curve],
        },
    }


#: objectives whose bound is drawn, and whose curve it is below
_BOUNDED = {"rms torque": "rms", "torque": "peak"}


def ratios(request: CycleRequest) -> dict[str, Any]:
    """Root mean square and peak of the torque at the motor over the ratio of the gear; None where there is no law."""
    spec, beside, place = _read(request)
    drive = beside[place].drive
    if not isinstance(drive, dict) or "motor" not in drive or not request.low < request.high:
        return {"ratios": [], "laws": [], "bound": [], "words": "no gear: give the machine a motor"}
    places = np.geomspace(request.low, request.high, _RATIOS).tolist()
    tried = [[_law(spec, replace(other, drive={**drive, "ratio": ratio})) for ratio in places] for other in beside]
    laws = [[law if isinstance(law, Plan) else None for law in course] for course in tried]
    cycles = [cycle for cycle in laws[place] if cycle is not None]
    searched = [cycle for cycle in cycles if cycle.solutions and cycle.minimise in _BOUNDED]
    words = "torque at the motor over the ratio of the gear, of laws as they are given"
    if searched:
        proven = all(cycle.status is Status.OPTIMAL for cycle in searched)
        bound = "proven" if proven else "no law that never turns back is below the dashed line"
        words = f"least {quantity_name(searched[0].minimise)} at each ratio: {bound}"
    return {
        "ratios": places,
        "laws": [{"rms": _of(course, "rms_force"), "peak": _of(course, "peak_force")} for course in laws],
        "fits": [None if cycle is None else cycle.sheet.fits for cycle in laws[place]],
        "bound": [
            bounded(cycle.lower_bound) if cycle is not None and cycle in searched and cycle.lower_bound else None
            for cycle in laws[place]
        ],
        "of": _BOUNDED.get(cycles[0].minimise) if cycles else None,
        "words": words,
    }


def _of(course: Sequence[Plan | None], attribute: str) -> list[float | None]:
    return [None if cycle is None else bounded(getattr(cycle.effort, attribute)) for cycle in course]


def limits(request: CycleRequest) -> dict[str, Any]:
    """The infimum of each move over laws that never turn back, beside this law's value; it takes longer."""
    spec, beside, place = _read(request)
    shown = _law(spec, beside[place])
    efforts = [] if isinstance(shown, OptlawsError) else CycleReport(shown).least_efforts()
    return {
        "moves": [
            {"name": name, "at": [MILLI * start, MILLI * stop], "peak": peak, "rms": rms}
            for (name, start, stop), peak, rms in efforts
        ]
    }


# --- the mechanism to scale ---


def _pictures(cycle: Plan, entries: Mapping[str, Any], used: tuple[float, float]) -> dict[str, Any]:
    """The mechanism at equal steps of time over a cycle, in mm and deg, and its inertia and load over the input."""
    mechanism = cycle.drive.mechanism if isinstance(cycle.drive, Drive) else cycle.drive
    assert isinstance(mechanism, Mechanism)  # noqa: S101 - as the axis has one
    unit, factor, _ = INPUTS[mechanism.axis]
    report = MechanismReport(mechanism, (used[0] / factor, used[1] / factor))
    x = np.asarray(cycle(np.linspace(0.0, cycle.duration, _FRAMES)))
    panels = [panel_data(panel) for panel in report.panels]
    return {
        "drawing": {
            "name": mechanism.name,
            "input": drawn(factor * x, 4),
            "axis": mechanism.axis,
            "ends": used,
            "duration": MILLI * cycle.duration,
            **_parts(report, x, entries),
        },
        "over_input": {
            "across": f"input of the {mechanism.name}",
            "unit": unit,
            "note": "; lines: what the cycle uses",
            "range": [panels[0]["series"][0]["at"][i] for i in (0, -1)],
            "panels": panels,
            "segments": [{"name": "", "at": list(used)}, {"name": "", "at": [used[1]] * 2}],
        },
    }


def _parts(report: MechanismReport, x: Array, entries: Mapping[str, Any]) -> dict[str, Any]:
    """Links with the paths of their joints, a cam, or a drum with a slide, at positions of the input."""
    mechanism = report.mechanism
    if mechanism.linkage.chains:
        courses = report.chains(report.positions[::_COARSE])
        return {
            "kind": "links",
            "chains": [list(map(_joint, chain)) for chain in report.chains(x)],
            "fixed": [moving == [False] for moving in report.moving],
            "paths": [_joint(joint) for course in courses for joint in course if np.ptp(joint, axis=1).any()],
        }
    if mechanism.name == "cam":
        return {"kind": "cam", "dimensions": [], **drawing(CamAtShaft.from_dict(entries).cam)}
    if _ROUND.get(mechanism.name) in entries:  # a stored mechanism has its formulas alone
        size = float(quantity(entries[_ROUND[mechanism.name]], "length", "size", bare=True))
        slide = drawn(MILLI * np.asarray(mechanism.driven_position("slide", x)), 4)
        return {"kind": mechanism.name, "size": MILLI * size, "slide": slide}
    return {"kind": "table"}


def _joint(places: Array) -> list[list[float | None]]:
    return [drawn(place, _DECIMALS) for place in places.T]


#: how the input of a new mechanism moves: a turn and a rest, or for ever
_A_TURN = [{"kind": "rise", "by": "360 deg", "duration": "0.5 s"}, {"kind": "dwell"}]
_STEADILY = [{"kind": "constant velocity", "velocity": "720 deg/s"}]


def kinds() -> dict[str, dict[str, Any]]:
    """Kinds of mechanisms: the entries of an example and its motion, and the fields of its form."""
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
