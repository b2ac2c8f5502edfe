"""C99 headers, compiled and run: against the polynomials in exact arithmetic, within the bounds that they state."""

import re
import shutil
import subprocess
from fractions import Fraction
from math import factorial, perm
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, seed
from hypothesis import strategies as st

from optlaws import InputError, Pieces, PiecewiseMotion, Problem, smoothstep, synthesize
from tests.exports.motions import random_motion
from tests.exports.moves import COMPILER, SANITISED, STRICT
from tests.internals.exports import DOUBLE, SINGLE, Labels, as_stored, c_name, error_bounds, header
from tests.sampling import examples

needs_compiler = pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")


def motions() -> list[PiecewiseMotion]:
    solution = synthesize(Problem(B=1.859, order=4, basis=Pieces(6, 7, 3)))
    made = [solution.law.pieces("35 mm", "0.12 s"), smoothstep(5).pieces("-20 mm", "360 s")]
    made += [random_motion(i, pieces=1 + i, degree=1 + i % 9) for i in range(10)]
    return [*made, PiecewiseMotion([-1, 2], [[5.0]])]


def exact_value(motion: PiecewiseMotion, piece: int, x: Fraction, nu: int) -> Fraction:
    s = x - Fraction(motion.breaks[piece])
    row = enumerate(motion.coefficients[piece])
    terms = (Fraction(c) * perm(n, nu) * s ** (n - nu) for n, c in row if n >= nu)
    return sum(terms, Fraction(0))


def places(motion: PiecewiseMotion, *, single: bool) -> list[float]:
    breaks = as_stored(motion, SINGLE if single else DOUBLE).breaks
    x = np.concatenate([np.linspace(motion.start, motion.stop, 23), breaks, np.nextafter(breaks, -np.inf)])
    x = np.clip(x.astype(np.float32 if single else np.float64), breaks[0], breaks[-1])
    return [float(one) for one in x]


def program(number: int, x: list[float], *, single: bool) -> str:
    kind, f = ("float", "_f") if single else ("double", "")
    values = ", ".join(one.hex() + ("F" if single else "") for one in x)
    names = ", ".join(f"(double)m{number}_{q}{f}(x[i])" for q in ("position", "velocity", "acceleration", "jerk"))
    return f"""    {{
        static const {kind} x[] = {{{values}}};
        size_t i;
        for (i = 0; i < sizeof x / sizeof x[0]; ++i) {{
            printf("%d %d %d %a %a %a %a\\n", {number}, {int(single)}, m{number}_piece{f}(x[i]), {names});
        }}
    }}
"""


@pytest.mark.parametrize(
    ("compiler", "sanitised"),
    [(COMPILER, False), *(pytest.param(name, True, marks=pytest.mark.long) for name in ("gcc", "clang"))],
)
def test_compiled_headers_keep_their_bounds_in_double_and_float(
    compiler: str | None,
    sanitised: bool,  # noqa: FBT001
    tmp_path: Path,
) -> None:
    if compiler is None or shutil.which(compiler) is None:
        pytest.skip(f"there is no {compiler or 'C compiler'}")
    made = motions()
    bodies, asked = [], {}
    for i, motion in enumerate(made):
        (tmp_path / f"m{i}.h").write_text(header(motion, f"m{i}"), "utf-8")
        for single in (False, True):
            asked[i, single] = places(motion, single=single)
            bodies.append(program(i, asked[i, single], single=single))
    includes = "".join(f'#include "m{i}.h"\n' for i in range(len(made)))
    source = (
        f"#include <stddef.h>\n#include <stdio.h>\n{includes}int main(void)\n{{\n{''.join(bodies)}    return 0;\n}}\n"
    )
    (tmp_path / "main.c").write_text(source, "utf-8")
    flags = [*STRICT, *SANITISED] if sanitised else STRICT
    subprocess.run([compiler, *flags, "main.c", "-o", "main"], cwd=tmp_path, check=True)
    run = subprocess.run([str(tmp_path / "main")], capture_output=True, text=True, check=True)
    rows = [line.split() for line in run.stdout.splitlines()]
    assert len(rows) == sum(map(len, asked.values()))
    bounds = {key: error_bounds(made[key[0]], SINGLE if key[1] else DOUBLE) for key in asked}
    worst = 0.0
    for key, x in asked.items():
        mine = [row for row in rows if (int(row[0]), bool(int(row[1]))) == key]
        for place, row in zip(x, mine, strict=True):
            for nu in range(4):
                exact = exact_value(made[key[0]], int(row[2]), Fraction(place), nu)
                error = abs(Fraction(float.fromhex(row[3 + nu])) - exact)
                assert error <= Fraction(bounds[key][nu])
                worst = max(worst, float(error) / bounds[key][nu])
    assert worst > 0.01, "the bound would hold whatever the code did"


@needs_compiler
def test_outside_the_motion_its_ends_are_held_and_the_header_may_be_included_twice(tmp_path: Path) -> None:
    (tmp_path / "press.h").write_text(header(PiecewiseMotion([1, 2, 3], [[0, 1], [1, 1]]), "press"), "utf-8")
    source = '#include "press.h"\n#include "press.h"\n#include <stdio.h>\n'
    source += "int main(void) { double all[4]; press_motion(9.0, all); "
    source += 'printf("%g %g %g", press_position(-5.0), all[0], (double)press_velocity_f(1.5F)); return 0; }\n'
    (tmp_path / "main.c").write_text(source, "utf-8")
    subprocess.run([str(COMPILER), *STRICT, "main.c", "-o", "main"], cwd=tmp_path, check=True)
    stdout = subprocess.run([str(tmp_path / "main")], capture_output=True, text=True, check=True).stdout
    assert stdout == "0 2 1"


@seed(99)
@examples(25)
@given(st.integers(0, 10**6), st.integers(0, 12), st.booleans())
def test_the_bound_holds_for_horner_in_floating_point(number: int, degree: int, single: bool) -> None:  # noqa: FBT001
    motion = random_motion(number, pieces=2, degree=degree)
    arithmetic, kind = (SINGLE, np.float32) if single else (DOUBLE, np.float64)
    run, bounds = as_stored(motion, arithmetic), error_bounds(motion, arithmetic)
    for piece, share in ((0, 0.999), (1, 0.37), (1, 1.0)):
        low, high = run.breaks[piece : piece + 2]
        x = min(kind(low + share * (high - low)), kind(high))
        values = [kind(0)] * 4
        s = kind(x - kind(low))
        values[0] = kind(run.powers()[piece][-1])
        for c in run.powers()[piece][-2::-1]:
            values = [kind(a * s + b) for a, b in zip(values, [kind(c), *values], strict=False)]
        for nu, value in enumerate(values):
            fraction = Fraction(float(kind(factorial(nu)) * value))
            assert abs(fraction - exact_value(motion, piece, Fraction(float(x)), nu)) <= Fraction(bounds[nu])


def test_the_bound_is_near_what_numbers_hold_however_long_a_piece_is() -> None:
    for length in (1e-3, 120.0, 1e5):
        motion = smoothstep(3).pieces("35 mm", f"{length} s")
        for arithmetic in (DOUBLE, SINGLE):
            for nu, bound in enumerate(error_bounds(motion, arithmetic)):
                assert bound <= 3000.0 * float(arithmetic.unit) * max(motion.peak(nu).value, 35.0 / length**nu)


def test_the_bound_is_near_what_numbers_hold_beside_a_long_dwell() -> None:
    """The beginning of a move of degree 23 and a rest of 108 deg, whose products of zeros are exact."""
    powers = smoothstep(11).pieces("35 mm", "90 s").coefficients[0]
    move, motion = PiecewiseMotion([0.0, 18.0], [powers]), PiecewiseMotion([0.0, 18.0, 126.0], [powers, [35.0]])
    alone, both = error_bounds(move, SINGLE), error_bounds(motion, SINGLE)
    assert both[1:] == pytest.approx(alone[1:], rel=1e-9)
    assert both[0] <= 35.0 * 70.0 * float(SINGLE.unit), "the position of the rest is rounded in each step"


def test_the_bound_holds_where_products_underflow() -> None:
    """Positions of 1e-36 in REAL, whose powers are below its least normal number."""
    motion = PiecewiseMotion([0.0, 3.0], [[1e-36 / 3.0**n for n in range(9)]])
    run, bounds, beyond = as_stored(motion, SINGLE), error_bounds(motion, SINGLE), 0
    row = [np.float32(c) for c in run.powers()[0]]
    for place in np.linspace(0.0, 3.0, 97, dtype=np.float32):
        values = [row[-1], *[np.float32(0.0)] * 3]
        for c in row[-2::-1]:
            values = [a * place + b for a, b in zip(values, [c, *values], strict=False)]
        for nu, value in enumerate(values):
            found = Fraction(float(np.float32(factorial(nu)) * value))
            error = abs(found - exact_value(motion, 0, Fraction(float(place)), nu))
            assert error <= Fraction(bounds[nu])
            beyond += error > 0
    assert beyond > 97


def test_the_header_says_units_peaks_proof_and_bounds_and_nothing_ends_its_comment() -> None:
    motion = PiecewiseMotion([0, 0.1], [[0, 0, 0, 35000]])
    labels = Labels("s", "mm", ("status optimal, bound 4.41 */ int x; /*", "second\nline"))
    source = header(motion, "press", labels)
    comment, rest = source.split("*/", 1)
    assert "acceleration from 0 mm/s^2 at x = 0 s to 21000 mm/s^2 at x = 0.1 s" in comment
    assert "status optimal, bound 4.41 * / int x; / *" in comment
    stated = re.search(r"rounding in REAL, proven, at most: (\S+) mm,", comment)
    assert stated is not None
    assert float(stated[1]) >= error_bounds(motion, SINGLE)[0]
    assert "made by optlaws" in comment
    assert "/*" not in rest.split("static", 1)[0]
    assert not re.search(r"malloc|include|math", rest)


@pytest.mark.parametrize(
    ("name", "proposed"),
    [
        ("3rd press", "cam_3rd_press"),
        ("int", "cam_int"),
        ("a-b", "a_b"),
        ("a" * 40, "a" * 31),
        (None, "cam"),
        ("π", "cam"),
    ],
)
def test_what_is_no_name_in_c_is_refused_with_one_that_is(name: object, proposed: str) -> None:
    with pytest.raises(InputError, match=f"take '{proposed}'"):
        c_name(name)
    assert c_name(proposed) == proposed


def test_numbers_that_float_does_not_hold_are_refused() -> None:
    with pytest.raises(InputError, match="beyond REAL32"):
        header(PiecewiseMotion([0, 1], [[0.0, 1e39]]), "press")
