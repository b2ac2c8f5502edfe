"""A table that is sampled finer is split into the same dwells and moves."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from optlaws import OldTable, catalogue, split_table

Motion = Callable[[NDArray[np.float64]], NDArray[np.float64]]
STEPS = [3.6, 1.0, 0.36, 0.1]


def between_dwells(name: str) -> Motion:
    """30 mm up and back by a standard law."""
    law = catalogue[name].law
    return lambda x: 30.0 * (law(np.clip((x - 36.0) / 108.0, 0, 1)) - law(np.clip((x - 200.0) / 90.0, 0, 1)))


def harmonics(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """A motion without a dwell."""
    w = np.radians(x)
    return np.asarray(10.0 * np.cos(w) + 3.0 * np.cos(2.0 * w + 0.4) + 0.7 * np.cos(3.0 * w + 1.1))


def corners(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Constant velocities between dwells."""
    return np.interp(x, [0.0, 36.0, 144.0, 200.0, 290.0, 360.0], [0.0, 0.0, 30.0, 30.0, 0.0, 0.0])


def crest(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """A valve's lift, of which the acceleration is greatest where it turns."""
    return np.asarray(9.0 * np.sin(np.pi * np.clip((x - 100.0) / 120.0, 0.0, 1.0)) ** 2)


LAWS = [
    "cycloidal",
    "modified sine",
    "modified trapezoid",
    "3-4-5 polynomial",
    "simple harmonic",
    "5-6-7-8-9 polynomial",
]
MOTIONS = {**{name: between_dwells(name) for name in LAWS}, "harmonics": harmonics, "corners": corners, "crest": crest}


def kinds(table: OldTable) -> list[tuple[str, str]]:
    """Its dwells and moves with their laws, where these are standard."""
    return [(part.kind, part.law if isinstance(part.law, str) else "") for part in table.stretches]


@pytest.mark.long
@pytest.mark.parametrize("name", MOTIONS)
@pytest.mark.parametrize("noise", [0.0, 3e-3])
def test_finer_sampling_splits_a_table_alike(name: str, noise: float) -> None:
    """Of few rows and of 1,441 standard laws are read each time, in tests of standard laws."""
    motion, tables = MOTIONS[name], []
    for step in STEPS:
        x = np.linspace(0.0, 360.0, round(360.0 / step) + 1)
        y = motion(x) + np.random.default_rng(3).normal(0.0, noise, len(x))
        tables.append(split_table(x, np.round(y, 4), digit=1e-4))
    finest = tables[-1]
    at = np.linspace(0.0, 360.0, 36001)
    acceleration = float(np.abs(np.diff(motion(at), 2)).max() / 1e-4)
    # where a harmonic motion turns slowly the rows tell little of the place
    near = 2.0 * STEPS[0] if motion is harmonics else 0.1
    for table in tables:
        assert kinds(table) == kinds(finest)
        assert [part.start for part in table.stretches] == pytest.approx([p.start for p in finest.stretches], abs=near)
        assert len(table.corners) == (4 if motion is corners else 0)
        assert table.outliers == ()
        assert motion is corners or table.peaks[1].holds(acceleration)


@pytest.mark.parametrize("seed", [3, 16])
def test_a_slow_turn_in_noise_is_no_dwell(seed: int) -> None:
    x = np.linspace(0.0, 360.0, 361)
    y = harmonics(x) + np.random.default_rng(seed).normal(0.0, 3e-3, len(x))
    table = split_table(x, np.round(y, 4), digit=1e-4)
    assert [part.kind for part in table.stretches] == ["return", "rise", "return"]
