"""A limit of the vibration that a move leaves in what it drives, whose number of vibrations grows with the time."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from optlaws.errors import InputError
from optlaws.files.reading import JsonText, all_entries_of
from optlaws.numbers import not_negative, positive
from optlaws.synthesis.least_time.motor_torque import TimedLimit
from optlaws.synthesis.problem.named_constants import named

_KEYS = ("lowest", "highest", "damping", "most")


@dataclass(frozen=True)
class FollowerResidual(JsonText):
    """The residual acceleration of an elastic follower after a move, and what it is at most.

    Attributes
    ----------
    lowest, highest
        Between which its natural circular frequency is, rad/s.
    damping
        Its damping ratio, below 1.
    most
        The greatest amplitude of its acceleration after the move, in units of the stroke a square second.

    Raises
    ------
    InputError
        If a number is out of range.

    Examples
    --------
    >>> FollowerResidual(95.0, 105.0, 0.05, most=0.4).limit_in(0.2, stroke=0.1)
    TimedLimit(name='residual acceleration', constant=residual(frequency=(19.0, 21.0), damping=0.05), bound=0.16)
    """

    lowest: float
    highest: float
    damping: float
    most: float

    _json_name = "the residual vibration of a move"

    def __post_init__(self) -> None:
        for name in ("lowest", "highest", "most"):
            object.__setattr__(self, name, positive(getattr(self, name), name))
        object.__setattr__(self, "damping", not_negative(self.damping, "damping"))
        if self.lowest > self.highest or self.damping >= 1.0:
            raise InputError("the frequencies of a follower must be in order, and its damping below 1")

    def limit_in(self, duration: float, stroke: float) -> TimedLimit:
        """The limit of a law with the stroke 1 in a time."""
        low, high = (frequency * duration for frequency in (self.lowest, self.highest))
        spread = repr(low) if low == high else f"({low!r}, {high!r})"
        constant = named(f"residual(frequency={spread}, damping={self.damping!r})")
        return TimedLimit("residual acceleration", constant, self.most * duration * duration / stroke)

    def to_dict(self) -> dict[str, Any]:
        """The follower and the limit as plain data."""
        return asdict(self)

    @classmethod
    def from_dict(cls, data: Any) -> FollowerResidual:  # noqa: ANN401 - it is checked here
        """The limit that `to_dict` described.

        Raises
        ------
        InputError
            If an entry is missing or wrong.
        """
        return cls(**all_entries_of(data, _KEYS, cls._json_name))
