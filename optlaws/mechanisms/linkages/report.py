"""The report of a mechanism: its inertia and its load over the input, and the joints of its linkage."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from optlaws.formulas.arithmetic import NUMPY, evaluate
from optlaws.mechanisms.linkages.mechanism import Mechanism
from optlaws.motion.quantities import DEGREES, MILLI
from optlaws.numbers import Array
from optlaws.shown.report import Panel, Series

_POSITIONS = 721
_TURN, _TENTH = 2.0 * np.pi, 0.1
#: by what the input is: its unit, how many of them make one of SI, and those of the inertia, of its slope, of the load
INPUTS = {
    "angle": ("deg", DEGREES, ("kg m²", "kg m²/rad", "N m")),
    "length": ("mm", MILLI, ("kg", "kg/m", "N")),
}


@dataclass(frozen=True)
class MechanismReport:
    """The report of a mechanism; where its input has no ends, over what is `used` of it, else a turn or 0.1 m."""

    mechanism: Mechanism
    used: tuple[float, float] | None = None

    @property
    def positions(self) -> Array:
        """Positions of the input at which it is drawn, rad or m."""
        mechanism = self.mechanism
        usual = self.used or (0.0, _TURN if mechanism.axis == "angle" else _TENTH)
        return np.linspace(*(mechanism.over if mechanism.has_end else usual), _POSITIONS)

    @property
    def panels(self) -> tuple[Panel, ...]:
        """The inertia J, its slope J' and the load T over the input, which is in degrees or millimetres."""
        x, (of_input, factor, units) = self.positions, INPUTS[self.mechanism.axis]
        values = self.mechanism.inertia(x), self.mechanism.inertia(x, 1), self.mechanism.load(x)
        return tuple(
            Panel(name, unit, (Series(factor * x, np.asarray(curve)),), (), (), ends, f"input, {of_input}", 1.0)
            for name, unit, curve in zip(("J", "J'", "T"), units, values, strict=True)
            for ends in [(float(np.min(curve)), float(np.max(curve)))]
        )

    def chains(self, x: Array) -> list[Array]:
        """The joints of each chain of links at positions of the input, in mm, of shape (joints, 2, positions)."""
        return [
            MILLI * np.array([[evaluate(part, {"x": x}, NUMPY) + 0.0 * x for part in point] for point in chain])
            for chain in self.mechanism.linkage.chains
        ]

    @property
    def moving(self) -> list[list[bool]]:
        """Which joints of each chain move."""
        chains = self.mechanism.linkage.chains
        return [[bool(point[0].names() | point[1].names()) for point in chain] for chain in chains]
