"""Cycles as the page shows them: motion in machine units, what lies beyond limits, segments, and words of trust."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, replace
from functools import lru_cache
from math import inf
from pathlib import Path
from typing import Annotated, Any, TypeAlias

import msgspec

from optlaws import Cycle, Plan
from optlaws.cycles.axes.interlock import Interlock
from optlaws.cycles.optimisation.objectives import OBJECTIVES
from optlaws.cycles.placed import broken_limits
from optlaws.cycles.report import CycleReport, drive_rows, joint_rows, objective_unit, proof_rows
from optlaws.cycles.specification.drive import CONSTANTS
from optlaws.cycles.specification.limits import LIMITS, LIMITS_OF_CYCLE
from optlaws.cycles.specification.segments import CycleSegment
from optlaws.entries.declared import entries_of
from optlaws.errors import InfeasibleProblem, SolverFailure, located
from optlaws.explorer.views.law_view import digits, refusing, verdict
from optlaws.explorer.views.opened_results import OPENED
from optlaws.explorer.views.panel_data import fact_sentences, panel_data, table_data
from optlaws.explorer.views.requests import MOST_LAWS, check_size, without_files
from optlaws.files import reading
from optlaws.files.packaged import packaged
from optlaws.jobs.cycle_entries import AxisEntries, CycleProblemFile, cycle_of
from optlaws.mechanisms.drives.motor import OF_TORQUE, Motor
from optlaws.motion.quantities import MILLI, TURN_DEG, UNITS
from optlaws.numbers import NumberOrQuantity
from optlaws.sentences import Amount, joined, sentence
from optlaws.synthesis.status import gap_text
from optlaws.tolerances import AGREEMENT, BOUND_SLACK

_MOTION = ("velocity", "acceleration", "deceleration", "jerk", "snap")
_LIMITS = {"motion": _MOTION, "machine": (*_MOTION, "torque", "rms torque", "power", "energy", "motor")}
_WHERE = Path("the machine")
MOST_POINTS = 6
Ratio: TypeAlias = Annotated[float, msgspec.Meta(gt=0.0, le=1e6)]
Laws: TypeAlias = Annotated[list[dict[str, Any]], msgspec.Meta(max_length=100)]
#: entries of a motor that change no torque
LIMITING = {entry.name for entry in fields(Motor)} - {*OF_TORQUE, "name"}


class CycleRequest(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A machine document, as its problem file, the axis or move on display, and what a view computes of it.

    Of least times the time; of machines, for each law, the laws of optimised moves that are evaluated without any
    optimisation, and the ratios of the gear between which torque is drawn; of advice the objective, the elastic
    follower and the points of the front.
    """

    study: dict[str, Any]
    axis: Annotated[int, msgspec.Meta(ge=0, le=99)] = 0
    time: Annotated[float, msgspec.Meta(gt=0.0, le=1e5)] | None = None
    laws: Annotated[list[Laws], msgspec.Meta(max_length=MOST_LAWS)] | None = None
    low: Ratio = 1.0
    high: Ratio = 1.0
    minimise: Annotated[str, msgspec.Meta(max_length=40)] | None = None
    follower: dict[str, Any] | None = None
    points: Annotated[int, msgspec.Meta(ge=0, le=MOST_POINTS)] = MOST_POINTS


@refusing()
def answer(request: CycleRequest) -> dict[str, Any]:
    """The view of an axis, or the reason why there is none."""
    shown = cycle(request)
    report = CycleReport(shown)
    return {
        "across": "master",
        "unit": "deg",
        "note": f" ({digits(MILLI * shown.duration)} ms a turn)",
        "turn": MILLI * shown.duration,
        "symbol": "master",
        "panels": [panel_data(replace(report.panel(nu), per=TURN_DEG / shown.duration)) for nu in report.orders],
        "segments": list(_segments(report)),
        "table": table_data(report.tables[0]),
        "beside": None if report.beside is None else table_data(report.beside.table),
        "trust": trust(shown),
        "facts": fact_sentences([*drive_rows(shown), *joint_rows(shown), *report.worse]),
    }


def nearest(request: CycleRequest) -> dict[str, Any]:
    """The least relaxation of each single limit, the others unchanged, after which a motion exists again."""
    spec, axis = read(request)
    ways = []
    for name, given in axis.limits.items():
        if name not in LIMITS or name not in OBJECTIVES or not isinstance(given, str):
            continue
        others = {other: value for other, value in axis.limits.items() if other != name}
        freed = replace(axis, limits=others, minimise=name, follower=None)
        try:
            cycle = stored(spec, freed)
            least = cycle.objective
        except (InfeasibleProblem, SolverFailure):
            continue
        order = LIMITS[name].order
        # in the unit of its limit, of which so many make one of SI
        unit, factor = UNITS[cycle.axis][order] if order else (objective_unit(cycle), 1.0)
        raised = Amount(least * factor * (1.0 + BOUND_SLACK), unit)
        text = sentence("raise the limit of {} from {} to {}", name, given, raised)
        ways.append({"entry": name, "value": str(raised), "text": text})
    return {"ways": ways}


def machine(study: dict[str, Any]) -> CycleProblemFile:
    """The machine of a study."""
    without_files(study)
    spec = CycleProblemFile.read(study, _WHERE)
    for axis in spec.axis:
        check_size(axis.order, axis.degree)
    return spec


def read(request: CycleRequest) -> tuple[CycleProblemFile, AxisEntries]:
    """The requested machine, and the axis on display."""
    spec = machine(request.study)
    return spec, spec.axis[min(request.axis, len(spec.axis) - 1)]


def cycle(request: CycleRequest) -> Plan:
    """The cycle of the axis that is shown."""
    return stored(*read(request))


def stored(spec: CycleProblemFile, axis: AxisEntries) -> Plan:
    """The cycle of an axis, which is computed once."""
    return _solved(axis, spec.speed, spec.period)


@lru_cache(maxsize=128)
def _solved(axis: AxisEntries, speed: NumberOrQuantity | None, period: NumberOrQuantity | None) -> Plan:
    motor, drive = (axis.drive or {}).get("motor"), axis.drive or {}
    if OPENED.text and (known := OPENED.plan_of(cycle_of(axis, speed, period))) is not None:
        return known
    if isinstance(motor, Mapping) and LIMITING & motor.keys() and not axis.limits.get("motor"):
        # the laws stay while a limit of the motor is dragged
        free = {name: entry for name, entry in motor.items() if name not in LIMITING}
        same = replace(axis, drive={**drive, "motor": free})
        with located("drive"), located("motor"):
            limited = Motor.from_dict(motor)
        return _solved(same, speed, period).with_motor(limited)
    return cycle_of(axis, speed, period).unchecked()


def _segments(report: CycleReport) -> Iterator[dict[str, Any]]:
    """The names and the ends of segments in degrees, and which of their derivatives are beyond a limit."""
    extremes = [report.extremes(nu) for nu in report.orders]
    scale = TURN_DEG / report.plan.duration
    for i, (segment, limits) in enumerate(zip(report.segments, report.plan.limits_of_segments, strict=True)):
        beyond = [_beyond(extremes[nu][i], limits.get(nu, (-inf, inf))) for nu in report.orders[1:]]
        ends = [round(scale * segment.start, 4), round(scale * segment.stop, 4)]
        yield {"name": segment.name, "at": ends, "peaks": [{"beyond": each} for each in beyond]}


def _beyond(extremes: tuple[tuple[float, float], tuple[float, float]], limits: tuple[float, float]) -> bool:
    (least, _), (most, _) = extremes
    rounding = AGREEMENT * max(abs(least), abs(most))
    return least < limits[0] - rounding or most > limits[1] + rounding


def trust(shown: Plan) -> dict[str, Any] | None:
    """The status of the laws and what is proven of them, and which limits they do not keep; None of laws as given."""
    beyond, broken = broken_limits(shown), dict[str, str]()
    if beyond:
        advice = sentence("Limits exceeded: {}.", joined("; ", beyond))
        broken = {"status": "refused", "word": "beyond a limit", "advice": advice}
    if not shown.solutions:
        return {"facts": []} | broken if broken else None
    facts = fact_sentences(row for row in proof_rows(shown) if row.name != "status")
    gap = "" if shown.lower_bound is None else gap_text(1.0 - shown.lower_bound / shown.objective)
    optimal = f"The lower bound meets the objective: no law is better among {shown.search_space}."
    return verdict(shown.status, gap, facts, optimal) | broken


#: segments of what is shown at first, as a cycle and as a cam
SEGMENTS = [
    {"kind": "rise", "by": "35 mm", "duration": "120 deg"},
    {"kind": "dwell", "duration": "90 deg"},
    {"kind": "return", "by": "35 mm", "duration": "100 deg"},
    {"kind": "dwell"},
]


def form() -> dict[str, Any]:
    """What the form of a cycle shows: objectives, limits of motions and of machines that turn, drives, segments."""
    kinds = CycleSegment.form()["kinds"]
    return {
        "objectives": entries_of(Cycle)["minimise"].form["choices"],
        "limits": {kind: [LIMITS_OF_CYCLE.entries[name].form for name in names] for kind, names in _LIMITS.items()},
        "drive": {axis: table.form()["entries"] for axis, table in CONSTANTS.items()},
        "interlocks": Interlock.form()["kinds"],
        "segments": {kind: [each for each in shown if "entries" not in each] for kind, shown in kinds.items()},
    }


def packaged_study(name: str, *without: str) -> dict[str, Any]:
    """A problem file that comes with optlaws as a study of the page, without its text and some entries."""
    entries = reading.toml(packaged(f"problems/{name}.toml"))
    return {entry: value for entry, value in entries.items() if entry not in {"text", *without}}


def example() -> dict[str, Any]:
    """The cycle that the page shows where none was given."""
    return {
        "job": "cycle",
        "title": "Rise, dwell, return, dwell",
        "speed": "200 rpm",
        "axis": [
            {"name": "slide", "minimise": "acceleration", "limits": {"velocity": "616 mm/s"}, "segment": SEGMENTS}
        ],
    }
