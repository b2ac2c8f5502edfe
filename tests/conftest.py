import os

import pytest
from hypothesis import settings

from tests.known_defects import KNOWN_DEFECTS

settings.register_profile("ci", derandomize=True, deadline=None)
settings.register_profile("dev", deadline=None)
settings.load_profile("ci" if os.environ.get("CI") else "dev")

# importing the first registers constants that go wrong; the second needs Cosmic Ray and has no doctests
collect_ignore = ["studies/troubles.py", "mutants/trying.py"]


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        for part, reason in KNOWN_DEFECTS.items():
            if part in item.nodeid:
                item.add_marker(pytest.mark.xfail(reason=reason, strict=True))
