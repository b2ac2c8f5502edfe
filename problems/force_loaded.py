"""Laws of least drive torque under given loads, beside known laws, tabled and drawn."""

from __future__ import annotations

from collections.abc import Mapping
from decimal import ROUND_FLOOR, Context
from math import ceil, log10
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from optlaws import MotionLaw, Problem, Solution, Status, catalogue, drive_torque, peak, rms, synthesize
from optlaws.formulas import NUMPY, evaluate
from optlaws.formulas import read as formula
from optlaws.plots.style import BLUES, GREY, empty_figure, plot_style
from optlaws.results import Cell, Entries, Results

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEADINGS = ("case", "law", "peak torque", "RMS torque", "B", "C", "lower bound", "gap", "status")
_POINTS = 401

Laws = dict[str, tuple[MotionLaw, Solution | None]]


class Case(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A machine: its inertia over a, its friction, and the load over k or a."""

    name: str
    inertia: str = "1"
    friction: str = "0"
    load: str = "0"

    @property
    def torque(self) -> str:
        """The torque that drives it, as the formula of a law."""
        return drive_torque(inertia=self.inertia, friction=self.friction, load=self.load)


class Loads(Entries):
    """The problem file: what all laws keep, the machines, and known laws beside them."""

    problem: dict[str, Any]
    case: list[Case]
    catalogue: list[str]


def run(results: Results) -> None:
    """Put the table, its page and the picture into results."""
    spec = results.read(Loads)
    torques = {case.name: case.torque for case in spec.case}
    cases = {name: (torque, _laws(spec, torque)) for name, torque in torques.items()}
    lines = [_line(case, torque, name, *laws[name]) for case, (torque, laws) in cases.items() for name in laws]
    for torque, laws in cases.values():
        least = {name: laws[f"least {name} torque"][0] for name in ("peak", "RMS")}
        for law, _ in laws.values():
            for name, constant in (("peak", peak), ("RMS", rms)):
                bounded = law.constants.B.value <= 2.2 and law.constants.C.value <= 9.0
                value, best = (constant(torque).value(each) for each in (law, least[name]))
                assert not bounded or best <= value * (1.0 + 1e-6), "no law beside has less torque"
    results.table("table", HEADINGS, lines)
    page = results.page("table").text(spec.text).figure("figure", spec.title).table(HEADINGS, lines, digits=7)
    page.text(
        "\n".join(f"{case}: torque = {torque}; peak {peak(torque).convexity}" for case, torque in torques.items())
    )
    results.picture("figure", draw(spec.title, cases))


def _laws(spec: Loads, torque: str) -> Laws:
    """Known laws, the law of least peak acceleration, and the laws of least peak and least RMS torque."""
    laws: Laws = {name: (catalogue[name].law, None) for name in spec.catalogue}
    objectives = {"least C": "C", "least peak torque": peak(torque).name, "least RMS torque": rms(torque).name}
    for name, minimise in objectives.items():
        solution = synthesize(Problem.from_dict({**spec.problem, "minimise": minimise}))
        laws[name] = (solution.law, solution)
    return laws


def _line(case: str, torque: str, name: str, law: MotionLaw, solution: Solution | None) -> list[Cell]:
    proof: list[Cell] = [None, None, None]
    if solution is not None:
        proof = [_bound(solution), _gap(solution), solution.status.value]
    torques = [constant(torque).value(law) for constant in (peak, rms)]
    return [case, name, *torques, law.constants.B.value, law.constants.C.value, *proof]


def _bound(solution: Solution) -> float:
    """The lower bound; of the phase plane six digits, rounded down, for more depend on the machine."""
    if solution.drive_limit is None:
        return solution.lower_bound
    return float(Context(prec=6, rounding=ROUND_FLOOR).create_decimal_from_float(solution.lower_bound))


def _gap(solution: Solution) -> str:
    """The gap; where it is closed the power of ten above it, for what lies below differs between machines."""
    if solution.status is Status.OPTIMAL:
        return f"1e{ceil(log10(max(solution.gap, 1e-10)))}"
    return f"{solution.gap:.3g}"


def draw(title: str, cases: Mapping[str, tuple[str, Laws]]) -> Figure:
    """A figure of the torque of every law over k, with a panel for each case."""
    with plot_style():
        figure = empty_figure(9.2, 3.2 * len(cases) + 0.6)
        panels = figure.subplots(len(cases), 1, sharex=True, squeeze=False)[:, 0]
        k = np.linspace(0.0, 1.0, _POINTS)
        for axes, (case, (torque, laws)) in zip(panels, cases.items(), strict=True):
            tree = formula(torque, ("k", "a", "b", "c"))
            for i, (name, (law, solution)) in enumerate(laws.items()):
                values = evaluate(tree, {"k": k, "a": law.a(k), "b": law.b(k), "c": law.c(k)}, NUMPY)
                shade = GREY if solution is None else BLUES[-1 - (len(laws) - 1 - i)]
                style = "-" if solution is not None else (0, (1 + 2 * i, 2))
                label = name if axes is panels[0] else None
                axes.plot(k, np.broadcast_to(values, k.shape), color=shade, linestyle=style, label=label)
            axes.set_title(case, loc="left", fontsize=9.5)
            axes.set_ylabel("torque")
            axes.axhline(0.0, color=GREY, linewidth=0.6)
        panels[-1].set_xlabel("k")
        figure.suptitle(title, x=0.01, ha="left", fontsize=11.0)
        figure.legend(loc="outside lower center", ncols=3)
        return figure
