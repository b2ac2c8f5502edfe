"""Integrals over a law: magnitudes, sizes, and splines over the displacement."""

import re
from collections.abc import Callable
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import fixed_quad
from scipy.optimize import brentq

from optlaws import (
    BoundaryConditions,
    Chebyshev,
    Drive,
    InputError,
    Mechanism,
    MotionLaw,
    Motor,
    Problem,
    catalogue,
    drive_torque,
    integral,
    law_from_z,
    maximum,
    peak,
    rms,
    smoothstep,
    synthesize,
    via,
)
from tests.internals.formulas import MotionFormula, of_text
from tests.internals.synthesis import space_of

SHOWN = re.compile(r"for both sides write (maximum\(.*\)), which is never less")


def written(text: str, **part: Any) -> Any:
    """What the error of a magnitude writes, read as Python."""
    with pytest.raises(InputError) as error:
        peak(text, **part)
    shown = SHOWN.search(str(error.value))
    assert shown is not None
    return eval(shown.group(1), {"maximum": maximum, "peak": peak})  # noqa: S307


def lossy(load: str, efficiency: float) -> tuple[Drive, str, float]:
    """A drive whose gear loses power, its torque over one stroke, and the unit of that."""
    mechanism = Mechanism("0.8 kg m^2", load=load)
    drive = Drive(mechanism, Motor("3e-4 kg m^2"), ratio=20, efficiency=efficiency)
    moved = drive.dimensionless("0 deg", "45 deg", "0.25 s")
    return drive, moved.torque, moved.unit


@pytest.mark.parametrize("text", ["b*c + 0.1*abs(b)", "b*c - 0.1*abs(b)", "c + max(1.2*(c + 0.3), 0.8*(c + 0.3))"])
@pytest.mark.parametrize("part", [{}, {"start": 0.25, "stop": 0.75}])
def test_what_is_written_is_never_less_than_the_magnitude(text: str, part: dict[str, float]) -> None:
    both, k = written(text, **part), np.linspace(part.get("start", 0.0), part.get("stop", 1.0), 4001)
    for law in (catalogue[name].law for name in ("345", "cycloidal", "modified sine", "4567")):
        values = {"abs": np.abs, "max": np.maximum, "b": law(k, 1), "c": law(k, 2)}
        size = np.abs(eval(text, values)).max()  # noqa: S307
        value = max(term.value(law) for part in both.parts for _, term in part.terms)
        assert size * (1.0 - 1e-7) <= value <= 2.0 * size


@pytest.mark.parametrize("load", ["3 N m", "-3 N m", "0 N m"])
@pytest.mark.parametrize("efficiency", [0.5, 0.85])
def test_what_is_written_for_a_drive_is_its_peak_torque(load: str, efficiency: float) -> None:
    drive, torque, unit = lossy(load, efficiency)
    with pytest.raises(InputError, match=r"of a drive they are `torque` and `branches\[-1\]`"):
        synthesize(Problem(order=3, minimise=f"peak({torque})", monotone=True))
    best = synthesize(Problem(order=3, minimise=written(torque), monotone=True))
    known = drive.sheet(best.law, 0.0, np.pi / 4.0, 0.25).peak_torque
    assert best.objective * unit == pytest.approx(known, rel=1e-6)


# --- sizes ---


def test_no_law_is_larger_than_an_integral_with_kinks_says() -> None:
    rest, constant = BoundaryConditions.rest(3), integral("abs(c - b)")
    [(order, factor, offset)] = constant.sizes(space_of(Chebyshev(7), rest, symmetric=False))
    rng, k = np.random.default_rng(1), np.linspace(0.0, 1.0, 2001)
    for size in (1.0, 10.0, 100.0) * 5:
        law = law_from_z(rest, size * rng.normal(size=2))
        assert float(np.mean(np.abs(law(k, order)))) <= factor * constant.value(law) + offset


# --- splines over the displacement ---


Array = NDArray[np.float64]
_GRID = np.linspace(0.0, 1.0, 4001)


def there_and_back(degree: int) -> MotionLaw:
    """A law that goes above 1 and below 0, and passes every place in between three times."""
    high, low = via("a", 1.15, at=0.3), via("a", -0.1, at=0.6)
    return synthesize(Problem(order=3, basis=Chebyshev(degree), symmetric=False, windows=(high, low))).law


def by_quadrature(motion: MotionFormula, law: MotionLaw, places: list[float], *, square: bool) -> float:
    """The integral, cut wherever the law passes a place or the formula changes its sign, which scipy finds."""

    def formula(k: Array) -> Array:
        return motion.values({**{name: law(k, nu) for nu, name in enumerate("abcj")}, "k": k})

    cuts = {0.0, 1.0}
    functions: list[Callable[[Array], Array]] = [*(partial(_above, law, place) for place in places), formula]
    for function in functions:
        heights = function(_GRID)
        for i in np.flatnonzero(heights[1:] * heights[:-1] < 0.0):
            cuts.add(brentq(lambda k, of=function: float(of(np.array([k]))[0]), _GRID[i], _GRID[i + 1], xtol=1e-15))
    edges = sorted(cuts)
    shown = (lambda k: formula(k) ** 2) if square else (lambda k: np.abs(formula(k)))
    return float(sum(fixed_quad(shown, low, high, n=80)[0] for low, high in pairwise(edges)))


def _above(law: MotionLaw, place: float, k: Array) -> Array:
    return np.asarray(law(k, 0) - place)


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("kind", "count", "degree"),
    [
        ("spline", 5, 0),
        ("spline", 12, 9),
        pytest.param("spline", 50, 41, marks=pytest.mark.long),
        ("table", 2, 0),
        ("table", 9, 7),
    ],
)
def test_integrals_and_root_mean_squares_are_those_of_scipy(kind: str, count: int, degree: int) -> None:
    law = there_and_back(degree) if degree else smoothstep(3)
    numbers = np.random.default_rng(count)
    places = sorted(numbers.uniform(0.0, 1.0, count).round(4).tolist())
    heights = numbers.uniform(0.5, 3.0, count).round(3).tolist()
    text = f"{kind}(a, {', '.join(f'{x!r}:{y!r}' for x, y in zip(places, heights, strict=True))})*c + b"
    motion = of_text(text)
    assert rms(text).value(law) == pytest.approx(by_quadrature(motion, law, places, square=True) ** 0.5, rel=1e-9)
    sizes = by_quadrature(motion, law, places, square=False)
    assert integral(f"abs({text})").value(law) == pytest.approx(sizes, rel=1e-8)


def test_a_torque_whose_inertia_is_a_spline_has_a_root_mean_square() -> None:
    torque = drive_torque(inertia="spline(a, 0:1, 0.25:2, 0.5:3, 0.75:2, 1:1)")
    assert rms(torque).value(smoothstep(3)) == pytest.approx(9.480863, abs=5e-7)


@pytest.mark.parametrize(
    ("places", "most"),
    [
        ("0:1, 0.1:1.2, 0.25:2, 0.3:2.6, 0.5:3, 0.6:2.6, 0.75:2, 0.9:1.5, 1:1", 9.0),
        ("0:2.1, 0.13:1.7, 0.32:1.1, 0.58:2.9, 0.81:1.4, 1:2.3", 9.0),
        ("0:1, 0.35:2.8, 0.45:1.3, 1:1.9", 10.0),
    ],
)
def test_a_bound_of_a_spline_is_kept_as_exactly_as_any(places: str, most: float) -> None:
    torque = rms(drive_torque(inertia=f"spline(a, {places})"))
    solution = synthesize(Problem(order=3, symmetric=False, bounds={torque: (None, most)}))
    assert torque.value(solution.law) == pytest.approx(most, rel=1e-12)
