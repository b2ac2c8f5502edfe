"""The benchmarks themselves: what they time exists, so that `make bench` does not end halfway."""

from pkgutil import resolve_name

import pytest

from optlaws import synthesize
from tests.bench.machines import OBJECTIVES, asked, chain
from tests.bench.study import PARTS


@pytest.mark.parametrize("part", PARTS)
def test_what_a_benchmark_times_is_in_the_package(part: str) -> None:
    assert all(callable(resolve_name(name)) for name in PARTS[part])


def test_the_machine_that_is_timed_has_eight_states_and_proven_laws() -> None:
    machine = chain()
    assert len(machine.A) == 8
    for objective in OBJECTIVES.values():
        solution = synthesize(asked(machine, objective))
        assert (solution.status.value, len(solution.problem.bounds)) == ("optimal", 3)
