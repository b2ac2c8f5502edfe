"""Outputs of machines in balls, against matrix exponentials by mpmath at 50 digits, and against doubles."""

from fractions import Fraction
from functools import cache

import mpmath  # type: ignore[import-untyped] # ships no types
import numpy as np
import pytest
from flint import arb, ctx

from optlaws import InputError, Machine, PiecewiseLaw, smoothstep
from tests.internals.laws import PolynomialSegment
from tests.internals.verification import (
    ExactLaw,
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
