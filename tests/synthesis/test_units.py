"""A problem in another unit is the same problem: same law, same status, objective and bounds times the unit."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from optlaws import (
    FUNCTIONALS,
    C,
    Certificate,
    Chebyshev,
    Expression,
    Functional,
    InfeasibleProblem,
    Machine,
    Pieces,
    Problem,
    ProblemArray,
    Solution,
    Window,
    at_least,
    at_most,
    between,
    integral,
    maximum,
    pareto_front,
    peak,
    proven_front,
    residual_vibration,
    rms,
    sweep,
    synthesize,
    synthesize_array,
    value,
)
from optlaws.synthesis import Term
from optlaws.verification import verify
from tests.internals.synthesis import MAKERS, PLAIN
from tests.sampling import sampled

UNITS = (3.7e-15, 1e12)
SCALES = (1.1, 1.0001, 1e-12, 1e-6, 1e9)
PLACES = np.linspace(0.0, 1.0, 41)


def machine(unit: float) -> Machine:
    return Machine.from_modes([(9.0, 0.02), (31.0, 0.05)], duration=1.0, stroke=unit, outputs=["deflection"])


def asked(minimise: str | Term | Expression, **entries: Any) -> Problem:
    return Problem(**{"order": 3, "basis": Chebyshev(6), "symmetric": False, "minimise": minimise, **entries})


def held(unit: float, limit: float, start: float = 0.0, stop: float = 1.0) -> tuple[Window, ...]:
    formula = f"{unit!r}*c + {0.1 * unit!r}*b"
    return Window(formula, high=limit * unit, start=start, stop=stop), Window(formula, low=-limit * unit)


#: the problem in a unit; of some the objective is in it, of some only what is asked
OBJECTIVES: dict[str, Callable[[float], Problem]] = {
    "peak": lambda u: asked(peak(f"{u!r}*c"), B=1.8),
    "peak of one side": lambda u: asked(peak(f"{u!r}*c", side="high"), B=1.8, J=at_most(120.0)),
    "peak of a sum": lambda u: asked(peak(f"{u!r}*(1 + k)*c + {2.0 * u!r}*b - {u!r}"), B=at_most(2.0)),
    "peak that is bent": lambda u: asked(peak(f"{u!r}*(c^2 + 10*b^2)"), symmetric=True),
    "peak of a maximum": lambda u: asked(peak(f"max({u!r}*c, {0.5 * u!r}*j/10 - {u!r})", side="high"), B=1.8),
    "rms": lambda u: asked(rms(f"{u!r}*(c + 3*b)")),
    "rms of a norm": lambda u: asked(rms(f"norm({u!r}*c, {5.0 * u!r}*b)")),
    "integral": lambda u: asked(integral(f"{u!r}*c^2", start=0.2)),
    "value": lambda u: asked(value(f"{u!r}*j^2 + {u!r}*c", at=0.3), C=at_most(6.5)),
    "weight": lambda u: asked(u * C, B=1.8),
    "sum": lambda u: asked(0.5 * peak(f"{u!r}*c") / 4 + 0.5 * rms(f"{u!r}*j") / 30, B=1.8),
    "maximum": lambda u: asked(maximum(peak(f"{u!r}*c"), 0.1 * peak(f"{u!r}*j")), symmetric=True),
    "pieces": lambda u: asked(peak(f"{u!r}*c + {0.2 * u!r}*b"), basis=Pieces(6, degree=5, continuity=3), B=1.8),
    "power": lambda u: asked(peak(f"{u!r}*d"), B=1.8, symmetric=True),
    "output": lambda u: asked(machine(u).peak(), J=at_most(100.0)),
    "output in the dwell": lambda u: asked(machine(u).peak(within=(1.0, 1.5)), J=at_most(60.0), basis=Chebyshev(3)),
    "rms of an output": lambda u: asked(machine(u).rms(dwell=0.3)),
    "residual": lambda u: asked(machine(u).residual(spread=0.1), J=at_most(80.0)),
    "residual that vanishes": lambda u: asked(machine(u).residual(), C=at_most(9.0)),
}
#: weights of all constants that have a name, those of cams by their frequency
WEIGHED: dict[str, Callable[[float], Problem]] = {
    **{name: partial(lambda constant, u: asked(u * constant, B=1.8), FUNCTIONALS[name]) for name in FUNCTIONALS},
    **{
        name: partial(lambda make, u: asked(u * make(frequency=30.0), B=1.8, order=5), MAKERS[name])
        for name in MAKERS
        if name.endswith("_cam")
    },
    **{name: partial(lambda name, u: asked(f"{u!r}*{name}", B=1.8, symmetric=True), name) for name in PLAIN},
    "residual of a frequency": lambda u: asked(u * residual_vibration(frequency=(18, 22)), J=at_most(80.0)),
    "residual of a mode": lambda u: asked(u * machine(1.0).residual(mode=1), J=at_most(80.0)),
}
CONDITIONS: dict[str, Callable[[float], Problem]] = {
    "bounded peak": lambda u: asked("J", B=1.8, bounds={peak(f"{u!r}*c"): at_most(4.9 * u)}),
    "fixed rms": lambda u: asked("C", bounds={rms(f"{u!r}*c"): between(3.6 * u, 3.6 * u)}),
    "peak from below": lambda u: asked("rms_j", bounds={peak(f"{u!r}*c"): at_least(8.0 * u)}, symmetric=True),
    "bounded output": lambda u: asked("J", bounds={machine(u).peak(): at_most(0.0018 * u)}, basis=Chebyshev(9)),
    "bounded residual": lambda u: asked("C", bounds={machine(u).residual(): at_most(1e-6 * u)}, basis=Chebyshev(9)),
    "window": lambda u: asked("J", B=1.8, windows=held(u, 5.0)),
    "window of a part": lambda u: asked("rms_j", windows=held(u, 2.0, 0.1, 0.2)[:1]),
    "value of a formula": lambda u: asked("J", windows=(Window(f"{u!r}*c - {u!r}*b", u, u, 0.3, 0.3),)),
    "bent window": lambda u: asked("J", B=1.8, windows=(Window(f"{u!r}*(c^2 + b^2)", high=27.0 * u),)),
}
IMPOSSIBLE: dict[str, Callable[[float], Problem]] = {
    "bound": lambda u: asked("J", bounds={peak(f"{u!r}*c"): at_most(3.0 * u)}),
    "window": lambda u: asked("rms_j", B=1.8, windows=held(u, 3.0)),
    "bound of an output": lambda u: asked("J", bounds={machine(u).peak(): at_most(0.0005 * u)}),
    "values": lambda u: asked(
        "C", windows=(Window(f"{u!r}*b", u, u, 0.3, 0.3), Window(f"{u!r}*b", 0.0, 0.0, 0.3, 0.3))
    ),
}


def same(found: Solution, plain: Solution, unit: float) -> None:
    """What a problem in a unit has in common with the problem in the unit 1."""
    assert found.status == plain.status, (found.gap, plain.gap)
    size = unit * plain.problem.objective.scale
    assert found.objective == pytest.approx(unit * plain.objective, rel=1e-9, abs=1e-13 * size)
    assert found.lower_bound == pytest.approx(unit * plain.lower_bound, rel=1e-8, abs=1e-10 * size)
    if abs(plain.objective) > 1e-10 * size:  # many laws leave nothing
        c = plain.law.c(PLACES)
        assert np.abs(found.law.c(PLACES) - c).max() <= 1e-7 * np.abs(c).max()


@cache
def law_of(make: Callable[[float], Problem], unit: float) -> Solution:
    return synthesize(make(unit))


@cache
def solved(make: Callable[[float], Problem], unit: float = 1.0) -> tuple[Solution, list[bool]]:
    solution = law_of(make, unit)
    return solution, [claim.proven for claim in verify(solution.to_dict()).claims]


def check(make: Callable[[float], Problem], unit: float, scaled: float) -> None:
    (plain, proven), (found, other) = solved(make), solved(make, unit)
    same(found, plain, scaled)
    assert other == proven


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("kind", sampled(OBJECTIVES, 3))
def test_an_objective_in_another_unit_has_the_same_law(kind: str, unit: float) -> None:
    check(OBJECTIVES[kind], unit, unit)


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("kind", sampled({**WEIGHED, **OBJECTIVES}, 12))
def test_an_objective_times_a_number_has_the_same_law(kind: str, scale: float) -> None:
    plain, scaled = (law_of({**WEIGHED, **OBJECTIVES}[kind], unit) for unit in (1.0, scale))
    same(scaled, plain, scale)


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("kind", sampled(CONDITIONS, 5))
def test_a_condition_times_a_number_has_the_same_law(kind: str, scale: float) -> None:
    same(law_of(CONDITIONS[kind], scale), law_of(CONDITIONS[kind], 1.0), 1.0)


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("kind", sampled(CONDITIONS, 3))
def test_a_condition_in_another_unit_has_the_same_law(kind: str, unit: float) -> None:
    check(CONDITIONS[kind], unit, 1.0)


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("kind", sampled(IMPOSSIBLE, 4))
def test_what_no_law_keeps_is_infeasible_in_every_unit(kind: str, unit: float) -> None:
    with pytest.raises(InfeasibleProblem) as caught:
        synthesize(IMPOSSIBLE[kind](unit))
    proof = caught.value.proof
    assert isinstance(proof, Certificate)
    assert proof.proves_infeasible
    assert verify(proof.to_dict()).proven


@cache
def tight(unit: float) -> Solution:
    return synthesize(asked(peak(f"{unit!r}*d"), symmetric=True, B=1.8, basis=Chebyshev(3)), bound="tight")


@pytest.mark.sample(2)
@pytest.mark.parametrize("unit", UNITS)
def test_a_tight_bound_is_as_tight_in_every_unit(unit: float) -> None:
    found = tight(unit)
    same(found, tight(1.0), unit)
    assert found.status.value == "optimal"


@pytest.mark.sample(2)
@pytest.mark.parametrize("unit", UNITS)
def test_arrays_sweeps_and_fronts_are_the_same_in_every_unit(unit: float) -> None:
    def both(unit: float) -> tuple[Problem, Functional]:
        constant = peak(f"{unit!r}*c + {0.2 * unit!r}*b")
        return asked(constant, basis=Chebyshev(5)), constant

    (plain, _), (other, constant) = both(1.0), both(unit)
    velocities = np.linspace(1.7, 1.9, 7)
    first, last = (synthesize_array(ProblemArray.of([replace(p, B=B) for B in velocities])) for p in (plain, other))
    assert last.status.tolist() == first.status.tolist() == ["optimal"] * len(velocities)
    np.testing.assert_allclose(last.objective, unit * first.objective, rtol=1e-9)
    np.testing.assert_allclose(last.gap, first.gap, atol=1e-10)
    for mine, single in zip(sweep([replace(other, B=B) for B in velocities]), last, strict=True):
        assert mine.objective == pytest.approx(single.objective, rel=1e-9)
    smooth = replace(other, minimise="J")
    bounded = [replace(smooth, bounds={constant: at_most(unit * most)}) for most in (5.5, 6.0, 6.5)]
    assert [one.status.value for one in sweep(bounded)] == ["optimal"] * 3
    front = proven_front(other, ("B", repr(constant)), between=(1.7, 1.8), gap=1e-5)
    known = proven_front(plain, ("B", repr(both(1.0)[1])), between=(1.7, 1.8), gap=1e-5)
    assert len(front) == len(known)
    assert front(1.75).objective == pytest.approx(unit * known(1.75).objective, rel=1e-7)
    assert verify(front.to_dict()).proven
    over, like = (pareto_front(smooth, over=("J", both(u)[1]), points=5).points for u in (unit, 1.0))
    assert [point.status for point in over] == [point.status for point in like]
    assert [point.objective / unit for point in over] == pytest.approx([point.objective for point in like], rel=1e-6)


@cache
def stage(stroke: float, frequency: float) -> Solution:
    made = Machine.from_modes([(frequency, 0.02)], duration=1.0, stroke=stroke, outputs=["deflection"])
    return synthesize(asked(made.peak(), J=at_most(80.0), basis=Chebyshev(5)))


@pytest.mark.sample(3)
@pytest.mark.parametrize("stroke", [1e-9, 1e-3, 1e3])
@pytest.mark.parametrize("frequency", [40.0, 500.0])
def test_nanopositioners_and_ships_move_alike(stroke: float, frequency: float) -> None:
    found = stage(stroke, frequency)
    assert found.status.value == "optimal"
    same(found, stage(1.0, frequency), stroke)


@pytest.mark.long
@settings(deadline=None, max_examples=60)
@given(st.sampled_from(sorted({**OBJECTIVES, **CONDITIONS})), st.floats(-15.0, 12.0))
def test_every_unit_is_as_good(kind: str, decade: float) -> None:
    unit = 10.0**decade
    if kind in OBJECTIVES:
        check(OBJECTIVES[kind], unit, unit)
    else:
        check(CONDITIONS[kind], unit, 1.0)
