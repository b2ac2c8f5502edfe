"""Constants and windows of formulas: their optima are those of other programs, and every door takes them."""

import json
import re
from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest
from scipy.optimize import minimize

from optlaws import (
    BSplines,
    Chebyshev,
    InputError,
    Pieces,
    Problem,
    Range,
    SolverFailure,
    Window,
    at_most,
    functional,
    integral,
    maximum,
    peak,
    rms,
    smoothstep,
    synthesize,
    value,
)
from optlaws.verification import verify
from tests.internals.synthesis import CurvedFamily, Outcome, failure, model_of, named, solve, space_of
from tests.synthesis.judge import Judged, broken

PROBLEM = Problem(B=1.8, order=4, basis=Chebyshev(9))


def test_one_line_says_what_thirty_lines_said() -> None:
    assert synthesize(replace(PROBLEM, minimise='rms("c + 3*b")')).objective == pytest.approx(5.123671906731, rel=1e-11)


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("text", "same"), [("peak(c)", "C"), ("rms(c)", "rms_c"), ("peak(j)", "J"), ("peak(c, side=low)", "C_minus")]
)
def test_a_formula_of_a_built_in_constant_has_its_optimum(text: str, same: str) -> None:
    for symmetric in (True, False):
        one, other = (synthesize(replace(PROBLEM, minimise=asked, symmetric=symmetric)) for asked in (text, same))
        assert one.objective == pytest.approx(other.objective, rel=1e-10)
        assert one.status.value == "optimal"


def _last(z: Any) -> float:
    return float(z[-1])


def gridded(text: str, degree: int, count: int) -> float:
    """The least value over symmetric laws with B = 1.8 by SLSQP on a grid, from several starts."""
    constant: Any = named(text)
    space = space_of(Chebyshev(degree), Problem(order=4).conditions, symmetric=True)
    k = (np.arange(count) + 0.5) / count
    half = {nu: space.columns(nu, np.abs(1.0 - 2.0 * k)) for nu in (0, 1, 2, 3)}
    sign = np.where(k > 0.5, -1.0, 1.0)[:, None]
    columns = {"a": half[0] * sign, "b": half[1], "c": half[2] * sign, "j": half[3]}
    columns["a"][k > 0.5, -1] += 1.0
    middle = space.row(1, 0.5)

    def values(z: Any) -> Any:
        point = np.append(z[:-1], 1.0)
        return constant.motion.values({"k": k, **{name: rows @ point for name, rows in columns.items()}})

    constraints: Any = [
        {"type": "ineq", "fun": lambda z: np.concatenate([z[-1] - values(z), z[-1] + values(z)])},
        {"type": "eq", "fun": lambda z: middle @ np.append(z[:-1], 1.0) - 1.8},
        {"type": "ineq", "fun": lambda z: 1.8 - np.abs(columns["b"] @ np.append(z[:-1], 1.0))},
    ]
    best = np.inf
    for seed in range(6):
        start = np.append(np.random.default_rng(seed).normal(size=space.terms) * 0.3 * seed, 20.0)
        options: Any = {"maxiter": 300, "ftol": 1e-12}
        optimum: Any = minimize(_last, start, method="SLSQP", constraints=constraints, options=options)
        if optimum.success:
            best = min(best, float(optimum.fun))
    return best


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    "text", ["peak(c + 0.2*b)", "peak(c^2 + 9*b^2)", "peak(b*c)", "peak((1 + a^2)*c + a*b^2)", "peak(c + 3*a*b)"]
)
def test_another_solver_on_a_grid_finds_nothing_better(text: str) -> None:
    solution = synthesize(replace(PROBLEM, basis=Chebyshev(5), minimise=text))
    other = gridded(text, 5, 400)
    # between its points the other law is higher, by the grid's error
    assert solution.objective == pytest.approx(other, rel=2e-3)
    assert solution.lower_bound <= other * (1.0 + 2e-3)
    assert (solution.status.value == "optimal") == named(text).convex


@pytest.mark.long
def test_extremes_are_sought_where_a_formula_counts_and_has_values() -> None:
    problem = replace(PROBLEM, minimise=peak("c/b", start=0.1, stop=0.9))
    solution = synthesize(problem)
    assert broken(problem, solution.law) == []
    assert solution.objective == pytest.approx(Judged(solution.law).worth(problem.objective), rel=1e-8)
    family = model_of(problem).program.families[0]
    assert isinstance(family, CurvedFamily)
    low, high = family.domain
    places = family.stationary(np.linspace(-0.2, 0.3, len(family.slack)))
    assert (((places >= low) & (places <= high)) | np.isin(places, family.edges)).all()


def test_a_formula_that_no_half_of_a_law_has_alone_needs_one_round() -> None:
    for text in ("peak(c + 0.2*b)", "peak((1 + k)*c)"):
        assert solve(model_of(replace(PROBLEM, minimise=text)).program).rounds == 1


def test_products_are_bounded_where_derivatives_are() -> None:
    problem = Problem(B=1.8, C=at_most(5.5), order=4, basis=Chebyshev(7), minimise="peak(b*c)")
    solution = synthesize(problem)
    assert 4.33 < solution.lower_bound < solution.objective < 4.88
    assert verify(json.loads(json.dumps(solution.to_dict()))).proven
    assert synthesize(replace(problem, minimise="D")).objective == pytest.approx(solution.objective, rel=1e-9)


def test_a_window_that_cannot_be_kept_is_proven_so() -> None:
    from optlaws import InfeasibleProblem

    with pytest.raises(InfeasibleProblem) as caught:
        synthesize(replace(PROBLEM, windows=(Window("c + 0.2*b", high=4.0, start=0.1, stop=0.6),)))
    assert getattr(caught.value.proof, "proves_infeasible", False)


def test_every_door_takes_them() -> None:
    bounded = Problem.from_dict({"order": 4, "B": 1.8, "minimise": "C", "bounds": {"rms(c + 3*b)": [None, 5.2]}})
    # the formula differs for a law's mirror image, and symmetric=True is not given
    assert bounded == replace(PROBLEM, minimise="C", bounds={rms("c + 3*b"): at_most(5.2)}, symmetric=False)
    assert named(rms("c + 3*b").name).value(synthesize(bounded).law) <= 5.2 * (1 + 1e-9)
    assert Problem.from_dict({"order": 4, "windows": ["c + 0.2*b <= 4.5 @ 0.1..0.9"]}).windows == (
        Window("c + 0.2*b", high=4.5, start=0.1, stop=0.9),
    )
    mixed = 0.5 * peak("c + 0.2*b") / 4 + maximum(rms("c"), integral("c^2"))
    assert named("value(c, at=0.3)") == value("c", at=0.3)
    assert replace(PROBLEM, minimise=mixed).objective == mixed
    assert Range().low == 0.0


@pytest.mark.parametrize(
    ("text", "message", "place"),
    [
        ("peak(c + 0.2*v)", "unknown name 'v'; known are a, b, c, d, j, k", 13),
        ("0.5*C + rms(c + 1/(k - 0.5))", "k - 0.5 is 0 within k = 0..1, and it is divided by", 17),
        ("peak(c + log(k))", "log(k) has no finite value at k = 0", 9),
        ("peak(c*tan(3*k))", "tan(3*k) has no finite value within k = 0..1", 7),
        ("peak(k)", "no law changes it", 5),
        ("peak(1 + " + "c*" * 1500 + "b)", "a product may have 24 factors that depend on the law", 9),
        ("peak(b*c + 0.1*abs(b))", 'a maximum of smooth formulas; side="high" is possible', 15),
        ("peak(b*c - 0.1*abs(b))", 'side="low" is possible', 15),
        ("peak(c, side=up)", "unknown side 'up'; known are both, high, low", 0),
        ("peak(c, start=0.6, stop=0.2)", "needs start <= stop", 0),
        ("rms(c, start=0.5, stop=0.5)", "start < stop", 0),
        ("value(c)", "value does not take the arguments", 0),
        ("peak", "peak needs its arguments, such as peak(c + 0.2*b)", 4),
        ("peak(c + )", "expected a number, a name, a function or (", 9),
        ('rms("c + 3*b)', 'expected "', 12),
        ("peak(c.real)", "'.' is not understood", 6),
        ("peak(__import__(c))", "unknown function '__import__'", 5),
    ],
)
def test_an_error_shows_the_place_in_the_text(text: str, message: str, place: int) -> None:
    with pytest.raises(InputError) as caught:
        Problem(order=4, minimise=text)
    assert message in str(caught.value)
    assert str(caught.value).splitlines()[-1] == " " * (2 + place) + "^"


@pytest.mark.sample(3)
@pytest.mark.parametrize(
    ("text", "status"),
    [
        ("integral(abs(c))", "optimal"),
        ("integral(max(c + 3*a - 2, 0)^2)", "optimal"),
        ("rms(max(c, 0))", "optimal"),
        ("integral(max((c + 0.5*b)*b, 0))", "local"),
        ("integral(table(c, -9:9, 0:0, 9:4) + b^2)", "optimal"),
    ],
)
def test_integrals_of_kinks_are_exact_and_bounded(text: str, status: str) -> None:
    problem = replace(PROBLEM, basis=Chebyshev(5), C=at_most(6.0), minimise=text)
    solution = synthesize(problem)
    assert solution.status.value == status
    constant = named(text)
    k = np.linspace(0.0, 1.0, 40_001)
    law = solution.law
    values = np.broadcast_to(
        cast("Any", constant).motion.values({"k": k, "a": law.a(k), "b": law.b(k), "c": law.c(k)}), k.shape
    )
    plain = float(np.trapezoid(values**2 if text.startswith("rms") else values, k))
    assert solution.objective == pytest.approx(plain**0.5 if text.startswith("rms") else plain, rel=1e-6)
    assert solution.objective <= constant.value(synthesize(replace(problem, minimise="J")).law) + 1e-9
    assert solution.lower_bound <= solution.objective * (1.0 + 1e-12)


@pytest.mark.parametrize("text", ["abs(c - 1)", "exp(c)"])
@pytest.mark.parametrize("length", [2.0**-52, 2.0**-51, 2.0**-50, 2.0**-40])
@pytest.mark.parametrize("first", [True, False], ids=["start", "end"])
def test_a_part_may_be_as_short_as_rounding(text: str, length: float, first: bool) -> None:  # noqa: FBT001 - a case
    ends = (0.0, length) if first else (1.0 - length, 1.0)
    law, (start, stop) = smoothstep(3), ends
    assert integral(text, start=start, stop=stop).value(law) == pytest.approx(length, rel=1e-9)
    assert peak(text, side="high", start=start, stop=stop).value(law) == pytest.approx(1.0, rel=1e-9)


def test_what_divides_by_nothing_at_an_end_shows_where() -> None:
    with pytest.raises(InputError) as caught:
        synthesize(replace(PROBLEM, minimise="peak(c + 2*c/b, start=0.1)"))
    assert "ask for a part of the interval" in str(caught.value)
    assert str(caught.value).splitlines()[1:3] == ["  c + 2*c/b", "         ^"]


def test_what_has_no_least_value_or_is_beyond_every_bound_says_so() -> None:
    from optlaws import SolverFailure

    with pytest.raises(SolverFailure, match="no least value"):
        synthesize(replace(PROBLEM, B=None, minimise="value(c, at=0.3)"))
    with pytest.raises(InputError, match="impulses"):
        synthesize(Problem(order=2, basis=BSplines(4, 3, 1), minimise="peak(j)", symmetric=False))


def test_a_function_writes_its_formula_down() -> None:
    import casadi

    written = functional(lambda k, a, b, c, j: c + 0.2 * b + casadi.sin(6 * k) * a - j / 100, side="high")
    assert written.name.startswith("peak(c + 0.2*b + ")
    assert functional(lambda c: 2 * c, kind="value", at=0.3) == named("value(2*c, at=0.3)")
    for one, text in (
        (rms(lambda b, c: c + 3 * b), "rms(c + 3*b)"),
        (functional(lambda c, b: casadi.fmax(casadi.fabs(c), b**2), side="high"), "peak(max(abs(c), b^2), side=high)"),
        (functional(lambda c: c * c, kind="integral"), "integral(c^2)"),
    ):
        assert one == named(text)
    law = synthesize(replace(PROBLEM, minimise=written)).law
    k = np.linspace(0.0, 1.0, 2001)
    values = law.c(k) + 0.2 * law.b(k) + np.sin(6 * k) * law.a(k) - law.j(k) / 100
    assert written.value(law) == pytest.approx(float(values.max()), rel=1e-4)


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda x: x, "a function of some of a, b, c, d, j, k"),
        (lambda c: f"{c}?", "no formula"),
        (lambda c: c.is_zero(), "no law changes it"),
        (lambda c: c > 0, "an operation that formulas do not have"),
    ],
)
def test_a_function_that_writes_no_formula_is_refused(function: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        functional(function)


def test_formulas_without_a_value_where_every_law_comes_by_are_refused() -> None:
    for text, complaint in {
        "peak(c/(b - 1))": "c/(b - 1) has no finite value where b = 1, which every law passes",
        "rms(1/(c - 0.3))": "1/(c - 0.3) has no finite value where c = 0.2998, which every law passes",
        "peak(sqrt(c))": "sqrt(c) has no finite value where c = -1, which every law passes",
        "peak(tan(2*b))": "tan(2*b) has no finite value where b = 0.7852, which every law passes",
        "peak(1/b)": "1/b has no finite value at k = 0, where b = 0 in every law",
    }.items():
        with pytest.raises(InputError, match=re.escape(complaint)):
            synthesize(replace(PROBLEM, minimise=text))


def test_where_no_law_is_found_the_error_says_what_may_have_no_value() -> None:
    nothing = Outcome(None, iterations=42, rounds=1, status="Invalid_Number_Detected")
    error = failure(replace(PROBLEM, basis=Chebyshev(3), minimise="integral(b^0.5)"), nothing)
    assert isinstance(error, SolverFailure)
    assert "mind that b^0.5 has no slope or no value where b <= 0" in str(error)


def test_the_error_says_nothing_of_values_that_no_motion_brings() -> None:
    crank = integral("c/sqrt(1 - (0.25*sin(pi*a))^2) + 1/(c - 7) + 1/(2 + b^2) + log(b)")
    assert crank.remarks == ("1/(c - 7) has no value where c - 7 = 0", "log(b) has no slope or no value where b <= 0")


def test_symmetric_laws_of_uneven_formulas_survive_text() -> None:
    problem = Problem(order=2, minimise="rms((1 + k)*c)", symmetric=True)
    assert eval(repr(problem), {"Problem": Problem, "Chebyshev": Chebyshev}) == problem  # noqa: S307 - a repr of our own
    assert Problem(order=2, minimise="rms((1 + k)*c)") != problem


@pytest.mark.parametrize(
    ("asked", "optimum"),
    [
        ({"windows": (Window("1*c", low=-1.0, high=1.0, start=0.0, stop=0.3),)}, 7.382077137),
        ({"windows": (Window("c", low=-1.0, high=1.0, start=0.0, stop=0.3),)}, 7.382077137),
        ({"windows": (Window("c", low=-1.0, high=1.0, start=0.3, stop=0.7),)}, 4.634920635),
        ({"bounds": {peak("c", stop=0.3): at_most(1.0)}}, 7.382077137),
        ({"bounds": {peak("c*(1 + k)", stop=0.3): at_most(1.0)}}, 7.518154876),
        pytest.param({"bounds": {peak("c^2 + b", stop=0.3): at_most(1.0)}}, 7.462285772, marks=pytest.mark.long),
    ],
)
def test_a_limit_on_a_part_says_nothing_of_what_jumps_at_its_end(asked: dict[str, Any], optimum: float) -> None:
    """The numbers are those of parts that end 1e-7 within the breaks, to the digits that this leaves."""
    problem = Problem(order=2, basis=Pieces([0.0, 0.3, 0.7, 1.0], 4, 1), minimise="C", symmetric=False, **asked)
    solution = synthesize(problem)
    assert solution.status == "optimal"
    assert solution.objective == pytest.approx(optimum, rel=1e-9)
    assert verify(solution.to_dict()).proven


@pytest.mark.parametrize(("text", "optimum"), [("c", 19.75), ("c*(1 + k)", 22.189220183), ("c^2 + b", 20.0875)])
def test_a_limit_on_a_part_of_symmetric_laws_says_nothing_of_what_jumps_at_its_mirrored_end(
    text: str, optimum: float
) -> None:
    """1 - 0.7 is not 0.3 to the last digit; the numbers are those of parts that begin 1e-7 after the break."""
    bounds = {peak(text, start=0.7): at_most(1.0)}
    problem = Problem(
        order=2, basis=Pieces([0.0, 0.3, 0.5, 0.7, 1.0], 4, 1), minimise="C", bounds=bounds, symmetric=True
    )
    solution = synthesize(problem)
    assert solution.status == "optimal"
    assert solution.objective == pytest.approx(optimum, rel=1e-9)
    assert verify(solution.to_dict()).proven


def test_the_best_of_a_formula_that_jumps_is_proven() -> None:
    """Looked at on one side of its breaks alone it led to a law of 21.4."""
    problem = Problem(order=2, basis=Pieces([0.0, 0.3, 0.7, 1.0], 4, 1), minimise="peak(c^2 + b)", symmetric=False)
    solution = synthesize(problem)
    assert solution.status == "optimal"
    k = np.linspace(0.0, 1.0, 20001)
    values = solution.law(k, 2) ** 2 + solution.law(k, 1)
    assert values.max() == pytest.approx(solution.objective, rel=1e-3)
    assert solution.objective == pytest.approx(18.48394415790, rel=1e-10)
