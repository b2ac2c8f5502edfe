"""The laws that the job "optimal polydyne" compares: members of families, optima beside them, robust and known laws."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from optlaws.kept import kept_property
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.savin.family import SavinFamily
from optlaws.mechanisms.polydyne.cam_constants import cam_constant
from optlaws.mechanisms.polydyne.polydyne import polydyne
from optlaws.mechanisms.spectrum.robust import residual
from optlaws.synthesis import Chebyshev, Problem, Solution, at_most, synthesize


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
