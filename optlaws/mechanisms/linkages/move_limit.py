"""Lower bounds for motions of a mechanism over one stroke, in SI units, with certificates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import fsum, inf, nextafter
from typing import Any, TypeAlias, get_args

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, TableOf, ValueOf, declared, entry
from optlaws.entries.value_types import (
    Choice,
    Either,
    InSI,
    Kept,
    Listed,
    Number,
    ReadBy,
    Table,
    Together,
    is_list,
    pairs,
)
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure
from optlaws.files.reading import entries_of
from optlaws.formulas.reading import read
from optlaws.formulas.slopes import scaled
from optlaws.kept import kept_property
from optlaws.mechanisms.linkages.mechanism_formulas import DIMENSIONS, MOVED, InputAxis, StrokeTorque, duration_of
from optlaws.numbers import NumberOrQuantity, positive
from optlaws.sentences import quantity_name
from optlaws.synthesis.limits.drive_limits import (
    LONG,
    DriveLimit,
    limit_of_plane,
    phase_torque,
    planes_of_proof,
    unreachable,
)
from optlaws.synthesis.limits.phase_plane import ACCELERATION, AnyTorque, PhasePlane, TorqueLimit, VelocityLimit
from optlaws.synthesis.limits.plane_of_problem import DriveObjective
from optlaws.tolerances import CLOSURE, STATED_BOUND

_ENTRIES = ("dimension", "unit", "move", "drive_limit")
_DIGITS = 6


def _driven(value: Any) -> Any:
    if not isinstance(value, tuple(MOVED.values())):
        raise InputError(f"it must be a mechanism or a drive, got {shortened(value)}")
    return value


MoveTable: TypeAlias = Kept["tuple[tuple[str, Any], ...]", "Mapping[str, Any]"]
_PARTS = Listed(Together(Number(), Number(), Number(above=0.0), names=("from", "to", "bound")))


@declared
class LimitedMove(Declared, title="a move with its limits"):
    """A move of a mechanism or a drive over one stroke, with its limits, in SI units.

    Raises
    ------
    InputError
        If an entry is wrong, something counts of an energy that is not minimised, or the drive itself has it.
    """

    writes_defaults = True

    driven: Any = entry(ReadBy(_driven, "a mechanism or a drive", lambda moved: moved.to_dict()), "What moves.")
    minimise: DriveObjective = entry(Choice(*get_args(DriveObjective)), "Of what a limit is computed.")
    start: float = entry(Number(), "Where the input begins.")
    stroke: float = entry(Number(), "How far it moves.")
    duration: float | None = entry(Number(above=0.0), "Duration; not given where the time is minimised.", default=None)
    limits: MoveTable = entry(
        Table(Either(Number(above=0.0), _PARTS, which=is_list), keep=pairs),
        "The greatest velocity and acceleration of the input, and torque or force, or lists of them by position.",
        default=(),
    )
    recovered: float = entry(
        Number(least=0.0, most=1.0), "Which share of the braking energy of a mechanism is used again.", default=0.0
    )
    heat: float = entry(Number(least=0.0), "Copper heat that counts with the energy.", default=0.0)

    def _check(self) -> None:
        for name in self._unused:
            if getattr(self, name):
                raise InputError(
                    f"{name} is a part of the energy that is minimised: take minimise='energy'"
                    if self.minimise != "energy"
                    else f"{name} of a drive is its regeneration: give it to the drive"
                )

    @property
    def kind(self) -> str:
        """Whether a "mechanism" or a "drive" moves."""
        return next(kind for kind, moved in MOVED.items() if isinstance(self.driven, moved))

    @property
    def _unused(self) -> set[str]:
        """What does not count: an energy counts heat, and that of a mechanism what it recovers; a drive says this."""
        if self.minimise != "energy":
            return {"recovered", "heat"}
        return set() if self.kind == "mechanism" else {"recovered"}

    @classmethod
    def json_schema(cls) -> dict[str, Any]:
        schema = super().json_schema()
        schema["required"].remove("driven")
        moved = dict.fromkeys(MOVED, schema["properties"].pop("driven"))
        return {**schema, "properties": moved | schema["properties"]}

    def to_dict(self) -> dict[str, Any]:
        plain = super().to_dict()
        moved = {self.kind: plain.pop("driven")}
        return moved | {name: value for name, value in plain.items() if name not in self._unused}

    @classmethod
    def _from_earlier(cls, data: dict[str, Any]) -> dict[str, Any]:
        kinds = [kind for kind in MOVED if kind in data]
        if len(kinds) != 1:
            raise InputError(f"a move with its limits has a mechanism or a drive, got {shortened(data)}")
        return {"driven": MOVED[kinds[0]].from_dict(data.pop(kinds[0])), **data}


@declared
class MoveLimit(Declared, title="the limit of a move"):
    """A lower bound for motions over one stroke, from rest to rest, that never turn back; in SI units.

    >>> from optlaws import Mechanism
    >>> limit = Mechanism("0.8 kg m^2").limit("peak torque", "0 deg", "45 deg", "0.25 s")
    >>> print(limit)
    peak torque at least 40.2124 N m
    >>> limit.value < limit.attained, limit.gap < 1e-6, MoveLimit.from_json(limit.to_json()) == limit
    (True, True, True)
    """

    computes = True

    drive_limit: DriveLimit = entry(ValueOf(DriveLimit), "The limit without dimensions, with its certificate.")
    move: LimitedMove = entry(ValueOf(LimitedMove), "The mechanism or the drive, with the move and its limits.")

    @property
    def unit(self) -> float:
        """By what the value without dimensions is multiplied, in SI units."""
        return self._scale[0]

    @property
    def dimension(self) -> str:
        """The unit of the value: "N m", "N", "J" or "s"."""
        return self._scale[1]

    @kept_property
    def _scale(self) -> tuple[float, str]:
        return PhaseMove(self.move).scale(self.minimise)

    @property
    def minimise(self) -> DriveObjective:
        """The quantity that is minimised."""
        return self.drive_limit.minimise

    @property
    def value(self) -> float:
        """The proven lower bound, rounded down; minus infinity of an energy that nothing bounds."""
        value = self.drive_limit.value * self.unit
        return nextafter(value, -inf) if self.drive_limit.value else 0.0

    @property
    def attained(self) -> float:
        """The value of a motion that keeps the limits, by integration; infinite where no such one is known."""
        return self.drive_limit.attained * self.unit

    @property
    def gap(self) -> float:
        """The difference between that motion and the bound, as a share of the bound."""
        return self.drive_limit.gap

    def __str__(self) -> str:
        if self.value in {0.0, -inf}:
            return f"{self.minimise}: no bound {'above 0 ' if self.value == 0.0 else ''}is known"
        return f"{quantity_name(self.minimise)} at least {self.value:.{_DIGITS}g} {self.dimension}"

    def to_dict(self) -> dict[str, Any]:
        plain = {"dimension": self.dimension, "unit": self.unit, **super().to_dict()}
        return {name: plain[name] for name in _ENTRIES}

    @classmethod
    def from_dict(cls, data: Any) -> MoveLimit:
        """The limit that `to_dict` described, its plane, its unit and its bound computed again.

        Raises
        ------
        InputError
            If the data is no such limit, or states what its move, its certificate or its motion does not have.
        """
        limit, wrong = cls.stated(data)
        if wrong := wrong or limit.drive_limit.contradiction():
            raise InputError(wrong)
        return limit

    @classmethod
    def stated(cls, data: Any) -> tuple[MoveLimit, str]:
        """The limit of a file, and what of the file is not that of its move; the certificate is not checked.

        Raises
        ------
        InputError
            If the data is no such limit.
        """
        if isinstance(data, Mapping) and "drive_limit" in data and "move" not in data:
            raise InputError(
                f"{cls.named} was written by a version of optlaws that did not store its mechanism and its move, "
                "without which its unit cannot be checked: compute it again with this version and write a new file"
            )
        known = entries_of(data, _ENTRIES, cls.named, alone=True)
        limit = cls(DriveLimit.stated(known["drive_limit"]), LimitedMove.from_dict(known["move"]))
        unit = positive(known["unit"], "unit")
        if known["dimension"] != limit.dimension:
            return limit, f"dimension is {shortened(known['dimension'])}, and that of the move is {limit.dimension}"
        if abs(unit - limit.unit) > STATED_BOUND * limit.unit:
            return limit, f"unit is {unit!r}, and that of the move is {limit.unit!r}"
        return limit, "" if limit.is_of_its_move() else "drive_limit is the limit of another move"

    def is_of_its_move(self) -> bool:
        """Whether the limit without dimensions is that of the move, or the proof that the move is impossible."""
        of_move, form = PhaseMove(self.move).plane()
        same_unit = self.minimise == "time" or self.drive_limit.unit == form.size
        same_kind = self.minimise in {"time", "peak torque", self.move.minimise}
        return same_unit and same_kind and self.drive_limit.plane in planes_of_proof(of_move, self.drive_limit)


def limits_of_input(limits: Mapping[str, Any] | None, axis: InputAxis) -> dict[str, Any]:
    """The limits that a table names in SI units: velocity, acceleration and torque, or force where the input slides.

    Each is one bound, or a list of bounds over parts of the way: two positions and the bound.

    Raises
    ------
    InputError
        If a name is unknown, or a bound is of another dimension or not above 0.
    """
    dimensions = DIMENSIONS[axis]

    def bound(dimension: str) -> Any:
        position, most = InSI(axis), InSI(dimension, above=0.0)
        parts = Listed(Together(position, position, most, names=("from", "to", "bound")))
        return entry(Either(most, parts, which=is_list), "The greatest.", default=None, example=most.example)

    names = {name: dimensions[name] for name in ("velocity", "acceleration")} | {dimensions["load"]: dimensions["load"]}
    table = TableOf("limit of a move", {name: bound(dimension) for name, dimension in names.items()})
    given = table.read(limits or {}, "limits")
    parts = {name: [[*sorted(part[:2]), part[2]] for part in of] for name, of in given.items() if isinstance(of, tuple)}
    return {name: given[name] for name in names if name in given and name not in parts} | parts


class PhaseMove:
    """A move without dimensions, within its limits and those of its motor."""

    def __init__(self, move: LimitedMove) -> None:
        is_drive = move.kind == "drive"
        drive = move.driven if is_drive else MOVED["drive"].of_input(move.driven, move.recovered)
        self.minimise, self.heat = move.minimise, move.heat
        #: for the least time its duration is a unit alone
        self.over: StrokeTorque = drive.dimensionless(
            move.start, move.stroke, duration_of(move.minimise, move.duration)
        )
        axis = drive.mechanism.axis
        self.dimension = "N m" if axis == "angle" else "N"
        #: of the mechanism's input, in SI units
        self.most = {"velocity": drive.motor.greatest_speed / drive.ratio, "acceleration": inf}
        lines = [] if move.minimise == "peak torque" else drive.motor.peak_lines
        #: pairs of a torque at rest and by how much less it is with the velocity of the input
        self.torques = [(top, fall * drive.ratio) for top, fall in lines]
        #: what is bounded, from where to where as shares of the stroke, and the bound
        self.windows: list[tuple[str, float, float, float]] = []
        for name, of in limits_of_input(dict(move.limits), axis).items():
            if isinstance(of, list):
                self.windows += [(name, *self._shares(part[:2]), part[2]) for part in of]
            elif name in self.most:
                self.most[name] = min(of, self.most[name])
            else:
                self.torques.insert(0, (of, 0.0))
        #: the mean velocity of the input
        self.velocity = abs(self.over.stroke) / self.over.duration

    def _shares(self, positions: Sequence[float]) -> tuple[float, float]:
        """Two positions of the input as shares of the stroke."""
        low, high = sorted((position - self.over.start) / self.over.stroke for position in positions)
        if not -CLOSURE <= low < high <= 1.0 + CLOSURE:
            raise InputError(
                f"a part of the travel must lie within the stroke and have a length above 0, got {positions!r}"
            )
        return (0.0 if low < CLOSURE else low), (1.0 if high > 1.0 - CLOSURE else high)

    def scale(self, minimise: DriveObjective) -> tuple[float, str]:
        """The scale of what is minimised, and its unit."""
        known = {"energy": (self.over.energy_unit, "J"), "time": (self.over.duration, "s")}
        return known.get(minimise, (self.over.unit, self.dimension))

    def least_share(self) -> float:
        """The least time for the whole way within the bounds of velocities, by the time at the mean velocity."""
        limits = [(low, high, bound) for name, low, high, bound in self.windows if name == "velocity"]
        places = sorted({0.0, 1.0, *(end for limit in limits for end in limit[:2])})
        shares = []
        for low, high in pairwise(places):
            bounds = (bound for start, stop, bound in limits if start <= low and high <= stop)
            shares.append((high - low) * self.velocity / min([self.most["velocity"], *bounds]))
        return fsum(shares)

    def plane(self) -> tuple[PhasePlane, AnyTorque]:
        """The phase plane of the move, its torques divided by the size of the torque, which is given too."""
        over, whole = self.over, phase_torque(self.over.torque)
        form, torque = whole.scaled(1.0 / whole.size), whole.size * over.unit
        unit_of = {"velocity": self.velocity, "acceleration": self.velocity / over.duration}
        limits = [TorqueLimit(form, most / torque, fall * self.velocity / torque) for most, fall in self.torques]
        velocities = []
        for name, low, high, bound in self.windows:
            most = bound / unit_of.get(name, torque)
            if name == "velocity":
                velocities.append(VelocityLimit(low, high, most))
            else:
                limits.append(TorqueLimit(ACCELERATION if name == "acceleration" else form, most, start=low, stop=high))
        B, C = (self.most[name] / of for name, of in unit_of.items())
        plane = PhasePlane(limits=tuple(limits), B=B, C=C, velocities=tuple(velocities))
        if self.minimise == "energy":
            plane = replace(plane, maxima=((form, form.scaled(over.train.regeneration)),))
            # the mean of the squared torque over the time, in the unit of the energy
            heat = self.heat * torque**2 * over.duration / over.energy_unit / whole.size
            plane = replace(plane, squared=form, heat=heat) if self.heat else plane
        elif self.minimise != "time":
            is_peak = self.minimise == "peak torque"
            plane = replace(plane, peak=form) if is_peak else replace(plane, squared=form)
        if plane.squared is not None or plane.peak is not None:
            plane = replace(plane, holding=scaled(read(over.holding, ("a",)), 1.0 / whole.size))
        return plane, whole


def limit_of(
    driven: Any,
    minimise: DriveObjective,
    stroke: tuple[NumberOrQuantity, NumberOrQuantity],
    duration: NumberOrQuantity | None,
    limits: Mapping[str, Any] | None,
    **more: float,
) -> MoveLimit:
    """The limit of a mechanism or a drive over a stroke, known by its start and its length."""
    way = driven.dimensionless(*stroke, duration_of(minimise, duration))
    bounds = limits_of_input(limits, getattr(driven, "mechanism", driven).axis)
    time = None if duration is None else way.duration
    return move_limit(LimitedMove(driven, minimise, way.start, way.stroke, time, bounds, **more))


def move_limit(move: LimitedMove) -> MoveLimit:
    """The limit of a move of a mechanism or a drive over one stroke.

    Raises
    ------
    InputError
        If the torque is of another form, or nothing keeps the acceleration finite.
    InfeasibleProblem
        If no motion keeps the bounds; the error states what is reachable.
    """
    minimise = move.minimise
    parts = PhaseMove(move)
    time, most = parts.over.duration, parts.most["velocity"]
    if minimise != "time" and (least := parts.least_share()) >= 1.0:
        takes, given = f"{least * time:.{_DIGITS}g} s", f"{time:.{_DIGITS}g} s"
        unit_of_velocity = "rad/s" if parts.dimension == "N m" else "m/s"
        speed = f" of {most:.{_DIGITS}g} {unit_of_velocity}" if most < inf else ""
        shown = f"at the greatest velocity{speed} alone the stroke takes {takes}"
        raise InfeasibleProblem(f"{shown}, and {given} are given: take more time, or a greater velocity", proof=shown)
    plane, form = parts.plane()
    unit = form.size
    try:
        limit = limit_of_plane(plane, minimise, unit)
    except InfeasibleProblem as error:
        raise _infeasible(plane, form, move, parts, error) from None
    except SolverFailure as error:
        beyond = unreachable(plane, unit)
        if beyond is None:
            raise
        proof = MoveLimit(beyond, move)
        raise InfeasibleProblem(
            f"no motion keeps the limits in up to {LONG * time:.{_DIGITS}g} s, which is proven: the load "
            f"takes a peak of at least {proof.value:.{_DIGITS}g} {parts.dimension}. Allow more torque",
            proof=proof,
            tried=str(error),
        ) from None
    return MoveLimit(limit, move)


def _infeasible(
    plane: PhasePlane, form: AnyTorque, move: LimitedMove, parts: PhaseMove, error: InfeasibleProblem
) -> InfeasibleProblem:
    """The error in SI units: the least time and, where torques are bounded, the least peak torque in the time given."""
    if not isinstance(error.proof, DriveLimit):
        return error
    given, least = f"{parts.over.duration:.{_DIGITS}g} s", error.proof.value * parts.over.duration
    reached = [f"within them the move takes at least {least:.{_DIGITS}g} s"]
    if plane.limits:
        unit = form.size
        free = replace(plane, squared=None, maxima=(), peak=form.scaled(1.0 / unit), limits=(), holding=None)
        try:
            peak = limit_of_plane(free, "peak torque", unit).value * parts.over.unit
            reached.append(f"and in {given} a peak of at least {peak:.{_DIGITS}g} {parts.dimension}")
        except (InfeasibleProblem, SolverFailure, InputError):
            pass
    return InfeasibleProblem(
        f"no motion keeps the limits in {given}, which is proven: {', '.join(reached)}",
        proof=MoveLimit(error.proof, move),
    )
