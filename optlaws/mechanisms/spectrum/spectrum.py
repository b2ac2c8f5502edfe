"""Response spectrum: what a law does to followers of every frequency."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.mechanisms.checks import motion_law
from optlaws.mechanisms.spectrum.mass_peaks import peak_accelerations
from optlaws.mechanisms.spectrum.residual import residual_phasor, roots
from optlaws.numbers import Array


@dataclass(frozen=True, eq=False)
class ResponseSpectrum:
    """Free vibration and peak acceleration over the follower's frequency; made by `response_spectrum`.

    Parameters
    ----------
    law
        Motion of the cam.
    damping
        Ratio zeta of all followers.
    nu
        Their frequencies, shape (m,).
    phasor
        Complex amplitudes of their free vibrations at k = 1.

    Examples
    --------
    >>> from optlaws.laws.savin import savin
    >>> spectrum = response_spectrum(savin("III", 7.2), [18.0, 20.0])
    >>> spectrum.residual_acceleration.round(6), spectrum.peak_acceleration.round(4)
    (array([7.204401, 1.140114]), array([13.7651, 11.2675]))
    """

    law: MotionLaw
    damping: float
    nu: Array
    phasor: NDArray[np.complex128]

    def __eq__(self, other: object) -> bool:
        return self._contents() == other._contents() if isinstance(other, ResponseSpectrum) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._contents())

    def _contents(self) -> tuple[MotionLaw, float, tuple[float, ...], tuple[complex, ...]]:
        return self.law, self.damping, tuple(self.nu.tolist()), tuple(self.phasor.tolist())

    @property
    def residual_displacement(self) -> Array:
        """Amplitudes of the free vibrations at k = 1, the envelope's if damped; shape (m,)."""
        return np.abs(self.phasor)

    @property
    def residual_acceleration(self) -> Array:
        """nu² times the residual displacement, shape (m,)."""
        return self.nu**2 * self.residual_displacement

    @kept_property
    def peak_acceleration(self) -> Array:
        """Greatest |a_m''| of the rise, shape (m,), to about 1e-6; computed when first asked for."""
        _, w, _ = roots(self.nu, self.damping)
        return peak_accelerations(self.law, self.nu, w)


def response_spectrum(law: MotionLaw, nu: Any, damping: float = 0.0) -> ResponseSpectrum:  # noqa: ANN401 - numbers of any kind
    """The response spectrum of a law, the mass at rest at first.

    Parameters
    ----------
    law
        Motion of the cam.
    nu
        Frequencies, above 0; shape (m,).
    damping
        Ratio zeta, below 1, the same for all.

    Raises
    ------
    InputError
        If a number is out of range.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> import numpy as np
    >>> spectrum = response_spectrum(smoothstep(4), np.linspace(2.0, 200.0, 10_000))
    >>> float(spectrum.residual_acceleration[spectrum.nu > 100].max())
    0.167...
    """
    frequencies, _, _ = roots(nu, damping)
    return ResponseSpectrum(motion_law(law), float(damping), frequencies, residual_phasor(law, frequencies, damping))
