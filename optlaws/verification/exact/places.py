"""Trees over the places of a peak in exact arithmetic: no law below the claim has its peak in any part."""

from __future__ import annotations

from fractions import Fraction
from math import factorial

from flint import arb, ctx

from optlaws.synthesis.problem.constants import PeakConstant
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.proof.nodes import Leaf, Node, PlaceRange, closes
from optlaws.synthesis.proof.peak_rows import CLAIM, peak_of, roots_of
from optlaws.verification.enclosing.balls import ball
from optlaws.verification.exact.charge import charge, summed, worth
from optlaws.verification.exact.rows import BallRow, ExactRows


class PlaceSteps:
    """The nodes of a certificate's tree, applied again."""

    def __init__(self, certificate: Certificate, peak: PeakConstant) -> None:
        self.rows, self.peak, limits = ExactRows(certificate), peak, certificate.problem.range(peak.name)
        self.claim, self.low = Fraction(certificate.claim or 0), Fraction(0 if limits is None else limits.low)
        self.means = self.rows.sublevel.means(self.rows.sublevel.greatest_values(self.claim))

    def after(self, here: PlaceRange, node: Node) -> list[PlaceRange] | None:
        """The ranges that remain of a range after a node; None if it is no node of places."""
        if type(node) is Leaf:
            most = self.upper(here, node)
            low = ball(self.low)
            return [] if most is not None and bool(most + self.remainder(here) < low) else [here]
        return here.after(node)

    def upper(self, here: PlaceRange, leaf: Leaf) -> arb | None:
        """Most that sign times the derivative in the middle can be below the claim; None if nothing is known."""
        rows = self.rows
        derivative = BallRow([-ball(here.sign) * value for value in self._values(0, here)])
        below = BallRow([arb(0)] * (rows.space.terms + 1), rows.cost, -ball(self.claim))
        weighed = [(arb(1), derivative)]
        for contact in leaf.contacts:
            row = below if contact.constraint == CLAIM else rows.row(contact)
            if row is not None and contact.multiplier > 0.0:
                weighed.append((ball(contact.multiplier), row))
        weighed += zip(map(ball, leaf.equations), rows.equations, strict=False)
        total = summed([weight for weight, _ in weighed], [row.vector(rows.names) for _, row in weighed])
        lost = charge(rows.sublevel, rows, total, self.claim)
        return None if lost is None else lost - total[-1]

    def remainder(self, here: PlaceRange) -> arb:
        """Most by which a peak in the range, where the slope is 0, can be above the value in its middle: by Taylor."""
        reach, highest = ball((Fraction(here.high) - Fraction(here.low)) / 2), self.rows.space.degree_of(0)
        if here.low == here.high:
            return arb(0)
        sizes = (
            self._magnitude(self._values(2 + i, here)) * reach**i / factorial(i)
            for i in range(highest - self.peak.nu - 1)
        )
        return sum(sizes, arb(0)) * reach * reach / 2

    def _values(self, further: int, here: PlaceRange) -> list[arb]:
        return self.rows.space.values(self.peak.nu + further, (Fraction(here.low) + Fraction(here.high)) / 2)

    def _magnitude(self, row: list[arb]) -> arb:
        """Most that the magnitude of a function of the law, a row of its coordinates, can be below the claim."""
        space, settled = self.rows.space, self.rows.settled
        known = [(worth(space.moments(nu), settled, row[:-1]), ball(mean)) for nu, mean in self.means.items()]
        sizes = [abs(row[-1] - value.known) + value.by_mean * mean for value, mean in known if value is not None]
        return min(sizes, key=lambda size: float(size.upper()), default=arb.pos_inf())


def places_hold(certificate: Certificate, bits: int) -> bool:
    """Whether the tree of a certificate over the places of a peak leaves none with every rounding enclosed."""
    peak = peak_of(certificate.problem, certificate.peak)
    if peak is None:
        return False
    with ctx.workprec(bits):
        roots = roots_of(certificate.problem, peak.name)
        return closes(certificate.tree, roots, PlaceSteps(certificate, peak).after)
