"""Programs of controllers are read back by readers of their own, and random motions through them."""

import re
import shutil
import subprocess
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st
from scipy.interpolate import PPoly

from optlaws import (
    BoundaryConditions,
    Chebyshev,
    Cycle,
    Dwell,
    InputError,
    MotionLaw,
    Pieces,
    PiecewiseMotion,
    Powers,
    Problem,
    Return,
    Rise,
    Solution,
    catalogue,
    law_from_z,
    smoothstep,
    synthesize,
)
from tests.exports.formats import readers
from tests.exports.samples import repeating
from tests.exports.structured_text import Block, parsed
from tests.internals.exports import FORMATS, export_motion
from tests.internals.motion import Motion, motion_of_law
from tests.sampling import examples

READ: dict[str, Callable[[str], PPoly]] = {
    "codesys-cambuilder": readers.cam_builder,
    "twincat-nc2": readers.motion_function,
    "twincat-mc3": readers.third_motion_function,
    "siemens-points": readers.basic_points,
    "siemens-elements": readers.advanced_elements,
    "siemens-polynomials": readers.polynomial_elements,
    "br-acp10": lambda text: readers.acp10(text)[0],
}
EXACT = {"codesys-cambuilder": 7, "twincat-nc2": 5, "siemens-points": 5, "siemens-polynomials": 6, "br-acp10": 6}


@cache
def solved(degree: int, order: int = 4) -> Solution:
    return synthesize(Problem(B=1.859, order=order, basis=Pieces(8, degree, 3)))


@cache
def law(name: str) -> MotionLaw:
    if name == "degree 17":
        return synthesize(Problem(B=1.859, order=4, basis=Chebyshev(9))).law
    return catalogue[name].law if name in catalogue else solved(int(name[-1])).law


def one_shot(name: str, **more: str) -> Motion:
    return motion_of_law(law(name), **{"stroke": "35 mm", "master": "120 deg", "duration": "0.1 s", **more})


def same(run: PiecewiseMotion, read: PPoly, tolerance: float = 1e-12) -> None:
    """The same values and derivatives inside every piece, to a share of their size."""
    assert len(read.x) == len(run.breaks)
    for low, high in zip(run.breaks, run.breaks[1:], strict=False):
        x = low + (high - low) * np.array([0.01, 0.3, 0.5, 0.77, 0.99])
        for nu in range(4):
            size = max(run.peak(nu).value, run.peak(0).value / (high - low) ** nu)
            assert np.abs(run(x, nu) - read(x, nu)).max() <= tolerance * size


@pytest.mark.sample(5)
@pytest.mark.parametrize("name", READ)
@pytest.mark.parametrize("of", ["degree 17", "pieces of 6", "modified trapezoid"])
def test_what_is_written_is_what_the_report_says(name: str, of: str) -> None:
    made = export_motion(one_shot(of), name, name="Press")
    same(made.run, READ[name](made.text), 1e-6 if name == "br-acp10" else 1e-11)
    assert made.report.ratio(2) == pytest.approx(1.0, abs=1.1e-3)
    assert made.report.deviation[0].value <= 1e-3 * 35.0
    exact = FORMATS[name].model and "exact" in made.written.notes[0]
    stated = re.search(r"within (\S+) mm", made.written.notes[0])
    if exact and name != "br-acp10":
        assert made.report.deviation[0].value <= 1e-12 * 35.0
    elif stated and name != "br-acp10":
        assert made.report.deviation[0].value <= float(stated[1]) * 1.01
    assert made.points <= {"siemens-points": 51, "br-acp10": 64}.get(name, 50)


@pytest.mark.sample(2)
@pytest.mark.parametrize(("name", "degree"), EXACT.items())
def test_a_law_optimised_in_the_pieces_of_the_target_is_exported_without_loss_and_with_its_proof(
    name: str, degree: int
) -> None:
    solution = solved(degree)
    made = solution.export(name, stroke="35 mm", duration="0.1 s", master="120 deg", name="Press")
    assert "exact" in made.written.notes[0]
    assert made.points == 8 + (made.written.counted == "points")
    loss = 1e-6 if name == "br-acp10" else 1e-12
    assert made.report.deviation[0].value <= loss * 35.0
    assert made.report.ratio(2) == pytest.approx(1.0, abs=1e-4 if name == "br-acp10" else 1e-11)
    proof = f"least C = {solution.objective:.9g}, lower bound {solution.lower_bound:.9g} in its space; status optimal"
    assert proof in made.text
    assert proof in str(made)


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", [*READ, "iec-st", "iec-st-real"])
def test_a_whole_cycle_with_dwells_goes_through_every_format(name: str) -> None:
    motion = repeating()
    made = export_motion(motion, name, name="Press")
    if name in READ:
        same(made.run, READ[name](made.text), 1e-5 if name == "br-acp10" else 1e-11)
    assert made.report.ratio(2) == pytest.approx(1.0, abs=2e-3)


@pytest.mark.parametrize("name", ["codesys-cambuilder", "twincat-nc2"])
def test_the_grammar_takes_every_program(name: str) -> None:
    made = export_motion(motion_of_law(smoothstep(3), stroke="35 mm", master="120 deg"), name, name="Press")
    [item] = parsed(made.text).items
    assert "Press" in repr(item)


def test_a_cycle_with_laws_that_were_looked_for_says_what_is_proven_of_them() -> None:
    cycle = Cycle([Rise("35 mm", "120 deg"), Dwell("90 deg"), Return("35 mm", "100 deg"), Dwell()], speed="200 rpm")
    for name in ("codesys-cambuilder", "codesys-xyva"):
        made = cycle.export(name)
        assert f"2 optimised laws, status optimal: least acceleration {cycle.objective:.9g}" in made.text
    assert [place for place in cycle.export("codesys-cambuilder").run.breaks if place in {120.0, 210.0, 310.0}] == [
        120,
        210,
        310,
    ]


def test_function_blocks_and_headers_run_what_their_report_says(tmp_path: Path) -> None:
    motion = one_shot("degree 17")
    exact = export_motion(motion, "iec-st", name="Press")
    assert exact.run.degree == 17
    assert "exact" in exact.written.notes[0]
    assert exact.report.deviation[0].value <= 1e-14 * 35.0
    block = Block(exact.text)
    single = Block(export_motion(motion, "iec-st-real", name="Press").text)
    places = np.linspace(0.0, 120.0, 57)
    values = np.array([[block(x)[q] for q in ("position", "velocity", "acceleration", "jerk")] for x in places])
    coarse = np.array([single(x)["acceleration"] for x in places], dtype=np.float64)
    for nu, column in enumerate(values.T):
        assert column == pytest.approx(motion(places, nu), rel=0, abs=1e-12 * motion.peak(nu))
    assert coarse == pytest.approx(motion(places, 2), rel=0, abs=1e-4 * motion.peak(2))
    header = export_motion(motion, "c99", name="press")
    assert header.run == exact.run
    if (compiler := shutil.which("gcc") or shutil.which("cc")) is None:
        pytest.skip("there is no C compiler")
    (tmp_path / "press.h").write_text(header.text, "utf-8")
    main = (
        '#include "press.h"\n#include <stdio.h>\nint main(void) { printf("%.17g", press_position(60.0)); return 0; }\n'
    )
    (tmp_path / "main.c").write_text(main, "utf-8")
    flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"]
    subprocess.run([compiler, *flags, "main.c", "-o", "main"], cwd=tmp_path, check=True)
    output = subprocess.run([str(tmp_path / "main")], capture_output=True, text=True, check=True).stdout
    assert float(output) == pytest.approx(17.5, abs=1e-13)


@pytest.mark.parametrize("back", ["3-4-5 polynomial", "modified sine"])
def test_jumps_of_the_law_stay_in_real_beside_a_long_rest(back: str) -> None:
    """The powers of a law of degree 19 are not multiplied by those of the rest's length, 225 deg."""
    segments = [Rise("35 mm", "45 deg", law=smoothstep(9)), Dwell("225 deg"), Return("35 mm", law=back)]
    export = Cycle(segments, speed="60 rpm").export("iec-st-real")
    run, law = export.report.run, export.report.law
    assert law.jumps[2].value > 0.0
    assert run.jumps[2].value == pytest.approx(law.jumps[2].value, rel=1e-3)
    assert run.jumps_at_ends[2] == pytest.approx(law.jumps_at_ends[2], rel=1e-3)
    assert [jump.value for jump in run.jumps[:2]] == [jump.value for jump in law.jumps[:2]] == [0.0, 0.0]
    stated = next(note for note in export.written.notes if "come from the rounding to REAL32" in note)
    bounds = [float(number) for number in re.findall(r"(\S+) mm/deg", stated)]
    assert len(bounds) == 3
    for nu, bound in enumerate(bounds, start=1):
        assert bound < 0.1 * export.run.peak(nu).value


def test_ends_are_those_of_the_motion_and_joints_close() -> None:
    motion = motion_of_law(smoothstep(3), stroke="35 mm", master="120 deg", duration="0.1 s")
    for name in ("twincat-nc2", "siemens-points", "siemens-elements", "siemens-polynomials"):
        assert " := 35.0, " in export_motion(motion, name).text
        cyclic = export_motion(repeating(), name)
        assert not cyclic.run.jumps(0).any() or np.abs(cyclic.run.jumps(0)).max() <= 1e-13
    jumps = export_motion(motion, "br-acp10").written.roundings
    assert jumps[1] <= 1e-3 * motion.peak(2)


def test_points_that_hold_one_value_refuse_jumps_and_pieces_do_not() -> None:
    motion = one_shot("constant acceleration")
    for name in ("twincat-nc2", "twincat-mc3", "siemens-points"):
        with pytest.raises(InputError, match=r"acceleration jumps at x = 60 deg, and a .* one value of it: take"):
            export_motion(motion, name)
    for name in ("codesys-cambuilder", "siemens-elements", "siemens-polynomials"):
        made = export_motion(motion, name)
        assert "exact" in made.written.notes[0]
        same(made.run, READ[name](made.text))


@pytest.mark.parametrize(
    ("name", "more", "message"),
    [
        ("siemens-elements", {"points": 60}, "points must be at most 50, which the target holds, got 60"),
        ("siemens-points", {"points": 60}, "points must be at most 51, which the target holds, got 60"),
        ("br-acp10", {"points": 65}, "points must be at most 64"),
        ("codesys-cambuilder", {"name": "2nd"}, "CODESYS takes no variable called '2nd'"),
        ("siemens-elements", {"name": "CONFIGURATION"}, "SIMATIC AX takes no variable called"),
        ("c99", {"name": "for"}, "C takes no name 'for'"),
        ("codesys-cambuilder", {"counts": 4096}, "codesys-cambuilder takes no counts"),
        ("codesys-cambuilder", {"points": 3}, None),
    ],
)
def test_limits_of_targets_are_named_with_the_remedy(name: str, more: dict[str, object], message: str | None) -> None:
    motion = one_shot("degree 17")
    if message is None:
        assert export_motion(motion, name, **more).points == 3  # type: ignore[arg-type]
        return
    with pytest.raises(InputError, match=re.escape(message)):
        export_motion(motion, name, **more)  # type: ignore[arg-type]


def test_the_drive_takes_whole_periods_from_zero() -> None:
    with pytest.raises(InputError, match=r"whole-number periods \(DINT\), and that of the master is 0\.1 s"):
        export_motion(motion_of_law(smoothstep(3), stroke="35 mm", duration="0.1 s"), "br-acp10")
    with pytest.raises(InputError, match=r"that of the slave is 12\.7 mm: choose another unit or stroke, or counts"):
        export_motion(one_shot("cycloidal", stroke="12.7 mm"), "br-acp10")
    made = export_motion(one_shot("cycloidal", stroke="12.7 mm", start="5 mm"), "br-acp10", counts=65536)
    read, master, slave = readers.acp10(made.text)
    assert (master, slave) == (120, 65536)
    assert made.run(60.0) == pytest.approx(5.0 + 6.35, abs=1e-5)
    assert read(60.0) == pytest.approx(32768, abs=0.05)
    with pytest.raises(InputError, match=r"in REAL32 the last polynomial ends .*\(5304, 37111"):
        export_motion(one_shot("cycloidal"), "br-acp10", counts=2**31 - 1)


def test_the_best_number_is_of_points_alone() -> None:
    motion = one_shot("degree 17")
    for name in READ:
        with pytest.raises(InputError, match=r"points: 'best' is of tables of points: leave points out for the fewest"):
            export_motion(motion, name, points="best")


def test_every_format_of_polynomials_is_listed_with_its_limits() -> None:
    for name in [*READ, "iec-st", "iec-st-real", "c99"]:
        assert FORMATS[name].limits
        assert FORMATS[name].name == name


# --- random motions ---


STROKES = ("35 mm", "-20 deg", "1200 mm", "7 deg")
MASTERS = ("120 deg", "360 deg", "90 mm")


def random_motion(number: int) -> Motion:
    """A law of order 3 with a random Z, in random units."""
    rng = np.random.default_rng(number)
    z = rng.normal(size=rng.integers(1, 8)).tolist()
    law = law_from_z(BoundaryConditions.rest(3), z, Powers(len(z) - 1))
    return motion_of_law(law, stroke=str(rng.choice(STROKES)), master=str(rng.choice(MASTERS)), duration="0.2 s")


def comes_back(number: int) -> None:
    motion = random_motion(number)
    for name, read in READ.items():
        made = export_motion(motion, name)
        same(made.run, read(made.text), 1e-5 if name == "br-acp10" else 1e-10)
        assert made.report.deviation[0].value <= 1e-2 * motion.stroke
        assert made.report.ratio(2) <= 1.0 + 2e-3


@seed(2026)
@settings(max_examples=3, deadline=None)
@given(st.integers(0, 10**6))
def test_random_motions_come_back(number: int) -> None:
    comes_back(number)


@pytest.mark.long
@seed(2027)
@examples(60)
@given(st.integers(0, 10**6))
def test_many_random_motions_come_back(number: int) -> None:
    comes_back(number)
