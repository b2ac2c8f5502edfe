"""Sums over the motions of a cycle: integrals over their laws of squares, of energy and of heat, and their bounds.

What a cycle takes in all is the sum of what its motions take. Energy is the integral of the power that is above 0, less
the share of the braking power that is fed back; heat is what the winding of a motor and its brake resistor burn.
Without losses in the gear and without viscous friction motoring and braking energy differ by what is known of the ends:
the work against the load and the gain of kinetic energy. Then the heat consists of the motoring energy, which is convex
in the phase plane.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf, sqrt
from typing import TYPE_CHECKING

from optlaws.cycles.optimisation.drive_formulas import along, driven_formula, driven_mean, known_drive, moved
from optlaws.cycles.specification.joints import LawSpan
from optlaws.errors import InputError
from optlaws.motion.piece import Piece, factor
from optlaws.motion.quantity_kinds import Kind
from optlaws.motion.smooth_parts import SmoothParts
from optlaws.synthesis.functionals.makers import integral
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.search import limit_beside
from optlaws.synthesis.solution import Solution

if TYPE_CHECKING:
    from optlaws.mechanisms.drives.drive_train import Drive

NO_HEAT = (
    "minimise: heat is that of a motor's winding and of its brake resistor: give drive=Drive(...) with a motor that "
    "has a motor constant, such as Motor('3e-4 kg m^2', constant=0.3), in N m/√W"
)


@dataclass(frozen=True)
class SpanSum:
    """An integral over a span's law in SI units: `unit` times the integral of a formula, plus a constant.

    `beneath` are formulas whose integrals are never greater, in whose phase plane bounds are proven; `least` is what
    the sum is at least, whatever the law.
    """

    formula: str
    unit: float
    constant: float = 0.0
    beneath: tuple[str, ...] = ()
    least: float = -inf

    def bound(self, solution: Solution, *, exact: bool = True) -> float:
        """The lower bound of the laws of a problem, in SI units, from its solution and from phase planes.

        Where the problem is not exact, its solution proves nothing.
        """
        proven = max(solution.lower_bound if exact else -inf, self._of_planes(solution.problem))
        return max(self.unit * proven + self.constant, self.least)

    def _of_planes(self, problem: Problem) -> float:
        limits = (limit_beside(replace(problem, minimise=integral(formula))) for formula in self.beneath)
        return max((limit.value for limit in limits if limit is not None), default=-inf)


def span_sum(span: LawSpan, kind: Kind, drive: Drive | None, stroke: float) -> SpanSum:
    """The integrand over a span: the square of a derivative or of the force, energy or heat."""
    nu = kind.order
    if nu:
        return SpanSum(f"{'abcj'[nu]}^2", factor(stroke, span.duration, nu) ** 2 * span.duration)
    if kind is Kind.FORCE:
        driven = driven_mean(span, drive, stroke)
        # in the direction of the stroke, as phase planes have it
        force = (
            f"-({driven.formula})"
            if drive is not None and drive.linear is not None and stroke < 0.0
            else driven.formula
        )
        return SpanSum(f"({force})^2", driven.unit**2 * span.duration, driven.friction * span.duration)
    from optlaws.mechanisms.linkages.dimensionless import recovering

    known = known_drive(drive)
    # a span that may turn back is refused as it is for forces
    force, unit = driven_formula(span, known, stroke, Kind.FORCE)
    if kind is Kind.HEAT:
        return _heat(span, known, stroke)
    least = _least_energy(span, known, stroke)
    if known.linear is None:
        over = moved(span, known, stroke)
        branches = over.branches if known.train.loses else ()
        beneath = tuple(recovering([f"({branch})*b"], known.regeneration) for branch in branches)
        return SpanSum(over.energy, over.energy_unit, beneath=beneath, least=least)
    power = f"({force})*b" if stroke > 0.0 else f"(-({force}))*b"
    return SpanSum(recovering([power], known.regeneration), unit * known.ratio * abs(stroke), least=least)


def sum_of_piece(piece: Piece, kind: Kind, drive: Drive | None) -> float:
    """A piece's contribution to a sum, in SI units."""
    if kind.order:
        return piece.duration * piece.mean_square(kind.order)
    taken = along(drive, piece)
    if kind is Kind.FORCE:
        return taken.square
    return taken.energy if kind is Kind.ENERGY else taken.heat


def size_of(piece: Piece, kind: Kind, drive: Drive | None, *, mean: bool = False) -> float:
    """The peak or RMS of a derivative, or of the force or power of a drive, in a piece, in SI units."""
    nu = kind.order
    if nu or drive is None:
        if not piece.stroke:
            return 0.0
        constant = piece.law.rms(nu) if mean else piece.law.peak(nu).value
        return constant * abs(factor(piece.stroke, piece.duration, nu))
    taken = along(drive, piece)
    if kind is Kind.POWER:
        return max(taken.powers)
    return sqrt(taken.square / piece.duration) if mean else taken.peak_force.value


def total(pieces: Sequence[Piece], kind: Kind, drive: Drive | None) -> float:
    """A sum over pieces, in SI units."""
    return sum(sum_of_piece(piece, kind, drive) for piece in pieces)


def _least_energy(span: LawSpan, drive: Drive, stroke: float) -> float:
    """What the energy of a span is at least, J: the work along its stroke, of which no more than a share comes back."""
    if drive.mechanism.varies:
        return -inf
    work = _work(span, drive, stroke)
    return max(work, drive.regeneration * work)


def _heat(span: LawSpan, drive: Drive, stroke: float) -> SpanSum:
    """The copper heat of a motor and the braking energy that is not fed back."""
    train, over = drive.train, moved(span, drive, stroke)
    if not train.copper:
        raise InputError(NO_HEAT)
    squared = [f"{over.copper!r}*({torque})^2" for torque in (over.torque, over.branches[-1])]
    burnt, beneath = 1.0 - drive.regeneration, tuple(squared[1:]) if drive.brakes_as_it_drives else ()
    if not burnt:
        return SpanSum(squared[0], over.energy_unit, beneath=beneath, least=0.0)
    if drive.mechanism.varies or train.loses or drive.mechanism.viscous or train.viscous:
        return SpanSum(over.heat, over.energy_unit, beneath=beneath, least=0.0)
    formula = f"{squared[0]} + {burnt!r}*max({over.power}, 0)"
    return SpanSum(formula, over.energy_unit, -burnt * _work(span, drive, stroke), least=0.0)


def _work(span: LawSpan, drive: Drive, stroke: float) -> float:
    """The work along a span's stroke without viscous friction, J: whatever the law."""
    mechanism, train, ends = drive.mechanism, drive.train, (span.origin, span.origin + stroke)
    load = SmoothParts.between(*sorted(ends)).integral(mechanism.load) * (1.0 if stroke > 0.0 else -1.0)
    kinetic = [
        0.5 * (mechanism.inertia(x) + train.ratio**2 * train.inertia) * state.velocity**2
        for x, state in zip(ends, (span.first, span.last), strict=True)
    ]
    rubbed = (mechanism.coulomb + train.ratio * train.coulomb) * abs(stroke)
    return float(load + rubbed + kinetic[1] - kinetic[0])
