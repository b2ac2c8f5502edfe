"""Files in which one value after the other is changed, and whether what is still called proven is true."""

import copy
import json
from collections.abc import Iterator, Sequence
from functools import cache
from math import inf
from typing import Any

from optlaws import BSplines, Chebyshev, Pieces, Problem, Window, between, synthesize
from optlaws.typing import Bound
from optlaws.verification import Verification, verify

Data = dict[str, Any]
Path = tuple[str | int, ...]

#: how far above the proven value a stated one, computed in doubles, may be
ROOM = 2e-9
#: what is said of the search and not of the law
IDLE = {"seconds", "iterations", "versions", "starts"}
#: problems of which files are changed, with their bounds
SOLUTIONS: dict[str, tuple[Problem, Bound]] = {
    "solution": (Problem(B=1.859, order=3, basis=Chebyshev(5)), "quick"),
    "solution of pieces": (Problem(B=1.75, order=2, basis=Pieces(4, 4, 2), minimise="max(C/4, J/40)"), "quick"),
    "solution in splines": (Problem(B=1.75, order=2, basis=BSplines(4, 3)), "quick"),
    "solution that need not be symmetric": (
        Problem(B=1.8, order=3, basis=Chebyshev(7), minimise="rms_c", symmetric=False),
        "quick",
    ),
    "solution with a window": (
        Problem(B=between(1.2, 1.9), order=3, basis=Chebyshev(7), J=80, windows=(Window("c", -6.0, 2.0, 0.3, 0.6),)),
        "quick",
    ),
    "solution with a tight bound": (Problem(B=1.6, order=2, basis=Chebyshev(3), minimise="D"), "tight"),
}


@cache
def text_of(problem: Problem, bound: Bound = "quick") -> str:
    return json.dumps(synthesize(problem, bound=bound).to_dict(), allow_nan=False)


def data_of(problem: Problem, bound: Bound = "quick") -> Data:
    data: Data = json.loads(text_of(problem, bound))
    return data


def places(data: Any, path: Path = ()) -> Iterator[Path]:
    """Every value that is no object and no list, and every object and list too."""
    if path:
        yield path
    if isinstance(data, dict):
        for key, value in data.items():
            if key not in IDLE:
                yield from places(value, (*path, key))
    elif isinstance(data, list):
        for i, value in enumerate(data):
            yield from places(value, (*path, i))


def value_at(data: Any, path: Sequence[str | int]) -> Any:
    for key in path:
        data = data[key]
    return data


def changed(data: Data, path: Path, value: object) -> Data:
    """A copy with another value at a place."""
    copied = copy.deepcopy(data)
    value_at(copied, path[:-1])[path[-1]] = value
    return copied


def numbers(data: Data) -> list[Path]:
    """Every number."""
    return [path for path in places(data) if type(value_at(data, path)) in {int, float}]


def overstated(tampered: Data, true: Verification, known: Verification | None = None) -> list[str]:
    """What is wrong with what is `known` of a changed file, if `true` is what holds of the unchanged one."""
    verification = verify(tampered) if known is None else known
    assert true.objective is not None
    low, high = true.objective
    wrong = []
    if (
        verification.problem == true.problem
        and verification.bound is not None
        and verification.bound > high * (1.0 + 1e-11)
    ):
        wrong.append(f"bound {verification.bound!r} above the optimum {high!r}")
    if not verification.proven:
        return wrong
    if verification.problem != true.problem:
        wrong.append("another problem")
    best = max(true.bound or 0.0, 0.0) + ROOM * max(1.0, high)
    stated = {
        "lower_bound": tampered.get("lower_bound"),
        "certificate.bound": tampered["certificate"].get("bound"),
        "power_certificate.bound": (tampered.get("power_certificate") or {}).get("bound"),
    }
    wrong += [f"{name} {value!r}" for name, value in stated.items() if value is not None and value > best]
    objective = tampered.get("objective")
    if objective is not None and not low - 1e-9 * high <= objective <= high * (1.0 + 1e-9):
        wrong.append(f"objective {objective!r}")
    gap = tampered.get("gap")
    if gap is not None and true.gap is not None and gap < true.gap - 2e-8:
        wrong.append(f"gap {gap!r}")
    return [*wrong, *wrong_constants(tampered, true)]


def wrong_constants(tampered: Data, true: Verification) -> list[str]:
    """Constants of a law that a file states otherwise than they are."""
    wrong = []
    for name, one in (tampered.get("constants") or {}).items():
        value = one.get("value", one) if isinstance(one, dict) else one
        low, high = true.constants[name]
        # without a value a constant has no bound
        off = high < inf if value is None else not abs(value - low) <= 1e-9 * max(1.0, high)
        if off:
            wrong.append(f"{name} {one!r}")
    return wrong
