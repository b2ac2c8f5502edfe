"""The constants of a law: its peaks B, C, D, J and the RMS of its acceleration, as one value."""

from __future__ import annotations

from dataclasses import dataclass

from optlaws.numbers import bounded
from optlaws.numerics.peaks import Peak
from optlaws.shown.summary import Row, Summary


@dataclass(frozen=True, slots=True)
class Constants:
    """The constants of a law, dimensionless.

    Attributes
    ----------
    B, C, D, J
        Peaks of |b|, |c|, |d|, |j| over the whole interval.
    rms_c
        Root mean square of c.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> smoothstep(2).constants.C
    Peak(value=6.0, k=0.0)
    """

    B: Peak
    C: Peak
    D: Peak
    J: Peak
    rms_c: float

    def to_dict(self, *, rms: bool = False) -> dict[str, dict[str, float | None] | float | None]:
        """B, C, D, J as {"value": ..., "k": ...}; rms_c too where `rms`; None where a value has no bound.

        Examples
        --------
        >>> from optlaws.laws import smoothstep
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

    def summary(self) -> Summary:
        """The peaks with their places, and the root mean square of c, as rows.

        Examples
        --------
        >>> from optlaws.laws import smoothstep
        >>> [row.name for row in smoothstep(2).constants.summary() if row.place == 0.0]
        ['C', 'J']
        """
        peaks = [Row(name, peak.value, place=peak.k) for name in "BCDJ" for peak in [getattr(self, name)]]
        return Summary([*peaks, Row("RMS of c", self.rms_c)], at="k")

    def _repr_html_(self) -> str:
        return self.summary()._repr_html_()
