"""Cams and followers without optlaws: an ODE and quadrature."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

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
