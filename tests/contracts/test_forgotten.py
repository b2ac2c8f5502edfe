"""A class that forgets a method of its protocol is refused when it is made, by a text that names the method."""

from collections.abc import Iterator
from importlib import import_module
from inspect import isabstract

import numpy as np
import pytest

from optlaws import C, Functional, MotionLaw
from tests.documents import ROOT
from tests.imports import modules


def every_class() -> Iterator[type]:
    """The classes that the modules of the package define."""
    for name in sorted(modules(ROOT / "optlaws")):
        if not name.endswith("__main__"):
            module = import_module(name)
            yield from (kind for kind in vars(module).values() if isinstance(kind, type) and kind.__module__ == name)


def left_to_heirs(kind: type) -> list[str]:
    return [name for name in dir(kind) if getattr(getattr(kind, name, None), "__isabstractmethod__", False)]


class Unlisted:
    """Keeps an heir out of the registry of its kind."""

    def __init_subclass__(cls, **_: object) -> None:
        """Nothing."""


PROTOCOLS = [kind for kind in every_class() if left_to_heirs(kind)]


def test_there_are_protocols() -> None:
    assert {"Functional", "ConstraintFamily", "LawSpace", "Basis", "MotionLaw", "Segment"} <= {
        kind.__name__ for kind in PROTOCOLS
    }


@pytest.mark.parametrize("protocol", PROTOCOLS, ids=lambda kind: kind.__name__)
def test_each_method_that_is_forgotten_is_named(protocol: type) -> None:
    assert isabstract(protocol)
    for forgotten in left_to_heirs(protocol):
        others = {name: C.least for name in left_to_heirs(protocol) if name != forgotten}
        heir = type(protocol)("Heir", (Unlisted, protocol), others)
        with pytest.raises(TypeError, match=rf"abstract class Heir .*{forgotten}"):
            heir()


def test_a_constant_without_rows_is_refused_before_anything_is_solved() -> None:
    class Snap(Functional):
        def value(self, law: MotionLaw) -> float:
            return law.peak(4).value

    with pytest.raises(TypeError, match="families"):
        Snap("snap", np.nan, convex=True)  # type: ignore[abstract]
