"""Random moves for functions at run time, and a C program that plans and evaluates them."""

import shutil
import subprocess
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from optlaws import Chebyshev, Pieces, Problem, ProvenFront, proven_front
from tests.internals.exports import FrontExport

COMPILER = shutil.which("gcc") or shutil.which("cc")
STRICT = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-Wconversion", "-Wdouble-promotion", "-O2"]
SANITISED = ["-g", "-fsanitize=undefined,address", "-fno-sanitize-recover=all"]
#: near the ends more: there the derivatives of a series, and what rounding adds to them, are greatest
_NEAR_ENDS = tuple(n / 1000 for n in range(1, 50, 4))
SHARES = (-0.25, 0.0, 1e-9, *_NEAR_ENDS, 0.113, 0.5, 0.77, *(1.0 - near for near in _NEAR_ENDS[::-1]), 1.0, 1.5)

PROBLEMS = {
    "lift": Problem(order=4),
    "pieces": Problem(order=3, basis=Pieces(4, degree=5, continuity=2)),
    "skew": Problem(order=3, symmetric=False, basis=Chebyshev(6)),
}


class Move(NamedTuple):
    """What is asked of a function: a time of 0 stands for the least."""

    stroke: float
    time: float
    velocity: float
    acceleration: float
    jerk: float


@cache
def front(name: str) -> ProvenFront:
    return proven_front(PROBLEMS[name], ("at_most.B", "C"), gap=2e-4)


@cache
def exported(name: str, to: str = "c99") -> FrontExport:
    export = front(name).export(to, gap=1e-3, name=name if to == "c99" else f"FB_{name}")
    assert isinstance(export, FrontExport)
    return export


def drawn(export: FrontExport, count: int, seed: int) -> list[Move]:
    """Moves around the whole front and a little beyond, in units that differ by twelve powers of ten."""
    rng = np.random.default_rng(seed)
    table = export.table
    b = rng.uniform(0.98 * table.velocities[0], 1.04 * table.velocities[-1], count)
    c = np.interp(b, table.velocities, table.accelerations) * 10.0 ** rng.uniform(-0.03, 0.03, count)
    j = np.interp(b, table.velocities, table.jerks) * 10.0 ** rng.uniform(-0.2, 1.0, count)
    h = rng.choice([-1.0, 1.0], count) * 10.0 ** rng.uniform(-6.0, 6.0, count)
    t = 10.0 ** rng.uniform(-6.0, 6.0, count)
    size = np.abs(h)
    given = np.where(rng.random(count) < 0.4, t, 0.0)
    rows = zip(h, given, b * size / t, c * size / t**2, j * size / t**3, strict=True)
    return [Move(*map(float, row)) for row in rows]


_PROGRAM = """\
#include <stdio.h>
#include "{name}.h"
int main(void)
{{
    static const double shares[] = {{{shares}}};
    double stroke, time, velocity, acceleration, jerk;
    while (scanf("%la %la %la %la %la", &stroke, &time, &velocity, &acceleration, &jerk) == 5) {{
        {name}_move move;
        double y[4];
        size_t i;
        const int status = time != 0.0 ? {name}_in_time(stroke, time, velocity, &move)
                                       : {name}_least_time(stroke, velocity, acceleration, jerk, &move);
        printf("%a %a %a %a %a %a %a %a", (double)status, (double)move.law, move.share, move.stroke, move.duration,
               move.velocity, move.acceleration, move.jerk);
        for (i = 0; i < sizeof shares / sizeof shares[0]; ++i) {{
            {name}_motion(&move, shares[i] * move.duration, y);
            printf(" %a %a %a %a", y[0], y[1], y[2], y[3]);
        }}
        printf("\\n");
    }}
    return 0;
}}
"""


class Answer(NamedTuple):
    """What the compiled functions answer: eight numbers of the plan, and four of the motion at each share."""

    plan: list[float]
    motion: np.ndarray[Any, Any]


def program(folder: Path, name: str, header: str, compiler: str | None = COMPILER) -> Path:
    """The compiled program of a header."""
    shares = ", ".join(float(share).hex() for share in SHARES)
    (folder / f"{name}.h").write_text(header, "utf-8")
    (folder / f"{name}.c").write_text(_PROGRAM.format(name=name, shares=shares), "utf-8")
    command = [str(compiler), *STRICT, *SANITISED, f"{name}.c", "-o", name, "-lm"]
    subprocess.run(command, cwd=folder, check=True)
    return folder / name


def answers(compiled: Path, moves: list[Move]) -> list[Answer]:
    text = "\n".join(" ".join(value.hex() for value in move) for move in moves)
    run = subprocess.run([str(compiled)], input=text, capture_output=True, text=True, check=True)
    numbers = [list(map(float.fromhex, line.split())) for line in run.stdout.splitlines()]
    assert len(numbers) == len(moves)
    return [Answer(row[:8], np.array(row[8:]).reshape(-1, 4)) for row in numbers]
