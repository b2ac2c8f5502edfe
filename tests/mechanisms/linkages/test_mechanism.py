"""Mechanisms from formulas and tables, what they refuse, and how they are kept."""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce
from operator import mul
from typing import Any, Literal

import numpy as np
import pytest

from optlaws import (
    Body,
    CamForces,
    Cycle,
    DiscCam,
    Dwell,
    InputError,
    Loads,
    Mechanism,
    Return,
    Rise,
    TranslatingRoller,
    belt,
    cam_mechanism,
    four_bar,
    mechanism_of_motion,
    rack,
    rms,
    screw,
    slider_crank,
    smoothstep,
    toggle,
)
from optlaws.typing import Jet
from tests.internals.formulas import NUMPY, Arithmetic, Formula, evaluate, read
from tests.internals.numerics import variable

KNEE = {"crank": "60 mm", "rod": "250 mm", "upper": "200 mm", "lower": "200 mm", "frame": "280 mm"}
ALL = {
    "formula": Mechanism("0.02 + 0.01*sin(x)^2", "3*cos(x)", coulomb=0.2, viscous=0.01, over=(0.0, 3.0)),
    "table": Mechanism([(0.0, 0.3), (0.2, 0.5), (0.5, 0.4), (0.7, 0.6)], {0.0: 1.0, 0.3: 4.0, 0.7: 2.0}, axis="length"),
    "slider-crank": slider_crank("0.1 m", "0.4 m", bodies={"slider": 5.0}, loads=Loads({0.3: -80.0, 0.5: 10.0})),
    "four-bar": four_bar(0.1, 0.3, 0.25, 0.35, bodies={"coupler": Body(1.0, centre=(0.1, 0.05))}),
    "toggle": toggle(KNEE, bodies={"ram": "40 kg"}, loads=Loads("-900 N", gravity="90 deg")),
    "screw": screw(
        "10 mm", "80 kg", loads=Loads(stiffness="2 N/mm", free="20 mm", gravity="180 deg"), over=(0.0, 60.0)
    ),
    "traced": mechanism_of_motion(lambda x: {"arm": np.arctan(x) + x / 3}, {"arm": "0.2 kg m^2"}, over=(0.0, 2.0)),
}


@pytest.fixture(params=ALL)
def mechanism(request: pytest.FixtureRequest) -> Mechanism:
    return ALL[request.param]


def test_slopes_are_those_of_the_values(mechanism: Mechanism) -> None:
    low, high = mechanism.over
    x, step = np.linspace(low, high, 9)[1:-1] + 0.013 * (high - low), 1e-4 * (high - low)
    for values in (mechanism.inertia, mechanism.load):
        if values == mechanism.load and mechanism in (ALL["table"], ALL["slider-crank"]):
            continue  # straight lines have no slope at their places
        for nu in range(2):
            by_differences = (
                8.0 * (values(x + step, nu) - values(x - step, nu))
                - values(x + 2 * step, nu)
                + values(x - 2 * step, nu)
            ) / (12.0 * step)
            size = 1e-30 + np.abs(values(x, nu)).max() / (high - low)
            assert values(x, nu + 1) == pytest.approx(by_differences, rel=1e-6, abs=1e-6 * size)


def by_taylor(formula: Formula, x: np.ndarray, order: int) -> Jet:
    """The derivatives of a formula by Taylor arithmetic, which shares nothing with the formulas of slopes."""

    zero = variable(x, order) * 0.0

    def power(base: Jet, exponent: Jet) -> Jet:
        return reduce(mul, [base] * int(exponent.terms[0][0]))

    functions = {
        "sin": lambda of: of.waves()[0],
        "cos": lambda of: of.waves()[1],
        "sqrt": Jet.root,
        "atan": Jet.arctangent,
    }
    jets = Arithmetic(lambda value: zero + value, functions, power)
    jet: Jet = evaluate(formula, {"x": variable(x, order)}, jets)
    return jet


@pytest.mark.parametrize("name", ["formula", "four-bar", "toggle", "traced", "rod"])
def test_derivatives_are_those_of_taylor_arithmetic(name: str) -> None:
    mechanism = ALL.get(name) or slider_crank(
        0.1, 0.4, offset=0.05, bodies={"rod": Body(2.0, centre=(0.1, 0.02), inertia=0.01)}, loads=Loads(gravity="1 rad")
    )
    x = np.linspace(*mechanism.over, 13)
    for formula, values in ((mechanism.inertia_formula, mechanism.inertia), (mechanism.load_formula, mechanism.load)):
        jet = by_taylor(formula, x, 3)
        for nu in range(4):
            exact = jet.derivative(nu)
            assert values(x, nu) == pytest.approx(exact, rel=1e-11, abs=1e-11 * np.abs(exact).max() + 1e-300)


@pytest.mark.sample(3)
@pytest.mark.parametrize("share", [0.6, -0.6])
def test_dimensionless_torque_is_the_torque(mechanism: Mechanism, share: float) -> None:
    low, high = mechanism.over
    start, stroke, duration = (low if share > 0.0 else high), share * (high - low), 0.4
    moved = mechanism.dimensionless(start, stroke, duration)
    law, k = smoothstep(4), np.linspace(0.0, 1.0, 101)[1:-1]
    names = {"a": law(k), "b": law(k, 1), "c": law(k, 2)}
    position, velocity = start + stroke * names["a"], stroke / duration * names["b"]
    torque = mechanism.torque(position, velocity, stroke / duration**2 * names["c"])
    values = moved.unit * evaluate(read(moved.torque), names, NUMPY)
    assert np.sign(stroke) * values == pytest.approx(torque, rel=1e-10, abs=1e-11 * np.abs(torque).max())
    # its numbers are near 1, whatever the units
    assert 0.05 < rms(moved.torque).value(law) < 20.0
    # and the work of the law is what is stored and lost
    k, weights = np.polynomial.legendre.leggauss(60)
    k, weights = 0.5 * (k + 1.0), 0.5 * weights
    names = {"a": law(k), "b": law(k, 1), "c": law(k, 2)}
    if mechanism.coulomb == 0.0 and mechanism is not ALL["table"]:
        work = moved.energy_unit * weights @ (evaluate(read(moved.torque), names, NUMPY) * names["b"])
        x = start + stroke * k
        assert work == pytest.approx(stroke * weights @ mechanism.load(x), rel=1e-5, abs=1e-6 * moved.energy_unit)


def test_straight_transmissions_reduce_masses_and_forces() -> None:
    loads = Loads("-10 N", gravity="180 deg")
    for mechanism, ratio in (
        (rack(0.02, 3.0, inertia=1e-3, loads=loads), 0.02),
        (belt("30 mm", 3.0, inertia=1e-3, loads=loads), 0.03),
        (screw("10 mm", "3 kg", inertia=1e-3, loads=loads), 0.01 / (2.0 * np.pi)),
    ):
        assert mechanism.inertia(123.0) == pytest.approx(1e-3 + 3.0 * ratio**2)
        assert mechanism.load(-7.0) == pytest.approx((10.0 + 3.0 * 9.80665) * ratio)


def test_a_cam_takes_the_power_of_its_follower() -> None:
    segments = [Rise("40 mm", "120 deg", law="3-4-5"), Dwell("60 deg"), Return(law="cycloidal")]
    cam = DiscCam(Cycle(segments, speed="200 rpm"), "80 mm", TranslatingRoller("12 mm"))
    forces = CamForces(cam, drive={"mass": "2 kg", "stiffness": "3 N/mm", "preload": "60 N"})
    loads = Loads("-60 N", stiffness="3 N/mm")
    for over, share in ((("0 deg", "120 deg"), 1e-13), (("180 deg", "360 deg"), 1e-12), (None, 3e-6)):
        shaft = cam_mechanism(cam, "2 kg", loads=loads, over=over)
        x = np.linspace(*shaft.over, 997)[1:-1]
        assert shaft.torque(x, forces.rate, 0.0) == pytest.approx(
            forces.shaft_torque(x), abs=share * forces.torque.most
        )


REFUSED: list[tuple[Callable[[], Any], str]] = [
    (lambda: Mechanism("-0.1"), "the inertia must be at least 0, and it is -0.1 at"),
    (lambda: Mechanism("0.1*x", over=("-30 deg", "30 deg")), r"it is -0\.0523599 at -30 deg"),
    (
        lambda: Mechanism("0.1 kg"),
        "inertia must be a moment of inertia such as '0.02 kg m\\^2', but '0.1 kg' is a mass",
    ),
    (lambda: Mechanism("abs(x)"), "no derivative everywhere"),
    (lambda: Mechanism("1/x", over=(0.0, 1.0)), "the inertia has no finite value at 0 deg"),
    (lambda: Mechanism("0.1 + y"), "unknown name 'y'"),
    (lambda: Mechanism(1.0, over=("0 deg", "1 m")), "angles, one that slides lengths"),
    (lambda: Mechanism(1.0, over=(2.0, 1.0)), "positions that ascend"),
    (lambda: Mechanism(1.0, coulomb="-1 N m"), "coulomb must be at least 0"),
    (
        lambda: Mechanism({0.0: 1.0, 0.5: 1.0, 0.8: 1.0, 1.0: 1.0}, over=(0.0, 2.0)),
        "table of the inertia goes from 0 deg to 57.29\\d* deg, and the mechanism from 0 deg to 114.59",
    ),
    (lambda: Mechanism({0.0: 1.0}), "a table needs 2 pairs"),
    (lambda: Mechanism("table(x, 0:1, 1:2, 2:1)"), "the inertia has corners"),
    (lambda: Mechanism(1.0, "spline(x, 0:0, 1:0, 1.2:9, 2:9, 3:9)"), "load: between 0 and 1 the spline is .* beyond"),
    (lambda: Mechanism(1.0, {1.0: 1.0, 0.5: 1.0}), "places of a table must ascend, got 1.0 before 0.5"),
    (lambda: Mechanism(1.0, [("60 deg", 1.0), ("50 deg", 1.0)]), "must ascend, got '60 deg' before '50 deg'"),
    (lambda: ALL["formula"].dimensionless(1.0, 3.0, 1.0), "defined from 0 deg to 171.887339 deg, got 229.183"),
    (
        lambda: ALL["formula"].dimensionless(1.0, 0.0, 1.0),
        "stroke must not be 0: give how far the input moves, such as '45 deg'",
    ),
    (lambda: Mechanism(0.0).dimensionless(0.0, 1.0, 1.0), "neither inertia nor load nor friction"),
    (lambda: ALL["formula"].driven_position("ram", 0.0), "unknown driven link 'ram'"),
    (
        lambda: slider_crank(0.1, 0.08, bodies={"slider": 1.0}),
        r"rod of 0.08 m is too short .* at 53.1301 deg the pin is 0.08 m",
    ),
    (lambda: slider_crank(0.1, 0.4, bodies={"slider": "-5 kg"}), "bodies: slider must be at least 0"),
    (lambda: slider_crank(0.1, 0.4, bodies={"ram": "5 kg"}), "unknown body 'ram'"),
    (lambda: slider_crank(0.1, 0.4, bodies={"rod": "5 kg"}), "rod is on no pivot and needs a Body"),
    (lambda: slider_crank("-0.1 m", 0.4, bodies={}), "crank must be above 0"),
    (lambda: four_bar(0.1, 0.2, 0.2, 0.6, bodies={}), "the links do not close: the frame of 0.6 m"),
    (lambda: four_bar(0.2, 0.15, 0.2, 0.3, bodies={}), r"reaches no angle from 86\.4167 to 273\.583 deg: .* Grashof"),
    (lambda: toggle({"crank": 1.0}, bodies={}), "a toggle needs rod, upper, lower, frame too"),
    (lambda: toggle({**KNEE, "lower": "50 mm"}, bodies={}), "lower link of 0.05 m does not reach the ram's way at"),
    (lambda: toggle({**KNEE, "upper": "1 m"}, bodies={}), "the links do not close: the upper link of 1 m is as long"),
    (lambda: toggle({**KNEE, "upper": "60 mm"}, bodies={}), "deg: rod and upper link are in line, stretched"),
    (lambda: toggle(KNEE, direction="-90 deg", bodies={}), "behind the upper link's pivot"),
    (lambda: mechanism_of_motion(lambda x: x if x > 1 else 0, {"q1": "1 kg"}, over=(0, 1)), "compares .* give a table"),
    (lambda: mechanism_of_motion(np.floor, {"q1": "1 kg"}, over=(0, 1)), "numpy.floor"),
    (lambda: mechanism_of_motion(lambda x: x, {"q1": 1.0}, over=(0, 1)), "q1 must be a mass such as '5 kg'"),
    (lambda: mechanism_of_motion(lambda x: x, {}, over=(0, 1)), "needs a mass"),
    (lambda: Loads("3 N", over="position"), "unknown over 'position'; known are driven, input"),  # type: ignore[arg-type]
    (lambda: Mechanism.from_dict({"format": 1, "mass": 1}), "unknown entry of a mechanism 'mass'"),
]


@pytest.mark.parametrize(("wrong", "message"), REFUSED, ids=range(len(REFUSED)))
def test_what_cannot_be_is_refused(wrong: Callable[[], Any], message: str) -> None:
    with pytest.raises(InputError, match=f"(?s){message}"):
        wrong()


#: with what happens within less than a thousandth of the range, or between the places of even samples
NARROW: list[tuple[Callable[[], Any], str]] = [
    (lambda: Mechanism("0.1 - 0.2*exp(-(1e5*(x - 0.70001))^2)", over=(0.0, 3.0)), r"it is -0\.1 at 40\.1076"),
    (lambda: Mechanism("0.1", "1/(x - 0.70001)", over=(0.0, 3.0)), r"the load has no finite value at 40\.1076"),
    (lambda: Mechanism("0.1", "1/sin(x - 0.70001)^2", over=(0.0, 3.0)), r"the load has no finite value at 40\.1076"),
    (lambda: Mechanism("0.1", "tan(x)", over=(0.0, 3.0)), "the load has no finite value at 90 deg"),
    (lambda: Mechanism("0.1", "(x - 0.5)^-3", over=(0.0, 3.0)), "the load has no finite value at 28.6478"),
    (lambda: Mechanism("0.1", "log((x - 0.70001)^2)", over=(0.0, 3.0)), r"the load has no finite value at 40\.1076"),
    (
        lambda: Mechanism("0.1", "sqrt((x - 0.7)^2 - 1e-10)", over=(0.0, 3.0)),
        r"the load has no finite value at 40\.1070",
    ),
    (lambda: Mechanism("0.1*(40 - x)").dimensionless(39.0, 2.0, 1.0), r"it is -0\.1 at 2349\.1"),
    (
        lambda: slider_crank(0.1, 0.1 - 1e-9, bodies={}, over=("0.03 deg", "180 deg")),
        r"at 89\.99\d* deg the pin is 0.1 m from .* it is reached from 0\.03 to 180 deg but for these",
    ),
    (
        lambda: slider_crank(0.1, 0.12, offset="-20.000001 mm", bodies={}, over=("0.03 deg", "360 deg")),
        r"at 89\.9\d* deg the pin is 0\.12 m",
    ),
    (lambda: slider_crank(0.1, 0.12, offset="0.3 m", bodies={}, over=("0 deg", "360 deg")), "does not reach it"),
    (lambda: slider_crank(0.1, 0.12, offset="-0.3 m", bodies={}), "does not reach it"),
    (
        lambda: toggle({**KNEE, "lower": 0.14696411836}, bodies={}, over=("0 deg", "360 deg")),
        r"lower link of 0\.146964 m does not reach the ram's way at 225\.55",
    ),
]


@pytest.mark.parametrize(("wrong", "message"), NARROW, ids=range(len(NARROW)))
def test_what_cannot_be_between_samples_is_refused(wrong: Callable[[], Any], message: str) -> None:
    with pytest.raises(InputError, match=f"(?s){message}"):
        wrong()


@pytest.mark.parametrize("exponent", ["0", "1", "2", "4", "0.5", "1.5"])
def test_a_power_has_a_value_where_its_base_vanishes(exponent: str) -> None:
    inertia = Mechanism(f"1 + (x/2)^{exponent}", over=(0.0, 2.0))
    assert inertia.inertia(0.0) == pytest.approx(1.0 + 0.0 ** float(exponent))


def test_what_only_touches_its_bounds_is_taken() -> None:
    """An inertia that vanishes, a root of what is 0 at an end, and a rod that is hardly long enough."""
    assert Mechanism("0.1*(1 - cos(x))", over=(0.0, 7.0)).inertia(0.0) == 0.0
    assert Mechanism("0.1", "sqrt(1 - x^2)", over=(-1.0, 1.0)).load(1.0) == 0.0
    assert Mechanism("0.1 - 0.2*exp(-(1e5*(x - 3.1))^2)", over=(0.0, 3.0)).load(0.0) == 0.0
    press = slider_crank(0.1, 0.1 + 1e-9, bodies={"crank": 0.2})
    assert press.inertia(1.0) == 0.2
    assert Mechanism("0.02 + 0.01*sin(x)^2").dimensionless(1e6, 2.0, 1.0).start == 1e6
    moved_by_time = Mechanism("0.1", read("3*t*x", ("t", "x"))).with_friction(coulomb=1.0)
    assert moved_by_time.torque(2.0, 1.0, 0.0, time=0.5) == 4.0


@pytest.mark.sample(3)
@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("more", [1e-2, -1e-2, 3e-3, -3e-3, 1e-5, -1e-5])
def test_a_rocker_that_turns_over_at_once_has_no_jump(more: float, branch: Literal["open", "crossed"]) -> None:
    """Where the crank is nearly as long as the frame, the pins of its ends pass each other, and half a turn with it."""
    x = np.unique(np.concatenate([np.linspace(-1.0, 1.0, 401), np.linspace(-9.0, 9.0, 40001) * more]))
    frame = 0.1 * (1.0 + more)
    near = four_bar(0.1, 0.2, 0.2, frame, bodies={"rocker": 0.05}, over=(-1.0, 1.0), branch=branch)
    if near.linkage.driven or abs(more) > 1e-3:
        angle = near.driven_position("rocker", x)
        assert np.abs(np.diff(angle)).max() < 0.02
        assert np.abs(0.1 * np.exp(1j * x) - frame - 0.2 * np.exp(1j * angle)) == pytest.approx(0.2, abs=1e-9)


def test_pictures(mechanism: Mechanism) -> None:
    artists = mechanism.plot()
    panels = {artist.axes for artist in artists}
    assert len(panels) == 3 + bool(mechanism.linkage.chains)
    inertia = next(line for line in artists if line.axes.get_ylabel().startswith("J,"))
    assert inertia.get_ydata() == pytest.approx(mechanism.inertia(np.linspace(*mechanism.over, 721)))
