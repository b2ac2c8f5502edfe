"""Nothing that users rely on goes away or changes its meaning: names, signatures, options, jobs and their entries."""

import json
import re

import pytest

from tests.contracts.frozen import FROZEN, Table, commands, jobs, of_release, public_names, text_of_contract
from tests.documents import ROOT

WORDS = re.compile(r"'[^']*'|[\w-]+")
NOW = {"public names": public_names, "commands": commands, "jobs": jobs}
#: ways to say that nothing is given
NOTHING = {"None", "[]", "{}", "''", "()"}
#: what is gone or different since the release: words of the changelog that say so and what to use instead
EXPLAINED = {
    r"Advice\.to_\w+|AdvisedLaw\.to_dict": "`Advice.proofs()`",
    r"\w+(Flat|Roller)\.examples": "`examples` of followers",
    r"[mM]achine_?[fF]ollower.*": "`machine_follower`, `MachineFollower`",
    r"MoveLimit: .*": "`MoveLimit(drive_limit, unit, dimension)` is `MoveLimit(drive_limit, move)`",
    r"best_breaks|.*export\[\]\.points: .*": '`best_breaks` and `points="best"`',
    r"jerk_limited_move": "`jerk_limited_move`",
    r"read_spectrum: points: .*": "`read_spectrum(points=...)`",
    r"constants|cam|atlas|ledger|dwell|lever|loader": "Commands, each of which answers with what to use",
    r"Solution: (limit: .*|best_possible must now be given)|solutions: columns: .*": "`best_possible`",
    r"fronts|force loaded": "The jobs `fronts`, `force loaded` and `atlas`",
}
#: what a file could hold stays the same, and is stated now: what a text may be, and what is taken unless it is given;
#: a "base circle" that is best is read as the prime circle that it is
STATED = re.compile(
    r"cam: (best|as_made\.curve|file\[\]\.(curve|decimals|degree|format|points|tolerance)|forces\.\w+"
    r"|turning|motion\.segment\[\]\.law): .*|cycle: (axis\[\]\.segment\[\]\.law|interlocks\[\]\.(ratio|way)): .*"
)


def test_what_is_frozen_is_what_the_release_said() -> None:
    released, written = of_release(), FROZEN.read_text("utf-8")
    if released is None:
        pytest.skip("the history of the release is not here")
    # of the next release it is all that is now
    assert written == released or written == text_of_contract()


@pytest.mark.parametrize("part", NOW)
def test_what_users_rely_on_stays(part: str) -> None:
    known = [re.compile(pattern) for pattern in EXPLAINED]
    found = changes(json.loads(FROZEN.read_text("utf-8"))[part], NOW[part]())
    assert [change for change in found if not any(each.fullmatch(change) for each in [*known, STATED])] == []


def test_the_changelog_says_what_is_gone() -> None:
    changed = (ROOT / "CHANGELOG.md").read_text("utf-8").partition("## [Unreleased]")[2].partition("\n## [")[0]
    text = " ".join(changed.split())
    assert [words for words in EXPLAINED.values() if words not in text] == []


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
    (old, _, default), (new, _, now_default) = (plain(text).partition(" = ") for text in (kind, now))
    known, allowed = set(WORDS.findall(old)), set(WORDS.findall(new))
    if "str" in allowed:
        known = {word for word in known if word != "Literal" and not word.startswith("'")}
    if "table" in allowed:
        known -= {"dict", "str", "float", "Any"}
    # what had to be given and now may be left out is still taken; what a factory made was not written down
    same = default in {"", now_default} or (default == "<factory>" and now_default != "")
    return (same or {default, now_default} <= NOTHING) and known <= allowed


def plain(kind: str) -> str:
    """A type and its default, where files have lists for tuples."""
    return re.sub(r"\((.+)\)$", r"[\1]", kind.replace("tuple[", "list[").replace(", Ellipsis", ""))


def is_below_an_optional(entry: str, known: dict[str, str]) -> bool:
    """Whether an entry is part of a table that is itself new, or whose entries were not listed."""
    parent = entry.rpartition(".")[0].removesuffix("[]").removesuffix(".*")
    return bool(parent) and known.get(parent, "dict").startswith("dict")


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
        ("tuple[int, Ellipsis] = (3, 4)", "list[int] | None = [3, 4]", True),
        ("tuple[int, Ellipsis] = (3, 4)", "list[int] | None = [3, 5]", False),
        ("list[table] = []", "list[table] | None = None", True),
        ("list[table] = []", "list[table] | None = [1]", False),
        ("dict[str, str]", "table", True),
        ("int", "table", False),
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
