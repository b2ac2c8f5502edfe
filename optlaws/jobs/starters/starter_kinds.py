"""The kinds of problem files to begin with: the questions of each, and the entries that follow from the answers."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil, floor, log10
from pathlib import Path
from typing import Any

from optlaws.errors import InputError
from optlaws.files.problem_file import convert
from optlaws.jobs.cam_entries import CamProblemFile
from optlaws.jobs.cycle_entries import read_given
from optlaws.jobs.machine_laws import MachineLawsProblemFile
from optlaws.jobs.solutions import SolutionsProblemFile
from optlaws.jobs.starters.starter import Answers, Question, Starter
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.motion.quantities import either, positive_quantity, quantity
from optlaws.studies.problem_entries import problem
from optlaws.studies.specification import read_study

_USUAL = "modified sine"
_LENGTH, _TIME, _ANGLE = ("length",), ("time",), ("angle",)
_EITHER = ("length", "angle")
_DIGITS = 5

_LIMITS = (
    Question("velocity", None, ("velocity", "angular velocity")),
    Question("acceleration", None, ("acceleration", "angular acceleration")),
    Question("jerk", None, ("jerk", "angular jerk")),
)
_CYCLE = (
    Question("rise", "120 deg", ("angle", "time")),
    Question("dwell", "90 deg", ("angle", "time")),
    Question("return", "100 deg", ("angle", "time")),
    Question("speed", "200 rpm", ("angular velocity",)),
)
_OBJECTIVE = Question("minimise", "C", choices=("C", "D", "J", "rms_c", "rms_j"))


def _usual(constant: str) -> float:
    return float(getattr(catalogue[_USUAL].law.constants, constant).value)


def _at_least(value: float) -> str:
    """A number in a few digits, not below its value."""
    unit = 10.0 ** (floor(log10(value)) + 1 - _DIGITS)
    return f"{ceil(value / unit) * unit:.12g}"


def _si(answers: Answers, name: str, *dimensions: str) -> tuple[str, float]:
    return either(answers[name], dimensions, f"--{name}")


def _of_cycle(answers: Answers) -> Answers:
    """Modified sine's jerk in the shorter motion, and the names of the quantities of an angle or a length."""
    axis, stroke = _si(answers, "stroke", *_EITHER)
    speed = positive_quantity(answers["speed"], "angular velocity", "--speed")
    durations = []
    for name in ("rise", "return"):
        kind, value = _si(answers, name, *_ANGLE, *_TIME)
        durations.append(value / speed if kind == "angle" else value)
    usual = f"{_at_least(_usual('J') * stroke / min(durations) ** 3)} {'rad' if axis == 'angle' else 'm'}/s^3"
    more: Answers = {"modified_sine_jerk": usual, "jerk": answers["jerk"] or usual}
    return more | {"axis": "table" if axis == "angle" else "slide", "inertia": _inertia(answers.get("mass"), axis)}


def _inertia(mass: str | None, axis: str) -> str:
    needed = "inertia" if axis == "angle" else "mass"
    if mass is not None:
        quantity(mass, "moment of inertia" if axis == "angle" else "mass", "--mass")
    return needed


def _of_law(answers: Answers) -> Answers:
    """Bounds without dimension, and factors that convert numbers to quantities."""
    axis, stroke = _si(answers, "stroke", *_EITHER)
    duration = positive_quantity(answers["duration"], "time", "--duration")
    unit, turning = ("rad", "angular ") if axis == "angle" else ("m", "")
    bounds: Answers = {"B": None, "C": None, "J": _at_least(_usual("J"))}
    scales: Answers = {}
    for nu, (name, constant) in enumerate({"velocity": "B", "acceleration": "C", "jerk": "J"}.items(), 1):
        scale = stroke / duration**nu
        scales[f"{name}_scale"] = f"{scale:.6g} {unit}/s{'²³'[nu - 2] if nu > 1 else ''}"
        if answers[name] is not None:
            bounds[constant] = f"{quantity(answers[name], turning + name, f'--{name}') / scale:.10g}"
    if bounds["B"] is not None and float(bounds["B"]) <= 1.0:
        raise InputError(
            f"--velocity must be above the mean velocity, {scales['velocity_scale']}, got {answers['velocity']}"
        )
    return bounds | scales | {"modified_sine_J": f"{_usual('J'):.5g}"}


def _of_machine(answers: Answers) -> Answers:
    """The numbers in SI units, without them."""
    axis, stroke = _si(answers, "stroke", *_EITHER)
    numbers = {
        "stroke_number": stroke,
        "duration_number": positive_quantity(answers["duration"], "time", "--duration"),
        "frequency_number": positive_quantity(answers["frequency"], "frequency", "--frequency"),
        "sway_number": positive_quantity(answers["sway"], axis, "--sway"),
    }
    units: Answers = {"si_unit": "rad" if axis == "angle" else "m"}
    return units | {name: f"{value:.12g}" for name, value in numbers.items()}


def _of_study(answers: Answers) -> Answers:
    if not 1.0 < float(answers["from"] or 0.0) < float(answers["to"] or 0.0):
        raise InputError(
            f"--from and --to are peak velocities above 1, the lesser first, got {answers['from']} and {answers['to']}"
        )
    return {"modified_sine_J": f"{_usual('J'):.5g}", "J": None}


def _check_cam(entries: Mapping[str, Any], file: Path) -> None:
    CamProblemFile.read(entries, file).cycle  # noqa: B018 - a motion that is none is refused


def _check_machine(entries: Mapping[str, Any], file: Path) -> None:
    MachineLawsProblemFile.read(entries, file).machine.machine()


def _check_law(entries: Mapping[str, Any], file: Path) -> None:
    problem("problem", convert(entries, SolutionsProblemFile, file).problem.given())


def _check_study(entries: Mapping[str, Any], _: Path) -> None:
    read_study(entries)


STARTERS: dict[str, Starter] = {
    "cycle": Starter(
        "cycle",
        "cycle {file} --out {folder}",
        (
            Question("stroke", "35 mm", _EITHER),
            *_CYCLE,
            *_LIMITS,
            Question("mass", None, ("mass", "moment of inertia")),
        ),
        _of_cycle,
        read_given,
    ),
    "cam": Starter(
        "cam",
        "run {file} --out {folder}",
        (
            Question("stroke", "35 mm", _LENGTH),
            *_CYCLE,
            Question("roller", "12 mm", _LENGTH),
            Question("offset", None, _LENGTH),
            Question("pressure-angle", "30 deg", _ANGLE),
            Question("curvature", "5 mm", _LENGTH),
            Question("prime-radius", None, _LENGTH),
            *_LIMITS,
            Question("mass", None, ("mass",)),
        ),
        _of_cycle,
        _check_cam,
        CamProblemFile,
    ),
    "machine": Starter(
        "machine",
        "run {file} --out {folder}",
        (
            Question("stroke", "300 mm", _EITHER),
            Question("duration", "0.4 s", _TIME),
            Question("frequency", "8.5 Hz", ("frequency",)),
            Question("damping", "0.02"),
            Question("spread", "0.1"),
            Question("sway", "1 mm", _EITHER),
        ),
        _of_machine,
        _check_machine,
    ),
    "law": Starter(
        "law",
        "run {file} --out {folder}",
        (
            Question("stroke", "35 mm", _EITHER),
            Question("duration", "0.1 s", _TIME),
            _OBJECTIVE,
            Question("order", "3", whole=True),
            *_LIMITS,
        ),
        _of_law,
        _check_law,
    ),
    "study": Starter(
        "study",
        "study {file} --out {folder}",
        (
            _OBJECTIVE,
            Question("from", "1.5"),
            Question("to", "2"),
            Question("steps", "11", whole=True),
            Question("degree", "9", whole=True),
        ),
        _of_study,
        _check_study,
    ),
}
