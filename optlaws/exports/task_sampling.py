"""The sampling of a run by the drive's task: positions once in a task cycle, straight lines between them."""

from __future__ import annotations

from dataclasses import dataclass
from math import floor
from typing import Any

import numpy as np

from optlaws.errors import InputError
from optlaws.motion.motion import Motion
from optlaws.motion.polynomials import PiecewiseMotion
from optlaws.motion.quantities import quantity
from optlaws.numbers import MOST_VALUES


@dataclass(frozen=True)
class TaskSampling:
    """The sampled run: the time of a task in seconds, and the greatest second difference of positions over it."""

    seconds: float
    acceleration: float


def task_sampling(run: PiecewiseMotion, motion: Motion, task: Any) -> TaskSampling:  # noqa: ANN401 - a quantity
    """The run sampled once in a task: second differences of the positions, those at both ends included.

    Before and after a motion of one shot there is rest; a cycle goes on with itself.

    Parameters
    ----------
    run
        What the controller makes of an export.
    motion
        What was exported; it must be known how fast its master goes.
    task
        The time of a task, such as "1 ms".

    Raises
    ------
    InputError
        If the time is none, or so long or short that there are fewer than 4 or too many positions.

    Examples
    --------
    >>> from optlaws.exports.interpolation import linear
    >>> from optlaws.motion.motion import motion_of_law
    >>> from optlaws.laws import smoothstep
    >>> motion = motion_of_law(smoothstep(3), stroke="35 mm", time="0.1 s")
    >>> x = np.linspace(0.0, 0.1, 37)
    >>> round(task_sampling(linear(x, motion(x)), motion, "0.1 ms").acceleration / motion.peak(2), 1)
    27.0
    """
    seconds = quantity(task, "time", "task")
    if motion.units.rate is None:
        raise InputError("task: how fast the master goes is not known: say how long the motion takes, time='0.1 s'")
    step = seconds * motion.units.rate
    if not 4.0 * step <= motion.length <= MOST_VALUES * step:
        raise InputError(f"task must be between {MOST_VALUES} and 4 of it in the motion, got {task!r}")
    count = floor(motion.length / step * (1.0 + 1e-12))
    y = np.asarray(run(np.minimum(run.start + step * np.arange(count + 1), run.stop)))
    last = float(run.ends(0)[1][-1])
    if motion.repeats:
        again = motion.advance + run(np.clip(step * np.arange(count + 1, count + 3) - motion.length, 0.0, None))
        sampled = np.concatenate([y, again])
    else:
        sampled = np.concatenate([y[:1], y[:1], y, [last, last]])
    return TaskSampling(seconds, float(np.abs(np.diff(sampled, 2)).max()) / seconds**2)
