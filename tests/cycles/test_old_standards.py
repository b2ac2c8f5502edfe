"""Old tables of standard laws, and of lifts between ramps, whose parts are all known: they are read as these parts."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import BPoly

from optlaws import catalogue, split_table

Array = NDArray[np.float64]
Move = tuple[str, float, float, float]

EVEN, HALVES = np.linspace(0.0, 360.0, 901), np.linspace(0.0, 360.0, 721)
UNEVEN = np.unique(np.random.default_rng(1).choice(3600, 1200)) / 10.0


class Standard(NamedTuple):
    """Moves by laws, each from a place to a place by a stroke, and the rows that are samples of them."""

    moves: Sequence[Move]
    places: Array = HALVES
    #: the standard deviation, in the stroke's unit
    noise: float = 0.0
    seed: int = 1
    decimals: int = 4
    #: how near the ends of parts are found, in deg
    near: float = 0.1
    specks: dict[int, float] = {}  # noqa: RUF012 - none is changed
    #: whether rows at rest are exact
    exact_rests: bool = False
    frame: dict[str, Any] = {}  # noqa: RUF012

    def heights(self) -> Array:
        """What a table prints."""
        numbers, y, moving = np.random.default_rng(self.seed), np.zeros_like(self.places), self.places < 0.0
        for law, start, stop, stroke in self.moves:
            y += stroke * np.asarray(catalogue[law].law(np.clip((self.places - start) / (stop - start), 0.0, 1.0)))
            moving |= (self.places > start) & (self.places < stop)
        y += numbers.normal(0.0, self.noise, len(y)) * (moving | (not self.exact_rests))
        for row, off in self.specks.items():
            y[row] += off
        return np.asarray(np.round(y, self.decimals))

    def parts(self) -> tuple[list[str | None], list[float]]:
        """The laws of its stretches, none of a rest, and where they stop."""
        laws: list[str | None] = []
        stops: list[float] = []
        for law, start, stop, _ in [*self.moves, ("", 360.0, 360.0, 0.0)]:
            if start > (stops[-1] if stops else 0.0):
                laws, stops = [*laws, None], [*stops, start]
            if stop > start:
                laws, stops = [*laws, law], [*stops, stop]
        return laws, stops


def there_and_back(law: str, stroke: float, up: tuple[float, float], down: tuple[float, float]) -> list[Move]:
    return [(law, *up, stroke), (law, *down, -stroke)]


def index(law: str, stops: int, rest: float, stroke: float) -> list[Move]:
    turn = 360.0 / stops
    return [(law, turn * i + rest, turn * i + rest + 60.0 * 4 / stops, stroke) for i in range(stops)]


PLAIN, LATER = ((30.0, 130.0), (180.0, 270.0)), ((40.0, 130.0), (190.0, 280.0))
SLOW = there_and_back("cycloidal", 33.42, (30.0, 110.0), (180.0, 270.0))
SHORT = there_and_back("cycloidal", 33.42, (30.0, 93.9), (180.0, 273.6))
STOPPING = [
    ("cycloidal", 50.0, 130.0, 20.0),
    ("3-4-5 polynomial", 130.0, 220.0, -8.0),
    ("cycloidal", 220.0, 330.0, -12.0),
]
SEAM = there_and_back("cycloidal", 25.0, (40.0, 130.0), (170.0, 280.0))
STANDARDS = {
    "begins where its noisy table does": [
        Standard(there_and_back("modified sine", 40.0, (0.0, 110.0), (200.0, 300.0)), EVEN, 0.004, 100 + i, near=0.01)
        for i in range(4)
    ],
    "a speck in the slow end of a move": [
        Standard(SLOW, EVEN, 0.005, seed, specks={round(at / 0.4): 0.054}, near=1.5)
        for seed, at in ((31, 104.8), (44, 109.6), (48, 182.0), (51, 268.8))
    ],
    "rows left out and uneven places": [
        Standard(SHORT, x, 0.005, 0, specks={int(np.searchsorted(x, 68.8)): 0.1}, near=1.0, frame={"turn": 360.0})
        for x in (np.delete(EVEN, 300), np.delete(EVEN, [100, 150, 173, 223, 500]), UNEVEN)
    ],
    "two specks beside each other": [
        Standard(there_and_back("cycloidal", 20.0, *LATER), HALVES[::2], 2e-3, 70, specks={70: 0.1, 72: 0.1})
    ],
    "crests of noisy harmonics": [
        Standard(there_and_back("simple harmonic", 33.42, (0.0, 160.0), (160.0, 360.0)), EVEN, 0.005, i, near=0.5)
        for i in range(6)
    ],
    "noise of moves beside exact rests": [
        Standard(
            there_and_back("cycloidal", 20.0, (30.0, 120.0), (200.0, 290.0)), noise=0.0022, seed=3, decimals=5,
            near=0.3, exact_rests=True,
        )
    ],
    "finer samples": [
        Standard(
            there_and_back("modified sine", 30.0, (20.0, 120.0), (180.0, 260.0)), np.linspace(0.0, 360.0, rows), 0.005,
            7, 3, near=1.5,
        )
        for rows in (1441, 721, 361)
    ],
    "standard laws between dwells": [
        Standard(there_and_back(name, 30.0, *PLAIN), noise=noise, seed=7, decimals=12, near=1.0)
        for name in ("cycloidal", "simple harmonic", "4-5-6-7 polynomial", "modified trapezoid")
        for noise in (0.0, 5e-3)
    ],
    "rows in the slow end of a law": [
        Standard(
            there_and_back("4-5-6-7 polynomial", 25.0, (30.0, 110.0), (160.0, 240.0)), np.linspace(0.0, 360.0, 1801),
            0.01, seed, 3,
        )
        for seed in (8, 10)
    ],
    "a row that is missing": [
        Standard(there_and_back("3-4-5 polynomial", 22.0, *LATER), np.delete(HALVES[::2], row), decimals=3, near=0.01)
        for row in (65, 79, 93, 100)
    ],
    "a crest that looks like a long rest": [
        Standard(
            there_and_back("4-5-6-7 polynomial", 2.0, (60.0, 146.0), (146.0, 261.0)), np.linspace(0.0, 360.0, 3601),
            5e-3, 1, 2, near=0.2,
        )
    ],
    "short dwells between short moves of coarse tables": [
        Standard(
            there_and_back("cycloidal", 3.2, (30.0, 70.0), (70.0 + dwell, 105.0 + dwell)),
            np.linspace(0.0, 360.0, rows), decimals=3,
        )
        for rows, dwell in ((73, 5.0), (72, 5.0), (91, 15.0), (121, 8.0))
    ],
    "a return that stops for an instant": [
        Standard(STOPPING, np.linspace(0.0, 360.0, rows), noise, 1, decimals, near=0.5)
        for noise, decimals, rows in ((2e-3, 3, 721), (0.0, 4, 361), (0.0, 3, 721))
    ],
    "a point far off at the seam": [
        Standard(SEAM, noise=2e-3, seed=2, specks={row % 721: 0.08, other % 721: -0.06})
        for row, other in ((0, -2), (-1, 300), (0, 300))
    ],
    "an index of four stops": [
        Standard(index("modified sine", 4, 30.0, 90.0), noise=2e-3, seed=i, decimals=3) for i in range(4)
    ],
    "an index of eight stops": [
        Standard(index("modified sine", 8, 15.0, 25.0), np.linspace(0.0, 360.0, 1441), 5e-3, i, 3, near=0.3)
        for i in range(4)
    ],
    "an index that moves up to its seam, without its last row": [
        Standard(
            index("cycloidal", 4, 30.0, 90.0), np.arange(1440) / 4.0, 5e-3, 114, 3, near=0.2,
            frame={"unit": "deg", **frame},
        )
        for frame in ({}, {"turn": 360.0}, {"advance": 360.0})
    ],
}  # fmt: skip
#: whose branches the others take too
LONG = {
    "a crest that looks like a long rest", "an index of eight stops", "an index of four stops",
    "standard laws between dwells",
}  # fmt: skip
EACH = [
    pytest.param(each, id=f"{name}, {i}", marks=[pytest.mark.long] if i or name in LONG else [])
    for name, cases in STANDARDS.items()
    for i, each in enumerate(cases)
]


@pytest.mark.parametrize("known", EACH)
def test_a_table_of_standard_laws_is_read_as_these(known: Standard) -> None:
    table = split_table(known.places, known.heights(), digit=10.0**-known.decimals, **known.frame)
    laws, stops = known.parts()
    assert [part.law for part in table.stretches] == laws
    assert [part.stop for part in table.stretches] == pytest.approx(stops, abs=known.near)
    assert set(table.outliers) == set(known.specks)
    assert table.corners == ()
    for nu in (1, 2):
        peaks = [
            abs(stroke) * catalogue[law].law.peak(nu).value / (stop - start) ** nu
            for law, start, stop, stroke in known.moves
        ]
        assert table.peaks[nu - 1].holds(max(peaks))
    room = 4.0 * known.noise + 2.0 * 10.0**-known.decimals
    assert [part.stroke for part in table.moves] == pytest.approx([stroke for *_, stroke in known.moves], abs=room)
    assert table.scatter >= 0.8 * known.noise
    assert not known.exact_rests or table.scatter == pytest.approx(known.noise, rel=0.2)


class Lobe(NamedTuple):
    """A lift from a corner to a crest and on to another one, ramps before and behind it from and to a rest.

    The value and two derivatives at the corners, where the ramps meet the lift, and those at the crest.
    """

    feet: tuple[float, float]
    corners: tuple[float, float]
    meeting: tuple[tuple[float, float, float], tuple[float, float, float]]
    crest: float
    top: tuple[float, float, float]
    places: Array
    noise: float = 0.0
    seed: int = 1
    decimals: int = 3
    near: float = 0.05
    turn: float = 360.0

    def lift(self) -> BPoly:
        """Between the corners."""
        places = [self.corners[0], self.crest, self.corners[1]]
        return BPoly.from_derivatives(places, [self.meeting[0], self.top, self.meeting[1]])

    def exact(self) -> Array:
        """What the table has samples of."""
        (first, last), (rise, fall) = self.feet, self.corners
        y = np.interp(self.places, [first, rise, fall, last], [0.0, self.meeting[0][0], self.meeting[1][0], 0.0])
        inside = (self.places >= rise) & (self.places <= fall)
        return np.asarray(np.where(inside, self.lift()(np.clip(self.places, rise, fall)), y))


def even(
    foot: float, corner: float, meeting: tuple[float, float], crest: float, top: tuple[float, float], **more: Any
) -> Lobe:
    """With ramps and lifts alike on both sides."""
    (height, velocity), mirrored = meeting, (2.0 * crest - foot, 2.0 * crest - corner)
    ends = ((height, velocity, 0.0), (height, -velocity, 0.0))
    return Lobe((foot, mirrored[0]), (corner, mirrored[1]), ends, crest, (top[0], 0.0, top[1]), **more)


VALVE = Lobe(
    (85.0, 245.0 + 0.25 / 0.015),
    (100.0, 245.0),
    ((0.3, 0.02, 0.0), (0.25, -0.015, 0.0)),
    170.0,
    (9.0, 0.0, -0.006),
    HALVES,
)
LOBES = {
    "two ramps that are not alike": VALVE._replace(noise=0.003, seed=5, decimals=4, near=0.4),
    "leaves its ramp at rest": even(95.0, 120.0, (0.3, 0.0), 180.0, (8.3, -0.0448 / 6.0), places=HALVES),
    "five decimals": even(
        64.0, 78.0, (0.2695, 0.0), 134.0, (6.4539, -0.0047), places=np.linspace(0.0, 360.0, 1441), decimals=5
    ),
    "a line that a lift joins smoothly": even(
        100.0, 120.0, (0.24, 0.012), 178.0, (9.74, -0.007), places=HALVES[::2], noise=8e-3, near=1.5
    ),
    "a long polynomial": even(
        174.0, 234.0, (0.3, 0.005), 362.0, (10.7, -0.0016), places=np.linspace(0.0, 720.0, 1441), noise=1e-3, seed=16,
        decimals=4, near=0.5, turn=720.0,
    ),
    "ramps of eleven rows": even(
        95.0, 117.0, (0.44, 0.0), 169.0, (8.64, -0.016), places=np.linspace(0.0, 358.0, 180), noise=3e-3, seed=3,
        near=0.6,
    ),
}  # fmt: skip


#: corners are sought for seconds in each, and the branches of the others are among those of this one
EACH_TIME = {"a line that a lift joins smoothly"}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[] if name in EACH_TIME else [pytest.mark.long]) for name in LOBES]
)
def test_a_lift_between_ramps_has_corners_where_its_velocity_jumps_and_no_others(name: str) -> None:
    known = LOBES[name]
    numbers = np.random.default_rng(known.seed).normal(0.0, known.noise, len(known.places))
    exact = known.exact()
    table = split_table(
        known.places, np.round(exact + numbers, known.decimals), digit=10.0**-known.decimals, turn=known.turn
    )
    jumps = [known.feet[0], *(c for c, meeting in zip(known.corners, known.meeting, strict=True) if not meeting[1])]
    jumps = sorted([*jumps, known.feet[1]])
    assert table.corners == pytest.approx(jumps, abs=known.near)
    assert table.outliers == ()
    assert np.abs(table.at(known.places) - exact).max() <= 4.0 * known.noise + 1.5 * 10.0**-known.decimals
    rise, fall = known.corners
    inside = np.linspace(rise + 1e-6, fall - 1e-6, 100_001)
    assert table.peaks[0].holds(float(np.abs(known.lift()(inside, 1)).max()))
    assert table.peaks[0].high < 1.03 * table.peaks[0].low
    assert np.isinf(table.peaks[1].high)
    ends = [known.feet[0], rise, known.crest, fall, known.feet[1], known.turn]
    places = [part.stop for part in table.stretches]
    assert all(min(abs(place - end) for place in places) < max(8.0 * known.near, 0.5) for end in ends)
    assert all(first < last for first, last in pairwise(places))
