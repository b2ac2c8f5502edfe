"""Limits of random drives in units from 1e-9 to 1e9: below every standard law, attained, alike in other units."""

from __future__ import annotations

from collections import Counter
from typing import Any, NamedTuple

import numpy as np
import pytest

from optlaws import Drive, InfeasibleProblem, Mechanism, Motor, MoveLimit, SolverFailure, catalogue
from optlaws.typing import DriveObjective
from optlaws.verification import verify

LAWS = ("345", "cycloidal", "modified sine", "modified trapezoid", "simple harmonic", "parabolic")
KINDS: tuple[DriveObjective, ...] = ("energy", "rms torque", "peak torque", "time")
#: integration of a sheet, and of the motion that a limit has
AGREES = 1e-6


class RandomMove(NamedTuple):
    """A drive with a move of it, in units of torque and time; torques are about 1 in these."""

    seed: int
    torque: float = 1.0
    time: float = 1.0

    @property
    def numbers(self) -> np.random.Generator:
        return np.random.default_rng(self.seed)

    def parts(self) -> tuple[Drive, float, float, float, DriveObjective, float]:
        draw = self.numbers
        kind = KINDS[self.seed % len(KINDS)]
        unit, second = self.torque * 10.0 ** draw.uniform(-9, 9), self.time * 10.0 ** draw.uniform(-3, 3)
        ratio, stroke = 10.0 ** draw.uniform(-3, 3), draw.choice([-1.0, 1.0]) * 10.0 ** draw.uniform(-1, 1)
        start = draw.uniform(-3, 3)
        size = unit * second**2 / abs(stroke) * 10.0 ** draw.uniform(-3, 1)
        bulge = draw.choice([0.0, draw.uniform(0, 3)])
        inertia = f"{size:.17g} + {bulge * size:.17g}*sin(x + {draw.uniform(0, 6):.17g})^2"
        lift, spring = draw.choice([0.0, draw.uniform(-2, 2)]), draw.choice([0.0, draw.uniform(-1, 1)])
        load = f"{unit * lift:.17g} + {unit * spring / abs(stroke):.17g}*(x - {start:.17g})"
        wave = draw.choice([0.0, draw.uniform(-1, 1)])
        coulomb, viscous = (draw.choice([0.0, draw.uniform(0, 0.5)]) for _ in range(2))
        mechanism = Mechanism(
            inertia,
            f"{load} + {unit * wave:.17g}*sin(x)",
            coulomb=coulomb * unit,
            viscous=viscous * unit * second / abs(stroke),
        )
        motor = Motor(draw.choice([0.0, 0.3]) * size / ratio**2)
        shares = draw.choice([1.0, draw.uniform(0.5, 1.0)]), draw.choice([1.0, draw.uniform(0.5, 1.0)])
        drive = Drive(mechanism, motor, ratio, shares, regeneration=float(draw.choice([0.0, 1.0, draw.uniform(0, 1)])))
        return drive, start, stroke, second, kind, 10.0 ** draw.uniform(0.6, 2.0)

    def limits(self) -> dict[str, Any]:
        """An acceleration, and perhaps a velocity over a part of the way."""
        _, start, stroke, second, kind, accelerates = self.parts()
        known: dict[str, Any] = {"acceleration": accelerates * abs(stroke) / second**2}
        if self.seed % 3 == 0 and kind != "peak torque":
            low, high = np.sort(np.random.default_rng(self.seed + 10**6).uniform(0, 1, 2))
            most = 10.0 ** np.random.default_rng(self.seed).uniform(0.2, 0.8) * abs(stroke) / second
            known["velocity"] = [(start + low * stroke, start + high * stroke, most)]
        return known

    def limit(self) -> MoveLimit:
        drive, start, stroke, second, kind, _ = self.parts()
        return drive.limit(kind, start, stroke, None if kind == "time" else second, limits=self.limits())


def keeps(move: RandomMove, law: str, second: float) -> bool:
    """Whether a standard law keeps the limits of a move in a time."""
    _, start, stroke, _, _, _ = move.parts()
    limits, k = move.limits(), np.linspace(0.0, 1.0, 4001)
    of = catalogue[law].law
    if np.max(np.abs(of(k, 2))) * abs(stroke) / second**2 > limits["acceleration"]:
        return False
    for first, last, most in limits.get("velocity", ()):
        low, high = sorted((end - start) / stroke for end in (first, last))
        a = of(k)
        within = (a >= low - 1e-3) & (a <= high + 1e-3)
        if np.any(of(k, 1)[within] * abs(stroke) / second > most):
            return False
    return True


def own_value(move: RandomMove, law: str) -> tuple[float, float]:
    """What a law takes, and the size of the numbers whose difference it is."""
    drive, start, stroke, second, kind, _ = move.parts()
    sheet = drive.sheet(law, start, stroke, second)
    if kind == "energy":
        return sheet.energy, sheet.motoring_energy + sheet.braking_energy
    value = sheet.peak_torque if kind == "peak torque" else sheet.rms_torque
    return value, value


def check(seed: int) -> str:
    """The outcome of a random move: what is claimed of it holds."""
    move = RandomMove(seed)
    _, _, _, second, kind, _ = move.parts()
    try:
        limit = move.limit()
    except InfeasibleProblem as error:
        proven = error.proof is not None and not any(keeps(move, law, second) for law in LAWS)
        return "infeasible" if proven else f"infeasible without a proof, {seed}"
    except SolverFailure:
        return "failure"
    assert limit.attained >= limit.value, (seed, limit.value, limit.attained)
    assert limit.gap >= 0.0, seed
    for law in LAWS if kind != "time" else ():
        if keeps(move, law, second):
            value, size = own_value(move, law)
            assert limit.value <= value + AGREES * size, (seed, law, limit.value, value)
    if kind == "time" and limit.value:
        fast = [law for law in LAWS if keeps(move, law, limit.value * (1.0 - AGREES))]
        assert not fast, (seed, fast)
    if seed % 10 == 0:
        assert verify(limit.to_dict()).proven, seed
        other = RandomMove(seed, torque=2.0**20, time=2.0**-10).limit()
        # the energy is torque times a way without a unit
        factor = 2.0**-10 if kind == "time" else 2.0**20
        assert other.value == pytest.approx(limit.value * factor, rel=1e-6), seed
    return "bound" if limit.value not in {0.0, -np.inf} else "nothing known"


@pytest.mark.parametrize(
    "seed",
    [3, 4, 586, *(pytest.param(seed, marks=pytest.mark.long) for seed in (*range(3), *range(5, 20), 290, 950))],
)
def test_a_random_drive_takes_no_less_than_its_limit(seed: int) -> None:
    assert check(seed) in {"bound", "infeasible", "nothing known"}


@pytest.mark.parametrize(
    ("seed", "gap"),
    [
        (50, 1e-4),
        *(pytest.param(*case, marks=pytest.mark.long) for case in [(142, 0.5), (274, 1e-3), (348, 0.6), (350, 1e-2)]),
    ],
)
def test_a_bound_and_a_motion_are_known_of_loads_that_help_or_rub(seed: int, gap: float) -> None:
    limit = RandomMove(seed).limit()
    assert 0.0 < limit.value <= limit.attained <= limit.value * (1.0 + gap)


@pytest.mark.long
def test_a_thousand_random_drives_take_no_less_than_their_limits() -> None:
    counts = Counter(check(seed) for seed in range(20, 1020))
    assert counts.keys() <= {"bound", "infeasible", "nothing known", "failure"}
    assert counts["failure"] <= 10
    assert counts["bound"] >= 700
