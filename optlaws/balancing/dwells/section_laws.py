"""The properties that a dwell mechanism needs of the laws on its sections."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from optlaws.balancing.loaders.loader import Loader
from optlaws.balancing.loaders.tops import tops
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.numerics.tolerances import AGREEMENT


@lru_cache(maxsize=64)
def loader_of(law: MotionLaw) -> Loader:
    """The loader of a law, kept."""
    return Loader(law)


@lru_cache(maxsize=64)
def peak_velocity(law: MotionLaw) -> float:
    """B of a law, kept."""
    return law.peak(1).value


@lru_cache(maxsize=64)
def peak_power(law: MotionLaw) -> float:
    """D of a law, kept."""
    return law.power_peak().value


@lru_cache(maxsize=64)
def top(law: MotionLaw) -> float:
    """The place where a law is cut into a run-up and a run-out: the middle of the top of its velocity.

    Examples
    --------
    >>> from optlaws.laws import smoothstep
    >>> top(smoothstep(2))
    0.5
    """
    places = tops(law)
    middle = places[len(places) // 2]
    return 0.5 * (middle.first + middle.last)


@lru_cache(maxsize=64)
def _ends(law: MotionLaw) -> tuple[float, float, float, float]:
    (a0, b0), (a1, b1) = law.boundary_values(2)
    return a0, b0, a1, b1


def law_of(given: Any) -> Any:  # noqa: ANN401 - whatever the caller gave, a law or not
    """The law of an entry of the catalogue or of a solution; everything else as it is."""
    law = getattr(given, "law", None)
    return law if isinstance(law, MotionLaw) and not isinstance(given, MotionLaw) else given


def check_law(name: str, law: Any) -> None:  # noqa: ANN401 - whatever the caller gave
    """Refuse what is no law from rest to rest over a stroke of 1."""
    if not isinstance(law, MotionLaw):
        raise InputError(f"{name} must be a MotionLaw, or what has one in `law`, got {shortened(law)}")
    a0, b0, a1, b1 = _ends(law)
    if max(abs(b0), abs(b1)) > AGREEMENT * peak_velocity(law) or abs(a1 - a0 - 1.0) > AGREEMENT:
        raise InputError(
            f"{name} must run from rest to rest over a stroke of 1; it begins with a = {a0:g}, b = {b0:g}, ends with "
            f"a = {a1:g}, b = {b1:g}"
        )
    tops(law)
