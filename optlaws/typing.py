"""Types in annotations of public names: return values, arguments, and strings of choice."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(
    __name__,
    __file__,
    removed={
        "MachineCycle": "take MachineMotion, which Machine.cycle returns",
        "MachineResponse": "take MachineMotion, which Machine.response returns",
        "MachineAnswer": "machine_follower has gone: Response.in_units answers in a dict",
        "BestBreaks": "best_breaks has gone: what export(...) returns says its pieces",
        "SegmentExport": "jerk_limited_move has gone: a FrontExport is of smooth moves",
        "SegmentTimes": "jerk_limited_move has gone: a FrontExport is of smooth moves",
    },
)
