"""Writing results: whole or not at all, never over what a user made or changed; tables give the same bytes."""

import json
import os
from pathlib import Path

import pytest

from optlaws import InputError
from optlaws.results import Results
from tests.files.concurrent_writing import outcomes
from tests.internals.files import tables, writing
from tests.internals.plots import empty_figure, plot_style, save_picture

MINE = f"# {writing.MARK}\n"


def test_a_file_is_written_with_its_folders(tmp_path: Path) -> None:
    target = tmp_path / "a" / "b.csv"
    assert writing.write(target, MINE) == target
    assert target.read_text("utf-8") == MINE
    assert [path.name for path in target.parent.iterdir()] == ["b.csv"]
    assert target.stat().st_mode & 0o777 == 0o644


@pytest.mark.parametrize("edited", ["mine\n", MINE + "\n1,2\n", ""])
@pytest.mark.parametrize("exact", [False, True])
def test_other_contents_are_replaced_by_force_alone(tmp_path: Path, edited: str, *, exact: bool) -> None:
    target = tmp_path / "b.csv"
    writing.write(target, MINE, exact=exact)
    target.write_text(edited, "utf-8")
    for content in (MINE, MINE.encode()):
        with pytest.raises(InputError, match=r"there is .*b\.csv with other contents, .*--force, or force=True"):
            writing.write(target, content, exact=exact)
        assert target.read_text("utf-8") == edited
    writing.write(target, MINE, exact=exact, force=True)
    assert target.read_text("utf-8") == MINE
    with writing.forced():
        writing.write(target, MINE + "more\n", exact=exact)
    assert {path.name: path.read_text("utf-8") for path in tmp_path.iterdir()} == {"b.csv": MINE + "more\n"}


def test_of_several_files_none_is_written_where_one_is_another(tmp_path: Path) -> None:
    file = tmp_path / "peaks.toml"
    file.write_text('title = "Peaks"\n', "utf-8")

    def results(value: float) -> Results:
        made = Results(file)
        made.table("peaks", ["C"], [[value]])
        made.page("peaks").table(["C"], [[value]])
        made.add("peaks.txt", lambda place: writing.write(place, f"{value!r}\n", exact=True))
        return made

    first = {path: path.read_bytes() for path in results(6.0).write(tmp_path / "out")}
    assert sorted(path.suffix for path in first) == [".csv", ".md", ".txt"]
    assert set(results(6.0 * (1.0 + 1e-12)).write(tmp_path / "other")) != set(first)
    with pytest.raises(InputError, match=r"there is .*peaks\.csv, .*peaks\.md, .*peaks\.txt with other contents"):
        results(7.0).write(tmp_path / "out")
    (tmp_path / "out" / "peaks.md").write_text("mine\n", "utf-8")
    with pytest.raises(InputError, match=r"there is \S*peaks\.md with other contents"):
        results(6.0).write(tmp_path / "out")
    assert results(6.0).write(tmp_path / "out", force=True) == list(first)
    assert {path: path.read_bytes() for path in first} == first
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["peaks.csv", "peaks.md", "peaks.txt"]


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
        writing.write(target, MINE + "new", force=True)
    assert [path.name for path in tmp_path.iterdir()] == ["b.csv"]
    assert target.read_text("utf-8") == MINE


CONTENTS = {
    "table.csv": f"# about; {writing.MARK}\nB,C\n1.5,5.5721384\n",
    "page.md": f"# Laws made by optlaws and others\n\n<!-- {writing.MARK} -->\n\nC = 5.5721384.\n",
    "laws.json": json.dumps({"about": f"a title; {writing.MARK}", "C": 5.572138396124845}),
}


@pytest.mark.parametrize("name", CONTENTS)
def test_a_file_that_says_the_same_is_left_as_it_is(tmp_path: Path, name: str) -> None:
    target = writing.write(tmp_path / name, CONTENTS[name])
    # the version before wrote a digest behind the mark
    begin, mark, end = CONTENTS[name].rpartition(writing.MARK)
    before = f"{begin}{mark} 0123456789abcdef{end}".replace("\n", "\r\n").encode()
    target.write_bytes(before)
    near = CONTENTS[name].replace("5.5721384", "5.5721385").replace("5.572138396124845", "5.5721384")
    assert writing.write(target, near) == target
    assert target.read_bytes() == before
    far = CONTENTS[name].replace("5.5721384", "5.5721386").replace("5.572138396124845", "5.5721386")
    with pytest.raises(InputError, match="other contents"):
        writing.write(target, far)


def test_a_picture_is_an_svg_that_stays_where_it_shows_the_same(tmp_path: Path) -> None:
    def drawn(place: float) -> bytes:
        with plot_style():
            figure = empty_figure()
            axes = figure.subplots()
            axes.plot([0.0, place], [0.0, 1.0])
            axes.set(xlim=(0.0, 2.0))
        return save_picture(figure, tmp_path / "figure").read_bytes()

    first = drawn(1.0)
    assert [path.name for path in tmp_path.iterdir()] == ["figure.svg"]
    assert drawn(1.0 + 1e-6) == first
    with pytest.raises(InputError, match="other contents"):
        drawn(1.1)


@pytest.mark.skipif(os.name == "nt", reason="there is no umask")
def test_the_umask_and_the_rights_of_a_replaced_file_hold(tmp_path: Path) -> None:
    target = tmp_path / "b.csv"
    before = os.umask(0o077)
    try:
        writing.write(target, MINE)
        assert target.stat().st_mode & 0o777 == 0o600
        target.chmod(0o664)
        writing.write(target, MINE + "again\n", force=True)
        assert target.stat().st_mode & 0o777 == 0o664
    finally:
        os.umask(before)


@pytest.mark.parametrize("rounds", [400, pytest.param(20_000, marks=pytest.mark.long)])
def test_of_two_processes_that_write_at_once_one_wins_and_the_other_says_so(tmp_path: Path, rounds: int) -> None:
    assert list(outcomes(rounds, tmp_path)) == []


@pytest.mark.parametrize("links", [True, False])
def test_what_another_process_does_meanwhile_costs_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, links: bool
) -> None:
    target = tmp_path / "b.txt"
    linked = os.link

    def slow(source: Path, target_of_link: Path) -> None:
        # the other process, in the middle of ours
        target.write_text("theirs", "utf-8")
        if not links:
            raise PermissionError("no links here")
        linked(source, target_of_link)

    monkeypatch.setattr(os, "link", slow)
    with pytest.raises(InputError, match="other contents"):
        writing.write(target, f"ours {writing.MARK}\n", exact=True)
    assert {path.name: path.read_text("utf-8") for path in tmp_path.iterdir()} == {"b.txt": "theirs"}


def test_a_link_that_leads_nowhere_and_a_folder_are_no_free_names(tmp_path: Path) -> None:
    (tmp_path / "link.csv").symlink_to(tmp_path / "nowhere")
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(InputError, match="other contents"):
        writing.write(tmp_path / "link.csv", MINE)
    with pytest.raises(IsADirectoryError):
        writing.write(tmp_path / "folder.csv", MINE, force=True)


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


@pytest.mark.parametrize("twin", ["slide.csv", "Slide.CSV"])
def test_no_two_files_of_a_result_have_one_name(tmp_path: Path, twin: str) -> None:
    results = Results(tmp_path / "press.toml")
    results.text("slide.csv", MINE, "axis slide: its table")
    with pytest.raises(InputError, match=r"axis b: export: another file is called slide\.csv, axis slide: its table: "):
        results.add(twin, Path, "axis b: export")
