"""Linear machines as matrices: x' = A x + B w, y = C x + D w, where w holds the law and its derivatives a, b and c."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import KW_ONLY
from math import inf, isfinite
from typing import TYPE_CHECKING, Any, Self, TypeAlias

import numpy as np
from numpy.typing import NDArray

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Kept, ReadBy, Text, ValueType
from optlaws.errors import InputError
from optlaws.files.reading import check_names, json_text
from optlaws.kept import kept_property
from optlaws.mechanisms.machine.dynamics import Dynamics
from optlaws.motion.quantities import si_number
from optlaws.numbers import MAGNITUDE_LIMIT, Array, Complex, NumberOrQuantity, positive, real_times

if TYPE_CHECKING:
    from optlaws.synthesis.spaces.space import LawSpace

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
        self._check_stability()

    def _check_stability(self) -> None:
        roots = self.dynamics.roots
        size = float(np.abs(roots).max())
        worst = complex(roots[int(np.argmax(roots.real))])
        if worst.real > _UNSTABLE * max(size, 1.0):
            raise InputError(
                f"the machine is unstable: its root {worst.real:.6g}{worst.imag:+.6g}i grows with time"
                "; left to itself it must rest or vibrate: check the signs in A"
            )
        if self.dynamics.fastest > FASTEST or self.dynamics.decay > STIFFEST:
            raise InputError(
                f"the machine's fastest root is {size:.3g} in the duration of the rise: beyond {FASTEST:g} radians it "
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
        T = positive(si_number(duration, ("time",), "duration"), "duration")
        h = positive(si_number(stroke, ("length", "angle"), "stroke"), "stroke")
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
