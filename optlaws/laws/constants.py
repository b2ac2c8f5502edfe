"""The constants of a law: its peaks B, C, D, J and the RMS of its acceleration, as one value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf
from typing import Any, Self

from optlaws.files.reading import JsonText, entries_of
from optlaws.numbers import bounded, finite
from optlaws.numerics.peaks import Peak
from optlaws.shown.summary import Row, Summary


@dataclass(frozen=True, slots=True)
class Constants(JsonText):
    """The constants of a law, dimensionless.

    Attributes
    ----------
    B, C, D, J
        Peaks of |b|, |c|, |d|, |j| over the whole interval.
    rms_c
        Root mean square of c.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> smoothstep(2).constants.C
    Peak(value=6.0, k=0.0)
    """

    _json_name = "constants"

    B: Peak
    C: Peak
    D: Peak
    J: Peak
    rms_c: float

    def to_dict(self, *, rms: bool = True) -> dict[str, dict[str, float | None] | float | None]:
        """B, C, D, J as {"value": ..., "k": ...}; rms_c too unless `rms` is False; None where a value has no bound.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> smoothstep(2).constants.to_dict()["B"]
        {'value': 1.5, 'k': 0.5}
        """
        table: dict[str, dict[str, float | None] | float | None] = {
            "B": self.B.to_dict(),
            "C": self.C.to_dict(),
            "D": self.D.to_dict(),
            "J": self.J.to_dict(),
        }
        if rms:
            table["rms_c"] = bounded(self.rms_c)
        return table

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """The constants that `to_dict` described, all five of them.

        Raises
        ------
        InputError
            If an entry is missing or no number.
        """
        entries = entries_of(data, ("B", "C", "D", "J", "rms_c"), cls._json_name)
        rms_c = entries.pop("rms_c")
        peaks = {name: Peak.from_dict(peak) for name, peak in entries.items()}
        return cls(**peaks, rms_c=inf if rms_c is None else finite(rms_c, "rms_c"))

    def summary(self) -> Summary:
        """The peaks with their places, and the root mean square of c, as rows.

        Examples
        --------
        >>> from optlaws import smoothstep
        >>> [row.name for row in smoothstep(2).constants.summary() if row.place == 0.0]
        ['C', 'J']
        """
        peaks = [Row(name, peak.value, place=peak.k) for name in "BCDJ" for peak in [getattr(self, name)]]
        return Summary([*peaks, Row("RMS of c", self.rms_c)], at="k")

    def _repr_html_(self) -> str:
        return self.summary()._repr_html_()
