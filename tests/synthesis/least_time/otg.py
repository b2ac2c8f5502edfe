"""The fastest motion of one axis as ruckig has it: its time, and the times between its segments as shares of it."""

import numpy as np
import ruckig

from tests.internals.synthesis import TimedMove

_SHORTEST = 1e-9


def fastest_motion(move: TimedMove) -> tuple[float, tuple[float, ...]]:
    """Its time and its breaks."""
    limits, given = move.limits, ruckig.InputParameter(1)
    given.current_position, given.target_position = [0.0], [move.stroke]
    given.current_velocity, given.target_velocity = [move.start_velocity], [move.end_velocity]
    given.current_acceleration, given.target_acceleration = [0.0], [move.end_acceleration]
    given.max_velocity, given.max_jerk = [limits.velocity], [limits.jerk]
    given.max_acceleration, given.min_acceleration = [limits.acceleration], [-float(limits.deceleration or 0.0)]
    motion = ruckig.Trajectory(1)
    assert ruckig.Ruckig(1).calculate(given, motion) in {ruckig.Result.Working, ruckig.Result.Finished}
    ends = np.cumsum(list(motion.profiles[0][0].t)) / motion.duration
    breaks = [0.0]
    for end in ends.tolist():
        if breaks[-1] + _SHORTEST < end < 1.0 - _SHORTEST:
            breaks.append(end)
    return float(motion.duration), (*breaks, 1.0)
