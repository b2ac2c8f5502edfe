"""Balancing cam mechanisms of types I, II and III: sections, ways and the criteria a and b."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, tau
from typing import Any

from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.mechanisms.dwell.checks import check
from optlaws.mechanisms.dwell.section_laws import REST, loader_of, peak_power, peak_velocity, top
from optlaws.mechanisms.dwell.sections import Section, composed, excursion
from optlaws.mechanisms.loader.loader import Loader

ANGLES = ("dwell", "rise", "return_angle", "lower_dwell", "clutch_angle", "standstill", "swing")
RATIOS = ("radius_ratio", "inertia_ratio", "reverse_share")
FOUND = ("speed", "phi1", "phi2", "S_sp", "S1", "S2", "a", "b")


@dataclass(frozen=True, repr=False, kw_only=True)
class DwellMechanism:
    """A balancing cam mechanism for an executive rocker that dwells; `dwell_mechanism` makes it, and names its data.

    Angles are in radians, ways in strokes S of the executive link.

    Examples
    --------
    >>> from optlaws import catalogue, deg, dwell_mechanism
    >>> one = dwell_mechanism(
    ...     "III",
    ...     law=catalogue["K"].law,
    ...     dwell=deg(90),
    ...     rise=deg(90),
    ...     clutch_angle=deg(15),
    ...     swing=deg(20),
    ...     radius_ratio=1.0026761,
    ...     inertia_ratio=0.1,
    ... )
    >>> one, [section.name for section in one.sections]
    (DwellMechanism(III, a=1.59434, b=0.15, S1=0, S2=0.666667), ['rise', 'clutch', 'run-out', 'run-up', 'clutch', ...])
    """

    kind: str
    law: MotionLaw
    dwell: float
    rise: float
    clutch_angle: float
    swing: float
    radius_ratio: float
    inertia_ratio: float
    law_1: MotionLaw
    law_2: MotionLaw
    return_angle: float
    return_law: MotionLaw
    lower_dwell: float
    standstill: float
    reverse_share: float

    def __post_init__(self) -> None:
        check(self)

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
        """Way of the rocker while the clutch acts, in S (eq. 11); 0 for type I."""
        return 0.0 if self.kind == "I" else self.speed * self.clutch_angle

    @property
    def S1(self) -> float:
        """Way in the upper dwell (I, eq. 7) or of run-out and run-up together (II, eq. 14), in S; 0 for type III."""
        if self.kind == "I":
            return self.speed * self.dwell
        return self.speed * self.phi1 / peak_velocity(self.law_1)

    @property
    def S2(self) -> float:
        """Way of the reverse motion (II, eq. 9) or of run-out and run-up together (III, eq. 26), in S; 0 for type I."""
        if self.kind == "I":
            return 0.0
        return self.S1 + 2.0 * self.S_sp if self.kind == "II" else self.speed * self.phi2 / peak_velocity(self.law_2)

    @kept_property
    def a(self) -> float:
        """Criterion a: greatest radius of the loader's cam over that of the executive cam (eq. 1)."""
        return (self.radius_ratio + excursion(self.sections)) / (self.radius_ratio + 1.0)

    @kept_property
    def b(self) -> float:
        """Criterion b: greatest inertia torque of the loader's rocker in the dwells over the balanced one (eq. 23)."""
        found = 0.0
        for one in self.sections:
            if one.law is not None and one.name in {"run-out", "reverse", "run-up"}:
                whole = one.angle / (one.end - one.start)
                found = max(found, peak_power(one.law) * one.scale**2 / whole**3)
        return self.inertia_ratio * found * self.rise**3 / peak_power(self.law)

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
        """What to mind: a cycle that is not one turn of the cam."""
        if abs(self.cycle / tau - 1.0) < REST:
            return ()
        return (f"rise, return and dwells add up to {degrees(self.cycle):.6g} degrees, not to one turn",)

    def to_dict(self) -> dict[str, Any]:
        """Angles (radians), ways, criteria and sections as plain data."""
        return {
            "type": self.kind,
            **{name: getattr(self, name) for name in ANGLES + RATIOS + FOUND},
            "sections": [{"name": one.name, "angle": one.angle, "travel": one.travel} for one in self.sections],
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
            law, stroke = self.law_1, self.speed * phi / peak_velocity(self.law_1)
            middle = [Section.run("reverse", phi2, self.law_2, -way * (stroke + 2.0 * self.S_sp))]
        else:
            phi, law, stroke = phi2, self.law_2, self.S2
            rest = self.free(dwell) - phi2
            middle = [Section("standstill", rest, 0.0)] if rest > REST else []
        cut = top(law)
        run_out = Section.run("run-out", (1.0 - cut) * phi, law, way * stroke, (cut, 1.0))
        run_up = Section.run("run-up", cut * phi, law, way * stroke, (0.0, cut))
        return [*ends, run_out, *middle, run_up, *ends]
