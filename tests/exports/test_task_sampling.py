"""What a drive hears once in a task: second differences, of one shot with its rest and of cycles over their seam."""

import numpy as np
import pytest

from optlaws import InputError, smoothstep
from tests.exports.interpolations import linear
from tests.exports.samples import one_shot, optimal, press, turning
from tests.internals.exports import export_motion, task_sampling
from tests.internals.motion import motion_of_law


def test_straight_lines_are_heard_as_in_the_table() -> None:
    """1000 ticks a stroke: 37 points are heard with 26.9 C, 361 with 2.8 C, 3601 with 1.02 C."""
    motion = motion_of_law(optimal(), stroke="1 m", duration="1 s")
    for points, ratio in ((37, 26.9), (361, 2.78), (3601, 1.0185)):
        x = np.linspace(0.0, 1.0, points)
        assert task_sampling(linear(x, motion(x)), motion, "1 ms").acceleration / motion.peak(2) == pytest.approx(
            ratio, rel=3e-3
        )


def test_smooth_runs_are_heard_as_they_are() -> None:
    made = export_motion(one_shot(), "codesys-xyva", task="10 us")
    assert made.task is not None
    assert made.task.acceleration == pytest.approx(made.report.run.peak(2), rel=1e-3)
    assert "acceleration by positions every 0.01 ms, mm/s²" in str(made)
    assert made.results()["task"] == {"seconds": made.task.seconds, "acceleration": made.task.acceleration}


@pytest.mark.parametrize("cycle", [press(), turning()])
def test_a_cycle_goes_on_with_itself(cycle: object) -> None:
    """Nothing is heard at the seam that is not in the motion: no jump by which a cycle advances or returns."""
    made = cycle.export("codesys-xyva", task="0.7 ms")  # type: ignore[attr-defined]
    assert made.task.acceleration == pytest.approx(made.report.run.peak(2), rel=0.02)


@pytest.mark.parametrize(("task", "words"), [("1 mm", "time"), ("0.1 s", "task"), ("-1 ms", "task"), ("1 ns", "task")])
def test_a_wrong_task_is_named(task: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        export_motion(one_shot(), "csv", points=20, task=task)
    with pytest.raises(InputError, match="how fast the master goes"):
        export_motion(motion_of_law(smoothstep(3), stroke="1 mm", master="90 deg"), "csv", points=20, task="1 ms")
