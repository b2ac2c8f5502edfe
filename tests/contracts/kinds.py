"""Every kind of a protocol that the package has, so that a suite fails while one lacks an example."""

from collections.abc import Iterator
from importlib import import_module

from tests.documents import ROOT
from tests.imports import modules


def kinds(protocol: type) -> set[type]:
    """The classes of the package that keep a protocol and can be made."""
    for module in modules(ROOT / "optlaws"):
        if not module.endswith("__main__"):
            import_module(module)
    return {kind for kind in _heirs(protocol) if kind.__module__.startswith("optlaws.") and not _lacking(kind)}


def _lacking(kind: type) -> bool:
    """Whether a method is left to its heirs, also where Python would make one all the same."""
    return any(getattr(getattr(kind, name, None), "__isabstractmethod__", False) for name in dir(kind))


def _heirs(protocol: type) -> Iterator[type]:
    yield protocol
    heirs: list[type] = protocol.__subclasses__()
    for heir in heirs:
        yield from _heirs(heir)
