"""The benchmarks themselves: what they time exists, so that `make bench` does not end halfway."""

from optlaws import synthesize
from tests.bench.machines import OBJECTIVES, asked, chain


def test_the_machine_that_is_timed_has_eight_states_and_proven_laws() -> None:
    machine = chain()
    assert len(machine.A) == 8
    for objective in OBJECTIVES.values():
        solution = synthesize(asked(machine, objective))
        assert (solution.status.value, len(solution.problem.bounds)) == ("optimal", 3)
