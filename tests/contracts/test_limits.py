"""What every limit does: no law of its class is below it, and the law that is said to attain it does.

A new limit is a line in LIMITS.
"""

import inspect
from collections.abc import Callable, Iterator
from functools import cache, partial
from math import inf, isfinite, nan
from typing import Any, NamedTuple

import numpy as np
import pytest

from optlaws import (
    BoundaryConditions,
    Chebyshev,
    InputError,
    MotionLaw,
    Powers,
    Problem,
    acceleration_limit,
    at_least,
    law_from_z,
    limit,
    limit_law,
    synthesize,
)
from tests.internals.laws import PolynomialSegment, from_half
from tests.internals.synthesis import (
    acceleration_limit_at_jerk,
    best_velocity,
    closed_forms,
    jerk_limit,
    known_limit,
    power_limit,
    rms_limit,
)


class Limit(NamedTuple):
    """The closed form at a B, with the constant it bounds in laws of an order."""

    at: Callable[..., float]
    constant: str
    order: int


LIMITS = {
    "C of end velocities": Limit(partial(acceleration_limit, order=1), "C", 1),
    "C": Limit(acceleration_limit, "C", 2),
    "C of end accelerations zero": Limit(partial(acceleration_limit, order=4), "C", 4),
    "D": Limit(power_limit, "D", 2),
    "J of end accelerations": Limit(partial(jerk_limit, order=2), "J", 2),
    "J": Limit(jerk_limit, "J", 3),
    "rms": Limit(rms_limit, "RMS", 2),
}
VELOCITIES = [1.02, 1.3, 1.5 - 1e-7, 1.5, 1.5 + 1e-7, 1.77, 2.0, 2.4, 3.0, 3.9, 12.0]
K = np.linspace(0.0, 1.0, 401)
JERK_SHARES = [1.0, 1.1, 2.0, 30.0]

each = pytest.mark.parametrize("limits", LIMITS.values(), ids=LIMITS.keys())
each_way = pytest.mark.parametrize("monotone", [False, True], ids=["any", "forth"])


def own(law: MotionLaw, constant: str) -> float:
    constants = law.constants
    return {"C": constants.C.value, "D": constants.D.value, "J": constants.J.value, "RMS": constants.rms_c}[constant]


@cache
def rivals(order: int) -> tuple[MotionLaw, ...]:
    """Laws of stroke 1 with b(1/2) = max b, symmetric about the middle, from rest to rest if the order is above 1."""
    made = [*polynomials(order), *(halves() if order <= 2 else []), *(trapezoids() if order == 3 else [])]
    return tuple(law for law in made if law.b(0.5) > 1.001 and law.extrema(1)[1].value <= law.b(0.5) * (1 + 1e-13))


def polynomials(order: int) -> Iterator[MotionLaw]:
    generator = np.random.default_rng(order)
    for i in range(120):
        even = np.polynomial.Polynomial([0.0, 1.0, -1.0])  # k (1 - k)
        factors = generator.normal(size=1 + i % 4) * 2.0 ** generator.uniform(-1.0, 4.5)
        z = np.polynomial.Polynomial([-0.5, 1.0]) * sum(q * even**n for n, q in enumerate(factors))
        yield law_from_z(BoundaryConditions.rest(order), z.coef.tolist(), Powers(len(z.coef) - 1))


def halves() -> Iterator[MotionLaw]:
    """Accelerations in random steps: near the limits of C, D and the RMS."""
    generator = np.random.default_rng(7)
    for _ in range(60):
        lengths = generator.dirichlet(np.ones(4)) * 0.5
        steps = generator.normal(size=4) + 0.8
        yield from_half([(float(s), PolynomialSegment((float(c),))) for s, c in zip(lengths, steps, strict=True)])


def trapezoids() -> Iterator[MotionLaw]:
    """Accelerations that rise and fall straight: near the limit of J."""
    generator = np.random.default_rng(8)
    for _ in range(60):
        lengths = generator.dirichlet(np.ones(5)) * 0.5
        knots = [0.0, *(generator.normal(size=4) + 0.8).tolist(), 0.0]
        yield from_half(
            [
                (float(s), PolynomialSegment((0.5 * (a + z), 0.5 * (z - a))))
                for s, a, z in zip(lengths, knots, knots[1:], strict=False)
            ]
        )


def test_every_closed_form_has_a_line() -> None:
    public = {name for name, one in inspect.getmembers(closed_forms, inspect.isfunction) if "limit" in name}
    here = {getattr(one.at, "func", one.at).__name__ for one in LIMITS.values()}
    own_names = {name for name in public if getattr(closed_forms, name).__module__ == closed_forms.__name__}
    assert own_names - {"limit", "limit_law", "acceleration_limit_at_jerk"} == here
    assert {one.constant for one in LIMITS.values()} == set(closed_forms.CONSTANTS)


@pytest.mark.sample(3)
@each
@each_way
def test_no_law_is_below(limits: Limit, monotone: bool) -> None:  # noqa: FBT001
    laws = [law for law in rivals(limits.order) if not monotone or law.extrema(1)[0].value >= 0.0]
    assert len(laws) >= 20
    excess = [own(law, limits.constant) / limits.at(law.b(0.5), monotone=monotone) for law in laws]
    assert min(excess) >= 1.0 - 1e-12
    # laws that come nowhere near would prove nothing
    assert min(excess) <= 2.5


@pytest.mark.sample(2)
@each
@each_way
@pytest.mark.parametrize("B", VELOCITIES)
def test_its_law_is_of_its_class_and_attains_it(limits: Limit, B: float, monotone: bool) -> None:  # noqa: FBT001
    law = limit_law(limits.constant, B, order=limits.order, monotone=monotone)
    assert own(law, limits.constant) == pytest.approx(limits.at(B, monotone=monotone), rel=1e-12)
    assert [law.b(0.5), law.constants.B.value] == pytest.approx([B, B], rel=1e-12)
    assert law.a([0.0, 1.0]) == pytest.approx([0.0, 1.0], abs=1e-12)
    assert law.a(K) + law.a(1.0 - K) == pytest.approx(1.0, abs=1e-12)
    assert law.extrema(1)[0].value >= (-1e-12 if monotone else -inf)
    if limits.order > 1:
        assert law.b([0.0, 1.0]) == pytest.approx([0.0, 0.0], abs=1e-12 * B)
    if limits.constant == "J" and limits.order > 2:
        assert law.c([0.0, 1.0]) == pytest.approx([0.0, 0.0], abs=1e-9 * law.constants.C.value)
    assert limit(limits.constant, B, order=limits.order, monotone=monotone) == limits.at(B, monotone=monotone)


@each
@each_way
def test_it_falls_to_the_best_velocity_and_rises_from_there(limits: Limit, monotone: bool) -> None:  # noqa: FBT001
    values = [limits.at(B, monotone=monotone) for B in np.linspace(1.01, 5.0, 120).tolist()]
    if limits.order == 1:
        assert (np.diff(values) > 0.0).all()
        return
    best = best_velocity(limits.constant, limits.order)
    assert limit(limits.constant, order=limits.order) == limits.at(best)
    turn = int(np.argmin(values))
    assert (np.diff(values[: turn + 1]) < 0.0).all()
    assert (np.diff(values[turn:]) > 0.0).all()
    assert min(values) >= limits.at(best)


@each
def test_asking_more_costs_no_less(limits: Limit) -> None:
    for B in VELOCITIES:
        assert limits.at(B) <= limits.at(B, monotone=True)
        least = {"C": 1, "J": 2}.get(limits.constant, 2)
        values = [limit(limits.constant, B, order=order) for order in range(least, 6)]
        assert values == sorted(values)


@each
def test_velocities_and_orders_that_make_no_sense_are_refused(limits: Limit) -> None:
    wrong: list[Any] = [1.0, 0.5, -2.0, nan, inf, "2", None, True, [2.0], 2j]
    for B in wrong:
        with pytest.raises(InputError, match="B must be a finite number above 1"):
            limits.at(B)
    orders: list[Any] = [0, -1, 1.5, "2", True, None]
    for order in orders:
        with pytest.raises(InputError, match="order must be an integer of at least"):
            limit(limits.constant, 2.0, order=order)


@pytest.mark.sample(3)
@each_way
@pytest.mark.parametrize("B", VELOCITIES)
def test_the_acceleration_at_a_jerk_is_attained_and_falls_to_that_of_any_jerk(B: float, monotone: bool) -> None:  # noqa: FBT001
    least = jerk_limit(B, monotone=monotone)
    values = []
    for share in JERK_SHARES:
        C = acceleration_limit_at_jerk(B, share * least, monotone=monotone)
        law = limit_law("C", B, monotone=monotone, J=share * least)
        assert law.constants.C.value == pytest.approx(C, rel=1e-11)
        assert law.constants.J.value == pytest.approx(share * least, rel=1e-7)
        assert law.constants.B.value == pytest.approx(B, rel=1e-12)
        assert law.a(K) + law.a(1.0 - K) == pytest.approx(1.0, abs=1e-12)
        assert law.continuity == 2
        assert law.c([0.0, 1.0]) == pytest.approx([0.0, 0.0], abs=1e-9 * C)
        values.append(C)
    assert values == sorted(values, reverse=True)
    assert values[-1] > acceleration_limit(B, monotone=monotone)
    assert acceleration_limit_at_jerk(B, 1e14, monotone=monotone) == pytest.approx(
        acceleration_limit(B, monotone=monotone), rel=1e-6
    )
    with pytest.raises(InputError, match="J must be a finite number of at least"):
        acceleration_limit_at_jerk(B, 0.99 * least, monotone=monotone)


def test_no_law_has_less_acceleration_at_its_jerk() -> None:
    laws = [*rivals(3), *rivals(4)]
    excess = [law.constants.C.value / acceleration_limit_at_jerk(law.b(0.5), law.constants.J.value) for law in laws]
    assert len(excess) >= 40
    assert 1.0 - 1e-12 <= min(excess) <= 1.2


SOLVED: dict[str, dict[str, Any]] = {
    "C": {"minimise": "C", "B": 1.7},
    "C of one side": {"minimise": "C_plus", "B": 1.7},
    "C at a jerk": {"minimise": "C", "B": 1.6, "J": (0.0, 80.0)},
    "C forth": {"minimise": "C", "B": 2.4, "monotone": True},
    "D": {"minimise": "D", "B": 1.6},
    "J": {"minimise": "J"},
    "rms": {"minimise": "rms_c", "B": 1.8},
    "a sum": {"minimise": "C + 0.1*J", "B": 1.9},
    "the greater of two": {"minimise": "max(C, 0.2*J)", "B": 1.9},
    "C elsewhere": {"minimise": "C", "B": 1.7, "inflexion": 0.4, "symmetric": False},
    "C at a greater B": {"minimise": "C", "B": at_least(2.3)},
}


@pytest.mark.sample(2)
@pytest.mark.parametrize("asked", SOLVED.values(), ids=SOLVED.keys())
def test_the_limit_of_a_problem_is_below_what_is_found(asked: dict[str, Any]) -> None:
    problem = Problem(order=3, basis=Chebyshev(9), **asked)
    known = known_limit(problem)
    solution = synthesize(problem)
    assert known is not None
    assert 0.0 < known <= solution.objective
    assert solution.best_possible == known
    assert solution.objective < 2.5 * known
    assert isfinite(solution.objective)


@pytest.mark.parametrize(
    "asked",
    [
        {"minimise": "snap", "B": 1.7},
        {"minimise": "C", "order": 1},
        {"minimise": "C + snap", "B": 1.7},
        {"minimise": "C", "boundary": BoundaryConditions((0.0, 0.5), (1.0, 0.25))},
    ],
)
def test_where_none_is_known_none_is_stated(asked: dict[str, Any]) -> None:
    order: dict[str, Any] = {} if "order" in asked or "boundary" in asked else {"order": 3}
    assert known_limit(Problem(basis=Chebyshev(9), symmetric="boundary" not in asked, **order, **asked)) is None
