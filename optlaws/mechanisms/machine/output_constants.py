"""Peaks and root mean squares of a machine's outputs as constants of a law: affine in it, so they are convex."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from math import inf, nan, pi
from typing import Any, ClassVar

import numpy as np
from numpy.polynomial import legendre

from optlaws.echo import shortened
from optlaws.errors import InputError, OptlawsError
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw, smoothstep
from optlaws.laws.law import motion_law
from optlaws.mechanisms.machine import drives
from optlaws.mechanisms.machine.over_time import (
    MachineMotion,
    OutputCurve,
    RiseReturnCycle,
    around,
    jumps,
)
from optlaws.mechanisms.machine.state_space import (
    Panel,
    StateSpace,
    check_rest,
    machine_of,
    text_of,
    title_of,
)
from optlaws.numbers import Array, numbers, power_of_two
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, NormFamily
from optlaws.synthesis.families.piece_series import PieceSeries, widened
from optlaws.synthesis.functionals.makers import PeakSide
from optlaws.synthesis.functionals.sizes import size_bounds
from optlaws.synthesis.problem.constants import MAKERS, Functional
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.tolerances import CLOSURE, NEGLIGIBLE_TERM, SHORTEST_STRETCH, VALUE_ROUNDING

_LATEST = 100.0
_RADIANS = 40.0  # of the fastest vibration on one piece of the rows
_MOST_PANELS = 800  # of a cycle that repeats, some six vibrations long each
_SMOOTH = 4  # the order of the law that scales are taken from
_KNOWN = 3  # end conditions of which the acceleration is one
SIDES = {"both": (1.0, -1.0), "high": (1.0,), "low": (-1.0,)}
_SIDE = {signs: side for side, signs in SIDES.items()}


@dataclass(frozen=True, repr=False)
class OutputConstant(Functional):
    """The common part of constants of an output, with an offset added to it.

    Times `within` which it counts are in durations of the rise; the law rests from 1 on. A `cycle` is given by the
    dwell and the rest of rise, dwell, return and rest; where `steady`, the law is itself a whole cycle that repeats.
    """

    machine: StateSpace = field(compare=False)
    output: str = field(compare=False)
    within: tuple[float, float]
    cycle: tuple[float, float] | None
    steady: bool = False
    offset: float = 0.0

    def curve(self, given: MotionLaw) -> OutputCurve:
        """The output under a law with its offset, over all that counts and what is before it."""
        law, machine = motion_law(given), self.machine
        if self.steady:
            _check_repeats(self.name, machine, float(law.a(1.0)) - float(law.a(0.0)))
            motion = MachineMotion(machine.dynamics, machine.rows, drives.of_law(law), jumps=jumps(law))
        elif self.cycle is not None:
            cycle = RiseReturnCycle(law, law, self.cycle[0], 1.0, self.cycle[1])
            motion = MachineMotion.of_cycle(machine.dynamics, machine.rows, cycle)
        else:
            motion = MachineMotion.of_law(machine, law, max(0.0, self.within[1] - 1.0))
        return motion[self.output].plus(self.offset)

    #: what of the output it is, in words
    _what: ClassVar[str]
    normalised = True

    @kept_property
    def scale(self) -> float:
        """The size of the output under a smooth law, with its offset; a power of 2."""
        return _scale_of_output(self.machine, self.output, self.offset)

    @property
    def title(self) -> str:
        first, last = self.within
        words = [] if self.cycle is not None or self.within == (0.0, 1.0) else [f"times {first:g} to {last:g}"]
        words += [] if self.cycle is None else ["over a cycle with dwell {:g} and rest {:g}".format(*self.cycle)]
        words += ["steady"] if self.steady else []
        words += [f"{self.offset:+g}"] if self.offset else []
        return title_of(self.machine, self._what, self.output, *words)

    @property
    def duration(self) -> float:
        """The time that places are shares of."""
        return self.within[1]

    def where(self, k: float, part: int = 0) -> str:  # noqa: ARG002 - it has one
        return f"time {k * self.duration:.4g}"

    def sizes(self, space: LawSpace) -> tuple[tuple[int, float, float], ...]:
        return size_bounds(self, space)

    def _samples(self, space: LawSpace) -> Iterator[tuple[Array, Array]]:
        """Columns of the output at Gauss points of each panel that counts, and their weights."""
        for start, length, series in self.panels(space):
            x, weights = legendre.leggauss(len(series))
            inside = start + 0.5 * length * (x + 1.0) >= self.within[0]
            basis = np.polynomial.chebyshev.chebvander(x, len(series) - 1)
            yield basis[inside] @ series, 0.5 * length * weights[inside]

    def panels(self, space: LawSpace) -> list[tuple[float, float, Array]]:
        """Start, length and series of the output on short stretches, a column for each function of a space."""
        if self.steady:
            _check_repeats(self.name, self.machine, space.stroke)
        else:
            check_rest(self.name, space)
        states, direct = self.machine.rows[self.output]
        if direct[2] and space.continuity < 1:
            raise InputError(f"{self.output!r} is beyond every bound where the velocity jumps: give a continuity of 1")
        panels = [(panel.start, panel.length, panel.output(states, direct)) for panel in self._moved(space)]
        for *_, series in panels:
            series[0, -1] += self.offset
        return panels

    def _moved(self, space: LawSpace) -> list[Panel]:
        rise = drives.of_space(space)
        low, high = rise[0].ends[0][0], rise[-1].ends[1][0]
        dynamics, initial = self.machine.dynamics, None
        if self.cycle is not None:
            dwell, rest = self.cycle
            rise = around(rise, drives.backward(rise, 1.0 + dwell, 1.0, high), (high, low), (dwell, 1.0, rest))
        elif not self.steady:
            rise += [drives.rest(1.0, self.within[1] - 1.0, high)] if self.within[1] > 1.0 + SHORTEST_STRETCH else []
            initial = self.machine.settled(low)
        return MachineMotion(dynamics, self.machine.rows, rise, initial, radians=_RADIANS).panels

    def rows_of_output(self, space: LawSpace) -> Array:
        """A column for each function of a space: the RMS of the output is the norm of their sum."""
        samples = list(self._samples(space))
        total = sum(float(weights.sum()) for _, weights in samples)
        rows = [np.sqrt(weights / total)[:, None] * values for values, weights in samples]
        # a norm is that of the triangle alone
        return np.ascontiguousarray(np.linalg.qr(np.vstack(rows), mode="r"))

    @abstractmethod
    def _rows(self, space: LawSpace) -> Array:
        """What the rows of the constant are made from."""

    def _cached(self, space: LawSpace) -> Array:
        return space.cached((type(self).__name__, self.name), lambda: self._rows(space))


@lru_cache(maxsize=256)
def _scale_of_output(machine: StateSpace, output: str, offset: float) -> float:
    try:
        curve = MachineMotion.of_law(machine, smoothstep(_SMOOTH))[output]
        return power_of_two(max(abs(offset), *(abs(extreme.value) for extreme in curve.extrema(0))))
    except (ArithmeticError, OptlawsError, ValueError):
        return power_of_two(max(abs(offset), _along_a_wave(machine, output)))  # it does not come to rest


def _along_a_wave(machine: StateSpace, output: str) -> float:
    """The amplitude of an output while the law is a wave as long as the motion, with amplitude 1."""
    rate, place = 2.0j * pi, machine.place(output)
    drive = np.array([1.0, rate, rate**2])
    states = np.linalg.lstsq(rate * np.eye(len(machine.A)) - np.array(machine.A), machine.load @ drive, rcond=None)[0]
    return float(abs(np.array(machine.C[place]) @ states + np.array(machine.direct[place]) @ drive))


@dataclass(frozen=True, repr=False)
class OutputPeak(OutputConstant):
    """Greatest magnitude of an output, or its greatest or least value; constructed by `Machine.peak`."""

    _what: ClassVar[str] = "peak of"
    signs: tuple[float, ...] = (1.0, -1.0)

    @property
    def title(self) -> str:
        return super().title + ("" if self.both else f", side {_SIDE[self.signs]}")

    @property
    def both(self) -> bool:
        return len(self.signs) == 2

    def floor(self, conditions: BoundaryConditions) -> float:
        """A lower bound of a one-sided peak: the machine's output at rest where it begins, which may be below 0."""
        if self.both:
            return 0.0
        place, level = self.machine.place(self.output), conditions.start[0]
        begins = self.cycle is None and not self.steady and self.within[0] == 0.0
        if not begins or (len(conditions.start) < _KNOWN and self.machine.direct[place][2]):
            return -inf
        states, direct = self.machine.rows[self.output]
        still = (states @ self.machine.settled(np.array([level]))).real[0]
        value = float(still) + direct[0] * level + self.offset
        size = abs(float(still)) + abs(direct[0] * level) + abs(self.offset)
        return float(self.signs[0] * value - VALUE_ROUNDING * size)

    def value(self, law: MotionLaw) -> float:
        curve = self.curve(law)
        low, high = curve.extrema(0, None if self.cycle is not None else (self.within[0], curve.interval[1]))
        return max(high.value if sign > 0.0 else -low.value for sign in self.signs)

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        """The output's series, on pieces where it has many."""
        rows = self._cached(space)
        breaks, unit = np.append(1.0 - 2.0 * rows[:, 0, 0] / self.duration, -1.0), self.unit(space)
        table = PieceSeries(breaks, rows[:, 1:] / unit).widened(len(slack))
        domain = (-1.0, 1.0 - 2.0 * self.within[0] / self.duration)
        # the output jumps where the acceleration does: at breaks, or where the motion ends
        smooth = space.continuity > 1 and space.boundary.order > 2
        jumps = bool(self.machine.rows[self.output][1][2]) and not smooth
        return (LinearFamily(self.name, slack / unit, bound / unit, self.signs, domain, table=table, jumps=jumps),)

    def unit(self, space: LawSpace) -> float:
        """The size of the rows: nearly the base law's output."""
        rows = self._cached(space)
        return float(np.abs(rows[:, 1:, -1]).max()) or float(np.abs(rows[:, 1:]).max()) or 1.0

    def _rows(self, space: LawSpace) -> Array:
        """Series in the place u, which falls with time, a panel each; before each its start."""
        if self.steady:
            check_peaks_of_cycle(self.machine, self.output, [drive.length for drive in drives.of_space(space)])
        panels = self.panels(space)
        count = max(len(series) for *_, series in panels)
        rows = np.zeros((len(panels), count + 1, panels[0][2].shape[1]))
        for i, (start, _, series) in enumerate(panels):
            rows[i, 0] = start
            rows[i, 1 : 1 + len(series)] = series * np.where(np.arange(len(series)) % 2, -1.0, 1.0)[:, None]
        # short panels have more coefficients than count, and roots are looked for by all of them
        sizes = np.abs(rows[:, 1:]).max(axis=0)
        counted = np.flatnonzero((sizes > NEGLIGIBLE_TERM * sizes.max(axis=0)).any(axis=1))
        return np.ascontiguousarray(rows[:, : 2 + (int(counted[-1]) if len(counted) else 0)])


def _check_repeats(name: str, machine: StateSpace, stroke: float) -> None:
    """Refuse a law that ends elsewhere than it begins where the machine is driven by displacements."""
    if "a" in machine.inputs and abs(stroke) > CLOSURE:
        short = name.partition("(")[0]
        raise InputError(
            f"{short}: steady is of a law that ends where it begins, but its stroke is {stroke:g}: a machine whose "
            "motion goes on is driven by b and c alone"
        )


def check_peaks_of_cycle(machine: StateSpace, output: str, lengths: Sequence[float] = (1.0,)) -> None:
    """Refuse peaks of a cycle that repeats if there are too many to look at each, by the machine's roots alone.

    `lengths` are those of the cycle's stretches; fewer stretches have no more peaks.
    """
    if sum(len(machine.dynamics.edges(length, _RADIANS)) - 1 for length in lengths) > _MOST_PANELS:
        raise InputError(
            f"{output!r} vibrates {machine.dynamics.fastest / (2.0 * pi):.0f} times in a cycle and hardly dies away: "
            "its peaks are too many to look at each, and so stiff a machine moves as if it were rigid: leave it out "
            "and minimise the acceleration itself, or give it more damping"
        )


@dataclass(frozen=True, repr=False)
class OutputRms(OutputConstant):
    """Root mean square of an output; constructed by `Machine.rms`."""

    _what: ClassVar[str] = "RMS of"

    def value(self, law: MotionLaw) -> float:
        return self.curve(law).rms(0)

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConstraintFamily, ...]:
        unit = self.unit(space)
        wide = widened(self._cached(space), len(slack)) / unit
        return (NormFamily(self.name, slack / unit, bound / unit, matrix=wide),)

    def unit(self, space: LawSpace) -> float:
        """The size of the rows: the base law's output."""
        matrix = self._cached(space)
        return float(np.linalg.norm(matrix[:, -1])) or float(np.linalg.norm(matrix, axis=0).max()) or 1.0

    def along(self, space: LawSpace, direction: Sequence[float]) -> MotionLaw | None:
        """The law of a space whose output has a direction, for a certificate; None without such a law."""
        matrix = self._cached(space) / self.scale
        if len(direction) != len(matrix):
            return None
        free, base = matrix[:, :-1], matrix[:, -1]
        if not base.any():
            return space.law(np.linalg.lstsq(free, np.array(direction), rcond=None)[0])
        *weights, length = np.linalg.lstsq(np.column_stack([-free, direction]), base, rcond=None)[0]
        return space.law(np.array(weights)) if length > 0.0 else None

    def _rows(self, space: LawSpace) -> Array:
        return self.rows_of_output(space)


def output_peak(
    *,
    of: str | StateSpace,
    within: tuple[float, float] = (0.0, 1.0),
    cycle: tuple[float, float] | None = None,
    output: str | None = None,
    steady: bool = False,
    side: PeakSide = "both",
    offset: float = 0.0,
) -> OutputPeak:
    """The greatest magnitude of an output of a machine, or its greatest or least value, as `Machine.peak` has it.

    `of` is the machine, or its text with the output; `steady` says that the law is itself a whole cycle that repeats,
    such as one of `PeriodicPieces`.
    """
    check_names([side], SIDES, "side")
    entries, words = _entries(of, output, within=within, cycle=cycle, steady=steady, offset=offset)
    words += [] if side == "both" else [f"side={side}"]
    return OutputPeak(f"output_peak({', '.join(words)})", nan, convex=True, **entries, signs=SIDES[side])


def output_rms(
    *,
    of: str | StateSpace,
    dwell: float = 0.0,
    cycle: tuple[float, float] | None = None,
    output: str | None = None,
    steady: bool = False,
    offset: float = 0.0,
) -> OutputRms:
    """The root mean square of an output of a machine, as `Machine.rms` has it; the rest as of `output_peak`."""
    within = (0.0, 1.0 + _time(dwell, "dwell"))
    entries, words = _entries(of, output, within=within, cycle=cycle, steady=steady, offset=offset)
    text = ", ".join(f"dwell={float(dwell)!r}" if part.startswith("within") else part for part in words)
    return OutputRms(f"output_rms({text})", nan, convex=True, **entries)


def _entries(
    of: str | StateSpace, output: str | None, *, within: object, cycle: object, steady: object, offset: object
) -> tuple[dict[str, Any], list[str]]:
    """The checked common entries of an output's constant, and the words for them in a text."""
    machine = machine_of(of)
    name = machine.outputs[machine.place(output)]
    times, pauses = _pair(within, "within"), None
    if not times[0] < times[1]:
        raise InputError(f"within must be two times, the first before the last, got {shortened(within)}")
    words = [f"of={text_of(machine, name)}"]
    if cycle is not None:
        pauses = _pair(cycle, "cycle")
        times = 0.0, 2.0 + sum(pauses)
        words.append(f"cycle=({pauses[0]!r}, {pauses[1]!r})")
    elif times != (0.0, 1.0):
        words.append(f"within=({times[0]!r}, {times[1]!r})")
    # in a text it is a word
    repeats = {"True": True, "False": False}.get(steady, steady) if isinstance(steady, str) else steady
    if not isinstance(repeats, bool):
        raise InputError(f"steady must be True or False, got {shortened(repeats)}")
    if repeats and (pauses is not None or times != (0.0, 1.0)):
        raise InputError("steady is of a law that is a whole cycle: leave within, dwell and cycle out")
    (added,) = numbers([offset], "offset")
    words += ["steady=True"] if repeats else []
    words += [f"offset={added!r}"] if added else []
    common = {"machine": machine, "output": name, "within": times, "cycle": pauses, "steady": repeats, "offset": added}
    return common, words


def _pair(value: object, name: str) -> tuple[float, float]:
    pair = numbers(value, name) if isinstance(value, list | tuple) else ()
    if len(pair) != 2:
        raise InputError(f"{name} must be two times in durations of the rise, got {shortened(value)}")
    return _time(pair[0], name), _time(pair[1], name)


def _time(value: float, name: str) -> float:
    """A time in durations of the rise."""
    (time,) = numbers([value], name)
    if not 0.0 <= time <= _LATEST:
        raise InputError(f"{name}: times are durations of the rise, from 0 to {_LATEST:g}, got {shortened(value)}")
    return time


MAKERS.setdefault("output_peak", output_peak)
MAKERS.setdefault("output_rms", output_rms)
