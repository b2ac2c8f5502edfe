import os

import pytest
from hypothesis import settings

from tests.known_defects import KNOWN_DEFECTS
from tests.sampling import QUICK, THOROUGH, leave_to_long_runs

settings.register_profile("quick", derandomize=bool(os.environ.get("CI")), deadline=None, max_examples=QUICK)
settings.register_profile("thorough", settings.get_profile("quick"), max_examples=THOROUGH)

# importing the first registers constants that go wrong; the second needs Cosmic Ray and has no doctests
collect_ignore = ["studies/troubles.py", "mutants/trying.py"]


def pytest_configure(config: pytest.Config) -> None:
    settings.load_profile("thorough" if str(config.getoption("markexpr")).startswith("long") else "quick")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    leave_to_long_runs(items)
    for item in items:
        for part, reason in KNOWN_DEFECTS.items():
            if part in item.nodeid:
                item.add_marker(pytest.mark.xfail(reason=reason, strict=True))
