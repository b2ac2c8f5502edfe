"""Cycles are values: nothing of one changes after it was solved; copies, pickles and hashes are of its entries."""

import copy
import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError
from typing import Any

import pytest

from optlaws import Cycle, DiscCam, Drive, Dwell, Free, Mechanism, Motor, Return, Rise, TranslatingRoller

LIMITS: dict[str, Any] = {"acceleration": ["-90 m/s^2", "95 m/s^2"], "velocity": "2 m/s"}
RISE: dict[str, Any] = {"by": "35 mm", "duration": "120 deg", "limits": {"jerk": "90000 m/s^3"}}


def cycle() -> Cycle:
    load = {"period": "20 ms", "damping": 0.05}
    return Cycle(
        [Rise(**RISE), Dwell("90 deg"), Return()], speed="200 rpm", limits=LIMITS, drive={"mass": "2 kg"}, load=load
    )


@pytest.mark.parametrize(
    "change",
    [
        lambda it: it.limits.__setitem__("velocity", "0.65 m/s"),
        lambda it: it.limits.__delitem__("velocity"),
        lambda it: it.limits.__ior__({"velocity": "0.65 m/s"}),
        lambda it: it.limits.update(velocity="0.65 m/s"),
        lambda it: it.limits.setdefault("jerk", "9 m/s^3"),
        lambda it: it.limits.clear(),
        lambda it: it.limits.pop("velocity"),
        lambda it: it.limits.popitem(),
        lambda it: it.limits["acceleration"].append("3 m/s^2"),
        lambda it: it.drive.__setitem__("mass", "3 kg"),
        lambda it: it.load.__setitem__("damping", 0.1),
        lambda it: it.segments[0].limits.__setitem__("jerk", "1 m/s^3"),
        lambda it: it.segments.append(Dwell()),
        lambda it: setattr(it, "limits", {}),
        lambda it: setattr(it.segments[0], "limits", {}),
    ],
)
def test_nothing_of_a_cycle_can_be_changed(change: Callable[[Any], Any]) -> None:
    given = cycle()
    before = given.to_json()
    with pytest.raises((TypeError, AttributeError, FrozenInstanceError)):
        change(given)
    assert given.to_json() == before


def test_what_it_was_made_from_may_change() -> None:
    limits = {"velocity": "2 m/s"}
    given = Cycle([Rise("35 mm", "120 deg"), Return()], speed="200 rpm", limits=limits)
    limits["velocity"] = "0.1 m/s"
    assert given.limits == {"velocity": "2 m/s"}
    via = [("0.1 s", "50 mm")]
    free = Free("60 mm", "0.3 s", via=via)
    via.append(("0.2 s", "55 mm"))
    assert free.via == (("0.1 s", "50 mm"),)


def test_copies_are_equal_and_have_the_same_hash() -> None:
    given = cycle()
    for other in (
        cycle(),
        copy.copy(given),
        copy.deepcopy(given),
        pickle.loads(pickle.dumps(given)),  # noqa: S301 - it was made here
        Cycle.from_json(given.to_json()),
    ):
        assert other == given
        assert hash(other) == hash(given)
        with pytest.raises(TypeError, match="not changed"):
            other.limits["velocity"] = "1 m/s"  # type: ignore[index] # which is what is tested
    assert len({given, cycle()}) == 1
    assert hash(DiscCam(given, "60 mm", TranslatingRoller("12 mm"))) == hash(
        DiscCam(cycle(), "60 mm", TranslatingRoller("12 mm"))
    )
    geared = Drive(Mechanism("0.8 kg m^2"), Motor("3e-4 kg m^2"), ratio=20)
    turning = [
        Cycle([Rise("45 deg", "0.2 s"), Dwell()], period="1 s", advance="45 deg", drive=geared) for _ in range(2)
    ]
    assert len(set(turning)) == 1
