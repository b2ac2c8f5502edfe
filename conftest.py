"""Makes the documents' code blocks tests (see tests/documents.py), wherever pytest starts from."""

import os

# Before anything imports matplotlib: tests, doctests and documents draw without a display.
os.environ["MPLBACKEND"] = "Agg"

import pytest
from xdist.remote import Producer
from xdist.scheduler import LoadScopeScheduling

from tests.documents import documents

pytest_collect_file = documents.pytest()


class DocumentScheduling(LoadScopeScheduling):  # type: ignore[misc]  # xdist is untyped
    """Keeps a document's blocks, which use each other's names, in one process; all else is spread freely."""

    def _split_scope(self, nodeid: str) -> str:
        path = nodeid.partition("::")[0]
        return path if path.endswith(".md") else nodeid


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Producer) -> DocumentScheduling:
    """Use the scheduling above; xdist's own groups (--dist=loadgroup) are lost under pytest 9.2."""
    return DocumentScheduling(config, log)
