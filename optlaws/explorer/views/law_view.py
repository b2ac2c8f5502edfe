"""Laws as displayed: curves, peaks, constants, residuals, their status, and the path back to the problem."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache, wraps
from typing import Any, TypeAlias

import msgspec
import numpy as np

from optlaws import Chebyshev, MotionLaw, Problem, Range, Solution, Status, residual_vibration, response_spectrum
from optlaws.errors import InfeasibleProblem, InputError, OptlawsError, SolverFailure
from optlaws.explorer.views.panel_data import beside_each_other, panel_data
from optlaws.explorer.views.requests import (
    MOST_DEGREE,
    MOST_ORDER,
    LawRequest,
    LawsRequest,
    law_of,
    problem_of,
    result_of,
    solved,
    without,
)
from optlaws.mechanisms.machine.residual import BandResidual
from optlaws.mechanisms.machine.spectrum import Spectrum, weight_of
from optlaws.motion.piece import factor
from optlaws.motion.quantities import UNITS, either, quantity
from optlaws.numbers import bounded, rounded_up
from optlaws.sentences import Amount
from optlaws.synthesis.limits.of_problem import limited_laws
from optlaws.synthesis.problem.problem import ENTRIES
from optlaws.synthesis.proof.infeasible import possible_velocities
from optlaws.synthesis.status import gap_text
from optlaws.tolerances import BOUND_SLACK

Answer: TypeAlias = Callable[[Any], dict[str, Any]]


TITLES = {Status.OPTIMAL: "proven optimal", Status.LOCAL: "local", Status.INACCURATE: "bound not met"}
_LONG_NUMBER = re.compile(r"\d+\.\d{4,}")

#: from where to where the sliders of entries of a law go, by which step, and the greatest value that is taken
_SLIDERS = {
    "B": (1.05, 2.6, 0.001, None),
    "order": (2, 8, 1, MOST_ORDER),
    "degree": (1, 25, 1, MOST_DEGREE),
    "C": (3.5, 15.0, 0.01, None),
    "D": (2.0, 15.0, 0.01, None),
    "J": (20.0, 300.0, 0.1, None),
    "rms_c": (3.4, 8.0, 0.01, None),
}


def form() -> dict[str, Any]:
    """What the form of a law shows: the entries of its space, and the constants that are weighed and bounded.

    A constant that problems name only among their bounds has the words of its own.
    """
    entries = {name: each.form for name, each in ENTRIES.items()}
    entries["rms_c"] = {"name": "rms_c", "label": "rms c", "about": "RMS acceleration."}

    def shown(name: str) -> dict[str, Any]:
        slider = dict(zip(("low", "high", "step", "most"), _SLIDERS[name], strict=True)) if name in _SLIDERS else None
        return entries[name] | ({"slider": slider} if slider else {})

    return {
        "minimise": entries["minimise"],
        "space": [shown(name) for name in ("B", "order", "degree", "monotone", "symmetric")],
        "constants": [shown(name) for name in ("C", "D", "J", "rms_c")],
    }


def answer(request: LawsRequest) -> dict[str, Any]:
    """A view of each law, or the reason why there is none."""
    return {"laws": [view(msgspec.json.encode(law)) for law in request.laws]}


@lru_cache(maxsize=256)
def view(question: bytes) -> dict[str, Any]:
    """The view of a law that is requested as JSON; an error is reported in its place, so that other laws remain."""
    request = msgspec.json.decode(question, type=LawRequest)
    head = {"title": titled(request)}
    try:
        result = result_of(request)
        return head | {"trust": trust(result) if isinstance(result, Solution) else None} | shown(result)
    except OptlawsError as error:
        return head | {"refused": refusal(error)}


def titled(law: LawRequest) -> str:
    """The title of a law: its own, or what it is."""
    if law.title or law.problem is None:
        return law.title or law.name or "a stored law"
    try:
        return title(problem_of(law))
    except OptlawsError:  # the view says why
        return "a problem"


def refusal(error: OptlawsError, word: str = "not understood") -> dict[str, str]:
    """The reason why there is no law, in words that begin with the wrong input."""
    if not isinstance(error, InfeasibleProblem | SolverFailure):
        return {"word": word, "reason": error.args[0], "tried": ""}
    word = "no such law" if isinstance(error, InfeasibleProblem) else "no law found"
    return {"word": word, "reason": error.args[0], "tried": error.tried}


def refusing(word: str = "not understood") -> Callable[[Answer], Answer]:
    """Let what answers a question say why there is no answer, in place of an error."""

    def decorate(answer: Answer) -> Answer:
        @wraps(answer)
        def answer_or_refusal(request: Any) -> dict[str, Any]:
            try:
                return answer(request)
            except OptlawsError as error:
                return {"refused": refusal(error, word)}

        return answer_or_refusal

    return decorate


def title(problem: Problem) -> str:
    """A short title of a problem."""
    bounds = [*((constant.title, bound) for constant, bound in problem.bounded), ("B", problem.range("B"))]
    texts = [_bound_text(name, bound) for name, bound in bounds if bound is not None]
    size = problem.basis.to_dict().get("degree")
    return ", ".join([f"least {objective_title(problem)}", *texts, f"order {problem.order}", f"degree {size}"])


def _bound_text(name: str, bound: Range) -> str:
    if bound.fixed:
        return f"{name} = {bound.high:g}"
    lower = f"{bound.low:g} ≤ " if bound.low > 0.0 else ""
    return f"{lower}{name}" if bounded(bound.high) is None else f"{lower}{name} ≤ {bound.high:g}"


def objective_title(problem: Problem) -> str:
    """The objective of a problem, with numbers rounded for reading."""
    return _LONG_NUMBER.sub(lambda match: f"{float(match[0]):.4g}", problem.titled(str(problem.minimise)))


def shown(result: MotionLaw | Solution) -> dict[str, Any]:
    """B, C, D, J and the root mean square of c, each as text and as a number, with its place, and the curves."""
    constants = [
        {
            "name": "rms_c" if row.place is None else row.name,
            "text": digits(row.value),
            "value": bounded(row.value),
            "k": "" if row.place is None else f"k = {row.place:.6g}",
        }
        for row in result.constants.summary()
    ]
    panels = [panel_data(panel) | {"symbol": panel.name[-1]} for panel in result.report().panels]
    return {"constants": constants, "panels": panels}


def digits(number: float, count: int = 6) -> str:
    """A number as the page prints it."""
    if bounded(number) is None:
        return "−∞" if number < 0.0 else "∞"
    return f"{number:.{count}g}".replace("-", "−")


def trust(solution: Solution) -> dict[str, Any]:
    """The status and the bounds of a solution as words."""
    facts = [f"{objective_title(solution.problem)} = {digits(solution.objective)}"]
    if bounded(solution.lower_bound) is not None:
        facts.append(f"no law of this problem is below {digits(solution.lower_bound)}")
    if solution.best_possible is not None:
        above = 100.0 * (solution.objective / solution.best_possible - 1.0)
        facts.append(
            f"no {limited_laws(solution.problem)}, of any degree, is below {digits(solution.best_possible)}: "
            f"this one is {digits(above, 3)} % above"
        )
    return verdict(solution.status, gap_text(solution.gap), facts)


def verdict(status: Status, gap: str, facts: Iterable[str], optimal: str = "", *, proof: bool = True) -> dict[str, Any]:
    """How far a result can be trusted: its status with the advice of this or, of an optimum, with other words."""
    advice = optimal if optimal and status is Status.OPTIMAL else status.advice
    word = TITLES.get(status, status.value)
    return {"status": status.value, "word": word, "advice": advice, "gap": gap, "facts": list(facts), "proof": proof}


_FIGURES = 5
_STEPS = (2, 4, 8)


def nearest(request: LawsRequest) -> dict[str, Any]:
    """Single changes of the active problem after which a law exists, with the new values."""
    problem = problem_of(request.law)
    return {"ways": [] if isinstance(solved(problem), Solution) else list(ways(problem))}


def ways(problem: Problem) -> Iterator[dict[str, Any]]:
    """Each way back: the entry to change, its nearest value that has a law, and both in words."""
    if isinstance(problem.B, float):
        for word, B in zip(("raise", "lower"), possible_velocities(problem), strict=True):
            outside = B is not None and (B > problem.B if word == "raise" else B < problem.B)
            if outside and isinstance(solved(replace(problem, B=B)), Solution):
                yield _way("B", B, f"{word} B", problem.B)
    for name in ("C", "D", "J", "rms_c"):
        bound = problem.range(name)
        least = None if bound is None or bound.low > 0.0 else solved(without(problem, name, minimise=name))
        if bound is not None and isinstance(least, Solution) and least.objective > bound.high:
            value = rounded_up(least.objective * (1.0 + BOUND_SLACK), _FIGURES)
            yield _way(name, value, f"raise the bound of {name}", bound.high)
    if isinstance(problem.basis, Chebyshev):
        degree = problem.basis.degree
        higher = (degree + step for step in _STEPS if degree + step <= MOST_DEGREE)
        for value in (each for each in higher if _has_law(replace(problem, basis=Chebyshev(each)))):
            yield _way("degree", value, "raise the degree", degree)
            return


def _has_law(problem: Problem) -> bool:
    """Whether a law exists; the range of possible B is checked first, ten times as fast as a proof of infeasibility."""
    if isinstance(problem.B, float):
        least, greatest = possible_velocities(problem)
        if least is None or least > problem.B or (greatest is not None and greatest < problem.B):
            return False
    return isinstance(solved(problem), Solution)


def _way(entry: str, value: Any, words: str, now: float) -> dict[str, Any]:
    return {"entry": entry, "value": value, "text": f"{words} from {digits(now)} to {digits(value)}"}


_INERTIAS = {"length": ("mass", "N"), "angle": ("moment of inertia", "N m")}


def in_machine_units(request: LawsRequest) -> dict[str, Any]:
    """Peaks of the active law in the units of a machine, by the constant that each comes of."""
    of, time = law_of(request.law).constants, quantity(request.time, "time", "time", above=0.0)
    axis, stroke = either(request.stroke, ("length", "angle"), "stroke")
    sizes = {"B": (of.B.value, 1), "C": (of.C.value, 2), "J": (of.J.value, 3), "rms_c": (of.rms_c, 2)}
    inertia, force = _INERTIAS[axis]
    peaks = {name: value * factor(stroke, time, nu) for name, (value, nu) in sizes.items()}
    units = {name: UNITS[axis][nu] for name, (_, nu) in sizes.items()}
    cells = {name: Amount(abs(peak * units[name][1]), units[name][0], 5) for name, peak in peaks.items()}
    rows = [{"name": f"{request.stroke} in {request.time}", "cells": cells}]
    if request.mass:
        mass = quantity(request.mass, inertia, inertia, above=0.0)
        power = of.D.value * factor(stroke, time, 1) * factor(stroke, time, 2)
        forces = {"C": (peaks["C"], force), "D": (power, "W"), "rms_c": (peaks["rms_c"], force)}
        moved = {name: Amount(mass * abs(size), unit, 5) for name, (size, unit) in forces.items()}
        rows.append({"name": request.mass, "cells": moved})
    return {"rows": rows}


_COUNT = 241
_LOW = 2.0


def residuals(request: LawsRequest) -> dict[str, Any]:
    """Residual and peak acceleration of each law over frequencies, in units of a'', at one frequency, in a band."""
    weight = None if request.spectrum is None else weight_of(request.spectrum, request.duration)
    constant, laws = _constant(request, weight), dict[int, MotionLaw]()
    for i, law in enumerate(request.laws):
        with suppress(OptlawsError):  # the view of this law says why there is none
            laws[i] = law_of(law)
    frequencies = np.union1d(np.linspace(_LOW, request.most, _COUNT), request.frequency)
    spectra = {i: response_spectrum(law, frequencies, request.damping) for i, law in laws.items()}
    curves = [(i, spectrum.report().panels) for i, spectrum in spectra.items()]
    left = {i: float(each.residual_acceleration[frequencies == request.frequency][0]) for i, each in spectra.items()}
    shown = {i: {"text": digits(left[i], 6), "band": _greatest(law, constant)} for i, law in laws.items()}
    return {
        "range": [_LOW, request.most],
        "panels": [panel_data(panel) for panel in (beside_each_other(curves[0][1], curves) if curves else ())],
        "laws": [shown.get(i) for i in range(len(request.laws))],
        "at": request.frequency,
        "weight": [] if weight is None else [list(pair) for pair in weight],
        "band": None if constant is None else [constant.low, constant.high],
        "constant": None if constant is None else str(constant),
    }


def _constant(request: LawsRequest, weight: Spectrum | None) -> BandResidual | None:
    """The greatest residual in the band, weighed where there is a spectrum; None without either."""
    if weight is None and request.band is None:
        return None
    band = request.band
    if weight is not None and band is not None:
        band = max(band[0], weight[0][0]), min(band[1], weight[-1][0])
        if not band[0] < band[1]:
            ends = f"{digits(weight[0][0], 5)} to {digits(weight[-1][0], 5)}"
            raise InputError(f"the spectrum is known from {ends}, where the band is not: move the band there")
    return residual_vibration(frequency=band, damping=request.damping, spectrum=weight)


def _greatest(law: MotionLaw, constant: BandResidual | None) -> dict[str, Any] | None:
    """The greatest residual of a law in the band, and where."""
    peak = None if constant is None else constant.peak(law)
    if peak is None or bounded(peak.value) is None:
        return None
    return {"value": peak.value, "text": digits(peak.value, 6), "at": digits(peak.k, 5)}


def spectrum(request: LawsRequest) -> dict[str, Any]:
    """The duration of the motion in seconds where one is given, for a spectrum that can weigh a band."""
    weight_of(request.spectrum or (), request.duration)
    return {"seconds": None if request.duration is None else quantity(request.duration, "time", "duration", above=0.0)}
