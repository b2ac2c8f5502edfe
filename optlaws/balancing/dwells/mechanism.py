"""Balancing cam mechanisms of types I, II and III: sections, ways and the criteria a and b."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY
from math import degrees, tau
from typing import Any, Literal, TypedDict, Unpack, get_args

from optlaws.balancing.dwells.sections import (
    Section,
    check_law,
    composed,
    excursion,
    law_of,
    loader_of,
    top,
)
from optlaws.balancing.loaders.loader import Loader
from optlaws.echo import keywords_of, shortened
from optlaws.entries.declared import Declared, declared, documented_by, entry
from optlaws.entries.value_types import Choice, InSI, Kept, Number, ReadBy, SINumber
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.numbers import NumberOrQuantity
from optlaws.tolerances import AGREEMENT

DwellType = Literal["I", "II", "III"]

KINDS: tuple[DwellType, ...] = ("I", "II", "III")
LAWS = ("law", "law_1", "law_2", "return_law")
ANGLES = ("dwell", "rise", "return_angle", "lower_dwell", "clutch_angle", "standstill", "swing")
RATIOS = ("radius_ratio", "inertia_ratio", "reverse_share")
#: what stands for a quantity that is not given
INSTEAD = {"law_1": "law", "law_2": "law", "return_law": "law", "return_angle": "rise", "lower_dwell": "dwell"}
COMPUTED = ("speed", "phi1", "phi2", "S_sp", "S1", "S2", "a", "b")


def _law(given: Any) -> MotionLaw:
    law: MotionLaw = law_of(MotionLaw.from_dict(given) if isinstance(given, Mapping) else given)
    check_law("it", law)
    return law


_LAW = ReadBy(_law, "a `MotionLaw` from rest to rest over a stroke of 1", MotionLaw.to_dict, {"type": "object"})
_ANGLE, _FROM_0, _ABOVE_0 = InSI("angle", above=0.0), InSI("angle", least=0.0), Number(above=0.0)


@declared
class DwellMechanism(Declared, title="a dwell mechanism"):
    """A balancing cam mechanism for an executive rocker that dwells; `dwell_mechanism` builds it from its data.

    Angles are in radians, ways in strokes S of the executive link.

    Examples
    --------
    >>> from optlaws import catalogue, deg, dwell_mechanism
    >>> mechanism = dwell_mechanism(
    ...     "III",
    ...     law=catalogue["K"].law,
    ...     dwell=deg(90),
    ...     rise=deg(90),
    ...     clutch_angle=deg(15),
    ...     swing=deg(20),
    ...     radius_ratio=1.0026761,
    ...     inertia_ratio=0.1,
    ... )
    >>> mechanism, [section.name for section in mechanism.sections]
    (DwellMechanism(III, a=1.59434, b=0.15, S1=0, S2=0.666667), ['rise', 'clutch', 'run-out', 'run-up', 'clutch', ...])
    """

    computes = True

    _: KW_ONLY
    kind: DwellType = entry(Choice(*get_args(DwellType)), "How its loader runs in the dwells.", name="type")
    law: MotionLaw = entry(_LAW, "Executive law of the rise; its loader is that of `inertial_loader`.")
    dwell: SINumber = entry(_ANGLE, "Angle of the upper dwell.")
    rise: SINumber = entry(_ANGLE, "Angle of the rise.")
    swing: SINumber = entry(_ANGLE, "Swing of the executive rocker; the rocker of the loader is as long.")
    radius_ratio: float = entry(_ABOVE_0, "Least radius of either cam over S.")
    inertia_ratio: float = entry(
        _ABOVE_0,
        "Moment of inertia of the loader's rocker alone over that of everything the executive rocker moves.",
    )
    clutch_angle: SINumber = entry(
        _FROM_0,
        "Angle in which the clutch acts at either end of the dwell, at uniform speed; not used by type I.",
        default=0.0,
    )
    law_1: MotionLaw = entry(
        _LAW, "Law of run-out and run-up of type II; the executive law unless given.", default=None
    )
    law_2: MotionLaw = entry(
        _LAW,
        "Law of the reverse motion of type II, of run-out and run-up of type III; the executive law unless given.",
        default=None,
    )
    return_angle: Kept[float, NumberOrQuantity | None] = entry(
        _ANGLE, "Angle of the return; that of the rise unless given.", default=None
    )
    return_law: MotionLaw = entry(_LAW, "Executive law of the return; that of the rise unless given.", default=None)
    lower_dwell: Kept[float, NumberOrQuantity | None] = entry(
        _FROM_0, "Angle of the lower dwell, 0 for none; that of the upper dwell unless given.", default=None
    )
    standstill: SINumber = entry(
        _FROM_0,
        "Angle in which the rocker of type III stands still in the upper dwell; in the lower one it stands still for "
        "as much longer as that dwell is longer.",
        default=0.0,
    )
    reverse_share: float = entry(
        Number(above=0.0),
        "Share of the reverse motion in the angle of type II between the clutch angles.",
        default=0.5,
    )

    def _check(self) -> None:
        for name, other in INSTEAD.items():
            if getattr(self, name) is None:
                object.__setattr__(self, name, getattr(self, other))
        _check(self)

    @property
    def loader(self) -> Loader:
        """The inertial loader of the rise."""
        return loader_of(self.law)

    @property
    def speed(self) -> float:
        """Speed of the loader in the dwell, S per radian: B of its law over the angle of the rise (eq. 6)."""
        return self.loader.B / self.rise

    @property
    def phi1(self) -> float:
        """Angle of run-out and run-up together in the upper dwell, radians; 0 for types I and III (eq. 17)."""
        return (1.0 - self.reverse_share) * self.free(self.dwell) if self.kind == "II" else 0.0

    @property
    def phi2(self) -> float:
        """Angle of the reverse motion (II, eq. 17), or of run-out and run-up (III, eq. 24), radians; 0 for type I."""
        return 0.0 if self.kind == "I" else self.second(self.dwell)

    @property
    def S_sp(self) -> float:
        """Travel of the rocker while the clutch acts, in S (eq. 11); 0 for type I."""
        return 0.0 if self.kind == "I" else self.speed * self.clutch_angle

    @property
    def S1(self) -> float:
        """Travel in the upper dwell (I, eq. 7) or of run-out and run-up together (II, eq. 14), in S; 0 for III."""
        if self.kind == "I":
            return self.speed * self.dwell
        return self.speed * self.phi1 / self.law_1.constants.B.value

    @property
    def S2(self) -> float:
        """Travel of the reverse motion (II, eq. 9) or of run-out and run-up together (III, eq. 26), in S; 0 for I."""
        if self.kind == "I":
            return 0.0
        return self.S1 + 2.0 * self.S_sp if self.kind == "II" else self.speed * self.phi2 / self.law_2.constants.B.value

    @kept_property
    def a(self) -> float:
        """Criterion a: the greatest radius of the loader's cam over the executive cam's greatest radius (eq. 1)."""
        return (self.radius_ratio + excursion(self.sections)) / (self.radius_ratio + 1.0)

    @kept_property
    def b(self) -> float:
        """Criterion b: greatest inertia torque of the loader's rocker in the dwells over the balanced one (eq. 23)."""
        greatest = 0.0
        for section in self.sections:
            if section.law is not None and section.name in {"run-out", "reverse", "run-up"}:
                whole = section.angle / (section.end - section.start)
                greatest = max(greatest, section.law.constants.D.value * section.scale**2 / whole**3)
        return self.inertia_ratio * greatest * self.rise**3 / self.law.constants.D.value

    @kept_property
    def sections(self) -> tuple[Section, ...]:
        """The sections of the loader's cam in order, from the start of the rise."""
        rise = Section.run("rise", self.rise, self.loader.law, 1.0)
        back = Section.run("return", self.return_angle, loader_of(self.return_law).law, -1.0)
        return (rise, *self._in_dwell(self.dwell, -1.0), back, *self._in_dwell(self.lower_dwell, 1.0))

    @property
    def cycle(self) -> float:
        """Angle of a whole cycle, radians."""
        return self.rise + self.dwell + self.return_angle + self.lower_dwell

    @kept_property
    def motion(self) -> PiecewiseLaw:
        """The motion of the loader's rocker over the cycle, in S over k = cam angle / cycle."""
        return composed(self.sections)

    @kept_property
    def remarks(self) -> tuple[str, ...]:
        """Remarks on the mechanism: a cycle that is not one turn of the cam."""
        if abs(self.cycle / tau - 1.0) < AGREEMENT:
            return ()
        return (f"rise, return and dwells add up to {degrees(self.cycle):.6g} degrees, not to one turn",)

    def to_dict(self) -> dict[str, Any]:
        """Angles (radians), travels, criteria and sections as plain data, with the laws besides the rise's law."""
        laws = {name: getattr(self, name) for name in LAWS}
        return {
            "type": self.kind,
            **{name: law.to_dict() for name, law in laws.items() if name == "law" or law != self.law},
            **{name: getattr(self, name) for name in ANGLES + RATIOS + COMPUTED},
            "sections": [
                {"name": section.name, "angle": section.angle, "travel": section.travel} for section in self.sections
            ],
            "remarks": list(self.remarks),
        }

    def __repr__(self) -> str:
        return f"DwellMechanism({self.kind}, a={self.a:g}, b={self.b:g}, S1={self.S1:g}, S2={self.S2:g})"

    def free(self, dwell: float) -> float:
        """Angle of a dwell between the clutch angles, radians."""
        return dwell - 2.0 * self.clutch_angle

    def second(self, dwell: float) -> float:
        """phi2 of a dwell of types II and III, radians."""
        if self.kind == "II":
            return self.reverse_share * self.free(dwell)
        return self.free(self.dwell) - self.standstill

    def _in_dwell(self, dwell: float, way: float) -> list[Section]:
        if dwell == 0.0:
            return []
        if self.kind == "I":
            return [Section("dwell", dwell, way * self.speed * dwell)]
        clutch = Section("clutch", self.clutch_angle, way * self.S_sp)
        ends = [clutch] if self.clutch_angle else []
        phi2 = self.second(dwell)
        if self.kind == "II":
            phi = self.free(dwell) - phi2
            law, stroke = self.law_1, self.speed * phi / self.law_1.constants.B.value
            middle = [Section.run("reverse", phi2, self.law_2, -way * (stroke + 2.0 * self.S_sp))]
        else:
            phi, law, stroke = phi2, self.law_2, self.S2
            rest = self.free(dwell) - phi2
            middle = [Section("standstill", rest, 0.0)] if rest > AGREEMENT else []
        cut = top(law)
        run_out = Section.run("run-out", (1.0 - cut) * phi, law, way * stroke, (cut, 1.0))
        run_up = Section.run("run-up", cut * phi, law, way * stroke, (0.0, cut))
        return [*ends, run_out, *middle, run_up, *ends]


def _check(mechanism: DwellMechanism) -> None:
    """Refuse what cannot be built."""
    if mechanism.reverse_share >= 1.0:
        raise InputError(f"reverse_share must be between 0 and 1, got {shortened(mechanism.reverse_share)}")
    _speeds(mechanism)
    if mechanism.kind == "I":
        _equal_dwells(mechanism)
    else:
        _room(mechanism)


def _speeds(mechanism: DwellMechanism) -> None:
    back = loader_of(mechanism.return_law).B / mechanism.return_angle
    if abs(mechanism.speed / back - 1.0) > AGREEMENT:
        raise InputError(
            f"return_angle must suit the rise, for the loader keeps its speed in the dwell: it ends the rise with "
            f"{mechanism.speed:.6g} S per radian (B / rise), and the return begins with {back:.6g}; for the return's "
            f"law it must be {degrees(loader_of(mechanism.return_law).B / mechanism.speed):.6g} degrees"
        )


def _equal_dwells(mechanism: DwellMechanism) -> None:
    if abs(mechanism.lower_dwell - mechanism.dwell) > AGREEMENT:
        raise InputError(
            f"lower_dwell of type I must equal dwell, {degrees(mechanism.dwell):.6g} degrees, or its rocker drifts; "
            f"got {degrees(mechanism.lower_dwell):.6g} degrees: take type II, or III if there are two dwells"
        )


def _room(mechanism: DwellMechanism) -> None:
    for name, dwell in (("dwell", mechanism.dwell), ("lower_dwell", mechanism.lower_dwell)):
        if mechanism.kind == "II" and dwell == 0.0:
            continue
        if mechanism.free(dwell) <= AGREEMENT or mechanism.second(dwell) <= AGREEMENT:
            least = degrees(2.0 * mechanism.clutch_angle + (mechanism.standstill if mechanism.kind == "III" else 0.0))
            raise InputError(
                f"{name} must exceed twice clutch_angle{' and the standstill' if mechanism.kind == 'III' else ''}, "
                f"{least:.6g} degrees, got {degrees(dwell):.6g} degrees"
            )
        if mechanism.free(dwell) - mechanism.second(dwell) < -AGREEMENT:
            raise InputError(
                f"{name} of type III must leave room for the same way as the upper one: at least "
                f"{degrees(mechanism.dwell - mechanism.standstill):.6g} degrees, got {degrees(dwell):.6g} degrees"
            )


class _DwellData(TypedDict):
    law: MotionLaw
    dwell: NumberOrQuantity
    rise: NumberOrQuantity
    swing: NumberOrQuantity
    radius_ratio: float
    inertia_ratio: float


class DwellEntries(_DwellData, total=False):
    """Arguments of `dwell_mechanism` that are common to all types; `dwell_mechanism` defines each."""

    clutch_angle: NumberOrQuantity
    law_1: MotionLaw | None
    law_2: MotionLaw | None
    return_angle: NumberOrQuantity | None
    return_law: MotionLaw | None
    lower_dwell: NumberOrQuantity | None
    standstill: NumberOrQuantity
    reverse_share: float


DEFAULTS: dict[str, float] = {"clutch_angle": 0.0, "standstill": 0.0, "reverse_share": 0.5}


@documented_by(DwellMechanism)
@keywords_of(DwellEntries, **DEFAULTS)
def dwell_mechanism(kind: DwellType, **entries: Unpack[DwellEntries]) -> DwellMechanism:
    """A balancing cam mechanism with an inertial loader, for an executive rocker that dwells.

    While the executive link dwells, the loader keeps the kinetic energy. In type I its rocker runs on with it at
    uniform speed. In types II and III a clutch lets the loader go: the rocker of type II runs out, comes back by the
    reverse motion and runs up again, that of type III runs out, may stand still and runs up again.

    Angles have a unit, "90 deg", or are numbers in radians (`optlaws.deg` turns degrees into radians); ways are in
    strokes S of the executive link.

    Raises
    ------
    InputError
        If a number is out of range, a law is not from rest to rest, the angles leave no room for the motions, or the
        rise, the return and the dwells do not fit each other.

    Examples
    --------
    >>> from optlaws import catalogue, deg
    >>> data = dict(law=catalogue["K"].law, dwell=deg(90), rise=deg(90), clutch_angle=deg(15), swing=deg(20))
    >>> for kind in ("I", "II", "III"):
    ...     print(dwell_mechanism(kind, radius_ratio=1.0026761, inertia_ratio=0.1, **data))
    DwellMechanism(I, a=1.78435, b=0, S1=1.5708, S2=0)
    DwellMechanism(II, a=1, b=1.9827, S1=0.333333, S2=0.856932)
    DwellMechanism(III, a=1.59434, b=0.15, S1=0, S2=0.666667)
    """
    given: Any = entries
    return DwellMechanism(kind=kind, **given)
