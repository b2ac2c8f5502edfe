"""Nothing that users rely on goes away or changes its meaning: names, signatures, options, jobs and their entries."""

import json
import re

import pytest

from tests.contracts.frozen import FROZEN, Table, commands, jobs, public_names

WORDS = re.compile(r"'[^']*'|[\w-]+")
NOW = {"public names": public_names, "commands": commands, "jobs": jobs}


@pytest.mark.parametrize("part", NOW)
def test_what_users_rely_on_stays(part: str) -> None:
    assert changes(json.loads(FROZEN.read_text("utf-8"))[part], NOW[part]()) == []


def changes(frozen: Table, now: Table) -> list[str]:
    """What is gone or different, and what is new without a default."""
    gone = [name for name in frozen if name not in now]
    different = [
        f"{name}: {entry}: {kind}, now {now[name].get(entry, 'gone')}"
        for name in frozen.keys() & now.keys()
        for entry, kind in frozen[name].items()
        if not is_kept(kind, now[name].get(entry, ""))
    ]
    demanded = [
        f"{name}: {entry} must now be given"
        for name in frozen.keys() & now.keys()
        for entry, kind in now[name].items()
        if entry not in frozen[name] and " = " not in kind and not is_below_an_optional(entry, frozen[name])
    ]
    return sorted([*gone, *different, *demanded])


def is_kept(kind: str, now: str) -> bool:
    """Whether whatever could be given still can, and means the same if it is not given."""
    (old, _, default), (new, _, now_default) = kind.partition(" = "), now.partition(" = ")
    known, allowed = set(WORDS.findall(old)), set(WORDS.findall(new))
    if "str" in allowed:
        known = {word for word in known if word != "Literal" and not word.startswith("'")}
    # what had to be given and now may be left out is still taken; what a factory made was not written down
    same = default in {"", now_default} or (default == "<factory>" and now_default != "")
    return same and known <= allowed


def is_below_an_optional(entry: str, known: dict[str, str]) -> bool:
    """Whether an entry is part of a table that is itself new."""
    parent = entry.rpartition(".")[0]
    return bool(parent) and parent.removesuffix("[]").removesuffix(".*") not in known


@pytest.mark.parametrize(
    ("kind", "now", "kept"),
    [
        ("int", "int | None = None", True),
        ("int = 3", "int", False),
        ("Literal['a', 'b'] | None = None", "str | None = None", True),
        ("Literal['a', 'b'] | None = None", "Literal['a', 'b', 'c'] | None = None", True),
        ("Literal['a', 'b'] | None = None", "Literal['a'] | None = None", False),
        ("str | None = None", "Literal['a'] | None = None", False),
        ("int | str = 3", "str = 3", False),
        ("keyword-only = <factory>", "keyword-only = Chebyshev(degree=9)", True),
        ("keyword-only = <factory>", "keyword-only", False),
    ],
)
def test_more_may_be_taken_and_less_demanded(kind: str, now: str, *, kept: bool) -> None:
    assert is_kept(kind, now) == kept


@pytest.mark.parametrize(
    ("now", "found"),
    [
        ({"law": {"k": "keyword-only = 1"}}, []),
        ({"law": {"k": "keyword-only = 1", "n": "keyword-only = None"}, "other": {}}, []),
        ({"law": {"k": "keyword-only | None = 1"}}, []),
        ({}, ["law"]),
        ({"law": {}}, ["law: k: keyword-only = 1, now gone"]),
        ({"law": {"k": "keyword-only = 2"}}, ["law: k: keyword-only = 1, now keyword-only = 2"]),
        ({"law": {"k": "keyword-only = 1", "n": "keyword-only"}}, ["law: n must now be given"]),
    ],
)
def test_a_change_is_seen(now: Table, found: list[str]) -> None:
    assert changes({"law": {"k": "keyword-only = 1"}}, now) == found
