"""Every kind of a protocol that the package has, so that a suite fails while one lacks an example."""

from collections.abc import Iterator
from importlib import import_module
from inspect import isabstract

from tests.documents import ROOT
from tests.imports import modules


def kinds(protocol: type) -> set[type]:
    """The classes of the package that keep a protocol and can be made."""
    for module in modules(ROOT / "optlaws"):
        if not module.endswith("__main__"):
            import_module(module)
    return {kind for kind in _heirs(protocol) if kind.__module__.startswith("optlaws.") and not isabstract(kind)}


def _heirs(protocol: type) -> Iterator[type]:
    yield protocol
    for heir in protocol.__subclasses__():
        yield from _heirs(heir)
