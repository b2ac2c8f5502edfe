"""Optimal and robust laws for elastic followers beside known ones, tabled and drawn."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import cycle
from math import ceil, log10
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from optlaws import (
    Chebyshev,
    MotionLaw,
    Problem,
    SavinFamily,
    Solution,
    Status,
    at_most,
    cam_constant,
    catalogue,
    polydyne,
    residual_phasor,
    residual_vibration,
    synthesize,
)
from optlaws.plots.style import DISTINCT, empty_figure, plot_style
from optlaws.results import Cell, Entries, Results

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure


@dataclass(frozen=True, eq=False)
class Design:
    """For what the cams are made: frequency, damping ratio, the interval and the most residual of robust laws."""

    frequency: float
    damping: float
    between: tuple[float, float]
    residual: float
    degree: int

    def problem(self, order: int, minimise: Any, *, of_cam: bool = False, **entries: Any) -> Problem:
        """Symmetric laws where the cam is undamped: then no other law has a smaller C of the cam.

        The cam of a mass law of order l has order l - 2 and the same degree, so that its Z has four degrees more.
        """
        basis = Chebyshev(self.degree + (4 if of_cam else 0))
        return Problem(order=order, basis=basis, minimise=minimise, symmetric=self.damping == 0.0, **entries)


@dataclass(frozen=True, eq=False)
class Compared:
    """One law: of the mass if the cam is made from it, else of the cam itself; its solution if it is an optimum."""

    name: str
    kind: str
    design: Design
    law: MotionLaw
    polydyne: bool = True
    solution: Solution | None = None

    @cached_property
    def cam(self) -> MotionLaw:
        """What is cut on the cam."""
        return polydyne(self.law, self.design.frequency, self.design.damping) if self.polydyne else self.law

    @cached_property
    def worst(self) -> float:
        """The greatest residual acceleration over the interval."""
        return residual_vibration(frequency=self.design.between, damping=self.design.damping).value(self.cam)

    @cached_property
    def at_design(self) -> float:
        """The residual acceleration at the design frequency."""
        return residual_vibration(frequency=self.design.frequency, damping=self.design.damping).value(self.cam)


def compared(design: Design, members: Sequence[tuple[str, float]], known: Sequence[str]) -> Iterator[Compared]:
    """All laws of a design, in the order of the table."""
    C_cam = cam_constant("C", frequency=design.frequency, damping=design.damping)
    orders: dict[int, str] = {}
    for family, alpha in members:
        member = SavinFamily.of(family)
        law = member.law(alpha)
        B, order = law.constants.B.value, member.order
        orders[order] = family
        yield Compared(f"family {family}, alpha = {alpha:g}", "known", design, law)
        solution = synthesize(design.problem(order, C_cam, B=B))
        yield Compared(f"optimal, order {order}, same B", "optimal", design, solution.law, solution=solution)
    for order in orders:
        solution = synthesize(design.problem(order, C_cam))
        yield Compared(f"optimal, order {order}, free B", "optimal", design, solution.law, solution=solution)
    most = at_most(design.residual)
    mine = residual_vibration(frequency=design.between, damping=design.damping, design=design.frequency)
    for order in orders:
        solution = synthesize(design.problem(order, C_cam, bounds={mine: most}))
        yield Compared(f"robust polydyne, order {order}", "robust", design, solution.law, solution=solution)
        cut = residual_vibration(frequency=design.between, damping=design.damping)
        solution = synthesize(design.problem(order - 2, "C", of_cam=True, bounds={cut: most}))
        yield Compared(
            f"robust on the cam, order {order - 2}", "robust", design, solution.law, polydyne=False, solution=solution
        )
    for standard in known:
        yield Compared(f"{standard}, on the cam", "known", design, catalogue[standard].law, polydyne=False)


HEADINGS = (
    "damping", "law", "B of the mass", "C of the mass", "B of the cam", "C of the cam", "D of the cam", "J of the cam",
    "lower bound of C", "gap", "status", "residual at nu", "greatest residual",
)  # fmt: skip


class Member(msgspec.Struct):
    """A member of one of Savin's families that a cam can be made from."""

    family: str
    alpha: float


class Study(Entries):
    """The problem file."""

    frequency: float
    dampings: list[float]
    between: tuple[float, float]
    residual: float
    degree: int
    member: list[Member]
    catalogue: list[str]
    figure: tuple[float, float]


def run(results: Results) -> None:
    """Table the laws of every damping ratio with what is proven of them, and draw residuals and accelerations."""
    spec = results.read(Study)
    members = [(entry.family, entry.alpha) for entry in spec.member]
    designs = [Design(spec.frequency, damping, spec.between, spec.residual, spec.degree) for damping in spec.dampings]
    comparisons = [list(compared(design, members, spec.catalogue)) for design in designs]
    rows = [_line(law) for laws in comparisons for law in laws]
    results.table("table", HEADINGS, rows)
    results.picture("figure", draw(spec.title, comparisons, spec.figure))
    page = results.page("table").text(spec.text).figure("figure", spec.title)
    page.text(f"Greatest residual over nu = {spec.between[0]:g} to {spec.between[1]:g}; nu = {spec.frequency:g}.")
    page.table(HEADINGS, rows, digits=6)
    least = {law.name: law.cam.constants.C.value for law in comparisons[0]}
    assert abs(least["optimal, order 4, same B"] - 4.3665175) < 1e-6
    assert abs(least["optimal, order 5, same B"] - 4.557032) < 1e-6
    assert all(
        law.worst <= spec.residual * (1.0 + 1e-6) for laws in comparisons for law in laws if law.kind == "robust"
    )


def _gap(solution: Solution) -> str:
    # the power of ten above it where it is closed, for what lies below differs between machines
    if solution.status is Status.OPTIMAL:
        return f"1e{ceil(log10(max(solution.gap, 1e-10)))}"
    return f"{solution.gap:.3g}"


def _line(law: Compared) -> list[Cell]:
    mass, cam, solution = law.law.constants, law.cam.constants, law.solution
    bound: list[Cell] = [None, None, None]
    if solution is not None:
        bound = [solution.lower_bound, _gap(solution), solution.status.value]
    of_mass: list[Cell] = [mass.B.value, mass.C.value] if law.polydyne else [None, None]
    residuals = [0.0 if law.polydyne else law.at_design, law.worst]
    return [
        law.design.damping, law.name, *of_mass, cam.B.value, cam.C.value, cam.D.value, cam.J.value, *bound, *residuals,
    ]  # fmt: skip


_POINTS = 601
_LEAST = 2e-3


#: what is shown together: pictures of more curves cannot be read
_GROUPS: tuple[tuple[str, Callable[[Compared], bool]], ...] = (
    (
        "Least C of the cam, beside Savin's families",
        lambda compared_law: compared_law.kind == "optimal" or _member(compared_law),
    ),
    (
        "Robust laws, beside standard laws on the cam",
        lambda compared_law: compared_law.kind == "robust" or not compared_law.polydyne,
    ),
)
_STROKES = ("-", (0, (4, 1.5)), "-.", (0, (1, 1.2)))


def draw(title: str, comparisons: Sequence[Sequence[Compared]], between: tuple[float, float]) -> Figure:
    """Residual accelerations over frequencies and accelerations over k, for each group two panels for each damping."""
    with plot_style():
        figure = empty_figure(9.6, 2 * (3.1 * len(comparisons) + 1.3))
        figure.suptitle(title, x=0.01, ha="left", fontsize=11.0)
        parts: Any = figure.subfigures(len(_GROUPS), 1)
        for part, (name, belongs) in zip(parts, _GROUPS, strict=True):
            groups = [[law for law in laws if belongs(law)] for laws in comparisons]
            _draw_group(part, name, [laws for laws in groups if laws], between)
        return figure


def _member(law: Compared) -> bool:
    return law.kind == "known" and law.polydyne


def _draw_group(
    part: SubFigure, name: str, comparisons: Sequence[Sequence[Compared]], between: tuple[float, float]
) -> None:
    if not comparisons:
        return
    panels = part.subplots(len(comparisons), 2, squeeze=False, width_ratios=(3, 2))
    for (left, right), laws in zip(panels, comparisons, strict=True):
        damping = f"damping ratio {laws[0].design.damping:g}"
        _residuals(left, laws, between)
        _accelerations(right, laws)
        left.set_title(f"{name}, {damping}", fontsize=10.0)
        right.set_title(f"on the cam, {damping}", fontsize=10.0)
    panels[-1, 0].set_xlabel("frequency nu of the follower (dimensionless)")
    panels[-1, 1].set_xlabel("k (dimensionless)")
    part.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)


def _residuals(axes: Axes, laws: Sequence[Compared], between: tuple[float, float]) -> None:
    design = laws[0].design
    frequencies = np.linspace(*between, _POINTS)
    for law, style in zip(laws, _styles(laws), strict=True):
        amplitudes = frequencies**2 * np.abs(residual_phasor(law.cam, frequencies, design.damping))
        axes.semilogy(frequencies, np.maximum(amplitudes, _LEAST / 10), label=law.name, **style)
    axes.axvspan(*design.between, color="#f2f2f2", zorder=0)
    axes.plot(design.between, [design.residual] * 2, color="black", linewidth=0.9, linestyle=":", label="upper bound")
    axes.set(xlim=between, ylim=(_LEAST, None), ylabel="residual acceleration")


def _accelerations(axes: Axes, laws: Sequence[Compared]) -> None:
    k = np.linspace(0.0, 1.0, _POINTS)
    for law, style in zip(laws, _styles(laws), strict=True):
        axes.plot(k, law.cam.c(k), **style)
    axes.set(xlim=(0.0, 1.0), ylabel="acceleration c of the cam")


def _styles(laws: Sequence[Compared]) -> list[dict[str, Any]]:
    """A colour for each law of a group, and a stroke, so that they are told apart without colours too."""
    plain = [law.kind == "known" for law in laws]
    return [
        {"color": colour, "linestyle": stroke, "linewidth": 1.2 if known else 1.7}
        for known, colour, stroke in zip(plain, cycle((*DISTINCT, "black")), cycle(_STROKES), strict=False)
    ]


if __name__ == "__main__":
    run(results := Results(__file__))
    results.write()
