"""Vibration left in an elastic follower as the page shows it: over its frequency, in a band, by a measured spectrum."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import msgspec
import numpy as np

from optlaws import MotionLaw, residual_vibration, response_spectrum
from optlaws.errors import InputError, OptlawsError
from optlaws.explorer.views.law_view import digits
from optlaws.explorer.views.panel_data import beside_each_other, panel_data
from optlaws.explorer.views.requests import LawsRequest, Pairs, Question, Text, law_of
from optlaws.mechanisms.measured_spectrum import Spectrum, weight_of
from optlaws.mechanisms.residual import Residual
from optlaws.motion.quantities import positive_quantity
from optlaws.numbers import bounded

_COUNT = 241
_LOW = 2.0


class SpectrumRequest(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A measured spectrum, pairs of a frequency and an amplitude: in Hz where the duration of the motion is given."""

    pairs: Pairs
    duration: Text | None = None


def residuals(request: LawsRequest) -> dict[str, Any]:
    """Residual and peak acceleration of each law over frequencies, in units of a'', at one frequency, in a band."""
    weight = None if request.spectrum is None else weight_of(request.spectrum, request.duration)
    constant, laws = _constant(request, weight), dict(_laws(request))
    frequencies = np.union1d(np.linspace(_LOW, request.most, _COUNT), request.frequency)
    spectra = {i: response_spectrum(law, frequencies, request.damping) for i, law in laws.items()}
    curves = [(i, spectrum.report().panels) for i, spectrum in spectra.items()]
    left = {i: float(each.residual_acceleration[frequencies == request.frequency][0]) for i, each in spectra.items()}
    shown = {i: {"text": digits(left[i], 6), "band": _greatest(law, constant)} for i, law in laws.items()}
    return {
        "range": [_LOW, request.most],
        "panels": [panel_data(panel, 1.0) for panel in (beside_each_other(curves[0][1], curves) if curves else ())],
        "laws": [shown.get(i) for i in range(len(request.laws))],
        "at": request.frequency,
        "weight": [] if weight is None else [list(pair) for pair in weight],
        "band": None if constant is None else [constant.low, constant.high],
        "constant": None if constant is None else str(constant),
    }


def _laws(request: LawsRequest) -> Iterator[tuple[int, MotionLaw]]:
    """The laws that there are, by their numbers: the view of the others says why there is none."""
    for i, law in enumerate(request.laws):
        with suppress(OptlawsError):
            yield i, law_of(law)


def _constant(request: LawsRequest, weight: Spectrum | None) -> Residual | None:
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


def _greatest(law: MotionLaw, constant: Residual | None) -> dict[str, Any] | None:
    """The greatest residual of a law in the band, and where."""
    peak = None if constant is None else constant.peak(law)
    if peak is None or bounded(peak.value) is None:
        return None
    return {"value": peak.value, "text": digits(peak.value, 6), "at": digits(peak.k, 5)}


def spectrum(request: SpectrumRequest) -> dict[str, Any]:
    """The duration of the motion in seconds where one is given, for a spectrum that can weigh a band.

    >>> spectrum(SpectrumRequest(pairs=[(30.0, 0.2), (32.0, 1.0)], duration="0.1 s"))
    {'seconds': 0.1}
    """
    weight_of(request.pairs, request.duration)
    return {"seconds": None if request.duration is None else positive_quantity(request.duration, "time", "duration")}


QUESTIONS: dict[str, Question] = {"residual": (LawsRequest, residuals), "spectrum": (SpectrumRequest, spectrum)}
