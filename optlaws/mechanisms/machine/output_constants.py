"""Peaks and root mean squares of a machine's outputs as constants of a law: affine in it, so they are convex."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import inf, nan
from typing import ClassVar

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.mechanisms.machine import drives
from optlaws.mechanisms.machine.dynamics import Panel
from optlaws.mechanisms.machine.output_curve import OutputCurve
from optlaws.mechanisms.machine.over_time import (
    BRIEF,
    MachineCycle,
    MachineResponse,
    RepeatedMotion,
    around,
    jumps,
    steady,
)
from optlaws.mechanisms.machine.state_space import StateSpace
from optlaws.mechanisms.machine.texts import check_repeats, check_rest, machine_of, text_of, title_of
from optlaws.numbers import numbers
from optlaws.synthesis.families.family import Family, LinearFamily, NormFamily
from optlaws.synthesis.problem.constants import MAKERS, Functional
from optlaws.synthesis.spaces.pieces.rows import PieceFamily, PieceSeries
from optlaws.synthesis.spaces.space import LawSpace

Array = NDArray[np.float64]

_RADIANS = 40.0  # of the fastest vibration on one piece of the rows
_LATEST = 100.0
_SAMPLES = 4001
_MOST_GAIN = 1e6
_RANK = 1e-12
_NEGLIGIBLE = 2.0**-54
_ROOM = 1.01  # for what the sum over samples misses of an integral


@dataclass(frozen=True, repr=False)
class OutputConstant(Functional):
    """What the constants of an output share.

    Attributes
    ----------
    machine, output
        Of which machine, which output.
    within
        The first and the last time that count, in durations of the rise; the law rests from 1 on.
    cycle
        The dwell and the rest of a cycle of rise, dwell, return and rest; None for one rise.
    steady
        Whether the law is itself a whole cycle that repeats; its duration is then the unit of time.
    """

    machine: StateSpace = field(compare=False)
    output: str = field(compare=False)
    within: tuple[float, float]
    cycle: tuple[float, float] | None
    steady: bool = False

    def curve(self, law: MotionLaw) -> OutputCurve:
        """The output under a law, over all that counts and what is before it."""
        if self.steady:
            check_repeats(self.name, self.machine, float(law.a(1.0)) - float(law.a(0.0)))
            return RepeatedMotion(self.machine, tuple(drives.of_law(law)), tuple(jumps(law)))[self.output]
        if self.cycle is not None:
            return MachineCycle(self.machine, law, law, self.cycle[0], 1.0, self.cycle[1])[self.output]
        return MachineResponse(self.machine, law, max(0.0, self.within[1] - 1.0))[self.output]

    #: what of the output it is, in words
    _what: ClassVar[str]

    @property
    def title(self) -> str:
        """A few words for it; the name has the whole machine in it.

        Examples
        --------
        >>> from optlaws import Machine
        >>> Machine([[-2.0]], [[2.0]], [[1.0]], outputs=["speed"]).peak(within=(0, 1.5)).title
        "peak of 'speed' of a machine of 1 state, times 0 to 1.5"
        """
        first, last = self.within
        said = [] if self.cycle is not None or self.within == (0.0, 1.0) else [f"times {first:g} to {last:g}"]
        said += [] if self.cycle is None else ["over a cycle with dwell {:g} and rest {:g}".format(*self.cycle)]
        said += ["steady"] if self.steady else []
        return title_of(self.machine, self._what, self.output, *said)

    @property
    def duration(self) -> float:
        """The time that places are shares of."""
        return self.within[1]

    def where(self, k: float) -> str:
        """The time of a place."""
        return f"time {k * self.duration:.4g}"

    def curbs(self) -> tuple[tuple[int, float], ...]:
        """The derivative that enters the output directly is the response of the inverse machine to it."""
        alone = self.cycle is None and not self.steady
        return self._curbs if alone and self.within[0] == 0.0 and self.within[1] >= 1.0 else ()

    @kept_property
    def _curbs(self) -> tuple[tuple[int, float], ...]:
        order, gain = inverse_gain(self.machine, self.output)
        # of a part [0, 1] of the time, whose mean is at most so much more
        return ((order, gain * self.duration),) if gain < _MOST_GAIN else ()

    def sizes(self, space: LawSpace) -> tuple[tuple[int, float, float], ...]:
        """Of a law that repeats: its acceleration is bounded by the output, for it determines the law in the space."""
        return steady_sizes(self, space) if self.steady else super().sizes(space)

    def panels(self, space: LawSpace) -> list[tuple[float, float, Array]]:
        """Start, length and series of the output on short stretches, a column for each function of a space."""
        if self.steady:
            check_repeats(self.name, self.machine, space.stroke)
        else:
            check_rest(self.name, space)
        if self.machine.output_rows(self.output)[1][2] and getattr(space, "continuity", 2) < 1:
            raise InputError(f"{self.output!r} is beyond every bound where the velocity jumps: ask a continuity of 1")
        states, direct = self.machine.output_rows(self.output)
        return [(one.start, one.length, one.output(states, direct)) for one in self._moved(space)]

    def _moved(self, space: LawSpace) -> list[Panel]:
        rise = drives.of_space(space)
        if self.steady:
            return steady(self.machine, rise, _RADIANS)
        low, high = rise[0].ends[0][0], rise[-1].ends[1][0]
        if self.cycle is not None:
            dwell, rest = self.cycle
            fall = drives.backward(rise, 1.0 + dwell, 1.0, high)
            return steady(self.machine, around(rise, fall, (high, low), (dwell, 1.0, rest)), _RADIANS)
        if self.within[1] > 1.0 + BRIEF:
            rise.append(drives.rest(1.0, self.within[1] - 1.0, high))
        initial = self.machine.settled(low)
        return self.machine.dynamics.moved(rise, initial, radians=_RADIANS)[0]

    def rows_of_output(self, space: LawSpace) -> Array:
        """A column for each function of a space: the RMS of the output is the norm of their sum."""
        panels = self.panels(space)
        total = sum(length for _, length, _ in panels)
        rows = []
        for _, length, series in panels:
            x, weights = legendre.leggauss(len(series))
            values = np.polynomial.chebyshev.chebvander(x, len(series) - 1) @ series
            rows.append(np.sqrt(0.5 * weights * length / total)[:, None] * values)
        # a norm is that of the triangle alone
        return np.ascontiguousarray(np.linalg.qr(np.vstack(rows), mode="r"))

    def _kept(self, space: LawSpace, make: Callable[[], Array]) -> Array:
        return space.cached((type(self).__name__, self.name), make)


@dataclass(frozen=True, repr=False)
class OutputPeak(OutputConstant):
    """Greatest magnitude of an output; made by `Machine.peak`."""

    _what: ClassVar[str] = "peak of"

    def value(self, law: MotionLaw) -> float:
        """The greatest magnitude over the whole time that counts."""
        curve = self.curve(law)
        low, high = curve.extrema(0, None if self.cycle is not None else (self.within[0], curve.interval[1]))
        return max(high.value, -low.value)

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[Family, ...]:
        """The output's series, on pieces where it has many."""
        rows = self._kept(space, lambda: self._rows(space))
        breaks, series = 1.0 - 2.0 * rows[:, 0, 0] / self.duration, rows[:, 1:]
        wide = np.zeros((*series.shape[:2], len(slack) + 1))
        wide[:, :, : space.terms], wide[:, :, -1] = series[:, :, :-1], series[:, :, -1]
        domain = (-1.0, 1.0 - 2.0 * self.within[0] / self.duration)
        unit = self.unit(space)
        slack, bound, wide = slack / unit, bound / unit, wide / unit
        if len(wide) == 1:
            return (LinearFamily(self.name, slack, bound, (1.0, -1.0), domain, series=wide[0]),)
        pieces = PieceSeries(np.append(breaks, -1.0), wide)
        nothing = np.zeros((1, 1))
        return (
            PieceFamily(
                self.name, slack, bound, (1.0, -1.0), domain, series=nothing, pieces=pieces, jumps=self._jumps(space)
            ),
        )

    def unit(self, space: LawSpace) -> float:
        """The size of the rows: what the base law's output is, nearly."""
        rows = self._kept(space, lambda: self._rows(space))
        return float(np.abs(rows[:, 1:, -1]).max()) or float(np.abs(rows[:, 1:]).max()) or 1.0

    def _jumps(self, space: LawSpace) -> bool:
        """Whether the output jumps where the acceleration does: at breaks, or where the motion ends."""
        smooth = getattr(space, "continuity", 2) > 1 and space.boundary.order > 2
        return bool(self.machine.output_rows(self.output)[1][2]) and not smooth

    def _rows(self, space: LawSpace) -> Array:
        """Series in the place u, which falls with time, a panel each; before each its start."""
        panels = self.panels(space)
        count = max(len(series) for *_, series in panels)
        found = np.zeros((len(panels), count + 1, panels[0][2].shape[1]))
        for i, (start, _, series) in enumerate(panels):
            found[i, 0] = start
            found[i, 1 : 1 + len(series)] = series * np.where(np.arange(len(series)) % 2, -1.0, 1.0)[:, None]
        return np.ascontiguousarray(found[:, : 1 + _terms(found[:, 1:])])


def _terms(series: Array) -> int:
    """How many coefficients count: short panels have more than are needed, and places are looked for by them all."""
    sizes = np.abs(series).max(axis=0)
    kept = np.flatnonzero((sizes > _NEGLIGIBLE * sizes.max(axis=0)).any(axis=1))
    return int(kept[-1]) + 1 if len(kept) else 1


@dataclass(frozen=True, repr=False)
class OutputRms(OutputConstant):
    """Root mean square of an output; made by `Machine.rms`."""

    _what: ClassVar[str] = "RMS of"

    def value(self, law: MotionLaw) -> float:
        """The root of the mean square over the whole time."""
        return self.curve(law).rms(0)

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[Family, ...]:
        """A norm of the coordinates."""
        matrix = self._kept(space, lambda: self.rows_of_output(space))
        unit = float(np.linalg.norm(matrix[:, -1])) or float(np.linalg.norm(matrix, axis=0).max()) or 1.0
        wide = space.widened(matrix, len(slack)) / unit
        return (NormFamily(self.name, slack / unit, bound / unit, matrix=wide),)


def inverse_gain(machine: StateSpace, output: str) -> tuple[int, float]:
    """An order and a factor: the mean of |a^(order)| from rest on is at most the factor times that of |output|.

    The highest derivative that enters the output directly is what the inverse machine makes of the output: as much as
    is fed through, and the integral of its response to an impulse at most. Infinite where nothing enters directly.
    """
    place = machine.place(output)
    A, load, states, direct = np.array(machine.A), machine.load, np.array(machine.C[place]), machine.direct[place]
    feeds, loads = direct.copy(), load.copy()
    for order in (2, 1, 0):
        if feeds[order]:
            break
        if order == 0:
            return 0, inf
        # x - load a^(order - 1) has no derivative of this order in its equation
        feeds[order - 1] += states @ loads[:, order]
        loads[:, order - 1] += A @ loads[:, order]
        loads[:, order] = 0.0
    size = len(A)
    # the states, then what is integrated from the derivative: a, or a and b
    whole = np.zeros((size + order, size + order))
    whole[:size, :size], whole[:size, size:] = A, loads[:, :order]
    whole[size:, size:] = np.eye(order, k=1)
    entry, row = np.zeros(size + order), np.concatenate([states, feeds[:order]])
    entry[:size] = loads[:, order]
    entry[size:] += np.eye(order)[-1] if order else 0.0
    inverse = whole - np.outer(entry, row) / feeds[order]
    return order, _ROOM * (1.0 / abs(feeds[order]) + _impulse(inverse, entry, row) / feeds[order] ** 2)


def _impulse(matrix: Array, entry: Array, row: Array) -> float:
    """Integral over [0, 1] of |row exp(matrix t) entry|, by samples."""
    from scipy.linalg import expm

    step, states = expm(matrix / (_SAMPLES - 1)), entry[:, None]
    with np.errstate(over="ignore", invalid="ignore"):
        while states.shape[1] < _SAMPLES:
            # as many times again, all of them as much later
            states, step = np.hstack([states, step @ states]), step @ step
        total = float(np.trapezoid(np.abs(row @ states[:, :_SAMPLES]))) / (_SAMPLES - 1)
    return total if np.isfinite(total) else inf


def steady_sizes(constant: OutputConstant, space: LawSpace) -> tuple[tuple[int, float, float], ...]:
    """What the RMS of c is at most in laws of a space with such an output: by the least singular value of the way back.

    Nothing where the output does not determine the law.
    """
    rows = constant.rows_of_output(space)
    rule = space.quadrature(2)
    bent = np.sqrt(rule.weights)[:, None] * rule.values
    asked = space.equations()
    matrix = np.array([one.row for one in asked]).reshape(-1, space.terms)
    right = np.array([one.right for one in asked])
    kept = np.append(np.linalg.lstsq(matrix, right, rcond=None)[0], 1.0)
    _, sizes, turn = np.linalg.svd(matrix)
    free = turn[int((sizes > _RANK * sizes.max(initial=1.0)).sum()) :].T
    way: Array = np.asarray(np.linalg.qr(bent[:, :-1] @ free, mode="r"))
    if np.linalg.matrix_rank(way) < way.shape[1]:
        return ()
    least = float(np.linalg.svd(rows[:, :-1] @ free @ np.linalg.inv(way), compute_uv=False)[-1])
    if least * _MOST_GAIN < float(np.linalg.norm(rows)) / max(float(np.linalg.norm(bent)), 1.0):
        return ()
    factor = _ROOM / least
    return ((2, factor, _ROOM * float(np.linalg.norm(bent @ kept)) + factor * float(np.linalg.norm(rows @ kept))),)


def output_peak(
    *,
    of: str | StateSpace,
    within: tuple[float, float] = (0.0, 1.0),
    cycle: tuple[float, float] | None = None,
    output: str | None = None,
    steady: bool = False,
) -> OutputPeak:
    """The greatest magnitude of an output of a machine.

    Parameters
    ----------
    of
        The machine, or its text with the output.
    within
        The first and the last time that count, in durations of the rise; the law rests from 1 on.
    cycle
        The dwell and the rest of a cycle that repeats; then the whole of it counts.
    output
        Which output; the first one unless given.
    steady
        Whether the law is itself a whole cycle that repeats, such as one of `PeriodicPieces`.

    Raises
    ------
    InputError
        If there is no such output, or a time is out of range.

    Examples
    --------
    >>> from optlaws import Machine, smoothstep
    >>> machine = Machine([[0, 1], [-400, -2]], [[0], [400]], [[-400, -2]], [[400]], outputs=["acceleration"])
    >>> output_peak(of=machine).value(smoothstep(4)), output_peak(of=machine, within=(1, 2)).value(smoothstep(4))
    (10.254029, 1.620669)
    """
    machine, name, times, pauses, said = _asked(of, within, cycle, output)
    said += _steady(steady, times, pauses)
    text = f"output_peak({', '.join(said)})"
    return OutputPeak(text, nan, convex=True, machine=machine, output=name, within=times, cycle=pauses, steady=steady)


def _steady(steady: object, times: tuple[float, float], pauses: tuple[float, float] | None) -> list[str]:
    """How a text says that the law repeats."""
    if not isinstance(steady, bool):
        raise InputError(f"steady must be True or False, got {shortened(steady)}")
    if steady and (pauses is not None or times != (0.0, 1.0)):
        raise InputError("steady is of a law that is a whole cycle: leave within, dwell and cycle out")
    return ["steady=True"] if steady else []


def output_rms(
    *,
    of: str | StateSpace,
    dwell: float = 0.0,
    cycle: tuple[float, float] | None = None,
    output: str | None = None,
    steady: bool = False,
) -> OutputRms:
    """The root mean square of an output of a machine, over the rise and a dwell after it, or over a cycle.

    Parameters
    ----------
    of
        The machine, or its text with the output.
    dwell
        How much of the dwell counts too, in durations of the rise.
    cycle
        The dwell and the rest of a cycle that repeats; then the whole of it counts.
    output
        Which output; the first one unless given.
    steady
        Whether the law is itself a whole cycle that repeats.

    Raises
    ------
    InputError
        If there is no such output, or a time is out of range.

    Examples
    --------
    >>> from optlaws import Machine, smoothstep
    >>> machine = Machine([[-2.0]], [[2.0]], [[1.0]], outputs=["temperature"])
    >>> output_rms(of=machine).value(smoothstep(4))
    0.29...
    """
    machine, name, times, pauses, said = _asked(of, (0.0, 1.0 + _time(dwell, "dwell")), cycle, output)
    said = [one for one in said if not one.startswith("within")]
    said += [f"dwell={float(dwell)!r}"] if dwell and cycle is None else []
    said += _steady(steady, times, pauses)
    text = f"output_rms({', '.join(said)})"
    return OutputRms(text, nan, convex=True, machine=machine, output=name, within=times, cycle=pauses, steady=steady)


def _asked(
    of: str | StateSpace, within: object, cycle: object, output: str | None
) -> tuple[StateSpace, str, tuple[float, float], tuple[float, float] | None, list[str]]:
    """What is asked of an output, checked, and its text."""
    machine = machine_of(of)
    name = machine.outputs[machine.place(output)]
    first, last = _pair(within, "within")
    if not first < last:
        raise InputError(f"within must be two times, the first before the last, got {shortened(within)}")
    said = [f"of={text_of(machine, name)}"]
    if cycle is not None:
        dwell, rest = _pair(cycle, "cycle")
        period = 2.0 + dwell + rest
        return machine, name, (0.0, period), (dwell, rest), [*said, f"cycle=({dwell!r}, {rest!r})"]
    said += [f"within=({first!r}, {last!r})"] if (first, last) != (0.0, 1.0) else []
    return machine, name, (first, last), None, said


def _pair(value: object, name: str) -> tuple[float, float]:
    found = numbers(value, name) if isinstance(value, list | tuple) else ()
    if len(found) != 2:
        raise InputError(f"{name} must be two times in durations of the rise, got {shortened(value)}")
    return _time(found[0], name), _time(found[1], name)


def _time(value: float, name: str) -> float:
    (found,) = numbers([value], name)
    if not 0.0 <= found <= _LATEST:
        raise InputError(f"{name}: times are durations of the rise, from 0 to {_LATEST:g}, got {shortened(value)}")
    return found


MAKERS.setdefault("output_peak", output_peak)
MAKERS.setdefault("output_rms", output_rms)
