"""Laws of tables: through points, within what noise leaves open, and tables as people lay them out."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import make_interp_spline

from optlaws import (
    Cycle,
    Dwell,
    InputError,
    NoisyTable,
    Return,
    Rise,
    catalogue,
    compare_laws,
    law_through,
    read_cycle_table,
    read_law,
    smoothstep,
)
from tests.internals.cycles import CycleReport, read_points
from tests.internals.files import tables
from tests.internals.laws import law_of_table, table_of_values
from tests.sampling import examples

DENSE = np.linspace(0.0, 1.0, 1001)
#: laws from rest to rest: a velocity that jumps at the ends is no rounding
EXACT = sorted({*catalogue} - {"constant velocity"})
RESTING = [(1, 0.0), (2, 0.0)]


@given(count=st.integers(6, 40), rest=st.booleans(), seed=st.integers(0, 2**32 - 1))
@examples(60)
def test_a_law_through_points_is_the_spline_of_scipy(*, count: int, rest: bool, seed: int) -> None:
    random = np.random.default_rng(seed)
    k = np.concatenate([[0.0], np.cumsum(random.uniform(0.5, 1.5, count - 1))])
    a = np.concatenate([[0.0], random.uniform(-1.0, 2.0, count - 2), [1.0]])
    law = law_through(10.0 + 3.0 * k, 5.0 - 2.0 * a, tolerance=0.0, rest=rest)
    ends: Any = (RESTING, RESTING) if rest else None
    spline = make_interp_spline(k / k[-1], a, k=5, bc_type=ends)
    for nu, digits in ((0, 1e-10), (1, 1e-9), (2, 1e-8), (4, 1e-6)):
        expected = spline(DENSE, nu)
        assert np.abs(law(DENSE, nu) - expected).max() <= digits * np.abs(expected).max()
    assert law.continuity >= 4


@pytest.mark.parametrize("decimals", [1, 3])
def test_a_law_within_the_rounding_of_a_table_has_nearly_its_constants(decimals: int) -> None:
    angles = np.arange(0.0, 121.0)
    for name, share in (
        ("modified sine", 0.1),
        ("cycloidal", 0.1),
        ("3-4-5 polynomial", 0.01),
        ("modified trapezoid", 0.15),
    ):
        known = catalogue[name].law
        table = np.round(35.0 * known(angles / 120.0), decimals)
        law = law_through(angles, table, tolerance=0.1**decimals)
        assert np.abs(35.0 * law(angles / 120.0) - table).max() <= 0.1**decimals
        assert np.abs(np.array(law.boundary_values(3)) - [[0.0] * 3, [1.0, 0.0, 0.0]]).max() <= 1e-9
        allowed = share * (3.0 if decimals == 1 else 1.0)
        for constant in "BCD":
            assert getattr(law.constants, constant).value == pytest.approx(
                getattr(known.constants, constant).value, rel=allowed
            ), (name, constant)


def test_what_makes_no_law_is_refused() -> None:
    k = np.linspace(0.0, 1.0, 9)
    a = smoothstep(3)(k)
    swapped = k.copy()
    swapped[[3, 4]] = swapped[[4, 3]]
    many = np.linspace(0.0, 1.0, 1200)
    cases: list[Any] = [
        ((k[:5], a[:5]), "at least 6 points, as many k as a, got 5 and 5"),
        ((k, a[:-1]), "as many k as a, got 9 and 8"),
        ((swapped, a), r"got 0.5 and then 0.375 \(points 3 and 4\): sort them"),
        ((k, a * (1.0 - k)), "turn at k = 0.625, a = 0.27.*by themselves, points 0 to 5 and 5 to 8"),
        ((k, a * (1.0 - k) + 0.001 * k), "points return to 0.001: they turn at k = 0.625"),
        ((k, a, -1.0), "tolerance must be"),
        ((many, many + 0.1 * np.sin(1e4 * many), 1e-3), "none goes through the points: the nearest deviates by 0"),
        ((many, many), "at most 1000 points: give a tolerance"),
        ((k, [*a[:-1], np.nan]), "a.8. must be a finite real number, got nan"),
    ]
    for given_points, printed in cases:
        with pytest.raises(InputError, match=printed):
            law_through(*given_points)


@given(
    points=st.integers(6, 40),
    rest=st.booleans(),
    seed=st.integers(0, 2**32 - 1),
    tolerances=st.lists(st.floats(1e-6, 1.0), min_size=2, max_size=4),
)
@examples(60)
def test_a_law_through_points_keeps_within_any_tolerance_with_no_more_pieces_for_a_larger_one(
    *, points: int, rest: bool, seed: int, tolerances: list[float]
) -> None:
    random = np.random.default_rng(seed)
    k = np.concatenate([[0.0], np.cumsum(random.uniform(0.5, 1.5, points - 1))])
    a = np.concatenate([[0.0], random.uniform(-1.0, 2.0, points - 2), [1.0]])
    pieces = []
    for tolerance in sorted(tolerances):
        law = law_through(k, a, tolerance, rest=rest)
        assert np.abs(law(k / k[-1]) - a).max() <= tolerance
        pieces.append(len(law.segments))
    assert pieces == sorted(pieces, reverse=True)


#: of what accelerations a law without noise has, one fitted to noise may have more; kinks are seen least
KNOWN = {"3-4-5 polynomial": 0.2, "modified sine": 0.3, "cycloidal": 0.3, "modified trapezoid": 0.6}


@given(
    name=st.sampled_from(sorted(KNOWN)),
    points=st.integers(61, 400),
    share=st.floats(-5.0, -2.3),
    seed=st.integers(0, 2**32 - 1),
    stroke=st.sampled_from([1e-6, 1.0, -35.0]),
)
@examples(40)
def test_the_law_of_a_noisy_table_is_that_without_its_noise(
    *, name: str, points: int, share: float, seed: int, stroke: float
) -> None:
    law, size, k = catalogue[name].law, 10.0**share, np.linspace(0.0, 1.0, points)
    table = stroke * (law(k) + np.random.default_rng(seed).normal(0.0, size, points))
    with warnings.catch_warnings(record=True) as raised:
        warnings.simplefilter("always", NoisyTable)
        found = law_through(k, table)
    assert found.constants.C.value == pytest.approx(law.constants.C.value, rel=KNOWN[name])
    if raised:
        text = str(raised[0].message)
        assert float(text.split()[4]) == pytest.approx(abs(stroke) * size, rel=0.6), text
    else:
        # what is not said changes little: the law goes through the points
        assert np.abs((table[-1] - table[0]) * found(k) - (table - table[0])).max() <= 1e-6 * abs(stroke)
    assert raised or 6.0 * size * points**2 <= 20.0


@given(name=st.sampled_from(EXACT), points=st.integers(6, 400), decimals=st.integers(2, 17))
@examples(60)
def test_a_table_that_is_exact_to_its_digits_is_not_taken_for_noisy(name: str, points: int, decimals: int) -> None:
    k = np.linspace(0.0, 1.0, points)
    exact = catalogue[name].law(k)
    if decimals > 10:
        law = law_through(k, exact)
        assert np.abs(law(k) - exact).max() <= 1e-9
    else:
        law = law_of_table(k, np.round(exact, decimals), 0.1**decimals)
        assert np.abs(law(k) - np.round(exact, decimals)).max() <= 0.1**decimals * (1.0 + 1e-9)


def test_a_measured_table_has_the_acceleration_of_its_law() -> None:
    random = np.random.default_rng(1)
    k = np.linspace(0.0, 1.0, 361)
    lift = np.round(35.0 * smoothstep(3)(k) + random.normal(0.0, 0.005, 361), 2)
    lift[[0, -1]] = 0.0, 35.0
    with pytest.warns(NoisyTable, match=r"scatter by 0.005.*keeps within 0.01"):
        law = law_through(k, lift)
    assert law.constants.C.value == pytest.approx(smoothstep(3).constants.C.value, rel=0.01)
    assert law_through(k, lift, tolerance=0).constants.C.value > 100.0


def test_files_of_points_are_read_however_they_are_written(tmp_path: Path) -> None:
    angles = np.arange(0, 121, 5)
    lifts = [f"{lift:.4f}" for lift in 12.0 * smoothstep(4)(angles / 120)]
    rows = list(zip(angles.tolist(), lifts, strict=True))
    expected = law_through(angles, list(map(float, lifts)), 1e-4)
    lines = "".join(f"{x},{y}\n" for x, y in rows)
    texts = {
        "comma.csv": "angle,lift\n" + lines,
        "semicolon.csv": "Winkel;Hub\n" + "".join(f"{x};{y}\n" for x, y in rows).replace(".", ","),
        "tab.txt": "# deg\tmm\n" + "".join(f"{x}\t{y}\n" for x, y in rows),
        "tab and commas.txt": "deg\tmm\n" + "".join(f"{x}\t{y}\n" for x, y in rows).replace(".", ","),
        "blanks.dat": "\r\n".join(f"  {x}   {y}" for x, y in rows),
        "quoted.csv": '"deg","mm"\n' + "".join(f'"{x}","{y}"\n' for x, y in rows) + "\n",
        "exponents.csv": "".join(f"{x}, {float(y) * 1e4:.0f}e-4\n" for x, y in rows),
        "units.csv": "angle,lift\n" + "".join(f"{x}°,{y} mm\n" for x, y in rows),
        "footer.csv": "angle,lift\n" + lines + "\nend of the table\n",
        "equal rows.csv": "angle,lift\n" + lines.replace("\n", "\n", 1) + f"{rows[-1][0]},{rows[-1][1]}\n",
        "text beside.csv": "".join(f"{x},{y},spline\n" for x, y in rows),
    }
    for name, text in texts.items():
        for encoding in ("utf-8-sig", "latin-1", "utf-16"):
            file = tmp_path / name
            file.write_text(text, encoding=encoding)
            assert read_law(str(file)) == expected, (name, encoding)


def test_of_more_columns_two_are_chosen(tmp_path: Path) -> None:
    angles = np.arange(0, 121, 5)
    lift, other = 12.0 * smoothstep(4)(angles / 120), 12.0 * smoothstep(3)(angles / 120)
    file = tmp_path / "three.csv"
    rows = "".join(f"{x},{y:.4f},{z:.4f}\n" for x, y, z in zip(angles, other, lift, strict=True))
    file.write_text("angle (deg),inner (mm),outer (mm)\n" + rows)
    with pytest.raises(InputError, match=r"line 2: 3 columns.*columns=\(1, 2\), of 1 'angle .deg.', 2 'inner .mm.', 3"):
        read_law(str(file))
    expected = law_through(angles, np.round(lift, 4), 1e-4)
    for columns in ((1, 3), ("1", "3"), ("angle", "outer"), ("angle (deg)", "OUTER (mm)")):
        assert read_law(file, columns=columns) == expected
    for brackets in ("columns=1,3", "columns=angle,outer; tolerance=0.0001"):
        assert read_law(f"{file}({brackets})") == expected
    for wrong, printed in {
        (1, 4): "no column 4: columns are numbers from 1 to 3",
        (1, 2, 3): "columns are two",
    }.items():
        with pytest.raises(InputError, match=printed):
            read_law(file, columns=wrong)
    for text in ("columns=1", "limit=3", "tolerance=x", "columns=1,3; tolerance=-1"):
        with pytest.raises(InputError, match=r"columns are two|written as in|tolerance must be"):
            read_law(f"{file}({text})")
    with pytest.raises(InputError, match="are of a table of points"):
        read_law("modified sine", tolerance=0.1)


def test_tables_that_optlaws_writes_are_read_back(tmp_path: Path) -> None:
    law = smoothstep(4)
    values = tmp_path / "values.CSV"
    values.write_text(table_of_values(law, "S_4", 31))
    assert np.abs(read_law(str(values)).c(DENSE) - law.c(DENSE)).max() < 1e-3
    for name in ("csv", "sew", "lenze", "kas", "technosoft"):
        options: list[dict[str, Any]] = [{}, {"decimal": ","}] if name == "csv" else [{}]
        for more in options:
            made = law.export(name, stroke="35 mm", master="120 deg", duration="0.1 s", points=61, **more)
            table = made.write(tmp_path / f"{name}.txt", force=True)
            row = compare_laws(str(table), law).rows[0]
            assert row["C"] == pytest.approx(law.constants.C.value, rel=2e-3), name
    cycle = Cycle(
        [Rise("35 mm", "120 deg", law=law), Dwell("90 deg"), Return(duration="90 deg"), Dwell()], speed="60 rpm"
    )
    whole = tmp_path / "whole.csv"
    whole.write_text(tables.to_csv(*CycleReport(cycle).motion(361), about="a cycle"))
    with pytest.raises(InputError, match=r"turn at k = 120, a = 35.*lines 3 to 123 and 213 to 363"):
        read_law(str(whole))


def test_files_that_hold_no_law_say_why(tmp_path: Path) -> None:
    rise = "".join(f"{x},{x / 10:.3f}\n" for x in range(8))
    for text, printed in {
        "": "holds no points",
        "angle,lift\n": "holds no points",
        "0.0\n1.0\n2.0\n": "holds no points.*: line 2 has one number alone",
        "0°30' 0.0\n1°30' 0.1\n2°30' 0.3\n": 'holds no points.*: line 2: write "1°30\'" in decimal degrees',
        "0,0\n1,2\nx,3\n": "line 3: a point is two numbers, got 'x, 3'; mend the line, or put # before it",
        "0,0\n1\n": "line 2: a point is two numbers",
        f"{rise}total,8\n": "line 9: a point is two numbers, got 'total, 8'",
        f"{rise}8,0.800 mm\n": "line 9: .* other units than the line above",
        f"{rise}7,0.800\n": r"k must increase .* got 7 and then 7 \(lines 8 and 9\): sort them by k, and keep one",
        "\n".join(reversed(rise.splitlines())): r"got 7 and then 6 \(lines 1 and 2\)",
        "0,0.0\n1,1.1\n2,3.01\n": "at least 6 points",
        "".join(f"{x},{x % 2}\n" for x in range(8)): "too few digits, 1 of a stroke of 1",
    }.items():
        file = tmp_path / "bad.csv"
        file.write_text(text)
        with pytest.raises(InputError, match=printed) as caught:
            read_law(str(file))
        assert "bad.csv" in str(caught.value)
    with pytest.raises(InputError, match="cannot read"):
        read_law(str(tmp_path / "none.csv"))


# --- columns of text ---


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
        (rows(";", "{:,.1f}"), r"line 26: a point is two .*'1,012.8' has separators of thousands: write 1012.8"),
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
