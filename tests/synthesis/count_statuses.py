"""What becomes of random problems over every public option: python -m tests.synthesis.count_statuses SEED COUNT.

With `units` as a third argument formulas, machines, weights and windows are drawn too, in units from 1e-12 to 1e9.

Each answer is judged from its law alone and against the law that the problem was drawn around. The counts go by kind
of problem and by outcome; problems that raised, came out inaccurate, were judged wrong or took long are listed.
"""

import sys
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from time import perf_counter

from optlaws import InfeasibleProblem, NotNormalised, Problem, SolverFailure, synthesize
from tests.synthesis.judge import Judged, judge, lower_bounded
from tests.synthesis.random_options import Drawn, every_option, every_unit

SLOW = 20.0


@dataclass(frozen=True)
class Outcome:
    """How a problem ended: a status, "infeasible", "no least value" or what went wrong; and the seconds it took."""

    status: str
    why: str
    seconds: float

    @property
    def trouble(self) -> bool:
        """Whether it is to be listed."""
        return self.status not in {"optimal", "local", "infeasible", "no least value"} or self.seconds > SLOW


def outcome(one: Drawn) -> Outcome:
    """Solve and judge; nothing is raised."""
    began = perf_counter()
    try:
        status, why = _answer(one)
    except Exception as error:  # noqa: BLE001 - whatever escapes is what is counted
        status, why = type(error).__name__, " ".join(str(error).split())[:300]
    return Outcome(status, why, perf_counter() - began)


def _answer(one: Drawn) -> tuple[str, str]:
    try:
        solution = synthesize(one.problem)
    except InfeasibleProblem as error:
        return ("infeasible", "") if one.witness is None else ("infeasible?", str(error).partition("\n")[0])
    except SolverFailure as error:
        message = str(error).partition("\n")[0]
        # as it should be: such a problem has no answer
        return ("no least value", "") if "has no least value" in message else ("failed", message)
    if solution.status.value == "inaccurate":
        return "inaccurate", f"gap {solution.gap:.1e}"
    judge(solution)
    if one.witness is not None:
        best = Judged(one.witness).worth(one.problem.objective)
        allowed = 1e-8 * abs(best) + 1e-11 * one.problem.objective.scale
        assert solution.lower_bound <= best + allowed, f"the bound is above the known law's {best!r}"
        if solution.status.value == "optimal" or (one.problem.convex and not lower_bounded(one.problem)):
            assert solution.objective <= best + allowed, f"{solution.objective!r} is worse than {best!r}"
    return solution.status.value, ""


def kinds(problem: Problem) -> Iterator[str]:
    """What a problem is an example of."""
    yield problem.basis.name
    yield f"order {problem.order}"
    yield "rest to rest" if problem.boundary is None else "other ends"
    yield "symmetric" if problem.symmetric else "unsymmetric"
    yield "convex" if problem.convex and not lower_bounded(problem) else "not convex"
    features = {
        "monotone": problem.monotone,
        "inflexion": problem.inflexion is not None,
        "windows": bool(problem.windows),
        "B asked": problem.B is not None,
        "bounds": bool(problem.bounded),
        "of a cam or follower": any("(" in constant.name for constant in problem.constants),
        "in small units": any(constant.scale < 1e-3 for constant in problem.constants),
        "in large units": any(constant.scale > 1e3 for constant in problem.constants),
        "windows of formulas": any(window.motion is not None for window in problem.windows),
    }
    yield from (name for name, holds in features.items() if holds)


def table(problems: list[Problem], outcomes: list[Outcome]) -> str:
    """Counts, a row for each kind."""
    counts: dict[str, Counter[str]] = {"all": Counter(outcome.status for outcome in outcomes)}
    for problem, outcome in zip(problems, outcomes, strict=True):
        for kind in kinds(problem):
            counts.setdefault(kind, Counter())[outcome.status] += 1
    columns = [status for status, _ in counts["all"].most_common()]
    lines = [f"{'':22}" + "".join(f"{status:>14.13}" for status in columns)]
    rows = ["all", *sorted(set(counts) - {"all"})]
    lines += [f"{kind:22}" + "".join(f"{counts[kind][status] or '':>14}" for status in columns) for kind in rows]
    return "\n".join(lines)


def report(seed: int, count: int, *, units: bool = False) -> str:
    """The table, and below it what needs a look."""
    warnings.simplefilter("ignore", NotNormalised)
    drawn = every_unit(seed, count) if units else every_option(seed, count)
    outcomes = [outcome(one) for one in drawn]
    lines = [table([one.problem for one in drawn], outcomes)]
    lines += [
        f"\n{number}: {found.status} in {found.seconds:.1f} s. {found.why}\n  {one.problem!r}"
        for number, (one, found) in enumerate(zip(drawn, outcomes, strict=True))
        if found.trouble
    ]
    return "\n".join(lines)


if __name__ == "__main__":
    sys.stdout.write(report(int(sys.argv[1]), int(sys.argv[2]), units="units" in sys.argv[3:]) + "\n")
