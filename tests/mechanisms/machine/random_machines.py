"""Random machines of every kind and what they do by means that share nothing with optlaws."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from optlaws import Machine, PolynomialLaw

Array = NDArray[np.float64]

KINDS = ("dense", "undamped", "defective", "critical", "overdamped", "stiff", "drifting")
MOST_STATES = 8
INPUTS = ("a", "b", "c", "ab", "ac", "abc")


@dataclass(frozen=True)
class Case:
    """A machine with one output for each state and one that every input enters, and a law with its polynomial a."""

    kind: str
    machine: Machine
    law: PolynomialLaw
    a: np.polynomial.Chebyshev


def random_case(seed: int) -> Case:
    """A machine of up to eight states and a law of degree up to 14, with velocities at both ends."""
    rng = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    A = _matrix(kind, rng)
    size, inputs = len(A), str(rng.choice(INPUTS))
    turn = np.eye(size) if kind in {"stiff", "drifting"} else np.linalg.qr(rng.normal(size=(size, size)))[0]
    A = turn @ A @ turn.T
    B = rng.normal(size=(size, len(inputs))) * np.linalg.norm(A, axis=1)[:, None]
    C = np.vstack([np.eye(size), rng.normal(size=(1, size))])
    D = np.vstack([np.zeros((size, len(inputs))), rng.normal(size=(1, len(inputs)))])
    c, b0 = rng.normal(size=int(rng.integers(1, 13))), float(rng.normal())
    a = np.polynomial.Chebyshev(c, domain=[0, 1]).integ(lbnd=0, k=b0).integ(lbnd=0)
    return Case(kind, Machine(A, B, C, D, inputs=inputs), PolynomialLaw(c, b0=b0), a)


def _matrix(kind: str, rng: np.random.Generator) -> Array:
    if kind == "dense":
        size = int(rng.integers(1, MOST_STATES + 1))
        A = 8.0 * rng.normal(size=(size, size))
        return np.asarray(A - np.eye(size) * (float(np.linalg.eigvals(A).real.max()) + rng.uniform(0.0, 1.0)))
    if kind == "drifting":  # a state that integrates what drives it, with a vibration beside it
        return _blocks([np.zeros((1, 1)), _oscillator(float(rng.uniform(2.0, 40.0)), 0.02)])
    pairs = int(rng.integers(1, MOST_STATES // 2 + 1))
    if kind == "defective":  # the same vibration, one part driving the next
        one = _oscillator(float(rng.uniform(2.0, 30.0)), float(rng.uniform(0.0, 0.2)))
        return np.kron(np.eye(pairs), one) + np.kron(np.eye(pairs, k=1), np.eye(2))
    dampings = {"undamped": 0.0, "critical": 1.0, "overdamped": float(rng.uniform(1.2, 4.0)), "stiff": 0.01}
    fastest = 500.0 if kind == "stiff" else 60.0
    return _blocks([_oscillator(float(nu), dampings[kind]) for nu in rng.uniform(0.02 * fastest, fastest, size=pairs)])


def _oscillator(nu: float, damping: float) -> Array:
    return nu * np.array([[0.0, 1.0], [-1.0, -2.0 * damping]])


def _blocks(parts: list[Array]) -> Array:
    size = sum(map(len, parts))
    found, place = np.zeros((size, size)), 0
    for part in parts:
        found[place : place + len(part), place : place + len(part)] = part
        place += len(part)
    return found


def integrated(case: Case, k: Array) -> Array:
    """Outputs at times k, shape (outputs, times), by DOP853 in the rise and in the dwell."""
    machine, b, c = case.machine, case.a.deriv(), case.a.deriv(2)
    A, B, C, D = (np.array(one) for one in (machine.A, machine.B, machine.C, machine.D))
    jump = B[:, machine.inputs.index("c")] if "c" in machine.inputs else np.zeros(len(A))

    def drive(time: float) -> Array:
        if time > 1.0:
            values = {"a": case.a(1.0), "b": 0.0, "c": 0.0}
        else:
            values = {"a": case.a(time), "b": b(time), "c": c(time)}
        return np.array([float(values[one]) for one in machine.inputs])

    def course(start: float, stop: float, state: Array, *, dwell: bool) -> Array:
        inside = k[(k > start) & (k <= stop)]
        last = 1.0 + 1e-9 if dwell else 0.0

        def slope(time: float, x: Array) -> Array:
            return np.asarray(A @ x + B @ drive(max(time, last)))

        times = np.unique([*inside, stop])
        longest = 1.0 / (
            1.0 + float(np.abs(machine.dynamics.roots).max())
        )  # for what it interpolates between its steps
        run = solve_ivp(slope, (start, stop), state, "DOP853", times, rtol=1e-12, atol=1e-14, max_step=longest).y
        values = [C @ x + D @ drive(max(time, last)) for time, x in zip(inside, run.T, strict=False)]
        outputs.extend(values)
        return np.asarray(run[:, -1])

    outputs: list[Array] = []
    state = course(0.0, 1.0, jump * float(b(0.0)), dwell=False)
    course(1.0, float(k.max()), state - jump * float(b(1.0)), dwell=True)
    return np.array(outputs).T
