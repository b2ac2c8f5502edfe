"""Laws as the page shows them: curves, peaks, constants, and how far they can be trusted, in words."""

from __future__ import annotations

import re
from functools import lru_cache
from math import isfinite
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from optlaws import MotionLaw, Peak, Problem, Solution, Status
from optlaws.errors import InfeasibleProblem, OptlawsError, SolverFailure
from optlaws.explorer.answers.asked import AskedLaw, AskedLaws, given_law, problem_of, solved
from optlaws.numbers import bounded
from optlaws.synthesis.limits.of_problem import limited_laws

LETTERS = ("a", "b", "c", "d", "j")
_ORDERS = {"a": 0, "b": 1, "c": 2, "j": 3}
_SAMPLES = 161
_DRAWN = 6  # decimals of what is drawn; what is read is a text of its own
HEARD = {Status.OPTIMAL: "proven optimal", Status.LOCAL: "local", Status.INACCURATE: "bound not met"}
_LEAST_GAP = 1e-12
_LONG_NUMBER = re.compile(r"\d+\.\d{4,}")


def answer(asked: AskedLaws) -> dict[str, Any]:
    """A view of each law, or why there is none."""
    return {"laws": [view(msgspec.json.encode(law)) for law in asked.laws]}


@lru_cache(maxsize=256)
def view(question: bytes) -> dict[str, Any]:
    """The view of one law, which is asked as JSON; an error is told in its place, so that the others stand.

    Examples
    --------
    >>> view(b'{"name": "cycloidal"}')["constants"][0]
    {'name': 'B', 'text': '2', 'value': 2.0, 'k': 'k = 0.5'}
    """
    asked = msgspec.json.decode(question, type=AskedLaw)
    try:
        return _given(asked) if asked.problem is None else _optimal(asked)
    except OptlawsError as error:
        name = asked.title or asked.name or "a problem"
        return {"title": name, "refused": {"word": "not understood", "reason": str(error), "tried": ""}}


def refusal(error: InfeasibleProblem | SolverFailure) -> dict[str, str]:
    """Why there is no law, in words.

    Examples
    --------
    >>> refusal(InfeasibleProblem("no law has B < 1", tried="by hand"))
    {'word': 'no such law', 'reason': 'no law has B < 1', 'tried': 'by hand'}
    """
    word = "no such law" if isinstance(error, InfeasibleProblem) else "no law found"
    return {"word": word, "reason": str(error.args[0]), "tried": error.tried}


def _given(asked: AskedLaw) -> dict[str, Any]:
    return {"title": asked.title or asked.name or "a stored law", "trust": None} | shown(given_law(asked))


def _optimal(asked: AskedLaw) -> dict[str, Any]:
    problem = problem_of(asked)
    solution = solved(problem)
    name = {"title": asked.title or title(problem)}
    if not isinstance(solution, Solution):
        return name | {"refused": refusal(solution)}
    return name | {"trust": trust(solution)} | shown(solution.law)


def title(problem: Problem) -> str:
    """What a problem asks, in a few words.

    Examples
    --------
    >>> title(Problem(B=1.7, order=4, minimise="J"))
    'least J, B = 1.7, order 4, degree 9'
    """
    asked = [f"{name} = {r.high:g}" if r.fixed else _range(name, r.low, r.high) for name, r in _ranges(problem)]
    size = problem.basis.to_dict().get("degree")
    return ", ".join([f"least {wanted(problem)}", *asked, f"order {problem.order}", f"degree {size}"])


def wanted(problem: Problem) -> str:
    """What a problem minimises, with numbers that can be read.

    Examples
    --------
    >>> wanted(Problem(order=4, minimise="C/4 + D/2.25"))
    '0.25*C + 0.4444*D'
    """
    return _LONG_NUMBER.sub(lambda match: f"{float(match[0]):.4g}", problem.titled(str(problem.minimise)))


def _ranges(problem: Problem) -> list[tuple[str, Any]]:
    bounds = [(constant.title, asked) for constant, asked in problem.bounds.items()]
    own = [(name, problem.range(name)) for name in ("J", "D", "C", "B")]
    return [(name, asked) for name, asked in (*bounds, *own) if asked is not None]


def _range(name: str, low: float, high: float) -> str:
    upper = "" if bounded(high) is None else f"{name} ≤ {high:g}"
    lower = f"{name} ≥ {low:g}" if low > 0.0 else ""
    return " and ".join(part for part in (lower, upper) if part)


def shown(law: MotionLaw) -> dict[str, Any]:
    """Constants, curves and peaks of a law."""
    return {"constants": constants(law), "curves": curves(law), "peaks": peaks(law)}


def constants(law: MotionLaw) -> list[dict[str, Any]]:
    """B, C, D, J and the root mean square of c, each as text and as a number, with its place."""
    return [
        {
            "name": "rms_c" if row.place is None else row.name,
            "text": digits(row.value),
            "value": bounded(row.value),
            "k": "" if row.place is None else f"k = {row.place:.6g}",
        }
        for row in law.constants.summary()
    ]


def digits(number: float, count: int = 7) -> str:
    """A number as the page prints it.

    Examples
    --------
    >>> digits(1.7), digits(float("inf")), digits(-0.25)
    ('1.7', '∞', '−0.25')
    """
    if bounded(number) is None:
        return "∞"
    return f"{number:.{count}g}".replace("-", "−")


def curves(law: MotionLaw) -> dict[str, list[float | None]]:
    """Values of a, b, c, d and j over k, as they are drawn; None where there is no finite value."""
    k = law.samples(_SAMPLES)[0]
    values = {letter: law.samples(_SAMPLES, nu)[1] for letter, nu in _ORDERS.items()}
    values["d"] = values["b"] * values["c"]
    return {"k": drawn(k)} | {letter: drawn(values[letter]) for letter in LETTERS}


def drawn(values: NDArray[np.float64], decimals: int = _DRAWN) -> list[float | None]:
    """Values to draw: rounded, None where there is none.

    Examples
    --------
    >>> drawn(np.array([1.23456789, np.inf]))
    [1.234568, None]
    """
    rounded = np.round(values, decimals)
    drawn_values: list[float | None] = rounded.tolist()
    return (
        drawn_values
        if np.isfinite(rounded).all()
        else [value if isfinite(value) else None for value in rounded.tolist()]
    )


def peaks(law: MotionLaw) -> dict[str, list[dict[str, Any]]]:
    """The least and the greatest value of each curve but a, where they are finite and not 0."""
    extremes = {letter: law.extrema(nu) for letter, nu in _ORDERS.items() if nu}
    extremes["d"] = law.power_extrema()
    return {letter: [_mark(extreme) for extreme in pair if _seen(extreme, pair)] for letter, pair in extremes.items()}


def _seen(extreme: Peak, pair: tuple[Peak, Peak]) -> bool:
    size = max(abs(other.value) for other in pair)
    return bounded(extreme.value) is not None and abs(extreme.value) > 1e-9 * size


def _mark(peak: Peak) -> dict[str, Any]:
    return {"k": peak.k, "value": peak.value, "text": digits(peak.value, 6)}


def trust(solution: Solution) -> dict[str, Any]:
    """The status and the bounds of a solution as words."""
    name = wanted(solution.problem)
    below = f"no law of this problem is below {digits(solution.lower_bound)}"
    facts = [f"{name} = {digits(solution.objective)}", below]
    if solution.limit is not None:
        above = 100.0 * (solution.objective / solution.limit - 1.0)
        facts.append(
            f"no {limited_laws(solution.problem)}, of any degree, is below {digits(solution.limit)}: this one is "
            f"{digits(above, 3)} % above"
        )
    return {
        "status": solution.status.value,
        "word": HEARD[solution.status],
        "advice": solution.status.advice,
        "gap": gap_text(solution.gap),
        "facts": facts,
    }


def gap_text(gap: float) -> str:
    """The gap in words; what is below 1e-12 is rounding.

    Examples
    --------
    >>> gap_text(0.07), gap_text(3e-14)
    ('gap 7.0e-02', 'gap below 1e-12')
    """
    if bounded(gap) is None:
        return "no bound is known"
    return f"gap {gap:.1e}" if gap > _LEAST_GAP else "gap below 1e-12"
