"""Outputs of machines in balls, against matrix exponentials: motions, amplitudes of modes, and optima."""

import json
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import mpmath  # type: ignore[import-untyped] # ships no types
import numpy as np
import pytest
from flint import arb, ctx

from optlaws import (
    C,
    Chebyshev,
    Cycle,
    InputError,
    Link,
    Machine,
    Pieces,
    PiecewiseLaw,
    Problem,
    Return,
    Rise,
    Solution,
    at_most,
    smoothstep,
    synthesize,
)
from optlaws.verification import exact_bound, verify, verify_all
from tests.documents import ROOT
from tests.internals.laws import PolynomialSegment
from tests.internals.verification import (
    ExactLaw,
    ExactModeResidual,
    Transfer,
    ball,
    cycle,
    enclosed,
    followed,
    lower,
    of_pieces,
    response,
    upper,
)
from tests.mechanisms.machine.random_machines import random_case
from tests.sampling import sampled
from tests.verification.tampering import changed

ORDER = 3
MACHINES = {
    # equal vibrations, one driving the next
    "defective": Machine(
        [[0, 1, 1, 0], [-400, -2, 0, 1], [0, 0, 0, 1], [0, 0, -400, -2]],
        [[0], [0], [0], [400]],
        [[1, 0, 0, 0]],
        [[0.5]],
    ),
    "critical": Machine([[0, 1], [-64, -16]], [[0], [64]], [[-64, -16]], [[64]]),
    "undamped": Machine([[0, 1], [-900, 0]], [[0], [1]], [[30, 1]], [[0.25]], inputs="c"),
    "overdamped": Machine([[0, 1], [-100, -90]], [[0, 0], [100, 90]], [[1, 0]], [[-1, 0]], inputs="ab"),
    "stiff": Machine([[0, 1], [-250000, -10]], [[0], [250000]], [[-250000, -10]], [[250000]]),
    "drifting": Machine([[0, 1], [0, 0]], [[0], [1]], [[1, 0]]),
}


def chain(machine: Machine) -> tuple[mpmath.matrix, mpmath.matrix, mpmath.matrix]:
    """The machine with the displacement's derivatives as further states: the matrix, the start and the output's row."""
    law = ExactLaw(smoothstep(ORDER))
    derivatives = [Fraction(str(law.value(nu, Fraction(0)))) for nu in range(2 * ORDER)]
    size, count = len(machine.A), len(derivatives)
    whole, start, row = mpmath.zeros(size + count), mpmath.zeros(size + count, 1), mpmath.zeros(1, size + count)
    whole[:size, :size] = mpmath.matrix(machine.A)
    row[0, :size] = mpmath.matrix([list(machine.C[0])])
    for nu, value in enumerate(derivatives):
        start[size + nu] = mpmath.mpf(value.numerator) / value.denominator
        if nu + 1 < count:
            whole[size + nu, size + nu + 1] = 1
    for column, symbol in enumerate(machine.inputs):
        place = size + "abc".index(symbol)
        row[0, place] = machine.D[0][column]
        for i in range(size):
            whole[i, place] = machine.B[i][column]
    return whole, start, row


@cache
def exponential(kind: str, k: Fraction) -> mpmath.matrix:
    return mpmath.expm(chain(MACHINES[kind])[0] * (mpmath.mpf(k.numerator) / k.denominator))


def fraction(value: mpmath.mpf) -> Fraction:
    return Fraction(mpmath.nstr(value, 50, min_fixed=0, max_fixed=0))


@pytest.mark.parametrize("kind", MACHINES)
def test_a_response_is_that_of_the_matrix_exponential(kind: str) -> None:
    machine, k = MACHINES[kind], Fraction(5, 16)
    with mpmath.workdps(50), ctx.workprec(400):
        _, start, row = chain(machine)
        expected = (row * exponential(kind, k) * start)[0]
        rise = of_pieces(ExactLaw(smoothstep(ORDER)).polynomials)
        (found,) = response(Transfer(machine, "output 1"), rise).row(k)
        assert abs(lower(found) - fraction(expected)) < Fraction(1, 10**36)
        assert float(found.rad()) < 1e-60


@pytest.mark.parametrize("kind", ["defective", "undamped"])
def test_a_mean_square_is_that_of_van_loan(kind: str) -> None:
    machine = MACHINES[kind]
    with mpmath.workdps(50):
        whole, start, row = chain(machine)
        size = whole.rows
        double = mpmath.zeros(2 * size)
        double[:size, :size], double[:size, size:], double[size:, size:] = -whole.T, row.T * row, whole
        grown = mpmath.expm(double)
        square = (start.T * grown[size:, size:].T * grown[:size, size:] * start)[0]
        found = ExactLaw(smoothstep(ORDER)).term(machine.rms())
        assert lower(found) <= fraction(mpmath.sqrt(square)) + Fraction(1, 10**30)
        assert upper(found) >= fraction(mpmath.sqrt(square)) - Fraction(1, 10**30)
        assert float(found.rad()) < 1e-30


@pytest.mark.parametrize("kind", sampled(MACHINES))
def test_peaks_are_those_of_doubles(kind: str) -> None:
    machine = MACHINES[kind]
    law = ExactLaw(smoothstep(ORDER))
    for within in ((0.0, 1.0), (0.25, 1.5), (1.0, 1.25)):
        if kind == "drifting" and within[0] == 1.0:
            continue
        constant = machine.peak(within=within)
        low, high = enclosed(law.term(constant))
        assert high - low < 1e-15 * high
        # 250000 times what the mass lags behind is what doubles make of the stiff one's acceleration
        lost = 1e-8 if kind == "stiff" else 1e-11
        assert constant.value(smoothstep(ORDER)) == pytest.approx(low, rel=lost)


@pytest.mark.parametrize("seed", [1, 2, *(pytest.param(i, marks=pytest.mark.long) for i in range(7, 60))])
def test_random_machines_are_those_of_doubles(seed: int) -> None:
    case = random_case(seed)
    machine, rise = case.machine, smoothstep(4)
    for output in machine.outputs[-2:]:
        found = machine.response(rise, dwell=0.5)[output]
        with ctx.workprec(400):
            laws = followed(of_pieces(ExactLaw(rise).polynomials), Fraction(3, 2))
            motion = response(Transfer(machine, output), laws)
            values = [float(motion.row(Fraction(i, 8))[0].mid()) for i in range(13)]
        scale = max(found.peak(0).value, 1e-3)
        assert np.abs(np.array(values) - found(np.arange(13) / 8)).max() < 1e-9 * scale, case.kind


def test_cycles_come_back() -> None:
    rise, machine = smoothstep(ORDER), MACHINES["critical"]
    cycle = machine.cycle(rise, dwell=0.5, rest=0.25)["output 1"]
    for constant, value in (
        (machine.peak(cycle=(0.5, 0.25)), cycle.peak(0).value),
        (machine.rms(cycle=(0.5, 0.25)), cycle.rms(0)),
    ):
        low, high = enclosed(ExactLaw(rise).term(constant))
        assert low - 1e-11 * value < value < high + 1e-11 * value
        assert high - low < 1e-13 * high


def test_what_has_no_steady_motion_is_said() -> None:
    drifting = Transfer(MACHINES["drifting"], "output 1")
    there = of_pieces(ExactLaw(smoothstep(ORDER)).polynomials)
    with pytest.raises(InputError, match="drifts"), ctx.workprec(300):
        response(drifting, cycle(there, Fraction(0), Fraction(0)), repeats=True)


def test_a_jump_of_velocity_has_no_peak_where_the_acceleration_is_felt() -> None:
    bent = PiecewiseLaw([0.0, 0.5, 1.0], [PolynomialSegment((1.0,)), PolynomialSegment((1.0,), 3.0)])
    feels = Machine([[-2.0]], [[1.0]], [[1.0]], [[1.0]], inputs="c")
    assert ExactLaw(bent).term(feels.peak()) == arb.pos_inf()
    assert ExactLaw(bent).term(Machine([[-2.0]], [[1.0]], [[1.0]], inputs="c").peak()) < ball(10)


# --- amplitudes of modes ---


CHAIN = Machine.from_masses(
    {"drive": 1.0, "first": 0.5, "last": 0.3},
    [Link("drive", "first", 300.0, 0.4), Link("first", "last", 900.0, 0.2)],
    drive="drive",
    outputs=["force drive-first", "acceleration last"],
)
#: two equal vibrations beside each other: one mode
TWIN = Machine(
    [[0, 1, 0, 0], [-400, -2, 0, 0], [0, 0, 0, 1], [0, 0, -400, -2]], [[0], [400], [0], [100]], [[1, 0, 2, 1]]
)


def velocity(k: mpmath.mpf) -> mpmath.mpf:
    return 30 * k**2 * (1 - k) ** 2


def amplitude(machine: Machine, output: str, root: mpmath.mpc, place: mpmath.mpc) -> mpmath.mpf:
    """By eigenvectors of the matrix; the share at the machine's own root, the integral at another place."""
    roots, left, right = mpmath.eig(mpmath.matrix(machine.A), left=True, right=True)
    own = min(range(len(roots)), key=lambda i: abs(roots[i] - root))
    w = roots[own]
    driven = mpmath.matrix(machine.B) * mpmath.matrix([w ** ("abc".index(one) - 1) for one in machine.inputs])
    row, column = left[own, :], right[:, own]
    seen = (mpmath.matrix([list(machine.C[machine.place(output)])]) * column)[0]
    share = seen * (row * driven)[0] / (row * column)[0]
    integral = mpmath.quad(lambda k: mpmath.exp(place * (1 - k)) * velocity(k), [0, 0.5, 1])
    return abs(2 * share * integral)


@pytest.mark.parametrize(("mode", "output"), [(1, "force drive-first"), (2, "acceleration last")])
def test_an_amplitude_is_that_of_eigenvectors(mode: int, output: str) -> None:
    root = mpmath.mpc(CHAIN.modes[mode - 1].root)
    with mpmath.workdps(40):
        own = min(mpmath.eig(mpmath.matrix(CHAIN.A))[0], key=lambda one: abs(one - root))
        expected = amplitude(CHAIN, output, own, own)
        found = ExactLaw(smoothstep(ORDER)).term(CHAIN.residual(mode, output))
        off = expected * mpmath.mpf("1e-30")
        assert lower(found) <= Fraction(str(expected + off))
        assert upper(found) >= Fraction(str(expected - off))
        assert float(found.rad()) < 1e-30


@pytest.mark.parametrize("box", [{"spread": 0.1}, {"damping": (0.0, 0.05)}, {"spread": 0.1, "damping": (0.0, 0.05)}])
def test_the_greatest_over_a_box_is_that_of_doubles(box: dict[str, float | tuple[float, float]]) -> None:
    constant = CHAIN.residual(1, "acceleration last", **box)  # type: ignore[arg-type]
    low, high = enclosed(ExactLaw(smoothstep(ORDER)).term(constant))
    assert constant.value(smoothstep(ORDER)) == pytest.approx(low, rel=1e-11)
    assert high - low < 1e-13 * high


def test_equal_vibrations_beside_each_other_are_one_mode() -> None:
    residual = ExactModeResidual(TWIN.residual())
    with ctx.workprec(300):
        assert [count for _, count in residual.mode] == [2]
        assert float(residual.share.mid()) == pytest.approx(TWIN.residual().share, rel=1e-12)


def test_modes_that_no_number_tells_apart_are_refused() -> None:
    two = Machine(
        [[0, 1, 0, 0], [-400, -2, 0, 0], [0, 0, 0, 1], [0, 0, -400, -4]], [[0], [400], [0], [100]], [[1, 0, 2, 1]]
    )
    with ctx.workprec(300), pytest.raises(InputError, match="same frequency"):
        _ = ExactModeResidual(two.residual()).mode


# --- optima ---


AXIS = Machine.from_masses(
    {"motor": 0.8e-4, "carriage": 2.4e-4},
    [Link("motor", "carriage", 9.0, 0.0018)],
    drive="motor",
    outputs={"torque": "drive force", "sway": "deflection motor-carriage"},
    duration=0.1,
    stroke=4.0,
)
WHOLE: dict[str, Any] = {"order": 3, "symmetric": False, "basis": Chebyshev(7)}
SWAY = AXIS.residual(1, "sway", spread=0.1)
BOX = AXIS.residual(1, "sway", spread=0.1, damping=(0.0, 0.05))
ASKED: dict[str, dict[str, Any]] = {
    "peak": {"minimise": AXIS.peak("torque"), "J": at_most(100), "bounds": {SWAY: at_most(0.01)}},
    "peak in the dwell": {"minimise": C, "bounds": {AXIS.peak("sway", within=(1.0, 1.5)): at_most(0.02)}},
    "rms": {"minimise": AXIS.rms("torque", dwell=0.5), "J": at_most(100)},
    "rms kept": {"minimise": C, "bounds": {AXIS.rms("torque"): at_most(0.6)}},
    "residual": {"minimise": SWAY, "J": at_most(70), "basis": Chebyshev(3)},
    "residual over a box": {"minimise": C, "bounds": {BOX: at_most(0.01)}},
    "cycle": {"minimise": AXIS.peak("torque", cycle=(0.2, 0.3)), "B": at_most(2.0)},
    "rms of a cycle alone": {"minimise": AXIS.rms("torque", cycle=(0.2, 0.3), offset=0.3)},
    "side": {"minimise": AXIS.peak("torque", side="low", offset=0.4), "J": at_most(100)},
    "side at its floor": {"minimise": AXIS.peak("sway", side="high", offset=1.0), "J": at_most(100)},
    "side below 0": {"minimise": AXIS.peak("torque", side="high", offset=-5.0) + 0.1 * C},
    "sum": {"minimise": AXIS.peak("torque") + 0.1 * C + 10.0 * SWAY, "J": at_most(100)},
    "maximum": {"minimise": f"max({AXIS.peak('torque')!r}, {AXIS.rms('torque')!r}) + 0.05*C"},
    "pieces": {"minimise": AXIS.peak("torque"), "J": at_most(100), "basis": Pieces([0, 0.3, 0.7, 1], 5, 2)},
    "symmetric": {"minimise": AXIS.peak("torque"), "J": at_most(100), "symmetric": True},
    "symmetric pieces": {
        "minimise": AXIS.rms("torque"),
        "J": at_most(100),
        "symmetric": True,
        "basis": Pieces([0, 0.5, 1], 7, 3),
    },
}


@cache
def solved(kind: str) -> Solution:
    return synthesize(Problem(**{**WHOLE, **ASKED[kind]}))


def stored(kind: str) -> dict[str, Any]:
    data: dict[str, Any] = json.loads(json.dumps(solved(kind).to_dict()))
    return data


@pytest.mark.parametrize("kind", sampled(ASKED, each=5))
def test_each_kind_is_proven_and_nothing_more(kind: str) -> None:
    data = stored(kind)
    verification = verify(data)
    assert [str(claim) for claim in verification.claims if not claim.proven] == []
    assert verification.gap is not None
    assert abs(verification.gap) < 1e-8
    more = {**data}
    for key, sign in (("objective", -1.0), ("lower_bound", 1.0)):
        more[key] += sign * 1e-6 * abs(data[key])
    refused = {claim.name for claim in verify(more).claims if not claim.proven}
    assert refused >= {"the objective", "the lower bound"}


@pytest.mark.parametrize("kind", sampled(["peak", "rms", "residual over a box"]))
def test_another_machine_is_not_proven(kind: str) -> None:
    text = json.dumps(stored(kind))
    # a stiffness that is more by a millionth, in the problem and in the certificate
    matrix = repr(AXIS.A[1][0])
    assert matrix in text
    assert not verify(json.loads(text.replace(matrix, repr(AXIS.A[1][0] * (1.0 + 1e-6))))).proven


@pytest.mark.long
def test_a_whole_cycle_with_its_load_is_proven() -> None:
    load = {"period": "20 ms", "damping": 0.05}
    cycle = Cycle([Rise("35 mm", "0.1 s"), Return()], period="0.3 s", load=load, minimise="load acceleration")
    for solution in cycle.solutions:
        assert verify(json.loads(json.dumps(solution.to_dict()))).proven


@pytest.mark.long
def test_no_multiplier_and_no_place_proves_more_than_is_true() -> None:
    solution = solved("peak")
    data = solution.certificate.to_dict()
    for i, contact in enumerate(data["contacts"]):
        for key, value in (("k", min(1.0, contact["k"] + 0.01)), ("multiplier", contact["multiplier"] * 1.5)):
            other = changed(data, ("contacts", i, key), value)
            bound = exact_bound(type(solution.certificate).from_dict(other))
            assert bound is None or float(bound) <= solution.objective * (1.0 + 1e-9)


@pytest.mark.parametrize("file", sampled(sorted((ROOT / "results").glob("machine_*/laws.json")), each=4))
def test_the_laws_of_problem_files_are_proven(file: Path) -> None:
    verifications = verify_all(file)
    assert len(verifications) > 2
    assert [str(claim) for one in verifications.values() for claim in one.claims if not claim.proven] == []
