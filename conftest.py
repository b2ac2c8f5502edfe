"""Makes the documents' code blocks tests (see tests/documents.py), wherever pytest starts from."""

import gc
import os
import sys
from collections.abc import Generator
from contextlib import chdir
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory

# Before anything imports matplotlib: tests, doctests and documents draw without a display.
os.environ["MPLBACKEND"] = "Agg"

import pytest
from xdist.remote import Producer
from xdist.scheduler import LoadFileScheduling

from tests.documents import documents
from tests.internals.cli import output

#: on a slow machine commands would say every ten seconds what they are doing, beside the answers that tests compare
output.BETWEEN_LINES = 3600.0

# tests start some hundred processes, each of which would compile the package again
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False

#: the gallery's examples are run when the pages are made, and their copies stand beside them
collect_ignore_glob = ["docs/examples/*.py", "docs/gallery/*", "docs/_build/*"]

_PACKAGE = Path(__file__).parent / "optlaws"
_collect_document = documents.pytest()


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Collect a document; import a module of the package as Python does before its doctests are looked for.

    Pytest's own import runs a module again whose package has imported it, and values of the two are never equal.
    """
    if file_path.suffix == ".py" and _PACKAGE in file_path.parents and file_path.name != "__main__.py":
        place = file_path.relative_to(_PACKAGE.parent).with_suffix("")
        import_module(".".join(place.parts if place.name != "__init__" else place.parts[:-1]))
    found: pytest.Collector | None = _collect_document(file_path, parent)
    return found


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Let nothing look for garbage among thousands of tests that stay: neither while they are collected nor later."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None, object, object]:
    """Run a docstring's example in a directory of its own: what it writes is not left in the repository."""
    if not isinstance(item, pytest.DoctestItem):
        return (yield)
    with TemporaryDirectory() as directory, chdir(directory):
        return (yield)


def pytest_runtest_teardown() -> None:
    """Close what a test drew: pyplot keeps every figure, and warns from the twentieth on."""
    if "matplotlib.pyplot" in sys.modules:
        import matplotlib.pyplot as plt

        plt.close("all")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Producer) -> LoadFileScheduling:
    """Keep a file in one process: blocks of a document use each other's names, tests what others have solved.

    They come in their order, not those of most tests first: what is slow is few tests, and would come last.
    """
    config.option.loadscopereorder = False
    return LoadFileScheduling(config, log)
