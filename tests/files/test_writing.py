"""Writing results: whole or not at all, never over what a user made; what two files say; printed numbers."""

import json
import math
import os
from pathlib import Path
from typing import Any

import pytest

from optlaws import InputError
from optlaws.results import MISPRINT, ON_GRID, REPRODUCED, Results, compared, number, rows
from tests.files.concurrent_writing import outcomes
from tests.internals.files import say_the_same, tables, writing
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


# --- what two files say ---


LAW: dict[str, Any] = {
    "status": "optimal",
    "objective": 5.57,
    "best_possible": None,
    "constants": {"B": {"value": 1.53, "k": 0.5}},
    "gap": "1e-10",
    "z": [1e6, 1.0],
    "starts": [5.57, 5.58],
    "certificate": {"program": "linear", "bound": 5.57, "contacts": [{"k": 0.1, "multiplier": 1.0}]},
}


@pytest.mark.parametrize(
    ("change", "same"),
    [
        ({"objective": 5.57 * (1 + 1e-9)}, True),
        ({"objective": 5.57 * (1 + 2e-8)}, False),
        ({"objective": None}, False),
        ({"status": "local"}, False),
        ({"best_possible": 0.0}, False),
        ({"more": 1}, False),
        # the place of a smooth peak, not its size
        ({"constants": {"B": {"value": 1.53, "k": 0.5 + 1e-7}}}, True),
        ({"constants": {"B": {"value": 1.53 + 1e-7, "k": 0.5}}}, False),
        ({"gap": "1e-9"}, True),
        ({"gap": "1e-7"}, False),
        # in the scale of the list
        ({"z": [1e6, 1.001]}, True),
        ({"z": [1e6, 1.1]}, False),
        ({"z": [1e6, 1.0, 0.0]}, False),
        ({"starts": [5.57]}, True),
        # what a proof proves, not how
        ({"certificate": {"program": "linear", "bound": 5.57, "contacts": []}}, True),
        ({"certificate": {"program": "linear", "bound": 5.5, "contacts": []}}, False),
        ({"certificate": {"program": "conic", "bound": 5.57, "contacts": []}}, False),
    ],
)
def test_json(change: dict[str, Any], *, same: bool) -> None:
    first, second = (json.dumps(data).encode() for data in (LAW, LAW | change))
    assert say_the_same(first, second, ".json") is same
    assert say_the_same(second, first, ".json") is same


@pytest.mark.parametrize(
    ("first", "second", "same"),
    [
        ("| C |\n|---|\n| 5.572139 |", "| C   |\n|-----|\n| 5.57214 |", True),
        ("C = 5.572139", "C = 5.572140", True),
        ("C = 5.572139", "C = 5.572141", False),
        # few digits are meant so
        ("C = 5.57", "C = 5.58", False),
        ("row 103456", "row 103457", False),
        ("gap 1e-10", "gap 1e-9", True),
        ("gap 1e-8", "gap 1e-7", False),
        ("C = 5.572139", "D = 5.572139", False),
        ("C = 5.572139", "C = 5.572139 or so", False),
        ("law 0307a1.234567", "law 0307a1.234568", False),
    ],
)
def test_tables(first: str, second: str, *, same: bool) -> None:
    for kind in (".csv", ".md"):
        assert say_the_same(first.encode(), second.encode(), kind) is same
    assert not say_the_same(first.encode(), second.encode(), ".txt")


def test_pictures() -> None:
    line = '<path id="p{0}" d="M {1} 2" style="opacity: {2}; stroke: #{3}"/><use href="#p{0}"/>'
    drawn = line.format("0123456789", "201.214027", 0.3, "1e5000")
    for parts, same in (
        (("abcdef0123", "201.214027", 0.3, "1e5000"), True),
        (("0123456789", "201.24", 0.3, "1e5000"), True),
        (("0123456789", "201.294027", 0.3, "1e5000"), False),
        (("0123456789", "201.214027", 0.32, "1e5000"), False),
        (("0123456789", "201.214027", 0.3, "1e5001"), False),
    ):
        assert say_the_same(drawn.encode(), line.format(*parts).encode(), ".svg") is same
    assert not say_the_same(
        drawn.encode(), drawn.replace('href="#p0123456789"', 'href="#p0000000000"').encode(), ".svg"
    )


def test_fewer_digits_may_mean_something() -> None:
    tables = [f"| 0510 | 3 | {C} |".encode() for C in ("9.82783", "9.82776", "9.8348")]
    assert say_the_same(tables[0], tables[1], ".md", digits=4)
    assert not say_the_same(tables[0], tables[1], ".md")
    assert not say_the_same(tables[0], tables[2], ".md", digits=4)
    assert say_the_same(b'{"C": 9.82783}', b'{"C": 9.82776}', ".json", digits=4)


def test_what_cannot_be_read_is_not_the_same() -> None:
    for kind in (".json", ".csv", ".svg"):
        assert not say_the_same(b"\xff", b"{}", kind)
    assert not say_the_same(b"{", b"{}", ".json")


@pytest.mark.parametrize(
    ("other", "same"),
    [
        ("M 1 2 \nL 5 6 \nL 5 9 \n", True),
        ("M 1 2 \nL 3.02 4 \nL 4 5 \nL 5 6 \nL 5 9 \n", True),
        ("M 1 2 \nL 3.2 4 \nL 5 6 \nL 5 9 \n", False),
        ("M 1 2 \nL 3 4 \nL 5 6 \n", False),
    ],
)
def test_a_line_may_have_more_places_on_its_way(other: str, *, same: bool) -> None:
    line, other = (f'<path d="{path}" class="line"/>' for path in ("M 1 2 \nL 3 4 \nL 5 6 \nL 5 9 \n", other))
    assert say_the_same(line.encode(), other.encode(), ".svg") is same
    assert say_the_same(other.encode(), line.encode(), ".svg") is same


# --- printed numbers ---


@pytest.mark.parametrize(
    ("text", "exact", "on_grid", "verdict"),
    [
        ("5.92", 5.919541667, 5.916132213, REPRODUCED),  # rounded
        ("1.53", 1.5299999999, None, REPRODUCED),
        ("9.34", 9.344999, None, REPRODUCED),
        ("9.34", 9.345001, None, "reproduced to 0.05 %"),
        ("6.83", 6.837463633, 6.831965392, ON_GRID),  # rounded on the grid
        ("5.91", 5.919584792, 5.913136526, ON_GRID),
        ("9.34", 9.3489, 9.3499, ON_GRID),  # cut on the grid
        ("9.34", 9.3489, None, "reproduced to 0.1 %"),  # an exact peak is rounded, never cut
        ("9.34", 9.36, 9.3501, "reproduced to 0.21 %"),
        ("6.062", 6.0603773, 6.059645748, "reproduced to 0.03 %"),
        ("6.07", 6.10624117, 6.101606364, "reproduced to 0.6 %"),
        ("10.52", 10.35193717, 10.34168796, "reproduced to 1.6 %"),
        ("4", 4.6, None, "reproduced to 15 %"),
        ("4", 4.4, None, REPRODUCED),
    ],
)
def test_a_verdict_follows_from_the_digits(text: str, exact: float, on_grid: float | None, verdict: str) -> None:
    found = compared("row", "C", text, exact, on_grid=on_grid, misprint=None)
    assert found.verdict == verdict
    assert (found.row, found.quantity, found.printed, found.exact, found.on_grid) == ("row", "C", text, exact, on_grid)
    assert bool(found.reason) == (verdict == ON_GRID)


@pytest.mark.parametrize("exact", [10.35, 10.52])
def test_a_misprint_is_called_one_with_its_reason(exact: float) -> None:
    found = compared("2.6", "C", "10.52", exact, on_grid=10.34, misprint="a digit")
    assert (found.verdict, found.reason) == (MISPRINT, "a digit")


@pytest.mark.parametrize("text", ["", "x", "nan", "inf", "-inf", "1,5", "1.5.2"])
def test_what_is_no_number_is_refused(text: str) -> None:
    with pytest.raises(InputError, match=r"table\.csv: .* is not a number"):
        number(text, "table.csv")


@pytest.mark.parametrize(("text", "value"), [("1.53", 1.53), (" 2 ", 2.0), ("-1e-3", -0.001)])
def test_numbers_are_read(text: str, value: float) -> None:
    assert math.isclose(number(text, ""), value)


def test_rows_skip_comments_and_blank_lines(tmp_path: Path) -> None:
    file = tmp_path / "data.csv"
    file.write_text('# source\n\nB,C\n# remark\n1.5,"6, exactly"\n', "utf-8")
    assert [dict(row) for row in rows(file, ("B", "C"))] == [{"B": "1.5", "C": "6, exactly"}]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        *(
            (content, "must have the columns B, C")
            for content in ("B;C\n1;2\n", "C,B\n1,2\n", "", "# only a comment\n")
        ),
        *((f"B,C\n{line}\n", r"data\.csv") for line in ("1.5", "1.5,6,7")),
    ],
)
def test_other_columns_and_rows_with_too_few_or_too_many_cells_are_refused(
    tmp_path: Path, content: str, message: str
) -> None:
    file = tmp_path / "data.csv"
    with pytest.raises(InputError, match="cannot read the printed data"):
        rows(file, ("B", "C"))
    file.write_text(content, "utf-8")
    with pytest.raises(InputError, match=message):
        rows(file, ("B", "C"))
