"""Objectives: text and Python say the same, errors point at the character, nothing is evaluated as Python."""

from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import optlaws
from optlaws import (
    FUNCTIONALS,
    B,
    C,
    C_minus,
    C_plus,
    Chebyshev,
    D,
    Expression,
    InputError,
    J,
    Problem,
    maximum,
    rms_c,
    rms_j,
    snap,
    synthesize,
)
from tests.internals.synthesis import parse

pytestmark = pytest.mark.filterwarnings("ignore::optlaws.errors.NotNormalised")
NAMES: dict[str, Any] = {**FUNCTIONALS, "max": maximum}


@pytest.mark.parametrize(
    ("text", "python"),
    [
        ("C", C.expression()),
        ("2*C", 2 * C),
        ("C*2", C * 2),
        ("C/4", C / 4),
        ("0.6*C/4 + 0.4*D/2.25", 0.6 * C / 4 + 0.4 * D / 2.25),
        ("C + C", 2 * C),
        ("3*(C/4 + D/2.25)", 3 * (C / 4 + D / 2.25)),
        ("(C + D)/2", (C + D) / 2),
        ("max(C/4, D/2.25)", maximum(C / 4, D / 2.25).expression()),
        ("max(C, D, J)", maximum(C, D, J).expression()),
        ("2*max(C, D) + J/32", 2 * maximum(C, D) + J / 32),
        ("max(C + J/8, 2*max(D, rms_c))", maximum(C + J / 8, 2 * maximum(D, rms_c)).expression()),
        ("C_plus + C_minus + snap + rms_j + B", C_plus + C_minus + snap + rms_j + B),
        ("1e-3*snap + .5*C + 2.*D + 1E2*J", 1e-3 * snap + 0.5 * C + 2.0 * D + 1e2 * J),
        ("(1 + 2)*3*C/(4*5)", 9 * C / 20),
        ("  C\n+\tD ", C + D),
        ("rms", rms_c.expression()),
        ("((C))", C.expression()),
    ],
)
def test_text_and_python_say_the_same(text: str, python: Expression) -> None:
    expression = parse(text, {**FUNCTIONALS, "rms": rms_c})
    assert expression == python
    assert expression.weights() == pytest.approx(python.weights())
    assert Problem(B=1.6, order=3, minimise=text) == Problem(B=1.6, order=3, minimise=python)


leaf = st.sampled_from(list(FUNCTIONALS.values()))
weight = st.floats(1e-3, 1e3)


@st.composite
def expressions(draw: st.DrawFn, depth: int = 2) -> Expression:
    total: Expression | None = None
    for _ in range(draw(st.integers(1, 3))):
        term: Any = draw(leaf)
        if depth and draw(st.booleans()):
            term = maximum(*(draw(expressions(depth=depth - 1)) for _ in range(draw(st.integers(2, 3)))))
        part = draw(weight) * term
        total = part if total is None else total + part
    assert total is not None
    return total


@given(expression=expressions())
def test_what_is_printed_is_read_back_as_text_and_as_python(expression: Expression) -> None:
    text = repr(expression)
    assert parse(text, FUNCTIONALS) == expression
    assert eval(text, dict(NAMES)).expression() == expression  # noqa: S307
    problem = Problem(B=1.6, order=3, minimise=expression)
    assert problem.minimise == text
    assert problem.objective == expression
    assert Problem.from_dict(problem.to_dict()) == problem
    assert eval(repr(problem), vars(optlaws)) == problem  # noqa: S307


@given(expression=expressions(), factor=weight)
def test_factors_multiply_every_weight(expression: Expression, factor: float) -> None:
    for name, value in (factor * expression).weights().items():
        assert value == pytest.approx(factor * expression.weights()[name])
    for name, value in (expression / factor).weights().items():
        assert value == pytest.approx(expression.weights()[name] / factor)
    doubled = expression + expression
    assert doubled.weights() == pytest.approx((2 * expression).weights())


def test_order_and_brackets_of_a_sum_do_not_matter_to_its_weights() -> None:
    assert ((C + D) + J).weights() == (J + (D + C)).weights()
    assert len((C + C + 2 * C).terms) == 1


# --- errors ---


@pytest.mark.parametrize(
    ("text", "message", "place"),
    [
        ("", "expected a number, a constant, max or (", 0),
        ("   ", "expected a number, a constant, max or (", 3),
        ("C +", "expected a number, a constant, max or (", 3),
        ("C + * D", "expected a number, a constant, max or (", 4),
        ("C D", "expected + * / or the end", 2),
        ("C - D", "terms can only be added", 2),
        ("-C", "expected a number, a constant, max or (", 0),
        ("2 + C", "a number cannot be added", 2),
        ("C + 2", "a number cannot be added", 2),
        ("2", "needs at least one constant", 0),
        ("(1 + 2)*3", "needs at least one constant", 0),
        ("C*D", "two constants of the law cannot be multiplied", 2),
        ("C**2", "expected a number, a constant, max or (", 2),
        ("C^2", "'^' is not understood", 1),
        ("C/D", "the divisor must be a number", 2),
        ("1/0*C", "division by 0", 2),
        ("C/0", "division by 0", 2),
        ("C/0.0", "division by 0", 2),
        ("0*C", "a weight must be above 0", 2),
        ("max()", "expected a number, a constant, max or (", 4),
        ("max(C)", "max needs at least two parts", 6),
        ("max(C, 2)", "a part of max needs a constant", 7),
        ("max(C, D", "expected )", 8),
        ("max C, D", "expected ( after max", 4),
        ("max", "expected ( after max", 3),
        ("(C", "expected )", 2),
        ("C)", "expected + * / or the end", 1),
        ("0.5*C + 0.5*Q", "unknown constant 'Q'", 12),
        ("C @ D", "'@' is not understood", 2),
        ("C; D", "';' is not understood", 1),
        ("'C'", '"\'" is not understood', 0),
        ("C.value", "'.' is not understood", 1),
        ("C[0]", "'[' is not understood", 1),
        ("lambda: C", "':' is not understood", 6),
        ("__import__(C)", "unknown constant '__import__'", 0),
        ("__import__('os')", "is not understood", 11),
        ("exec(C)", "unknown constant 'exec'", 0),
        ("C if D else J", "expected + * / or the end", 2),
        ("C\x00", "is not understood", 1),
        ("С", "", 0),
    ],
)
def test_an_error_shows_the_text_and_points_at_the_character(text: str, message: str, place: int) -> None:
    with pytest.raises(InputError) as caught:
        Problem(B=1.6, order=3, minimise=text)
    complaint = str(caught.value)
    assert message in complaint
    assert complaint.endswith(f"\n  {text}\n  {' ' * place}^")


@pytest.mark.parametrize(
    ("text", "name"), [("snapp", "snap"), ("rmsj", "rms_j"), ("C_pluss", "C_plus"), ("C_minu", "C_minus")]
)
def test_an_unknown_constant_names_the_nearest(text: str, name: str) -> None:
    with pytest.raises(InputError, match=f"did you mean '{name}'"):
        Problem(B=1.6, order=3, minimise=text)


@pytest.mark.parametrize(
    "text",
    [
        "1e999*C",
        "C/1e999",
        "1e308*C*1e308",
        "1e-320*C/1e300",
        "nan*C",
        "inf*C",
        "C" + "+C" * 10_000,
        "(" * 2_000 + "C" + ")" * 2_000,
        "max(C," * 2_000 + "D" + ")" * 2_000,
        "9" * 5_000 + "*C",
        "C*" + "9" * 400,
        "C" * 10_000,
    ],
    ids=lambda text: f"{text[:12]}-{len(text)}",
)
def test_hostile_text_is_refused_or_read_and_never_crashes(text: str) -> None:
    try:
        problem = Problem(B=1.6, order=3, minimise=text)
    except InputError:
        return
    assert all(0.0 < weight < float("inf") for weight, _ in problem.objective.terms)


@given(text=st.text(alphabet="CDJBmax_rs()+-*/,. 0123456789e\n'\"[]{}@", max_size=30))
def test_any_text_is_read_or_refused(text: str) -> None:
    try:
        expression = parse(text, FUNCTIONALS)
    except InputError:
        return
    assert parse(repr(expression), FUNCTIONALS) == expression


@pytest.mark.parametrize(
    "make",
    [
        lambda: C - D,  # type: ignore[operator]
        lambda: C * D,  # type: ignore[operator]
        lambda: C / D,  # type: ignore[operator]
        lambda: 1 / C,  # type: ignore[operator]
        lambda: C**2,  # type: ignore[operator]
        lambda: C + 1,  # type: ignore[operator]
        lambda: 1 + C,  # type: ignore[operator]
        lambda: C + "D",  # type: ignore[operator]
        lambda: -C,  # type: ignore[operator]
        lambda: C * True,
        lambda: True * C,
        lambda: C / True,
        lambda: C * "2",  # type: ignore[operator]
        lambda: (C + D) * None,  # type: ignore[operator]
        lambda: (C + D) + 1,  # type: ignore[operator]
        lambda: (C + D) * (C + D),  # type: ignore[operator]
        lambda: (C + D) - C,  # type: ignore[operator]
        lambda: maximum(C, D) - C,  # type: ignore[operator]
        lambda: C * 1j,  # type: ignore[operator]
    ],
)
def test_expressions_refuse_nonsense(make: Callable[[], object]) -> None:
    with pytest.raises((TypeError, InputError)):
        make()


@pytest.mark.parametrize("factor", [-1, -0.5, float("nan"), float("inf"), -float("inf")])
def test_weights_that_make_no_sense_are_named(factor: float) -> None:
    makers: list[Callable[[], object]] = [lambda: factor * C, lambda: C * factor, lambda: (C + D) * factor]
    for make in makers:
        with pytest.raises(InputError, match="weights in an objective must be finite numbers above 0"):
            make()


def test_a_weight_of_0_leaves_its_term_out() -> None:
    # a sweep of weights starts there
    assert 0 * C / 4 + 1 * D / 2.25 == D / 2.25
    assert Problem(order=4, minimise="0*C/4 + 1*D/2.25") == Problem(order=4, minimise=D / 2.25)
    assert Problem(order=4, minimise="0*C + D") == Problem(order=4, minimise="D")
    for nothing in (0 * C, 0 * (C + D), 0 * C + 0.0 * D):
        with pytest.raises(InputError, match="a weight above 0"):
            Problem(order=4, minimise=nothing)
    with pytest.raises(InputError, match="a weight above 0"):
        maximum(0 * C, D)
    with pytest.raises(InputError, match="a weight must be above 0"):
        Problem(order=4, minimise="max(0*C, D)")


def test_division_by_zero_is_refused() -> None:
    makers: list[Callable[[], object]] = [lambda: C / 0, lambda: (C + D) / 0.0]
    for make in makers:
        with pytest.raises(InputError, match="divided by 0"):
            make()


@pytest.mark.parametrize("parts", [(), (C,), (C, 2), (C, None), (C, "D"), (C, float("nan"))])
def test_a_maximum_of_nonsense_is_refused(parts: tuple[Any, ...]) -> None:
    with pytest.raises(InputError):
        maximum(*parts)


@pytest.mark.parametrize("terms", [(), ((1.0, "C"),), ((1.0, None),), (("1", C),), ((True, C),)])
def test_an_expression_of_nonsense_is_refused(terms: tuple[Any, ...]) -> None:
    with pytest.raises(InputError):
        Problem(B=1.6, order=3, minimise=Expression(terms))


# --- what weights do ---


@pytest.mark.sample(6)
@pytest.mark.parametrize("factor", [1e-6, 0.1, 3.0, 1e6])
@pytest.mark.parametrize("minimise", ["C", "J", "rms_c", "C/8 + J/64", "max(C/4, J/32)", "D"])
def test_a_factor_changes_the_objective_and_not_the_law(minimise: str, factor: float) -> None:
    problem = Problem(B=1.7, order=4, basis=Chebyshev(7), minimise=minimise)
    plain = synthesize(problem)
    scaled = synthesize(Problem(B=1.7, order=4, basis=Chebyshev(7), minimise=factor * problem.objective))
    assert scaled.objective == pytest.approx(factor * plain.objective, rel=1e-10)
    assert scaled.lower_bound == pytest.approx(factor * plain.lower_bound, rel=1e-8)
    assert scaled.status == plain.status
    assert scaled.z == pytest.approx(plain.z, rel=1e-6, abs=1e-5)
