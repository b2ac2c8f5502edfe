"""Files in which one value after the other is changed, and whether what is still called proven is true."""

import copy
import json
from collections.abc import Iterator, Sequence
from functools import cache
from math import inf
from typing import Any

from optlaws import Problem, synthesize
from optlaws.verification import Verification, verify

Data = dict[str, Any]
Path = tuple[str | int, ...]

#: how far above the proven value a stated one, computed in doubles, may be
ROOM = 2e-9
#: what is said of the search and not of the law
IDLE = {"seconds", "iterations", "versions", "starts"}


@cache
def text_of(problem: Problem, bound: str = "quick") -> str:
    solution = synthesize(problem, bound="tight") if bound == "tight" else synthesize(problem)
    return json.dumps(solution.to_dict(), allow_nan=False)


def data_of(problem: Problem, bound: str = "quick") -> Data:
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
    found = []
    for path in places(data):
        value = value_at(data, path)
        if isinstance(value, int | float) and not isinstance(value, bool):
            found.append(path)
    return found


def overstated(tampered: Data, true: Verification) -> list[str]:
    """What is wrong with calling a file proven, if `true` is what holds of the untampered one."""
    verification = verify(tampered)
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
    if "objective" in tampered and not low - 1e-9 * high <= tampered["objective"] <= high * (1.0 + 1e-9):
        wrong.append(f"objective {tampered['objective']!r}")
    gap = tampered.get("gap")
    if gap is not None and true.gap is not None and gap < true.gap - 2e-8:
        wrong.append(f"gap {gap!r}")
    return [*wrong, *wrong_constants(tampered, true)]


def wrong_constants(tampered: Data, true: Verification) -> list[str]:
    """Constants of a law that a file states otherwise than they are."""
    wrong = []
    for name, one in tampered.get("constants", {}).items():
        value = one.get("value", one) if isinstance(one, dict) else one
        low, high = true.constants[name]
        # without a value a constant has no bound
        off = high < inf if value is None else not abs(value - low) <= 1e-9 * max(1.0, high)
        if off:
            wrong.append(f"{name} {one!r}")
    return wrong
