"""The job "optimal polydyne": optimal and robust laws for elastic followers beside known ones, tabled and drawn."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
import numpy as np

from optlaws import drawing
from optlaws.errors import InputError
from optlaws.files import tables, writing
from optlaws.files.problem_file import Text, convert
from optlaws.jobs.pages.page import Page
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.savin.family import SavinFamily
from optlaws.mechanisms.cam.constants import cam_constant
from optlaws.mechanisms.cam.polydyne import polydyne
from optlaws.mechanisms.spectrum.residual import residual_phasor
from optlaws.mechanisms.spectrum.robust import residual
from optlaws.studies.points.problem_entries import gap
from optlaws.synthesis import Chebyshev, Problem, Solution, Status, at_most, synthesize

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure


@dataclass(frozen=True, eq=False)
class Design:
    """For what the cams are made: frequency, damping ratio, the interval and the most residual of robust laws."""

    nu: float
    damping: float
    between: tuple[float, float]
    residual: float
    degree: int

    def problem(self, order: int, minimise: Any, *, of_cam: bool = False, **asked: Any) -> Problem:  # noqa: ANN401 - a constant, and entries
        """Symmetric laws where the cam is undamped: then no other law has a smaller C of the cam.

        The cam of a mass law of order l has order l - 2 and the same degree, so that its Z has four degrees more.
        """
        basis = Chebyshev(self.degree + (4 if of_cam else 0))
        return Problem(order=order, basis=basis, minimise=minimise, symmetric=self.damping == 0.0, **asked)


@dataclass(frozen=True, eq=False)
class Compared:
    """One law: of the mass if the cam is made from it, else of the cam itself; its solution if it is an optimum."""

    name: str
    kind: str
    design: Design
    law: MotionLaw
    polydyne: bool = True
    solution: Solution | None = None

    @kept_property
    def cam(self) -> MotionLaw:
        """What is cut on the cam."""
        return polydyne(self.law, self.design.nu, self.design.damping) if self.polydyne else self.law

    @kept_property
    def worst(self) -> float:
        """The greatest residual acceleration over the interval."""
        return residual(nu=self.design.between, damping=self.design.damping).value(self.cam)

    @kept_property
    def at_design(self) -> float:
        """The residual acceleration at the design frequency."""
        return residual(nu=self.design.nu, damping=self.design.damping).value(self.cam)


def compared(design: Design, members: Sequence[tuple[str, float]], known: Sequence[str]) -> Iterator[Compared]:
    """All laws of a design, in the order of the table."""
    C_cam = cam_constant("C", nu=design.nu, damping=design.damping)
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
    mine = residual(nu=design.between, damping=design.damping, design=design.nu)
    for order in orders:
        solution = synthesize(design.problem(order, C_cam, bounds={mine: most}))
        yield Compared(f"robust polydyne, order {order}", "robust", design, solution.law, solution=solution)
        cut = residual(nu=design.between, damping=design.damping)
        solution = synthesize(design.problem(order - 2, "C", of_cam=True, bounds={cut: most}))
        yield Compared(
            f"robust on the cam, order {order - 2}", "robust", design, solution.law, polydyne=False, solution=solution
        )
    for standard in known:
        yield Compared(f"{standard}, on the cam", "known", design, catalogue[standard].law, polydyne=False)


Positive = Annotated[float, msgspec.Meta(gt=0.0, le=1e3)]
Pair = Annotated[list[Positive], msgspec.Meta(min_length=2, max_length=2)]

HEADINGS = (
    "damping", "law", "B of the mass", "C of the mass", "B of the cam", "C of the cam", "D of the cam", "J of the cam",
    "lower bound of C", "gap", "status", "residual at nu", "greatest residual",
)  # fmt: skip


class Member(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A member of one of Savin's families that a cam can be made from."""

    family: Literal["III", "IV"]
    alpha: float


class Study(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: Text
    nu: Positive
    dampings: Annotated[list[Annotated[float, msgspec.Meta(ge=0.0, lt=1.0)]], msgspec.Meta(min_length=1, max_length=3)]
    between: Pair
    residual: Positive
    degree: Annotated[int, msgspec.Meta(ge=5, le=41)]
    member: Annotated[list[Member], msgspec.Meta(min_length=1, max_length=4)]
    catalogue: list[Text] = []
    figure: Pair
    text: str = ""


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Study, file)
    for name, (low, high) in (("between", spec.between), ("figure", spec.figure)):
        if not low < high:
            raise InputError(f"{name}: must be two frequencies in ascending order, got [{low:g}, {high:g}]")
    members = [(entry.family, entry.alpha) for entry in spec.member]
    low, high = spec.between
    designs = [Design(spec.nu, damping, (low, high), spec.residual, spec.degree) for damping in spec.dampings]
    comparisons = [list(compared(design, members, spec.catalogue)) for design in designs]
    lines = [_line(law) for laws in comparisons for law in laws]
    about = f"{spec.title}; from {file.name}"
    written = [
        writing.write(out / "table.csv", tables.to_csv(HEADINGS, lines, about=about)),
        writing.write(out / "table.md", str(_page(spec, lines))),
    ]
    figure = draw(spec.title, comparisons, (spec.figure[0], spec.figure[1]))
    return written + drawing.save_picture(figure, out / "figure")


def _line(law: Compared) -> list[tables.Cell]:
    mass, cam, solution = law.law.constants, law.cam.constants, law.solution
    bound: list[tables.Cell] = [None, None, None]
    if solution is not None:
        optimal = solution.status is Status.OPTIMAL
        bound = [solution.lower_bound, gap(solution), solution.status.value if not optimal else "optimal"]
    own: list[tables.Cell] = [mass.B.value, mass.C.value] if law.polydyne else [None, None]
    residuals = [0.0 if law.polydyne else law.at_design, law.worst]
    return [
        law.design.damping, law.name, *own, cam.B.value, cam.C.value, cam.D.value, cam.J.value, *bound, *residuals,
    ]  # fmt: skip


def _page(spec: Study, lines: list[list[tables.Cell]]) -> Page:
    interval = f"Greatest residual over nu = {spec.between[0]:g} to {spec.between[1]:g}; nu = {spec.nu:g}."
    page = Page(spec.title).text(spec.text).figure("figure", spec.title)
    return page.text(interval).table(HEADINGS, lines, digits=6)


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
    """Residual accelerations over nu and accelerations over k, for each group two panels for each damping."""
    with drawing.style():
        figure = drawing.figure(9.6, 2 * (3.1 * len(comparisons) + 1.3))
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
        told = f"damping ratio {laws[0].design.damping:g}"
        _residuals(left, laws, between)
        _accelerations(right, laws)
        left.set_title(f"{name}, {told}", fontsize=10.0)
        right.set_title(f"on the cam, {told}", fontsize=10.0)
    panels[-1, 0].set_xlabel("frequency nu of the follower (dimensionless)")
    panels[-1, 1].set_xlabel("k (dimensionless)")
    part.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)


def _residuals(axes: Axes, laws: Sequence[Compared], between: tuple[float, float]) -> None:
    design = laws[0].design
    nu = np.linspace(*between, _POINTS)
    for law, style in zip(laws, _styles(laws), strict=True):
        amplitudes = nu**2 * np.abs(residual_phasor(law.cam, nu, design.damping))
        axes.semilogy(nu, np.maximum(amplitudes, _LEAST / 10), label=law.name, **style)
    axes.axvspan(*design.between, color="#f2f2f2", zorder=0)
    axes.plot(
        design.between, [design.residual] * 2, color="black", linewidth=0.9, linestyle=":", label="most that is asked"
    )
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
        for known, colour, stroke in zip(plain, cycle((*drawing.DISTINCT, "black")), cycle(_STROKES), strict=False)
    ]
