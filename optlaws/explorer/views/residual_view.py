"""Vibration left in an elastic follower as the page shows it: over its frequency, in a band, by a measured spectrum."""

from __future__ import annotations

from math import isfinite
from typing import Annotated, Any

import msgspec
import numpy as np

from optlaws import residual_vibration, response_spectrum
from optlaws.errors import InputError, OptlawsError
from optlaws.explorer.views.law_view import digits
from optlaws.explorer.views.panel_data import drawn
from optlaws.explorer.views.requests import MOST_LAWS, LawRequest, Question, law_of
from optlaws.mechanisms.measured_spectrum import MOST_POINTS, Spectrum, weight_of
from optlaws.mechanisms.residual import Residual
from optlaws.motion.quantities import positive_quantity
from optlaws.numbers import Array

_COUNT = 241
#: beyond this the envelope of the vibration, which the residual is, says nothing of what little is left to see
MOST_DAMPING = 0.5
_LOW = 2.0

Frequency = Annotated[float, msgspec.Meta(gt=0.0, le=1000.0)]
Pairs = Annotated[list[tuple[float, float]], msgspec.Meta(min_length=2, max_length=MOST_POINTS)]
Duration = Annotated[str, msgspec.Meta(max_length=60)]


class ResidualRequest(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Laws, and the follower that they drive: the highest displayed frequency, the selected one, the damping.

    A band is of frequencies nu over which the greatest residual is computed, a spectrum pairs of a frequency and an
    amplitude: nu, or Hz where the duration of the motion is given.
    """

    laws: Annotated[list[LawRequest], msgspec.Meta(min_length=1, max_length=MOST_LAWS)]
    frequency: Frequency = 20.0
    most: Annotated[float, msgspec.Meta(ge=10.0, le=1000.0)] = 80.0
    damping: Annotated[float, msgspec.Meta(ge=0.0, le=MOST_DAMPING)] = 0.0
    band: tuple[Frequency, Frequency] | None = None
    spectrum: Pairs | None = None
    duration: Duration | None = None


class SpectrumRequest(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A measured spectrum, pairs of a frequency and an amplitude: in Hz where the duration of the motion is given."""

    pairs: Pairs
    duration: Duration | None = None


def residuals(request: ResidualRequest) -> dict[str, Any]:
    """Residual and peak acceleration of each law over frequencies, in units of a'', at one frequency, in a band."""
    frequencies = np.linspace(_LOW, request.most, _COUNT)
    weight = None if request.spectrum is None else weight_of(request.spectrum, request.duration)
    constant = _constant(request, weight)
    return {
        "frequencies": drawn(frequencies),
        "laws": [_spectrum(law, frequencies, request, constant) for law in request.laws],
        "at": request.frequency,
        "weight": [] if weight is None else [list(pair) for pair in weight],
        "band": None if constant is None else [constant.low, constant.high],
        "constant": None if constant is None else str(constant),
    }


def _constant(request: ResidualRequest, weight: Spectrum | None) -> Residual | None:
    """The greatest residual in the band, weighed where there is a spectrum; None without either."""
    if weight is None and request.band is None:
        return None
    band = request.band
    if weight is not None and band is not None:
        band = max(band[0], weight[0][0]), min(band[1], weight[-1][0])
        if not band[0] < band[1]:
            ends = f"{digits(weight[0][0], 5)} to {digits(weight[-1][0], 5)}"
            raise InputError(f"the spectrum is known from {ends}, where the band is not: move the band there")
    return residual_vibration(frequency=band, damping=request.damping, spectrum=weight)


def _spectrum(
    request: LawRequest, frequencies: Array, follower: ResidualRequest, constant: Residual | None
) -> dict[str, Any] | None:
    try:
        law = law_of(request)
    except OptlawsError:  # the view of the law says why
        return None
    spectrum = response_spectrum(law, frequencies, follower.damping)
    here = residual_vibration(frequency=follower.frequency, damping=follower.damping).value(law)
    beside = response_spectrum(law, [follower.frequency], follower.damping).peak_acceleration
    greatest = None if constant is None else constant.peak(law)
    return {
        "values": drawn(spectrum.residual_acceleration),
        "peaks": drawn(spectrum.peak_acceleration),
        "value": here,
        "peak": float(beside[0]),
        "text": digits(here, 6),
        "band": None
        if greatest is None or not isfinite(greatest.value)
        else {"value": greatest.value, "text": digits(greatest.value, 6), "at": digits(greatest.k, 5)},
    }


def spectrum(request: SpectrumRequest) -> dict[str, Any]:
    """What a measured spectrum is over nu, in words, and the duration of the motion in seconds where one is given.

    Examples
    --------
    >>> spectrum(SpectrumRequest(pairs=[(30.0, 0.2), (32.0, 1.0)], duration="0.1 s"))
    {'text': '2 points, nu 18.85 to 20.11', 'seconds': 0.1}
    """
    frequencies = np.array(request.pairs)[:, 0]
    if (np.diff(frequencies) <= 0.0).any():
        raise InputError("the frequencies of a spectrum increase from line to line: sort the file by its first column")
    weight = weight_of(request.pairs, request.duration)
    return {
        "text": f"{len(weight)} points, nu {digits(weight[0][0], 4)} to {digits(weight[-1][0], 4)}",
        "seconds": None if request.duration is None else positive_quantity(request.duration, "time", "duration"),
    }


QUESTIONS: dict[str, Question] = {"residual": (ResidualRequest, residuals), "spectrum": (SpectrumRequest, spectrum)}
