"""Cycles and moves whose strokes and limits are multiplied alike keep status, objective and bound."""

from typing import Any

import pytest

from optlaws import Cycle, Dwell, Problem, Return, Rise, fastest

#: what is minimised, limits for strokes of 35 mm, and the power of the strokes by which the objective grows
CASES: list[tuple[str, dict[str, tuple[float, str]], int]] = [
    ("acceleration", {}, 1),
    ("jerk", {}, 1),
    ("velocity", {}, 1),
    ("rms acceleration", {}, 1),
    ("rms jerk", {}, 1),
    ("acceleration", {"velocity": (616.0, "mm/s")}, 1),
    ("acceleration", {"jerk": (2500.0, "m/s^3")}, 1),
    ("jerk", {"velocity": (650.0, "mm/s")}, 1),
    ("jerk", {"acceleration": (26.0, "m/s^2")}, 1),
    ("rms acceleration", {"velocity": (616.0, "mm/s")}, 1),
    ("power", {"velocity": (650.0, "mm/s")}, 2),
]


def scaled(minimise: str, limits: dict[str, tuple[float, str]], scale: float) -> Cycle:
    stroke = f"{35.0 * scale!r} mm"
    segments: list[Any] = [Rise(stroke, "120 deg"), Dwell("90 deg"), Return(stroke, "100 deg"), Dwell()]
    of_scale = {key: f"{value * scale!r} {unit}" for key, (value, unit) in limits.items()}
    drive: dict[str, Any] = {"drive": {"mass": "2 kg"}} if minimise == "power" else {}
    return Cycle(segments, speed="200 rpm", minimise=minimise, limits=of_scale, **drive)


@pytest.mark.sample(6)
@pytest.mark.parametrize(("minimise", "limits", "grows"), CASES)
@pytest.mark.parametrize("scale", [1.0001, 1.1, 1e-9, 1e-3, 1e6])
def test_strokes_in_another_scale_change_no_status(
    minimise: str, limits: dict[str, tuple[float, str]], grows: int, scale: float
) -> None:
    one, other = scaled(minimise, limits, 1.0), scaled(minimise, limits, scale)
    assert other.status == one.status
    assert other.objective / scale**grows == pytest.approx(one.objective, rel=1e-9)
    assert other.lower_bound is not None
    assert one.lower_bound is not None
    assert other.lower_bound / scale**grows == pytest.approx(one.lower_bound, rel=1e-8)


@pytest.mark.parametrize("scale", [1.0001, 1.1, 1e-9, 1e6])
@pytest.mark.parametrize(
    "limits",
    [
        {"velocity": (1000.0, "mm/s"), "acceleration": (12.0, "m/s^2"), "jerk": (300.0, "m/s^3")},
        {"velocity": (700.0, "mm/s"), "acceleration": (8.0, "m/s^2")},
        {"jerk": (300.0, "m/s^3")},
    ],
)
def test_the_least_time_is_of_no_scale(limits: dict[str, tuple[float, str]], scale: float) -> None:
    one, other = (
        fastest(
            Problem(order=3),
            stroke=f"{100.0 * times!r} mm",
            limits={key: f"{value * times!r} {unit}" for key, (value, unit) in limits.items()},
        )
        for times in (1.0, scale)
    )
    assert other.binding == one.binding
    assert other.duration == pytest.approx(one.duration, rel=1e-9)
    assert other.limit == pytest.approx(one.limit, rel=1e-8)
