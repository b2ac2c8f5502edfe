"""Linkages against equations of motion of another kind, and the slider-crank against published numbers."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, hypot, pi, radians, sin
from typing import Literal

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

from optlaws import (
    Body,
    Chebyshev,
    Loads,
    Mechanism,
    Problem,
    Solution,
    four_bar,
    mechanism_of_motion,
    rms,
    slider_crank,
    smoothstep,
    synthesize,
    toggle,
)
from optlaws.typing import Array, StrokeTorque

G = 9.80665
LAW = smoothstep(3)
CRANK = Body(1.0, centre=(0.04, 0.01), inertia=0.002)
COUPLER = Body(2.0, centre=(0.12, 0.05), inertia=0.01)
ROCKER = Body(1.5, centre=(0.10, -0.02), inertia=0.02)
LENGTHS = {"crank": 0.1, "coupler": 0.3, "rocker": 0.25, "frame": 0.35}


def linkage(branch: str = "open", over: tuple[float, float] = (0.0, 2.0 * pi)) -> Mechanism:
    bodies = {"crank": CRANK, "coupler": COUPLER, "rocker": ROCKER}
    loads = Loads("3 + 2*s", stiffness=4.0, free=1.0, gravity="-60 deg")
    return four_bar(*LENGTHS.values(), bodies=bodies, loads=loads, over=over, branch=branch)  # type: ignore[arg-type]


def placed(body: Body, angle: float, first: tuple[float, float]) -> tuple[Array, Array]:
    """The centre of mass from a link's first joint, and the joint's place."""
    (p, q), c, s = body.centre, cos(angle), sin(angle)
    return np.array([p * c - q * s, p * s + q * c]), np.array(first)


def crossed(omega: float, way: Array) -> Array:
    return omega * np.array([-way[1], way[0]])


def angles(x: float, side: float) -> tuple[float, float]:
    """Coupler's and rocker's angle by the law of cosines."""
    dx, dy = LENGTHS["frame"] - 0.1 * cos(x), -0.1 * sin(x)
    base, length = np.arctan2(dy, dx), hypot(dx, dy)
    inner = np.arccos((length**2 + 0.3**2 - 0.25**2) / (2.0 * length * 0.3))
    coupler = base + side * inner
    pin = np.array([0.1 * cos(x) + 0.3 * cos(coupler), 0.1 * sin(x) + 0.3 * sin(coupler)])
    return float(coupler), float(np.arctan2(pin[1], pin[0] - 0.35))


@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("x", [0.3, 1.7, 3.6, 5.9])
def test_torque_of_a_four_bar_by_newton_and_euler(branch: str, x: float) -> None:
    """Nine equations of three free bodies with the forces in four pins: the torque is one of the unknowns."""
    side = 1.0 if branch == "open" else -1.0
    velocity, acceleration = 7.0, -40.0
    coupler, rocker = angles(x, side)
    a, b, c = (0.1 * np.array([cos(x), sin(x)]), 0.3 * np.array([cos(coupler), sin(coupler)]),
               0.25 * np.array([cos(rocker), sin(rocker)]))  # fmt: skip
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    # the loop a + b = d + c, differentiated twice
    rates = np.linalg.solve(np.column_stack([turn @ b, -turn @ c]), -velocity * turn @ a)
    right = -acceleration * turn @ a + velocity**2 * a + rates[0] ** 2 * b - rates[1] ** 2 * c
    bends = np.linalg.solve(np.column_stack([turn @ b, -turn @ c]), right)

    ways = [placed(CRANK, x, (0, 0))[0], placed(COUPLER, coupler, (0, 0))[0], placed(ROCKER, rocker, (0, 0))[0]]
    starts = [np.zeros(2), acceleration * turn @ a - velocity**2 * a, np.zeros(2)]
    spins = [(velocity, acceleration), (rates[0], bends[0]), (rates[1], bends[1])]
    ends, bodies = [a, b, c], [CRANK, COUPLER, ROCKER]
    accelerations = [
        s + alpha * turn @ w - omega**2 * w for s, w, (omega, alpha) in zip(starts, ways, spins, strict=True)
    ]
    weight = G * np.array([cos(radians(-60.0)), sin(radians(-60.0))])
    position = rocker % (2.0 * pi) if rocker < -2.5 else rocker
    on_rocker = 3.0 + 2.0 * position - 4.0 * (position - 1.0)

    # unknowns: forces in the four pins, two numbers each, and the torque on the crank
    matrix, vector = np.zeros((9, 9)), np.zeros(9)
    joints: list[list[tuple[int, float, Array]]] = [
        [(0, 1.0, np.zeros(2)), (2, 1.0, ends[0])],
        [(2, -1.0, np.zeros(2)), (4, -1.0, ends[1])],
        [(6, 1.0, np.zeros(2)), (4, 1.0, ends[2])],
    ]
    for i, (body, forces) in enumerate(zip(bodies, joints, strict=True)):
        for column, sign, place in forces:
            lever = place - ways[i]
            matrix[3 * i : 3 * i + 2, column : column + 2] += sign * np.eye(2)
            matrix[3 * i + 2, column : column + 2] += sign * np.array([-lever[1], lever[0]])
        vector[3 * i : 3 * i + 2] = body.mass * (accelerations[i] - weight)
        vector[3 * i + 2] = body.inertia * spins[i][1]
    matrix[2, 8], vector[8] = 1.0, vector[8] - on_rocker
    expected = np.linalg.solve(matrix, vector)[8]

    mechanism = linkage(branch)
    assert mechanism.driven_position("rocker", x) == pytest.approx(position, abs=1e-12)
    assert mechanism.torque(x, velocity, acceleration) == pytest.approx(expected, rel=1e-12)


@pytest.mark.sample(4)
@pytest.mark.parametrize(
    ("mechanism", "start", "stroke"),
    [
        (linkage(), 0.2, 2.5),
        (linkage("crossed"), 3.0, -2.0),
        (slider_crank("0.1 m", "0.4 m", bodies={"slider": "5 kg", "crank": 0.02}), 0.0, pi),
        (
            slider_crank(
                "0.1 m",
                "0.4 m",
                offset="30 mm",
                bodies={"slider": "5 kg", "rod": COUPLER, "crank": CRANK},
                loads=Loads("-50*s", gravity="-90 deg"),
            ).with_friction(coulomb="0.7 N m", viscous="0.05 N m s/rad"),
            0.5,
            2.0,
        ),
    ],
    ids=["four-bar", "crossed four-bar", "slider-crank", "slider-crank with everything"],
)  # fmt: skip
def test_computed_torque_gives_the_law_back(mechanism: Mechanism, start: float, stroke: float) -> None:
    """Lagrange's equation J x'' = torque - J' x'^2/2 - T, J' by differences, integrated in time."""
    duration, step = 0.3, 1e-6

    def motion(t: float) -> tuple[float, float, float]:
        k = t / duration
        return start + stroke * LAW(k), stroke / duration * LAW(k, 1), stroke / duration**2 * LAW(k, 2)

    def rate(t: float, state: Array) -> list[float]:
        x, v = state
        bend = (mechanism.inertia(x + step) - mechanism.inertia(x - step)) / (2.0 * step)
        friction = mechanism.viscous * v + mechanism.coulomb * np.sign(motion(t)[1])
        moved = mechanism.torque(*motion(t)) - bend * v * v / 2.0 - mechanism.load(x) - friction
        return [v, moved / mechanism.inertia(x)]

    times = np.linspace(0.1, 0.9, 5) * duration
    solved = solve_ivp(rate, (0.02, times[-1]), motion(0.02)[:2], t_eval=times, rtol=1e-10, atol=1e-12)
    assert solved.y[0] == pytest.approx([motion(t)[0] for t in times], abs=2e-6)


def numerically(function: Callable[[float], Array], x: float, step: float = 1e-5) -> Array:
    return np.asarray((function(x + step) - function(x - step)) / (2.0 * step))


@pytest.mark.parametrize("x", [0.4, 2.0, 4.5])
def test_inertia_and_load_of_a_toggle_by_its_places(x: float) -> None:
    """Velocities by differences of places that are solved from the loops; the load as the slope of an energy."""
    lengths = {"crank": 0.06, "rod": 0.25, "upper": 0.2, "lower": 0.22, "frame": 0.28}
    lower = Body(3.0, centre=(0.1, 0.015), inertia=0.01)
    bodies = {"ram": 40.0, "lower": lower, "rod": COUPLER, "upper": ROCKER, "crank": 0.05}
    direction, down = radians(80.0), radians(-70.0)
    press = toggle(lengths, direction=direction, bodies=bodies, loads=Loads(force=-300.0, gravity="-70 deg"))
    way = np.array([cos(direction), sin(direction)])

    def loops(unknown: Array, at: float) -> list[float]:
        rod, upper, low, ram = unknown
        knee = np.array([0.28 + 0.2 * cos(upper), 0.2 * sin(upper)])
        first = np.array([0.06 * cos(at) + 0.25 * cos(rod), 0.06 * sin(at) + 0.25 * sin(rod)]) - knee
        second = knee + 0.22 * np.array([cos(low), sin(low)]) - np.array([0.28, 0.0]) - ram * way
        return [*first, *second]

    near = np.array([0.7, 1.8, 1.2, 0.35])
    for at in np.linspace(0.4, x, 41):
        near = fsolve(loops, near, (at,))

    def places(at: float) -> Array:
        """Centres of rod, upper and lower link, the ram, and the three angles."""
        now = near
        for _ in range(4):  # Newton's method to the last digit
            slopes = [(np.array(loops(now + h, at)) - loops(now - h, at)) / 2e-6 for h in 1e-6 * np.eye(4)]
            now = now - np.linalg.solve(np.transpose(slopes), loops(now, at))
        rod, upper, low, ram = now
        pin, knee = np.array([0.06 * cos(at), 0.06 * sin(at)]), np.array([0.28 + 0.2 * cos(upper), 0.2 * sin(upper)])
        centres = [
            pin + placed(COUPLER, rod, (0, 0))[0],
            np.array([0.28, 0.0]) + placed(ROCKER, upper, (0, 0))[0],
            knee + placed(lower, low, (0, 0))[0],
            np.array([0.28, 0.0]) + ram * way,
        ]
        return np.array([*np.concatenate(centres), rod, upper, low, ram])

    rates = numerically(places, x)
    weights = np.array([2.0, 2.0, 1.5, 1.5, 3.0, 3.0, 40.0, 40.0, 0.01, 0.02, 0.01, 0.0])
    assert press.driven_position("ram", x) == pytest.approx(places(x)[-1], abs=1e-12)
    assert press.inertia(x) == pytest.approx(0.05 + weights @ rates**2, rel=1e-8)

    def energy(at: float) -> Array:
        now = places(at)
        heights = -(now[0:8:2] * cos(down) + now[1:8:2] * sin(down))
        return np.asarray(G * np.array([2.0, 1.5, 3.0, 40.0]) @ heights + 300.0 * now[-1])

    assert press.load(x) == pytest.approx(float(numerically(energy, x)), rel=1e-7)


def test_a_traced_function_is_the_slider_crank() -> None:
    def place(x: float) -> dict[str, float]:
        return {"slider": 0.1 * np.cos(x) + np.sqrt(0.4**2 - (0.1 * np.sin(x)) ** 2)}

    x = np.linspace(0.1, 3.0, 7)
    loads = Loads({"0.3 m": "-100 N", "0.5 m": "40 N"}, stiffness="2 N/mm", free="0.35 m")
    written = slider_crank("0.1 m", "0.4 m", bodies={"slider": "5 kg"}, loads=loads, over=("0 deg", "180 deg"))
    read = mechanism_of_motion(place, {"slider": "5 kg"}, loads={"slider": loads}, over=("0 deg", "180 deg"))
    for nu in range(3):
        assert read.inertia(x, nu) == pytest.approx(written.inertia(x, nu), rel=1e-12)
    assert read.load(x) == pytest.approx(written.load(x), rel=1e-12)


@pytest.mark.long
def test_the_law_of_a_linkage_with_long_formulas_is_stored() -> None:
    moved = linkage().dimensionless("200 deg", "-150 deg", "0.3 s")
    assert len(moved.torque) > 10_000
    solution = synthesize(Problem(order=3, basis=Chebyshev(5), minimise=rms(moved.torque)))
    assert solution.objective < rms(moved.torque).value(LAW)
    assert Solution.from_json(solution.to_json()) == solution


@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("ends", [(0.0, 360.0), (-720.0, 1080.0), (30.0, 200.0)])
def test_a_rocker_that_turns_round_is_followed(branch: Literal["open", "crossed"], ends: tuple[float, float]) -> None:
    """A double crank: the coupler keeps its length, and the angle has no jump and turns as often as the crank."""
    over = (f"{ends[0]} deg", f"{ends[1]} deg")
    loads = Loads("s")
    turned = four_bar(0.3, 0.35, 0.32, 0.1, bodies={"rocker": "0.05 kg m^2"}, over=over, branch=branch, loads=loads)
    x = np.linspace(radians(ends[0]), radians(ends[1]), 2001)
    angle, slope = turned.driven_position("rocker", x), turned.driven_position("rocker", x, 1)
    pins = 0.3 * np.exp(1j * x), 0.1 + 0.32 * np.exp(1j * angle)
    assert np.abs(pins[1] - pins[0]) == pytest.approx(0.35, abs=1e-12)
    assert np.diff(angle) == pytest.approx(0.5 * (slope[1:] + slope[:-1]) * np.diff(x), abs=1e-4)
    if ends[1] - ends[0] >= 360.0:
        assert angle[-1] - angle[0] == pytest.approx(x[-1] - x[0], rel=1e-12)
    # without springs the torque does its work over every turn of the rocker
    dragged = four_bar(0.3, 0.35, 0.32, 0.1, bodies={}, over=over, branch=branch, loads=Loads("2 N m"))
    assert np.trapezoid(dragged.load(x), x) == pytest.approx(-2.0 * (angle[-1] - angle[0]), rel=1e-5)
    assert turned.load(x) == pytest.approx(-angle * slope, abs=1e-9)


KNEE = {"crank": "60 mm", "rod": "250 mm", "upper": "200 mm", "lower": "220 mm", "frame": "280 mm"}
MAKE: dict[str, Callable[..., Mechanism]] = {
    "slider crank": lambda **given: slider_crank("0.1 m", "0.4 m", offset="30 mm", **given),
    "four bar": lambda **given: four_bar(*LENGTHS.values(), branch="crossed", **given),
    "toggle": lambda **given: toggle(KNEE, direction="80 deg", **given),
}


@pytest.mark.parametrize(
    ("kind", "link", "at", "other", "beside"),
    [
        ("slider crank", "rod", 0.0, "crank", 0.1),
        ("slider crank", "rod", 0.4, "slider", 0.0),
        ("four bar", "coupler", 0.0, "crank", 0.1),
        ("four bar", "coupler", 0.3, "rocker", 0.25),
        ("toggle", "lower", 0.0, "rod", 0.25),
        ("toggle", "lower", 0.22, "ram", 0.0),
    ],
)
def test_a_mass_at_a_joint_moves_alike_on_either_link(
    kind: str, link: str, at: float, other: str, beside: float
) -> None:
    x = np.linspace(0.05, 6.2, 41)
    loads = Loads(gravity="-70 deg")
    here, there = (
        MAKE[kind](bodies={name: Body(2.0, centre=(place, 0.0))}, loads=loads)
        for name, place in ((link, at), (other, beside))
    )
    for nu in (0, 1):
        assert here.inertia(x, nu) == pytest.approx(there.inertia(x, nu), abs=1e-13)
    assert here.load(x) == pytest.approx(there.load(x), abs=1e-11)
    assert np.ptp(here.load(x)) > 0.1


# --- the slider-crank ---


def press(crank_inertia: float) -> Mechanism:
    return slider_crank("0.1 m", "0.4 m", bodies={"slider": "5 kg", "crank": crank_inertia})


@pytest.fixture(scope="module")
def moved() -> StrokeTorque:
    return press(0.02).dimensionless("0 deg", "180 deg", "0.3 s")


@pytest.mark.parametrize(("crank_inertia", "expected"), [(0.0, 5.992776), (0.02, 7.979021)])
def test_rms_torque_of_the_quintic(crank_inertia: float, expected: float) -> None:
    stroke = press(crank_inertia).dimensionless("0 deg", "180 deg", "0.3 s")
    assert rms(stroke.torque).value(smoothstep(3)) * stroke.unit == pytest.approx(expected, abs=6e-7)


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("degree", "symmetric", "expected"),
    [(5, False, 4.032923), (9, False, 3.989601), (13, False, 3.960253), (9, True, 4.126803)],
)
def test_least_rms_torque(moved: StrokeTorque, degree: int, symmetric: bool, expected: float) -> None:  # noqa: FBT001
    problem = Problem(order=3, basis=Chebyshev(degree), minimise=rms(moved.torque), symmetric=symmetric)
    assert synthesize(problem).objective * moved.unit == pytest.approx(expected, abs=1e-6)


def test_inertia_that_vanishes_at_the_dead_centres() -> None:
    # without inertia of the crank the torque there is that of friction alone
    without = press(0.0).with_friction(coulomb="0.4 N m")
    assert without.inertia(0.0) == 0.0
    assert without.torque(0.0, 3.0, 500.0) == pytest.approx(0.4, abs=1e-12)
    stroke = press(0.0).dimensionless("0 deg", "180 deg", "0.3 s")
    problem = Problem(order=3, basis=Chebyshev(9), minimise=rms(stroke.torque), symmetric=False)
    assert synthesize(problem).objective * stroke.unit == pytest.approx(1.263272, abs=1e-6)


def test_a_stroke_backwards_takes_the_torque_of_its_mirror() -> None:
    # the slider-crank looks the same from both sides, so that the way back takes what the way forth takes
    forth = press(0.02).with_friction(coulomb="1 N m", viscous="0.1 N m s/rad").dimensionless("0 deg", "120 deg", 0.2)
    back = press(0.02).with_friction(coulomb="1 N m", viscous="0.1 N m s/rad").dimensionless("360 deg", "-120 deg", 0.2)
    for law in (smoothstep(3), smoothstep(5)):
        assert rms(back.torque).value(law) * back.unit == pytest.approx(rms(forth.torque).value(law) * forth.unit)
