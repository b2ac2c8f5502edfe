"""What roundings add to the acceleration of a run never exceeds 6 eps/dx², whatever is exported."""

from functools import cache

import numpy as np
import pytest

from optlaws import MotionLaw, catalogue, smoothstep
from tests.exports.interpolations import cubic_spline
from tests.exports.samples import optimal
from tests.internals.exports import export_motion
from tests.internals.motion import Motion, motion_of_law

FORMATS = ("csv", "rockwell-cam", "rockwell-cam-extended", "lenze", "kas")


@cache
def laws() -> tuple[MotionLaw, ...]:
    names = ("cycloidal", "modified sine", "modified trapezoid", "parabolic")
    return (optimal(), *(smoothstep(order) for order in (2, 3, 5)), *(catalogue[name].law for name in names))


def drawn(rng: np.random.Generator) -> tuple[Motion, str, dict[str, int]]:
    """A motion with its format and what is asked of it."""
    law = laws()[rng.integers(len(laws()))]
    stroke, master = float(10.0 ** rng.uniform(-1, 3)) * float(rng.choice([-1, 1])), float(10.0 ** rng.uniform(-1, 3))
    start = f"{stroke * rng.uniform(-2, 2)!r} mm"
    motion = motion_of_law(law, stroke=f"{stroke!r} mm", master=f"{master!r} deg", start=start)
    to = FORMATS[rng.integers(len(FORMATS))]
    asked = {"points": int(10.0 ** rng.uniform(0.9, 3.0))}
    if to in {"csv", "rockwell-cam", "rockwell-cam-extended"} and rng.random() < 0.7:
        asked["counts"] = int(2.0 ** rng.uniform(8, 22))
    elif to != "rockwell-cam":
        # as many that the points of the master are told apart
        asked["digits"] = int(np.ceil(-np.log10(master / asked["points"]))) + int(rng.integers(1, 5))
        asked["digits"] = max(asked["digits"], 0)
    return motion, to, asked


def breaks_the_bound(motion: Motion, to: str, asked: dict[str, int]) -> bool:
    made = export_motion(motion, to, **asked)  # type: ignore[arg-type]
    x = np.array(made.run.breaks)
    places = np.clip(x, motion.start, motion.stop)
    first, last = motion.ends(1)
    exact = cubic_spline(x, np.asarray(motion(places)), slopes=(first, last))
    added = made.run.minus(exact).peak(2).value
    noise = 1e-12 * exact.peak(0).value / float(np.diff(x).min()) ** 2
    return added > made.written.bound * (1.0 + 1e-6) + noise


def test_a_sample_keeps_the_bound() -> None:
    rng = np.random.default_rng(20)
    assert [one for one in (drawn(rng) for _ in range(25)) if breaks_the_bound(*one)] == []


@pytest.mark.long
def test_ten_thousand_keep_the_bound() -> None:
    rng = np.random.default_rng(21)
    assert [one for one in (drawn(rng) for _ in range(10_000)) if breaks_the_bound(*one)] == []


def test_the_bound_is_near() -> None:
    """Alternating errors of eps/2 reach it within a few per cent, so that no smaller rule would do."""
    x = np.linspace(0.0, 1.0, 101)
    eps = 1e-4
    y = np.asarray(smoothstep(3)(x))
    wrong = cubic_spline(x, y + 0.5 * eps * (-1.0) ** np.arange(101))
    added = wrong.minus(cubic_spline(x, y)).peak(2).value
    assert 0.9 < added / (6.0 * eps * 100.0**2) <= 1.0 + 1e-9


def test_the_rule_of_the_page() -> None:
    """With 65,536 counts a stroke of the law with C = 4.6478, 361 points may run with 3.55 C and 721 with 11.2 C."""
    for points, most in ((361, 2.55), (721, 10.2)):
        motion = motion_of_law(optimal(), stroke="1 m", duration="1 s")
        made = export_motion(motion, "csv", points=points, counts=65536)
        assert made.written.bound / motion.peak(2) == pytest.approx(most, rel=0.01)
        assert made.report.ratio(2) <= 1.001 + most
