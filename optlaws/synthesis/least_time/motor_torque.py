"""Limits of the torque at a motor in a move whose time is sought: formulas of the law, which depend on the time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

from optlaws.errors import InputError
from optlaws.files.reading import JsonText, all_entries_of
from optlaws.formulas.reading import read
from optlaws.formulas.slopes import constant
from optlaws.laws import smoothstep
from optlaws.numbers import not_negative, positive
from optlaws.synthesis.functionals.makers import drive_torque, peak, rms
from optlaws.synthesis.problem.constants import Functional

_KEYS = ("inertia", "friction", "load", "unit", "peak", "rms")
#: a law that passes every position, in which a load over the position is as great as it ever is
_PASSING = smoothstep(2)


class TimedLimit(NamedTuple):
    """A limit of a law in a time: its name, the constant of the law and what it is at most."""

    name: str
    constant: Functional
    bound: float


@dataclass(frozen=True)
class MotorTorque(JsonText):
    """The torque I(a) c + I'(a) b²/2 + f b + L(a) at the motor of a move that takes 1 s, and its limits.

    In the time T the inertia's part is that over T², the friction's that over T, and the load stays. Friction that does
    not depend on the speed is part of the load: laws never turn back.

    Attributes
    ----------
    inertia, load
        I and L as formulas of a.
    friction
        f, of the viscous friction, at least 0.
    unit
        Of the torque, N m.
    peak, rms
        Limits of its greatest magnitude and of its root mean square over the move, N m; None where there is none.

    Raises
    ------
    InputError
        If a formula or a number is wrong, there is no limit, or the load alone is above it.

    Examples
    --------
    >>> MotorTorque("1 + 0.3*a", 0.0, "0.2", unit=2.0, peak=3.0).limits_in(0.5)
    (TimedLimit(name='torque', constant=peak((1 + 0.3*a)*c + 0.15*b^2 + 0.25*0.2), bound=0.375),)
    """

    inertia: str
    friction: float
    load: str
    unit: float
    peak: float | None = None
    rms: float | None = None

    _json_name = "the torque of a move"

    def __post_init__(self) -> None:
        for name in ("inertia", "load"):
            text = getattr(self, name)
            if not isinstance(text, str):
                raise InputError(f"{name} must be the text of a formula of a, got {text!r}")
            read(text, ("a",))
        object.__setattr__(self, "friction", not_negative(self.friction, "friction"))
        for name in ("unit", "peak", "rms"):
            if name == "unit" or getattr(self, name) is not None:
                object.__setattr__(self, name, positive(getattr(self, name), name))
        if self.peak is None and self.rms is None:
            raise InputError("the torque of a move needs a limit: of its peak or its root mean square")
        if self.peak is not None and self.static >= self.peak:
            raise InputError(
                f"the static torque at the motor reaches {self.static:.6g} N m, and the limit of the torque is "
                f"{self.peak:.6g} N m: no time keeps it"
            )

    @property
    def static(self) -> float:
        """The greatest magnitude of the torque in an infinitely slow motion, N m."""
        known = constant(read(self.load, ("a",)))
        return self.unit * (abs(known) if known is not None else peak(self.load).value(_PASSING))

    @property
    def grows_possible(self) -> bool:
        """Whether a law that keeps the limits in a time keeps them in every longer time: docs/theory/least-time.md."""
        load = constant(read(self.load, ("a",)))
        of_peak = self.peak is None or self.friction == 0.0 or load is not None
        of_rms = self.rms is None or (load is not None and (self.friction == 0.0 or load >= 0.0))
        return of_peak and of_rms and constant(read(self.inertia, ("a",))) is not None

    def text(self, duration: float) -> str:
        """T² times the torque in the time T, in its unit: the inertia's part stays as it is."""
        load = read(self.load, ("a",))
        weighed = "0" if constant(load) == 0.0 else f"{duration * duration!r}*({self.load})"
        return drive_torque(inertia=self.inertia, friction=repr(self.friction * duration), load=weighed)

    def limits_in(self, duration: float) -> tuple[TimedLimit, ...]:
        """The limits in a time: bounds of T² times the torque."""
        text, factor = self.text(duration), duration * duration / self.unit
        known = (("torque", peak, self.peak), ("rms torque", rms, self.rms))
        return tuple(TimedLimit(name, make(text), limit * factor) for name, make, limit in known if limit is not None)

    def to_dict(self) -> dict[str, Any]:
        """The formulas, the unit and the limits as plain data."""
        return {name: getattr(self, name) for name in _KEYS}

    @classmethod
    def from_dict(cls, data: Any) -> MotorTorque:  # noqa: ANN401 - it is checked here
        """The torque that `to_dict` described.

        Raises
        ------
        InputError
            If an entry is missing or wrong.
        """
        return cls(**all_entries_of(data, _KEYS, cls._json_name))
