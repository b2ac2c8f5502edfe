"""Work of every kind done by many threads at once, in a process of its own: a crash is then an exit status.

`python -m tests.synthesis.concurrent_work THREADS ROUNDS` compares every answer with the serial one, bit by bit, and
then does the work again in a child that is forked while the threads are at work.
"""

import os
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import optlaws
from optlaws import Chebyshev, Problem, smoothstep, synthesize
from optlaws.typing import Bound
from optlaws.verification import enclosures, verify

PROBLEMS = {
    "peak": Problem(B=1.859, order=4, basis=Chebyshev(9)),
    "mean": Problem(B=1.7, order=3, basis=Chebyshev(7), minimise="rms_c"),
    "power": Problem(B=1.641, order=4, minimise="D", basis=Chebyshev(5)),
    "mixture": Problem(order=4, minimise="0.6*C/4+0.4*D/2.25", basis=Chebyshev(5)),
    "greatest": Problem(B=1.8, order=3, minimise="max(C/4, J/32)", basis=Chebyshev(9)),
    "pieces": Problem(B=1.8, order=2, basis=optlaws.Pieces(4)),
    "splines": Problem(B=1.8, order=3, basis=optlaws.BSplines(5)),
    "residual": Problem(B=1.9, order=3, basis=Chebyshev(9), minimise="residual(frequency=(8, 10))"),
    "cam": Problem(B=1.9, order=5, basis=Chebyshev(9), minimise="C_cam(frequency=20)"),
}


def solved(name: str, bound: Bound = "quick") -> str:
    solution = synthesize(PROBLEMS[name], bound=bound)
    return f"{solution.law.to_dict()} {solution.objective!r} {solution.lower_bound!r}"


def proven(name: str) -> str:
    solution = synthesize(PROBLEMS[name])
    verification = verify(solution.to_dict())
    return f"{verification.proven} {verification.bound!r} {enclosures(solution.law)}"


def front() -> str:
    front = optlaws.pareto_front(Problem(order=3, basis=Chebyshev(5)), over=("C", "J"), points=3)
    return repr([one.law.to_dict() for one in front])


def mechanisms() -> str:
    law = smoothstep(4)
    loader = optlaws.Loader(law)
    response = optlaws.Follower(frequency=20.0, damping=0.05).response(law)
    phasor = optlaws.residual_phasor(law, [9.5]).tolist()
    return f"{loader.to_dict()} {phasor} {response(0.5)!r} {response.residual_displacement!r}"


WORK: dict[str, Callable[[], str]] = {
    **{name: partial(solved, name) for name in PROBLEMS},
    "tight": partial(solved, "power", "tight"),
    "proof of a peak": partial(proven, "peak"),
    "proof of a mean": partial(proven, "mean"),
    "front": front,
    "mechanisms": mechanisms,
}


def forked(serial: dict[str, str]) -> bool:
    """Whether a child comes to the same answers."""
    child = os.fork()
    if child == 0:
        same = False
        try:
            same = all(work() == serial[name] for name, work in WORK.items() if name in {"peak", "power", "mechanisms"})
        finally:
            os._exit(0 if same else 1)
    return os.waitpid(child, 0)[1] == 0


def main(threads: int, rounds: int) -> None:
    serial = {name: work() for name, work in WORK.items()}
    with ThreadPoolExecutor(threads) as pool:
        answers = [(name, pool.submit(work)) for _ in range(rounds) for name, work in WORK.items()]
        children = [forked(serial) for _ in range(rounds)] if hasattr(os, "fork") else []
        different = [name for name, answer in answers if answer.result() != serial[name]]
    assert not different, different
    assert all(children), children
    sys.stdout.write(f"{len(answers)} answers and {len(children)} children\n")


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
