"""Linear machines as matrices, and their exact motion: x' = A x + B w as Chebyshev series, without steps in time.

A is balanced and turned into triangular form (Schur), so that defective, undamped and overdamped machines are all the
same: one scalar equation after another, the last one first. Each is an integral equation for the coefficients of its
Chebyshev series, three of them to a row. Panels are short only so that a series is, and its roots are computed quickly.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import KW_ONLY, dataclass
from itertools import pairwise
from math import ceil, inf, isfinite, sqrt
from typing import TYPE_CHECKING, Any, Self, TypeAlias

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Kept, ReadBy, Text, ValueType
from optlaws.errors import InputError
from optlaws.files.reading import check_names, json_text
from optlaws.kept import kept_property
from optlaws.motion.quantities import quantity
from optlaws.numbers import MAGNITUDE_LIMIT, Array, Complex, NumberOrQuantity, positive, real_times
from optlaws.numerics import chebyshev
from optlaws.tolerances import SAME_ROOT, SAME_TIME, VIBRATING

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace

RADIANS = 10.0  # of the fastest vibration in a panel
DECAY = 40.0  # of the fastest decay in a panel, while it is not over
SPARED = 2  # times as many panels as are enough where vibrations die away
SPARE = 32  # coefficients beyond those of the law that resolve a vibration on such a panel
STEEP = 2.0  # of the number of coefficients: what is faster is over before any of them shows it
PER_ROOT_OF_DECAY = 6.5  # coefficients that an exponential needs for each root of its exponent


@dataclass(frozen=True, eq=False)
class DriveStretch:
    """The motion of the drive on one stretch of time, in durations of the rise.

    `series` are Chebyshev series of a, b and c on it, shape (coefficients, 3, columns): one column for each law.
    """

    start: float
    length: float
    series: Array

    def within(self, low: float, high: float) -> Array:
        """The series of the part from low to high, as shares of the stretch."""
        if (low, high) == (0.0, 1.0):
            return self.series
        count, _, columns = self.series.shape
        x = low + 0.5 * (high - low) * (chebyshev.nodes(count) + 1.0)
        values = np.polynomial.chebyshev.chebvander(2.0 * x - 1.0, count - 1) @ self.series.reshape(count, -1)
        return np.asarray(chebyshev.from_values(values)).reshape(count, 3, columns)

    @property
    def ends(self) -> tuple[Array, Array]:
        """A, b and c at the start and at the end, shape (3, columns)."""
        signs = np.where(np.arange(len(self.series)) % 2, -1.0, 1.0)
        return np.tensordot(signs, self.series, 1), self.series.sum(axis=0)


@dataclass(frozen=True, eq=False)
class Panel:
    """The machine's states over a short time, as Chebyshev series, in the coordinates of its triangular form.

    `states` have the shape (coefficients, states, columns), `drive` (coefficients, 3, columns) with no more
    coefficients.
    """

    start: float
    length: float
    states: Complex
    drive: Array

    def output(self, states: Complex, direct: Array) -> Array:
        """Series of states . x + direct . (a, b, c), shape (coefficients, columns)."""
        output = np.ascontiguousarray(np.einsum("s,nsc->nc", states, self.states).real)
        output[: len(self.drive)] += np.einsum("i,nic->nc", direct, self.drive)
        return output


class Dynamics:
    """x' = A x + B (a, b, c) in triangular form; A and B have the shapes (states, states) and (states, 3)."""

    def __init__(self, matrix: Array, load: Array) -> None:
        from scipy.linalg import matrix_balance, schur

        balanced, (scale, _) = matrix_balance(matrix, permute=False, separate=True)
        self.triangle, turn = schur(balanced, output="complex")
        #: columns that turn the triangular form's coordinates into states, and back
        self.out_of: Complex = scale[:, None] * turn
        self.into: Complex = turn.conj().T / scale
        self.load: Complex = self.into @ load
        self.roots: Complex = np.diag(self.triangle).copy()

    @kept_property
    def vibrations(self) -> list[Complex]:
        """Roots with vibration, in the upper half plane, the slowest first; equal roots are grouped."""
        upper = self.roots[self.roots.imag > VIBRATING * np.abs(self.roots)]
        groups: list[list[complex]] = []
        for root in upper[np.argsort(np.abs(upper))].tolist():
            near = [group for group in groups if abs(group[0] - root) <= SAME_ROOT * max(abs(root), 1.0)]
            if near:
                near[0].append(root)
            else:
                groups.append([root])
        return [np.array(group) for group in groups]

    @property
    def fastest(self) -> float:
        """The fastest vibration, radians in the duration of the rise."""
        return float(np.abs(self.roots.imag).max())

    @property
    def decay(self) -> float:
        """The fastest decay, in the duration of the rise."""
        return float(np.abs(self.roots.real).max())

    def moved(
        self, drives: Sequence[DriveStretch], initial: Complex, *, radians: float = RADIANS, before: Array | None = None
    ) -> tuple[list[Panel], Complex]:
        """The motion over consecutive drives from given states, shape (states, columns), and the states at its end.

        Where the law's velocity jumps, its acceleration is an impulse; `before` is its velocity before the first drive,
        0 unless given.
        """
        velocity = np.zeros(drives[0].series.shape[2]) if before is None else before
        state, panels = initial, list[Panel]()
        for drive in drives:
            first, last = drive.ends
            state = state + np.outer(self.load[:, 2], first[1] - velocity)
            velocity = last[1]
            panels += self._over(drive, state, radians)
            state = panels[-1].states.sum(axis=0)
        return panels, state

    def _over(self, drive: DriveStretch, initial: Complex, radians: float) -> list[Panel]:
        """The motion over one drive: triangular equations in sequence, each over all panels."""
        edges = self.edges(drive.length, radians)
        parts = list(pairwise(edges))
        lengths = [(high - low) * drive.length for low, high in parts]
        series = [drive.within(low, high) for low, high in parts]
        alike = _alike(lengths)
        groups = [
            _Group(self, [series[j] for j in members], 0.5 * lengths[members[0]], edges[members[0]] * drive.length)
            for members in alike
        ]
        place = {j: (group, at) for group, members in zip(groups, alike, strict=True) for at, j in enumerate(members)}
        for i in range(len(self.roots) - 1, -1, -1):
            for group in groups:
                group.solve(i)
            value = initial[i]
            for j in range(len(parts)):
                group, at = place[j]
                value = group.begun(at, value)
            for group in groups:
                group.join(i)
        starts = [drive.start + low * drive.length for low in edges[:-1]]
        # what is known ends where the stretch does, to the last digit
        lengths[-1] = drive.start + drive.length - starts[-1]
        states = [place[j][0].states[:, :, place[j][1]].swapaxes(0, 1) for j in range(len(parts))]
        return [Panel(*panel) for panel in zip(starts, lengths, states, series, strict=True)]

    def edges(self, length: float, radians: float) -> list[float]:
        """Shares of a stretch that separate its panels: equal ones, with short ones at first for fast decays.

        Where that spares most of them, panels are also longer as soon as fast vibrations have died away.
        """
        count = max(1, ceil(self.fastest * length / radians))
        total = self.decay * length
        reaches = [DECAY / total] if total else [inf]
        while 2.0 * reaches[-1] < 1.0:
            reaches.append(2.0 * reaches[-1])
        growing = self._growing_edges([reach for reach in reaches if reach < 1.0], length, radians)
        if SPARED * (len(growing) - 1) < count:
            return growing
        return [0.0, *(reach for reach in reaches if reach < 1.0 / count), *((i + 1) / count for i in range(count))]

    def _growing_edges(self, reaches: list[float], length: float, radians: float) -> list[float]:
        """Shares of a stretch between panels as short as the vibrations require that are not yet damped out there."""
        edges = [0.0]
        for low, high in pairwise([0.0, *reaches, 1.0]):
            count = max(1, ceil(self._alive(low * length) * (high - low) * length / radians))
            edges += [low + (high - low) * (i + 1) / count for i in range(count - 1)] + [high]
        return edges

    def _alive(self, time: float) -> float:
        """The fastest vibration that has not died away after a time, radians in the duration of the rise."""
        alive = np.abs(self.roots.real) * time < (1.0 - SAME_TIME) * DECAY
        return float(np.abs(self.roots.imag[alive]).max(initial=0.0))

    def terms(self, drive: int, half: float, begun: float = 0.0) -> int:
        """Coefficients that resolve the motion on a panel of half that length, so long after its stretch began."""
        decay = min(self.decay * half, 2.0 * DECAY)
        return drive + SPARE + ceil(self._alive(begun) * half) + ceil(PER_ROOT_OF_DECAY * sqrt(decay))


class _Group:
    """Panels of one length: what drives them, and their states, shape (states, coefficients, panels, columns)."""

    def __init__(self, dynamics: Dynamics, drives: list[Array], half: float, begun: float) -> None:
        self._dynamics, self._half = dynamics, half
        drive = np.stack(drives, axis=2)
        terms, _, panels, columns = drive.shape
        shape = (len(dynamics.roots), dynamics.terms(terms, half, begun), panels, columns)
        self.states: Complex = np.zeros(shape, dtype=np.complex128)
        self.states[:, :terms] = np.tensordot(half * dynamics.load, drive, axes=(1, 1))
        self._free: Complex = np.empty(0, dtype=np.complex128)
        self._ends: Complex = np.empty(0, dtype=np.complex128)
        self._shares: Complex = np.empty((panels, columns), dtype=np.complex128)

    def solve(self, i: int) -> None:
        """A particular solution of equation i on every panel, and the free one; later equations are solved already."""
        row = self._dynamics.triangle[i, i + 1 :]
        if len(row):
            self.states[i] += np.tensordot(self._half * row, self.states[i + 1 :], axes=1)
        count = self.states.shape[1]
        root = complex(self._dynamics.roots[i]) * self._half
        solved = solutions(root, self.states[i].reshape(count, -1))
        self.states[i], self._free = solved[:, :-1].reshape(self.states[i].shape), solved[:, -1]
        even, odd = solved[::2].sum(axis=0), solved[1::2].sum(axis=0)
        self._ends = np.stack([even - odd, even + odd])

    def begun(self, at: int, value: Complex) -> Complex:
        """Begin the equation solved last on a panel with a value for each column; the values at its end."""
        columns = self.states.shape[3]
        first, last = self._ends[:, at * columns : (at + 1) * columns]
        share = (value - first) / self._ends[0, -1]
        self._shares[at] = share
        values: Complex = last + share * self._ends[1, -1]
        return values

    def join(self, i: int) -> None:
        """The share of the free solution on every panel that matches the panel's initial value."""
        self.states[i] += np.multiply.outer(self._free, self._shares)


def _alike(lengths: Sequence[float]) -> list[list[int]]:
    """Groups of lengths that are equal up to rounding."""
    groups = dict[float, list[int]]()
    for j, length in enumerate(lengths):
        same = next((known for known in groups if abs(known - length) <= SAME_TIME * length), length)
        groups.setdefault(same, []).append(j)
    return list(groups.values())


def solutions(root: complex, load: Complex) -> Complex:
    """Chebyshev series of solutions of y' = root y + load on [-1, 1], a column for each load, and one without load.

    Integrated once, each coefficient depends on its two neighbours, which leaves one free solution: the exponential. It
    is solved for beside the particular ones, from a coefficient 0, or a coefficient 1, that it is not without; where
    the coefficients are too few to show it, from the last one, beside which the particular ones are smooth.

    >>> load = np.zeros((3, 1), dtype=complex)
    >>> load[1] = 1.0
    >>> solutions(0.0, load).real.round(12).tolist()
    [[0.0, 1.0], [0.0, 0.0], [0.25, 0.0]]
    """
    from scipy.linalg import solve_banded
    from scipy.special import ive

    count, columns = load.shape
    j = np.arange(1, count)
    step = np.asarray(root / (2.0 * j), dtype=np.complex128)
    right = np.zeros((count - 1, columns + 1), dtype=np.complex128)
    right[:, :-1] = load[:-1]
    right[0] *= 2.0
    right[:-1, :-1] -= load[2:]
    right /= (2.0 * j)[:, None]
    if abs(root) > STEEP * count:
        return _steep(step, right)
    bands = np.ones((3, count - 1), dtype=np.complex128)
    bands[0, 1:], bands[2, :-1] = step[:-1], -step[1:]
    sizes = np.abs([complex(ive(order, np.complex128(root))) for order in (0, 1)])
    first = int(np.argmax(sizes))
    if first == 0:
        right[0, -1] = 2.0 * step[0]
    else:
        right[:2, -1] = -1.0, step[1]
        bands[1, 0], bands[2, 0] = -2.0 * step[0], 0.0
    solved = solve_banded((1, 1), bands, right, overwrite_ab=True, overwrite_b=True, check_finite=False)
    solution = np.empty((count, columns + 1), dtype=np.complex128)
    solution[1:] = solved
    solution[0] = solved[0]
    solution[first, :-1], solution[first, -1] = 0.0, 1.0
    return solution


def _steep(step: Complex, right: Complex) -> Complex:
    """Coefficients for a fast exponential: the last one is free, and the others follow from it."""
    from scipy.linalg import solve_banded

    count, columns = right.shape
    bands = np.ones((3, count), dtype=np.complex128)
    bands[0, 2:], bands[2] = step[:-2], -step
    bands[2, 0] *= 2.0
    right[-1, -1] -= 1.0
    right[-2:-1, -1] -= step[-2:-1]
    solution = np.zeros((count + 1, columns), dtype=np.complex128)
    solution[:-1] = solve_banded((0, 2), bands, right, overwrite_ab=True, overwrite_b=True, check_finite=False)
    solution[-1, -1] = 1.0
    return solution


_UNSTABLE = 1e-7  # of the fastest root: what its rounding may be
_SETTLED = 1e-9  # of a load: what a static state may miss it by

Matrix = tuple[tuple[float, ...], ...]

Rows = NDArray[Any] | Sequence[Sequence[float]]
MatrixRows: TypeAlias = Kept["Matrix", "Rows"]
OutputRows: TypeAlias = tuple[Complex, Array]
OutputNames: TypeAlias = Kept["tuple[str, ...]", "Sequence[str]"]

SYMBOLS = "abc"
#: states, or outputs
MOST_ROWS = 100
LONGEST_NAME = 80
FASTEST = 1e5  # radians of a vibration in the rise, as for followers
STIFFEST = 1e8  # the same for what decays


def _nothing(value: Any) -> bool:
    return isinstance(value, Sequence) and not isinstance(value, str) and not len(value)


def _listed(names: Any) -> tuple[Any, ...]:
    if isinstance(names, str):
        return (names,)
    if not isinstance(names, Iterable):
        raise InputError(f"outputs must be the outputs' names, got {shortened(names)}")
    return tuple(names)


class _Matrix(ValueType):
    """A matrix of finite numbers, kept by rows; where it may be left out it is empty."""

    def read(self, value: Any, name: str) -> Matrix:
        return () if name == "D" and _nothing(value) else tuple(map(tuple, _matrix(value, name).tolist()))

    def plain(self, value: Matrix) -> list[list[float]]:
        return [list(row) for row in value]

    @property
    def words(self) -> str:
        return "a matrix, a list of rows"

    def schema(self) -> dict[str, Any]:
        return {"type": "array", "items": {"type": "array", "items": {"type": "number"}}}


@declared
class StateSpace(Declared, title="a machine"):
    """x' = A x + B w, y = C x + D w in durations of the rise; w holds the signals a, b, c in `inputs`, such as "ab"."""

    writes_defaults = True

    A: MatrixRows = entry(_Matrix(), "Of the states.", example=[[-2.0]])
    B: MatrixRows = entry(_Matrix(), "From inputs to states.", example=[[2.0]])
    C: MatrixRows = entry(_Matrix(), "From states to outputs.", example=[[1.0]])
    D: MatrixRows = entry(_Matrix(), "From inputs to outputs.", default=())
    _: KW_ONLY
    inputs: str = entry(Text(), "The derivatives of the law that are inputs.", default="a")
    outputs: OutputNames = entry(ReadBy(_listed, "names", list), "Names of the outputs.", default=())

    def _check(self) -> None:
        _check_inputs(self.inputs)
        size, count, outputs = len(self.A), len(self.inputs), len(self.C)
        if len(self.A[0]) != size:
            shape = (size, len(self.A[0]))
            raise InputError(f"A must have as many columns as rows, one for each state, got shape {shape}")
        if not self.D:
            object.__setattr__(self, "D", ((0.0,) * count,) * outputs)
        for name, shape, says in (
            ("B", (size, count), f"a row for each of {size} states, a column for each of its inputs"),
            ("C", (outputs, size), f"a row for each output, a column for each of {size} states"),
            ("D", (outputs, count), f"a row for each of {outputs} outputs, a column for each input"),
        ):
            matrix = getattr(self, name)
            if (len(matrix), len(matrix[0])) != shape:
                raise InputError(f"{name} must have {says}, got shape {(len(matrix), len(matrix[0]))}")
        object.__setattr__(self, "outputs", _names(self.outputs, outputs))
        roots = self.dynamics.roots
        most = float(np.abs(roots).max())
        worst = complex(roots[int(np.argmax(roots.real))])
        if worst.real > _UNSTABLE * max(most, 1.0):
            raise InputError(
                f"the machine is unstable: its root {worst.real:.6g}{worst.imag:+.6g}i grows with time"
                "; left to itself it must rest or vibrate: check the signs in A"
            )
        if self.dynamics.fastest > FASTEST or self.dynamics.decay > STIFFEST:
            raise InputError(
                f"the machine's fastest root is {most:.3g} in the duration of the rise: beyond {FASTEST:g} radians it "
                f"is as good as rigid, and beyond a decay of {STIFFEST:g} without delay: leave that part out, or give "
                "the duration in the unit of time of the rest, such as s"
            )

    @classmethod
    def from_units(
        cls,
        A: Rows,
        B: Rows,
        C: Rows,
        D: Rows = (),
        *,
        duration: NumberOrQuantity,
        stroke: NumberOrQuantity = 1.0,
        inputs: str = "a",
        outputs: Sequence[str] = (),
    ) -> Self:
        """The machine of matrices in seconds, run through a rise of this duration and stroke; outputs keep their units.

        Parameters
        ----------
        A, B, C, D
            Matrices for time in seconds and for a displacement, velocity and acceleration of the input in its units.
        duration
            Duration of the rise, "0.2 s", or a number of seconds.
        stroke
            Stroke of the rise, "35 mm" or "20 deg", or a number in units of the input's displacement.
        inputs, outputs
            As of `Machine`.
        """
        T = positive(quantity(duration, "time", "duration", bare=True), "duration")
        h = positive(quantity(stroke, ("length", "angle"), "stroke", bare=True), "stroke")
        _check_inputs(inputs)
        if not (0.0 < T * T < inf and isfinite(h / (T * T))):
            raise InputError(f"duration must be a time in s that machines take, got {shortened(duration)}")
        units = np.array([h / T ** SYMBOLS.index(symbol) for symbol in inputs])
        scaled = _scaled(A, "A", T), _scaled(B, "B", T * units), C, _scaled(D, "D", units)
        return cls(*scaled, inputs=inputs, outputs=outputs)

    @kept_property
    def dynamics(self) -> Dynamics:
        """The equation in triangular form."""
        return Dynamics(np.array(self.A), self.load)

    @kept_property
    def load(self) -> Array:
        """B with a column for each of a, b and c."""
        return _spread(np.array(self.B), self.inputs)

    @kept_property
    def direct(self) -> Array:
        """D with a column for each of a, b and c."""
        return _spread(np.array(self.D), self.inputs)

    @kept_property
    def rows(self) -> dict[str, tuple[Complex, Array]]:
        """The rows that take the triangular form's states to each output, and those that take a, b and c to it."""
        states = (np.array(row) @ self.dynamics.out_of for row in self.C)
        return dict(zip(self.outputs, zip(states, self.direct, strict=True), strict=True))

    def output_rows(self, output: str) -> tuple[Complex, Array]:
        """The rows of an output."""
        return self.rows[self.outputs[self.place(output)]]

    def place(self, output: str | None) -> int:
        """The index of an output by its name; the first output if there is no name."""
        if output is None:
            return 0
        check_names([output], self.outputs, "output of the machine")
        return self.outputs.index(output)

    def settled(self, levels: Array) -> Complex:
        """States at rest under displacements of the law, one column for each, in the triangular form."""
        right = -np.outer(self.load[:, 0], levels)
        if not right.any():
            return np.zeros(right.shape, dtype=np.complex128)
        A = np.array(self.A)
        states = np.linalg.lstsq(A, right, rcond=None)[0]
        if np.abs(A @ states - right).max() > _SETTLED * np.abs(right).max():
            raise InputError(
                "the machine has no state of rest while the law stands away from 0: A x + B a = 0 has no solution"
            )
        return np.asarray(self.dynamics.into @ states)

    def __repr__(self) -> str:
        names = ", ".join(map(repr, self.outputs[:4])) + (", ..." if len(self.outputs) > 4 else "")
        return f"{type(self).__name__}(states={len(self.A)}, inputs={self.inputs!r}, outputs=[{names}])"


def _check_inputs(inputs: Any) -> None:
    known = isinstance(inputs, str) and inputs != "" and set(inputs) <= set(SYMBOLS)
    if not known or len(set(inputs)) < len(inputs):
        raise InputError(
            'inputs must name what of the law the columns of B belong to, each once: "a" displacement, '
            f'"b" velocity, "c" acceleration, such as "a" or "ab", got {shortened(inputs)}'
        )


def _spread(matrix: Array, inputs: str) -> Array:
    columns = np.zeros((len(matrix), 3))
    columns[:, [SYMBOLS.index(symbol) for symbol in inputs]] = matrix
    return columns


def _matrix(value: Any, name: str) -> Array:
    try:
        times = real_times(value)
    except InputError:
        raise InputError(f"{name} must be a matrix of finite numbers, got {shortened(value)}") from None
    if times.ndim != 2 or not times.size or max(times.shape) > MOST_ROWS or np.abs(times).max() > MAGNITUDE_LIMIT:
        raise InputError(
            f"{name} must be a matrix, a list of rows, at most {MOST_ROWS} of them, got {shortened(value)}"
        )
    return times + 0.0


def _scaled(value: Any, name: str, factor: Any) -> Any:
    """A matrix times numbers, where it is one; what is none is refused elsewhere."""
    if _nothing(value):
        return value
    matrix = _matrix(value, name)
    return matrix * factor if np.ndim(factor) == 0 or matrix.shape[1] == len(factor) else matrix


def _names(names: tuple[Any, ...], count: int) -> tuple[str, ...]:
    if not names:
        return tuple(f"output {i}" for i in range(1, count + 1))
    for name in names:
        plain = isinstance(name, str) and name.strip() and name.isprintable() and not set(name) & set("\"'\\")
        if not plain or len(name) > LONGEST_NAME:
            raise InputError(f"an output's name must be a short text without quotes, got {shortened(name)}")
    if len(names) != count or len(set(names)) != count:
        raise InputError(f"outputs must be {count} different names, one for each row of C, got {shortened(names)}")
    return names


def text_of(machine: StateSpace, output: str) -> str:
    """A machine with a selected output, as quoted JSON.

    >>> print(text_of(StateSpace([[-2.0]], [[2.0]], [[1.0]], outputs=["speed"]), "speed"))
    '{"A":[[-2.0]],"B":[[2.0]],"C":[[1.0]],"D":[[0.0]],"inputs":"a","outputs":["speed"]}'
    """
    place = machine.place(output)
    plain = machine.to_dict() | {"outputs": [output]}
    plain |= {name: [plain[name][place]] for name in "CD"}
    return f"'{json.dumps(plain, separators=(',', ':'), ensure_ascii=False)}'"


def title_of(machine: StateSpace, what: str, output: str, *words: str) -> str:
    """The title of a constant of a machine in messages."""
    count = len(machine.A)
    states = "1 state" if count == 1 else f"{count} states"
    return ", ".join([f"{what} {output!r} of a machine of {states}", *words])


def machine_of(given: Any) -> StateSpace:
    """The machine that is given, or that a text describes."""
    if isinstance(given, StateSpace):
        return given
    if not isinstance(given, str):
        raise InputError(f"of must be a machine, or one as JSON text, got {shortened(given)}")
    try:
        data = json_text(given, "of, a machine,")
    except InputError as error:
        raise InputError(f"of must be a machine as JSON text, {{...}}: {error}") from None
    return StateSpace.from_dict(data)


def check_rest(name: str, space: LawSpace) -> None:
    """Refuse laws that do not begin and end at rest."""
    if space.start_velocity != 0.0 or space.velocity_change != 0.0 or space.boundary.order < 2:
        short = name.partition("(")[0]
        raise InputError(f"{short} of a machine needs laws from rest to rest, of order 2 at least")
