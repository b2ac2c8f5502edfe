"""The direction of motion near rest: torques and energies against sums on a grid whose signs of velocity are exact."""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from optlaws import (
    BoundaryConditions,
    Cycle,
    Drive,
    Dwell,
    Mechanism,
    MotionLaw,
    Motor,
    Move,
    PiecewiseLaw,
    Return,
    catalogue,
    law_from_z,
)
from tests.internals.laws import PolynomialSegment, direction_of
from tests.laws.examples import EXAMPLES, free_function_law
from tests.sampling import examples, sampled

CELLS = 4000
#: middles of cells, and places ever nearer to both ends
NEAR = 2.0 ** -np.arange(8.0, 40.0)
MIDDLES = (np.arange(CELLS) + 0.5) / CELLS
K = np.sort(np.concatenate([MIDDLES, NEAR, 1.0 - NEAR]))


class Case(NamedTuple):
    """A law with its exact direction, where it is not forwards throughout: the polynomial of its velocity."""

    law: MotionLaw
    velocity: tuple[Fraction, ...] = ()

    def signs(self, k: np.ndarray) -> np.ndarray:
        if not self.velocity:
            return np.ones(k.shape)
        b = np.abs(np.asarray(self.law(k, 1)))
        exact = self._signs(k, b)
        runs = np.cumsum(np.diff(exact, prepend=exact[0]) != 0.0)
        for run in range(runs[-1], -1, -1):
            here = np.flatnonzero(runs == run)
            # the law is known to rounding alone: a turn of less than that is none
            if b[here].max() <= 1e-12 * b.max():
                exact[here] = exact[min(here[-1] + 1, len(k) - 1)] if run < runs[-1] else exact[max(here[0] - 1, 0)]
        return exact

    def _signs(self, k: np.ndarray, b: np.ndarray) -> np.ndarray:
        near = b <= 1e-9 * b.max()
        signs = np.sign(np.asarray(self.law(k, 1)))
        signs[near] = [self._sign(x) for x in k[near]]
        return signs

    def _sign(self, k: float) -> float:
        value, at = Fraction(0), Fraction(k)
        for coefficient in reversed(self.velocity):
            value = value * at + coefficient
        return float((value > 0) - (value < 0))


def polynomial(order: int, seed: int, terms: int) -> Case:
    """S_l + (k(k-1))^l Z of whole coefficients, with its velocity as it is before any rounding."""
    law = free_function_law(seed, order, terms)
    powers = [Fraction(value).limit_denominator(1) for value in law.to_powers()]
    assert sum(powers) == 1
    return Case(law, tuple(n * value for n, value in enumerate(powers))[1:])


def of_catalogue(name: str) -> Case:
    return Case(catalogue[name].law)


class Gear(NamedTuple):
    """A drive and a move as plain numbers."""

    to_load: float
    back: float
    inertia: float
    load: float
    slope: float
    rubs: float
    stroke: float

    @property
    def drive(self) -> Drive:
        mechanism = Mechanism(self.inertia, f"{self.load!r} + ({self.slope!r})*x", coulomb=self.rubs)
        motor = Motor(1e-4, friction={"coulomb": 0.1 * self.rubs}, constant=0.5)
        return Drive(mechanism, motor, ratio=2.0, efficiency=(self.to_load, self.back), regeneration=0.3)

    def torque(self, case: Case, k: np.ndarray) -> np.ndarray:
        """The motor's torque towards greater positions, by hand, for a duration of 1 s."""
        law, way = case.law, np.sign(self.stroke) * case.signs(k)
        x, w = self.stroke * np.asarray(law(k)), self.stroke * np.asarray(law(k, 2))
        resists = (self.inertia * w + self.load + self.slope * x + self.rubs * way) * way
        through = np.where(resists > 0.0, resists / self.to_load, resists * self.back)
        return np.asarray(2.0 * 1e-4 * w + (0.1 * self.rubs + through / 2.0) * way)


efficiency = st.floats(0.1, 1.0)
gears = st.builds(
    Gear,
    efficiency,
    efficiency,
    st.sampled_from([1e-6, 0.01, 1.0]),
    st.floats(-1000.0, 1000.0).filter(lambda load: abs(load) > 1e-3),
    st.floats(-5.0, 5.0),
    st.sampled_from([0.0, 0.3]),
    st.sampled_from([1.0, -1.0, 0.05, -3.0]),
)
polynomials = st.builds(polynomial, st.integers(3, 6), st.integers(0, 10_000), st.integers(1, 3))
cases = st.one_of(st.sampled_from(sorted(catalogue)).map(of_catalogue), polynomials)


def agree(case: Case, gear: Gear) -> None:
    drive, torque = gear.drive, gear.torque(case, K)
    own = float(np.abs(torque).max())
    sheet = drive.sheet(case.law, 0.0, gear.stroke, 1.0)
    assert own * (1.0 - 1e-9) <= sheet.peak_torque <= own * (1.0 + 4e-3)
    middle = gear.torque(case, MIDDLES)
    power = middle * 2.0 * gear.stroke * np.asarray(case.law(MIDDLES, 1))
    driven, braked = float(np.maximum(power, 0.0).mean()), float(np.maximum(-power, 0.0).mean())
    assert sheet.rms_torque == pytest.approx(float(np.sqrt(np.mean(middle**2))), rel=4e-3)
    assert sheet.motoring_energy == pytest.approx(driven, rel=4e-3, abs=1e-5 * (driven + braked))
    assert sheet.braking_energy == pytest.approx(braked, rel=4e-3, abs=1e-5 * (driven + braked))
    if np.abs(case.law([0.0, 1.0], 1)).max() > 1e-9:
        return  # no cycle goes on with a jump
    way = f"{gear.stroke!r} rad"
    cycle = Cycle([Move(way, "1 s", law=case.law), Dwell("1 s")], period="2 s", advance=way, drive=drive)
    effort, _ = cycle.efforts
    assert effort.peak_force == pytest.approx(sheet.peak_torque, rel=1e-9)
    assert effort.motoring_energy == pytest.approx(sheet.motoring_energy, rel=1e-9, abs=1e-9 * (driven + braked))
    assert np.asarray(cycle.force(K)) == pytest.approx(torque, rel=1e-9, abs=1e-9 * own)
    held = abs(gear.load + gear.slope * gear.stroke) / 2.0
    assert cycle.effort.peak_force == pytest.approx(max(sheet.peak_torque, held), rel=1e-9)


@pytest.mark.parametrize("name", sampled(sorted(catalogue), each=9))
@pytest.mark.parametrize("load", [-3.0, 3.0], ids=["helping", "hindering"])
def test_every_law_of_the_catalogue_goes_forwards_to_its_very_ends(name: str, load: float) -> None:
    agree(of_catalogue(name), Gear(0.5, 0.25, 1e-6, load, 0.2, 0.0, 1.0))


@given(cases, gears)
@examples(60)
def test_torques_and_energies_follow_the_law(case: Case, gear: Gear) -> None:
    agree(case, gear)


@given(polynomials)
def test_the_direction_is_that_of_the_exact_velocity(case: Case) -> None:
    b = np.asarray(case.law(K, 1))
    beyond = np.abs(b) > 1e-11 * np.abs(b).max()
    assert (direction_of(case.law)(K) == case.signs(K))[beyond].all()


@pytest.mark.parametrize("law", EXAMPLES.values(), ids=EXAMPLES)
def test_between_two_edges_no_velocity_is_against_the_direction(law: MotionLaw) -> None:
    b, way = np.asarray(law(K, 1)), direction_of(law)(K)
    size = np.abs(b[np.isfinite(b)]).max()
    assert (b * way >= -1e-11 * size).all()
    assert (np.abs(b[way == 0.0]) <= 1e-11 * size).all()


def test_rest_within_a_law_is_held_without_the_gear_s_losses() -> None:
    half = PolynomialSegment((0.0, -18.75))
    law = PiecewiseLaw([0.0, 0.4, 0.6, 1.0], [half, PolynomialSegment(()), half])
    drive = Drive(Mechanism("1e-6 kg m^2", "-3"), Motor("0 kg m^2"), efficiency=0.5)
    assert direction_of(law).signs.tolist() == [1.0, 0.0, 1.0]
    assert drive.sheet(law, 0.0, 1.0, 10.0).peak_torque == pytest.approx(3.0)
    cycle = Cycle([Move("1 rad", law=law), Dwell("1 s")], period="11 s", advance="1 rad", drive=drive)
    assert cycle.force(5.0) == pytest.approx(-3.0)
    assert cycle.force(1.0) == pytest.approx(-1.5, rel=1e-5)


@pytest.mark.parametrize("seed", [1, 2, 5])
def test_a_law_after_one_that_ends_with_a_rounding_does_not_turn_back(seed: int) -> None:
    law = law_from_z(BoundaryConditions.rest(3), 3.0 * np.random.default_rng(seed).normal(size=3))
    assert 0.0 < law.b(1.0) < 1e-15
    moves = [Move("30 mm", "0.2 s", law=law), Return(duration="0.2 s"), Dwell("0.1 s")]
    cycle = Cycle(moves, period="0.5 s", minimise="force", drive={"mass": "2 kg", "dry": "5 N"})
    assert cycle.status == "optimal"
    assert cycle.objective == pytest.approx(max(effort.peak_force for effort in cycle.efforts), rel=1e-9)


def test_a_picture_of_a_move_forwards_has_no_side_of_motion_backwards() -> None:
    motor = Motor("3e-4 kg m^2", peak_torque="9 N m", greatest_speed="3000 rpm")
    lines = Drive(Mechanism("0.8 kg m^2"), motor, ratio=20).plot("4-5-6-7 polynomial", 0.0, "45 deg", "0.25 s")
    assert min(line.get_xdata().min() for line in lines) > -1e-6
