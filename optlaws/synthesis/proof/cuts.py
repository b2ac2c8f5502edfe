"""Bounds of integrals with kinks by several tangents: where one alone leaves a slope that rounding, or a kink, hides.

At a law in which a formula with kinks vanishes along a stretch, or nearly does, the slope of its integral leaps.
Tangents on all sides of the law, weighted by a linear program, have the slope that the optimum asks for, exactly.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from optlaws.numbers import Array
from optlaws.numerics.tolerances import CUTS_ENOUGH
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.curved import IntegralFamily
from optlaws.synthesis.families.family import ConstraintFamily, LinearFamily, Points
from optlaws.synthesis.families.kinked import KinkedIntegralFamily
from optlaws.synthesis.method.discretised.grids import first_points, with_extrema
from optlaws.synthesis.method.discretised.linear import LinearTable, vertex_on_points
from optlaws.synthesis.program.writer import Model
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.proof.nodes import Contact

_ROUNDS = 24
#: how far beside the law tangents touch at first, in times the greatest variable, and shares of the way to a vertex
_BESIDE = (1e-2, 1e-5, 1e-8)
_SHARES = (1.0, 0.3, 1e-2, 1e-4, 1e-7)
#: how far a vertex may be from the law, in the same
_AROUND = 10.0
_TANGENTS = 600


def needs_tangents(model: Model) -> bool:
    """Whether the program has convex integrals with kinks, and else rows that are straight."""
    families = model.program.families
    kinked = [family for family in families if isinstance(family, KinkedIntegralFamily)]
    others = [family for family in families if not isinstance(family, KinkedIntegralFamily | LinearFamily)]
    return bool(kinked) and not others and all(family.convex for family in kinked)


def by_tangents(model: Model, optimum: ActiveSet, objective: float) -> Certificate | None:
    """The best certificate that tangents around an optimum lead to; None where there is none."""
    return _Tangents(model, optimum).certificate(objective)


class _Tangents:
    def __init__(self, model: Model, optimum: ActiveSet) -> None:
        self.model, self.x = model, optimum.x
        program = model.program
        self.straight = [family for family in program.families if isinstance(family, LinearFamily)]
        self.kinked = [family for family in program.families if isinstance(family, KinkedIntegralFamily)]
        several = with_extrema(program, first_points(program), optimum.x)
        self.points = [
            points.joined(Points(optimum.u[optimum.family == i], optimum.s[optimum.family == i]))
            for i, (family, points) in enumerate(zip(program.families, several, strict=True))
            if isinstance(family, LinearFamily)
        ]
        self.size = max(1.0, float(np.abs(optimum.x).max()))
        self.rows: list[tuple[IntegralFamily, tuple[float, ...], Array]] = []
        self._touch(self.x)
        for way in np.eye(model.space.terms, program.size):
            for reach in _BESIDE:
                for sign in (1.0, -1.0):
                    self._touch(self.x + sign * reach * self.size * way)

    def _touch(self, x: Array) -> None:
        for family in self.kinked:
            point = family.touching(x, 1.0)
            row = family.tangent_row(1.0, 1.0, point)
            if row is not None and np.isfinite(row).all():
                self.rows.append((family, point, row))

    def certificate(self, objective: float) -> Certificate | None:
        """Of the vertices, each of which shows where the next tangents touch."""
        best: Certificate | None = None
        for _ in range(_ROUNDS):
            families, points = self._families()
            program = replace(self.model.program, families=families)
            vertex = vertex_on_points(program, points)
            if vertex is None:
                return best
            table, ends = LinearTable(program, points), np.cumsum([len(held.u) for held in points])
            weights = np.concatenate(vertex.multipliers[:-1]) * table.length
            binding = weights > 0.0
            balanced = table.balanced(binding, weights, vertex.multipliers[-1])
            multipliers, equations = weights.copy(), vertex.multipliers[-1]
            if balanced is not None:
                multipliers[binding], equations = balanced
            proof = self._stated(np.split(multipliers / table.length, ends[:-1]), points, equations)
            best = proof if best is None or proof.bound > best.bound else best
            if best.bound >= objective - CUTS_ENOUGH * max(abs(objective), CUTS_ENOUGH) or len(self.rows) > _TANGENTS:
                return best
            for share in _SHARES:
                self._touch(self.x + share * (vertex.x - self.x))
            straight = replace(self.model.program, families=tuple(self.straight))
            self.points = with_extrema(straight, self.points, vertex.x)
        return best

    def _families(self) -> tuple[tuple[ConstraintFamily, ...], list[Points]]:
        """The straight families, a row for each tangent, and a box that is none of the certificate's."""
        once, families, points = np.ones(1), [*self.straight], [*self.points]
        size = self.model.program.size
        for kinked, _, row in self.rows:
            families.append(LinearFamily(kinked.name, kinked.slack, kinked.bound, (1.0,), (1.0, 1.0), series=row[None]))
            points.append(Points(once, once))
        for way in np.eye(size):
            for sign in (1.0, -1.0):
                row = np.append(sign * way, -sign * float(way @ self.x))[None]
                bound = _AROUND * self.size
                families.append(LinearFamily("box", np.zeros(size), bound, (1.0,), (1.0, 1.0), series=row))
                points.append(Points(once, once))
        return tuple(families), points

    def _stated(self, weights: list[Array], points: list[Points], equations: Array) -> Certificate:
        contacts, unit = [], self.model.unit
        for family, held, own in zip(self.straight, points, weights, strict=False):
            for u, s, weight in zip(held.u, held.s, own, strict=True):
                if weight > 0.0:
                    k = float(min(max(family.k(np.array([u]))[0], 0.0), 1.0))
                    contacts.append(Contact(family.name, float(s), k, float(weight) * (unit / family.unit)))
        for (kinked, point, _), own in zip(self.rows, weights[len(self.straight) :], strict=False):
            if own[0] > 0.0:
                contacts.append(Contact(kinked.name, 1.0, 0.0, float(own[0]) * (unit / kinked.unit), point))
        stated = self.model.program.stated_multipliers(np.asarray(equations))
        return Certificate.of_leaf(self.model.problem, contacts, stated.tolist())
