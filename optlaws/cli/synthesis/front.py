"""The command `optlaws front`: exchanges between two or three constants."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Literal

import optlaws
from optlaws.cli.app import Stopped
from optlaws.cli.options import Written, options, takes
from optlaws.cli.problem_options import problem_options
from optlaws.cli.show import Answer, exported
from optlaws.errors import InputError, Interrupted, OptlawsError
from optlaws.numbers import positive, whole
from optlaws.synthesis.problem.named_constants import apart


@takes(
    "Draw the front into this file, PNG or SVG.",
    entries=problem_options(
        {"degree": 9, "basis": "chebyshev"}, refused={"minimise": "the last constant of --over is minimised"}
    ),
    curve=options("optlaws.synthesis.pareto:pareto_front", "points", between={"type": tuple[float, float]}),
)
def front(
    entries: dict[str, Any],
    *,
    over: str | None = None,
    curve: Mapping[str, Any],
    bound: Literal["quick", "tight"] = "quick",
    gap: float | None = None,
    csv: Written = None,
    to: Literal["c99", "iec-st"] | None = None,
    within: float = 1e-3,
    name: str = "Front",
    output: Written = None,
) -> Answer:
    """Find the laws that exchange constants for one another: each the best of its own problem.

    Parameters
    ----------
    over
        Two or three constants, separated by commas, such as "residual(frequency=20),C"; the last is minimised at given
        values of the others. "B,C" unless given, with --to "at_most.B,C".
    bound
        Where D is in the front: tight searches all laws at each point, for a bound that usually meets the objective.
    gap
        Prove the front of two constants at every value between, to this gap relative to the objective; points are then
        values that are shown, and --json is what `optlaws verify` proves.
    csv
        Write the constants of all laws to this file.
    to
        The language of functions, for a front of B and C. They go to --output or, without it, to stdout, and what is
        proven of them to stderr.
    within
        The greatest gap of C at run time; the front is proven to a tenth of it unless --gap says otherwise.
    name
        What every name of a C header begins with, or the name of the function block.
    output
        The file of the functions.
    """
    if gap is not None and bound != "quick":
        raise InputError("--bound tight proves the points of a front, --gap every value between: give one of them")
    if output is not None and to is None:
        raise InputError("--output is where functions of a controller go: say --to c99 or --to iec-st")
    proven_to = positive(within, "within") / 10.0 if to and gap is None else gap
    problem, names = optlaws.Problem.from_dict(entries), tuple(apart(over or ("at_most.B,C" if to else "B,C")))
    front: optlaws.Front | optlaws.ProvenFront
    failure: OptlawsError | None = None
    if proven_to is None:
        try:
            front = optlaws.pareto_front(problem, names, **curve, bound=bound)
        except Interrupted as stopped:
            front, failure = stopped.partial, Stopped(str(stopped))
    else:
        front = optlaws.proven_front(problem, names, between=curve["between"], gap=proven_to)
    points = whole(curve["points"], "points", least=2)
    report = front.report() if isinstance(front, optlaws.Front) else front.report(points)
    if csv is not None:
        from optlaws.files import tables, writing

        stated = front[0].problem if isinstance(front, optlaws.Front) else front.problem
        writing.write(csv, tables.to_csv(*report.tables[0], about=f"{' and '.join(front.over)} exchanged: {stated!r}"))
    if to is not None and isinstance(front, optlaws.ProvenFront):
        return exported(front.export(to, within, name=name), output, front.plot)
    return replace(Answer.of(report, front.plot), failure=failure)
