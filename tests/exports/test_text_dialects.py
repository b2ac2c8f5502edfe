"""Tables as text with either decimal sign, whatever the locale: every number comes back as it is told to be."""

import locale

import numpy as np
import pytest
from hypothesis import given, seed
from hypothesis import strategies as st

from optlaws import smoothstep
from tests.exports import readers
from tests.internals.exports import export_motion, plain_column
from tests.internals.motion import motion_of_law
from tests.sampling import examples

READERS = {
    "csv": lambda text, sign: readers.separated(text, ";" if sign == "," else ",", sign)[1][:2],
    "sew": readers.sew,
    "lenze": readers.lenze,
    "kas": readers.kas,
}


@seed(7)
@examples(40)
@given(
    to=st.sampled_from(sorted(READERS)),
    sign=st.sampled_from([".", ","]),
    digits=st.none() | st.integers(3, 12),
    stroke=st.floats(0.01, 1e4),
    master=st.floats(1.0, 1e5),
    negative=st.booleans(),
    points=st.integers(5, 40),
)
def test_numbers_come_back(
    *, to: str, sign: str, digits: int | None, stroke: float, master: float, negative: bool, points: int
) -> None:
    stroke = -stroke if negative else stroke
    motion = motion_of_law(smoothstep(3), stroke=f"{stroke!r} mm", master=f"{master!r} deg")
    asked = {"digits": digits} if digits is not None else {}
    made = export_motion(motion, to, points=points, decimal=sign, **asked)  # type: ignore[arg-type]
    x, y = READERS[to](made.text, sign)
    np.testing.assert_array_equal(x, made.run.breaks)
    expected = [row[0] for row in made.run.coefficients]
    np.testing.assert_array_equal(y[:-1], expected)
    if digits is not None:
        off = np.abs(y - motion(np.clip(x, 0.0, motion.stop))).max()
        assert off <= 10.0**-digits * (1.0 + 3.0 * abs(stroke) / master)


@given(st.floats(allow_nan=False, allow_infinity=False, min_value=-1e15, max_value=1e15), st.integers(0, 17))
@seed(8)
@examples(100)
def test_a_number_has_no_exponent_and_is_itself(value: float, digits: int) -> None:
    every, rounded, dialect = (plain_column([value], *form)[0] for form in ((), (digits,), (digits, ",")))
    assert float(every) == value
    assert float(rounded) == pytest.approx(value, abs=0.51 * 10.0**-digits + 1e-15 * abs(value))
    for text in (every, dialect):
        assert set(text) <= set("-0123456789.,")
        assert text not in {"-0", "-0,0"}


def test_no_locale_changes_a_byte() -> None:
    motion = motion_of_law(smoothstep(3), stroke="35 mm", master="120 deg")
    texts = {to: export_motion(motion, to, points=9).text for to in READERS}
    kept = locale.setlocale(locale.LC_ALL)
    try:
        for name in ("de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8", "ar_EG.UTF-8"):
            try:
                locale.setlocale(locale.LC_ALL, name)
            except locale.Error:
                continue
            assert {to: export_motion(motion, to, points=9).text for to in READERS} == texts
    finally:
        locale.setlocale(locale.LC_ALL, kept)
