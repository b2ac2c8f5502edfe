"""The elastic follower: a mass driven by its cam through a spring (1.19), and what errors of its design cost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, exp, pi, sqrt, tau
from typing import Any, Literal

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws import MotionLaw, Peak
from optlaws.laws.law import motion_law
from optlaws.mechanisms.machine.response import CycleResponse, Response, duration_of_rise
from optlaws.motion.quantities import check_scale, either
from optlaws.numbers import NumberOrQuantity, Quantity, circular_frequency, not_negative, numbers, positive
from optlaws.shown.report import PlainReport, Report, ReportTable
from optlaws.shown.summary import Row, Summary

_SHOWN = 240


@dataclass(frozen=True)
class Follower:
    """A mass on a spring that a cam moves: a_m'' + 2 n a_m' + nu² a_m = nu² a, n = damping nu (1.19).

    Time is k = t/T, T the duration of the rise, so that nu = T sqrt(stiffness/mass) is the phase in radians that the
    undamped vibration runs through during the rise.

    Parameters
    ----------
    frequency
        Dimensionless circular frequency nu, above 0.
    damping
        Ratio zeta = n/nu of the damping to the critical one, at least 0; 1 and more are allowed. The damper is between
        mass and ground, not between mass and cam, as that of a `Machine.from_modes` is.

    Raises
    ------
    InputError
        If a number is not finite or out of its range, here and in its methods.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> response = Follower(frequency=20, damping=0.05).response(smoothstep(4))
    >>> response
    Response(frequency=20, damping=0.05, peak acceleration=10.254, residual acceleration=1.65015)
    >>> response(0.5), response.residual_displacement
    (0.489570, 0.004125)
    """

    frequency: float
    damping: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "frequency", circular_frequency(self.frequency))
        object.__setattr__(self, "damping", not_negative(self.damping, "damping"))

    @property
    def n(self) -> float:
        """Damping coefficient n = damping nu of (1.19)."""
        return self.damping * self.frequency

    @classmethod
    def from_units(cls, *, mass: float, stiffness: float, duration: float, damping: float = 0.0) -> Follower:
        """The follower of a machine; for a rotating one, moment of inertia, torsional stiffness and damping.

        Parameters
        ----------
        mass
            Driven mass in kg, or moment of inertia in kg m².
        stiffness
            Stiffness of the link in N/m, or N m/rad.
        duration
            Duration of the rise in s.
        damping
            Viscous damping between mass and ground in N s/m, or N m s/rad; not the ratio.

        Examples
        --------
        >>> Follower.from_units(mass=2.0, stiffness=80e3, duration=0.1, damping=40.0)
        Follower(frequency=20.0, damping=0.05)
        """
        m, kappa = positive(mass, "mass"), positive(stiffness, "stiffness")
        h = not_negative(damping, "damping")
        time = positive(duration, "duration")
        check_scale(time, "s", "duration", duration)
        return cls(time * sqrt(kappa / m), h / (2.0 * sqrt(kappa * m)))

    @classmethod
    def from_speed(
        cls, *, speed_rpm: float, rise_angle_deg: float, natural_period: float, damping: float = 0.0
    ) -> Follower:
        """The follower at a speed of the cam: nu = 60 phi / (speed natural_period), phi in radians (1.26).

        Parameters
        ----------
        speed_rpm
            Revolutions of the cam per minute.
        rise_angle_deg
            Angle of the cam during the rise, degrees.
        natural_period
            Period of the undamped free vibration, s.
        damping
            Ratio zeta.

        Examples
        --------
        >>> Follower.from_speed(speed_rpm=105, rise_angle_deg=120, natural_period=0.06, damping=0.05)
        Follower(frequency=19.9466, damping=0.05)
        """
        turn = positive(speed_rpm, "speed_rpm") * positive(natural_period, "natural_period")
        return cls(pi / 3.0 * positive(rise_angle_deg, "rise_angle_deg") / turn, damping)

    @classmethod
    def from_vibration(
        cls,
        vibration: Quantity,
        *,
        duration: Quantity | None = None,
        speed: NumberOrQuantity | None = None,
        rise: NumberOrQuantity | None = None,
        damping: float = 0.0,
    ) -> Follower:
        """The follower of a machine, from quantities with their units; `Response.in_units` gives its answers in units.

        Parameters
        ----------
        vibration
            Frequency or period of the undamped free vibration of the mass on its cam: "16.7 Hz" or "60 ms".
        duration
            Duration of the rise, such as "0.1 s".
        speed, rise
            In place of it: speed of the cam, such as "105 rpm", and its angle during the rise, such as "120 deg".
        damping
            Damping ratio zeta of the follower.

        Examples
        --------
        >>> Follower.from_vibration("16.7 Hz", speed="105 rpm", rise="120 deg", damping=0.05)
        Follower(frequency=19.986513, damping=0.05)
        >>> Follower.from_vibration("16.7", duration="0.1 s")
        Traceback (most recent call last):
        optlaws.errors.InputError: vibration must be a frequency such as '16.7 Hz' ... '16.7' without a unit: ...
        """
        dimension, number = either(vibration, ("frequency", "time"), "vibration")
        known = positive(number, "vibration")
        seconds = duration_of_rise(duration, speed, rise)
        return cls(tau * seconds * (known if dimension == "frequency" else 1.0 / known), damping)

    def speed_rpm(self, *, rise_angle_deg: float, natural_period: float) -> float:
        """Speed of the cam, in revolutions per minute, at which a machine is this follower, as `from_speed` takes it.

        Examples
        --------
        >>> Follower(frequency=20).speed_rpm(rise_angle_deg=120, natural_period=0.06)
        104.72
        """
        angle, period = positive(rise_angle_deg, "rise_angle_deg"), positive(natural_period, "natural_period")
        return pi / 3.0 * angle / (self.frequency * period)

    def _repr_html_(self) -> str:
        from optlaws.shown.showing import drawing, facts, page

        nu, zeta = self.frequency, self.damping
        known = {"frequency": nu, "damping ratio": zeta, "n": self.n, "free vibrations in the rise": nu / tau}
        k = [i / _SHOWN for i in range(_SHOWN + 1)]
        decay = [exp(-self.n * place) * cos(nu * sqrt(max(0.0, 1.0 - zeta**2)) * place) for place in k]
        return page("Follower", facts(known), drawing("free vibration", k, decay))

    def report(self, cam: MotionLaw, reference: MotionLaw, machine: Mapping[str, Any]) -> Report:
        """Peaks and vibration on a cam, off its design too, beside the law meant for the mass.

        The entries of the `machine`, if there are any, are arguments of `Response.in_units`.

        Examples
        --------
        >>> from optlaws import savin
        >>> law = savin("III", 7.2)
        >>> [row.name for row in Follower(frequency=18).report(law, law, {}).facts][2:4]
        ['dynamic factor', 'acceleration in the rise']
        """
        response = self.response(cam)
        peaks = {"rise": response.peak(2), "dwell": response.dwell_peak(2)}
        left = {name: getattr(response, name) for name in ("residual_displacement", "residual_acceleration")}
        factor = response.dynamic_factor(reference)
        known = response.in_units(**machine) | {"dynamic factor": factor} if machine else {}
        keys = ("percent", "frequency", "dynamic_factor", "residual_acceleration")
        off = [
            (each.percent, each.response.frequency, each.dynamic_factor, each.response.residual_acceleration)
            for each in off_design(cam, reference, self)
        ]
        data = {
            "frequency": self.frequency,
            "damping": self.damping,
            "dynamic_factor": factor,
            "peak_acceleration": peaks["rise"].to_dict(),
            "dwell_acceleration": peaks["dwell"].to_dict(),
            **left,
            "off_design": [dict(zip(keys, row, strict=True)) for row in off],
            "cam": {"constants": cam.constants.to_dict(rms=False), "law": cam.to_dict()},
            **({"machine": known} if known else {}),
        }
        facts = [
            Row("frequency", self.frequency),
            Row("damping ratio", self.damping),
            Row("dynamic factor", factor),
            *(Row(f"acceleration in the {where}", peak.value, place=peak.k) for where, peak in peaks.items()),
            *(Row(name.replace("_", " "), value) for name, value in reversed(left.items())),
            *(Row(name, value) for name, value in known.items() if name != "dynamic factor"),
            *(row._replace(name=f"{row.name} of the cam") for row in cam.constants.summary() if row.place is not None),
        ]
        headings = ("frequency off by", *(key.replace("_", " ") for key in keys[1:]))
        table = ReportTable(headings, [[f"{row[0]:+g} %" if row[0] else "0 %", *row[1:]] for row in off])
        return PlainReport(Summary(facts, at="k"), [table], (), lambda: data)

    def response(self, law: MotionLaw, *, initial: tuple[float, float] | None = None) -> Response:
        """Motion of the mass when the cam moves by `law` and rests afterwards.

        Parameters
        ----------
        law
            Motion of the cam.
        initial
            Displacement and velocity of the mass at k = 0; at rest on the cam unless given.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> Follower(frequency=20).response(smoothstep(4), initial=(0.01, 0.0))(0.0)
        0.01
        """
        cam = motion_law(law)
        pair = [float(cam.a(0.0)), 0.0] if initial is None else numbers(initial, "initial")
        if len(pair) != 2:
            raise InputError(f"initial must be displacement and velocity of the mass, got {shortened(initial)}")
        return Response(self.frequency, self.damping, cam, (pair[0], pair[1]))

    def cycle(
        self, rise: MotionLaw, fall: MotionLaw | None = None, *, dwell: float, fall_duration: float = 1.0, rest: float
    ) -> CycleResponse:
        """Steady motion of the mass when the cam rises, dwells, returns and rests again and again.

        Parameters
        ----------
        rise
            Motion of the cam during 0 <= k <= 1.
        fall
            Law of the return, run from its end of the rise as a(1) - (fall(k) - fall(0)); the rise's own unless given.
        dwell, rest
            Durations of the upper and of the lower dwell, in durations of the rise; 0 or more.
        fall_duration
            Duration of the return, in durations of the rise.

        Raises
        ------
        InputError
            If a duration is out of range, the return does not lead back, or the follower is undamped and in resonance
            with the cycle.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> steady = Follower(frequency=20, damping=0.05).cycle(smoothstep(4), dwell=0.5, rest=1.0)
        >>> steady.period, round(steady(0.0) - steady(3.5), 12)
        (3.5, 0.0)
        """
        return CycleResponse(
            self.frequency, self.damping, rise, rise if fall is None else fall, dwell, fall_duration, rest
        )


Change = Literal["speed", "stiffness"]

DEVIATIONS = (-10.0, -5.0, 0.0, 5.0, 10.0)


@dataclass(frozen=True)
class Deviation:
    """A follower off its design and its response.

    Parameters
    ----------
    percent
        Change of the frequency in percent of the design's.
    response
        What the mass does.
    reference
        The law meant for the mass.

    Examples
    --------
    >>> from optlaws import savin
    >>> worst = off_design(savin("III", 7.2), savin("III", 7.2), Follower(frequency=20))[0]
    >>> worst.percent, worst.dynamic_factor
    (-10.0, 2.035976)
    """

    percent: float
    response: Response
    reference: MotionLaw

    @property
    def dynamic_factor(self) -> float:
        """max |a_m''| of the rise over C of the reference."""
        return self.response.dynamic_factor(self.reference)

    @property
    def peak(self) -> Peak:
        """max |a_m''| of the rise and its place."""
        return self.response.peak(2)


def off_design(
    cam: MotionLaw,
    reference: MotionLaw,
    design: Follower,
    *,
    deviations: Sequence[float] = DEVIATIONS,
    change: Change = "speed",
) -> tuple[Deviation, ...]:
    """Responses to one cam of followers whose frequency deviates from the design's.

    The frequency nu = T sqrt(stiffness/mass) falls by as many percent as the speed rises, to first order, and by half
    as many as the stiffness falls. A change of speed leaves the damping ratio as it is, one of stiffness n = h T / 2
    mass.

    Parameters
    ----------
    cam
        Law of the cam.
    reference
        Law meant for the mass, whose C the dynamic factor refers to.
    design
        The follower for which the cam was designed.
    deviations
        Changes of the frequency in percent, above -100.
    change
        "speed" keeps the damping ratio, "stiffness" keeps n.

    Raises
    ------
    InputError
        If an argument is out of range or unknown.

    Examples
    --------
    >>> from optlaws import polydyne, savin
    >>> law = savin("IV", 11.0)
    >>> off = off_design(polydyne(law, frequency=20), law, Follower(frequency=20))
    >>> [round(deviation.dynamic_factor, 6) for deviation in off]
    [1.185564, 1.102502, 1.0, 0.963659, 0.945973]
    """
    meant = motion_law(reference, "reference")
    percents = numbers(list(deviations), "deviations")
    if min(percents, default=0.0) <= -100.0:
        raise InputError(
            f"deviations are changes of the frequency in percent and must be above -100, got {min(percents):g}"
        )
    if change not in ("speed", "stiffness"):
        raise InputError(f'change must be "speed" or "stiffness", got {shortened(change)}')
    compared = []
    for percent in percents:
        factor = 1.0 + percent / 100.0
        ratio = design.damping if change == "speed" else design.damping / factor
        compared.append(Deviation(percent, Follower(design.frequency * factor, ratio).response(cam), meant))
    return tuple(compared)
