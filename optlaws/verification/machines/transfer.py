"""Transfer functions from a law to an output: rational functions with exact coefficients, in partial fractions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import inf
from typing import Any

from flint import acb, acb_poly, acb_series, fmpq, fmpq_mat, fmpq_poly, fmpq_series, fmpz_poly

from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.mechanisms.machine.output_constants import OutputPeak
from optlaws.mechanisms.machine.state_space import StateSpace
from optlaws.synthesis.problem.constants import Functional
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.verification.enclosing.balls import rational, series_length

Matrix = Sequence[Sequence[float]]
_S = fmpq_poly([0, 1])
_NOTHING = fmpq_poly([0])
_SYMBOLS = "abc"


@dataclass(frozen=True)
class Pole:
    """A root of the denominator, real or in the upper half plane, with its effect on the output."""

    root: acb  #: where it is; the imaginary part of a real one is exactly 0
    shares: tuple[acb, ...]  #: factors of 1/(s - root), 1/(s - root)², ..., as many as the root is multiple

    @property
    def count(self) -> int:
        """2 where the conjugate root does the same."""
        return 1 if self.root.imag == 0 else 2


class Rational:
    """A quotient of polynomials in s, without what cancels.

    >>> fraction = Rational(fmpq_poly([2, 2]), fmpq_poly([2, 3, 1]))
    >>> fraction.numerator, fraction.denominator, fraction.laurent(3)
    (2, x + 2, {0: 1, 1: -1/2, 2: 1/4, 3: -1/8})
    """

    def __init__(self, above: fmpq_poly, below: fmpq_poly) -> None:
        common = above.gcd(below) if above.degree() >= 0 else below
        self.numerator, self.denominator = divmod(above, common)[0], divmod(below, common)[0]

    @property
    def direct(self) -> fmpq_poly:
        """The part that is a polynomial: what reaches the output at once."""
        return divmod(self.numerator, self.denominator)[0]

    @kept_property
    def zeros(self) -> int:
        """How often the denominator vanishes at 0: how often the output integrates what drives it."""
        return next(i for i, value in enumerate(self.denominator.coeffs()) if value != 0)

    def laurent(self, last: int) -> dict[int, fmpq]:
        """Coefficients of the powers of s about 0, up to a power."""
        above, below = self.numerator.coeffs(), self.denominator.coeffs()[self.zeros :]
        series = quotient(fmpq_series, above, below, last + self.zeros + 1)
        return {i - self.zeros: value for i, value in enumerate(series)}

    def poles(self) -> list[Pole]:
        """All poles, at the working precision; of two conjugate ones the upper."""
        rest = self.denominator
        poles = []
        if self.zeros:
            poles.append(self._pole(acb(0), self.zeros))
            rest = fmpq_poly(rest.coeffs()[self.zeros :])
        for root, multiplicity in roots(rest):
            if not root.imag < 0:
                poles.append(self._pole(root, multiplicity))
        return poles

    def _pole(self, root: acb, multiplicity: int) -> Pole:
        """A pole, by Taylor series of numerator and denominator about the root."""
        above, below = (acb_poly(part)(acb_poly([root, 1])).coeffs() for part in (self.numerator, self.denominator))
        shares = quotient(acb_series, above, below[multiplicity:], multiplicity)
        return Pole(root, tuple(reversed(shares)))


class Transfer(Rational):
    """The output's transform over the transform of the law's derivative `order`: 0 for the displacement.

    Where it does not, it is driven by the velocity, which need not come back after a cycle.
    """

    def __init__(self, machine: StateSpace, output: str) -> None:
        self.order = 0 if "a" in machine.inputs else 1
        self.characteristic, parts = transforms(machine, output)
        super().__init__(
            sum((part * _S ** (i - self.order) for i, part in enumerate(parts) if i >= self.order), _NOTHING),
            self.characteristic,
        )


def transforms(machine: StateSpace, output: str) -> tuple[fmpq_poly, list[fmpq_poly]]:
    """The characteristic polynomial p, and for each of a, b and c what is to be divided by p: C (s - A)^-1 B + D."""
    if output not in machine.outputs:
        raise InputError(f"the machine has no output {output!r}")
    place, size = machine.outputs.index(output), len(machine.A)
    A = fmpq_mat([[rational(value) for value in row] for row in machine.A])
    below = A.charpoly()
    parts = [_NOTHING] * len(_SYMBOLS)
    row = fmpq_mat([[rational(value) for value in machine.C[place]]])
    B = fmpq_mat([[rational(value) for value in line] for line in machine.B])
    chain = []
    for _ in range(size):
        chain.append(row * B)
        row = row * A
    for column, symbol in enumerate(machine.inputs):
        impulses = [link[0, column] for link in chain]
        coefficients = [sum((below[size - j] * impulses[i - j] for j in range(i + 1)), fmpq(0)) for i in range(size)]
        parts[_SYMBOLS.index(symbol)] = fmpq_poly(coefficients[::-1]) + below * rational(machine.D[place][column])
    return below, parts


def roots(polynomial: fmpq_poly) -> list[tuple[acb, int]]:
    """Balls around all roots with their multiplicities; of a real root the imaginary part is exactly 0.

    >>> [(root.real.mid(), count) for root, count in roots(fmpq_poly([1, 2, 1]))]
    [(-1.00000000000000, 2)]
    """
    if polynomial.degree() < 1:
        return []
    plain: Any = fmpz_poly(polynomial.numer().coeffs())
    return [(acb(root), int(multiplicity)) for root, multiplicity in plain.complex_roots()]


def quotient(kind: Any, above: Sequence[Any], below: Sequence[Any], count: int) -> list[Any]:
    """The first coefficients of a quotient of two series of a kind, the second of which does not vanish at 0."""
    with series_length(count):
        series = kind(above) / kind(below)
        return [series[i] for i in range(count)]


def floor(constant: Functional, conditions: BoundaryConditions) -> Fraction | float:
    """A lower bound of a constant in laws with these end conditions; minus infinity if nothing is known.

    A peak of one side of an output may be below 0, but not below the output where the law begins.
    """
    if not isinstance(constant, OutputPeak) or len(constant.signs) == 2:
        return constant.floor(conditions)
    start = conditions.start
    if constant.steady or constant.cycle is not None or constant.within[0] > 0.0:
        return -inf
    transfer = Transfer(constant.machine, constant.output)
    order, direct = transfer.order, transfer.direct
    drifts = transfer.characteristic(fmpq(0)) == 0
    if order + direct.degree() >= len(start) or (start[0] and drifts):
        return -inf
    still = transfer.laurent(0)[0] * rational(start[0]) if start[0] and not order else fmpq(0)
    begun = sum((direct[i - order] * rational(start[i]) for i in range(1, order + direct.degree() + 1)), fmpq(0))
    value = (still + begun) * int(constant.signs[0])
    return Fraction(int(value.p), int(value.q)) + Fraction(constant.signs[0]) * Fraction(constant.offset)
