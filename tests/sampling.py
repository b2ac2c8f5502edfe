"""Cases of which a few run each time, and the rest where long tests are asked for."""

from collections.abc import Iterable
from typing import Any

import pytest
from _pytest.mark.structures import ParameterSet


def sampled(cases: Iterable[Any], each: int = 3) -> list[ParameterSet]:
    """Every so many of the cases, from the first on, for each run; the others for `make test-long`."""
    return [
        pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=[pytest.mark.long] if i % each else [])
        for i, case in enumerate(cases)
    ]
