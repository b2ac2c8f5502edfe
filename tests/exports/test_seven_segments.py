"""Jerk-limited moves in closed form: compiled and run, against closed forms, 60 digits, and ruckig."""

import subprocess
from collections.abc import Sequence
from pathlib import Path

import mpmath  # type: ignore[import-untyped] # ships no types
import numpy as np
import pytest

from optlaws import InputError
from tests.exports.moves import COMPILER, SANITISED, STRICT
from tests.exports.structured_text import Block, parsed
from tests.internals.exports import jerk_limited_move, segment_times

needs_compiler = pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")
SHARES = (-0.5, 0.0, 0.03, 0.2, 0.37, 0.5, 0.6, 0.81, 0.99, 1.0, 2.0)
BOUND = 2.0**-45

_PROGRAM = """\
#include <stdio.h>
#include "axis.h"
int main(void)
{{
    static const double shares[] = {{{shares}}};
    double stroke, velocity, acceleration, jerk;
    while (scanf("%la %la %la %la", &stroke, &velocity, &acceleration, &jerk) == 4) {{
        axis_move move;
        double y[4];
        size_t i;
        printf("%a", (double)axis_least_time(stroke, velocity, acceleration, jerk, &move));
        printf(" %a %a %a %a", move.jerk_time, move.acceleration_time, move.cruise_time, move.duration);
        for (i = 0; i < sizeof shares / sizeof shares[0]; ++i) {{
            axis_motion(&move, shares[i] * move.duration, y);
            printf(" %a %a %a %a", y[0], y[1], y[2], y[3]);
        }}
        printf("\\n");
    }}
    return 0;
}}
"""


def drawn(count: int, seed: int) -> list[tuple[float, ...]]:
    """Stroke and limits that meet all branches, in units that differ by eight powers of ten."""
    rng = np.random.default_rng(seed)
    v, t = 10.0 ** rng.uniform(-4.0, 4.0, (2, count))
    h = v * t * 10.0 ** rng.uniform(-2.0, 2.0, count) * rng.choice([-1.0, 1.0], count)
    a, j = v / t * 10.0 ** rng.uniform(-0.7, 0.7, count), v / t**2 * 10.0 ** rng.uniform(-1.0, 1.0, count)
    return [tuple(map(float, row)) for row in zip(h, v, a, j, strict=True)]


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return program_of_segments(tmp_path_factory.mktemp("segments"))


def program_of_segments(folder: Path, compiler: str | None = COMPILER) -> Path:
    jerk_limited_move("c99", name="axis").write(folder / "axis.h")
    (folder / "main.c").write_text(_PROGRAM.format(shares=", ".join(map(str, SHARES))), "utf-8")
    command = [str(compiler), *STRICT, *SANITISED, "main.c", "-o", "main", "-lm"]
    subprocess.run(command, cwd=folder, check=True)
    return folder / "main"


def run(compiled: Path, moves: Sequence[tuple[float, ...]]) -> list[tuple[list[float], np.ndarray]]:
    text = "\n".join(" ".join(float(value).hex() for value in move) for move in moves)
    out = subprocess.run([str(compiled)], input=text, capture_output=True, text=True, check=True).stdout
    rows = [list(map(float.fromhex, line.split())) for line in out.splitlines()]
    assert len(rows) == len(moves)
    return [(row[:5], np.array(row[5:]).reshape(-1, 4)) for row in rows]


def in_many_digits(move: tuple[float, ...], at: float) -> tuple[float, list[float]]:
    """Duration and motion at a share of it, by integrating seven constant jerks in 60 digits."""
    with mpmath.workdps(60):
        h, v, a, j = (mpmath.mpf(abs(value)) for value in move)
        v, a, j = (value * (1 - mpmath.mpf(2) ** -48) for value in (v, a, j))
        # the greatest velocity that the stroke allows, from the equation of the ramp
        by_cubic, by_quadratic = (h * h * j / 4) ** (mpmath.mpf(1) / 3), None
        peak = by_cubic
        if by_cubic > a * a / j:
            by_quadratic = (mpmath.sqrt((a / j) ** 2 + 4 * h / a) - a / j) * a / 2
            peak = by_quadratic
        w = min(v, peak)
        tj = min(a / j, mpmath.sqrt(w / j))
        ta = w / (j * tj) - tj
        tc = h / w - 2 * tj - ta
        total = 4 * tj + 2 * ta + tc
        left, state = mpmath.mpf(at) * total, [mpmath.mpf(0)] * 3
        for time, jerk in ((tj, j), (ta, 0), (tj, -j), (tc, 0), (tj, -j), (ta, 0), (tj, j)):
            s = min(left, time)
            y, b, c = state
            state = [y + b * s + c * s**2 / 2 + jerk * s**3 / 6, b + c * s + jerk * s**2 / 2, c + jerk * s]
            left -= s
        sign = 1 if move[0] > 0 else -1
        return float(total), [float(sign * value) for value in state]


@needs_compiler
def test_known_times(compiled: Path) -> None:
    moves = [(1.0, 1.0, 1.0, 1.0), (2.0, 1.0, 1.0, 1.0), (10.0, 5.0, 10.0, 30.0), (-10.0, 5.0, 10.0, 30.0)]
    times = [plan[4] for plan, _ in run(compiled, moves)]
    assert times == pytest.approx([32.0 ** (1.0 / 3.0), 4.0, 17.0 / 6.0, 17.0 / 6.0], rel=1e-13)


@needs_compiler
def test_limits_are_kept_and_values_are_within_their_bound_of_many_digits(compiled: Path) -> None:
    moves = drawn(60, 41)
    branches, worst = set(), 0.0
    for move, (plan, motion) in zip(moves, run(compiled, moves), strict=True):
        h, v, a, j = map(abs, move)
        status, _, ta, tc, total = plan
        assert status == 0
        branches.add((ta > 0.0, tc > 0.0))
        assert (np.abs(motion).max(axis=0)[1:] <= (v, a, j)).all()
        assert motion[0].tolist() == [0.0] * 4
        assert motion[-1].tolist() == [move[0], 0.0, 0.0, 0.0]
        units = (h, v + a * total, a + j * total)
        for at, row in list(zip(SHARES, motion, strict=True))[1:-1]:
            time, exact = in_many_digits(move, at)
            assert abs(total - time) <= BOUND * time
            errors = [abs(x - y) / unit for x, y, unit in zip(row, exact, units, strict=False)]
            assert max(errors) <= BOUND
            worst = max(worst, *errors)
    assert branches == {(False, False), (True, False), (False, True), (True, True)}
    assert worst > 1e-3 * BOUND, "the bound would hold whatever the code did"


@needs_compiler
def test_nothing_that_ruckig_finds_is_faster(compiled: Path) -> None:
    ruckig = pytest.importorskip("ruckig")
    moves = drawn(300, 42)
    for (h, v, a, j), (plan, _) in zip(moves, run(compiled, moves), strict=True):
        # ruckig has absolute tolerances: in units of the move all its numbers are near 1
        t = plan[4]
        limits = ruckig.InputParameter(1)
        limits.target_position = [1.0]
        limits.max_velocity, limits.max_acceleration, limits.max_jerk = (
            [limit * t**nu / abs(h)] for nu, limit in enumerate((v, a, j), start=1)
        )
        trajectory = ruckig.Trajectory(1)
        ruckig.Ruckig(1).calculate(limits, trajectory)
        assert trajectory.duration == pytest.approx(1.0, abs=1e-9)


def test_the_function_block_moves_as_the_polynomials_do() -> None:
    block = Block(jerk_limited_move("iec-st", name="FB_Axis").text)
    for h, v, a, j in drawn(30, 43):
        move = segment_times(h, v, a, j)
        motion = move.motion()
        limits = {"velocityLimit": v, "accelerationLimit": a, "jerkLimit": j}
        assert block(plan=True, stroke=h, elapsed=0.0, **limits)["moveTime"] == pytest.approx(move.duration, rel=1e-14)
        assert motion(motion.stop) == pytest.approx(h, rel=1e-13)
        assert max(np.abs(motion.jumps(2)).max(), *(abs(motion.ends(2)[1][-1:]))) <= 1e-12 * (a + j * move.duration)
        for at in (0.01, 0.13, 0.4, 0.55, 0.8, 0.97):
            values = block(plan=False, stroke=0.0, elapsed=at * move.duration)
            x = min(at * move.duration, motion.stop)
            units = (abs(h), v + a * move.duration, a + j * move.duration)
            for nu, (name, unit) in enumerate(zip(("position", "velocity", "acceleration"), units, strict=True)):
                assert abs(values[name] - motion(x, nu)) <= 4.0 * BOUND * unit
        assert block(elapsed=1.5 * move.duration)["position"] == h


@needs_compiler
@pytest.mark.long
def test_ten_thousand_keep_their_limits(compiled: Path) -> None:
    moves = drawn(10_000, 44)
    for (_, *limits), (_, motion) in zip(moves, run(compiled, moves), strict=True):
        assert (np.abs(motion).max(axis=0)[1:] <= limits).all()


@pytest.mark.long
def test_the_grammar_of_the_standard_takes_it() -> None:
    [item] = parsed(jerk_limited_move("iec-st", name="FB_Axis").text).items
    assert item.name == "FB_Axis"


@needs_compiler
def test_what_is_no_limit_is_refused(compiled: Path) -> None:
    wrong = (float("nan"), float("inf"), -1.0, 0.0, 1e31, 1e-31)
    moves = [tuple(value if i == place else 1.0 for i in range(4)) for value in wrong for place in range(4)]
    moves = [move for move in moves if move[0] not in {0.0, -1.0}]
    for plan, motion in run(compiled, moves):
        assert plan[0] == 4
        assert not motion.any()
    [(plan, motion)] = run(compiled, [(0.0, 1.0, 1.0, 1.0)])
    assert plan == [0.0] * 5
    assert not motion.any()
    block = Block(jerk_limited_move("iec-st", name="FB_Axis").text)
    limits = {"velocityLimit": 1.0, "accelerationLimit": 0.0, "jerkLimit": 1.0}
    assert block(plan=True, stroke=1.0, elapsed=0.1, **limits)["status"] == 4
    assert block.values["position"] == 0.0


def test_in_python_they_are_refused_by_name() -> None:
    with pytest.raises(InputError, match="acceleration must be"):
        segment_times(1.0, 1.0, 0.0, 1.0)
    with pytest.raises(InputError, match="stroke must be"):
        segment_times(0.0, 1.0, 1.0, 1.0)
    with pytest.raises(InputError, match="csv holds one motion and no functions"):
        jerk_limited_move("csv")
