"""The reading of a law from a name of the catalogue, a file, or the law itself."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.reading import is_file, read_law

STROKE = 1e-9


def named_law(given: Any, where: str) -> MotionLaw:  # noqa: ANN401 - it is checked here
    """The law of a name, a file or a value; `where` is what an error calls the segment.

    Raises
    ------
    InputError
        If there is no such law, or its stroke is not 1.

    Examples
    --------
    >>> named_law("cycloidal", "segment 1").continuity
    9
    """
    try:
        law = given if isinstance(given, MotionLaw) else _read(given)
    except InputError as error:
        raise InputError(f"{where}: law: {error}") from None
    stroke = float(law.a(1.0)) - float(law.a(0.0))
    if abs(stroke - 1.0) > STROKE:
        raise InputError(f"{where}: its law must have the stroke 1, which `by` multiplies, but it has {stroke:g}")
    return law


@lru_cache(maxsize=64)
def _of_name(name: str) -> MotionLaw:
    return read_law(name)


def _read(given: Any) -> MotionLaw:  # noqa: ANN401
    if not isinstance(given, str):
        raise InputError(f"a law, a name of the catalogue, a JSON or CSV file or 'optimal', got {shortened(given)}")
    return read_law(given) if is_file(given) else _of_name(given)
