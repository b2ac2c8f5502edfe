"""Writing results: whole or not at all, never over what a user made or changed; tables give the same bytes."""

import json
import os
from pathlib import Path

import pytest
from PIL import Image

from optlaws import InputError
from tests.files.concurrent_writing import outcomes
from tests.internals.files import tables, writing
from tests.internals.plots import empty_figure, plot_style, save_picture

MINE = f"# {writing.MARK}\n"
SEALED = writing.sealed(MINE.encode()).decode()


def test_a_file_is_written_with_its_folders(tmp_path: Path) -> None:
    target = tmp_path / "a" / "b.csv"
    assert writing.write(target, MINE) == target
    assert target.read_text("utf-8") == SEALED
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
    assert kept == {"b.csv": SEALED, "b.csv.orig": "first", "b.csv.orig1": "second", "b.csv.orig2": "third"}


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
    assert target.read_text("utf-8") == SEALED


CONTENTS = {
    "table.csv": f"# about; {writing.MARK}\nB,C\n1.5,5.5721384\n",
    "page.md": f"# Laws made by optlaws and others\n\n<!-- {writing.MARK} -->\n\nC = 5.5721384.\n",
    "laws.json": json.dumps({"about": f"a title; {writing.MARK}", "C": 5.572138396124845}),
    "rows.sha256": f"0123  rows\n# {writing.MARK}\n",
}


@pytest.mark.parametrize("name", CONTENTS)
def test_an_edit_shows_and_is_kept(tmp_path: Path, name: str) -> None:
    target = writing.write(tmp_path / name, CONTENTS[name])
    written = target.read_text("utf-8")
    assert len(written) == len(CONTENTS[name]) + len(" 0123456789abcdef")
    assert writing.is_own(target)
    # some systems change line ends on their own
    target.write_bytes(written.replace("\n", "\r\n").encode())
    assert writing.is_own(target)
    for edited in (written.replace("5", "6").replace("0123  rows", "0124  rows"), written + "\n", CONTENTS[name]):
        assert edited != written
        target.write_text(edited, "utf-8")
        assert not writing.is_own(target)
        writing.write(target, CONTENTS[name])
        assert target.read_text("utf-8") == written
        assert (tmp_path / f"{name}.orig").read_text("utf-8") == edited
        (tmp_path / f"{name}.orig").unlink()
    writing.write(target, CONTENTS[name].replace("about", "else").replace("a title", "other").replace("C =", "D ="))
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_what_has_no_mark_is_not_written(tmp_path: Path) -> None:
    for content in (b"nothing", b"made by optlaws, once", b"\x89PNG made by optlaws"):
        with pytest.raises(ValueError, match="must hold the mark"):
            writing.write(tmp_path / "a.csv", content)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", [name for name in CONTENTS if name != "rows.sha256"])
def test_a_file_that_says_the_same_is_left_as_it_is(tmp_path: Path, name: str) -> None:
    target = writing.write(tmp_path / name, CONTENTS[name])
    before = target.read_bytes()
    writing.write(target, CONTENTS[name].replace("5.5721384", "5.5721385").replace("5.572138396124845", "5.5721384"))
    assert target.read_bytes() == before
    writing.write(target, CONTENTS[name].replace("5.5721384", "5.5721386").replace("5.572138396124845", "5.5721386"))
    assert target.read_bytes() != before


def test_pictures_are_sealed_and_rewritten_together(tmp_path: Path) -> None:
    def drawn(place: float) -> dict[str, bytes]:
        with plot_style():
            figure = empty_figure()
            axes = figure.subplots()
            axes.plot([0.0, place], [0.0, 1.0])
            axes.set(xlim=(0.0, 2.0))
        return {path.name: path.read_bytes() for path in save_picture(figure, tmp_path / "figure")}

    first = drawn(1.0)
    assert list(first) == ["figure.svg", "figure.png"]
    assert all(writing.is_own(path) for path in tmp_path.iterdir())
    with Image.open(tmp_path / "figure.png") as picture:
        picture.load()
        assert picture.info["Software"].startswith(f"{writing.MARK} ")
    assert drawn(1.0 + 1e-6) == first
    moved = drawn(1.1)
    assert all(moved[name] != first[name] for name in first)
    with (tmp_path / "figure.png").open("ab") as stream:
        stream.write(b"edited")
    assert drawn(1.1) == moved
    assert sorted(path.name for path in tmp_path.iterdir()) == ["figure.png", "figure.png.orig", "figure.svg"]


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


@pytest.mark.parametrize("rounds", [400, pytest.param(20_000, marks=pytest.mark.long)])
def test_of_two_processes_that_write_at_once_one_wins_and_the_users_file_is_kept(tmp_path: Path, rounds: int) -> None:
    assert list(outcomes(rounds, tmp_path)) == []


def test_what_another_process_does_meanwhile_costs_no_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "b.txt"
    target.write_text("mine", "utf-8")
    linked = os.link

    def slow(source: Path, target_of_link: Path, *, follow_symlinks: bool = True) -> None:
        # the other process, in the middle of ours
        monkeypatch.setattr(os, "link", linked)
        writing.write(target, f"theirs {writing.MARK}\n", exact=True)
        linked(source, target_of_link, follow_symlinks=follow_symlinks)

    monkeypatch.setattr(os, "link", slow)
    writing.write(target, f"ours {writing.MARK}\n", exact=True)
    files = {path.name: path.read_text("utf-8").partition(" ")[0] for path in tmp_path.iterdir()}
    assert files == {"b.txt": "ours", "b.txt.orig": "mine"}


def test_where_a_file_has_one_name_only_it_is_copied(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def none(*_: object, **__: object) -> None:
        raise PermissionError("no links here")

    monkeypatch.setattr(os, "link", none)
    target = tmp_path / "b.csv"
    for text in ("first", "second"):
        target.write_text(text, "utf-8")
        writing.write(target, MINE)
    writing.write(target, MINE + "again\n")
    kept = {path.name: path.read_text("utf-8") for path in tmp_path.iterdir() if path != target}
    assert kept == {"b.csv.orig": "first", "b.csv.orig1": "second"}
    assert writing.is_own(target)


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
