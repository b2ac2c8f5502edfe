"""Laws of tables: through points, as scipy's splines go, and within what the points are rounded to; files of points."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import make_interp_spline

from optlaws import InputError, catalogue, compare, law_through, read_law, smoothstep
from optlaws.laws.values import table_of_values

DENSE = np.linspace(0.0, 1.0, 1001)
RESTING = [(1, 0.0), (2, 0.0)]


@given(count=st.integers(6, 40), rest=st.booleans(), seed=st.integers(0, 2**32 - 1))
@settings(max_examples=20)
def test_a_law_through_points_is_the_spline_of_scipy(*, count: int, rest: bool, seed: int) -> None:
    random = np.random.default_rng(seed)
    k = np.concatenate([[0.0], np.cumsum(random.uniform(0.5, 1.5, count - 1))])
    a = np.concatenate([[0.0], random.uniform(-1.0, 2.0, count - 2), [1.0]])
    law = law_through(10.0 + 3.0 * k, 5.0 - 2.0 * a, rest=rest)
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
    noisy = a + 0.1 * (-1.0) ** np.arange(9) * (k > 0.0) * (k < 1.0)
    many = np.linspace(0.0, 1.0, 1200)
    cases: list[Any] = [
        ((k[:5], a[:5]), "at least 6 points, as many k as a, got 5 and 5"),
        ((k, a[:-1]), "as many k as a, got 9 and 8"),
        ((swapped, a), "k must increase from point to point, got 0.5 and then 0.375"),
        ((k, a * (1.0 - k)), "give the rise and the return by themselves"),
        ((k, a, -1.0), "tolerance must be"),
        ((k, noisy, 0.01), "keeps within the tolerance, 0.01 of the stroke: with . it misses a point by 0"),
        ((many, many), "at most 1000 points: give a tolerance"),
        ((k, [*a[:-1], np.nan]), "a.8. must be a finite real number, got nan"),
    ]
    for given_points, told in cases:
        with pytest.raises(InputError, match=told):
            law_through(*given_points)


def test_files_of_points_are_read_however_they_are_written(tmp_path: Path) -> None:
    angles = np.arange(0, 121, 5)
    lifts = [f"{lift:.4f}" for lift in 12.0 * smoothstep(4)(angles / 120)]
    rows = list(zip(angles.tolist(), lifts, strict=True))
    expected = law_through(angles, list(map(float, lifts)), 1e-4)
    texts = {
        "comma": "angle,lift\n" + "".join(f"{x},{y}\n" for x, y in rows),
        "semicolon": "Winkel;Hub\n" + "".join(f"{x};{y}\n" for x, y in rows).replace(".", ","),
        "tab": "# deg\tmm\n" + "".join(f"{x}\t{y}\t0\n" for x, y in rows),
        "blanks": "\r\n".join(f"  {x}   {y}" for x, y in rows),
        "quoted": '"deg","mm"\n' + "".join(f'"{x}","{y}"\n' for x, y in rows) + "\n",
        "exponents": "".join(f"{x}, {float(y) * 1e4:.0f}e-4\n" for x, y in rows),
    }
    for name, text in texts.items():
        file = tmp_path / f"{name}.csv"
        file.write_text(text, encoding="utf-8-sig")
        assert read_law(str(file)) == expected, name


def test_tables_that_optlaws_writes_are_read_back(tmp_path: Path) -> None:
    law = smoothstep(4)
    values = tmp_path / "values.CSV"
    values.write_text(table_of_values(law, "S_4", 31))
    assert np.abs(read_law(str(values)).c(DENSE) - law.c(DENSE)).max() < 1e-3
    made = law.export("csv", stroke="35 mm", master="120 deg", time="0.1 s", points=61)
    table = made.write(tmp_path / "table.csv")
    row = compare(str(table), law).rows[0]
    assert row["C"] == pytest.approx(law.constants.C.value, rel=1e-3)


def test_files_that_hold_no_law_say_why(tmp_path: Path) -> None:
    for text, told in {
        "": "holds no points",
        "angle,lift\n": "holds no points",
        "0,0\n1,2\nx,3\n": "line 3: a point is two numbers, got 'x,3'",
        "0,0\n1\n": "line 2: a point is two numbers",
        "0,0.0\n1,1.1\n2,3.01\n": "at least 6 points",
        "".join(f"{x},{x % 2}\n" for x in range(8)): "too few digits, 1 of a stroke of 1",
    }.items():
        file = tmp_path / "bad.csv"
        file.write_text(text)
        with pytest.raises(InputError, match=told) as caught:
            read_law(str(file))
        assert "bad.csv" in str(caught.value)
    with pytest.raises(InputError, match="cannot read"):
        read_law(str(tmp_path / "none.csv"))
