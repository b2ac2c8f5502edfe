"""The vibration that laws leave in an elastic follower, over its frequency."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec
import numpy as np

from optlaws import residual_vibration, response_spectrum
from optlaws.errors import OptlawsError
from optlaws.explorer.answers.asked import MOST_LAWS, AskedLaw, law_of
from optlaws.explorer.answers.law_view import digits, drawn

_COUNT = 241
_LOW = 2.0


class AskedResidual(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """Laws, and the follower whose mass they drive: nu up to which is drawn, the nu that is read, the damping ratio."""

    laws: Annotated[list[AskedLaw], msgspec.Meta(min_length=1, max_length=MOST_LAWS)]
    nu: Annotated[float, msgspec.Meta(gt=0.0, le=1000.0)] = 20.0
    most: Annotated[float, msgspec.Meta(ge=10.0, le=1000.0)] = 80.0
    damping: Annotated[float, msgspec.Meta(ge=0.0, lt=1.0)] = 0.0


def answer(asked: AskedResidual) -> dict[str, Any]:
    """Residual acceleration over nu for each law, in units of a'', and its value at one nu; None where there is no law.

    Examples
    --------
    >>> answered = answer(AskedResidual(laws=[AskedLaw(name="cycloidal")], nu=20.0))
    >>> answered["laws"][0]["text"]
    '2.38289'
    """
    nu = np.linspace(_LOW, asked.most, _COUNT)
    return {"nu": drawn(nu), "laws": [_spectrum(law, nu, asked) for law in asked.laws], "at": asked.nu}


def _spectrum(asked: AskedLaw, nu: Any, follower: AskedResidual) -> dict[str, Any] | None:  # noqa: ANN401 - an array
    try:
        law = law_of(asked)
    except OptlawsError:  # the view of the law says why
        return None
    values = response_spectrum(law, nu, follower.damping).residual_acceleration
    here = residual_vibration(nu=follower.nu, damping=follower.damping).value(law)
    return {"values": drawn(values), "value": here, "text": digits(here, 6)}
