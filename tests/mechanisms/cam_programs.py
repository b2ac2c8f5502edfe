"""Cams and followers without optlaws: an ODE, quadrature, and linear programs by HiGHS."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev, Polynomial
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import linprog

Array = NDArray[np.float64]
PLACES = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 2501))


class Moved(NamedTuple):
    """Displacement and acceleration of the mass at PLACES, and the residual acceleration's amplitude at k = 1."""

    a: Array
    c: Array
    residual: float


def integrated(cam: Callable[[Array], Array], nu: float, damping: float) -> Moved:
    """The mass of an elastic follower, at rest at first, by DOP853."""
    n = damping * nu

    def slope(k: float, state: Array) -> tuple[float, float]:
        return float(state[1]), float(nu**2 * (cam(np.array(k)) - state[0]) - 2.0 * n * state[1])

    run = solve_ivp(slope, (0.0, 1.0), (0.0, 0.0), "DOP853", PLACES, rtol=1e-12, atol=1e-14)
    a, b = run.y
    off, velocity = a[-1] - 1.0, b[-1]
    damped = np.sqrt(nu**2 - n**2)
    residual = nu**2 * float(np.hypot(off, (velocity + n * off) / damped))
    return Moved(a, nu**2 * (cam(PLACES) - a) - 2.0 * n * b, residual)


def residuals(velocity: Callable[[Array], Array], nu: Array, damping: float) -> Array:
    """Residual accelerations by quadrature of exp(w (1-k)) b; breaks at n/8 and n/12 fall between its panels."""
    x, weights = np.polynomial.legendre.leggauss(20)
    k = ((np.arange(24)[:, None] + (1.0 + x) / 2.0) / 24.0).ravel()
    w = -damping * nu + 1j * nu * np.sqrt(1.0 - damping**2)
    transform = np.exp(np.outer(w, 1.0 - k)) @ (np.tile(weights / 48.0, 24) * velocity(k))
    sizes: Array = nu**2 * np.abs(w) / w.imag * np.abs(transform)
    return sizes


def laws(order: int, degree: int) -> list[Polynomial]:
    """k^l (1-k)^l T_i(2k - 1) for every i, then the base law, by numpy alone."""
    edge = Polynomial([0.0, 1.0, -1.0]) ** order
    free = [edge * Chebyshev.basis(i, domain=[0.0, 1.0]).convert(kind=Polynomial) for i in range(degree + 1)]
    slope = Polynomial([0.0, 1.0, -1.0]) ** (order - 1)
    return [*free, slope.integ() / slope.integ()(1.0)]


def values(functions: list[Polynomial], k: Array) -> Array:
    """Columns of values at k."""
    return np.column_stack([function(k) for function in functions])


def least_cam_acceleration(B: float, order: int, degree: int, nu: float, damping: float) -> float:
    """The least C of the cam of laws with b <= b(1/2) = B, c(1/2) = 0, held on a grid of k."""
    free = laws(order, degree)
    c = values([one.deriv(2) for one in free], PLACES)
    c += 2.0 * damping / nu * values([one.deriv(3) for one in free], PLACES)
    c += values([one.deriv(4) for one in free], PLACES) / nu**2
    b = values([one.deriv() for one in free], PLACES)
    ones = np.ones((len(PLACES), 1))
    rows = np.vstack(
        [np.hstack([sign * c[:, :-1], -ones]) for sign in (1.0, -1.0)] + [np.hstack([b[:, :-1], 0 * ones])]
    )
    right = np.concatenate([-c[:, -1], c[:, -1], B - b[:, -1]])
    middle = np.array([0.5])
    equal = np.vstack([values([one.deriv(i) for one in free], middle) for i in (1, 2)])
    return _solved(rows, right, np.hstack([equal[:, :-1], np.zeros((2, 1))]), np.array([B, 0.0]) - equal[:, -1])


def least_acceleration(order: int, degree: int, nu: Array, damping: float, most: float) -> float:
    """The least C of laws whose residual, seen from 64 directions, is at most `most` at some frequencies."""
    directions = 64
    free = laws(order, degree)
    c = values([one.deriv(2) for one in free], PLACES)
    ones = np.ones((len(PLACES), 1))
    rows = [np.hstack([sign * c[:, :-1], -ones]) for sign in (1.0, -1.0)]
    x, weights = np.polynomial.legendre.leggauss(80)
    k = (1.0 + x) / 2.0
    w = -damping * nu + 1j * nu * np.sqrt(1.0 - damping**2)
    transform = np.exp(np.outer(w, 1.0 - k)) @ (weights[:, None] / 2.0 * values([one.deriv() for one in free], k))
    p = (nu**2 * np.abs(w) / w.imag)[:, None] * transform
    seen = [(p * np.exp(-1j * angle)).real for angle in 2.0 * np.pi * np.arange(directions) / directions]
    cones = np.vstack(seen)
    right = np.concatenate([-c[:, -1], c[:, -1], most - cones[:, -1]])
    rows.append(np.hstack([cones[:, :-1], np.zeros((len(cones), 1))]))
    return _solved(np.vstack(rows), right)


def _solved(rows: Array, right: Array, equal: Array | None = None, equal_right: Array | None = None) -> float:
    scale = np.abs(rows).max(axis=0)
    cost = np.zeros(rows.shape[1])
    cost[-1] = 1.0
    equal = None if equal is None else equal / scale
    optimum = linprog(cost / scale, rows / scale, right, equal, equal_right, bounds=(None, None), method="highs-ds")
    assert optimum.status == 0
    assert optimum.x is not None
    return float(optimum.x[-1] / scale[-1])
