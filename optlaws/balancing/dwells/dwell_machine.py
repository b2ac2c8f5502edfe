"""Dwell mechanisms in machine units: the clutch's time as an angle (16), and the torques (19) to (22), in N m."""

from __future__ import annotations

from collections.abc import Mapping
from math import tau
from typing import Any

from optlaws.balancing.dwells.mechanism import DwellMechanism, DwellType, dwell_mechanism
from optlaws.cams.curves.motion_by_angle import CamMotion
from optlaws.cams.disc import DiscCam
from optlaws.cams.followers.rollers import OscillatingRoller
from optlaws.cycles.cycle import Cycle
from optlaws.cycles.specification.segments import Dwell, Return, Rise
from optlaws.echo import shortened
from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Number
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import Exact, quantity
from optlaws.numbers import NumberOrQuantity

_DWELL = ("run-out", "reverse", "run-up")
_SIZES = ("inertia", "loader_inertia", "arm", "prime_radius")


_POSITIVE = Number(above=0.0)


@declared
class DwellMachine(Declared, title="a dwell machine"):
    """A balancing dwell mechanism at a speed; built by `dwell_machine`.

    Examples
    --------
    >>> from optlaws import catalogue
    >>> data = dict(dwell="90 deg", rise="90 deg", swing="20 deg", arm="100 mm", prime_radius="35 mm", speed="100 rpm")
    >>> inertias = dict(inertia="0.05 kg m^2", loader_inertia="0.005 kg m^2")
    >>> type_1 = dwell_machine("I", law=catalogue["K"].law, **data, **inertias)
    >>> round(type_1.balanced_torque, 6), type_1.residual_torque
    (0.668101, 0.0)
    """

    computes = True

    mechanism: DwellMechanism = entry(ValueOf(DwellMechanism), "The mechanism, dimensionless.")
    rate: float = entry(_POSITIVE, "Of the cam's shaft, rad/s.")
    inertia: float = entry(_POSITIVE, "Of everything the executive rocker moves, kg m².")
    loader_inertia: float = entry(_POSITIVE, "Of the loader's rocker alone, kg m².")
    arm: float = entry(_POSITIVE, "Length of both rockers, m.")
    prime_radius: float = entry(_POSITIVE, "The least radius of both pitch curves, m.")

    @property
    def clutch_angle(self) -> float:
        """Angle of the clutch, rad: w t_sp (eq. 16)."""
        return self.mechanism.clutch_angle

    @property
    def balanced_torque(self) -> float:
        """The greatest torque that the loader takes from the shaft, N m: D I gS²/(ph_v T_v²) (eq. 22)."""
        return self._power(self.mechanism.law, 1.0, self.mechanism.rise, self.inertia)

    @property
    def driven_torque(self) -> float:
        """The greatest inertia torque at the executive rocker, N m: C I gS/T_v²."""
        return self._torque(self.mechanism.law, 1.0, self.mechanism.rise, self.inertia)

    @property
    def residual_torque(self) -> float:
        """The greatest torque of the loader's rocker alone in the dwells, at the shaft, N m (eq. 19); 0 for type I."""
        return max((self._power(*section, self.loader_inertia) for section in self._sections), default=0.0)

    @property
    def loader_driven_torque(self) -> float:
        """The greatest inertia torque at the loader's rocker itself, N m (eq. 20)."""
        return max((self._torque(*section, self.loader_inertia) for section in self._sections), default=0.0)

    @property
    def reduction(self) -> float:
        """The torque at the shaft that remains in the dwells over the balanced torque: the criterion b (eq. 23)."""
        return self.residual_torque / self.balanced_torque

    def executive_motion(self) -> Cycle:
        """The executive rocker over the turn, as a cycle.

        Raises
        ------
        InputError
            If rise, return and dwells do not make a turn.
        """
        turn = self._turn()
        swing = Exact(turn.swing, "rad")
        rests = [[Dwell(Exact(dwell, "rad"))] if dwell else [] for dwell in (turn.dwell, turn.lower_dwell)]
        rise = Rise(swing, Exact(turn.rise, "rad"), law=turn.law)
        back = Return(swing, Exact(turn.return_angle, "rad"), law=turn.return_law)
        return Cycle([rise, *rests[0], back, *rests[1]], period=Exact(tau / self.rate, "s"))

    def loader_motion(self) -> CamMotion:
        """The loader's rocker over the turn, by the cam's angle, rad.

        Raises
        ------
        InputError
            If rise, return and dwells do not make a turn.
        """
        turn = self._turn()
        return CamMotion.of_pieces([Piece(0.0, tau, 0.0, turn.swing, turn.motion)], tau, "angle")

    def cams(self, roller: NumberOrQuantity, pivot_distance: NumberOrQuantity) -> dict[str, DiscCam]:
        """The executive cam and the loader's, with rollers on arms.

        Parameters
        ----------
        roller
            Radius of both rollers, such as "10 mm".
        pivot_distance
            From the cams' centre to the rockers' pivot.

        Raises
        ------
        InputError
            If the cycle is no turn, or there is no such mechanism.
        """
        follower = OscillatingRoller(roller, arm=Exact(self.arm, "m"), pivot_distance=pivot_distance)
        radius = Exact(self.prime_radius, "m")
        return {
            "executive": DiscCam(self.executive_motion(), radius, follower),
            "loader": DiscCam(self.loader_motion(), radius, follower),
        }

    def to_dict(self) -> dict[str, Any]:
        """Sizes, torques, angles and criteria as plain data in SI units."""
        torques = ("balanced_torque", "driven_torque", "residual_torque", "loader_driven_torque")
        names = ("rate", *_SIZES, "clutch_angle", *torques)
        return {name: getattr(self, name) for name in names} | {"mechanism": self.mechanism.to_dict()}

    @property
    def _sections(self) -> list[tuple[MotionLaw, float, float]]:
        """Laws of the loader's rocker alone, with their strokes in S and the angles of the whole laws."""
        return [
            (section.law, abs(section.scale), section.angle / (section.end - section.start))
            for section in self.mechanism.sections
            if section.law is not None and section.name in _DWELL
        ]

    def _torque(self, law: MotionLaw, stroke: float, angle: float, inertia: float) -> float:
        """The greatest inertia torque at a rocker that runs a law over a stroke in S within an angle."""
        return law.peak(2).value * inertia * (stroke * self.mechanism.swing) / (angle / self.rate) ** 2

    def _power(self, law: MotionLaw, stroke: float, angle: float, inertia: float) -> float:
        """The greatest torque that this rocker takes from the shaft."""
        return (
            law.constants.D.value * inertia * (stroke * self.mechanism.swing) ** 2 / (angle * (angle / self.rate) ** 2)
        )

    def _turn(self) -> DwellMechanism:
        if self.mechanism.remarks:
            raise InputError(f"no cam comes back: {self.mechanism.remarks[0]}; give a return_angle or a lower_dwell")
        return self.mechanism


def dwell_machine(
    kind: DwellType,
    *,
    law: MotionLaw,
    speed: NumberOrQuantity,
    dwell: NumberOrQuantity,
    rise: NumberOrQuantity,
    swing: NumberOrQuantity,
    inertia: NumberOrQuantity,
    loader_inertia: NumberOrQuantity,
    arm: NumberOrQuantity,
    prime_radius: NumberOrQuantity,
    clutch_time: NumberOrQuantity = "0 s",
    more: Mapping[str, Any] | None = None,
) -> DwellMachine:
    """A balancing dwell mechanism from a machine's data: its clutch takes a time, an angle that grows with the speed.

    Parameters
    ----------
    kind
        "I", "II" or "III".
    law
        Executive law of the rise.
    speed
        Of the cam's shaft, such as "120 rpm": n of eq. (16).
    dwell, rise, swing
        Angles of the upper dwell and the rise, and the executive rocker's swing, such as "90 deg".
    inertia, loader_inertia
        Moments of inertia of everything the executive rocker moves, and of the loader's rocker alone.
    arm, prime_radius
        Length of both rockers, and least radius of both cams.
    clutch_time
        In which the clutch acts, such as "5 ms": t_sp of eq. (16).
    more
        Further entries of `dwell_mechanism`: law_1, law_2, return_angle, lower_dwell, standstill, reverse_share.

    Raises
    ------
    InputError
        If a quantity is of another dimension or out of its range, or the clutch leaves no room in the dwell.

    Examples
    --------
    >>> from optlaws import catalogue
    >>> K = catalogue["K"].law
    >>> data = dict(law=K, dwell="90 deg", rise="90 deg", swing="20 deg", arm="100 mm", prime_radius="35 mm")
    >>> inertias = dict(inertia="0.05 kg m^2", loader_inertia="0.005 kg m^2")
    >>> slow = dwell_machine("III", speed="100 rpm", clutch_time="25 ms", **data, **inertias)
    >>> slow.mechanism, round(slow.balanced_torque, 6), round(slow.residual_torque, 6)
    (DwellMechanism(III, a=1.59434, b=0.15, S1=0, S2=0.666667), 0.668101, 0.100215)
    """
    rate = quantity(speed, "angular velocity", "speed", above=0.0)
    known = {
        "inertia": quantity(inertia, "moment of inertia", "inertia", above=0.0),
        "loader_inertia": quantity(loader_inertia, "moment of inertia", "loader_inertia", above=0.0),
        "arm": quantity(arm, "length", "arm", above=0.0),
        "prime_radius": quantity(prime_radius, "length", "prime_radius", above=0.0),
    }
    time = quantity(clutch_time, "time", "clutch_time")
    if time < 0.0:
        raise InputError(f"clutch_time must be at least 0, got {shortened(clutch_time)}")
    angles = {"dwell": dwell, "rise": rise, "swing": swing}
    turned: dict[str, Any] = {name: quantity(angle, "angle", name, above=0.0) for name, angle in angles.items()}
    mechanism = dwell_mechanism(
        kind,
        law=law,
        clutch_angle=rate * time,
        radius_ratio=known["prime_radius"] / (turned["swing"] * known["arm"]),
        inertia_ratio=known["loader_inertia"] / known["inertia"],
        **turned,
        **(more or {}),
    )
    return DwellMachine(mechanism, rate, **known)
