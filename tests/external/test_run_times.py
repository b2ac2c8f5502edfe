"""Tables that are exported here, as the open run times of others run them."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import BPoly, CubicSpline

from optlaws import Cycle, InputError, MotionLaw, catalogue
from tests.exports import readers
from tests.exports.samples import SAID, optimal, press, shearing, turning
from tests.internals.exports import Export

Array = NDArray[np.float64]


def as_rtmotion_runs(x: Array, y: Array) -> list[BPoly]:
    """Quintics by the rule of Intel's RTmotion (Apache-2.0, FbCamIn::findSlavePoint, segments of the type polyFive).

    V and A of the table are not read: the velocity at a point is the mean of the slopes on both sides, at the ends of a
    cam that does not repeat 0, and the acceleration is 0. Its program, built once from edge-ai-libraries, answered the
    same to 2e-15 for its own table, and to 6e-16 for the tables of these tests.
    """
    slopes = np.diff(y) / np.diff(x)
    velocities = [0.0, *(0.5 * (slopes[1:] + slopes[:-1])).tolist(), 0.0]
    ends = list(zip(y.tolist(), velocities, strict=True))
    return [
        BPoly.from_derivatives([low, high], [[*first, 0.0], [*second, 0.0]])
        for low, high, first, second in zip(x, x[1:], ends, ends[1:], strict=False)
    ]


@pytest.mark.parametrize(
    ("points", "ratio", "apart"), [(18, 1.4742, 5.2e-4), (61, 1.4957, 4.1e-5), (181, 1.4989, 4.6e-6)]
)
def test_a_run_time_that_does_not_read_accelerations_makes_half_as_much_again(
    points: int, ratio: float, apart: float
) -> None:
    made = optimal().export("codesys-xyva", stroke="1 mm", master="1 deg", points=points)
    x, _ = readers.codesys_xyva(made.text)
    pieces = as_rtmotion_runs(x, np.asarray(made.run(x)))
    peak = max(np.abs(piece(np.linspace(piece.x[0], piece.x[-1], 101), nu=2)).max() for piece in pieces)
    assert peak / optimal().constants.C.value == pytest.approx(ratio, abs=6e-4)
    assert made.report.ratio(2) < 1.0001
    for piece in pieces:
        places = np.linspace(piece.x[0], piece.x[-1], 11)
        assert np.abs(piece(places) - optimal()(places)).max() <= apart


def as_plcopen_runs(x: Array, y: Array, interpolation: str, *, periodic: bool) -> CubicSpline | None:
    """The spline of plcopen (Apache-2.0, core/exec/sync.h, CamSpline) or None for straight lines.

    At most 64 points, no acceleration at the ends or periodic. Its program, built once from pyplcopen 0.21, answered
    what the export's run does: positions to 5e-16 of their size, velocities to 7e-16, accelerations to 5e-14.
    """
    return CubicSpline(x, y, bc_type="periodic" if periodic else "natural") if interpolation == "cubic" else None


MOTIONS: dict[str, Callable[[], MotionLaw | Cycle]] = {
    "law": optimal,
    "sine": lambda: catalogue["modified sine"].law,
    "cycle": press,
    "turning": turning,
    "shearing": shearing,
}
CLOSED = {"cycle", "shearing"}


@pytest.mark.parametrize("points", [21, 64])
@pytest.mark.parametrize("interpolation", ["cubic", "linear"])
@pytest.mark.parametrize("name", MOTIONS)
def test_plcopen_reads_and_runs_its_tables_as_the_report_says(
    name: str, interpolation: str, points: int, tmp_path: Path
) -> None:
    pyplcopen = pytest.importorskip("pyplcopen", reason="pyplcopen has no wheel for this Python")
    motion = MOTIONS[name]()
    arguments: dict[str, Any] = {"interpolation": interpolation, "points": points}
    arguments |= SAID if isinstance(motion, MotionLaw) else {}
    made = cast("Export", motion.export("plcopen", **arguments))
    table = np.array(pyplcopen.load_cam_table_csv(str(made.write(tmp_path / "cam.csv"))))
    assert len(table) == points
    x, y = table.T
    spline = as_plcopen_runs(x, y, interpolation, periodic=name in CLOSED)
    places = np.linspace(x[0], x[-1], 901)
    if spline is None:
        assert np.interp(places, x, y) == pytest.approx(made.run(places), abs=1e-14 * np.abs(y).max())
        return
    assert f"C2 cubic spline, {'cyclic' if name in CLOSED else 'natural'}" in str(made)
    for nu in range(3):
        run = np.asarray(made.run(places[1:-1], nu))
        assert np.abs(spline(places[1:-1], nu) - run).max() <= 1e-12 * np.abs(run).max()
    # the acceleration is straight between points: its peak is at one
    rate = made.motion.units.rate or 1.0
    assert made.report.run.peak(2) == pytest.approx(np.abs(spline(x, 2)).max() * rate**2, rel=1e-12)


def test_plcopen_is_given_no_more_points_than_it_splines() -> None:
    law = catalogue["cycloidal"].law
    assert law.export("plcopen", interpolation="linear", points=65, **SAID).points == 65
    with pytest.raises(InputError, match="to 64"):
        law.export("plcopen", points=65, **SAID)
