"""The table of formats on the page about exports, computed: `python -m tests.exports.table_of_formats` prints it."""

from math import isfinite

import numpy as np

from tests.exports.samples import one_shot
from tests.exports.test_tables import TABLES, curve
from tests.internals.exports import export_motion

BY = {
    "codesys-xyva": "own parser, BPoly",
    "ros2": "PyYAML, BPoly",
    "rockwell-cam-profile": "struct, PPoly",
    "isg": "own parser, PPoly",
    "technosoft": "own parser, PPoly",
    "csv": "csv, CubicSpline",
    "sew": "own parser, CubicHermiteSpline",
}


def row(name: str) -> list[str]:
    """The cells of a format."""
    made = export_motion(one_shot(), name)
    x, read = curve(made)
    places = np.linspace(x[0], x[-1], 3001)
    apart = float(np.abs(read(places, 0) - made.run(places)).max()) / made.motion.stroke
    ratio = made.report.ratio(2)
    return [
        f"`{name}`",
        str(made.points),
        f"{ratio:.5f}" if isfinite(ratio) else "straight lines",
        f"{made.report.run.jumps_at_ends[1] / made.report.law.peak(2):.1g}" if isfinite(ratio) else "",
        f"{made.report.deviation[0].value:.1e}",
        BY.get(name, "own parser, CubicSpline"),
        f"{max(apart, 1e-16):.0e}",
    ]


def rows() -> list[list[str]]:
    """All rows of tables."""
    return [row(name) for name in TABLES]


if __name__ == "__main__":
    for cells in rows():
        print("| " + " | ".join(cells) + " |")  # noqa: T201
