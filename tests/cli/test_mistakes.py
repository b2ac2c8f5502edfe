"""What a user may mistake in a line: a command refuses it, names it with the remedy, and leaves nothing behind."""

import re
import shlex
import tomllib
from pathlib import Path

import pytest

from optlaws import smoothstep
from tests.documents import ROOT
from tests.internals.cli import RETIRED, exit_code
from tests.test_doors import INNER

#: texts of the packages that read words and files
OF_READERS = re.compile(r"Expected `|`\$\.|Unused Tokens|requires an argument")
CYCLE = """
job = "cycle"
title = "One axis"
speed = "100 rpm"
[[axis]]
name = "slide"
[[axis.segment]]
kind = "rise"
by = "10 mm"
duration = "120 deg"
[[axis.segment]]
kind = "return"
"""
#: a cycle with an entry that is wrong
CHANGED = {
    "still.toml": ('"10 mm"', '"0 mm"'),
    "stopped.toml": ('"100 rpm"', '"0 rpm"'),
    "back.toml": ('"120 deg"', '"-120 deg"'),
    "free.toml": ('name = "slide"', 'name = "slide"\ndegree = 0'),
    "rows.toml": ('speed = "100 rpm"', 'speed = "100 rpm"\nrows = 1'),
    "limit.toml": ('name = "slide"', 'name = "slide"\nlimits = { acceleration = "0 m/s^2" }'),
    "drive.toml": ('name = "slide"', 'name = "slide"\ndrive = { mass = "-2 kg" }'),
    "rack.toml": (
        'name = "slide"',
        'name = "slide"\nmechanism = { kind = "rack", radius = "20 mm", mass = "12 kg", colomb = "1 N" }',
    ),
    "export.toml": ('name = "slide"', 'name = "slide"\n[[axis.export]]\nto = "csv"\npoints = 10000000'),
}
TABLE = ROOT / "problems" / "cycle_rotary_table.toml"
FILES = {
    **{name: CYCLE.replace(old, new) for name, (old, new) in CHANGED.items()},
    "empty.json": "{}",
    "wrong.toml": "[problem]\norder = 2\n[vary]\nB = []\n",
    "open.json": "{",
    "list.json": "[]",
    "lawless.json": '{"law": {}}',
    "numbers.json": '{"law": [1]}',
    "front.json": '{"minimise": "C", "front": [1]}',
    "cubic.json": smoothstep(2).to_json(),
    "old.csv": "".join(f"{10 * k},{20.0 * (1.0 - abs(k - 18) / 18.0) ** 2}\n" for k in range(37)),
}
#: the line, and what the answer names, as a regular expression
MISTAKES = tomllib.loads((ROOT / "tests" / "reference" / "mistakes.toml").read_text("utf-8"))
NAMED = MISTAKES["patterns"] | {line: re.escape(words) for line, words in MISTAKES["words"].items()}
NAMED |= {f"{command} anything --json": re.escape(text) for command, text in RETIRED.items()}


@pytest.mark.parametrize(("line", "named"), NAMED.items())
def test_a_mistake_is_named_and_leaves_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], line: str, named: str
) -> None:
    monkeypatch.chdir(tmp_path)
    for name, content in FILES.items():
        (tmp_path / name).write_text(content, "utf-8")
    before = sorted(tmp_path.rglob("*"))
    assert exit_code(shlex.split(line.format(table=TABLE))) == 2
    assert sorted(tmp_path.rglob("*")) == before
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("optlaws: ")
    text = " ".join(err.removeprefix("optlaws: ").split())
    assert re.search(named, text), text
    assert not INNER.search(text), text
    assert not OF_READERS.search(text), text
