"""Every file of proofs in results/ with one value changed: it is not proven any more, or says nothing that is false."""

import json
from collections.abc import Iterator
from functools import cache
from itertools import pairwise
from pathlib import Path as File
from typing import Any

import numpy as np
import pytest

from optlaws import InputError
from optlaws.verification import Verification
from tests.check_proofs import certificates
from tests.documents import ROOT
from tests.internals.verification import FileEntry, entries, read, verified
from tests.verification.tampering import Data, Path, changed, places, value_at

FILES = [
    file
    for file in sorted((ROOT / "results").glob("*/*.json"))
    # every number of cycles and cams is changed in test_plans.py and test_cams.py
    if file.stem not in {"cam", "cycle"} and any(certificates(json.loads(file.read_text("utf-8"))))
]
#: how a bound is proven, and where another search begins: what is changed there may prove less, and nothing false
PROOFS = {"certificate", "power_certificate", "peak_certificate", "proof", "proofs"}
BEGINNING, DESCRIPTION = "state", "about"
#: what is weaker where it is less
BOUNDS = {"lower_bound", "best_possible", "bound"}
#: how many kinds of values of a file are changed each time
EACH_TIME = 6


@cache
def file_of(file: File) -> tuple[Data, dict[str, FileEntry]]:
    """A file, of which fronts have two points, and what is verified in it."""
    data: Data = json.loads(file.read_text("utf-8"))
    for path in places(data):
        if path[-1] in {"points", "values"} and isinstance(value_at(data, path), list):
            del value_at(data, path)[2:]
    return data, entries(read(data))


def kinds(data: Data, within: dict[str, FileEntry]) -> Iterator[tuple[Path, Any]]:
    """A value of each kind: those whose places differ by indices, or by the entry that they are in, are of one kind."""
    seen = set()
    for path in places(data):
        value = value_at(data, path)
        keys = ["*" if isinstance(key, int) else key for key in path]
        depth = next((i for i in range(len(path)) if place_of(path[:i]) in within), max(len(path) - 2, 0))
        kind = (tuple(keys[depth:]), type(value))
        if not isinstance(value, dict | list) and kind not in seen:
            seen.add(kind)
            yield path, value


def place_of(path: Path) -> str:
    """A place as verifications name it."""
    text = "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in path)
    return text.removeprefix(".")


def others(value: Any) -> list[Any]:
    """What stands in place of a value: numbers beside it on both sides, another text, something for nothing."""
    if isinstance(value, bool) or value is None:
        return [not value, 0.5]
    if isinstance(value, str):
        return [f"1{value}"]
    by = 1e-6 * max(1.0, abs(value)) if isinstance(value, float) else 1
    return [value + by, value - by]


def is_weaker(path: Path, old: Any, new: Any) -> bool:
    """Whether what is said with another value follows from what was said."""
    inside = [i for i, key in enumerate(path) if key in PROOFS]
    if BEGINNING in path or path[-1] == DESCRIPTION:
        return True
    if path[-1] in BOUNDS:
        return isinstance(old, float) and new < old
    if inside:
        return "problem" not in path[inside[-1] :]
    if path[-1] == "gap":
        return bool(new > old)
    # peaks may be elsewhere too; the limits and ends of a move decide whether its laws are symmetric, as the law is
    # that stands alone decides where it begins
    return path[-1] == "k" or path[-2:] in {("space", "symmetric"), ("law", "a0")}


def wrong(file: File, path: Path, new: Any) -> list[str]:
    """What is false of a changed file of which every claim that is checked is proven."""
    data, true = file_of(file)
    try:
        found = entries(read(changed(data, path, new)))
        differing = {place: verified(entry) for place, entry in found.items() if entry != true.get(place)}
    except InputError:
        return []
    if not all(each.proven for each in differing.values()):
        return []
    above = [place for place, each in differing.items() if is_above(each, verified(true[place]))]
    unchecked = any(name in path[-1:] for each in differing.values() for name in words(each))
    return above if unchecked or is_weaker(path, value_at(data, path), new) else [f"{path}: {new!r} is believed"]


def is_above(one: Verification, true: Verification) -> bool:
    """Whether a bound is above a law of its problem."""
    if one.bound is None or true.objective is None or one.problem != true.problem:
        return False
    return one.bound > true.objective[1] * (1.0 + 1e-11)


def words(verification: Verification) -> set[str]:
    """The words, and pairs of words as keys have them, that name what is not checked."""
    several = [claim.name.split() for claim in (*verification.recomputed, *verification.unchecked)]
    return {word for each in several for word in (*each, *map("_".join, pairwise(each)))}


@pytest.mark.sample(3)
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.parent.name)
def test_what_is_changed_in_a_result_is_found(file: File) -> None:
    found = list(kinds(*file_of(file)))
    chosen = np.random.default_rng(2026).permutation(len(found))[:EACH_TIME]
    for path, value in (found[i] for i in chosen):
        for new in others(value)[:1]:
            assert wrong(file, path, new) == []


@pytest.mark.long
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.parent.name)
def test_every_kind_of_value_that_is_changed_in_a_result_is_found(file: File) -> None:
    for path, value in kinds(*file_of(file)):
        for new in others(value):
            assert wrong(file, path, new) == []
