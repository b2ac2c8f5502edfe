"""Least times with a limit of the vibration that is left, beside shaped laws and by integration of the follower."""

from math import pi, sqrt, tau
from typing import Any, Literal

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import linprog

from optlaws import (
    Chebyshev,
    FastestMove,
    Follower,
    InputError,
    Pieces,
    Problem,
    Status,
    fastest,
    fastest_moves,
    residual_functional,
    shaped_law,
)
from optlaws.verification import verify

LIMITS = {"velocity": "1 m/s", "acceleration": "12 m/s^2", "jerk": "300 m/s^3"}
SPREAD = {"frequency": ("15.865 Hz", "17.535 Hz"), "damping": 0.02}
DEGREE_15 = Problem(order=3, basis=Chebyshev(9))


def left(law: Any, circular: float, damping: float) -> float:
    """The residual acceleration after a law in the time 1, by integration of the follower's equation."""

    def slope(k: float, state: Any) -> list[float]:
        off, speed = state[0] - float(law(min(k, 1.0))), state[1] - float(law(min(k, 1.0), 1))
        return [state[1], -2.0 * damping * circular * speed - circular**2 * off]

    end = solve_ivp(slope, (0.0, 1.0), [0.0, 0.0], rtol=1e-8, atol=1e-11, max_step=1e-2).y[:, -1]
    damped = circular * np.sqrt(1.0 - damping**2)
    off, speed = end[0] - 1.0, end[1]
    return float(circular**2 * np.hypot(off, (speed + damping * circular * off) / damped))


@pytest.fixture(scope="module")
def quiet() -> FastestMove:
    limits = LIMITS | {"residual acceleration": "0.5 m/s^2"}
    return fastest(DEGREE_15, stroke="100 mm", limits=limits, follower=SPREAD)


@pytest.mark.long
def test_the_follower_vibrates_no_more(quiet: FastestMove) -> None:
    """At both ends of the spread and between; at its worst as much as is allowed."""
    found = [
        0.1 / quiet.duration**2 * left(quiet.law, tau * hertz * quiet.duration, 0.02)
        for hertz in (15.865, 16.7, 17.535)
    ]
    assert max(found) == pytest.approx(0.5, rel=1e-4)
    assert "residual acceleration" in quiet.binding


@pytest.mark.long
def test_boxes_of_times_prove_that_none_is_faster(quiet: FastestMove) -> None:
    without = fastest(DEGREE_15, stroke="100 mm", limits=LIMITS)
    assert quiet.status is Status.OPTIMAL
    assert quiet.gap < 1e-6
    assert quiet.least.proofs[0].longest == without.none_below < quiet.duration
    assert all(proof.stands(quiet.least.move) for proof in quiet.least.proofs)
    assert quiet.gains() == {}


def test_law_and_proof_are_one_file(quiet: FastestMove) -> None:
    assert FastestMove.from_json(quiet.to_json()) == quiet
    assert verify(quiet.to_dict()).proven
    data = quiet.to_dict()
    for changes in ({"most": 0.4}, {"highest": 111.0}, {"damping": 1.5}):
        with pytest.raises(InputError):
            FastestMove.from_dict(data | {"residual": data["residual"] | changes})
    first, box, *others = data["proofs"]
    for proofs in (
        [first, *others],
        [first, box | {"longest": 1.001 * box["longest"]}, *others],
        [first, box | {"certificate": others[0]["certificate"]}, *others],
        [first | {"longest": box["longest"]}, *others],
    ):
        with pytest.raises(InputError, match="proof"):
            FastestMove.from_dict(data | {"proofs": proofs})


@pytest.mark.sample(2)
@pytest.mark.parametrize(("shaper", "periods"), [("ZV", 0.5), ("ZVD", 1.0)])
def test_it_is_faster_than_a_shaped_law_that_leaves_as_much(shaper: Literal["ZV", "ZVD"], periods: float) -> None:
    """Seven segments, shaped for 16.7 Hz; 5 % off its frequency they leave what is then allowed here."""
    plain = fastest(Problem(order=3), stroke="100 mm", limits=LIMITS)
    assert plain.best_possible is not None
    segments = Problem(order=3, basis=Pieces(plain.limit_breaks, degree=3, continuity=2))
    law = fastest(segments, stroke="100 mm", limits=LIMITS).law
    duration = plain.best_possible + periods / 16.7
    shaped = shaped_law(law, tau * 16.7 * duration, 0.0, shaper)
    followers = [Follower(tau * hertz * duration) for hertz in (15.865, 17.535)]
    worst = max(follower.response(shaped).residual_acceleration for follower in followers) * 0.1 / duration**2
    limits = LIMITS | {"residual acceleration": f"{worst!r} m/s^2"}
    follower = {"frequency": ("15.865 Hz", "17.535 Hz")}
    ours = fastest(Problem(order=3), stroke="100 mm", limits=limits, follower=follower)
    assert ours.duration < 0.97 * duration
    assert ours.status is Status.OPTIMAL


def least_share(duration: float, terms: int, hertz: tuple[float, ...], most: float) -> float:
    """The least greatest share of the limits by a linear program: rows at places, frequencies and directions alone."""
    x, weights = np.polynomial.legendre.leggauss(80)
    odd = [np.eye(terms)[i] for i in range(1, terms, 2)]
    places = np.linspace(-1.0, 1.0, 61)

    def columns(function: Any) -> Any:
        return np.array([function(np.polynomial.Chebyshev(each)) for each in odd]).T

    rows = []
    for of, limit in ((-1, 1.0), (0, 12.0), (1, 300.0)):
        values = columns(lambda c, of=of: (2.0**of * (c.integ(lbnd=-1) if of < 0 else c.deriv(of)))(places))
        rows.append(values * 0.1 / duration ** (of + 2) / limit)
    for each in hertz:
        nu = tau * each * duration
        phasors = columns(lambda c, nu=nu: nu * (0.5 * weights * np.exp(0.5j * nu * (1.0 - x))) @ c(x))
        turns = np.exp(1j * np.linspace(0.0, pi, 13))
        rows.append((turns[:, None] * phasors).real * 0.1 / duration**2 / most)
    both = np.vstack([np.vstack(rows), -np.vstack(rows)])
    ends = np.vstack([columns(lambda c: c(-1.0)), columns(lambda c: 0.25 * weights * (1.0 - x) @ c(x))])
    program = linprog(
        [*[0.0] * len(odd), 1.0],
        np.hstack([both, -np.ones((len(both), 1))]),
        np.zeros(len(both)),
        np.hstack([ends, np.zeros((2, 1))]),
        [0.0, 1.0],
        bounds=(None, None),
    )
    assert program.fun is not None
    return float(program.fun)


@pytest.mark.long
def test_no_time_is_skipped_where_longer_ones_are_impossible_again() -> None:
    """36 vibrations in a move: times that are possible are short intervals, of which linear programs show the same."""
    limits = LIMITS | {"residual acceleration": "0.08 m/s^2"}
    move = fastest(
        Problem(order=3, basis=Chebyshev(5)),
        stroke="100 mm",
        limits=limits,
        follower={"frequency": ("150 Hz", "150.4 Hz")},
    )
    assert move.status is Status.OPTIMAL
    law: Any = move.law
    terms = len(law.acceleration)
    below, above = (
        [least_share(time, terms, (150.0, 150.2, 150.4), 0.08) for time in times]
        for times in (
            np.linspace(0.9 * move.duration, 0.9999 * move.duration, 30),
            np.linspace(1.0001 * move.duration, 1.03 * move.duration, 12),
        )
    )
    assert min(below) > 1.0
    assert above[0] < 1.0 < max(above[:-1])


def test_a_limit_that_costs_nothing_is_proven() -> None:
    limits = LIMITS | {"residual acceleration": "100 m/s^2"}
    move = fastest(Problem(order=3), stroke="100 mm", limits=limits, follower={"frequency": "16.7 Hz"})
    assert move.duration == fastest(Problem(order=3), stroke="100 mm", limits=LIMITS).duration
    assert move.status is Status.OPTIMAL


def test_the_residual_is_that_of_the_functional(quiet: FastestMove) -> None:
    law: Any = quiet.law
    circular = 2.0 * pi * 16.7 * quiet.duration
    rows, start = residual_functional(len(law.acceleration), [circular], 0.02)
    assert abs(rows @ law.acceleration + start * law.b0)[0] == pytest.approx(left(law, circular, 0.02), rel=1e-5)


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"follower": None}, "give the follower"),
        ({"follower": {"damping": 0.1}}, "a follower needs its frequency"),
        ({"follower": {"frequncy": "1 Hz"}}, "did you mean 'frequency'"),
        ({"follower": {"frequency": ("18 Hz", "17 Hz")}}, "must be in order"),
        ({"follower": {"frequency": "18 Hz", "damping": 1.0}}, "damping below 1"),
        ({"follower": {"frequency": ("18 Hz", "19 Hz", "20 Hz")}}, "follower: frequency must be a list of 2 at most"),
        ({"limits": LIMITS}, "residual acceleration"),
        (
            {"limits": LIMITS | {"residual displacement": "1 mm"}, "follower": None},
            "displacement is that of a follower",
        ),
        ({"limits": LIMITS | {"residual displacement": "1 deg"}}, "residual displacement must be a length"),
        (
            {"limits": LIMITS | {"residual displacement": "1 mm", "residual acceleration": "1 m/s^2"}},
            "are of one vibration",
        ),
        ({"start_velocity": "0.1 m/s"}, "from rest to rest"),
    ],
)
def test_wrong_followers_are_named(changes: dict[str, Any], named: str) -> None:
    given = {"limits": LIMITS | {"residual acceleration": "1 m/s^2"}, "follower": {"frequency": "16.7 Hz"}}
    with pytest.raises(InputError, match=named):
        fastest(Problem(order=3), stroke="100 mm", **(given | changes))


@pytest.mark.long
def test_many_strokes_leave_as_much_as_one_by_one() -> None:
    limits, elastic = LIMITS | {"residual acceleration": "0.5 m/s^2"}, {"frequency": "16.7 Hz", "damping": 0.02}
    moves = fastest_moves(Problem(order=3), strokes=["140 mm", "100 mm"], limits=limits, follower=elastic)
    alone = fastest(Problem(order=3), stroke="100 mm", limits=limits, follower=elastic)
    assert moves[1].duration == pytest.approx(alone.duration, rel=1e-9)
    assert moves[0].least.used["residual acceleration"] <= 1.0 + 1e-9


def crane(degree: int, **left: str) -> FastestMove:
    """5 m at 0.6 m/s and 0.3 m/s², with a load on a rope of 4 m."""
    limits = {"velocity": "0.6 m/s", "acceleration": "0.3 m/s^2"} | left
    swing = {"frequency": f"{sqrt(9.81 / 4.0) / tau!r} Hz"}
    return fastest(Problem(order=2, basis=Chebyshev(degree)), stroke="5 m", limits=limits, follower=swing)


def test_a_displacement_of_one_frequency_is_its_acceleration_over_the_square() -> None:
    sway = crane(3, **{"residual displacement": "50 mm"})
    left = crane(3, **{"residual acceleration": f"{0.05 * 9.81 / 4.0!r} m/s^2"})
    assert sway.duration == pytest.approx(left.duration, rel=1e-12)
    assert sway.status is Status.OPTIMAL
    assert "residual displacement" in sway.binding
    assert FastestMove.from_json(sway.to_json()) == sway
    assert verify(sway.to_dict()).proven


def sways_in(duration: float, steps: int) -> bool:
    """Whether any acceleration in steps keeps the limits and leaves 20 mm: a linear program, the sway in 64 sides."""
    edges, omega = np.linspace(0.0, duration, steps + 1), sqrt(9.81 / 4.0)
    width, middle = duration / steps, 0.5 * (edges[1:] + edges[:-1])
    # a pendulum on a trolley: y'' + omega^2 y = -acceleration, in each step by its closed form
    swing = np.exp(1j * omega * (duration - middle)) * 2.0 * np.sin(0.5 * omega * width) / omega**2
    turns = np.exp(1j * np.arange(64) * tau / 64.0) / np.cos(pi / 64.0)
    speeds = width * np.tril(np.ones((steps, steps)))
    program = linprog(
        np.zeros(steps),
        np.vstack([speeds, -speeds, (turns[:, None] * swing).real]),
        np.concatenate([np.full(2 * steps, 0.6), np.full(64, 0.02)]),
        np.vstack([np.full(steps, width), width * (duration - middle)]),
        [0.0, 5.0],
        bounds=(-0.3, 0.3),
    )
    return bool(program.status == 0)


@pytest.mark.long
def test_a_crane_is_nearly_as_fast_as_any_motion_that_leaves_its_load_in_20_mm() -> None:
    low, high = 10.0, 12.0
    while high - low > 1e-4:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if sways_in(middle, 400) else (middle, high)
    assert high == pytest.approx(10.867, abs=2e-3)
    assert high < crane(25, **{"residual displacement": "20 mm"}).duration < 1.013 * high


@pytest.mark.long
def test_a_spread_of_frequencies_leaves_no_more_than_the_displacement() -> None:
    limits = LIMITS | {"residual displacement": "0.05 mm"}
    move = fastest(DEGREE_15, stroke="100 mm", limits=limits, follower=SPREAD)
    found = [
        0.1 * left(move.law, tau * hertz * move.duration, 0.02) / (tau * hertz * move.duration) ** 2
        for hertz in (15.865, 16.7, 17.535)
    ]
    assert max(found) == pytest.approx(5e-5, rel=1e-3)
    assert move.status is Status.OPTIMAL
    assert verify(move.to_dict()).proven
