"""Least times with a limit of the vibration that is left, beside shaped laws and by integration of the follower."""

from math import pi, tau
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

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
DEGREE_15 = Problem(order=3, basis=Chebyshev(15))


def left(law: Any, circular: float, damping: float) -> float:  # noqa: ANN401 - a law
    """The residual acceleration after a law in the time 1, by integration of the follower's equation."""

    def slope(k: float, state: Any) -> list[float]:  # noqa: ANN401
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


def test_the_follower_vibrates_no_more(quiet: FastestMove) -> None:
    """At both ends of the spread and between; at its worst as much as is allowed."""
    found = [
        0.1 / quiet.duration**2 * left(quiet.law, tau * hertz * quiet.duration, 0.02)
        for hertz in (15.865, 16.7, 17.535)
    ]
    assert max(found) == pytest.approx(0.5, rel=1e-4)
    assert "residual acceleration" in quiet.binding


def test_what_is_proven_is_without_the_vibration(quiet: FastestMove) -> None:
    without = fastest(DEGREE_15, stroke="100 mm", limits=LIMITS)
    assert quiet.status is Status.LOCAL
    assert quiet.none_below == without.none_below < quiet.duration
    assert all(proof.stands(quiet.least.move) for proof in quiet.least.proofs)
    assert quiet.gains() == {}


def test_law_and_proof_are_one_file(quiet: FastestMove) -> None:
    assert FastestMove.from_json(quiet.to_json()) == quiet
    assert verify(quiet.to_dict()).proven
    data = quiet.to_dict()
    for changes in ({"most": 0.4}, {"highest": 111.0}, {"damping": 1.5}):
        with pytest.raises(InputError):
            FastestMove.from_dict(data | {"residual": data["residual"] | changes})


def test_it_is_faster_than_a_shaped_law_that_leaves_as_much() -> None:
    """Seven segments, shaped by ZV for 16.7 Hz; 5 % off its frequency it leaves what is then allowed here."""
    plain = fastest(Problem(order=3), stroke="100 mm", limits=LIMITS)
    assert plain.limit is not None
    segments = Problem(order=3, basis=Pieces(plain.limit_breaks, degree=3, continuity=2))
    law = fastest(segments, stroke="100 mm", limits=LIMITS).law
    duration = plain.limit + 0.5 / 16.7
    shaped = shaped_law(law, tau * 16.7 * duration, 0.0, "ZV")
    followers = [Follower(tau * hertz * duration) for hertz in (15.865, 17.535)]
    worst = max(follower.response(shaped).residual_acceleration for follower in followers) * 0.1 / duration**2
    limits = LIMITS | {"residual acceleration": f"{worst!r} m/s^2"}
    ours = fastest(DEGREE_15, stroke="100 mm", limits=limits, follower={"frequency": ("15.865 Hz", "17.535 Hz")})
    assert ours.duration < 0.97 * duration


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
        ({"follower": {"frequency": ("18 Hz", "19 Hz", "20 Hz")}}, "the least and the greatest"),
        ({"limits": LIMITS}, "residual acceleration"),
        ({"start_velocity": "0.1 m/s"}, "from rest to rest"),
    ],
)
def test_wrong_followers_are_named(changes: dict[str, Any], named: str) -> None:
    given = {"limits": LIMITS | {"residual acceleration": "1 m/s^2"}, "follower": {"frequency": "16.7 Hz"}}
    with pytest.raises(InputError, match=named):
        fastest(Problem(order=3), stroke="100 mm", **(given | changes))


def test_many_strokes_leave_as_much_as_one_by_one() -> None:
    limits, elastic = LIMITS | {"residual acceleration": "0.5 m/s^2"}, {"frequency": "16.7 Hz", "damping": 0.02}
    moves = fastest_moves(Problem(order=3), strokes=["140 mm", "100 mm"], limits=limits, follower=elastic)
    alone = fastest(Problem(order=3), stroke="100 mm", limits=limits, follower=elastic)
    assert moves[1].duration == pytest.approx(alone.duration, rel=1e-9)
    assert moves[0].least.used["residual acceleration"] <= 1.0 + 1e-9
