"""Tables of points in columns of text as people and vendors lay them out, and what is said of damaged lines."""

from pathlib import Path

import numpy as np
import pytest

from optlaws import InputError, catalogue, read_cycle_table, read_law
from tests.internals.cycles import read_points

ANGLES = np.arange(0.0, 361.0, 5.0)
LIFT = 1200.0 * catalogue["cycloidal"].law(np.clip(ANGLES / 180.0, 0.0, 1.0))


def valves() -> str:
    """The lift of the valves of four cylinders as a public table of Markdown prints it: 200 rows over 720 deg.

    github.com/bmateuszideas/TDI-SIMULATOR, profil_krzywek_4cylindry.md, made by its own formula.
    """
    crank = 7200 / 1999 * np.arange(200)
    valve = {"Dolotowy": (9.0, 335.0, 575.0), "Wydechowy": (7.8, 155.0, 375.0)}
    lifts = {
        name: stroke * np.sin(np.pi * np.clip((crank - start) / (stop - start), 0.0, 1.0)) ** 2
        for name, (stroke, start, stop) in valve.items()
    }
    columns = {
        f"{name}_Cyl{n}": np.roll(lift, 50 * i) for i, n in enumerate((1, 3, 4, 2)) for name, lift in lifts.items()
    }
    lines = [f"| Kąt Wału [°CK] | {' | '.join(columns)} |", f"|{18 * '-'}|{8 * '------------------|'}"]
    rows = zip(crank, *columns.values(), strict=True)
    lines += [f"| {angle:.1f} | {' | '.join(f'{lift:.3f}' for lift in row)} |" for angle, *row in rows]
    return "# Profil wzniosu zaworów dla 4 cylindrów (cykl 4-suwowy, 720° CK)\n\n" + "\n".join(lines)


def test_cylinders_beside_each_other_in_markdown_are_chosen_by_name(tmp_path: Path) -> None:
    """The valve of the third cylinder is open where the table begins."""
    file, text = tmp_path / "valves.md", valves()
    assert "\n| 360.2 | 0.943 | 0.344 | 0.000 | 0.959 | 0.000 | 0.000 | 1.735 | 0.000 |\n" in text  # as it is printed
    for encoding in ("utf-8", "utf-8-sig", "utf-16", "cp1250"):
        file.write_text(text, encoding=encoding)
        with pytest.raises(InputError, match=r"line 5: 9 columns .* say by columns .* 1 'Kąt Wału .°CK.', 2 'Dolotowy"):
            read_cycle_table(file)
    table = read_cycle_table(file, columns=("kąt", "Dolotowy_Cyl3"), turn="720 deg")
    assert (table.unit, table.master) == ("mm", "deg")
    assert read_points(file, cam="Dolotowy_Cyl3").heights.tolist() == table.heights[:-1].tolist()
    with pytest.raises(InputError, match=r"has no column 'Cyl3': columns are numbers from 1 to 9, or one of 'Kąt"):
        read_points(file, cam="Cyl3")
    assert [part.kind for part in table.stretches] == ["return", "dwell", "rise", "return"]
    assert [part.stop for part in table.stretches] == pytest.approx([35.0, 515.0, 635.0, 720.0], abs=1.0)
    assert table.peaks[1].holds(1776.53 * 1e3 / 24000.0**2)


def rows(separator: str, write: str) -> str:
    return "".join(f"{angle:.0f}{separator}{write.format(lift)}\n" for angle, lift in zip(ANGLES, LIFT, strict=True))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (
            rows(";", "{:,.1f}"),
            r"line 26: a point is two .*'1,012.8' has separators of thousands: write 1012.8",
        ),
        (rows(",", "{:,.1f}"), r"line \d+: 3 numbers, got .* write numbers without separators of thousands"),
        (rows(" ", "{:,.1f}").replace(",", " "), r"line \d+: 3 numbers"),
        (rows(";", "{:,.1f}").replace(",", "'"), r"line 26: .*1'012.8\" has separators of thousands: write 1012.8"),
        ("1.000.000;2.000.000\n", "holds no points.*'1.000.000' has separators of thousands: write 1000000"),
    ],
)
def test_separators_of_thousands_are_refused_by_name(text: str, says: str, tmp_path: Path) -> None:
    (tmp_path / "cam.txt").write_text(text)
    for read in (read_law, read_cycle_table):
        with pytest.raises(InputError, match=rf"cam\.txt.*{says}"):
            read(tmp_path / "cam.txt")


def test_signs_of_print_and_comments_anywhere(tmp_path: Path) -> None:
    lift = np.round(LIFT - 600.0, 1)
    lines = [f"{angle:.0f} {height:.1f} // row" for angle, height in zip(ANGLES, lift, strict=True)]
    plain, printed = tmp_path / "plain.txt", tmp_path / "printed.txt"
    plain.write_text("\n".join(line.removesuffix(" // row") for line in lines))
    lines.insert(20, "(* half of it,\n 1 2 of two lines *)")
    printed.write_text("\n".join(["! a cam", "% of 600 mm", *lines, "# 1 2"]).replace("-", "−").replace(" ", "\u00a0"))
    table, other = read_cycle_table(plain), read_cycle_table(printed)
    assert (table.places.tolist(), table.heights.tolist()) == (other.places.tolist(), other.heights.tolist())
    (tmp_path / "wrong.txt").write_text(printed.read_text().replace("100\u00a0", "1/00\u00a0"))
    with pytest.raises(InputError, match=r"wrong\.txt, line 25: a point is two numbers, got '1/00, .*mend the line"):
        read_cycle_table(tmp_path / "wrong.txt")
