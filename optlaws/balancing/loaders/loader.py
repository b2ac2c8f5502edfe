"""Inertial loaders: masses driven by a balancing cam that take up the kinetic energy an executive link gives off."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, isfinite, sqrt
from typing import Any, Self

from optlaws.balancing.loaders.law import LoaderLaw
from optlaws.balancing.loaders.tops import is_symmetric, tops
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import JsonText, entries_of
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.law import motion_law
from optlaws.motion.quantities import quantity
from optlaws.numbers import NumberOrQuantity, bounded, real
from optlaws.tolerances import AGREEMENT

_LOADER_TERM = 1e-13  # of C squared: a smaller product of velocity and jerk is rounding


@dataclass(frozen=True, repr=False)
class Loader(JsonText):
    """The inertial loader that balances an executive law: its energy parameter Y, its law and its peaks.

    Executive link and loader together keep one kinetic energy, so each gives the power that the other takes:
    d_l = -Y² d (eq. 1). Everything is dimensionless but for `mass` and `stroke`.

    Parameters
    ----------
    executive
        The executive law.

    Raises
    ------
    InputError
        If the law has no loader: its peak velocity lies at k = 0 or 1, or is reached an even number of times.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> balanced = Loader(smoothstep(3))
    >>> balanced
    Loader(Y=0.754567, B=1.41481, C=5.65925, D=3.81152)
    >>> balanced.law.b([0.0, 0.5, 1.0]).round(6).tolist()
    [1.414812, 0.0, -1.414812]
    """

    _json_name = "a loader"

    executive: MotionLaw

    def __post_init__(self) -> None:
        object.__setattr__(self, "executive", motion_law(self.executive))
        tops(self.executive)

    @kept_property
    def law(self) -> LoaderLaw:
        """The loader's motion over the k of the executive law."""
        return LoaderLaw(self.executive)

    @property
    def Y(self) -> float:
        """Energy parameter; Y² is the ratio of the moving masses times their strokes squared (eq. 2)."""
        return self.law.Y

    @kept_property
    def B(self) -> float:
        """Peak velocity; Y B of the executive law where that stands still somewhere."""
        return self.law.peak(1).value

    @kept_property
    def C(self) -> float:
        """Peak acceleration over the whole interval; inf where the executive acceleration jumps at its turn."""
        return self.law.peak(2).value

    @kept_property
    def D(self) -> float:
        """Peak power, Y² D of the executive law, with the opposite sign of it at every k."""
        return self.law.power_peak().value

    @kept_property
    def turn(self) -> float:
        """The k at which the loader reverses: 1/2 for symmetric laws."""
        places = tops(self.executive)
        return places[len(places) // 2].first

    @kept_property
    def C_at_turn(self) -> float:
        """Acceleration where the loader reverses, Y sqrt(B |j|) with the executive B and j there; at most C.

        The paper gives it for the peak, which it is only where the acceleration is greatest at the turn.
        """
        c, j = abs(self.executive.c(self.turn)), abs(self.executive.j(self.turn))
        B, C = (self.executive.peak(nu).value for nu in (1, 2))
        if c > AGREEMENT * C or not isfinite(j):
            return inf
        return self.Y * sqrt(B * j) if B * j > _LOADER_TERM * C * C else 0.0

    @property
    def peaks_at_turn(self) -> bool:
        """Whether C is reached at the turn, so that the paper's formula gives it."""
        return self.C_at_turn == self.C or abs(self.C_at_turn / self.C - 1.0) <= AGREEMENT

    @kept_property
    def symmetric(self) -> bool:
        """Whether the executive law is symmetric, so that the loader is back at its start after the motion.

        If it is not, it is back after a return that runs the same law, s = h (1 - a(k)), and not after one that
        runs it backwards in time.
        """
        return is_symmetric(self.executive)

    def mass(
        self, *, executive_mass: NumberOrQuantity, executive_stroke: NumberOrQuantity, stroke: NumberOrQuantity
    ) -> float:
        """Mass of the loader for a stroke of its own (eq. 2).

        Parameters
        ----------
        executive_mass, executive_stroke
            Moving mass, "2.5 kg", and stroke, "40 mm", of the executive link; or moment of inertia and swing. Numbers
            are in kg and m, or kg m² and rad.
        stroke
            Stroke of the loader, from one extreme to the other, likewise.

        Returns
        -------
        Mass in kg, or moment of inertia in kg m².

        Raises
        ------
        InputError
            If a quantity is not positive and finite.

        Examples
        --------
        >>> from optlaws import catalogue
        >>> inertial_loader(catalogue["K"].law).mass(executive_mass="2.5 kg", executive_stroke="40 mm", stroke=0.020)
        10.0
        """
        mass, h, h_loader = _sizes(executive_mass=executive_mass, executive_stroke=executive_stroke, stroke=stroke)
        return mass * (h / (self.Y * h_loader)) ** 2

    def stroke(
        self, *, executive_mass: NumberOrQuantity, executive_stroke: NumberOrQuantity, mass: NumberOrQuantity
    ) -> float:
        """Stroke of a loader of some mass (eq. 2).

        Parameters
        ----------
        executive_mass, executive_stroke
            As of `mass`.
        mass
            Mass of the loader, or its moment of inertia.

        Returns
        -------
        Stroke from one extreme to the other, m or rad; in the unit of the executive stroke where that is a number.

        Raises
        ------
        InputError
            If a quantity is not positive and finite.

        Examples
        --------
        >>> from optlaws import catalogue
        >>> inertial_loader(catalogue["K"].law).stroke(executive_mass=2.5, executive_stroke=0.040, mass=10.0)
        0.02
        """
        executive, h, moved = _sizes(executive_mass=executive_mass, executive_stroke=executive_stroke, mass=mass)
        return h / self.Y * sqrt(executive / moved)

    def to_dict(self) -> dict[str, Any]:
        """Y, the peaks and the law as plain data; a peak without bound is None."""
        return {
            "Y": self.Y,
            "constants": {
                name: peak.to_dict()
                for name, peak in (
                    ("B", self.law.peak(1)),
                    ("C", self.law.peak(2)),
                    ("D", self.law.power_peak()),
                    ("J", self.law.peak(3)),
                )
            },
            "C_at_turn": bounded(self.C_at_turn),
            "peaks_at_turn": self.peaks_at_turn,
            "turn": self.turn,
            "symmetric": self.symmetric,
            "law": self.law.to_dict(),
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """The loader that `to_dict` described, of its law alone; all else is computed.

        Raises
        ------
        InputError
            If there is no law of a loader.
        """
        return cls(LoaderLaw.from_dict(entries_of(data, ("law",), cls._json_name)["law"]).executive)

    def __repr__(self) -> str:
        return f"Loader(Y={self.Y:g}, B={self.B:g}, C={self.C:g}, D={self.D:g})"


def inertial_loader(law: MotionLaw) -> Loader:
    """The inertial loader that balances the inertia of a link moving by a law (eq. 1, 2).

    Parameters
    ----------
    law
        The executive law: any law with its peak velocity inside the motion, symmetric or not.

    Raises
    ------
    InputError
        If the peak velocity lies at k = 0 or 1, or is reached an even number of times: the loader reverses there.

    Examples
    --------
    >>> from optlaws import catalogue
    >>> balanced = inertial_loader(catalogue["0317(1,5)"].law)
    >>> balanced, balanced.C_at_turn, balanced.peaks_at_turn
    (Loader(Y=1.07323, B=1.66389, C=4.9574, D=5.51213), 0.0, False)
    """
    return Loader(law)


def _sizes(**given: NumberOrQuantity) -> list[float]:
    sizes = []
    for name, value in given.items():
        kinds = ("length", "angle") if name.endswith("stroke") else ("mass", "moment of inertia")
        number = real(quantity(value, kinds, name, bare=True))
        if number is None or not 0.0 < number < inf:
            raise InputError(f"{name} must be positive and finite, got {shortened(value)}")
        sizes.append(number)
    return sizes
