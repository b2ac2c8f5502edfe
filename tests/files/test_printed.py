"""What is said of a printed number."""

import math
from pathlib import Path

import pytest

from optlaws import InputError
from optlaws.results import MISPRINT, ON_GRID, REPRODUCED, compared, number, rows


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


@pytest.mark.parametrize("content", ["B;C\n1;2\n", "C,B\n1,2\n", "", "# only a comment\n"])
def test_other_columns_are_refused(tmp_path: Path, content: str) -> None:
    file = tmp_path / "data.csv"
    file.write_text(content, "utf-8")
    with pytest.raises(InputError, match="must have the columns B, C"):
        rows(file, ("B", "C"))


@pytest.mark.parametrize("line", ["1.5", "1.5,6,7"])
def test_a_row_with_too_few_or_too_many_cells_is_refused(tmp_path: Path, line: str) -> None:
    file = tmp_path / "data.csv"
    file.write_text(f"B,C\n{line}\n", "utf-8")
    with pytest.raises(InputError, match=r"data\.csv"):
        rows(file, ("B", "C"))


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot read the printed data"):
        rows(tmp_path / "none.csv", ("B",))
