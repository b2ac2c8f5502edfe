"""Machines stepped through a law by matrix exponentials, and their modes by eigenvectors: another hand's constants."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import asin, factorial

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import NDArray
from scipy.linalg import expm
from scipy.optimize import minimize_scalar

from tests.internals.mechanisms import ModeResidual, OutputConstant, OutputPeak, StateSpace

Array = NDArray[np.float64]

STEPS = 400
TERMS = 10
#: the angle by which a mode turns along a rule of integration
TURNED = 25.0
X, WEIGHTS = np.polynomial.legendre.leggauss(120)


@dataclass(frozen=True)
class Stretch:
    """A polynomial displacement over a time."""

    start: float
    stop: float
    a: Chebyshev

    def derivatives(self, times: Array, count: int) -> Array:
        """Of the displacement, shape (count, times)."""
        return np.array([self.a.deriv(i)(times) if i else self.a(times) for i in range(count)])


def stretches(constant: OutputConstant, pieces: Sequence[Chebyshev]) -> list[Stretch]:
    """The law with what comes after it."""
    rise = [Stretch(float(piece.domain[0]), float(piece.domain[1]), piece) for piece in pieces]
    if constant.cycle is None:
        return [*rise, *_rest(1.0, constant.within[1], float(pieces[-1](1.0)))]
    dwell, rest = constant.cycle
    high, low = float(pieces[-1](1.0)), float(pieces[0](0.0))
    back = 1.0 + dwell
    fall = [
        Stretch(
            back + one.start,
            back + one.stop,
            Chebyshev(-one.a.coef, domain=[back + one.start, back + one.stop]) + high + low,
        )
        for one in rise
    ]
    return [*rise, *_rest(1.0, back, high), *fall, *_rest(back + 1.0, back + 1.0 + rest, low)]


def _rest(start: float, stop: float, level: float) -> list[Stretch]:
    return [Stretch(start, stop, Chebyshev([level], domain=[start, stop]))] if stop > start + 1e-12 else []


def walked(
    machine: StateSpace, course: Sequence[Stretch], state: Array
) -> tuple[list[tuple[Array, Array, Array]], Array]:
    """Times, states and derivatives of the displacement over each stretch, and the state at the end."""
    A, B, size = np.array(machine.A), machine.load, len(machine.A)
    found = []
    for one in course:
        count = max(one.a.degree(), 2) + 1
        whole = np.zeros((size + count, size + count))
        whole[:size, :size], whole[:size, size : size + 3] = A, B
        whole[size:, size:] = np.eye(count, k=1)
        times = np.linspace(one.start, one.stop, STEPS + 1)
        step = expm(whole * (times[1] - times[0]))[:size]
        drive = one.derivatives(times, count)
        states = [state]
        for i in range(STEPS):
            states.append(step @ np.concatenate([states[-1], drive[:, i]]))
        state = states[-1]
        found.append((times, np.array(states).T, drive))
    return found, state


def motion(constant: OutputConstant, pieces: Sequence[Chebyshev]) -> list[tuple[Array, Array, Array]]:
    """What the machine does; over a cycle, what comes back."""
    machine, size = constant.machine, len(constant.machine.A)
    course = stretches(constant, pieces)
    start = np.zeros(size)
    if constant.cycle is not None:
        still = [Stretch(one.start, one.stop, Chebyshev([0.0], domain=[one.start, one.stop])) for one in course]
        free = np.array([walked(machine, still, one)[1] for one in np.eye(size)]).T
        start = np.linalg.solve(np.eye(size) - free, walked(machine, course, start)[1])
    return walked(machine, course, start)[0]


def machine_value(constant: OutputConstant | ModeResidual, pieces: Sequence[Chebyshev]) -> float:
    """A constant of a machine under a law given by its displacement's pieces."""
    if isinstance(constant, ModeResidual):
        return residual_value(constant, pieces)
    return output_value(constant, pieces)


def output_value(constant: OutputConstant, pieces: Sequence[Chebyshev]) -> float:
    """Peak or RMS of the output."""
    machine = constant.machine
    place = machine.outputs.index(constant.output)
    row, direct, A, B = np.array(machine.C[place]), machine.direct[place], np.array(machine.A), machine.load
    squares, total, greatest = 0.0, 0.0, -np.inf
    signs = constant.signs if isinstance(constant, OutputPeak) else ()
    for times, states, drive in motion(constant, pieces):
        padded = np.vstack([drive, np.zeros((TERMS + 3, len(times)))])
        jets, moved = [], states
        for i in range(TERMS):  # the output's derivatives, of which its Taylor series is made
            jets.append(row @ moved + direct @ padded[i : i + 3])
            moved = A @ moved + B @ padded[i : i + 3]
        jets[0] = jets[0] + constant.offset
        length = times[1] - times[0]
        taylor = np.array([jet / factorial(i) for i, jet in enumerate(jets)])
        inside = (times >= constant.within[0] - 1e-12) & (times <= constant.duration + 1e-12)
        if isinstance(constant, OutputPeak):
            greatest = max([greatest, *(_highest(sign * taylor[:, inside], length) for sign in signs)])
        else:
            x = 0.5 * length * (X + 1.0)
            values = np.polynomial.polynomial.polyval(x, taylor[:, :-1])
            squares += float(0.5 * length * (values**2 @ WEIGHTS).sum())
            total += float(times[-1] - times[0])
    return greatest if isinstance(constant, OutputPeak) else float(np.sqrt(squares / total))


def _highest(taylor: Array, length: float) -> float:
    if not taylor.shape[1]:
        return -np.inf
    values = taylor[0]
    best = int(np.argmax(values))
    low, high = (0.0 if best == 0 else -length), (0.0 if best == len(values) - 1 else length)
    finer = minimize_scalar(
        lambda s: -np.polynomial.polynomial.polyval(s, taylor[:, best]),
        bounds=(low, high),
        method="bounded",
        options={"xatol": 1e-12},
    )
    return max(float(values[best]), -float(finer.fun))


def _mode(constant: ModeResidual) -> tuple[complex, float]:
    """The root of a mode, and the amplitude that a step of the velocity leaves of it."""
    machine = constant.machine
    values, left, right = _eigen(np.array(machine.A))
    upper = [i for i in np.argsort(np.abs(values)) if values[i].imag > 1e-6 * abs(values[i])]
    i = upper[constant.mode - 1]
    root = complex(values[i])
    row = np.array(machine.C[machine.outputs.index(constant.output)])
    B = machine.load
    return root, float(abs(2.0 * (row @ right[:, i]) * (left[i] @ (B[:, 0] / root + B[:, 1] + root * B[:, 2]))))


def residual_rounding(constant: ModeResidual) -> float:
    """What rounding may leave of an amplitude, which is a sum of parts that cancel."""
    return 1e-12 * _mode(constant)[1]


def residual_value(constant: ModeResidual, pieces: Sequence[Chebyshev]) -> float:
    """Greatest amplitude of the mode, over a grid of the whole box and along its edges."""
    root, share = _mode(constant)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    k, velocity = np.empty(0), np.empty(0)
    for piece in pieces:
        low, high = piece.domain
        # so short that few turns of the mode are in each
        for start, stop in pairwise(np.linspace(low, high, 2 + int((high - low) * abs(root) / TURNED))):
            inside = start + (stop - start) * (nodes + 1.0) / 2.0
            k = np.append(k, inside)
            velocity = np.append(velocity, (stop - start) / 2.0 * weights * piece.deriv()(inside))

    def size(nu: float, angle: float) -> float:
        return float(share * abs(np.exp(1j * nu * np.exp(1j * angle) * (1.0 - k)) @ velocity))

    middle, damping = abs(root), -root.real / abs(root)
    ends = [(1.0 - constant.spread) * middle, (1.0 + constant.spread) * middle]
    angles = [asin(one) for one in constant.dampings or (damping, damping)]
    grid = [
        size(nu, angle) for nu in np.linspace(ends[0], ends[1], 41) for angle in np.linspace(angles[0], angles[1], 9)
    ]
    corners = [
        (ends[0], angles[0]),
        (ends[1], angles[0]),
        (ends[1], angles[1]),
        (ends[0], angles[1]),
        (ends[0], angles[0]),
    ]
    places = np.linspace(0.0, 1.0, 21)
    for first, last in pairwise(corners):

        def along(share: float, first: tuple[float, float] = first, last: tuple[float, float] = last) -> float:
            return size(*(a + share * (b - a) for a, b in zip(first, last, strict=True)))

        sizes = np.array([along(float(s)) for s in places])
        grid.append(float(sizes.max()))
        # in an optimum several are as high as one another
        for best in np.flatnonzero(sizes >= 0.9 * sizes.max()):
            around = (float(places[max(best - 1, 0)]), float(places[min(best + 1, 20)]))  # type: ignore[call-overload]
            options = {"xatol": 1e-9}
            finer = minimize_scalar(  # type: ignore[call-overload]
                lambda s, along=along: -along(float(s)), bounds=around, method="bounded", options=options
            )
            grid.append(-float(finer.fun))
    return max(grid)


def _eigen(matrix: Array) -> tuple[NDArray[np.complex128], NDArray[np.complex128], NDArray[np.complex128]]:
    values, right = np.linalg.eig(matrix)
    return values, np.linalg.inv(right), right
