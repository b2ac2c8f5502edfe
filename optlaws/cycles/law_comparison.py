"""Laws side by side: their constants, their peaks in a machine, residual vibration, and the price of a small C."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import Any

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, ValueOf, declared, entry
from optlaws.entries.value_types import Either, Number, Table, Text, Together, is_list
from optlaws.errors import InputError, needed
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.reading import read_law
from optlaws.laws.law import motion_law
from optlaws.mechanisms.machine.residual import residual_vibration
from optlaws.motion.piece import factor, unit_of
from optlaws.motion.quantities import TURN, check_scale, either, quantity, written
from optlaws.numbers import NumberOrQuantity, Quantity, bounded, positive
from optlaws.tolerances import AGREEMENT

#: what is more than so many times as great is far above
_FAR = 1.5
_MACHINE = {1: "velocity, {}/s", 2: "acceleration, {}/s²", 3: "jerk, {}/s³"}
#: what moves, and what moves it, by the unit of the stroke
_MASS = {"m": ("mass", "force, N"), "rad": ("moment of inertia", "torque, N m")}


@declared
class Comparison(Declared, title="a comparison"):
    """Laws with their constants, computed by `compare_laws`; a row for each law.

    Examples
    --------
    >>> from optlaws import compare_laws
    >>> comparison = compare_laws("modified sine", "cycloidal")
    >>> [row["law"] for row in comparison.rows], [round(row["C"], 4) for row in comparison.rows]
    (['modified sine', 'cycloidal'], [5.528, 6.2832])
    """

    writes_defaults = True
    computes = True

    laws: Mapping[str, MotionLaw] = entry(Table(ValueOf(MotionLaw)), "The laws by their names, in the order given.")
    stroke: float | None = entry(
        Number(), "Of the machine, m or rad; peaks stay dimensionless unless given.", default=None
    )
    duration: float | None = entry(Number(), "Of the machine, s.", default=None)
    unit: str = entry(Text(), 'That of the stroke, "m" or "rad".', default="m")
    frequency: float | tuple[float, float] | None = entry(
        Either(Number(), Together(Number(), Number(), names=("low", "high")), which=is_list),
        "Of the follower whose residual acceleration is listed, in units of a''.",
        default=None,
    )
    damping: float = entry(Number(), "Its damping ratio.", default=0.0)
    mass: float | None = entry(
        Number(), "What moves, kg or kg m²; force, or torque, and power are listed for it.", default=None
    )

    def _check(self) -> None:
        _ = self.rows  # what is wrong is refused at once

    @kept_property
    def rows(self) -> list[dict[str, float | str]]:
        """A row for each law, by the names of the columns."""
        return [{"law": name} | self._row(law) for name, law in self.laws.items()]

    @property
    def remarks(self) -> tuple[str, ...]:
        """The costs of laws of smaller C than the first, where they are more than half as much again."""
        (first, reference), *others = self.laws.items()
        return tuple(
            f"{name}: {cost}"
            for name, law in others
            for cost in costs(law, reference, first, frequency=self.frequency, damping=self.damping)
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict; None where a peak has no bound. Rows and remarks follow from the rest."""
        rows = [
            {key: value if isinstance(value, str) else bounded(value) for key, value in row.items()}
            for row in self.rows
        ]
        return {"rows": rows, "remarks": list(self.remarks), **super().to_dict()}

    def to_pandas(self) -> Any:
        """The rows as a data frame with the laws' names as index; needs the extra `optlaws[studies]`."""
        pd = needed("pandas", "to_pandas")
        return pd.DataFrame(self.rows).set_index("law")

    def plot(self, ax: Any = None, **style: Any) -> list[Any]:
        """Draw a, b, c and j of all laws, one over the other, into four axes of matplotlib; the artists."""
        from optlaws.plots.law import draw_comparison

        return draw_comparison(self, ax, **style)

    def _repr_html_(self) -> str:
        from optlaws.shown.report import panel_drawing
        from optlaws.shown.showing import Html, page, table

        shown = (Html("".join(map(panel_drawing, law.report().panels))) for law in self.laws.values())
        rows = [[*row.values(), drawings] for row, drawings in zip(self.rows, shown, strict=True)]
        return page("Comparison", table((*self.rows[0], "a, b, c, d, j"), rows))

    def _row(self, law: MotionLaw) -> dict[str, float]:
        constants = law.constants
        row = {name: float(getattr(constants, name).value) for name in "BCDJ"} | {"rms_c": constants.rms_c}
        if self.stroke is not None and self.duration is not None:
            row |= {
                text.format(self.unit): factor(self.stroke, self.duration, nu) * law.peak(nu).value
                for nu, text in _MACHINE.items()
            }
            if self.mass is not None:
                h, T = self.stroke, self.duration
                row[_MASS[self.unit][1]] = self.mass * constants.C.value * h / T**2
                row["power, W"] = self.mass * constants.D.value * h**2 / T**3
        if self.frequency is not None:
            row["residual"] = residual_vibration(frequency=self.frequency, damping=self.damping).value(law)
        return row


def compare_laws(
    *laws: Any,
    stroke: Quantity | None = None,
    duration: Quantity | None = None,
    frequency: NumberOrQuantity | tuple[NumberOrQuantity, NumberOrQuantity] | None = None,
    damping: float = 0.0,
    mass: Quantity | None = None,
) -> Comparison:
    """Constants and machine values of several laws beside each other.

    Parameters
    ----------
    laws
        Each a law, what has one (an entry of the catalogue, a solution), or a text that names one: a name of the
        catalogue, a member such as "III(7.2)", a JSON or CSV file.
    stroke, duration
        Stroke and duration with their units, such as "35 mm" (or "45 deg") and "0.1 s", for the peaks in the machine:
        v = B h/T, a = C h/T², j = J h/T³.
    frequency
        Frequency of an elastic follower, such as "12 Hz" beside the duration, or as a number nu: the radians of its
        free vibration in the motion; or an interval (low, high). The greatest residual acceleration is listed too.
    damping
        Damping ratio of the follower.
    mass
        Mass that moves, or moment of inertia that turns, such as "2.5 kg": the greatest force, or torque, and power of
        its acceleration are listed; with stroke and duration.

    Raises
    ------
    InputError
        If there is no law, one cannot be read, or a number is out of range.

    Examples
    --------
    >>> comparison = compare_laws("modified sine", "cycloidal", stroke="35 mm", duration="0.1 s", frequency=20)
    >>> [round(row["acceleration, m/s²"], 3) for row in comparison.rows]
    [19.348, 21.991]
    >>> compare_laws("cycloidal", duration="0.1 s", frequency=("12 Hz", "15 Hz")).frequency
    (7.539822, 9.424778)
    """
    if not laws:
        raise InputError("no laws to compare are given: name some, such as 'modified sine' and 'law.json'")
    if (duration is None and stroke is not None) or (stroke is None and duration is not None and frequency is None):
        raise InputError("stroke and duration go together: the peaks in the machine need both")
    kind, height = ("length", None) if stroke is None else either(stroke, ("length", "angle"), "stroke")
    seconds = None if duration is None else positive(quantity(duration, "time", "duration"), "duration")
    if height is not None:
        if not height > 0.0:
            given = shortened(stroke)
            raise InputError(f"stroke must be above 0, got {given}: give how far the machine moves as '35 mm'")
        check_scale(height, unit_of(kind), "stroke", stroke)
    unit = unit_of(kind)
    if mass is not None and height is None:
        raise InputError("mass goes with stroke and duration: the force depends on the peaks in the machine")
    moved = None if mass is None else positive(quantity(mass, _MASS[unit][0], "mass"), "mass")
    named: dict[str, MotionLaw] = {}
    for place, law in enumerate(laws, 1):
        name = law if isinstance(law, str) else getattr(law, "name", f"law {place}")
        if name in named:
            raise InputError(f"{name} is given twice")
        named[name] = read_law(law) if isinstance(law, str) else motion_law(law)
    phase: Any = frequency
    phase = [_phase(each, seconds) for each in phase] if isinstance(phase, list | tuple) else _phase(phase, seconds)
    return Comparison(named, height, None if height is None else seconds, unit, phase, damping, moved)


def _phase(frequency: Any, seconds: float | None) -> Any:
    """The radians of a free vibration in a motion, of a frequency with a unit."""
    if not isinstance(written(frequency), str):
        return frequency
    rate = quantity(frequency, "frequency", "frequency", above=0.0)
    if seconds is None:
        raise InputError(
            f"a frequency with a unit needs the duration of the motion: give duration='0.1 s' beside "
            f"{shortened(frequency)}, or its radians within the motion as a number"
        )
    return TURN * rate * seconds


def costs(
    law: MotionLaw,
    reference: MotionLaw,
    name: str,
    *,
    frequency: float | tuple[float, float] | None = None,
    damping: float = 0.0,
) -> list[str]:
    """The price of a C below a named standard law's C: power, jerk or vibration far above that law's values."""
    if not law.constants.C.value < reference.constants.C.value:
        return []
    values = {
        "D = ": (law.constants.D.value, reference.constants.D.value),
        "J = ": (law.constants.J.value, reference.constants.J.value),
    }
    if frequency is not None:
        of = residual_vibration(frequency=frequency, damping=damping)
        values["a residual acceleration of "] = of.value(law), of.value(reference)
    return [f"{what}{_cost(*each, name)}" for what, each in values.items() if each[0] > _FAR * each[1]]


def _cost(value: float, other: float, name: str) -> str:
    if not isfinite(value):
        return f"inf, without bound; that of {name} is {other:.4g}"
    if other <= AGREEMENT * value:
        return f"{value:.4g}; {name} has none"
    return f"{value:.4g}, {value / other:.3g} times that of {name}"
