"""Toothed clutches of balancing mechanisms: tooth counts with which the halves meet without a shock."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import inf, tau

from optlaws.balancing.dwells.mechanism import DwellMechanism
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.numbers import MOST_TEETH, whole


@dataclass(frozen=True, slots=True)
class Teeth:
    """A clutch of N teeth whose halves part and meet again p pitches further on.

    Attributes
    ----------
    p, N
        Whole pitches, and teeth.
    error
        Angle by which the halves miss each other, loader ahead, radians.
    swing, dwell, rise
        Values that would make it exact, each with all else as it is, radians; None where none does.
    B2
        For type III, peak velocity of the law of run-out and run-up that would make it exact; None where none does.
    """

    p: int
    N: int
    error: float
    swing: float | None
    dwell: float | None
    rise: float | None
    B2: float | None


@dataclass(frozen=True)
class Clutch:
    """The condition that the teeth of a clutch meet, for a mechanism of type II or III (eq. 27 to 35).

    Parameters
    ----------
    mechanism
        The mechanism; its clutch parts and meets once in each dwell.
    lower
        Whether the lower dwell is meant.

    Raises
    ------
    InputError
        If the mechanism is of type I, which has no clutch, or does not dwell there.

    Examples
    --------
    >>> from optlaws import catalogue, deg, dwell_mechanism
    >>> K = catalogue["K"].law
    >>> angles = dict(dwell=deg(90), rise=deg(90), clutch_angle=deg(15), swing=deg(20))
    >>> clutch = Clutch(dwell_mechanism("II", law=K, radius_ratio=1.0, inertia_ratio=0.1, **angles))
    >>> clutch.ratio, 1 / clutch.ratio
    (0.087266, 11.459156)
    >>> best = clutch.nearest(most=120)
    >>> best.p, best.N, round(best.error, 6)
    (9, 103, -0.000705)
    """

    mechanism: DwellMechanism
    lower: bool = False

    def __post_init__(self) -> None:
        if self.mechanism.kind == "I":
            raise InputError("mechanism must be of type II or III: type I has no clutch")
        if self._dwell == 0.0:
            raise InputError("lower must be False: the mechanism has no lower dwell")

    @property
    def loader_turn(self) -> float:
        """Angle that the free loader turns through while the clutch is open, radians (eq. 29)."""
        mechanism = self.mechanism
        return mechanism.swing * mechanism.speed * mechanism.free(self._dwell)

    @property
    def rocker_turn(self) -> float:
        """Angle that the rocker turns through meanwhile, radians (eq. 28 for type II, 25 for type III)."""
        mechanism = self.mechanism
        return mechanism.swing * (-2.0 * mechanism.S_sp if mechanism.kind == "II" else mechanism.S2)

    @kept_property
    def ratio(self) -> float:
        """The ratio p/N at which teeth meet: the difference of these angles in turns (eq. 33 for II, 35 for III)."""
        return (self.loader_turn - self.rocker_turn) / tau

    def nearest(self, most: int = 120) -> Teeth:
        """The p/N nearest to the given one among clutches of at most this many teeth; p = 0 where 1/N is too large.

        Parameters
        ----------
        most
            Greatest number of teeth.

        Raises
        ------
        InputError
            If `most` is not a whole number above 0.
        """
        fraction = Fraction(self.ratio).limit_denominator(
            whole(most, "the whole number most", least=1, most=MOST_TEETH)
        )
        return self.teeth(fraction.numerator, fraction.denominator)

    def choices(self, least: int, most: int) -> tuple[Teeth, ...]:
        """The best p for each number of teeth in a range, the most exact clutch first; clutches with p = 0 are omitted.

        Parameters
        ----------
        least, most
            Range of the number of teeth.

        Raises
        ------
        InputError
            If they are not whole numbers above 0.
        """
        counts = range(
            whole(least, "the whole number least", least=1, most=MOST_TEETH),
            whole(most, "the whole number most", least=1, most=MOST_TEETH) + 1,
        )
        pairs = ((round(self.ratio * N), N) for N in counts)
        teeth = [self.teeth(p, N) for p, N in pairs if p > 0]
        return tuple(sorted(teeth, key=lambda choice: (abs(choice.error), choice.N)))

    def teeth(self, p: int, N: int) -> Teeth:
        """A clutch of N teeth that meets p pitches later, its error, and the swing that would remove the error.

        Raises
        ------
        InputError
            If p is not a whole number of at least 0, or N not one above 0.
        """
        whole(p, "the whole number p")
        mechanism = self.mechanism
        target = p / whole(N, "the whole number N", least=1)
        share = target / self.ratio if self.ratio else inf
        possible = 0.0 < share < inf
        return Teeth(
            p=p,
            N=N,
            error=(self.ratio - target) * tau,
            swing=mechanism.swing * share if possible else None,
            dwell=self._exact_dwell(target) if possible else None,
            rise=mechanism.rise / share if possible else None,
            B2=self._exact_B2(target) if mechanism.kind == "III" else None,
        )

    @property
    def _dwell(self) -> float:
        return self.mechanism.lower_dwell if self.lower else self.mechanism.dwell

    def _exact_dwell(self, target: float) -> float | None:
        """p/N is linear in the dwell: for type II without a constant, for III beginning at its angles of rest."""
        mechanism = self.mechanism
        turn = mechanism.swing * mechanism.speed / tau
        if mechanism.kind == "II":
            return target / turn
        slack = 1.0 - 1.0 / mechanism.law_2.constants.B.value
        still = mechanism.free(self._dwell) - mechanism.phi2
        if slack == 0.0:
            return None
        dwell = 2.0 * mechanism.clutch_angle + still + (target / turn - still) / slack
        return dwell if dwell > 2.0 * mechanism.clutch_angle + still else None

    def _exact_B2(self, target: float) -> float | None:
        mechanism = self.mechanism
        left = (self.loader_turn - target * tau) / (mechanism.swing * mechanism.speed * mechanism.phi2)
        return 1.0 / left if 0.0 < left < 1.0 else None
