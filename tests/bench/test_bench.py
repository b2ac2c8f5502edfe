"""The benchmarks themselves: what they time exists, so that `make bench` does not end halfway."""

from pkgutil import resolve_name

import pytest

from tests.bench.study import PARTS


@pytest.mark.parametrize("part", PARTS)
def test_what_a_benchmark_times_is_in_the_package(part: str) -> None:
    assert all(callable(resolve_name(name)) for name in PARTS[part])
