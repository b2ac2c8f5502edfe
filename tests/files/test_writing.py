"""Writing results: whole or not at all, never over a file that was not made here; tables give the same bytes."""

import os
from pathlib import Path

import pytest

from optlaws.errors import InputError
from optlaws.files import tables, writing

MINE = f"# {writing.MARK}\n"


def test_a_file_is_written_with_its_folders(tmp_path: Path) -> None:
    target = tmp_path / "a" / "b.csv"
    assert writing.write(target, MINE) == target
    assert target.read_text("utf-8") == MINE
    assert [path.name for path in target.parent.iterdir()] == ["b.csv"]
    assert target.stat().st_mode & 0o777 == 0o644


def test_own_files_are_replaced_and_foreign_ones_kept(tmp_path: Path) -> None:
    target = tmp_path / "b.csv"
    writing.write(target, MINE)
    writing.write(target, MINE + "again\n")
    assert [path.name for path in tmp_path.iterdir()] == ["b.csv"]
    for text in ("first", "second", "third"):
        target.write_text(text, "utf-8")
        writing.write(target, MINE.encode())
    kept = {path.name: path.read_text("utf-8") for path in tmp_path.iterdir()}
    assert kept == {"b.csv": MINE, "b.csv.orig": "first", "b.csv.orig1": "second", "b.csv.orig2": "third"}


def test_a_write_that_fails_leaves_the_old_file_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "b.csv"
    writing.write(target, MINE)

    def fails(*_: object, **__: object) -> None:
        raise OSError("disk full")

    monkeypatch.setattr(os, "replace", fails)
    monkeypatch.setattr(Path, "replace", fails)
    with pytest.raises(OSError, match="disk full"):
        writing.write(target, MINE + "new")
    assert [path.name for path in tmp_path.iterdir()] == ["b.csv"]
    assert target.read_text("utf-8") == MINE


@pytest.mark.skipif(os.name == "nt", reason="there is no umask")
def test_the_umask_and_the_rights_of_a_replaced_file_hold(tmp_path: Path) -> None:
    target = tmp_path / "b.csv"
    before = os.umask(0o077)
    try:
        writing.write(target, MINE)
        assert target.stat().st_mode & 0o777 == 0o600
        target.chmod(0o664)
        writing.write(target, MINE + "again\n")
        assert target.stat().st_mode & 0o777 == 0o664
    finally:
        os.umask(before)


def test_names_that_are_none_are_refused(tmp_path: Path) -> None:
    for name in ("con", "NUL.csv", "com1.tar.gz", "-rf", "a\0b", "a\ud800", "a\n", "b.", "b "):
        with pytest.raises(InputError, match="cannot be the name of a file"):
            writing.write(tmp_path / name, MINE)
    assert list(tmp_path.iterdir()) == []
    assert writing.write(tmp_path / "constants.csv", MINE).exists()


def test_csv_carries_its_source_and_eight_digits() -> None:
    text = tables.to_csv(["B", "note"], [[1 / 3, "a, b"], [None, 2], [1.5, 'say "x"']], about="about")
    assert text == '# about; made by optlaws\nB,note\n0.33333333,"a, b"\n,2\n1.5,"say ""x"""\n'


def test_markdown_is_aligned() -> None:
    text = tables.to_markdown(["B", "long heading"], [[1 / 3, "x"], [None, 20]])
    assert text.splitlines() == [
        "| B         | long heading |",
        "|-----------|--------------|",
        "| 0.3333333 | x            |",
        "|           | 20           |",
    ]
