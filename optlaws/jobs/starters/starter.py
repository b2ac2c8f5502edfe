"""Starter problem files: their questions, whose answers are checked as entries are, and their text with the answers."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from shlex import quote
from textwrap import fill
from typing import Any

from optlaws.entries.reference import sentences
from optlaws.entries.value_types import Measured, Number, Whole
from optlaws.errors import InputError, located
from optlaws.files.reading import check_names
from optlaws.jobs.starters.starter_numbers import DERIVATIVES, TYPES, numbers_of
from optlaws.laws.catalogue.catalogue import USUAL, catalogue
from optlaws.lazy import imported
from optlaws.motion.quantities import DIMENSIONS, Exact, either, in_small_units, quantity
from optlaws.numbers import rounded_up

#: answers by the names of questions; None where an entry is left out
Answers = dict[str, str | None]

#: a place in a text: the name of its answer and, behind a bar, what stands there where the entry is left out
_PLACE = re.compile(r"\$\{([\w-]+)(?:\|([^}]*))?\}")
_FOLDER = Path(__file__).parent
_DIGITS = 5
_SPARE = 0.25  # of the greatest inertia force: so much a spring presses more than it must
_STIFFER = 1.2  # times the least stiffness: with it the contact force is greatest above, where the follower rests
_PRIME = 10.0  # strokes: a prime circle on which every motion has a cam
#: velocity, acceleration and jerk of an axis that slides, and of one that turns
_LIMITS = ("1.5 m/s", "12 m/s^2", "600 m/s^3"), ("10 rad/s", "100 rad/s^2", "5000 rad/s^3")


def _read(text: str, name: str) -> str:
    """The answer to the question of a name as it was typed, checked as the entry that it is for.

    >>> _read(" 35 mm", "stroke"), _read("3", "order")
    ('35 mm', '3')
    """
    type_, answer = TYPES[name], text.strip()
    value: str | float = answer
    if isinstance(type_, Number | Whole):
        try:
            value = int(answer) if isinstance(type_, Whole) else float(answer)
        except ValueError:
            raise InputError(f"--{name} must be {type_.words}, got {answer!r}") from None
    type_.read(value, f"--{name}")
    return answer


@dataclass(frozen=True)
class Starter:
    """A kind of problem file to begin with, whose text is in the file of its name."""

    kind: str
    command: str  #: of `optlaws`, which runs the file
    derived: Callable[[Answers], Answers]  #: further answers that follow from those given
    check: Callable[[Any, Mapping[str, Any], Path], object]  #: refuses entries, to be read as `value`, of no use
    value: str  #: what the file is read as, behind "optlaws.": a # alone stands for what the entry below it says
    tables: Mapping[str, str] = field(default_factory=dict)  #: what its tables are read as, by their headings

    def run(self, file: Path) -> str:
        """The command behind `optlaws` that runs a file."""
        return f"{self.command} {quote(file.as_posix())}"

    def text(self, given: Mapping[str, str], file: Path) -> str:
        """The text of the file: each place with its answer; the line of an entry that is left out as a comment."""
        usual = numbers_of(self.kind)
        with located(self.kind):
            check_names([f"--{name}" for name in given], [f"--{name}" for name in usual], "option")
        typed: Answers = {name: _read(text, name) for name, text in given.items()}
        answers = usual | typed
        answers |= self.derived(answers) | {"run": self.run(file)}
        about = sentences(_of_name(self.value))
        lines = (_FOLDER / f"{self.kind}.toml").read_text("utf-8").splitlines()
        for i, line in enumerate(lines):
            if line.startswith("["):
                about = sentences(_of_name(self.tables.get(line.strip("[]"), self.value)))
            if line == "#":
                name = lines[i + 1].lstrip("# ").partition(" ")[0]
                lines[i] = fill(about[name], 120, initial_indent="# ", subsequent_indent="# ")
        text = "\n".join(_filled(line, answers) for line in lines) + "\n"
        with located(str(file)):
            self.check(_of_name(self.value), tomllib.loads(text), file)
        return text


def _of_name(name: str) -> Any:
    """What a kind needs of optlaws, imported where that kind is begun."""
    module, _, name = name.rpartition(".")
    return getattr(imported(f"optlaws.{module}"), name)


def _filled(line: str, answers: Answers) -> str:
    """A line of a text with its answers; as a comment, with examples, where one is left out."""
    left_out = any(answers[place[1]] is None for place in _PLACE.finditer(line))
    filled = _PLACE.sub(lambda place: answers[place[1]] or place[2] or _example(place[1], answers), line)
    return f"# {filled}" if left_out and not line.startswith("#") else filled


def _example(name: str, answers: Answers) -> str:
    """An example of a quantity that is left out, of the dimension of the stroke."""
    dimensions, (axis, _) = _dimensions(name), _si(answers, "stroke")
    return DIMENSIONS[dimensions[axis == "angle" and len(dimensions) > 1]][1]


def _usual(constant: str) -> float:
    return float(getattr(catalogue[USUAL].law.constants, constant).value)


def _at_least(value: float) -> str:
    """A number in a few digits, not below its value."""
    return f"{rounded_up(value, _DIGITS):.12g}"


def _dimensions(name: str) -> tuple[str, ...]:
    type_ = TYPES[name]
    return type_.dimensions if isinstance(type_, Measured) else ()


def _si(answers: Answers, name: str) -> tuple[str, float]:
    """The dimension of an answer, and its number in SI units."""
    return either(answers[name], _dimensions(name), f"--{name}")


def _of_cycle(answers: Answers) -> Answers:
    """Modified sine's jerk in the shorter motion, and the names of the quantities of an angle or a length."""
    axis, _ = _si(answers, "stroke")
    usual, turns = _usual_of_cycle(answers)["jerk"], axis == "angle"
    if answers["mass"] is not None:
        quantity(answers["mass"], "moment of inertia" if turns else "mass", "--mass")
    names = {"axis": "table", "inertia": "inertia"} if turns else {"axis": "slide", "inertia": "mass"}
    return {"modified_sine_jerk": usual, "jerk": answers["jerk"] or usual, **names}


def _usual_of_cycle(answers: Answers) -> dict[str, str]:
    """The peaks of modified sine in the shorter of two motions."""
    speed, motions = _si(answers, "speed")[1], [_si(answers, name) for name in ("rise", "return")]
    shorter = min(value / speed if kind == "angle" else value for kind, value in motions)
    return _peaks_of_usual(_si(answers, "stroke"), shorter)


def _peaks_of_usual(far: tuple[str, float], duration: float) -> dict[str, str]:
    """The peaks of modified sine in a motion so far in a duration, rounded up."""
    unit = "rad" if far[0] == "angle" else "m"
    return {
        name: f"{_at_least(_usual(constant) * far[1] / duration**nu)} {unit}/s{f'^{nu}' if nu > 1 else ''}"
        for nu, (name, constant) in enumerate(zip(DERIVATIVES, "BCJ", strict=True), 1)
    }


def _of_cam(answers: Answers) -> Answers:
    """The peaks of modified sine as limits; with a mass its spring, and the power is least, the torque at the shaft."""
    quantity(answers["stroke"], "length", "--stroke")
    usual, massive = _usual_of_cycle(answers), answers["mass"] is not None
    limits: Answers = {name: answers[name] or usual[name] for name in DERIVATIVES}
    if not massive:  # it is what is least
        limits["acceleration"] = answers["acceleration"] or None
    known = _of_cycle(answers) | limits | {"minimise": "power" if massive else "acceleration"}
    return known | (_spring_of_usual(answers) if massive else dict.fromkeys(("stiffness", "preload", "force", "width")))


def _of_barrel(answers: Answers) -> Answers:
    """The jerk of modified sine as a limit unless one is given."""
    quantity(answers["stroke"], "length", "--stroke")
    return {"jerk": answers["jerk"] or _usual_of_cycle(answers)["jerk"]}


def _spring_of_usual(answers: Answers) -> Answers:
    """A spring with which modified sine stays on the cam, stiffer than the least, with some force to spare."""
    from optlaws.cams.disc import DiscCam
    from optlaws.cams.followers.rollers import TranslatingRoller
    from optlaws.cams.springs_and_flywheels import least_spring
    from optlaws.cycles.cycle import Cycle
    from optlaws.cycles.specification.segments import Dwell, Return, Rise

    rise, dwell, back = (str(answers[name]) for name in ("rise", "dwell", "return"))
    moves = [Rise(str(answers["stroke"]), rise, law=USUAL), Dwell(dwell), Return(duration=back, law=USUAL), Dwell()]
    cycle, drive = Cycle(moves, speed=answers["speed"]), {"mass": answers["mass"]}
    spare = _at_least(_SPARE * cycle.peak(2) * quantity(answers["mass"], "mass", "--mass"))
    follower = TranslatingRoller(str(answers["roller"]))
    cam = DiscCam(cycle, Exact(_PRIME * cycle.peak(0), "m"), follower)  # no radius changes the force along the way
    speeds = ("0 rpm", str(answers["speed"]))
    spring = least_spring(cam, drive=drive, speeds=speeds, force=f"{spare} N")
    stiffness, preload = f"{_at_least(_STIFFER * spring.stiffness)} N/m", f"{_at_least(spring.preload)} N"
    return {"stiffness": stiffness, "preload": preload, "force": f"{spare} N", "width": "20 mm"}


def _of_drive(answers: Answers) -> Answers:
    """Modified sine's acceleration and jerk as limits unless a jerk is given."""
    stroke = quantity(answers["stroke"], "angle", "--stroke")
    usual = _peaks_of_usual(("angle", stroke), _si(answers, "duration")[1])
    limits = {"acceleration": usual["acceleration"], "jerk": answers["jerk"] or usual["jerk"]}
    return {**limits, "modified_sine_jerk": usual["jerk"]}


def _of_mechanism(answers: Answers) -> Answers:
    """Modified sine's jerk in a turn."""
    quantity(answers["mass"], "mass", "--mass")
    return _of_drive(answers | {"stroke": "360 deg"})


def _of_fastest(answers: Answers) -> Answers:
    """Limits of an axis that slides, or of one that turns, where none are given."""
    turns = _si(answers, "stroke")[0] == "angle"
    limits = {name: answers[name] or most for name, most in zip(DERIVATIVES, _LIMITS[turns], strict=True)}
    for name, most in limits.items():
        quantity(most, f"angular {name}" if turns else name, f"--{name}")
    return {**limits, "axis": "arm" if turns else "gripper"}


def _of_interlock(answers: Answers) -> Answers:
    """The position at which the table is as good as in its next place."""
    (axis, index), (slide, stroke) = _si(answers, "index"), _si(answers, "stroke")
    for name, of, dimension, most in (("clear", "stroke", slide, stroke), ("within", "index", axis, index)):
        if not quantity(answers[name], dimension, f"--{name}") < most:
            raise InputError(f"--{name} must be below --{of}, {answers[of]}, got {answers[name]}")
    return {"in_place": in_small_units(index - _si(answers, "within")[1], axis)}


def _of_law(answers: Answers) -> Answers:
    """Bounds without dimension, and factors that convert numbers to quantities."""
    (axis, stroke), (_, duration) = _si(answers, "stroke"), _si(answers, "duration")
    unit, turning = ("rad", "angular ") if axis == "angle" else ("m", "")
    bounds: Answers = {"B": None, "C": None, "J": _at_least(_usual("J"))}
    scales: Answers = {}
    for nu, (name, constant) in enumerate(zip(DERIVATIVES, bounds, strict=True), 1):
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
    axis, _ = _si(answers, "stroke")
    quantity(answers["sway"], axis, "--sway")
    numbers = {name: _si(answers, name)[1] for name in ("stroke", "duration", "frequency", "sway")}
    units: Answers = {"si_unit": "rad" if axis == "angle" else "m"}
    return units | {f"{name}_number": f"{value:.12g}" for name, value in numbers.items()}


def _of_study(answers: Answers) -> Answers:
    if not float(answers["from"] or 0.0) < float(answers["to"] or 0.0):
        raise InputError(
            f"--from and --to are peak velocities above 1, the lesser first, got {answers['from']} and {answers['to']}"
        )
    return {"modified_sine_J": f"{_usual('J'):.5g}", "J": None}


def _read_axes(_: Any, entries: Mapping[str, Any], file: Path) -> object:
    return _of_name("jobs.cycle_entries.read_given")(entries, file)


def _read_problem(of: Any, entries: Mapping[str, Any], file: Path) -> object:
    return _of_name("studies.problem_entries.problem")("problem", of.read(entries, file).problem)


def _read_alone(of: Any, entries: Mapping[str, Any], file: Path) -> object:
    return of.read(entries, file)


_CYCLE, _LINKAGES = "jobs.cycle_entries.CycleProblemFile", "mechanisms.linkages"
_DRIVEN = {
    "axis.mechanism": f"{_LINKAGES}.mechanism.Mechanism",
    "axis.drive": "mechanisms.drives.drive_train.Drive",
    "axis.drive.motor": "mechanisms.drives.motor.Motor",
}
_SLIDES = {
    "axis.mechanism": f"{_LINKAGES}.plane_linkages.SliderCrank",
    "axis.mechanism.loads": f"{_LINKAGES}.mechanism_kinds.Loads",
}
_KINDS = [
    Starter("cycle", "cycle", _of_cycle, _read_axes, _CYCLE),
    Starter(
        "cam", "run", _of_cam, lambda of, entries, file: of.read(entries, file).cycle, "jobs.cam_entries.CamProblemFile"
    ),
    Starter(
        "barrel", "run", _of_barrel, lambda of, entries, file: of.read(entries, file).cycle,
        "jobs.cam_entries.BarrelProblemFile", {"barrel": "cams.barrel.Groove"},
    ),
    Starter("drive", "cycle", _of_drive, _read_axes, _CYCLE, _DRIVEN),
    Starter("mechanism", "cycle", _of_mechanism, _read_axes, _CYCLE, _SLIDES),
    Starter("fastest", "run", _of_fastest, _read_alone, "jobs.fastest.FastestProblemFile"),
    Starter("interlock", "cycle", _of_interlock, _read_axes, _CYCLE, {"interlocks": "cycles.axes.interlock.After"}),
    Starter(
        "machine", "run", _of_machine,
        lambda of, entries, file: of.read(entries, file).machine.machine(), "jobs.machine_laws.MachineLawsProblemFile",
    ),
    Starter("law", "run", _of_law, _read_problem, "jobs.solutions.SolutionsProblemFile"),
    Starter(
        "study", "study", _of_study, lambda _, entries, __: _of_name("studies.specification.read_study")(entries),
        "studies.specification.StudyFile",
    ),
]  # fmt: skip
STARTERS: dict[str, Starter] = {starter.kind: starter for starter in _KINDS}
