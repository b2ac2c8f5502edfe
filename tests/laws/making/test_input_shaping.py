"""Shaped laws: what they leave of a vibration, against closed forms and against what the shapers promise."""

import numpy as np
import pytest

from optlaws import Follower, InputError, MotionLaw, catalogue, savin, shaped_law, smoothstep
from tests.internals.laws import Shaper

LAWS: dict[str, MotionLaw] = {
    "polynomial": smoothstep(3),
    "sines": catalogue["modified sine"].law,
    "pieces": catalogue["constant acceleration"].law,
    "savin": savin("IV", 11.0),
}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("shaper", ["ZV", "ZVD"])
@pytest.mark.parametrize(("nu", "damping"), [(9.0, 0.0), (14.0, 0.05), (60.0, 0.2)])
def test_nothing_is_left_of_the_vibration_and_the_law_is_a_sum(
    law: str, shaper: Shaper, nu: float, damping: float
) -> None:
    shaped = shaped_law(LAWS[law], nu, damping, shaper)
    assert Follower(nu, damping).response(shaped).residual_acceleration < 1e-9 * nu**2
    half = np.pi / (nu * np.sqrt(1.0 - damping**2))
    left = np.exp(-damping * nu * half)
    shares = np.array([1.0, left]) if shaper == "ZV" else np.array([1.0, 2.0 * left, left**2])
    duration = 1.0 - half * (len(shares) - 1)
    k = np.linspace(0.0, 1.0, 501)
    parts = [LAWS[law].a(np.clip((k - i * half) / duration, 0.0, 1.0)) for i in range(len(shares))]
    expected = np.array(shares / shares.sum()) @ np.array(parts)
    assert shaped.a(k) == pytest.approx(expected, abs=1e-12)


def test_three_repetitions_forgive_more_than_two() -> None:
    left = {}
    for shaper in ("ZV", "ZVD"):
        shaped = shaped_law(smoothstep(3), 20.0, 0.0, shaper)
        left[shaper] = [Follower(20.0 * off).response(shaped).residual_displacement for off in (0.98, 1.02)]
    assert max(left["ZVD"]) < 0.2 * max(left["ZV"])


@pytest.mark.parametrize(
    ("says", "arguments"),
    [
        ("leaves no time for the law", (3.0, 0.0, "ZV")),
        ("takes 1 of a period", (6.3, 0.0, "ZVD")),
        ("damping must be below 1", (20.0, 1.0, "ZV")),
        ("shaper", (20.0, 0.0, "E1")),
        ("one damping for all", ([20.0, 30.0], [0.0, 0.1, 0.2], "ZV")),
        ("frequency must be", (0.0, 0.0, "ZV")),
    ],
)
def test_wrong_shapers_are_named(says: str, arguments: tuple[float, float, Shaper]) -> None:
    with pytest.raises(InputError, match=says):
        shaped_law(smoothstep(3), *arguments)


@pytest.mark.parametrize("shaper", ["ZV", "MZV", "ZVD"])
def test_two_vibrations_are_shaped_one_after_the_other(shaper: Shaper) -> None:
    shaped = shaped_law(smoothstep(3), [25.0, 60.0], [0.02, 0.1], shaper)
    for nu, damping in ((25.0, 0.02), (60.0, 0.1)):
        assert Follower(nu, damping).response(shaped).residual_acceleration < 1e-9 * nu**2
    assert shaped.a(1.0) == pytest.approx(1.0, abs=1e-14)
