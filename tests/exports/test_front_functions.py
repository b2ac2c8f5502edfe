"""Fronts at run time: compiled and run, against the laws in Python, exact arithmetic, proofs and `synthesize`."""

import re
from dataclasses import replace
from fractions import Fraction
from functools import cache
from math import perm
from pathlib import Path

import numpy as np
import pytest

from optlaws import InputError, MotionLaw, PolynomialLaw, Problem, at_most, proven_front, sweep
from tests.exports.moves import COMPILER, PROBLEMS, SHARES, Answer, Move, answers, drawn, exported, front, program
from tests.exports.structured_text import Block, parsed
from tests.internals.exports import FrontExport, MoveStatus, RunTimeMove, summation_bounds
from tests.internals.synthesis import MoveLimits, TimedMove, least_time

needs_compiler = pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")
ORDERS = (1, 2, 3)


def in_python(export: FrontExport, move: Move) -> RunTimeMove:
    if move.time:
        return export.in_time(stroke=move.stroke, duration=move.time, velocity=move.velocity)
    limits = {"velocity": move.velocity, "acceleration": move.acceleration, "jerk": move.jerk}
    return export.least_time(stroke=move.stroke, **limits)


@cache
def compiled(name: str, folder: Path) -> Path:
    return program(folder, name, exported(name).text)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("compiled")


def limits_broken(move: Move, answer: Answer, planned: RunTimeMove, law: MotionLaw) -> list[str]:
    """Limits that the compiled motion, its bounds or the law itself exceed, rounding included."""
    given = [move.velocity, *([] if move.time else [move.acceleration, move.jerk])]
    constants = [law.constants.B.value, law.constants.C.value, law.constants.J.value]
    broken = []
    for nu, limit in enumerate(given, start=1):
        of_law = constants[nu - 1] * abs(move.stroke) / planned.duration**nu
        seen = max(np.abs(answer.motion[:, nu]).max(), answer.plan[4 + nu] * (1.0 - 1e-12), of_law)
        if seen > limit:
            broken.append(f"order {nu}: {seen!r} above {limit!r} of {move}")
    return broken


def checked(name: str, folder: Path, count: int, seed: int) -> set[int]:
    """Compare plans and motions with Python's, see limits kept and proofs hold, and return the statuses met."""
    export = exported(name)
    moves = drawn(export, count, seed)
    found = answers(compiled(name, folder), moves)
    of_b = {}
    for move, answer in zip(moves, found, strict=True):
        planned = in_python(export, move)
        assert answer.plan[:2] == [planned.status, planned.law]
        assert answer.plan[2] == pytest.approx(planned.share, abs=1e-11)
        plain = [planned.stroke, planned.duration, planned.velocity, planned.acceleration, planned.jerk]
        assert answer.plan[3:] == pytest.approx(plain, rel=1e-12)
        if not planned.status.moves:
            assert not answer.motion.any()
            continue
        law = export.law(planned)
        assert limits_broken(move, answer, planned, law) == []
        assert_near(export, planned, answer)
        if planned.status is MoveStatus.PROVEN:
            of_b[move.velocity * planned.duration / abs(move.stroke)] = law.constants.C.value
    assert_optimal(export, name, of_b)
    return {int(answer.plan[0]) for answer in found}


def assert_near(export: FrontExport, planned: RunTimeMove, answer: Answer) -> None:
    """The motion as evaluated in Python, at rest outside."""
    reference = export.motion(planned, planned.duration * np.array(SHARES))
    for nu in range(4):
        unit = abs(planned.stroke) / planned.duration**nu
        assert np.abs(answer.motion[:, nu] - reference[nu]).max() <= 2.0 * export.table.errors[nu] * unit
    assert answer.motion[0].tolist() == [0.0] * 4
    assert answer.motion[-1].tolist() == [planned.stroke, 0.0, 0.0, 0.0]


def assert_optimal(export: FrontExport, name: str, of_b: dict[float, float]) -> None:
    """C of proven moves by B: within the gap of what certificates prove and, of smooth laws, of `synthesize`."""
    low, high = front(name).between
    inside = {b: c for b, c in of_b.items() if low < b < high}
    for b, c in inside.items():
        assert c * (1.0 - export.gap) <= front(name).lower(b) * (1.0 + 1e-9)
    problems = [replace(PROBLEMS[name], B=at_most(b)) for b in inside if name == "lift"]
    for solution, c in zip(sweep(problems), inside.values(), strict=False):
        assert solution.lower_bound <= c * (1.0 + 1e-9)
        assert (c - solution.objective) / c <= export.gap + 1e-8


@pytest.mark.long
@needs_compiler
def test_compiled_functions_keep_limits_and_are_within_the_gap_of_synthesize(folder: Path) -> None:
    assert checked("lift", folder, 300, 27) == {0, 2, 3}


@pytest.mark.sample(2)
@needs_compiler
@pytest.mark.parametrize("name", ["pieces", "skew"])
def test_so_do_laws_of_pieces_and_laws_without_symmetry(name: str, folder: Path) -> None:
    assert checked(name, folder, 40, 28) >= {0, 2}


@needs_compiler
@pytest.mark.long
@pytest.mark.parametrize("name", ["lift", "pieces", "skew"])
def test_ten_thousand_do(name: str, folder: Path) -> None:
    assert checked(name, folder, 10_000, 29) >= {0, 2, 3}


def test_no_law_is_faster_by_more_than_half_the_gap() -> None:
    """At less than T sqrt(1 - gap) the acceleration that the certificates ask for at that B is above its limit."""
    export, proven = exported("lift"), front("lift")
    proofs = 0
    for move in drawn(export, 200, 30):
        planned = in_python(export, move)
        if move.time or planned.status is not MoveStatus.PROVEN:
            continue
        time = planned.duration * (1.0 - export.gap) ** 0.5 * (1.0 - 1e-9)
        b = move.velocity * time / abs(move.stroke)
        if proven.between[0] <= b <= proven.between[1]:
            proofs += 1
            assert proven.lower(b) * abs(move.stroke) / time**2 > move.acceleration
    assert proofs > 50


@pytest.mark.parametrize("name", ["lift", "skew"])
def test_no_law_within_the_limits_is_faster_by_more_than_half_the_gap(name: str) -> None:
    """Held against the least time of a move, which knows nothing of fronts."""
    export, seen = exported(name), 0
    for move in drawn(export, 60, 33):
        planned = in_python(export, move)
        if move.time or planned.status is not MoveStatus.PROVEN or seen == 8:
            continue
        # in units of the stroke, where the velocity is 1 a second
        limits = MoveLimits(1.0, *2 * (move.acceleration * abs(move.stroke) / move.velocity**2,))
        least = least_time(TimedMove(PROBLEMS[name], 1.0, limits))
        quickest = least.none_below * abs(move.stroke) / move.velocity
        assert quickest <= planned.duration <= quickest * (1.0 + 0.51 * export.gap + 2e-6)
        seen += 1
    assert seen == 8


def test_where_the_jerk_decides_no_mean_of_the_laws_is_faster() -> None:
    export = exported("lift")
    table = export.table
    share = np.linspace(0.0, 1.0, 200, endpoint=False)
    places = (np.arange(len(table) - 1)[:, None] + share).ravel()
    peaks = [np.interp(places, range(len(table)), p) for p in (table.velocities, table.accelerations, table.jerks)]
    seen = 0
    for move in drawn(export, 150, 31):
        planned = in_python(export, move)
        if move.time or not planned.status.moves:
            continue
        limits = (move.velocity, move.acceleration, move.jerk)
        times = [
            (p * abs(move.stroke) / limit) ** (1.0 / nu) for nu, p, limit in zip(ORDERS, peaks, limits, strict=True)
        ]
        assert planned.duration <= np.max(times, axis=0).min() * (1.0 + 2.0 * table.slack)
        seen += planned.status is MoveStatus.JERK
    assert seen > 10


@needs_compiler
def test_rounding_is_within_its_bound(folder: Path) -> None:
    """Compiled values beside the mean of the certified laws in rational arithmetic, at the very time in it.

    That it holds is a theorem, whose proof is that of `summation_bounds`. That it is not idle does not depend on how
    near to it rounding happens to come: exact sums of coefficients in single precision break it, in each derivative.
    """
    export = exported("lift")
    moves = drawn(export, 16, 32)
    coarse_by_more = np.zeros(4, dtype=np.bool_)
    for answer in answers(compiled("lift", folder), moves):
        status, place, share, stroke, duration = answer.plan[:5]
        if status > MoveStatus.JERK:
            continue
        laws = [export.laws[int(place) + i] for i in (0, 1)]
        rows = [law.exact_powers() for law in laws if isinstance(law, PolynomialLaw)]
        w = Fraction(share)
        mean = [(1 - w) * p + w * q for p, q in zip(*rows, strict=True)]
        coarse = [Fraction(float(np.float32(float(c)))) for c in mean]
        for at, values in list(zip(SHARES, answer.motion, strict=True))[1:-1]:
            k = Fraction(at * duration) / Fraction(duration)
            for nu in range(4):
                exact = _derivative(mean, nu, k)
                unit = Fraction(stroke) / Fraction(duration) ** nu
                error = abs(Fraction(float(values[nu])) / unit - exact)
                assert error <= Fraction(export.table.errors[nu])
                coarse_by_more[nu] |= abs(_derivative(coarse, nu, k) - exact) > Fraction(export.table.errors[nu])
    assert coarse_by_more.all(), "the bound would hold in single precision too"


def _derivative(powers: list[Fraction], nu: int, k: Fraction) -> Fraction:
    return sum((c * perm(n, nu) * k ** (n - nu) for n, c in enumerate(powers) if n >= nu), Fraction(0))


def test_the_bound_of_a_sum_holds_for_single_terms_and_grows_with_them() -> None:
    errors = np.array([summation_bounds(np.eye(12)[n], 2.0)[0] for n in range(12)])
    assert (np.diff(errors[4:, 1:], axis=0) > 0.0).all()
    assert (errors[1:, 0] >= 2.0**-53).all()


@pytest.mark.parametrize("name", ["lift", "pieces", "skew"])
def test_the_function_block_plans_as_python_does(name: str) -> None:
    export = exported(name, "iec-st")
    block = Block(export.text)
    for move in drawn(export, 40, 33):
        inputs = {"stroke": move.stroke, "givenTime": move.time, "velocityLimit": move.velocity}
        limits = {"accelerationLimit": move.acceleration, "jerkLimit": move.jerk}
        planned = in_python(export, move)
        values = block(plan=True, leastTime=not move.time, elapsed=0.0, **inputs, **limits)
        assert values["status"] == planned.status
        peaks = [values[f"peak{name}"] for name in ("Velocity", "Acceleration", "Jerk")]
        assert [values["moveTime"], *peaks] == pytest.approx(
            [planned.duration, planned.velocity, planned.acceleration, planned.jerk], rel=1e-12
        )
        # that time, for a unit in its last place decides what is beyond the end
        took = values["moveTime"]
        for at in SHARES:
            # other inputs mean nothing until the next plan
            seen = block(plan=False, stroke=-1.0, velocityLimit=0.0, elapsed=at * took)
            reference = export.motion(replace(planned, duration=took), at * took)
            for nu, output in enumerate(("position", "velocity", "acceleration", "jerk")):
                unit = abs(planned.stroke) / planned.duration**nu if planned.duration else 0.0
                assert abs(seen[output] - reference[nu]) <= 2.0 * export.table.errors[nu] * unit


@pytest.mark.long
@pytest.mark.parametrize("name", ["lift", "pieces"])
def test_the_grammar_of_the_standard_takes_the_function_block(name: str) -> None:
    # its parser takes a minute for a few thousand numbers
    [item] = parsed(re.sub(r"\[\s+([^,\]]+),[^\]]*\]", r"[\1]", exported(name, "iec-st").text)).items
    assert item.name == f"FB_{name}"
    kinds = [type(declaration).__name__ for declaration in item.declarations]
    assert kinds == ["InputDeclarations", "OutputDeclarations", "VariableDeclarations", "VariableDeclarations"]


@needs_compiler
def test_what_is_no_number_is_refused_and_no_stroke_takes_no_time(folder: Path) -> None:
    nan, inf = float("nan"), float("inf")
    wrong = [nan, inf, -1.0, 0.0, 1e31, 1e-31]
    moves = [Move(value, 0.0, 1.0, 1.0, 1.0) for value in wrong if value not in {0.0, -1.0}]
    moves += [Move(1.0, time, v, 1.0, 1.0) for value in wrong for time, v in ((0.0, value), (1.0, value))]
    moves += [Move(1.0, 0.0, 1.0, value, 1.0) for value in wrong] + [Move(1.0, 0.0, 1.0, 1.0, value) for value in wrong]
    moves += [Move(1.0, value, 1.0, 1.0, 1.0) for value in wrong if value]
    found = answers(compiled("lift", folder), moves)
    assert {answer.plan[0] for answer in found} == {MoveStatus.REFUSED}
    assert not any(answer.motion.any() for answer in found)
    great = [Move(1e30, 0.0, 1e30, 1e30, 1e30), Move(1e-30, 0.0, 1e-30, 1e-30, 1e30), Move(1e30, 1e30, 1e30, 1.0, 1.0)]
    for answer in answers(compiled("lift", folder), great):
        assert answer.plan[0] <= MoveStatus.JERK
        assert np.isfinite([*answer.plan, *answer.motion.ravel()]).all()
    still = answers(compiled("lift", folder), [Move(0.0, 0.0, 1.0, 1.0, 1.0), Move(0.0, 2.0, 1.0, 1.0, 1.0)])
    assert [answer.plan[0] for answer in still] == [MoveStatus.PROVEN] * 2
    assert [answer.plan[4] for answer in still] == [0.0, 2.0]
    assert not any(answer.motion.any() for answer in still)


def test_a_front_whose_ends_are_cut_says_so() -> None:
    cut = proven_front(Problem(order=4), ("at_most.B", "C"), between=(1.5, 1.7), gap=1e-3).export("c99", name="cut")
    limits = {"stroke": 1.0, "velocity": 1.0, "jerk": 1e6}
    assert cut.least_time(acceleration=0.1, **limits).status is MoveStatus.AT_END
    assert cut.least_time(acceleration=100.0, **limits).status is MoveStatus.AT_END
    assert exported("lift").least_time(acceleration=0.1, **limits).status is MoveStatus.PROVEN
    assert "AT_END: beyond the last law" in cut.text


def test_the_export_says_what_it_is(tmp_path: Path) -> None:
    export = exported("lift")
    assert export.size < 4000
    results = export.results()
    assert results["gap"] <= 1e-3
    assert results["proven_ends"] == [True, True]
    assert export.write(tmp_path / "lift.h").read_text("utf-8").startswith("/* lift: laws of a proven front")
    assert any(row.name == "gap of C, proven" and row.value == export.gap for row in export.summary())
    assert "32 certified laws" in str(export) or f"{export.points} certified laws" in str(export)


def test_what_cannot_be_exported_is_named() -> None:
    proven = front("lift")
    with pytest.raises(InputError, match="csv holds one motion and no functions; a front is exported to c99 or iec-st"):
        proven.export("csv")
    with pytest.raises(InputError, match=r"the front is proven to .*, not to 1e-06: make it with proven_front"):
        proven.export("c99", gap=1e-6)
    with pytest.raises(InputError, match=r"0.001 needs \d+ laws, but points allows 12, whose gap is 0.0\d+"):
        proven.export("c99", points=12)
    with pytest.raises(InputError, match=r"a front at run time exchanges at_most\.B and C, got rms_c and C"):
        proven_front(Problem(order=4), ("rms_c", "C"), between=(4.1, 4.3), gap=1e-2).export("c99")
    with pytest.raises(InputError, match="C takes no name"):
        proven.export("c99", name="2nd lift")
    with pytest.raises(InputError, match="there is no law of a move of status TOO_SHORT"):
        exported("lift").law(exported("lift").in_time(stroke=1.0, duration=1.0, velocity=1.0))
