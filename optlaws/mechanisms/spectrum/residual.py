"""The free vibration that a law leaves behind, in closed form and linear in the law."""

from __future__ import annotations

from typing import Any

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.mechanisms.spectrum.transforms import legendre_from_chebyshev, moments, velocity_transform
from optlaws.numbers import Array, Complex, frequency, not_negative, numbers, whole


def residual_phasor(law: MotionLaw, nu: Any, damping: float = 0.0) -> Complex:  # noqa: ANN401 - numbers of any kind
    """Complex amplitude Z of the free vibration after a law, the mass at rest at first; linear in the law.

    For k >= 1 the mass moves by a_m = a(1) + Re(Z exp(w (k - 1))), w = -n + i lambda, lambda = nu sqrt(1 - zeta²). |Z|
    is the residual displacement and nu² |Z| the residual acceleration. With wbar the conjugate of w,
    Z = -i wbar/lambda times the integral of exp(w (1 - k)) b(k), in closed form for polynomials and sines.

    Parameters
    ----------
    law
        Motion of the cam.
    nu
        Frequencies, above 0; a number or shape (m,).
    damping
        Ratio zeta, below 1.

    Returns
    -------
    Complex array, shape (m,).

    Raises
    ------
    InputError
        If a number is out of range.

    Examples
    --------
    >>> from optlaws.laws.savin import savin
    >>> 18**2 * abs(residual_phasor(savin("III", 7.2), 18)).round(12)
    array([7.204401])
    """
    _, w, damped = roots(nu, damping)
    return -1j * w.conj() / damped * velocity_transform(law, w)


def residual_functional(count: int, nu: Any, damping: float = 0.0) -> tuple[Complex, Complex]:  # noqa: ANN401
    """The rows that turn a polynomial law's coefficients into the complex amplitude of its free vibration.

    With ``rows, start = residual_functional(len(law.acceleration), nu, damping)`` the residual acceleration is
    ``abs(rows @ law.acceleration + start * law.b0)``: nu² times `residual_phasor`, affine in whatever the law is
    affine in, so that a bound on it is a second-order cone for each nu.

    Parameters
    ----------
    count
        Number of Chebyshev coefficients of c.
    nu
        Frequencies, above 0; a number or shape (m,).
    damping
        Ratio zeta, below 1.

    Returns
    -------
    Complex arrays of shape (m, count) and (m,).

    Raises
    ------
    InputError
        If a number is out of range.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> law = smoothstep(4)
    >>> rows, start = residual_functional(len(law.acceleration), [20.0], 0.05)
    >>> abs(rows @ law.acceleration + start * law.b0).round(6)
    array([1.650151])
    """
    frequencies, w, damped = roots(nu, damping)
    terms = whole(count, "count", least=1)
    scale = (-1j * frequencies**2 * w.conj() / (damped * w))[:, None]
    n = np.arange(terms)
    mean = np.where(n % 2 == 0, 1.0 / (1.0 - n * n + (n % 2)), 0.0)
    rows = moments(0.5 * w, terms) @ legendre_from_chebyshev(terms) - mean
    return scale * rows, scale[:, 0] * np.expm1(w)


def roots(nu: Any, damping: float) -> tuple[Array, Complex, Array]:  # noqa: ANN401 - numbers of any kind
    """Frequencies nu, roots w = -n + i lambda and lambda of followers below critical damping."""
    frequencies = np.array(numbers(np.atleast_1d(np.asarray(nu)).tolist(), "nu"))
    ratio = not_negative(damping, "damping")
    if not (frequencies > 0.0).all():
        raise InputError(f"nu must be above 0, got {float(frequencies.min())!r}")
    if frequencies.size:
        frequency(frequencies.max())
    if ratio >= 1.0:
        raise InputError(
            f"damping must be below 1, got {shortened(damping)}: from the critical damping on nothing vibrates; "
            "Follower.response tells how the mass comes to rest"
        )
    damped = frequencies * np.sqrt((1.0 - ratio) * (1.0 + ratio))
    return frequencies, -ratio * frequencies + 1j * damped, damped
