"""What a move takes on a controller: compiled functions of a front, beside ruckig's.

Times are those of the processor, the least of some runs over the same random moves. ruckig is C++ that Python calls:
the time of a call that only checks the input, or makes nothing, is taken off, which takes off a little too much.
"""

import subprocess
import tempfile
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from time import process_time

import numpy as np
from rich.console import Console
from rich.table import Table

from optlaws import Problem, proven_front
from tests.exports.moves import COMPILER

MOVES, REPEATS, RUNS = 4096, 200, 5

_PROGRAM = """\
#include <stdio.h>
#include <time.h>
#include "lift.h"
static double moves[{count}][4];
static lift_move lifts[{count}];
static double motions[{count}][4];
/* called as they stand, so that nothing of them is left out */
__attribute__((noinline)) static void plan_lift(int i)
{{
    lift_least_time(moves[i][0], moves[i][1], moves[i][2], moves[i][3], &lifts[i]);
}}
__attribute__((noinline)) static void move_lift(int i) {{ lift_motion(&lifts[i], moves[i][0], motions[i]); }}
int main(void)
{{
    void (*const timed[2])(int) = {{plan_lift, move_lift}};
    double sum = 0.0;
    int i, k, r;
    for (i = 0; i < {count}; ++i) {{
        double *move = moves[i];
        if (scanf("%la %la %la %la", &move[0], &move[1], &move[2], &move[3]) != 4) {{
            return 1;
        }}
    }}
    for (k = 0; k < 2; ++k) {{
        const clock_t began = clock();
        for (r = 0; r < {repeats}; ++r) {{
            for (i = 0; i < {count}; ++i) {{
                timed[k](i);
            }}
            sum += motions[r % {count}][r % 4];
        }}
        printf("%g ", 1e9 * (double)(clock() - began) / CLOCKS_PER_SEC / {repeats} / {count});
    }}
    printf("%g\\n", sum);
    return 0;
}}
"""


def drawn() -> list[list[float]]:
    """Stroke, velocity, acceleration and jerk of random moves."""
    rng = np.random.default_rng(27)
    moves: list[list[float]] = rng.uniform((0.2, 0.5, 2.0, 50.0), (1.2, 1.5, 6.0, 450.0), (MOVES, 4)).tolist()
    return moves


def compiled() -> list[float]:
    """Nanoseconds: a plan and a motion of the front."""
    given = "\n".join(" ".join(value.hex() for value in move) for move in drawn())
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        proven_front(Problem(order=4), ("at_most.B", "C"), gap=1e-4).export("c99", name="lift").write(place / "lift.h")
        (place / "main.c").write_text(_PROGRAM.format(count=MOVES, repeats=REPEATS), "utf-8")
        subprocess.run([str(COMPILER), "-std=c99", "-O2", "main.c", "-o", "main", "-lm"], cwd=place, check=True)
        command = [str(place / "main")]
        runs = [subprocess.run(command, input=given, capture_output=True, text=True, check=True) for _ in range(RUNS)]
    rows = [list(map(float, run.stdout.split()))[:2] for run in runs]
    return [min(column) for column in zip(*rows, strict=True)]


def of_ruckig() -> tuple[float, float] | None:
    """Nanoseconds of ruckig's plan and motion, less those of a call with little to do; None without ruckig."""
    if find_spec("ruckig") is None:
        return None
    ruckig = import_module("ruckig")
    planner, trajectory = ruckig.Ruckig(1), ruckig.Trajectory(1)
    limits = []
    for stroke, velocity, acceleration, jerk in drawn():
        move = ruckig.InputParameter(1)
        move.target_position, move.max_velocity = [stroke], [velocity]
        move.max_acceleration, move.max_jerk = [acceleration], [jerk]
        limits.append(move)

    def nanoseconds(call: Callable[[], object]) -> float:
        times = []
        for _ in range(RUNS):
            began = process_time()
            call()
            times.append(process_time() - began)
        return 1e9 * min(times) / MOVES

    plan = nanoseconds(lambda: [planner.calculate(move, trajectory) for move in limits])
    checks = nanoseconds(lambda: [planner.validate_input(move) for move in limits])
    motion = nanoseconds(lambda: [trajectory.at_time(0.37) for _ in limits])
    nothing = nanoseconds(lambda: [trajectory.duration for _ in limits])
    return plan - checks, motion - nothing


def main() -> None:
    """Measure and print."""
    if COMPILER is None:
        return
    plan, motion = compiled()
    theirs = of_ruckig()
    table = Table("", "plan", "motion", "ratio of plans", title="ns a call, one axis from rest to rest")
    ratio = "-" if theirs is None else f"{plan / theirs[0]:.2f}"
    table.add_row("front, 32 laws", f"{plan:.0f}", f"{motion:.0f}", ratio)
    if theirs is not None:
        table.add_row("ruckig, from Python", f"{theirs[0]:.0f}", f"{theirs[1]:.0f}", "1")
    Console(width=120).print(table)


if __name__ == "__main__":
    main()
